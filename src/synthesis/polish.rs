//! Polish after a search by least squares: minimises the largest deviation, brings answers within tolerances, and gains
//! the last digits of answers on which a limit is active.
//!
//! From a start or a judged candidate it computes a better one of the same basin, by sequential convex programming
//! ([`crate::numbers::optimise::convex`]) under all requirements.

use super::Context;
use super::constants::polish::{
    BASINS, EVALUATIONS, FUNCTION_BASINS, FUNCTION_HOPPED, HOP, HOPPED, HOPS, INSIDE, LEAST_BASINS, MAX_HOPS,
    QUIET_HOPS, SAME_DEVIATION, SAME_START, SHARE, STEPS,
};
use super::fit_state::{FitState, Fitted, Until, moved_scales};
use super::multistart::{by_merit, fit_and_judge, judged};
use crate::judge::error::structural_error;
use crate::judge::rank::{compare, distinct, exact_cost, exact_objective};
use crate::judge::warm::start_at;
use crate::mechanism::FourBar;
use crate::numbers::arithmetic::streams::{Stream, stream, uniform};
use crate::numbers::optimise::convex::{ConvexOptions, ConvexOutcome, Goal, solve};
use crate::numbers::optimise::levenberg_marquardt::BlockLeastSquares;
use crate::record::{Candidate, Evaluations, Figure};
use crate::task::Problem;
use crate::task::forms::fits::{FitUser, Kept, design_of, on_fit, own_scales};
use crate::task::forms::start::Start;
use crate::task::forms::torus::{PathFit, Positions};
use crate::task::requirement::RequirementKind;
use crate::task::spec::Objective;
use std::array::from_fn;

/// The random stream of the first round of hops; those of a multistart count up from 0.
const FIRST_HOP: u64 = 1 << 62;
/// Relative margin inside the tolerances at which a polish aims.
const TOLERANCE_MARGIN: f64 = 1e-9;
/// Least tolerance aimed at, in parts of the target's size; used for a tolerance of zero.
const LEAST_TOLERANCE: f64 = 1e-10;
/// The first half width of the trust box for the frame of a body, in radians.
const FRAME_TRUST: f64 = 0.1;
/// Distance of a value from its limit, in parts of max(1, |limit|), within which the limit is active.
const AT_LIMIT: f64 = 1e-4;

/// Returns the evaluations of a budget that a search by least squares leaves to [`improve`].
pub fn reserve(problem: &Problem, evaluations: u64) -> u64 {
    let wanted = problem.spec().solve.objective == Objective::MaxDeviation || problem.task().has_tolerances();
    if wanted { evaluations / SHARE } else { 0 }
}

/// Returns the number of distinct optima that a search by least squares has to find: the answers that are wanted, or,
/// if the largest deviation or tolerances decide, enough of them to polish.
pub fn basins_wanted(problem: &Problem) -> usize {
    let wanted = problem.spec().solve.candidates;
    if reserve(problem, SHARE) > 0 { wanted.max(LEAST_BASINS) } else { wanted }
}

/// Returns whether a candidate is accepted, or would be if its polish brought it within the tolerances.
pub fn promising(problem: &Problem, candidate: &Candidate) -> bool {
    let forbidden = candidate.defects.iter().any(|d| problem.spec().require.forbids(d));
    !forbidden && candidate.requirements.iter().all(|r| r.met || RequirementKind::names_tolerance(&r.name))
}

/// Returns the tolerances by which deviations are measured: 1 if none are given. In a motion two a target: of the place,
/// and of the angle as the length that it counts like; infinite where only the other one is limited. In a function one
/// pair's: of its output, in degrees.
fn measures(problem: &Problem) -> Vec<f64> {
    let task = problem.task();
    let least = LEAST_TOLERANCE * task.error_size();
    let inside = |t: f64| (t * (1.0 - TOLERANCE_MARGIN)).max(least);
    let Some(body) = task.body() else {
        return match task.tolerances() {
            None => vec![1.0; task.len()],
            Some(tolerances) => tolerances.iter().copied().map(inside).collect(),
        };
    };
    let unless_given = if task.has_tolerances() { f64::INFINITY } else { 1.0 };
    if problem.is_function() {
        let each = |j: usize| body.tolerances.as_ref().map_or(1.0, |t| inside(body.angle_weight * t[j]));
        return (0..task.len()).map(each).collect();
    }
    let both = |j: usize| {
        let place = task.tolerances().map_or(unless_given, |tolerances| inside(tolerances[j]));
        let angle = body.tolerances.as_ref().map_or(unless_given, |t| inside(body.angle_weight * t[j]));
        [place, if body.angles[j].is_some() { angle } else { f64::INFINITY }]
    };
    (0..task.len()).flat_map(both).collect()
}

/// Minimises the largest deviation, in parts of the tolerances if there are any, until it has converged or, within
/// tolerances, is below `enough`.
///
/// The merit is that deviation, plus the violation of the requirements in sizes of the target.
fn deviation_polish<S: FitState>(
    context: Context<'_>,
    start: &S,
    enough: f64,
    evaluations: u64,
) -> Fitted<S> {
    let tolerances = measures(context.problem);
    let until = Until { good_enough: enough, evaluations };
    start.convex(context, &Goal::MaxDeviation { tolerances: &tolerances }, until).0
}

/// Brings a start to the optimum of its basin under all requirements: the least largest deviation, or the least sum of
/// squares within the tolerances; if these cannot be met, the least largest deviation.
pub fn finish<S: FitState>(context: Context<'_>, start: &S, evaluations: u64) -> Fitted<S> {
    let problem = context.problem;
    let floor = 1e-3 * exact_objective(problem);
    match (problem.spec().solve.objective, problem.task().has_tolerances()) {
        (Objective::MaxDeviation, _) => deviation_polish(context, start, floor, evaluations),
        (Objective::SumOfSquares, false) => {
            let exact = 1e-6 * exact_cost(problem);
            start.convex(context, &Goal::SumOfSquares, Until { good_enough: exact, evaluations }).0
        }
        (Objective::SumOfSquares, true) => {
            let tolerances = measures(problem);
            let nearest = deviation_polish(context, start, INSIDE, evaluations);
            let left = evaluations.saturating_sub(nearest.evaluations);
            let Some(inside) = &nearest.end else { return nearest };
            if nearest.merit > 1.0 || left == 0 {
                return nearest;
            }
            let goal = Goal::SumOfSquaresWithin { tolerances: &tolerances };
            let exact = 1e-6 * exact_cost(problem);
            let (within, deviation) =
                inside.convex(context, &goal, Until { good_enough: exact, evaluations: left });
            let spent = nearest.evaluations + within.evaluations;
            if within.end.is_none() || deviation > 1.0 + TOLERANCE_MARGIN {
                return Fitted { evaluations: spent, ..nearest };
            }
            Fitted { evaluations: spent, ..within }
        }
    }
}

impl FitState for Start {
    fn of(problem: &Problem, candidate: &Candidate) -> Option<Start> {
        start_at(problem, candidate)
    }

    fn judged(&self, problem: &Problem) -> Option<Candidate> {
        judged(problem, self)
    }

    fn moved(&self, problem: &Problem, draws: &mut Stream) -> Start {
        let space = problem.space(self.setting.side);
        let trust = space.trust(problem.task().size());
        let mut near = self.clone();
        for ((value, trust), &(low, high)) in near.design.iter_mut().zip(trust).zip(space.bounds()) {
            let by = HOP * trust.max(0.1 * value.abs()) * uniform(draws, -1.0, 1.0);
            *value = (*value + by).max(low).min(high);
        }
        near.scales = moved_scales(problem, near.scales, HOP * FRAME_TRUST, draws);
        near
    }

    fn convex(&self, context: Context<'_>, goal: &Goal<'_>, until: Until) -> (Fitted, f64) {
        const NONE: (Fitted, f64) = (Fitted::NONE, f64::INFINITY);
        let (problem, mut start) = (context.problem, self.clone());
        let held = &mut start.positions;
        let settles = !held.is_empty() && !problem.task().is_partly_timed();
        if settles && !PathFit::new(problem, start.setting).settle(&start.design, held) {
            return NONE;
        }
        let polishing = Polishing { context, start: &start, goal, until };
        let kept = if problem.task().body().is_some() { Kept::OrderAndBranch } else { Kept::Nothing };
        on_fit(problem, &start, kept, polishing).unwrap_or(NONE)
    }
}

/// Fits from a start by sequential convex programming.
struct Polishing<'a> {
    context: Context<'a>,
    start: &'a Start,
    goal: &'a Goal<'a>,
    until: Until,
}

impl FitUser for Polishing<'_> {
    type Output = (Fitted, f64);

    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> (Fitted, f64)
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        let Polishing { context, start: Start { setting, positions, .. }, goal, .. } = self;
        let size = context.problem.task().size();
        let of_design = context.problem.space(setting.side).trust(size);
        let options = ConvexOptions {
            max_steps: STEPS,
            max_evaluations: self.until.evaluations,
            trust: from_fn(|i| of_design.get(i).copied().unwrap_or(FRAME_TRUST)),
            length: size,
            relative_reduction: 1e-11,
            feasibility: 1e-9 * size,
            good_enough: self.until.good_enough,
        };
        let end = solve(fit, goal, x, positions.clone(), &options, &|| context.stopped());
        let usable = !matches!(end.outcome, ConvexOutcome::NoStart | ConvexOutcome::Stopped);
        let fitted = Fitted {
            merit: end.objective + end.violation / size,
            evaluations: end.evaluations,
            end: usable.then_some(Start {
                design: design_of(&end.x),
                setting: *setting,
                positions: end.state,
                scales: own_scales(&end.x),
            }),
        };
        (fitted, end.deviation)
    }
}

/// Returns whether a limit is active at a candidate: then the last digits are worth a polish.
fn held(candidate: &Candidate) -> bool {
    let at = |value: f64, limit: f64| (value - limit).abs() <= AT_LIMIT * limit.abs().max(1.0);
    let mut told = candidate.requirements.iter().filter(|r| !RequirementKind::names_line(&r.name));
    told.any(|r| match (&r.value, &r.limit) {
        (Figure::Number(value), Figure::Number(limit)) => at(*value, *limit),
        (Figure::Number(value), Figure::Numbers(limits)) => {
            let fixed = limits.iter().all(|limit| Some(limit) == limits.first());
            !fixed && limits.iter().any(|limit| at(*value, *limit))
        }
        (Figure::Numbers(values), Figure::Numbers(limits)) => {
            values.iter().zip(limits).any(|(value, limit)| at(*value, *limit))
        }
        _ => false,
    })
}

/// Polishes the candidates of a search for the objective and the tolerances, and adds the results.
///
/// `limit` is the budget of evaluations, of which `evaluations` are used; it is not exceeded. The best `BASINS`
/// distinct candidates are polished in parallel, then starts around the best results, until these bring no improvement
/// or the tolerances are met. If neither tolerances nor the largest deviation need it, only accepted candidates at an
/// active limit are polished.
///
/// Candidates of other kinds than the state's are left as they are.
pub(super) fn improve<S: FitState>(
    context: Context<'_>,
    found: &mut Vec<Candidate>,
    evaluations: &mut Evaluations,
    limit: u64,
) {
    let problem = context.problem;
    let left = limit.saturating_sub(evaluations.objective);
    if left == 0 || found.is_empty() {
        return;
    }
    let deviation = problem.spec().solve.objective == Objective::MaxDeviation;
    let (basins, hopped, quiet_hops) = match problem.is_function() {
        true => (FUNCTION_BASINS, FUNCTION_HOPPED, 1),
        false => (BASINS, HOPPED, QUIET_HOPS),
    };
    let toleranced = problem.task().has_tolerances();
    let worth: Vec<Candidate> = if deviation || toleranced {
        // Unless the largest deviation is the objective, an accepted candidate has no more to gain.
        let open = |c: &&Candidate| promising(problem, c) && (deviation || !c.accepted);
        let promising: Vec<&Candidate> = found.iter().filter(open).collect();
        if !deviation && found.iter().any(|c| c.accepted) {
            let wanted = problem.spec().solve.candidates;
            if promising.is_empty() || distinct(problem, found.clone(), wanted).len() == wanted {
                return;
            }
        }
        let all = if promising.is_empty() { found.iter().collect() } else { promising };
        optima(problem, &all).into_iter().take(basins).cloned().collect()
    } else {
        let mut held: Vec<Candidate> = found.iter().filter(|c| c.accepted && held(c)).cloned().collect();
        held.sort_by(|one, other| compare(problem, one, other));
        distinct(problem, held, problem.spec().solve.candidates)
    };
    let starts = worth.iter().filter_map(|candidate| S::of(problem, candidate)).collect();
    polish_all::<S>(context, starts, found, evaluations, limit);
    if !(deviation || toleranced) {
        return;
    }
    // The largest deviation has many optima in one basin of least squares: start around the best.
    let mut best = f64::INFINITY;
    let mut quiet = 0;
    for hop in 0..MAX_HOPS {
        let mut near = by_deviation(problem, found.iter().filter(|c| promising(problem, c)));
        near.dedup_by(|one, other| (one.0 - other.0).abs() <= SAME_DEVIATION * other.0);
        let Some(&(least, _)) = near.first() else { return };
        let done = toleranced && !deviation && found.iter().any(|c| c.accepted);
        if done || least <= exact_objective(problem) || context.stopped() {
            return;
        }
        quiet = if least < best * (1.0 - SAME_DEVIATION) { 0 } else { quiet + 1 };
        best = best.min(least);
        if quiet >= quiet_hops {
            return;
        }
        let mut draws = stream(problem.spec().solve.seed, FIRST_HOP + hop);
        let mut starts = Vec::new();
        for (_, candidate) in near.into_iter().take(hopped) {
            let Some(start) = S::of(problem, candidate) else { continue };
            // The last start is the candidate itself, with the curvature estimate reset.
            for _ in 1..HOPS {
                starts.push(start.moved(problem, &mut draws));
            }
            starts.push(start);
        }
        let before = evaluations.objective;
        polish_all::<S>(context, starts, found, evaluations, limit);
        if evaluations.objective == before {
            return;
        }
    }
}

/// Returns the candidates that differ in more than digits, least deviation first. One curve may occur several times:
/// cognates and points along a valley of least squares lead to different largest deviations.
fn optima<'c>(problem: &Problem, all: &[&'c Candidate]) -> Vec<&'c Candidate> {
    let mut kept: Vec<(f64, &Candidate)> = Vec::new();
    for (deviation, candidate) in by_deviation(problem, all.iter().copied()) {
        let near = |one: f64, other: f64| (one - other).abs() <= SAME_START * other.abs();
        let same = kept.iter().any(|(other, c)| {
            near(deviation, *other)
                && near(candidate.link_ratio, c.link_ratio)
                && candidate.linkage.assembly() == c.linkage.assembly()
                && candidate.linkage.four_bar().map(FourBar::side) == c.linkage.four_bar().map(FourBar::side)
        });
        if !same {
            kept.push((deviation, candidate));
        }
    }
    kept.into_iter().map(|(_, candidate)| candidate).collect()
}

/// Returns candidates with their largest errors, in parts of the tolerances if there are any, the least first.
fn by_deviation<'c>(
    problem: &Problem,
    candidates: impl Iterator<Item = &'c Candidate>,
) -> Vec<(f64, &'c Candidate)> {
    let task = problem.task();
    let deviation = |candidate: &Candidate| {
        structural_error(problem, candidate).map_or(f64::INFINITY, |error| error.deviation(task))
    };
    let mut measured: Vec<(f64, &Candidate)> = candidates.map(|c| (deviation(c), c)).collect();
    by_merit(&mut measured, usize::MAX);
    measured
}

/// Polishes starts in parallel, each with its share of the rest of `limit`, and adds the results.
fn polish_all<S: FitState>(
    context: Context<'_>,
    mut starts: Vec<S>,
    found: &mut Vec<Candidate>,
    evaluations: &mut Evaluations,
    limit: u64,
) {
    let left = limit.saturating_sub(evaluations.objective);
    starts.truncate(usize::try_from(left).unwrap_or(usize::MAX));
    let each = (left / starts.len().max(1) as u64).min(EVALUATIONS);
    fit_and_judge(context, starts, |start| finish(context, &start, each), found, evaluations);
}
