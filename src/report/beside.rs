//! Lines printed below the candidates: the family, warnings, cognates, the buildable candidate, the picks.

use super::text::{COLUMNS, clean, plural, significant, wrapped};
use super::{picks, words};
use crate::record::{Candidate, ON_BOUND_TEXT, Record, WarningKind};

/// The largest number of lines of warnings and of cognates in the text.
const MOST_LINES: usize = 20;

/// Returns the lines for the table of candidates, indented by two; empty if there is nothing to report.
pub(super) fn lines(record: &Record) -> String {
    let mut parts = Vec::new();
    if let Some(family) = &record.family {
        parts.push(format!("{}.", clean(&family.text)));
    }
    let said = record.candidates.iter().filter(|c| !c.warnings.is_empty());
    parts.extend(said.take(MOST_LINES).map(|c| format!("#{}: {}", c.rank, warnings(c))));
    parts.extend(mirrored(record));
    if let Some(candidate) = &record.buildable {
        parts.push(buildable(record, candidate));
    }
    parts.extend(picks::lines(record));
    let cognates =
        record.candidates.iter().filter_map(|c| Some(format!("#{}: {}", c.rank, alternatives(c)?)));
    parts.extend(cognates.take(MOST_LINES));
    if parts.is_empty() {
        return String::new();
    }
    let text: String = parts.iter().map(|part| wrapped("  ", "      ", part, COLUMNS)).collect();
    format!("\n{text}")
}

/// Returns the candidates whose mirror images serve as well, in words; `None` if there are none.
pub(super) fn mirrored(record: &Record) -> Option<String> {
    let ranks: Vec<String> =
        record.candidates.iter().filter(|c| c.mirror_serves).map(|c| format!("#{}", c.rank)).collect();
    let (which, images) = match ranks.len() {
        0 => return None,
        1 => (ranks[0].clone(), "its mirror image, which is not listed, serves"),
        n if n == record.candidates.len() => {
            ("all".to_owned(), "their mirror images, which are not listed, serve")
        }
        _ => (ranks.join(", "), "their mirror images, which are not listed, serve"),
    };
    Some(format!("{which}: the target is symmetric, and {images} as well."))
}

/// Returns the warnings of a candidate in one line; empty without any. Several limits are combined in one clause.
pub(super) fn warnings(candidate: &Candidate) -> String {
    let (mut said, mut limits) = (Vec::new(), Vec::new());
    for warning in candidate.warnings.iter().take(MOST_LINES) {
        match warning.text.strip_suffix(ON_BOUND_TEXT) {
            Some(limit) if warning.kind == WarningKind::OnBound => limits.push(clean(limit)),
            _ => said.push(clean(&warning.text)),
        }
    }
    match limits.as_slice() {
        [] => {}
        [limit] => said.push(format!("{limit}{ON_BOUND_TEXT}")),
        [first @ .., last] => said.push(format!(
            "{} and {last} are on their limits: the problem's bounds decide them",
            first.join(", ")
        )),
    }
    said.join("; ")
}

fn buildable(record: &Record, candidate: &Candidate) -> String {
    let place = if candidate.rank > 0 { format!("#{}", candidate.rank) } else { "beside the table".into() };
    // If the first candidate has no warnings but those about limits, it may well be buildable: this one is free of
    // them.
    let first = record.candidates.first();
    let limits_only = first.is_some_and(|c| c.warnings.iter().all(|w| w.kind == WarningKind::OnBound));
    let label = if limits_only { "buildable, on no limit" } else { "buildable" };
    let angle_error = words::angle_errors(candidate).map_or(String::new(), |said| format!(", {said}"));
    let mut text = format!(
        "{label} ({place}): sum of sq {}, rms {}{}{angle_error}, {}, worst transmission angle {} deg, ratio {}",
        significant(candidate.error.sum_sq, 6),
        significant(candidate.error.rms, 4),
        words::error_unit(record),
        candidate.type_name(),
        significant(candidate.transmission_deg.worst, 3),
        significant(candidate.link_ratio, 3),
    );
    if !candidate.warnings.is_empty() {
        text.push_str(&format!("; {}", warnings(candidate)));
    }
    text + "; linkage-buildable.toml"
}

/// Returns a line such as `same curve: 2 cognates, one accepted, worst transmission 41 deg, see record`.
fn alternatives(candidate: &Candidate) -> Option<String> {
    let all = &candidate.alternatives;
    let count = match all.len() {
        0 => return None,
        n => plural(n, "cognate"),
    };
    let accepted: Vec<_> = all.iter().filter(|a| a.accepted).collect();
    let best = accepted.iter().map(|a| a.transmission_worst_deg).reduce(f64::max);
    let verdict = match (accepted.len(), all.len()) {
        (0, 1) => "not accepted".to_owned(),
        (0, _) => "none accepted".to_owned(),
        (1, 1) => "accepted".to_owned(),
        (1, _) => "one accepted".to_owned(),
        (n, _) => format!("{n} accepted"),
    };
    let angle =
        best.map_or(String::new(), |best| format!(", worst transmission {} deg", significant(best, 3)));
    Some(format!("same curve: {count}, {verdict}{angle}, see record"))
}
