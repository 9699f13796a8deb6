//! Fits of linkages with a slider for the largest deviation and within tolerances, by sequential convex programming.

use super::fits::{aligned, fit_of, judged, ranged_fit_of, start_at};
use super::starts::{Start, Target};
use crate::numbers::arithmetic::streams::{Stream, uniform};
use crate::numbers::optimise::convex::{ConvexOptions, ConvexOutcome, ConvexResult, Goal, solve};
use crate::record::Candidate;
use crate::synthesis::Context;
use crate::synthesis::constants::polish::{HOP, STEPS};
use crate::synthesis::fit_state::{FitState, Fitted, Until, moved_scales};
use crate::task::Problem;
use crate::task::forms::slider::fit::settle;
use crate::task::forms::slider::limits::Limited;
use crate::task::forms::slider::ranged::{WITH_SCALES, joined, parted};
use crate::task::forms::slider::shape::{SliderShape, UNKNOWNS};
use crate::task::forms::torus::Positions;
use crate::task::{Output, Timing};

/// The first half width of the trust box: of lengths in sizes of the target, of angles in radians.
const TRUST: f64 = 0.1;

impl FitState for Start {
    fn of(problem: &Problem, candidate: &Candidate) -> Option<Start> {
        start_at(problem, &Target::of(problem), candidate)
    }

    fn judged(&self, problem: &Problem) -> Option<Candidate> {
        judged(problem, &Target::of(problem), self)
    }

    fn moved(&self, problem: &Problem, draws: &mut Stream) -> Start {
        let target = Target::of(problem);
        let limits = Limited::of(problem, self.kind, target.centre, target.size);
        let mut near = self.clone();
        for (value, &(low, high)) in near.x.iter_mut().zip(&limits.bounds) {
            let by = HOP * TRUST * value.abs().max(1.0) * uniform(draws, -1.0, 1.0);
            *value = (*value + by).max(low).min(high);
        }
        near.scales = moved_scales(problem, near.scales, HOP * TRUST, draws);
        near
    }

    fn convex(&self, context: Context<'_>, goal: &Goal<'_>, until: Until) -> (Fitted<Start>, f64) {
        let target = Target::of(context.problem);
        let task = (context, &target);
        // A tolerance limits two rows, of a function the second is zero.
        match &target.body {
            None => fitted::<2>(task, self, goal, until),
            Some(_) => fitted::<3>(task, self, goal, until),
        }
    }
}

/// As [`FitState::convex`] with R rows a target.
fn fitted<const R: usize>(
    (context, target): (Context<'_>, &Target),
    from: &Start,
    goal: &Goal<'_>,
    Until { good_enough, evaluations }: Until,
) -> (Fitted<Start>, f64) {
    const NONE: (Fitted<Start>, f64) = (Fitted::NONE, f64::INFINITY);
    let problem = context.problem;
    let limits = Limited::of(problem, from.kind, target.centre, target.size).turning(from.turns);
    let is_of_places = target.outputs.as_ref().is_some_and(|outputs| outputs.kind == Output::Place);
    let mut start = aligned(&limits, is_of_places, from.clone());
    let Some(shape) = SliderShape::of(start.kind, &start.x) else { return NONE };
    let is_free = matches!(problem.task().timing(), Timing::Free);
    if is_free && !settle(&shape, &mut start.positions) {
        return NONE;
    }
    // The fit has sizes of the target for its unit.
    let unit_sq = target.unit_sq();
    let in_units =
        |tolerances: &[f64]| -> Vec<f64> { tolerances.iter().map(|t| t / unit_sq.sqrt()).collect() };
    let tolerances = match goal {
        Goal::SumOfSquares => Vec::new(),
        Goal::MaxDeviation { tolerances } | Goal::SumOfSquaresWithin { tolerances } => in_units(tolerances),
    };
    let (goal, good_enough) = match goal {
        Goal::SumOfSquares => (Goal::SumOfSquares, good_enough / unit_sq),
        // A largest deviation is in parts of the tolerances.
        Goal::MaxDeviation { .. } => (Goal::MaxDeviation { tolerances: &tolerances }, good_enough),
        Goal::SumOfSquaresWithin { .. } => {
            (Goal::SumOfSquaresWithin { tolerances: &tolerances }, good_enough / unit_sq)
        }
    };
    let positions = start.positions.clone();
    if let Some(fit) = ranged_fit_of::<R>(problem, target, &limits, &start) {
        let (x, options) = (joined(&start.x, start.scales), options::<WITH_SCALES>(evaluations, good_enough));
        let end = solve(&fit, &goal, x, positions, &options, &|| context.stopped());
        return ended(&end, |x, positions| {
            let (x, scales) = parted(x);
            Start { x, positions, scales, ..start }
        });
    }
    let fit = fit_of::<R>(problem, target, &limits, &start);
    let options = options::<UNKNOWNS>(evaluations, good_enough);
    let end = solve(&fit, &goal, start.x, positions, &options, &|| context.stopped());
    ended(&end, |x, positions| Start { x: *x, positions, ..start })
}

/// Returns the options of a fit in units of the target's size.
fn options<const N: usize>(max_evaluations: u64, good_enough: f64) -> ConvexOptions<N> {
    ConvexOptions {
        max_steps: STEPS,
        max_evaluations,
        trust: [TRUST; N],
        length: 1.0,
        relative_reduction: 1e-11,
        feasibility: 1e-9,
        good_enough,
    }
}

/// Returns the end of a fit with its largest deviation.
fn ended<const N: usize>(
    end: &ConvexResult<N, Positions>,
    start: impl FnOnce(&[f64; N], Positions) -> Start,
) -> (Fitted<Start>, f64) {
    let usable = !matches!(end.outcome, ConvexOutcome::NoStart | ConvexOutcome::Stopped);
    let fitted = Fitted {
        merit: end.objective + end.violation,
        evaluations: end.evaluations,
        end: usable.then(|| start(&end.x, end.state.clone())),
    };
    (fitted, end.deviation)
}
