//! The linkages through nine points: the census in words, the linkages in a table.

use super::body::{paragraph, section};
use super::data::MOST_EXACT;
use super::table::{Cell, head, scrolling};
use crate::record::{ExactLinkage, Record};
use crate::report::exact::{ability, none_through, sentences};
use crate::report::text::{clean, grouped, significant};
use crate::report::words;
use crate::task::Defect;

/// Returns the section; empty for a record without exact linkages.
pub(super) fn exact(record: &Record) -> String {
    let Some(exact) = &record.exact else { return String::new() };
    let said = none_through(record).map_or_else(|| sentences(exact).to_vec(), |one| vec![one]);
    let mut inside: String = said.iter().filter(|s| !s.is_empty()).map(|s| paragraph("", s)).collect();
    if !exact.linkages.is_empty() {
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
        let shown = exact.linkages.iter().take(MOST_EXACT).enumerate();
        let rows: String = shown.map(|(i, linkage)| row(i, linkage, &unit)).collect();
        let table = format!("{}<tbody>\n{rows}</tbody>\n", head(&columns));
        inside.push_str(&scrolling("Exact linkages", "sortable wide tight", &table));
        let mut notes = String::from(
            "the curve can be: what the best of its six mechanisms (three cognates, either link driven) can do. defects, \
             transmission, ratio: of the one listed. proved within: one exact linkage is proved to stand this near.",
        );
        if exact.linkages.len() > MOST_EXACT {
            let more = grouped((exact.linkages.len() - MOST_EXACT) as u64);
            notes.push_str(&format!(" {more} more stand in the record as exact.linkages."));
        }
        inside.push_str(&paragraph("notes", &notes));
    }
    section("exact", "Every linkage through the nine points", &inside)
}

fn row(i: usize, linkage: &ExactLinkage, unit: &str) -> String {
    let defects: Vec<&str> = linkage.defects.iter().map(Defect::name).collect();
    let others: Vec<String> = linkage
        .not_met
        .iter()
        .filter(|name| !defects.contains(&name.as_str()))
        .map(|name| clean(name.strip_prefix("design.").unwrap_or(name)))
        .collect();
    let verdict = match (linkage.accepted, others.as_slice()) {
        (true, _) => "accepted".to_owned(),
        (false, []) => "no".to_owned(),
        (false, list) => format!("no: {}", list[..list.len().min(3)].join(", ")),
    };
    let rank = if linkage.rank > 0 {
        Cell::number(linkage.rank as f64, format!("#{}", linkage.rank))
    } else {
        Cell::words("")
    };
    let radius = linkage.certified.map_or(Cell::words("no proof"), |c| {
        Cell::number(c.radius, format!("{}{unit}", significant(c.radius, 1)))
    });
    let cells = [
        rank,
        Cell::words(ability(linkage)),
        Cell::words(linkage.linkage_type.name()),
        Cell::words(&if defects.is_empty() { "none".to_owned() } else { defects.join(", ") }),
        Cell::number(
            linkage.transmission_worst_deg,
            format!("{}°", significant(linkage.transmission_worst_deg, 3)),
        ),
        Cell::figure(linkage.link_ratio, 3),
        radius,
        Cell::verdict(&verdict, linkage.accepted),
    ];
    let cells: String = cells.iter().map(Cell::markup).collect();
    let n = i + 1;
    format!("<tr data-key=\"x{n}\"><th scope=\"row\" class=\"n\" data-v=\"{n}\">{n}</th>{cells}</tr>\n")
}
