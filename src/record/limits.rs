//! What a record may hold: nothing that no run writes, so that a reader's work and memory are bounded by its file.

use super::{Candidate, MOST_MEMBERS, Picks, Record};
use crate::mechanism::MAX_MAGNITUDE;
use crate::task::spec::{MAX_CANDIDATES, MAX_POINTS, MAX_SMOOTHED};

/// The most entries of a list that has no limit of its own: classes of exact linkages, costs, changes.
const MAX_LIST: usize = 10_000;
/// The most alternatives of a candidate, and the most mechanisms of a class.
const MAX_FORMS: usize = 100;

/// A key of a record that is beyond its limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key} is {}, at most {} is read", shown(*found), shown(*limit))]
pub struct BeyondLimits {
    /// The key.
    pub key: String,
    /// What it has.
    pub found: f64,
    /// The most that it may have.
    pub limit: f64,
}

impl Record {
    /// The first key that is beyond its limit: a list that is too long, points that no problem has.
    pub fn beyond_limits(&self) -> Option<BeyondLimits> {
        let path = &self.problem.resolved.task;
        let raw = path.raw.as_ref();
        let smoothed = raw.is_some_and(|raw| raw.smooth.is_some());
        let exact = self.exact.as_ref();
        let counts = [
            ("problem.resolved.task.path.points", path.points.len(), MAX_POINTS),
            ("problem.resolved.task.function.output_deg", path.pairs().len(), MAX_POINTS),
            (
                "problem.resolved.task.path.raw.points",
                raw.map_or(0, |raw| raw.points.len()),
                if smoothed { MAX_SMOOTHED } else { MAX_POINTS },
            ),
            (
                "problem.resolved.task.path.raw.samples",
                raw.and_then(|raw| raw.samples).unwrap_or(0),
                MAX_POINTS,
            ),
            ("candidates", self.candidates.len(), MAX_CANDIDATES),
            ("relaxations", self.relaxations.len(), MAX_LIST),
            ("certificate.parts", self.certificate.as_ref().map_or(0, |c| c.parts.len()), MAX_FORMS),
            ("front.members", self.front.as_ref().map_or(0, |front| front.members.len()), MOST_MEMBERS),
            ("exact.linkages", exact.map_or(0, |exact| exact.linkages.len()), MAX_LIST),
        ];
        let long = counts.into_iter().find(|(_, found, limit)| found > limit);
        if let Some((key, found, limit)) = long {
            return Some(too_many(key.to_owned(), found, limit));
        }
        let points = path.points.iter().chain(raw.iter().flat_map(|raw| &raw.points)).flatten();
        if let Some(far) = points.copied().find(|v| v.is_nan() || v.abs() > MAX_MAGNITUDE) {
            let key = "a coordinate of problem.resolved.task.path".to_owned();
            return Some(BeyondLimits { key, found: far, limit: MAX_MAGNITUDE });
        }
        let forms = exact.iter().flat_map(|exact| &exact.linkages).enumerate().find_map(|(i, listed)| {
            let key = || format!("exact.linkages {}: others", i + 1);
            (listed.others.len() > MAX_FORMS).then(|| too_many(key(), listed.others.len(), MAX_FORMS))
        });
        let picks = self.picks.iter().flat_map(Picks::named).map(|(_, pick)| pick);
        let members = self.front.iter().flat_map(|front| &front.members).map(|member| &member.candidate);
        let all =
            self.candidates.iter().chain(&self.buildable).chain(&self.other_kind).chain(picks).chain(members);
        forms.or_else(|| all.into_iter().find_map(of_candidate))
    }
}

/// A count as it is, what is larger with its power of ten.
fn shown(value: f64) -> String {
    if value.abs() < 1e9 { value.to_string() } else { format!("{value:e}") }
}

fn too_many(key: String, found: usize, limit: usize) -> BeyondLimits {
    BeyondLimits { key, found: found as f64, limit: limit as f64 }
}

fn of_candidate(candidate: &Candidate) -> Option<BeyondLimits> {
    let counts = [
        ("crank_deg", candidate.crank_deg.len(), MAX_POINTS),
        ("t1_at", candidate.t1_at.len(), MAX_POINTS),
        ("alternatives", candidate.alternatives.len(), MAX_FORMS),
        ("warnings", candidate.warnings.len(), MAX_LIST),
        ("requirements", candidate.requirements.len(), MAX_LIST),
        ("costs", candidate.costs.len(), MAX_LIST),
    ];
    let (key, found, limit) = counts.into_iter().find(|(_, found, limit)| found > limit)?;
    Some(too_many(format!("candidate {}: {key}", candidate.rank), found, limit))
}
