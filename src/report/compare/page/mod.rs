//! A comparison as one self-contained HTML page: curves that can be shown and hidden, the trade-off chart, tables that
//! can be sorted. Without its script it can still be read and printed.

use super::overlay;
use super::overlay::Overlay;
use super::trade_off;
use super::trade_off::trade_off;
use super::{Comparison, Ranked, SortKey, strokes, tables};
use crate::record::Candidate;
use crate::report::canvas::{Canvas, px};
use crate::report::csv::PARAMETERS;
use crate::report::html::page::Page;
use crate::report::text::{NO_NUMBER, brief, clean, exact, significant};
use crate::report::words::{defect_names, length_suffix};
use maud::{Markup, PreEscaped, html};

/// The heading of a column: its text, and a longer text for screen readers if there is one.
type Head<'a> = (&'a str, Option<&'static str>);

impl Comparison {
    /// Returns the page. Labels and names are plain text in it, whatever characters they contain.
    pub fn html(&self) -> String {
        let title = self.title();
        let points = self.rows.first().filter(|_| self.same_target());
        let points = points.map(|row| format!("{} target points; ", row.entry.target.len()));
        let notes = self.notes();
        let body = html! {
            main {
                header {
                    h1 { (title) }
                    p.sub { (points.unwrap_or_default()) "ranked by " (tables::keys_in_words(self)) }
                }
                @if !notes.is_empty() { ul.notes { @for note in notes { li { (note) } } } }
                @if !self.rows.is_empty() {
                    (self.curves())
                    @if let Some(section) = self.trade() { (section) }
                    (self.figure_section())
                    @if let Some(section) = self.difference_section() { (section) }
                    (self.parameter_section())
                }
                footer { p {
                    "Made by linkwright " (env!("CARGO_PKG_VERSION"))
                    ". Every figure was computed again by its referee."
                } }
            }
        };
        Page {
            title: &title,
            styles: &[include_str!("compare.css")],
            body,
            data: "null",
            modules: &[include_str!("compare.mjs")],
        }
        .render()
    }

    fn curves(&self) -> Markup {
        let overlay = Overlay::new(self);
        let description = format!("The coupler curves over the target. {}", self.description());
        let target = self.same_target().then(|| "Circles: the target, its point 0 filled.".to_owned());
        let caption: Vec<String> = target.into_iter().chain(overlay.remarks(self)).collect();
        html! {
            section id="curves" {
                h2 { "Curves" }
                div.beside {
                    figure {
                        (drawing(overlay::WIDTH, overlay.height, &description, overlay.canvas))
                        figcaption { (caption.join(" ")) }
                    }
                    fieldset.legend {
                        legend { "Curves shown" }
                        @for (i, row) in self.rows[..overlay.drawn].iter().enumerate() { (self.label(i, row)) }
                        p.buttons {
                            button type="button" id="all" { "Show all" } " "
                            button type="button" id="none" { "Hide all" }
                        }
                    }
                }
            }
        }
    }

    /// Returns the box that shows or hides a curve, with its stroke and its name.
    fn label(&self, i: usize, row: &Ranked) -> Markup {
        let line = format!(r#"<path d="M2 5H34" {}/>"#, strokes::stroke(i));
        html! {
            label data-row=(i) {
                input type="checkbox" checked data-row=(i);
                svg.swatch viewBox="0 0 36 10" aria-hidden="true" { (PreEscaped(line)) }
                " " span.name { (row.rank) (star(row)) " " (clean(&row.entry.label)) }
                " " span.sub { (self.legend_figures(row)) }
            }
        }
    }

    fn trade(&self) -> Option<Markup> {
        let canvas = trade_off(self)?;
        let description = "Each linkage by its rms error (across), its worst transmission angle (up) and its size (the \
                           size of the mark); the same figures are in the table below.";
        Some(html! {
            section id="trade" {
                h2 { "Error, transmission angle, size" }
                figure {
                    (drawing(trade_off::WIDTH, trade_off::HEIGHT, description, canvas))
                    figcaption {
                        "Across the rms error, up the worst transmission angle: best is the upper left corner. \
                         Numbers are ranks, larger marks larger linkages; filled and bold: the Pareto front."
                    }
                }
            }
        })
    }

    fn figure_section(&self) -> Markup {
        let unit =
            length_suffix(self.rows.first().and_then(|row| row.entry.unit).filter(|_| self.same_unit()));
        let unit = if unit.is_empty() { String::new() } else { format!(" Lengths are in{unit}.") };
        let front = self.front_words().map_or(String::new(), |words| format!("★ {words}."));
        let ranks: Vec<String> = match self.keys.as_slice() {
            [_] => Vec::new(),
            several => several.iter().map(|key| format!("rank by {}", key.name())).collect(),
        };
        let mut heads: Vec<Head> = vec![
            ("behind", Some("behind the best, per cent")),
            (self.sum_head(), None),
            ("rms", None),
            ("max", None),
            ("at", Some("at which point")),
            ("to curve", None),
            ("transm.", Some("worst transmission angle")),
        ];
        heads.extend(plain_heads(&["link ratio", "size", "type", "accepted"]));
        heads.extend(ranks.iter().map(|rank| (rank.as_str(), None)));
        html! {
            section id="figures" {
                h2 { "Figures" }
                (self.sorted("Figures", &heads, |_, row| self.figure_cells(row)))
                p.sub { (front) (unit) }
            }
        }
    }

    fn difference_section(&self) -> Option<Markup> {
        let reference = self.reference_label()?;
        let heads =
            plain_heads(&[self.sum_head(), "rms", "max", "to curve", "transm.", "link ratio", "size"]);
        let cells = |i: usize, row: &Ranked| {
            let is_reference = self.reference == Some(i);
            let cells = self.shown_figures().map(|key| {
                let percent = row.difference_percent.get(key as usize).copied().flatten();
                let shown =
                    if is_reference { "reference".to_owned() } else { tables::signed_percent(percent) };
                Cell::of(percent, shown)
            });
            cells.into()
        };
        Some(html! {
            section id="differences" {
                h2 { "Above " (clean(reference)) ", per cent of it" }
                (self.sorted("Differences", &heads, cells))
                p.sub { "Where the reference's figure is 0 there is no percentage of it." }
            }
        })
    }

    fn parameter_section(&self) -> Markup {
        let mut heads = plain_heads(&["type"]);
        heads.extend(PARAMETERS.map(|(name, _)| (name, None)));
        let cells = |_: usize, row: &Ranked| {
            let candidate = &row.entry.candidate;
            let numbers = tables::parameters(&candidate.linkage, |x| brief(x, 6));
            let numbers = numbers.map(|(value, shown)| Cell::of(Some(value), shown));
            [Cell::word(candidate.linkage_type.name())].into_iter().chain(numbers).collect()
        };
        html! {
            section id="parameters" {
                h2 { "Parameters" }
                (self.sorted("Parameters", &heads, cells))
                p.sub {
                    "A, B fixed pivots; a crank, b coupler, c follower, d and e from its pins C and D to the coupler \
                     point; t1 and t2 say on which side D and the coupler point lie."
                }
            }
        }
    }

    fn sum_head(&self) -> &'static str {
        self.minimised().map_or("sum of squares", |(head, _)| head)
    }

    fn figure_cells(&self, row: &Ranked) -> Vec<Cell> {
        let candidate = &row.entry.candidate;
        let number = |key, digits| {
            let value = row.figure_of(key);
            Cell::of(value, significant(value.unwrap_or(f64::NAN), digits))
        };
        let whole = |value: usize| Cell::of(Some(value as f64), value.to_string());
        let behind = match row.behind_percent {
            Some(0.0) => "best".to_owned(),
            percent => tables::signed_percent(percent).trim_start_matches('+').to_owned(),
        };
        let angle = row.figure_of(SortKey::Transmission);
        let shown = angle.map_or(NO_NUMBER.to_owned(), |angle| format!("{}°", significant(angle, 3)));
        let mut cells = vec![
            Cell::of(row.behind_percent, behind),
            number(self.first_figure(), 4),
            number(SortKey::Rms, 4),
            number(SortKey::Max, 4),
            whole(candidate.error.max_at),
            number(SortKey::ToCurve, 4),
            Cell::of(angle, shown),
            number(SortKey::LinkRatio, 3),
            number(SortKey::Size, 4),
            Cell::word(candidate.linkage_type.name()),
            Cell::word(&verdict(candidate)),
        ];
        if self.keys.len() > 1 {
            cells.extend(row.ranks.iter().map(|rank| whole(*rank)));
        }
        cells
    }

    /// Returns a table whose first columns are rank and label; each heading is a button that sorts.
    fn sorted(&self, name: &str, heads: &[Head], cells: impl Fn(usize, &Ranked) -> Vec<Cell>) -> Markup {
        let first: [Head; 2] = [("#", Some("rank")), ("linkage", None)];
        html! {
            div.scroll role="region" tabindex="0" aria-label={ (name) ", scrolls sideways" } {
                table {
                    thead { tr {
                        @for (i, (shown, said)) in first.iter().chain(heads).enumerate() {
                            th scope="col" aria-sort=[(i == 0).then_some("ascending")] {
                                button type="button" title=[said] aria-label=[said] { (shown) }
                            }
                        }
                    } }
                    tbody {
                        @for (place, row) in self.rows.iter().enumerate() {
                            tr data-row=(place) {
                                td data-value=(row.rank) { (row.rank) (star(row)) }
                                th scope="row" {
                                    (clean(&row.entry.label))
                                    @if !row.entry.untrue.is_empty() {
                                        " " span title="the record is not true" { "⚠" }
                                    }
                                }
                                @for cell in cells(place, row) {
                                    td class=[cell.word.then_some("word")] data-value=[cell.value()] {
                                        (clean(&cell.shown))
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Returns whether a candidate is accepted, with its defects or with the requirements that it misses.
fn verdict(candidate: &Candidate) -> String {
    const NAMED: usize = 3;
    match (candidate.accepted, candidate.defects.is_empty()) {
        (true, true) => return "yes".to_owned(),
        (true, false) => return format!("yes ({})", defect_names(candidate)),
        (false, _) => {}
    }
    let mut unmet: Vec<&str> =
        candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.as_str()).collect();
    let defects = candidate.defects.iter().map(|d| d.name());
    let others: Vec<&str> = defects.filter(|name| !unmet.contains(name)).collect();
    unmet.extend(others);
    match unmet.len() {
        0 => "no".to_owned(),
        n if n > NAMED => format!("no: {} and {} more", unmet[..NAMED].join(", "), n - NAMED),
        _ => format!("no: {}", unmet.join(", ")),
    }
}

/// A cell of a table.
struct Cell {
    shown: String,
    /// The number by which it is sorted; words by themselves, missing numbers last.
    number: Option<f64>,
    word: bool,
}

impl Cell {
    fn of(number: Option<f64>, shown: String) -> Cell {
        Cell { shown, number, word: false }
    }

    fn word(word: &str) -> Cell {
        Cell { shown: word.to_owned(), number: None, word: true }
    }

    fn value(&self) -> Option<String> {
        (!self.word).then(|| self.number.map_or(String::new(), exact))
    }
}

fn plain_heads<'a>(heads: &[&'a str]) -> Vec<Head<'a>> {
    heads.iter().map(|head| (*head, None)).collect()
}

fn star(row: &Ranked) -> Markup {
    html! {
        @if row.on_front {
            " " span role="img" aria-label="on the Pareto front" title="on the Pareto front" { "★" }
        }
    }
}

fn drawing(width: f64, height: f64, description: &str, canvas: Canvas) -> Markup {
    html! {
        svg.drawing viewBox={ "0 0 " (px(width)) " " (px(height)) } role="img" aria-label=(description) {
            (PreEscaped(canvas.body))
        }
    }
}
