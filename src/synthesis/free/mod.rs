//! Multistart search for free timing: starts by arc length or from the atlas, joint Levenberg-Marquardt fits on the
//! torus, and a stopping rule by repeated hits of the best answer.
//!
//! A *round* takes `SCREEN` drawn starts, or matches of the atlas if the target has points enough, or starts near known
//! ends and along the differences between them. It fits the `SHORT` most promising for a few steps, fits the best
//! `MIDDLE` of those further, and finishes those that can still matter.
//!
//! Dense targets are explored in groups of points ([`super::coarse`]); now and then all points are explored, to find
//! detail that grouping blurs. The correspondence between the points and the curve is recomputed for their ends
//! (`reassign`), and these are fitted again for as long as that gains. The ends of a batch are finished on all points
//! after it, each of them once however many rounds reached it. Ends whose points have strayed to a circuit or branch
//! that the referee will refuse are led back (`required`). Rounds run in parallel in batches of `BATCH` and are read in
//! their order: the number of threads changes nothing but the time. Ends are judged by the referee in order of
//! increasing error until enough of them are accepted.
//!
//! *Stopping rule*: as many independent rounds as [`Hits`] gives (rounds that start near known ends do not count) have
//! reached the best error within `SAME_OPTIMUM`, or four or more times as many within `NEARLY`, for an optimum that is
//! approached and hardly reached; and either as many distinct answers as were asked for are known or `QUIET_BATCHES`
//! batches brought no new one. Sparse targets are searched through `LEAST_BATCHES` batches at least, so that rounds
//! near known ends get their turn. On a dense target the rule depends on the residuals. If they are noise, uncorrelated
//! from point to point, `NOISE_HITS` answers within `IN_NOISE` of each other are enough. If neighbouring residuals are
//! correlated, the linkage misses a shape that another linkage may have, and `PATIENT_BATCHES` batches are searched at
//! least. An exact answer needs no second hit.

use super::atlas::Matches;
use super::coarse::Coarse;
use super::keeper::Keeper;
use super::multistart::judged;
use super::plan::{Local, SAME_OPTIMUM};
use super::polish::{basins_wanted, promising};
use super::starts::Starts;
use super::{Budget, HitsSoFar, Observer, Progress, repeats};
use crate::judge::rank::{count_distinct, exact_cost, exact_sum_sq, searched};
use crate::mechanism::dot;
use crate::record::{Candidate, Evaluations, Reason};
use crate::task::Problem;
use crate::task::forms::start::Start;
use batch::Batch;
use round::Setup;
use state::{Counts, Resumed};

mod batch;
mod moves;
mod required;
mod round;
mod state;

pub use state::FreeState;

/// Number of different ends near which later rounds start.
const LEADING: usize = 12;
/// Relative difference of merits below which ends on the explored points are the same.
const DIFFERENT: f64 = 1e-3;
/// Rounds that run in parallel before any is read.
const BATCH: u64 = 8;
/// The number of independent rounds that have to reach the best answer before it is believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hits {
    /// Rounds that reach it within `SAME_OPTIMUM`.
    pub same: usize,
    /// Rounds that reach it within `NEARLY`.
    pub near: usize,
}

/// Hits for sparse targets: each point counts for much, so optima are many and rare ones worth waiting for.
pub const SPARSE_HITS: Hits = Hits { same: 6, near: 24 };
/// Hits for dense targets: many points determine the linkage better, and a round costs more.
pub const DENSE_HITS: Hits = Hits { same: 4, near: 12 };
/// Relative difference of errors below which they are nearly the same optimum.
pub const NEARLY: f64 = 1e-3;
/// Relative difference below which errors of noise are equally good: the noise of n points has a sum of squares with a
/// relative spread of (2/n)^(1/2).
const IN_NOISE: f64 = 1e-2;
/// Rounds with equally good answers that suffice if the errors are noise.
const NOISE_HITS: usize = 5;
/// Least number of batches for a sparse target.
const LEAST_BATCHES: u64 = 5;
/// Batches in which a round on a dense target fits only its best start further.
const DENSE_BATCHES: u64 = 2;
/// Least number of batches for a dense target whose errors are not noise.
const PATIENT_BATCHES: u64 = 60;
/// Correlation of the errors of neighbouring points above which they are not noise.
const ALIKE: f64 = 0.3;
/// Of `WHOLE_EVERY` batches on a dense target of at most `WHOLE_MOST` points one explores all of its points: the fourth
/// if the errors are noise, else the second.
const WHOLE_EVERY: u64 = 8;
const WHOLE_IN_NOISE: u64 = 3;
const WHOLE_ELSE: u64 = 1;
const WHOLE_MOST: usize = 200;
/// Batches without a new distinct answer that end a search for further ones.
const QUIET_BATCHES: u64 = 6;
/// Number of ends kept.
const KEPT: usize = 400;

/// The end of a fit, judged or not yet.
#[derive(Clone, Debug)]
struct End {
    start: Start,
    merit: f64,
    /// The referee's result. `None`: not judged yet; `Some(None)`: cannot be judged.
    verdict: Option<Option<Candidate>>,
}

/// A stage of the search (on groups of points, or on all points) with its memory.
struct Stage<'a> {
    setup: Setup<'a>,
    memory: Memory,
}

/// The results of a stage's batches so far.
#[derive(Clone, Debug)]
struct Memory {
    /// The least merit on the explored points.
    bar: f64,
    /// The best different ends on the explored points.
    leading: Vec<(f64, Start)>,
    /// The merits, on the explored points and on all points, of the ends that have been finished after their batch.
    finished: Vec<(f64, f64)>,
    /// Rounds so far.
    index: u64,
}

impl Memory {
    const NONE: Memory = Memory { bar: f64::INFINITY, leading: Vec::new(), finished: Vec::new(), index: 0 };
}

/// Returns whether the errors of the best acceptable end are noise.
fn is_noise(problem: &Problem, ends: &[End]) -> bool {
    let best = ends.iter().filter_map(|end| end.verdict.as_ref()?.as_ref()).find(|c| promising(problem, c));
    best.is_some_and(|best| likeness(problem, best) < ALIKE)
}

/// Returns the correlation of the errors of neighbouring points: sum <r_j, r_j+1> / sum |r_j|^2, near 0 for noise, near
/// 1 for a smooth misfit.
fn likeness(problem: &Problem, candidate: &Candidate) -> f64 {
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let Some(error) = problem.task().errors(&candidate.linkage, &radians, &candidate.t1_at) else {
        return 1.0;
    };
    let whole: f64 = error.structural.iter().map(|r| r.norm_sqr()).sum();
    let alike: f64 = error.structural.windows(2).map(|w| dot(w[0], w[1])).sum();
    if whole > 0.0 { alike / whole } else { 1.0 }
}

/// Runs rounds until the best is believed, until `limit` evaluations are used, or until `patience` are used without an
/// acceptable candidate.
pub(super) fn search(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Local {
    let wanted = basins_wanted(problem);
    let coarse = Coarse::of(problem);
    let exact = exact_cost(problem);
    let whole = Starts::new(problem);
    let grouped = coarse.as_ref().map(|coarse| Starts::new(&coarse.problem));
    let matches = |starts: &Starts<'_>| (starts.arc().len() >= LEAST_MATCHED).then(|| Matches::of(starts));
    let stage = |coarse, starts| Stage {
        setup: Setup { problem, coarse, starts, matches: matches(starts), single: wanted == 1, exact },
        memory: Memory::NONE,
    };
    let mut stages = vec![stage(coarse.as_ref(), grouped.as_ref().unwrap_or(&whole))];
    let mut local = Local {
        found: Vec::new(),
        evaluations: Evaluations::default(),
        reason: Reason::EvaluationLimit,
        used: vec!["least-squares".into()],
        repeats: None,
    };
    let mut ends: Vec<End> = Vec::new();
    let mut best_merits: Vec<f64> = Vec::new();
    let mut count = Counts::default();
    let points = coarse.as_ref().map_or(problem.task().len(), |coarse| coarse.problem.task().len());
    let earlier = keeper.and_then(|keeper| keeper.earlier().free.as_ref());
    if let Some((state, begun)) = earlier.and_then(|state| Some((state, state.stages(problem, points)?))) {
        if begun > stages.len() {
            stages.push(stage(None, &whole));
        }
        Resumed { counts: count, evaluations: local.evaluations, best_merits, ends } =
            state.resume(problem, &mut stages);
    }
    let keep = |stopped, count, evaluations, merits: &[f64], stages: &[Stage<'_>], ends: &[End]| {
        if let Some(keeper) = keeper {
            keeper.keep(stopped, |at| {
                at.free = Some(FreeState::of(count, evaluations, merits, stages, ends));
            });
        }
    };
    // No round so far came near its allowance of evaluations.
    let mut ample = true;
    loop {
        let stop = budget.stop_reason();
        if ample {
            keep(stop.is_some(), count, local.evaluations, &best_merits, &stages, &ends);
        }
        if let Some(reason) = stop {
            local.reason = reason;
            break;
        }
        let left = limit.saturating_sub(local.evaluations.objective);
        // Now and then all points are explored, to find detail that grouping blurs.
        let grouped_few = coarse.is_some() && problem.task().len() <= WHOLE_MOST;
        let on_all_at = if is_noise(problem, &ends) { WHOLE_IN_NOISE } else { WHOLE_ELSE };
        let on_all = grouped_few && count.batch % WHOLE_EVERY == on_all_at;
        if stages.len() == 1 && on_all {
            stages.push(stage(None, &whole));
        }
        let stage_now = usize::from(on_all);
        let Stage { setup, memory } = &stages[stage_now];
        let batch = Batch::run(setup, memory, count.batch * BATCH, left, budget);
        // A batch that was cut short does not count for convergence, and must not pass for a whole one.
        let stop = budget.stop_reason();
        if stop.is_some() && ample {
            keep(true, count, local.evaluations, &best_merits, &stages, &ends);
        }
        ample &= batch.ample;
        stages[stage_now].memory = batch.memory;
        count.batch += 1;
        count.draws += batch.draws;
        local.evaluations.objective += batch.cost.evaluations;
        local.evaluations.positions += batch.cost.positions;
        best_merits.extend(batch.best_merits);
        ends.extend(batch.ends);
        ends.sort_by(|one, other| one.merit.total_cmp(&other.merit));
        // Only some of the refused ends are kept: they must not crowd out the accepted.
        let mut refused = 0;
        ends.retain(|end| {
            let unfit =
                end.verdict.as_ref().is_some_and(|v| v.as_ref().is_none_or(|c| !promising(problem, c)));
            refused += usize::from(unfit);
            !unfit || refused <= KEPT / 4
        });
        ends.truncate(KEPT);
        let best = judge_from_the_best(problem, &mut ends, wanted, exact, budget);
        if let Some(reason) = stop {
            local.reason = reason;
            break;
        }
        let within = |error: f64, part: f64| repeats::came(&best_merits, error, part, exact);
        let hits = if coarse.is_some() { DENSE_HITS } else { SPARSE_HITS };
        observer(&Progress {
            phase: "least-squares",
            evaluations: local.evaluations.objective,
            budget: limit,
            best_sum_sq: best.as_ref().or(shown(&ends)).map(|c| c.error.sum_sq),
            accepted: best.as_ref().is_some_and(|b| b.accepted),
            hits: best
                .as_ref()
                .filter(|b| b.accepted)
                .map(|b| HitsSoFar { came: within(searched(problem, b), SAME_OPTIMUM), wanted: hits.same }),
        });
        if let Some(best) = &best {
            let error = searched(problem, best);
            let is_exact = error <= exact;
            let is_noise = coarse.is_some() && is_noise(problem, &ends);
            let believed = within(error, SAME_OPTIMUM) >= hits.same
                || within(error, NEARLY) >= hits.near
                || (is_noise && within(error, IN_NOISE) >= NOISE_HITS);
            let least = match &coarse {
                _ if is_exact => 0,
                None => LEAST_BATCHES,
                Some(_) if is_noise => 1,
                Some(_) => PATIENT_BATCHES,
            };
            if (believed && count.batch >= least) || (is_exact && wanted == 1) {
                let now =
                    if wanted == 1 { 1 } else { count_distinct(problem, &accepted(problem, &ends), wanted) };
                count.quiet = if now > count.known { 0 } else { count.quiet + 1 };
                count.known = now;
                if now >= wanted || count.quiet >= QUIET_BATCHES {
                    let is_exact = best.error.sum_sq <= exact_sum_sq(problem);
                    local.reason = if is_exact { Reason::TargetReached } else { Reason::Converged };
                    break;
                }
            }
        }
        // Draws that cannot be assembled cost no evaluation, and must not go on for ever.
        let used = local.evaluations.objective;
        let spent = used.max(count.draws);
        if spent >= limit || (spent >= patience && best.is_none()) {
            local.reason = if used < patience { Reason::Stalled } else { Reason::EvaluationLimit };
            break;
        }
    }
    let best = accepted(problem, &ends).iter().map(|c| searched(problem, c)).min_by(f64::total_cmp);
    local.repeats = best.map(|best| repeats::counted(&best_merits, best, exact));
    local.found = ends.into_iter().filter_map(|end| end.verdict.flatten()).collect();
    local
}

/// Number of points below which a target is not matched with the atlas.
pub const LEAST_MATCHED: usize = 24;

/// Judges ends in order of increasing merit: until the first accepted one if one answer is wanted, else all that can be
/// among the best.
fn judge_from_the_best(
    problem: &Problem,
    ends: &mut [End],
    wanted: usize,
    exact: f64,
    budget: &Budget<'_>,
) -> Option<Candidate> {
    let judging = budget.judging(problem.task().len());
    let mut best: Option<Candidate> = None;
    let mut count = 0;
    let enough = if wanted == 1 { 1 } else { 8 * wanted };
    for end in ends.iter_mut() {
        if count >= enough {
            break;
        }
        if end.verdict.is_none() && !judging.may_go_on() {
            continue;
        }
        let verdict = end.verdict.get_or_insert_with(|| judged(problem, &end.start));
        let Some(candidate) = verdict.as_ref().filter(|c| promising(problem, c)) else { continue };
        count += 1;
        let better = best
            .as_ref()
            .is_none_or(|b| searched(problem, candidate).max(exact) < searched(problem, b).max(exact));
        if better {
            best = Some(candidate.clone());
        }
    }
    best
}

fn accepted(problem: &Problem, ends: &[End]) -> Vec<Candidate> {
    ends.iter().filter_map(|end| end.verdict.clone().flatten()).filter(|c| promising(problem, c)).collect()
}

fn shown(ends: &[End]) -> Option<&Candidate> {
    ends.iter().find_map(|end| end.verdict.as_ref()?.as_ref())
}
