//! The plan of a search: the methods that run, their order, and their stopping rules.
//!
//! `least-squares` and `auto` search prescribed timing in its reduced form ([`timed`]) and free timing on the curves of
//! positions ([`free`]); each has its own rule of repeated hits. If there is no reduced form or it finds nothing
//! acceptable, rounds in the physical parameters follow: until [`HITS`] different rounds have reached the best answer
//! and as many distinct answers as were asked for are known. For objectives and tolerances beyond least squares the
//! answers are polished afterwards ([`super::polish`]). If still nothing is acceptable, `auto` searches without one of
//! the requirements in turn (`relaxed`), then by differential evolution for a feasible design, and polishes the
//! results. The population searches alone run without a polish.

use super::keeper::{Keeper, of_as_many_points, spared};
use super::multistart::{LONG_ROUNDS, LONG_STEPS, judged, polish, round};
use super::polish::{improve, promising, reserve};
use super::population;
use super::population::Population;
use super::starts::Starts;
use super::{Budget, HitsSoFar, Observer, Progress, SearchOutcome};
use super::{continuation, free, relaxed, timed};
use crate::judge::assess::assess;
use crate::judge::rank::{count_distinct, divided, exact_cost, exact_sum_sq, searched, sort};
use crate::mechanism::Complex;
use crate::numbers::optimise::population::PopulationError;
use crate::record::{Candidate, Evaluations, Reason, Repeats};
use crate::task::Problem;
use crate::task::spec::{Method, Objective};
use crate::task::{AngleOffset, Timing};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Rounds that have to reach the best answer before it is believed.
pub const HITS: usize = 6;
/// Relative difference of errors below which they are the same optimum.
pub(super) const SAME_OPTIMUM: f64 = 1e-6;
/// Rounds that run in parallel before any is read: the same number for any number of threads.
const BATCH: u64 = 8;
/// Least number of batches, so that rarer answers have their chance, and batches without a new answer that end a search
/// for further distinct answers.
const LEAST_BATCHES: u64 = 3;
const QUIET_BATCHES: u64 = 6;
/// The part of the budget that `auto` gives to local searches if these find nothing acceptable.
const LOCAL_SHARE: f64 = 0.6;
/// The part of that for the reduced form of prescribed timing, before rounds in the physical parameters.
const REDUCED_SHARE: f64 = 0.5;
/// If local searches end with nothing acceptable, one part in this many of the evaluations left goes to searches
/// without one of the requirements ([`relaxed`]), and the rest to differential evolution.
const RELAXED_SHARE: u64 = 2;
/// One part in this many of the evaluations for differential evolution goes to the polish of its best.
const POLISH_SHARE: u64 = 5;
/// Number of candidates kept while searching; the worst are dropped beyond it.
const KEPT: usize = 400;

/// Distance of a target from the origin, in sizes of the target, beyond which it is searched around its own centre: at
/// 1e6 sizes differences of coordinates have lost six digits.
pub const FAR: f64 = 100.0;
/// Number of the other candidates found there that are brought back.
const FAR_OTHERS: usize = 32;

/// Searches as the problem's `[solve]` table says: if there are nine precision points, `continuation` and `auto` first
/// solve for all linkages through them, and `auto` approximates if these do not give enough answers.
///
/// # Errors
/// [`PopulationError`] if a population search cannot be set up.
pub fn search(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
) -> Result<SearchOutcome, PopulationError> {
    search_kept(problem, budget, observer, None)
}

/// As [`search`], with a keeper of its state, from which it resumes.
///
/// # Errors
/// As [`search`].
pub fn search_kept(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Result<SearchOutcome, PopulationError> {
    let Some(exact) = continuation::solve(problem, budget, observer) else {
        return approximated(problem, budget, observer, keeper);
    };
    if exact.suffices(problem) || budget.stopped() {
        return Ok(exact.alone(problem, budget));
    }
    Ok(exact.beside(problem, approximated(problem, budget, observer, keeper)?, budget))
}

/// As [`search`] without exact answers: used many times over to find conflicts and costs.
///
/// # Errors
/// As [`search`].
pub fn approximate(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
) -> Result<SearchOutcome, PopulationError> {
    approximated(problem, budget, observer, None)
}

fn approximated(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Result<SearchOutcome, PopulationError> {
    let centre = problem.task().centre();
    if centre.norm() <= FAR * problem.task().size() {
        return search_here(problem, budget, observer, keeper);
    }
    let Ok(near) = Problem::new(problem.spec().shifted([-centre.re, -centre.im])) else {
        return search_here(problem, budget, observer, keeper);
    };
    let mut outcome = search_here(&near, budget, observer, keeper)?;
    let back = |candidate: &Candidate| moved_back(problem, candidate, centre);
    // Also the next best: a linkage that only just closes there may be open here.
    let found = outcome.candidates.iter().chain(outcome.others.iter().take(FAR_OTHERS)).filter_map(back);
    let found = found.collect();
    (outcome.candidates, outcome.others) = divided(problem, found, problem.spec().solve.candidates);
    Ok(outcome)
}

/// Returns a candidate that was found around its target's centre, moved `by` back to the target and judged there;
/// `None` if it does not close there. Its pivots are rounded in the move: angles that are counted from the ground line
/// then count from the moved line.
pub(super) fn moved_back(problem: &Problem, candidate: &Candidate, by: Complex) -> Option<Candidate> {
    let linkage = candidate.linkage.shifted(by).ok()?;
    let timing = problem.spec().task.path.timing.as_ref();
    match timing.filter(|timing| timing.offset == AngleOffset::Ground) {
        None => assess(problem, &linkage, &candidate.crank_deg, &candidate.t1_at),
        Some(timing) => {
            let base = linkage.ground_angle().to_degrees();
            let crank_deg: Vec<f64> = timing.crank_deg.iter().map(|deg| base + deg).collect();
            assess(problem, &linkage, &crank_deg, &candidate.t1_at)
        }
    }
}

fn search_here(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Result<SearchOutcome, PopulationError> {
    match problem.spec().solve.method {
        Method::Genetic => alone(problem, Population::Genetic, budget, observer, keeper),
        Method::DifferentialEvolution => {
            alone(problem, Population::DifferentialEvolution, budget, observer, keeper)
        }
        Method::LeastSquares => {
            let limit = problem.spec().solve.evaluations;
            let share = limit - reserve(problem, limit);
            let mut local = local_search(problem, share, share, budget, observer, keeper);
            local.finish(problem, limit, budget);
            Ok(local.outcome(problem))
        }
        // Exact answers are not approximated; if the points have none, `continuation` searches as `auto`.
        Method::Auto | Method::Continuation => auto(problem, budget, observer, keeper),
    }
}

fn alone(
    problem: &Problem,
    which: Population,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Result<SearchOutcome, PopulationError> {
    let spec = &problem.spec().solve;
    let end = population::search_kept(problem, which, spec.evaluations, budget, observer, keeper)?;
    let (candidates, others) = divided(problem, end.found, spec.candidates);
    Ok(SearchOutcome {
        candidates,
        others,
        used: vec![which.name().into()],
        reason: budget.stop_reason().unwrap_or(end.reason),
        evaluations: Evaluations { objective: end.evaluations, positions: end.positions },
        exact: None,
        repeats: None,
    })
}

/// The state of a multistart.
pub(super) struct Local {
    /// Judged candidates.
    pub(super) found: Vec<Candidate>,
    /// The evaluations used.
    pub(super) evaluations: Evaluations,
    /// The reason why it ended.
    pub(super) reason: Reason,
    /// Names of the methods that ran.
    pub(super) used: Vec<String>,
    /// The repeated hits of the best answer.
    pub(super) repeats: Option<Repeats>,
}

impl Local {
    /// Runs the polish that the objective and the tolerances ask for.
    fn finish(&mut self, problem: &Problem, limit: u64, budget: &Budget<'_>) {
        improve(problem, &mut self.found, &mut self.evaluations, limit, budget);
        if let Some(reason) = budget.stop_reason() {
            self.reason = reason;
        }
    }

    fn outcome(self, problem: &Problem) -> SearchOutcome {
        let (candidates, others) = divided(problem, self.found, problem.spec().solve.candidates);
        SearchOutcome {
            candidates,
            others,
            used: self.used,
            reason: self.reason,
            evaluations: self.evaluations,
            exact: None,
            // The largest deviation is polished afterwards: its basins are others.
            repeats: self.repeats.filter(|_| problem.spec().solve.objective == Objective::SumOfSquares),
        }
    }
}

/// Runs the local search: for free timing [`free`]; for prescribed timing the reduced form first, and if there is none
/// or it found nothing acceptable within its share, rounds in the physical parameters.
pub(super) fn local_search(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Local {
    if matches!(problem.task().timing(), Timing::Free) {
        return free::search(problem, limit, patience, budget, observer, keeper);
    }
    let share = (patience as f64 * REDUCED_SHARE) as u64;
    let Some(timed) = timed::search(problem, limit, share, budget, observer, keeper) else {
        return rounds(problem, limit, patience, budget, observer, keeper);
    };
    let mut local = Local {
        found: timed.found,
        evaluations: timed.evaluations,
        reason: timed.reason,
        used: vec!["variable-projection".into()],
        repeats: timed.repeats,
    };
    if timed.polished {
        local.used.push("least-squares".into());
    }
    let gave_up = matches!(local.reason, Reason::EvaluationLimit | Reason::Stalled);
    let left = limit.saturating_sub(local.evaluations.objective);
    if !gave_up || left == 0 || local.found.iter().any(|c| c.accepted) {
        return local;
    }
    let patience = patience.saturating_sub(local.evaluations.objective).min(left);
    let more = rounds(problem, left, patience, budget, observer, keeper);
    local.found.extend(more.found);
    local.evaluations.objective += more.evaluations.objective;
    local.evaluations.positions += more.evaluations.positions;
    local.reason = more.reason;
    local.repeats = more.repeats;
    if !timed.polished {
        local.used.extend(more.used);
    }
    local
}

/// The state of `rounds` between two batches, on which the next ones depend besides the problem and the budget.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RoundsState {
    found: Vec<Candidate>,
    evaluations: Evaluations,
    best: Option<Candidate>,
    hits: usize,
    known: usize,
    quiet: u64,
    batch: u64,
    draws: u64,
}

impl RoundsState {
    fn ended(self, reason: Reason) -> Local {
        let hits = self.hits as u64;
        Local {
            repeats: self.best.is_some().then(|| Repeats::new(self.batch * BATCH, hits, hits)),
            found: self.found,
            evaluations: self.evaluations,
            reason,
            used: vec!["least-squares".into()],
        }
    }
}

/// Runs rounds for prescribed timing in the physical parameters until the best is believed, until `limit` evaluations
/// are used, or until `patience` are used without an acceptable candidate.
fn rounds(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Local {
    let wanted = problem.spec().solve.candidates;
    let exact = exact_cost(problem);
    let starts = Starts::new(problem);
    let earlier = keeper.and_then(|keeper| keeper.earlier().rounds.clone());
    let earlier = earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best));
    let mut at = earlier.unwrap_or_default();
    let keep = |stopped, at: &RoundsState| {
        if let Some(keeper) = keeper {
            keeper.keep(stopped, |state| state.rounds = Some(at.clone()));
        }
    };
    // No round so far came near its allowance of evaluations.
    let mut ample = true;
    loop {
        let stop = budget.stop_reason();
        if ample {
            keep(stop.is_some(), &at);
        }
        if let Some(reason) = stop {
            return at.ended(reason);
        }
        // The evaluations left are shared evenly, so that the budget is never exceeded whatever the rounds need.
        let left = limit.saturating_sub(at.evaluations.objective);
        let allowance = |index: u64| left / BATCH + u64::from(index % BATCH < left % BATCH);
        let rounds: Vec<_> = (at.batch * BATCH..(at.batch + 1) * BATCH)
            .into_par_iter()
            .map(|index| round(problem, &starts, index, allowance(index), budget))
            .collect();
        let stop = budget.stop_reason();
        if stop.is_some() && ample {
            keep(true, &at);
        }
        ample &= (at.batch * BATCH..)
            .zip(&rounds)
            .all(|(index, round)| spared(round.evaluations, allowance(index)));
        at.batch += 1;
        for outcome in rounds {
            at.draws += outcome.draws;
            at.evaluations.objective += outcome.evaluations;
            at.evaluations.positions += outcome.positions;
            let mut hit = false;
            for candidate in outcome.found {
                if promising(problem, &candidate) {
                    let error = searched(problem, &candidate);
                    let bar = at.best.as_ref().map_or(f64::INFINITY, |b| searched(problem, b));
                    if error < bar - SAME_OPTIMUM * bar.max(exact) {
                        at.hits = 0;
                    }
                    if error <= bar + (SAME_OPTIMUM * bar).max(exact) {
                        hit = true;
                    }
                    if error < bar {
                        at.best = Some(candidate.clone());
                    }
                }
                at.found.push(candidate);
            }
            at.hits += usize::from(hit);
        }
        sort(problem, &mut at.found);
        at.found.truncate(KEPT);
        // A batch that was cut short does not count for convergence, and must not pass for a whole one.
        if let Some(reason) = stop {
            return at.ended(reason);
        }
        let shown = at.best.as_ref().or(at.found.first());
        observer(&Progress {
            phase: "least-squares",
            evaluations: at.evaluations.objective,
            budget: limit,
            best_sum_sq: shown.map(|c| c.error.sum_sq),
            accepted: at.best.as_ref().is_some_and(|b| b.accepted),
            hits: at.best.as_ref().map(|_| HitsSoFar { came: at.hits, wanted: HITS }),
        });
        if at.hits >= HITS && at.batch >= LEAST_BATCHES {
            let distinct = count_distinct(problem, &at.found, wanted);
            at.quiet = if distinct > at.known { 0 } else { at.quiet + 1 };
            at.known = distinct;
            if distinct >= wanted || at.quiet >= QUIET_BATCHES {
                let is_exact = at.best.as_ref().is_some_and(|b| b.error.sum_sq <= exact_sum_sq(problem));
                return at.ended(if is_exact { Reason::TargetReached } else { Reason::Converged });
            }
        }
        // Draws that cannot be assembled cost no evaluation, and must not go on for ever.
        let used = at.evaluations.objective;
        let spent = used.max(at.draws);
        if spent >= limit || (spent >= patience && at.best.is_none()) {
            return at.ended(if used < patience { Reason::Stalled } else { Reason::EvaluationLimit });
        }
    }
}

fn auto(
    problem: &Problem,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Result<SearchOutcome, PopulationError> {
    let limit = problem.spec().solve.evaluations;
    let patience = (limit as f64 * LOCAL_SHARE) as u64;
    let mut local =
        local_search(problem, limit - reserve(problem, limit), patience, budget, observer, keeper);
    local.finish(problem, limit, budget);
    // Converged without an accepted answer means a tolerance that no polish could meet.
    let gave_up = matches!(local.reason, Reason::EvaluationLimit | Reason::Stalled | Reason::Converged);
    let spent = local.evaluations.objective >= limit;
    if !gave_up || spent || local.found.iter().any(|c| c.accepted) {
        return Ok(local.outcome(problem));
    }
    let left = limit.saturating_sub(local.evaluations.objective);
    let (led, cost) = relaxed::search(problem, left / RELAXED_SHARE, budget, observer);
    if cost.objective > 0 {
        local.used.push(crate::record::RELAXED.into());
        local.evaluations.objective += cost.objective;
        local.evaluations.positions += cost.positions;
        local.found.extend(led);
        local.finish(problem, limit, budget);
        if local.found.iter().any(|c| c.accepted) {
            local.repeats = None;
            return Ok(local.outcome(problem));
        }
    }
    let left = limit.saturating_sub(local.evaluations.objective).max(1);
    let for_polish = left / POLISH_SHARE;
    let which = Population::DifferentialEvolution;
    let end = population::search_kept(
        problem,
        which,
        left - for_polish - reserve(problem, left),
        budget,
        observer,
        keeper,
    )?;
    local.used.push(which.name().into());
    local.evaluations.objective += end.evaluations;
    local.evaluations.positions += end.positions;
    local.found.extend(end.found);
    local.repeats = None;
    let n = problem.task().len() as u64;
    let each = for_polish / end.starts.len().max(1) as u64;
    let worth_it = if each == 0 { Vec::new() } else { end.starts };
    let judging = budget.judging(problem.task().len());
    let polished: Vec<_> = worth_it
        .into_par_iter()
        .map(|start| {
            if budget.stopped() {
                return (None, 0);
            }
            let fit = polish(problem, start, LONG_STEPS, LONG_ROUNDS, each, budget);
            let end = fit.end.filter(|_| judging.may_go_on());
            (end.and_then(|end| judged(problem, &end)), fit.evaluations)
        })
        .collect();
    for (candidate, evaluations) in polished {
        local.evaluations.objective += evaluations;
        local.evaluations.positions += n * evaluations;
        local.found.extend(candidate);
    }
    local.finish(problem, limit, budget);
    if let Some(reason) = budget.stop_reason() {
        local.reason = reason;
    } else {
        local.reason = end.reason;
    }
    Ok(local.outcome(problem))
}
