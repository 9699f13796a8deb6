//! The unknowns of a linkage in the fits of its kind, and the end of such a fit: what polishes of four-bars and of linkages with a
//! slider have in common.

use super::Context;
use crate::numbers::arithmetic::streams::{Stream, uniform};
use crate::numbers::optimise::convex::Goal;
use crate::record::Candidate;
use crate::task::Problem;
use crate::task::forms::start::Start;
use crate::task::ranges::Scales;

/// The unknowns of a linkage in the fits of its kind: the start of a fit, or its end.
pub trait FitState: Clone + Send + Sync {
    /// Returns the state at which a candidate stands; `None` of a candidate of another kind, or if its loop is open at a target.
    fn of(problem: &Problem, candidate: &Candidate) -> Option<Self>;

    /// Returns the candidate that stands there, judged; `None` if it cannot be judged.
    fn judged(&self, problem: &Problem) -> Option<Candidate>;

    /// Returns a random state near this one, in its bounds.
    fn moved(&self, problem: &Problem, draws: &mut Stream) -> Self;

    /// Fits by sequential convex programming; returns the end and its largest deviation.
    fn convex(&self, context: Context<'_>, goal: &Goal<'_>, until: Until) -> (Fitted<Self>, f64);
}

/// The end of a fit by sequential convex programming before it has converged.
#[derive(Clone, Copy, Debug)]
pub struct Until {
    /// The objective of the goal, in the problem's units, that is good enough.
    pub good_enough: f64,
    /// The most evaluations.
    pub evaluations: u64,
}

/// Returns random scales of a function's inputs and outputs near others, within the bounds of their ranges; those that are as
/// written draw nothing. `reach` is the largest relative change.
pub(super) fn moved_scales(problem: &Problem, scales: Scales, reach: f64, draws: &mut Stream) -> Scales {
    let ranges = problem.task().ranges();
    if ranges.are_written() {
        return scales;
    }
    ranges.nearest(scales.map(|scale| scale * (1.0 + reach * uniform(draws, -1.0, 1.0))))
}

/// The end of a local fit.
#[derive(Clone, Debug)]
pub struct Fitted<S = Start> {
    /// The end point; `None` if it could not start or was given up.
    pub end: Option<S>,
    /// The merit function, cost plus violation, for comparing ends.
    pub merit: f64,
    /// Evaluations of the cost.
    pub evaluations: u64,
}

impl<S> Fitted<S> {
    /// The end of a fit that cannot start.
    pub(super) const NONE: Fitted<S> = Fitted { end: None, merit: f64::INFINITY, evaluations: 0 };
}
