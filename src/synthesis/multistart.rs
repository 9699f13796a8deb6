//! Multistart: Levenberg-Marquardt fits from many starts, in rounds.
//!
//! A round draws `SCREEN` starts from its own stream of the seed, keeps the `SHORT` that promise most, fits each
//! for a few steps and the best `LONG` of them to convergence. Rounds run in parallel in batches of a fixed size and
//! are read in their order, so the number of threads changes nothing but the time.

pub use super::constants::Effort;
pub use super::constants::free::MIDDLE_FIT;
pub use super::constants::multistart::{LONG_FIT, SHORT_FIT};

use super::Context;
use super::constants::multistart::{LONG, SCREEN, SETTLING, SHORT, SUGGESTED_LONG, SUGGESTED_SHORT};
use super::fit_state::{FitState, Fitted};
use super::polish::reserve;
use super::starts::Starts;
use crate::judge::assess::assess_on_curve;
use crate::judge::rank::exact_cost;
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::FourBar;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::numbers::arithmetic::streams::stream;
use crate::numbers::optimise::levenberg_marquardt::{BlockLeastSquares, LmOptions, LmOutcome, solve};
use crate::record::{Candidate, CurveErrorRecord, ErrorRecord, Evaluations};
use crate::task::forms::design_space::Design;
use crate::task::forms::fits::{FitUser, Kept, design_of, on_fit, own_scales};
use crate::task::forms::rows::assembly_of;
use crate::task::forms::start::Start;
use crate::task::forms::timed::TimedPathFit;
use crate::task::forms::torus::{MotionFit, PathFit, Positions};
use crate::task::ranges::Reference;
use crate::task::spec::Objective;
use crate::task::{AngleOffset, Problem, Setting, Timing};
use rayon::prelude::*;

/// The candidates found in a round, and its cost.
#[derive(Clone, Debug, Default)]
pub struct RoundOutcome {
    /// Judged candidates, in the order of their starts' promise.
    pub found: Vec<Candidate>,
    /// Starts drawn, also those that could not be assembled.
    pub draws: u64,
    /// The evaluations used.
    pub evaluations: Evaluations,
}

/// Returns the options of a fit; `exact_cost` is the cost below which nothing is left to gain.
fn options(problem: &Problem, effort: Effort, max_evaluations: u64) -> LmOptions {
    let task = problem.task();
    // On a grid the answer is fitted again to the points as they were given.
    let nothing_left = if problem.grid() > 0.0 { 1.0 } else { 1e-6 };
    LmOptions {
        max_steps: effort.steps,
        max_rounds: effort.rounds,
        max_evaluations,
        relative_reduction: effort.relative_reduction,
        exact_cost: nothing_left * exact_cost(problem),
        feasibility: 1e-9 * task.size(),
        // A mean error above a fifth of the size after half of the steps is hopeless.
        hopeless_cost: 0.04 * task.weights().iter().sum::<f64>() * task.error_size().powi(2),
    }
}

/// Runs fits within an allowance of evaluations and counts their cost.
pub(super) struct Spender<'a> {
    context: Context<'a>,
    /// The evaluations used.
    pub(super) cost: Evaluations,
    allowance: u64,
    /// The best error known, beside which a fit may be worth more evaluations than others; 0 if there is none.
    pub(super) best: f64,
}

impl<'a> Spender<'a> {
    /// Creates a spender that has used nothing of its allowance.
    pub(super) fn new(context: Context<'a>, allowance: u64) -> Self {
        Spender { context, cost: Evaluations::default(), allowance, best: 0.0 }
    }

    /// As [`Spender::new`] where the best error is known, or infinite if it is not.
    pub(super) fn beside(context: Context<'a>, allowance: u64, best: f64) -> Self {
        Spender { best: if best.is_finite() { best } else { 0.0 }, ..Spender::new(context, allowance) }
    }

    /// Returns the evaluations left.
    pub(super) fn left(&self) -> u64 {
        self.allowance.saturating_sub(self.cost.objective)
    }

    /// Returns whether no further fit begins: nothing is left, or the search should end.
    pub(super) fn is_at_its_end(&self) -> bool {
        self.context.stopped() || self.left() == 0
    }

    /// Counts evaluations on the points of a problem.
    pub(super) fn spend(&mut self, problem: &Problem, evaluations: u64) {
        self.cost += self.context.of(problem).cost(evaluations);
    }

    /// Fits from a start with at most `most` of the evaluations left, and returns the end with its merit; `None` if it
    /// is given up, or no fit may begin.
    pub(super) fn fit(
        &mut self,
        problem: &Problem,
        start: Start,
        effort: Effort,
        most: u64,
    ) -> Option<(f64, Start)> {
        if self.is_at_its_end() {
            return None;
        }
        let fit = polish(self.context.of(problem), start, effort, self.left().min(most));
        self.spend(problem, fit.evaluations);
        fit.end.map(|end| (fit.merit, end))
    }

    /// As [`Spender::fit`] with all that is left; if that is nothing, returns the start with its merit as it is.
    fn fit_or_keep(&mut self, (merit, start): (f64, Start), effort: Effort) -> Option<(f64, Start)> {
        if self.left() == 0 && !self.context.stopped() {
            return Some((merit, start));
        }
        self.fit(self.context.problem, start, effort, u64::MAX)
    }
}

/// Runs round `index` of the seed with at most `allowance` evaluations.
pub fn round(context: Context<'_>, starts: &Starts<'_>, index: u64, allowance: u64) -> RoundOutcome {
    let problem = context.problem;
    let mut spender = Spender::new(context, allowance);
    let mut outcome = RoundOutcome::default();
    let mut stream = stream(problem.spec().solve.seed, index);
    let mut screened: Vec<(f64, Start)> = Vec::with_capacity(SCREEN);
    // The first round takes those that the task suggests.
    let mut suggested = if index == 0 { starts.suggested() } else { Vec::new() }.into_iter();
    let suggests = suggested.len() > 0;
    let (short, long) = if suggests { (SUGGESTED_SHORT, SUGGESTED_LONG) } else { (SHORT, LONG) };
    while outcome.draws < SCREEN as u64 && !spender.is_at_its_end() {
        let next = if suggests { suggested.next() } else { starts.draw(&mut stream) };
        if next.is_none() && suggests {
            break;
        }
        outcome.draws += 1;
        let Some(mut start) = next else { continue };
        spender.spend(problem, 1);
        screened.extend(promise(problem, &mut start).map(|promise| (promise, start)));
    }
    by_merit(&mut screened, short);
    let mut fitted: Vec<(f64, Start)> =
        screened.into_iter().filter_map(|start| spender.fit_or_keep(start, SHORT_FIT)).collect();
    by_merit(&mut fitted, long);
    let judging = context.judging();
    for start in fitted {
        let end = spender.fit_or_keep(start, LONG_FIT).filter(|_| judging.may_go_on());
        outcome.found.extend(end.and_then(|(_, end)| glanced(problem, &end)));
    }
    outcome.evaluations = spender.cost;
    outcome
}

/// Sorts ends by their merit, the least first, and keeps so many.
pub(super) fn by_merit<T>(ends: &mut Vec<(f64, T)>, keep: usize) {
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    ends.truncate(keep);
}

/// Fits starts in parallel, judges the ends, and adds them to the candidates and their cost to the evaluations. Once the
/// search is stopped, no further fit begins, and only a few ends are judged.
pub(super) fn fit_and_judge<S: Send, E: FitState>(
    context: Context<'_>,
    starts: Vec<S>,
    fit: impl Fn(S) -> Fitted<E> + Sync,
    found: &mut Vec<Candidate>,
    evaluations: &mut Evaluations,
) {
    let judging = context.judging();
    let fitted: Vec<(Option<Candidate>, u64)> = starts
        .into_par_iter()
        .map(|start| {
            if context.stopped() {
                return (None, 0);
            }
            let fit = fit(start);
            let end = fit.end.filter(|_| judging.may_go_on());
            (end.and_then(|end| end.judged(context.problem)), fit.evaluations)
        })
        .collect();
    for (candidate, used) in fitted {
        *evaluations += context.cost(used);
        found.extend(candidate);
    }
}

/// Returns the promise of a start, by which starts are screened: the cost plus the squared violation of the
/// requirements, in the units of the cost; `None` if it has no cost.
pub(super) fn promise(problem: &Problem, start: &mut Start) -> Option<f64> {
    let task = problem.task();
    let weight: f64 = task.weights().iter().sum();
    let scale = weight * task.error_size().powi(2);
    let held = &mut start.positions;
    let settles = !held.is_empty() && !task.is_partly_timed();
    if settles && !PathFit::new(problem, start.setting).settle(&start.design, held) {
        return None;
    }
    let (cost, lack) = on_fit(problem, start, Kept::Nothing, Screening { positions: &start.positions })??;
    let lack = lack / task.size();
    Some(cost + scale * lack * lack)
}

/// Computes the cost of a start and the total violation of its requirements, a length; `None` if it has no cost.
struct Screening<'a> {
    positions: &'a Positions,
}

impl FitUser for Screening<'_> {
    type Output = Option<(f64, f64)>;

    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> Self::Output
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        let cost = fit.cost(&x, self.positions)?;
        let mut lack = 0.0;
        fit.constraints(&x, self.positions, &mut |value, _| lack += (-value).max(0.0));
        Some((cost, lack))
    }
}

/// Fits from a start under all requirements, with at most `evaluations` of the cost (at least one).
pub fn polish(context: Context<'_>, start: Start, effort: Effort, evaluations: u64) -> Fitted {
    fit_with(context, start, effort, &options(context.problem, effort, evaluations))
}

/// As [`polish`] from a start whose error may be large; ends as soon as all requirements are met and the cost is at most
/// `enough`.
pub(super) fn polish_until(
    context: Context<'_>,
    start: Start,
    effort: Effort,
    evaluations: u64,
    enough: f64,
) -> Fitted {
    let usual = options(context.problem, effort, evaluations);
    let exact_cost = usual.exact_cost.max(enough);
    fit_with(context, start, effort, &LmOptions { exact_cost, hopeless_cost: f64::INFINITY, ..usual })
}

fn fit_with(context: Context<'_>, start: Start, effort: Effort, options: &LmOptions) -> Fitted {
    let kept = if effort.on_branch { Kept::OrderAndBranch } else { Kept::Order };
    on_fit(context.problem, &start, kept, Fitting { context, start: &start, options }).unwrap_or(Fitted::NONE)
}

/// Fits from a start by Levenberg-Marquardt.
struct Fitting<'a> {
    context: Context<'a>,
    start: &'a Start,
    options: &'a LmOptions,
}

impl FitUser for Fitting<'_> {
    type Output = Fitted;

    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> Fitted
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        let Fitting { context, start, options } = self;
        let end = solve(fit, x, start.positions.clone(), options, &|| context.stopped());
        let usable = !matches!(end.outcome, LmOutcome::NoStart | LmOutcome::Abandoned);
        let weight: f64 = context.problem.task().weights().iter().sum();
        Fitted {
            merit: end.cost + weight * end.violation * end.violation,
            evaluations: end.evaluations,
            end: usable.then_some(Start {
                design: design_of(&end.x),
                setting: start.setting,
                positions: end.state,
                scales: own_scales(&end.x),
            }),
        }
    }
}

/// Returns the positions of free timing at a fixed design, each brought to its nearest point.
pub fn settle_positions(
    context: Context<'_>,
    design: &Design,
    setting: Setting,
    positions: Positions,
) -> Option<Positions> {
    let problem = context.problem;
    let options = LmOptions { hopeless_cost: f64::INFINITY, ..options(problem, SETTLING, u64::MAX) };
    let stop = || context.stopped();
    let result = match problem.task().body() {
        None => solve(&PathFit::at(problem, setting, design), *design, positions, &options, &stop),
        Some(_) => solve(&MotionFit::at(problem, setting, design), *design, positions, &options, &stop),
    };
    (!matches!(result.outcome, LmOutcome::NoStart)).then_some(result.state)
}

/// As [`judged`], with the errors at the points in place of the distances to the whole curve, which take most of the time
/// of a verdict: for candidates that are measured later if they are listed.
pub(super) fn glanced(problem: &Problem, end: &Start) -> Option<Candidate> {
    const UNKNOWN: CurveErrorRecord = CurveErrorRecord { sum_sq: 0.0, rms: 0.0, max: 0.0 };
    let mut candidate = judged_with(problem, end, Some(UNKNOWN))?;
    let ErrorRecord { sum_sq, rms, max, .. } = candidate.error;
    candidate.error.to_curve = CurveErrorRecord { sum_sq, rms, max };
    Some(candidate)
}

/// Returns the judged candidate of a fit's end; `None` if it cannot be judged.
pub fn judged(problem: &Problem, end: &Start) -> Option<Candidate> {
    judged_with(problem, end, None)
}

/// As [`judged`]; `to_curve` as for [`assess_on_curve`].
fn judged_with(problem: &Problem, end: &Start, to_curve: Option<CurveErrorRecord>) -> Option<Candidate> {
    let space = problem.space(end.setting.side);
    let shape = space.shape(&end.design)?;
    let task = problem.task();
    if let Timing::Prescribed { crank_angles, offset } = task.timing() {
        let linkage = space.project(&shape.linkage(end.setting.assembly).ok()?).ok()?;
        // An exact multiple of the degrees in the file stays one.
        let base = match offset {
            AngleOffset::Free => {
                wrapped(TimedPathFit::new(problem, end.setting)?.offset(&end.design, &shape)).to_degrees()
            }
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => linkage.ground_angle().to_degrees(),
        };
        let written = problem.spec().task.timing.as_ref()?;
        debug_assert_eq!(written.crank_deg.len(), crank_angles.len());
        let run = end.scales[0] * problem.run(end.setting.direction);
        let mut crank_deg: Vec<f64> = written.crank_deg.iter().map(|deg| base + run * deg).collect();
        for (j, ([e, _], deg)) in end.positions.iter().zip(&mut crank_deg).enumerate() {
            if task.is_untimed(j) {
                *deg += wrapped(e.arg() - deg.to_radians()).to_degrees();
            }
        }
        let assemblies = vec![end.setting.assembly; crank_deg.len()];
        let own = reference_of(problem, &linkage, &crank_deg, (end.setting.direction, end.scales[1]));
        return assess_on_curve(problem, linkage, (&crank_deg, &assemblies), own, to_curve);
    }
    let assemblies = end.positions.iter().map(|[e, u]| assembly_of(&shape, *e, *u)).collect::<Vec<_>>();
    let linkage = shape.linkage(assemblies[0]).ok()?;
    let angles = end.positions.iter().map(|[e, _]| e.arg()).collect();
    let (crank_deg, assemblies) = unwrapped(problem, linkage, angles, assemblies);
    let linkage = space.project(&linkage).ok()?;
    // Unless deviations count one by one, the frame is the one of the least errors.
    let own = (problem.frame_is_free() && reserve(problem, 1000) > 0)
        .then(|| Reference::frame(wrapped(space.offset(&end.design)).to_degrees()));
    assess_on_curve(problem, linkage, (&crank_deg, &assemblies), own, to_curve)
}

/// Returns the frame of a body, or of a function's outputs with this sign and scale, at prescribed crank angles, where
/// deviations count one by one; `None` where the one of the least squared errors is wanted.
fn reference_of(
    problem: &Problem,
    linkage: &FourBar,
    crank_deg: &[f64],
    (sign, scale): (f64, f64),
) -> Option<Reference> {
    let (task, objective) = (problem.task(), problem.spec().solve.objective);
    let body = task.body().filter(|_| reserve(problem, 1000) > 0)?;
    let sign = if problem.is_function() { sign } else { 1.0 };
    let apart = |(angle, deg): (&Option<f64>, &f64)| {
        let joints = linkage.position_with(deg.to_radians(), linkage.assembly()).joints()?;
        let line = body.line([linkage.follower_pivot(), joints.crank_pin, joints.follower_pin]);
        Some(sign * scale * (*angle)? - line.arg())
    };
    let apart: Vec<Option<f64>> = body.angles.iter().zip(crank_deg).map(apart).collect();
    let largest = objective == Objective::MaxDeviation;
    let frame = body.frame_within(&apart, task.weights(), largest);
    Some(Reference { frame_deg: frame.to_degrees(), scale })
}
