//! The linkages through nine points, or poses and points: the census in words, the linkages in a table.

use super::data::MOST_EXACT;
use super::page::{paragraph, section};
use super::table::{Cell, Column, tabulated};
use crate::record::{ExactLinkage, ExactRecord, Record};
use crate::report::exact::{ability, best_of, defects, others, said, title};
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
            (paragraph("notes", &notes(exact)))
        }
    };
    section("exact", &title(exact), inside)
}

fn table(record: &Record, linkages: &[ExactLinkage]) -> Markup {
    let unit = words::unit_suffix(record);
    let columns: [Column<&ExactLinkage>; 8] = [
        ("candidate", true, &|x| match x.rank {
            0 => Cell::words(""),
            rank => Cell::number(rank as f64, format!("#{rank}")),
        }),
        ("the curve can be", false, &|x| Cell::words(ability(x))),
        ("type", false, &|x| Cell::words(x.type_name())),
        ("defects", false, &|x| Cell::words(defects(x))),
        ("transmission", true, &|x| Cell::degrees(x.transmission_worst_deg)),
        ("link ratio", true, &|x| Cell::figure(x.link_ratio, 3)),
        ("proved within", true, &|x| match x.certified {
            None => Cell::words("no proof"),
            Some(proof) => Cell::number(proof.radius, format!("{}{unit}", significant(proof.radius, 1))),
        }),
        ("verdict", false, &|x| Cell::verdict(verdict(x), x.accepted)),
    ];
    let shown = linkages.iter().take(MOST_EXACT).zip(1..);
    let rows = shown.map(|(x, i)| (Some(format!("x{i}")), Cell::whole(i), x));
    tabulated(("Exact linkages", "sortable wide tight"), ("#", true), &columns, rows)
}

fn notes(exact: &ExactRecord) -> String {
    let linkages = exact.linkages.len();
    let mut notes = format!(
        "the curve can be: what {} can do. defects, transmission, ratio: of the one listed. proved within: one exact \
         linkage is proved to stand this near.",
        best_of(exact)
    );
    if linkages > MOST_EXACT {
        let more = grouped((linkages - MOST_EXACT) as u64);
        notes.push_str(&format!(" {more} more stand in the record as exact.linkages."));
    }
    notes
}

fn verdict(linkage: &ExactLinkage) -> String {
    match (linkage.accepted, others(linkage).as_slice()) {
        (true, _) => "accepted".to_owned(),
        (false, []) => "no".to_owned(),
        (false, list) => format!("no: {}", list[..list.len().min(3)].join(", ")),
    }
}
