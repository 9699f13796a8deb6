//! The table of the candidates side by side, each figure in a column of its own.

use super::data::candidate_key;
use super::extras::{Shown, extras};
use super::page::{paragraph, section, still};
use crate::record::{AngleErrorRecord, Candidate, Record};
use crate::report::text::{NO_NUMBER, significant};
use crate::report::{output, words};
use crate::task::spec::{Measure, TransmissionOver};
use maud::{Markup, Render, html};

/// A cell: its text, and the number by which it is sorted.
#[derive(Default)]
pub(in crate::report) struct Cell {
    pub(in crate::report) text: String,
    pub(in crate::report) value: Option<f64>,
    /// The class of its element; words have none.
    pub(in crate::report) class: Option<&'static str>,
}

impl Cell {
    /// Returns a cell with a number, right-aligned; the number may be missing.
    pub(in crate::report) fn number(value: impl Into<Option<f64>>, text: impl Into<String>) -> Self {
        Cell { text: text.into(), value: value.into().filter(|v| v.is_finite()), class: Some("n") }
    }

    /// Returns a cell with a whole number.
    pub(in crate::report) fn whole(value: usize) -> Self {
        Cell::number(value as f64, value.to_string())
    }

    /// Returns a cell with a number with this many significant digits.
    pub(in crate::report) fn figure(value: f64, digits: usize) -> Self {
        Cell::number(value, minus(&significant(value, digits)))
    }

    /// Returns a cell with an angle in degrees.
    pub(super) fn degrees(value: f64) -> Self {
        Cell::number(value, format!("{}°", significant(value, 3)))
    }

    /// Returns a cell with words.
    pub(in crate::report) fn words(text: impl Into<String>) -> Self {
        Cell { text: text.into(), ..Cell::default() }
    }

    /// Returns a cell with a verdict in words.
    pub(in crate::report) fn verdict(text: impl Into<String>, good: bool) -> Self {
        Cell {
            text: text.into(),
            value: None,
            class: Some(if good { "verdict good" } else { "verdict bad" }),
        }
    }
}

impl Render for Cell {
    fn render(&self) -> Markup {
        html! { td class=[self.class] data-v=[self.value.map(|v| format!("{v:?}"))] { (self.text) } }
    }
}

/// A column: its heading, whether it holds numbers, which are right-aligned, and the cell of a row.
pub(super) type Column<'a, T> = (&'a str, bool, &'a dyn Fn(&T) -> Cell);

/// Returns a table in a region that scrolls. `first` is the heading of the first column; a row begins with the key of
/// the mechanism that it shows, if there is one, and its name.
pub(super) fn tabulated<T>(
    (name, class): (&str, &str),
    first: (&str, bool),
    columns: &[Column<T>],
    rows: impl IntoIterator<Item = (Option<String>, Cell, T)>,
) -> Markup {
    let heads: Vec<_> =
        std::iter::once(first).chain(columns.iter().map(|column| (column.0, column.1))).collect();
    let rows = rows.into_iter().map(|(key, Cell { text, value, class }, of)| {
        html! {
            tr data-key=[key] {
                th scope="row" class=[class] data-v=[value.map(|v| format!("{v:?}"))] { (text) }
                @for (_, _, cell) in columns { (cell(&of)) }
            }
        }
    });
    scrolling(name, class, &heads, rows)
}

/// Returns the text with a true minus sign.
pub(super) fn minus(text: &str) -> String {
    if text == NO_NUMBER { text.to_owned() } else { text.replacen('-', "\u{2212}", 2) }
}

/// Returns a table that may be wider than the page, in a region that scrolls. A heading says whether it is that of
/// numbers, which are right-aligned.
pub(in crate::report) fn scrolling<T: Render>(
    name: &str,
    class: &str,
    columns: &[(&str, bool)],
    rows: impl IntoIterator<Item = T>,
) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label=(name) {
            table class=(class) {
                thead { tr {
                    @for (name, number) in columns { th scope="col" class=[number.then_some("n")] { (name) } }
                } }
                tbody { @for row in rows { (row) } }
            }
        }
    }
}

/// Returns the section with the table.
pub(super) fn candidates(record: &Record, shown: Shown) -> Markup {
    if record.candidates.is_empty() {
        let drawing = crate::report::svg::candidate_svg(record, 0);
        return section(
            "candidates",
            "Candidates",
            html! { p { "No candidate was found." } (still(&drawing)) },
        );
    }
    let measure = record.problem.resolved.measure();
    let task = &record.problem.resolved.task;
    let ranks = words::minimised_in(record);
    let at = words::of_targets(
        task,
        if measure == Measure::LargestPart { "deviation at point" } else { "at point" },
    );
    let of_angle = |c: &Candidate, of: fn(&AngleErrorRecord) -> f64| {
        c.error.angle.as_ref().map_or(Cell::words(NO_NUMBER), |angle| Cell::degrees(of(angle)))
    };
    let [angle_rms, angle_max] = ["angle rms", "angle largest"];
    let (output_from, unit) =
        (format!("{} from", output::link(&record.problem.resolved)), words::error_unit(record));
    let from = |deg: Option<f64>, through: Option<f64>| {
        let through = through.map_or_else(String::new, |range| format!(" +{range:.2}°"));
        deg.map_or(Cell::words(NO_NUMBER), |deg| Cell::number(deg, minus(&format!("{deg:.2}°")) + &through))
    };
    let all: [Column<&Candidate>; 16] = [
        ("rms error", true, &|c| Cell::figure(c.error.rms, 4)),
        ("largest", true, &|c| Cell::figure(c.error.max, 4)),
        (&at, true, &|c| Cell::whole(crate::report::table::worst_at(record, c))),
        (angle_rms, true, &|c| of_angle(c, |angle| angle.rms_deg)),
        (angle_max, true, &|c| of_angle(c, |angle| angle.max_deg)),
        (ranks.as_ref().map_or("sum of squares", |(head, _)| head), true, &|c| {
            Cell::figure(if ranks.is_none() { c.error.sum_sq } else { c.error.objective }, 5)
        }),
        ("crank from", true, &|c| from(c.input_offset_deg, c.input_range_deg)),
        (&output_from, true, &|c| match c.output_offset {
            Some(place) => Cell::number(place, minus(&significant(place, 5)) + &unit),
            None => from(c.output_offset_deg, c.output_range_deg),
        }),
        ("to curve", true, &|c| Cell::figure(c.error.to_curve.rms, 4)),
        ("type", false, &|c| Cell::words(c.type_name())),
        ("transmission", true, &|c| Cell::degrees(c.transmission_deg.worst)),
        ("over", false, &|c| Cell::words(over(c.transmission_deg.over))),
        ("link ratio", true, &|c| Cell::figure(c.link_ratio, 3)),
        ("longest link", true, &|c| Cell::figure(c.linkage.longest_link(), 4)),
        ("defects", false, &|c| Cell::words(defects(c))),
        ("verdict", false, &|c| Cell::verdict(verdict(record, c), c.accepted)),
    ];
    let (of_motion, of_function) = (task.is_motion(), task.is_function());
    let [crank_from, follower_from] = ["crank from", output_from.as_str()];
    let is_shown = |column: &&Column<&Candidate>| match column.0 {
        name if [angle_rms, angle_max].contains(&name) => of_motion,
        name if [crank_from, follower_from].contains(&name) => of_function,
        "to curve" => !of_function,
        _ => true,
    };
    let columns: Vec<Column<&Candidate>> = all.iter().filter(is_shown).copied().collect();
    let ranked =
        record.candidates.iter().enumerate().map(|(i, c)| (c, candidate_key(i), (i + 1).to_string()));
    // After all others when sorted by rank.
    let others = extras(record, shown).into_iter().map(|extra| (extra.candidate, extra.key, extra.short));
    let rows = ranked
        .chain(others)
        .enumerate()
        .map(|(i, (c, key, name))| (Some(key), Cell::number(i as f64 + 1.0, name), c));
    let lengths = match words::unit_suffix(record).trim() {
        "" => String::new(),
        "in" => "Lengths in inches. ".to_owned(),
        unit => format!("Lengths in {unit}. "),
    };
    let first = ranks.as_ref().map_or(String::new(), |(_, sentence)| format!("{sentence} "));
    let notes = if task.is_of_places() {
        "rms error, largest: of the slider's place. crank from: its angle from the slider's line, or from the line A-B, at an \
         input of 0; then the slider's place at an output of 0, from the foot of the perpendicular from A, or the block's along \
         the rod from C. transmission: the worst angle, 0 to 90°, over the crank's full turn or the part used. link ratio: \
         longest to shortest link. Pairs count from 0."
    } else if of_function {
        "rms error, largest: of the follower's angle, degrees. crank, follower from: their angles from the line A-B at an \
         input and an output of 0. transmission: the worst angle, 0 to 90°, over the crank's full turn or the part used. \
         link ratio: longest to shortest link. Pairs count from 0."
    } else if of_motion {
        "rms error, largest: of the place. angle: of the body. to curve: rms distance of the poses' places to the whole curve \
         of the body's point. transmission: the worst angle, 0 to 90°, over the crank's full turn or the part used. link \
         ratio: longest to shortest link. Poses count from 0."
    } else {
        "to curve: rms distance to the whole coupler curve, whatever the timing. transmission: the worst angle, 0 to \
                 90°, over the crank's full turn or the part used. link ratio: longest to shortest link. Points count from 0."
    };
    let said = words::fewer(record).into_iter().chain(crate::report::beside::mirrored(record));
    let inside = html! {
        (tabulated(("Candidates", "candidates wide tight"), ("#", true), &columns, rows))
        (paragraph("notes", &format!("{lengths}{first}{notes}")))
        @for sentence in said { (paragraph("notes", &sentence)) }
    };
    section("candidates", "Candidates side by side", inside)
}

fn over(over: TransmissionOver) -> &'static str {
    match over {
        TransmissionOver::Cycle => "full turn",
        TransmissionOver::Used => "part used",
    }
}

fn defects(c: &Candidate) -> String {
    if c.defects.is_empty() { "none".to_owned() } else { words::defect_names(c) }
}

fn verdict(record: &Record, c: &Candidate) -> String {
    if c.accepted { "accepted".to_owned() } else { words::verdict(record, c).replacen("no:", "not:", 1) }
}
