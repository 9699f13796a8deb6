//! The picks beside the closest candidate, in words.

use super::text::significant;
use super::words;
use crate::judge::figures::extent;
use crate::record::{Candidate, Pick, Record};
use crate::task::Problem;

/// The picks that have an error limit in common.
pub(super) const BOTH: [Pick; 2] = [Pick::Smallest, Pick::BestTransmission];

/// Returns a line for each pick that is not the closest candidate, and a sentence on those that are; empty without
/// picks.
pub(super) fn lines(record: &Record) -> Vec<String> {
    let Some(closest) = record.candidates.first().filter(|_| record.picks.is_some()) else {
        return Vec::new();
    };
    let Ok(problem) = Problem::new(record.problem.resolved.clone()) else { return Vec::new() };
    let is_closest = |pick: &Pick| record.pick(*pick).is_some_and(|c| c.rank == 1);
    let same: Vec<&str> = BOTH.into_iter().filter(is_closest).map(named).collect();
    let mut lines = Vec::new();
    if !same.is_empty() {
        lines.push(format!("#1 is also the {} {}", same.join(" and the "), within(record)));
    }
    for pick in BOTH {
        if let Some(candidate) = record.pick(pick).filter(|c| c.rank != 1) {
            lines.push(line(record, &problem, pick, candidate, closest));
        }
    }
    lines
}

/// Returns the limit on the error of a pick: `within 1.5 times the least error`, or `within the tolerance`.
pub(super) fn within(record: &Record) -> String {
    match record.picks.as_ref().and_then(|picks| picks.within) {
        Some(_) => {
            let factor = record.problem.resolved.solve.picks_within;
            format!("within {factor} times the least error")
        }
        None => "within the tolerance".to_owned(),
    }
}

fn named(pick: Pick) -> &'static str {
    match pick {
        Pick::BestTransmission => "best transmitting one",
        other => other.words(),
    }
}

/// Returns a line such as `smallest within 1.5 times the least error: rms 0.1, extent 20 (#1: 31), worst transmission
/// angle 41 deg (#1: 35); linkage-smallest.toml`.
fn line(
    record: &Record,
    problem: &Problem,
    pick: Pick,
    candidate: &Candidate,
    closest: &Candidate,
) -> String {
    let (unit, of_errors) = (words::unit_suffix(record), words::error_unit(record));
    let place = if candidate.rank > 0 { format!(" (#{})", candidate.rank) } else { String::new() };
    let angle_error = words::angle_errors(candidate).map_or(String::new(), |said| format!(", {said}"));
    let [own, other] = [candidate, closest].map(|c| significant(extent_of(problem, c), 4));
    let [angle, other_angle] = [candidate, closest].map(|c| significant(c.transmission_deg.worst, 3));
    format!(
        "{}{place} {}: rms {}{of_errors}{angle_error}, extent {own}{unit} (#1: {other}), worst transmission angle {angle} deg (#1: \
         {other_angle}); linkage-{}.toml",
        pick.words(),
        within(record),
        significant(candidate.error.rms, 4),
        pick.name(),
    )
}

/// Returns the extent of a candidate; not a number if it has no position for every point.
pub(super) fn extent_of(problem: &Problem, candidate: &Candidate) -> f64 {
    let n = problem.task().len();
    let is_whole = candidate.crank_deg.len() >= n && candidate.t1_at.len() >= n;
    if is_whole { extent(problem, candidate) } else { f64::NAN }
}
