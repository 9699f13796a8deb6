//! The linkages through nine points: the census in words, the linkages in a table.

use super::data::MOST_EXACT;
use super::page::{paragraph, section};
use super::table::{Cell, Row, scrolling};
use crate::record::{ExactLinkage, Record};
use crate::report::exact::{ability, defects, others, said};
use crate::report::text::{grouped, significant};
use crate::report::words;
use maud::{Markup, html};

/// Returns the section; empty for a record without exact linkages.
pub(super) fn exact(record: &Record) -> Markup {
    let Some(exact) = &record.exact else { return Markup::default() };
    let inside = html! {
        @for sentence in said(record, exact) { (paragraph("", &sentence)) }
        @if !exact.linkages.is_empty() {
            (table(record, &exact.linkages))
            (paragraph("notes", &notes(exact.linkages.len())))
        }
    };
    section("exact", "Every linkage through the nine points", inside)
}

fn table(record: &Record, linkages: &[ExactLinkage]) -> Markup {
    let unit = words::unit_suffix(record);
    let columns = [
        ("#", true),
        ("candidate", true),
        ("the curve can be", false),
        ("type", false),
        ("defects", false),
        ("transmission", true),
        ("link ratio", true),
        ("proved within", true),
        ("verdict", false),
    ];
    let shown = linkages.iter().take(MOST_EXACT).enumerate();
    let rows = shown.map(|(i, linkage)| Row {
        key: Some(format!("x{}", i + 1)),
        name: Cell::number((i + 1) as f64, (i + 1).to_string()),
        cells: cells(linkage, &unit),
    });
    scrolling("Exact linkages", "sortable wide tight", &columns, rows)
}

fn notes(linkages: usize) -> String {
    let mut notes = String::from(
        "the curve can be: what the best of its six mechanisms (three cognates, either link driven) can do. defects, \
         transmission, ratio: of the one listed. proved within: one exact linkage is proved to stand this near.",
    );
    if linkages > MOST_EXACT {
        let more = grouped((linkages - MOST_EXACT) as u64);
        notes.push_str(&format!(" {more} more stand in the record as exact.linkages."));
    }
    notes
}

fn cells(linkage: &ExactLinkage, unit: &str) -> Vec<Cell> {
    let others = others(linkage);
    let verdict = match (linkage.accepted, others.as_slice()) {
        (true, _) => "accepted".to_owned(),
        (false, []) => "no".to_owned(),
        (false, list) => format!("no: {}", list[..list.len().min(3)].join(", ")),
    };
    let rank = match linkage.rank {
        0 => Cell::words(""),
        rank => Cell::number(rank as f64, format!("#{rank}")),
    };
    let radius = linkage.certified.map_or(Cell::words("no proof"), |c| {
        Cell::number(c.radius, format!("{}{unit}", significant(c.radius, 1)))
    });
    vec![
        rank,
        Cell::words(ability(linkage)),
        Cell::words(linkage.linkage_type.name()),
        Cell::words(defects(linkage)),
        Cell::degrees(linkage.transmission_worst_deg),
        Cell::figure(linkage.link_ratio, 3),
        radius,
        Cell::verdict(verdict, linkage.accepted),
    ]
}
