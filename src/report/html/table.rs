//! The table of the candidates side by side, each figure in a column of its own.

use super::body::section;
use super::data::{BUILDABLE_KEY, candidate_key};
use super::page::escaped;
use crate::record::{Candidate, Record};
use crate::report::text::{NO_NUMBER, significant};
use crate::report::words;
use crate::task::spec::{Measure, TransmissionOver};

/// A cell: its text, and the number by which it is sorted.
pub(super) struct Cell {
    text: String,
    value: Option<f64>,
    class: &'static str,
}

impl Cell {
    /// Returns a cell with a number, right-aligned.
    pub(super) fn number(value: f64, text: String) -> Self {
        Cell { text, value: Some(value).filter(|v| v.is_finite()), class: "n" }
    }

    /// Returns a cell with a number with this many significant digits.
    pub(super) fn figure(value: f64, digits: usize) -> Self {
        Cell::number(value, minus(&significant(value, digits)))
    }

    /// Returns a cell with words.
    pub(super) fn words(text: &str) -> Self {
        Cell { text: text.to_owned(), value: None, class: "" }
    }

    /// Returns a cell with a verdict in words.
    pub(super) fn verdict(text: &str, good: bool) -> Self {
        Cell { text: text.to_owned(), value: None, class: if good { "verdict good" } else { "verdict bad" } }
    }

    /// Returns the cell as markup.
    pub(super) fn markup(&self) -> String {
        let class = if self.class.is_empty() { String::new() } else { format!(" class=\"{}\"", self.class) };
        let value = self.value.map_or(String::new(), |value| format!(" data-v=\"{value:?}\""));
        format!("<td{class}{value}>{}</td>", escaped(&self.text))
    }
}

/// Returns the text with a true minus sign.
pub(super) fn minus(text: &str) -> String {
    if text == NO_NUMBER { text.to_owned() } else { text.replacen('-', "\u{2212}", 2) }
}

/// Returns a header row; headings of numbers are right-aligned.
pub(super) fn head(columns: &[(&str, bool)]) -> String {
    let cells: String = columns
        .iter()
        .map(|(name, number)| {
            let class = if *number { " class=\"n\"" } else { "" };
            format!("<th scope=\"col\"{class}>{}</th>", escaped(name))
        })
        .collect();
    format!("<thead><tr>{cells}</tr></thead>\n")
}

/// Returns a table that may be wider than the page, in a region that scrolls.
pub(super) fn scrolling(name: &str, class: &str, inside: &str) -> String {
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table class=\"{class}\">\n{inside}</table></div>\n",
        escaped(name)
    )
}

/// Returns the section with the table.
pub(super) fn candidates(record: &Record) -> String {
    if record.candidates.is_empty() {
        let drawing = crate::report::svg::candidate_svg(record, 0);
        let inside = format!(
            "<p>No candidate was found.</p>\n<figure class=\"still\">{}</figure>\n",
            super::candidate::inline(&drawing)
        );
        return section("candidates", "Candidates", &inside);
    }
    let measure = record.problem.resolved.measure();
    let ranks = words::minimised(measure);
    let unit = words::unit_suffix(record);
    let columns = [
        ("#", true),
        ("rms error", true),
        ("largest", true),
        (if measure == Measure::LargestPart { "deviation at point" } else { "at point" }, true),
        (ranks.map_or("sum of squares", |(head, _)| head), true),
        ("to curve", true),
        ("type", false),
        ("transmission", true),
        ("over", false),
        ("link ratio", true),
        ("longest link", true),
        ("defects", false),
        ("verdict", false),
    ];
    let mut rows: Vec<String> = record
        .candidates
        .iter()
        .enumerate()
        .map(|(i, c)| row(record, c, &candidate_key(i), &Cell::number(i as f64 + 1.0, (i + 1).to_string())))
        .collect();
    if let Some(c) = record.buildable.as_ref().filter(|c| c.rank == 0) {
        // After all others when sorted by rank.
        let name =
            Cell { text: "buildable".into(), value: Some(record.candidates.len() as f64 + 1.0), class: "n" };
        rows.push(row(record, c, BUILDABLE_KEY, &name));
    }
    let table = format!("{}<tbody>\n{}</tbody>\n", head(&columns), rows.concat());
    let lengths = if unit.is_empty() {
        String::new()
    } else {
        format!("Lengths in {}. ", if unit == " in" { "inches" } else { unit.trim() })
    };
    let first = ranks.map_or(String::new(), |(_, sentence)| format!("{sentence} "));
    let notes = "to curve: rms distance to the whole coupler curve, whatever the timing. transmission: the worst angle, 0 to \
                 90°, over the crank's full turn or the part used. link ratio: longest to shortest link. Points count from 0.";
    let said: String = words::fewer(record)
        .into_iter()
        .chain(crate::report::beside::mirrored(record))
        .map(|sentence| super::body::paragraph("notes", &sentence))
        .collect();
    let inside = format!(
        "{}{}{said}",
        scrolling("Candidates", "candidates wide tight", &table),
        super::body::paragraph("notes", &format!("{lengths}{first}{notes}"))
    );
    section("candidates", "Candidates side by side", &inside)
}

fn row(record: &Record, c: &Candidate, key: &str, name: &Cell) -> String {
    let plain = record.problem.resolved.measure() == Measure::Sum;
    let objective = if plain { c.error.sum_sq } else { c.error.objective };
    let worst_at = crate::report::table::worst_at(record, c);
    let over = match c.transmission_deg.over {
        TransmissionOver::Cycle => "full turn",
        TransmissionOver::Used => "part used",
    };
    let defects = if c.defects.is_empty() { "none".to_owned() } else { words::defect_names(c) };
    let verdict =
        if c.accepted { "accepted".to_owned() } else { words::verdict(record, c).replacen("no:", "not:", 1) };
    let cells = [
        Cell::figure(c.error.rms, 4),
        Cell::figure(c.error.max, 4),
        Cell::number(worst_at as f64, worst_at.to_string()),
        Cell::figure(objective, 5),
        Cell::figure(c.error.to_curve.rms, 4),
        Cell::words(c.linkage_type.name()),
        Cell::number(c.transmission_deg.worst, format!("{}°", significant(c.transmission_deg.worst, 3))),
        Cell::words(over),
        Cell::figure(c.link_ratio, 3),
        Cell::figure(c.linkage.longest_link(), 4),
        Cell::words(&defects),
        Cell::verdict(&verdict, c.accepted),
    ];
    let first = name.markup().replacen("<td", "<th scope=\"row\"", 1).replace("</td>", "</th>");
    let cells: String = cells.iter().map(Cell::markup).collect();
    format!("<tr data-key=\"{key}\">{first}{cells}</tr>\n")
}
