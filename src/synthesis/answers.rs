//! The parts of a record beside its ranked candidates: warnings, the family of exact answers, and a buildable
//! candidate.

use super::buildable::buildable;
use super::constants::buildable::{LEAST, SHARE};
use super::{Context, SearchOutcome};
use crate::judge::assess::{measure_beside, measure_curve};
use crate::judge::costs::marginal;
use crate::judge::family::family;
use crate::judge::symmetry::mirror_image_serves;
use crate::judge::warnings::warnings;
use crate::record::{Candidate, Family};
use crate::task::Problem;
use crate::task::spec::Method;

/// The results reported beside the ranked candidates.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// The family that the first candidate belongs to.
    pub family: Option<Family>,
    /// The best buildable candidate, if the first candidate has warnings.
    pub buildable: Option<Candidate>,
}

/// Annotates a candidate with its warnings and with whether its mirror image serves as well.
pub fn annotate(problem: &Problem, candidate: &mut Candidate) {
    candidate.warnings = warnings(problem, candidate);
    candidate.mirror_serves = mirror_image_serves(problem, candidate);
}

/// Gives a linkage that is not among the ranked candidates all that a record says of it: its distances to the whole
/// curve and to the points as they were given, the costs of its limits, and its annotations. It has no rank, no
/// cognates beside it and no certificate.
pub(super) fn complete(problem: &Problem, candidate: &mut Candidate) {
    (candidate.rank, candidate.alternatives, candidate.certified) = (0, Vec::new(), None);
    measure_curve(problem, candidate);
    candidate.costs = marginal(problem, candidate);
    measure_beside(problem, candidate);
    annotate(problem, candidate);
}

/// Annotates the candidates and returns the family and the buildable candidate.
///
/// If the first candidate has warnings, the method is `auto` and advice is asked for, a second search looks for a
/// buildable linkage. It uses a part of the evaluations that the first search used, if the budget still has them; they are
/// added to the outcome's. If the time limit or a cancellation cuts it short, that becomes the outcome's reason.
pub fn beside(context: Context<'_>, outcome: &mut SearchOutcome) -> Beside {
    let problem = context.problem;
    for candidate in &mut outcome.candidates {
        annotate(problem, candidate);
    }
    let family = outcome.candidates.first().and_then(|best| family(problem, best));
    let solve = &problem.spec().solve;
    if !solve.advice
        || solve.method != Method::Auto
        || outcome.candidates.first().is_none_or(|c| c.warnings.is_empty())
    {
        return Beside { family, buildable: None };
    }
    let used = outcome.evaluations.objective;
    let allowance = (used / SHARE).max(LEAST).min(used).min(solve.evaluations.saturating_sub(used));
    let mut found = buildable(context, &outcome.candidates, &outcome.others, allowance);
    outcome.evaluations += found.evaluations;
    if let Some(reason) = context.stop_reason().filter(|_| found.searched) {
        outcome.reason = reason;
    }
    if let Some(candidate) = &mut found.candidate {
        candidate.mirror_serves = mirror_image_serves(problem, candidate);
    }
    Beside { family, buildable: found.candidate }
}
