//! Multistart search for prescribed timing by variable projection (the reduced form).
//!
//! A batch draws [`DRAWS`] ratios and angles from its own stream of the seed, screens them in every allowed direction
//! on both assemblies, fits the `SHORT` most promising for a few steps and the best `LONG` of them to convergence
//! ([`crate::task::forms::projection`]). An end that meets every bound and requirement is taken as it is. One that does
//! not, and has a lower objective than the best that does, is a lower bound for its basin: it is polished in the
//! physical parameters under all requirements ([`polish`]).
//!
//! If such ends occur, requirements are active, and later waves also fit under all requirements from the first step on:
//! from the screened draws of least cost and violation, and in rounds of [`super::multistart`], in turn.
//!
//! `WAVE` batches run in parallel and are read in their order; the work that a wave may skip (polishes of ends that are
//! no better than the best so far) depends on earlier waves only. So the number of threads changes no digit.
//!
//! *Stopping rule.* Independent batches have to reach the best objective repeatedly ([`super::belief`]). If
//! requirements are active, at least `BINDING_WAVES` waves have to fit under them; if several answers are wanted, the
//! search goes on until as many distinct ones are known or `QUIET_WAVES` waves brought no further one.

use super::belief::Belief;
use super::keeper::{Keeper, of_as_many_points, spared};
use super::multistart::{LONG_ROUNDS, LONG_STEPS, judged, polish, promise, round};
use super::polish::{basins_wanted, promising};
use super::starts::{Starts, draw_ratios, drawn_types};
use super::{Budget, HitsSoFar, Observer, Progress};
use crate::judge::rank::{count_distinct, exact_cost, exact_sum_sq, searched, sort};
use crate::mechanism::{AssemblyMode, CouplerSide, LinkageType};
use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};
use crate::numbers::optimise::compact_lm::{CompactOptions, solve};
use crate::record::{Candidate, Evaluations, Reason, Repeats};
use crate::task::forms::design_space::{Design, DesignSpace};
use crate::task::forms::projection::{Batch, ProjectedFit, Projection, Reduced, Solution};
use crate::task::forms::rows::{Motion, Requirements, nearest_type};
use crate::task::forms::start::Start;
use crate::task::{AngleOffset, Timing};
use crate::task::{Problem, Setting};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Draws in a batch.
pub const DRAWS: usize = 128;
/// Draws fitted for a few steps.
const SHORT: usize = 8;
/// Draws fitted to convergence.
const LONG: usize = 3;
/// Most evaluations of a short and of a long fit.
const SHORT_EVALUATIONS: u32 = 10;
const LONG_EVALUATIONS: u32 = 100;
/// Most ends polished in a batch.
const POLISHES: usize = 2;
/// Draws screened with their violation, fitted for a few steps and fitted to convergence under all requirements, if
/// requirements are active.
const PROMISING: usize = 256;
const CONSTRAINED_SHORT: usize = 6;
const CONSTRAINED_STEPS: usize = 24;
const CONSTRAINED_LONG: usize = 2;
/// Least number of waves with such fits, if requirements are active.
const BINDING_WAVES: u64 = 2;
/// Batches that run in parallel.
pub const WAVE: u64 = 4;
/// Least number of waves if several answers are wanted, and waves without a new answer that end the search for more.
const LEAST_WAVES: u64 = 6;
const QUIET_WAVES: u64 = 12;
/// Relative difference of errors below which they are the same optimum.
const SAME_OPTIMUM: f64 = 1e-6;
/// Difference of designs, in parts of the target's size, within which they are judged once.
const SAME_NUMBERS: f64 = 1e-6;
/// Number of candidates kept while searching.
const KEPT: usize = 400;

/// The outcome of the search.
#[derive(Clone, Debug)]
pub struct TimedOutcome {
    /// Judged candidates, best first.
    pub found: Vec<Candidate>,
    /// The evaluations used.
    pub evaluations: Evaluations,
    /// The reason why it ended.
    pub reason: Reason,
    /// Whether the physical polish was needed.
    pub polished: bool,
    /// The repeated hits of the best answer.
    pub repeats: Option<Repeats>,
}

/// An end of a fit, in physical parameters.
#[derive(Clone, Debug)]
struct End {
    start: Start,
    /// The objective.
    cost: f64,
}

/// An end that the referee has judged.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Judged {
    setting: Setting,
    design: Design,
    accepted: bool,
}

/// The state of the search between two waves, on which the next waves depend besides the problem and the budget.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TimedState {
    found: Vec<Candidate>,
    evaluations: Evaluations,
    polished: bool,
    best: Option<Candidate>,
    seen: Vec<Judged>,
    belief: Belief,
    known: usize,
    quiet: u64,
    wave: u64,
    draws: u64,
    binding: bool,
    binding_waves: u64,
}

impl TimedState {
    fn new(exact: f64) -> Self {
        TimedState {
            found: Vec::new(),
            evaluations: Evaluations::default(),
            polished: false,
            best: None,
            seen: Vec::new(),
            belief: Belief::new(exact),
            known: 0,
            quiet: 0,
            wave: 0,
            draws: 0,
            binding: false,
            binding_waves: 0,
        }
    }

    fn ended(self, reason: Reason) -> TimedOutcome {
        let (hits, near) = self.belief.hits();
        let repeats = || Repeats::new(self.wave * WAVE, hits as u64, near as u64);
        TimedOutcome {
            repeats: self.best.is_some().then(repeats),
            found: self.found,
            evaluations: self.evaluations,
            reason,
            polished: self.polished,
        }
    }
}

/// The outcome of a batch.
#[derive(Clone, Debug, Default)]
struct BatchOutcome {
    /// Ends that meet every bound and requirement the search knows, best first.
    ends: Vec<End>,
    /// Ends of a round in the physical parameters, judged.
    judged: Vec<Candidate>,
    evaluations: u64,
    draws: u64,
    polished: bool,
    /// Whether an end that violates a bound or a requirement was better than all that meet them.
    binding: bool,
}

struct Search<'a> {
    problem: &'a Problem,
    budget: &'a Budget<'a>,
    forms: Vec<(f64, Projection)>,
    types: Vec<LinkageType>,
    starts: Starts<'a>,
    /// One design space per side of the coupler point.
    spaces: Vec<(CouplerSide, DesignSpace)>,
    requirements: Requirements,
    /// The least and the greatest prescribed angle as written, radians; the full turn of a closed target.
    span: (f64, f64),
    exact: f64,
}

/// Searches until the best is believed, `limit` evaluations are used, or `patience` are used without an acceptable
/// candidate; `None` if the problem has no reduced form.
pub fn search(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Option<TimedOutcome> {
    let search = Search::new(problem, budget)?;
    let wanted = basins_wanted(problem);
    let n = problem.task().len() as u64;
    let earlier = keeper.and_then(|keeper| keeper.earlier().timed.clone());
    let earlier = earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best));
    let mut at = earlier.unwrap_or_else(|| TimedState::new(search.exact));
    // No batch so far came near its allowance of evaluations.
    let mut ample = true;
    let keep = |stopped, at: &TimedState| {
        if let Some(keeper) = keeper {
            keeper.keep(stopped, |state| state.timed = Some(at.clone()));
        }
    };
    loop {
        let stop = budget.stop_reason();
        if ample {
            keep(stop.is_some(), &at);
        }
        if let Some(reason) = stop {
            return Some(at.ended(reason));
        }
        let left = limit.saturating_sub(at.evaluations.objective);
        let allowance = |index: u64| left / WAVE + u64::from(index % WAVE < left % WAVE);
        let (wave, bar, binding) = (at.wave, at.belief.best(), at.binding);
        let batches: Vec<BatchOutcome> = (wave * WAVE..(wave + 1) * WAVE)
            .into_par_iter()
            .map(|index| search.batch(index, allowance(index), bar, binding))
            .collect();
        let stop = budget.stop_reason();
        if stop.is_some() && ample {
            keep(true, &at);
        }
        ample &=
            (wave * WAVE..).zip(&batches).all(|(index, batch)| spared(batch.evaluations, allowance(index)));
        let (found, best, seen, belief) = (&mut at.found, &mut at.best, &mut at.seen, &mut at.belief);
        let judging = budget.judging(problem.task().len());
        at.wave += 1;
        at.binding_waves += u64::from(binding);
        for batch in batches {
            at.binding |= batch.binding;
            at.draws += batch.draws;
            at.polished |= batch.polished;
            at.evaluations.objective += batch.evaluations;
            at.evaluations.positions += n * batch.evaluations;
            let mut take = |candidate: Candidate, belief: &mut Belief| {
                if promising(problem, &candidate) {
                    let cost = searched(problem, &candidate);
                    belief.came_to(cost);
                    if best.as_ref().is_none_or(|b| cost < searched(problem, b)) {
                        *best = Some(candidate.clone());
                    }
                }
                found.push(candidate);
            };
            for end in batch.ends {
                if wanted == 1 && end.cost > search.exact && !belief.would_improve(end.cost) {
                    // One answer is wanted, and this is not a better one.
                    belief.came_back_to(end.cost);
                    continue;
                }
                if let Some(accepted) = search.judged_before(seen, &end) {
                    if accepted {
                        belief.came_back_to(end.cost);
                    }
                    continue;
                }
                if !judging.may_go_on() {
                    continue;
                }
                let Some(candidate) = judged(problem, &end.start) else { continue };
                let Start { setting, design, .. } = end.start;
                seen.push(Judged { setting, design, accepted: promising(problem, &candidate) });
                take(candidate, belief);
            }
            for candidate in batch.judged {
                take(candidate, belief);
            }
            belief.end_batch();
        }
        sort(problem, found);
        found.truncate(KEPT);
        if let Some(reason) = stop {
            return Some(at.ended(reason));
        }
        observer(&Progress {
            phase: "variable-projection",
            evaluations: at.evaluations.objective,
            budget: limit,
            best_sum_sq: best.as_ref().or(found.first()).map(|c| c.error.sum_sq),
            accepted: best.as_ref().is_some_and(|b| b.accepted),
            hits: best.as_ref().map(|_| HitsSoFar { came: belief.hits().0, wanted: super::belief::HITS }),
        });
        let explored = !at.binding || at.binding_waves >= BINDING_WAVES;
        let enough = wanted == 1 || at.wave >= LEAST_WAVES;
        if belief.is_firm() && explored && enough {
            let distinct = if wanted == 1 { 1 } else { count_distinct(problem, found, wanted) };
            at.quiet = if distinct > at.known { 0 } else { at.quiet + 1 };
            at.known = distinct;
            if distinct >= wanted || at.quiet >= QUIET_WAVES {
                let is_exact = best.as_ref().is_some_and(|b| b.error.sum_sq <= exact_sum_sq(problem));
                return Some(at.ended(if is_exact { Reason::TargetReached } else { Reason::Converged }));
            }
        }
        let used = at.evaluations.objective;
        let spent = used.max(at.draws);
        if spent >= limit || (spent >= patience && best.is_none()) {
            return Some(at.ended(if used < patience { Reason::Stalled } else { Reason::EvaluationLimit }));
        }
    }
}

impl<'a> Search<'a> {
    fn new(problem: &'a Problem, budget: &'a Budget<'a>) -> Option<Self> {
        let Timing::Prescribed { crank_angles, .. } = problem.task().timing() else { return None };
        let forms = problem
            .directions()
            .iter()
            .map(|&direction| Some((direction, Projection::new(problem, direction)?)))
            .collect::<Option<Vec<_>>>()?;
        let (low, high) = crank_angles
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &a| (low.min(a), high.max(a)));
        let high = if problem.task().closed() { high.max(low + TAU) } else { high };
        let spaces: Vec<_> = problem.sides().iter().map(|&side| (side, problem.space(side))).collect();
        Some(Search {
            requirements: problem.requirements(&spaces[0].1),
            starts: Starts::new(problem),
            spaces,
            forms,
            types: drawn_types(problem),
            span: (low, high),
            exact: exact_cost(problem),
            problem,
            budget,
        })
    }

    /// Returns the verdict on an end if an equal one has been judged before.
    fn judged_before(&self, seen: &[Judged], end: &End) -> Option<bool> {
        let near = SAME_NUMBERS * self.problem.task().size();
        let same = |(x, y): (&f64, &f64)| (x - y).abs() <= near;
        seen.iter()
            .find(|judged| {
                judged.setting == end.start.setting && judged.design.iter().zip(&end.start.design).all(same)
            })
            .map(|judged| judged.accepted)
    }

    fn draw(&self, draws: &mut Stream) -> Option<Reduced> {
        let kind = self.types[below(draws, self.types.len())];
        let ratios = draw_ratios(draws, kind)?;
        let angle = uniform(draws, -PI, PI);
        let form = &self.forms[0].1;
        let mut x = [ratios.crank.ln(), ratios.coupler.ln(), ratios.follower.ln(), angle];
        if !form.has_angle() {
            x[3] = 0.0;
        }
        for (value, (low, high)) in x.iter_mut().zip(form.bounds()) {
            *value = value.max(*low).min(*high);
        }
        Some(x)
    }

    /// Returns whether the loop stays closed between the points too, on one assembly: |CB|^2 between (b - c)^2 and (b +
    /// c)^2 over the whole range of crank angles.
    fn stays_closed(&self, form: usize, x: &Reduced) -> bool {
        if self.problem.circuit_any() {
            return true;
        }
        let (direction, form) = &self.forms[form];
        let [p, q, r] = [x[0].exp(), x[1].exp(), x[2].exp()];
        let turn = form.crank_turn(x);
        let (one, other) = (direction * self.span.0 + turn, direction * self.span.1 + turn);
        let (low, high) = (one.min(other), one.max(other));
        let holds = |angle: f64| (angle - low).rem_euclid(TAU) <= high - low;
        let diagonal = |cos: f64| 1.0 + p * p - 2.0 * p * cos;
        let ends = [diagonal(low.cos()), diagonal(high.cos())];
        let least = if holds(0.0) { diagonal(1.0) } else { ends[0].min(ends[1]) };
        let greatest = if holds(PI) { diagonal(-1.0) } else { ends[0].max(ends[1]) };
        least >= (q - r) * (q - r) && greatest <= (q + r) * (q + r)
    }

    fn batch(&self, index: u64, allowance: u64, bar: f64, thorough: bool) -> BatchOutcome {
        let problem = self.problem;
        let mut out = BatchOutcome::default();
        let mut stream = stream(problem.spec().solve.seed, index);
        let readings = 2 * self.forms.len() as u64;
        let affordable = (allowance / readings).min(DRAWS as u64) as usize;
        out.draws = DRAWS as u64;
        let draws: Vec<Reduced> =
            (0..DRAWS).filter_map(|_| self.draw(&mut stream)).take(affordable).collect();
        if draws.is_empty() {
            return out;
        }
        let batch = Batch::new(draws);
        out.evaluations = readings * batch.len() as u64;
        let mut screened: Vec<(f64, usize, usize, AssemblyMode)> = Vec::new();
        for (form, (_, projection)) in self.forms.iter().enumerate() {
            let Some(costs) = projection.screen_unless(&batch, &|| self.budget.stopped()) else {
                return BatchOutcome::default();
            };
            for (assembly, costs) in [AssemblyMode::Plus, AssemblyMode::Minus].into_iter().zip(costs) {
                screened.extend(
                    costs
                        .iter()
                        .enumerate()
                        .filter(|(_, c)| c.is_finite())
                        .map(|(i, &c)| (c, i, form, assembly)),
                );
            }
        }
        screened.sort_unstable_by(|x, y| {
            x.0.total_cmp(&y.0)
                .then(x.1.cmp(&y.1))
                .then(x.2.cmp(&y.2))
                .then(x.3.sign().total_cmp(&y.3.sign()))
        });
        let task = problem.task();
        let options = CompactOptions {
            max_evaluations: SHORT_EVALUATIONS,
            relative_reduction: 1e-10,
            exact_cost: 1e-6 * self.exact,
            hopeless_cost: f64::INFINITY,
            patience: u32::MAX,
        };
        let mut fits: Vec<ProjectedFit<'_>> =
            self.forms.iter().map(|(_, form)| ProjectedFit::new(form, AssemblyMode::Plus)).collect();
        let mut fit = |x: Reduced, form: usize, assembly: AssemblyMode, most: u32, used: &mut u64| {
            let left = u32::try_from(allowance - *used).unwrap_or(u32::MAX);
            if left == 0 {
                return None;
            }
            let fit = &mut fits[form];
            fit.set_assembly(assembly);
            let options = CompactOptions { max_evaluations: most.min(left), ..options };
            let end = solve(fit, x, self.forms[form].1.bounds(), &options, &|| self.budget.stopped());
            *used += u64::from(end.evaluations);
            end.cost.is_finite().then_some((end.cost, end.x))
        };
        let mut short = Vec::with_capacity(SHORT);
        let promising =
            screened.iter().filter(|(_, i, form, _)| self.stays_closed(*form, &batch.draws()[*i]));
        for &(_, i, form, assembly) in promising.take(SHORT) {
            if let Some((cost, x)) =
                fit(batch.draws()[i], form, assembly, SHORT_EVALUATIONS, &mut out.evaluations)
            {
                short.push((cost, x, form, assembly));
            }
        }
        short.sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut long: Vec<(f64, Reduced, usize, AssemblyMode)> = Vec::with_capacity(LONG);
        for (cost, x, form, assembly) in short.into_iter().take(LONG) {
            if self.budget.stopped() {
                // Taken as it is: the best so far.
                long.push((cost, x, form, assembly));
                break;
            }
            if let Some((cost, x)) = fit(x, form, assembly, LONG_EVALUATIONS, &mut out.evaluations) {
                long.push((cost, x, form, assembly));
            }
        }
        long.sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut broken: Vec<(f64, End)> = Vec::new();
        let scale = task.weights().iter().sum::<f64>() * task.size().powi(2);
        for (cost, x, form, assembly) in long {
            fits[form].set_assembly(assembly);
            let Some(solution) = fits[form].solution(&x) else { continue };
            let Some((start, lack)) = self.physical(&solution, self.forms[form].0, assembly) else {
                continue;
            };
            let end = End { start, cost };
            if lack == 0.0 {
                if self.stays_closed(form, &x) {
                    out.ends.push(end);
                }
            } else {
                broken.push((cost + scale * lack * lack, end));
            }
        }
        broken.sort_by(|x, y| x.0.total_cmp(&y.0));
        if self.budget.stopped() && out.ends.is_empty() {
            out.ends.extend(broken.drain(..).take(1).map(|(_, end)| end));
        }
        let mut polishes = 0;
        for (_, end) in broken {
            let bar = out.ends.iter().map(|e| e.cost).fold(bar, f64::min);
            let left = allowance - out.evaluations;
            if polishes >= POLISHES || left == 0 || self.budget.stopped() {
                break;
            }
            if end.cost >= bar * (1.0 - SAME_OPTIMUM) {
                continue;
            }
            polishes += 1;
            out.binding = true;
            self.polished(end.start, allowance, &mut out);
        }
        if thorough && index.is_multiple_of(2) {
            let left = allowance - out.evaluations;
            let round = round(problem, &self.starts, index, left, self.budget);
            out.evaluations += round.evaluations;
            out.polished = true;
            out.judged = round.found;
        } else if thorough {
            self.constrained(&screened, &batch, &mut fits, allowance, &mut out);
        }
        out.ends.sort_by(|x, y| x.cost.total_cmp(&y.cost));
        out
    }

    /// Fits to convergence under all requirements and adds the end.
    fn polished(&self, start: Start, allowance: u64, out: &mut BatchOutcome) {
        let left = allowance - out.evaluations;
        let fitted = polish(self.problem, start, LONG_STEPS, LONG_ROUNDS, left, self.budget);
        out.evaluations += fitted.evaluations;
        out.polished = true;
        out.ends.extend(fitted.end.map(|start| End { start, cost: fitted.merit }));
    }

    /// Fits under all requirements from the first step on, from the draws of least cost and violation.
    fn constrained(
        &self,
        screened: &[(f64, usize, usize, AssemblyMode)],
        batch: &Batch,
        fits: &mut [ProjectedFit<'_>],
        allowance: u64,
        out: &mut BatchOutcome,
    ) {
        let mut starts = Vec::new();
        for &(_, i, form, assembly) in screened.iter().take(PROMISING) {
            let x = &batch.draws()[i];
            if self.budget.stopped() {
                break;
            }
            if out.evaluations >= allowance || !self.stays_closed(form, x) {
                continue;
            }
            out.evaluations += 1;
            fits[form].set_assembly(assembly);
            let Some(solution) = fits[form].solution(x) else { continue };
            // The promise of the start as the fit takes it: clamped to the bounds.
            let physical = self.physical(&solution, self.forms[form].0, assembly);
            if let Some((mut start, _)) = physical
                && let Some(promise) = promise(self.problem, &mut start)
            {
                starts.push((promise, start));
            }
        }
        starts.sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut short = Vec::new();
        for (_, start) in starts.into_iter().take(CONSTRAINED_SHORT) {
            if out.evaluations >= allowance || self.budget.stopped() {
                break;
            }
            let left = allowance - out.evaluations;
            let fitted = polish(self.problem, start, CONSTRAINED_STEPS, 2, left, self.budget);
            out.evaluations += fitted.evaluations;
            short.extend(fitted.end.map(|start| (fitted.merit, start)));
        }
        short.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (_, start) in short.into_iter().take(CONSTRAINED_LONG) {
            if out.evaluations >= allowance || self.budget.stopped() {
                break;
            }
            self.polished(start, allowance, out);
        }
    }

    /// Returns a solution as a start of the physical fit, and its violation of bounds and requirements in sizes of the
    /// target.
    fn physical(&self, solution: &Solution, direction: f64, assembly: AssemblyMode) -> Option<(Start, f64)> {
        let problem = self.problem;
        let Solution { shape, offset, .. } = solution;
        let side = match self.spaces.as_slice() {
            [(only, _)] => *only,
            _ if shape.offset.im < 0.0 => CouplerSide::Minus,
            _ => CouplerSide::Plus,
        };
        let (_, space) = self.spaces.iter().find(|(s, _)| *s == side)?;
        let aim =
            if problem.types().is_empty() { None } else { nearest_type(shape.links(), problem.types()) };
        let setting = Setting { aim, assembly, direction, side };
        let base = match problem.task().timing() {
            Timing::Prescribed { offset: AngleOffset::Ground, .. } => {
                (shape.follower_pivot - shape.crank_pivot).arg()
            }
            _ => *offset,
        };
        let (one, other) = (direction * self.span.0 + base, direction * self.span.1 + base);
        let motion = Motion::Stretch(one.min(other), one.max(other), assembly);
        let lack = self.requirements.lack(aim, shape, &motion);
        let outside = space.excess(shape) / problem.task().size();
        let start = Start { design: space.design(shape, *offset), setting, positions: Vec::new() };
        Some((start, outside + lack))
    }
}
