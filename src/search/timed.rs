//! Prescribed timing: the search on the reduced form.
//!
//! A batch draws [`DRAWS`] ratios and angles from its own stream of the seed, screens them in every allowed
//! direction on both assemblies, fits the [`SHORT`] that promise most for a few steps and the best [`LONG`] of
//! them to the end ([`crate::problem::projection`]). An end that keeps every bound and requirement stands as it
//! is. One that does not, and is better than what stands, is a lower bound of what its basin can give: it is
//! polished in the physical parameters under all requirements ([`polish`]).
//!
//! [`WAVE`] batches run side by side and are read in their order; what a wave may skip (polishes of ends that are
//! no better than the best so far) depends on earlier waves only. So the number of threads changes no digit.
//!
//! *Stopping rule.* The best objective is believed when it has come back, within one part in 1e6, from [`HITS`]
//! different batches (the one that found it included). Where it is approached and not reached (at a toggle or a
//! change point every end is a little better than the last) it is enough that [`FLAT_HITS`] batches came within
//! one part in a thousand. Where several answers are wanted the search goes on until as many distinct ones are
//! known or [`QUIET_WAVES`] waves brought no further one.

use super::multistart::{LONG_ROUNDS, LONG_STEPS, judged, polish};
use super::rank::{compare, distinct, exact_objective, exact_sum_sq};
use super::starts::{Start, draw_ratios, drawn_types};
use super::{Budget, Observer, Progress};
use crate::linkage::{AssemblyMode, CouplerSide, LinkageType};
use crate::problem::design_space::{Design, Shape};
use crate::problem::projection::{Batch, ProjectedFit, Projection, Reduced, Solution};
use crate::problem::requirements::nearest_type;
use crate::problem::timed::TimedFit;
use crate::problem::{Problem, Setting};
use crate::record::{Candidate, Evaluations, Reason};
use crate::solve::compact_lm::{CompactOptions, solve};
use crate::solve::streams::{Stream, below, stream, uniform};
use crate::task::Timing;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Draws of a batch.
pub const DRAWS: usize = 128;
/// Draws fitted for a few steps.
const SHORT: usize = 8;
/// Draws fitted to the end.
const LONG: usize = 3;
/// Evaluations of a short and of a long fit.
const SHORT_EVALUATIONS: u32 = 10;
const LONG_EVALUATIONS: u32 = 100;
/// Ends polished in a batch at most.
const POLISHES: usize = 2;
/// Batches that run side by side.
pub const WAVE: u64 = 4;
/// The best objective has to come from this many batches.
pub const HITS: usize = 4;
/// Or within a thousandth from this many.
pub const FLAT_HITS: usize = 16;
/// Waves at least where several answers are wanted, and waves without news that end the search for more.
const LEAST_WAVES: u64 = 6;
const QUIET_WAVES: u64 = 12;
/// Errors that differ by less than this part are the same optimum.
const SAME_OPTIMUM: f64 = 1e-6;
const NEAR_OPTIMUM: f64 = 1e-3;
/// Designs that agree within this part of the target's size are judged once.
const SAME_NUMBERS: f64 = 1e-6;
/// Candidates that are kept while searching.
const KEPT: usize = 400;

/// The end of the search.
#[derive(Clone, Debug)]
pub struct TimedOutcome {
    /// Judged candidates, best first.
    pub found: Vec<Candidate>,
    /// What it cost.
    pub evaluations: Evaluations,
    /// Why it ended.
    pub reason: Reason,
    /// Whether the physical polish was needed.
    pub polished: bool,
}

/// An end of a fit, in physical parameters.
#[derive(Clone, Debug)]
struct End {
    start: Start,
    /// The objective.
    cost: f64,
}

/// An end that the referee has seen.
struct Judged {
    setting: Setting,
    design: Design,
    accepted: bool,
}

/// What a batch gives.
#[derive(Clone, Debug, Default)]
struct BatchOutcome {
    /// Ends that keep every bound and requirement the search knows, best first.
    ends: Vec<End>,
    evaluations: u64,
    draws: u64,
    polished: bool,
}

struct Search<'a> {
    problem: &'a Problem,
    budget: &'a Budget<'a>,
    forms: Vec<(f64, Projection)>,
    types: Vec<LinkageType>,
    /// The least and the greatest prescribed angle as written, radians; the full turn of a closed target.
    span: (f64, f64),
    exact: f64,
}

/// Searches until the best is believed, `limit` evaluations are used, or `patience` are used without an acceptable
/// candidate; `None` where the problem has no reduced form.
pub fn search(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
) -> Option<TimedOutcome> {
    let search = Search::new(problem, budget)?;
    let wanted = problem.spec().solve.candidates;
    let exact = search.exact;
    let mut out = TimedOutcome {
        found: Vec::new(),
        evaluations: Evaluations::default(),
        reason: Reason::EvaluationLimit,
        polished: false,
    };
    let n = problem.task().len() as u64;
    let mut best: Option<Candidate> = None;
    let mut seen: Vec<Judged> = Vec::new();
    let (mut hits, mut near_hits) = (0, 0);
    let (mut known, mut quiet, mut wave, mut draws) = (0, 0, 0, 0);
    loop {
        if let Some(reason) = budget.stop_reason() {
            out.reason = reason;
            return Some(out);
        }
        let left = limit.saturating_sub(out.evaluations.objective);
        let allowance = |index: u64| left / WAVE + u64::from(index % WAVE < left % WAVE);
        let bar = best.as_ref().map_or(f64::INFINITY, |b| b.error.objective);
        let batches: Vec<BatchOutcome> = (wave * WAVE..(wave + 1) * WAVE)
            .into_par_iter()
            .map(|index| search.batch(index, allowance(index), bar))
            .collect();
        wave += 1;
        for batch in batches {
            draws += batch.draws;
            out.polished |= batch.polished;
            out.evaluations.objective += batch.evaluations;
            out.evaluations.positions += n * batch.evaluations;
            let (mut hit, mut near) = (false, false);
            for end in batch.ends {
                let bar = best.as_ref().map_or(f64::INFINITY, |b| b.error.objective);
                let within = |part: f64| best.is_some() && end.cost <= bar + (part * bar).max(exact);
                let better = best.is_none() || end.cost < bar - SAME_OPTIMUM * bar.max(exact);
                if !better && wanted == 1 && end.cost > exact {
                    // One answer is wanted, and this is not a better one.
                    hit |= within(SAME_OPTIMUM);
                    near |= within(NEAR_OPTIMUM);
                    continue;
                }
                if let Some(accepted) = search.judged_before(&seen, &end) {
                    hit |= accepted && within(SAME_OPTIMUM);
                    near |= accepted && within(NEAR_OPTIMUM);
                    continue;
                }
                let Some(candidate) = judged(problem, &end.start) else { continue };
                seen.push(Judged {
                    setting: end.start.setting,
                    design: end.start.design,
                    accepted: candidate.accepted,
                });
                if candidate.accepted {
                    if better {
                        hits = 0;
                    }
                    if best.is_none() || candidate.error.objective < bar * (1.0 - NEAR_OPTIMUM) - exact {
                        near_hits = 0;
                    }
                    hit |= better || within(SAME_OPTIMUM);
                    near |= better || within(NEAR_OPTIMUM);
                    if candidate.error.objective < bar {
                        best = Some(candidate.clone());
                    }
                }
                out.found.push(candidate);
            }
            hits += usize::from(hit);
            near_hits += usize::from(near);
        }
        out.found.sort_by(|one, other| compare(problem, one, other));
        out.found.truncate(KEPT);
        if let Some(reason) = budget.stop_reason() {
            out.reason = reason;
            return Some(out);
        }
        observer(&Progress {
            phase: "variable-projection",
            evaluations: out.evaluations.objective,
            budget: limit,
            best_sum_sq: best.as_ref().or(out.found.first()).map(|c| c.error.sum_sq),
            accepted: best.is_some(),
        });
        if (hits >= HITS || near_hits >= FLAT_HITS) && (wanted == 1 || wave >= LEAST_WAVES) {
            let distinct = if wanted == 1 { 1 } else { distinct(problem, out.found.clone(), wanted).len() };
            quiet = if distinct > known { 0 } else { quiet + 1 };
            known = distinct;
            if distinct >= wanted || quiet >= QUIET_WAVES {
                let is_exact = best.as_ref().is_some_and(|b| b.error.sum_sq <= exact_sum_sq(problem));
                out.reason = if is_exact { Reason::TargetReached } else { Reason::Converged };
                return Some(out);
            }
        }
        let used = out.evaluations.objective;
        let spent = used.max(draws);
        if spent >= limit || (spent >= patience && best.is_none()) {
            out.reason = if used < patience { Reason::Stalled } else { Reason::EvaluationLimit };
            return Some(out);
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
        Some(Search {
            forms,
            types: drawn_types(problem),
            span: (low, high),
            exact: exact_objective(problem),
            problem,
            budget,
        })
    }

    /// The verdict on an end whose numbers have been judged before.
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

    /// Whether the loop stays closed between the points too, on one assembly: |CB|^2 between (b - c)^2 and
    /// (b + c)^2 over the whole stretch.
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

    fn batch(&self, index: u64, allowance: u64, bar: f64) -> BatchOutcome {
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
            let costs = projection.screen(&batch);
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
            let end = solve(fit, x, self.forms[form].1.bounds(), &options);
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
        for (_, x, form, assembly) in short.into_iter().take(LONG) {
            if self.budget.stopped() {
                return out;
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
            out.polished = true;
            let fitted = polish(problem, end.start, LONG_STEPS, LONG_ROUNDS, left, self.budget);
            out.evaluations += fitted.evaluations;
            if let Some(start) = fitted.end {
                out.ends.push(End { start, cost: fitted.merit });
            }
        }
        out.ends.sort_by(|x, y| x.cost.total_cmp(&y.cost));
        out
    }

    /// A solution as a start of the physical fit, and what it lacks of bounds and requirements in sizes.
    fn physical(&self, solution: &Solution, direction: f64, assembly: AssemblyMode) -> Option<(Start, f64)> {
        let problem = self.problem;
        let Solution { shape, offset, .. } = solution;
        let side = side_of(problem, shape);
        let aim =
            if problem.types().is_empty() { None } else { nearest_type(shape.links(), problem.types()) };
        let setting = Setting { aim, assembly, direction, side };
        let fit = TimedFit::new(problem, setting)?;
        let design = fit.space().design(shape, *offset);
        let outside = fit.space().excess(shape) / problem.task().size();
        let lack = fit.requirements().lack(aim, shape, &fit.motion(&design, shape));
        Some((Start { design, setting, positions: Vec::new() }, outside + lack))
    }
}

/// t2 where d and e are the coordinates, else the side that stands for both.
fn side_of(problem: &Problem, shape: &Shape) -> CouplerSide {
    match problem.sides() {
        [only] => *only,
        _ if shape.offset.im < 0.0 => CouplerSide::Minus,
        _ => CouplerSide::Plus,
    }
}
