//! Coverage of the verification of a record: each key is recomputed, held to limits, or not checked.
//!
//! `docs/results.md` has the whole table, and a test changes every figure of records and compares the outcome with the
//! table.

use crate::record::Record;

/// The extent to which a key of a record is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Checked {
    /// Held to limits: only a search or a proof could find the value again.
    Bounded,
    /// Not checked.
    Not,
}

/// The keys that are not recomputed, as in docs/results.md: `a.b[].c`, `a.b.*` for all keys below `a.b`, and `a[]` for
/// the number of entries of a list.
pub const UNCHECKED: &[(&str, Checked)] = &[
    ("tool.version", Checked::Not),
    ("problem.name", Checked::Not),
    ("problem.source", Checked::Not),
    ("problem.unit", Checked::Bounded),
    ("problem.resolved.solve.candidates", Checked::Bounded),
    ("problem.resolved.solve.evaluations", Checked::Bounded),
    ("problem.resolved.solve.picks_within", Checked::Bounded),
    ("problem.resolved.solve.time_limit_s", Checked::Not),
    ("problem.resolved.solve.certify.gap", Checked::Bounded),
    ("problem.resolved.solve.certify.time_limit_s", Checked::Not),
    ("method.used", Checked::Bounded),
    ("termination.reason", Checked::Bounded),
    ("evaluations.*", Checked::Bounded),
    ("repeats.starts", Checked::Bounded),
    ("repeats.hits", Checked::Bounded),
    ("repeats.near", Checked::Bounded),
    ("repeats.followed", Checked::Bounded),
    ("repeats.basins", Checked::Bounded),
    ("conflict.among", Checked::Bounded),
    ("of_kinds[]", Checked::Not),
    ("of_kinds[].*", Checked::Bounded),
    ("relaxations[]", Checked::Not),
    ("relaxations[].set[]", Checked::Bounded),
    ("relaxations[].set[].to", Checked::Bounded),
    ("relaxations[].sum_sq", Checked::Bounded),
    ("candidates[]", Checked::Bounded),
    ("candidates[].alternatives[]", Checked::Not),
    ("candidates[].error.max_at", Checked::Bounded),
    ("candidates[].costs[].rms_without", Checked::Bounded),
    ("front.axes", Checked::Bounded),
    ("front.points", Checked::Bounded),
    ("front.evaluations", Checked::Bounded),
    ("picks.evaluations", Checked::Bounded),
    ("front.members[]", Checked::Bounded),
    ("exact.census.not_told_apart", Checked::Not),
    ("exact.census.*", Checked::Bounded),
    ("certificate.lower_bound", Checked::Bounded),
    ("certificate.boxes", Checked::Bounded),
    ("certificate.wanted_gap", Checked::Bounded),
    ("certificate.leaves_sha256", Checked::Not),
    ("certificate.parts[].lower_bound", Checked::Bounded),
    ("certificate.parts[].closed", Checked::Bounded),
    ("certificate.parts[].boxes", Checked::Bounded),
    ("certificate.parts[].leaves_sha256", Checked::Not),
];

/// Returns the keys of a record that are checked to this extent. Lengths of lists are left out: the keys below the
/// lists cover them.
pub fn unchecked(record: &Record, how: Checked) -> Vec<&'static str> {
    let Ok(document) = serde_json::to_value(record) else { return Vec::new() };
    let asked = UNCHECKED.iter().filter(|(row, is)| *is == how && !row.ends_with("[]"));
    asked.map(|(row, _)| *row).filter(|row| holds(&document, row)).collect()
}

/// Returns whether a document has a key; of a list, whether one of its entries has it.
fn holds(value: &serde_json::Value, key: &str) -> bool {
    let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
    if first == "*" {
        return true;
    }
    let below = |value: &serde_json::Value| rest.is_none_or(|rest| holds(value, rest));
    match first.strip_suffix("[]") {
        None => value.get(first).is_some_and(below),
        Some(name) => {
            value.get(name).and_then(|list| list.as_array()).is_some_and(|list| list.iter().any(below))
        }
    }
}
