//! Search for six-bars and eight-bars for a path of free timing: the limits of a problem as those of [`dyad_chains`](super::dyad_chains),
//! and its answers as judged candidates.

use super::driver::Found;
use super::dyad_chains::{DyadChainLimits, DyadChainOutcome, DyadChainProgress, Request, Watch, search};
use super::{Context, Progress};
use crate::judge::assess::assess;
use crate::judge::rank::exact_cost;
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, DyadChainKind, LinkageKind, MultiLoop};
use crate::record::{Candidate, Reason, Repeats};
use crate::task::Problem;
use crate::task::spec::{DirectionPolicy, Limits};

/// The name of the phase.
const PHASE: &str = "least-squares";
/// Islands that have to come to the best answer before the search ends.
const REPEATS: usize = 3;
/// The most answers that are judged, for each that is listed.
const JUDGED: usize = 3;
/// Positions that a step of a fit computes at a point: the point, and its derivatives.
const POSITIONS: u64 = 1;

/// Searches for linkages of a kind with several loops with at most `limit` evaluations; nothing where the kind has one loop.
pub(super) fn search_for(context: Context<'_>, kind: LinkageKind, limit: u64) -> Found {
    let problem = context.problem;
    let Some(dyads) = kind.dyads() else { return Found::nothing() };
    let kinds = DyadChainKind::all(dyads);
    let clockwise = problem.spec().require.direction == DirectionPolicy::Cw;
    let points = points(problem, clockwise);
    let request = Request {
        points: &points,
        closed: problem.task().closed(),
        counter_clockwise: problem.spec().require.direction != DirectionPolicy::Any,
        kinds: &kinds,
        limits: limits(problem),
        seed: problem.spec().solve.seed,
        evaluations: limit,
        enough: 0.0,
        repeats: Some(REPEATS),
        answers: JUDGED * problem.spec().solve.candidates,
    };
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().dyad_chains.get(&kind).cloned());
    let observer = |now: &DyadChainProgress| {
        let sum_sq = now.best_rms * now.best_rms * points.len() as f64;
        (context.observer)(&Progress {
            best_sum_sq: Some(sum_sq).filter(|sum| sum.is_finite()),
            ..Progress::of(PHASE, now.evaluations, limit)
        });
    };
    let keep = |state: &super::dyad_chains::DyadChainState| {
        if let Some(keeper) = context.keeper {
            keeper.keep(context.stopped(), |all| {
                all.dyad_chains.insert(kind, state.clone());
            });
        }
    };
    let watch = Watch { stopped: &|| context.stopped(), observer: &observer, keeper: &keep };
    let Some(outcome) = search(&request, watch, earlier.as_ref()) else { return Found::nothing() };
    found(context, &outcome, clockwise, limit)
}

/// Returns what a search has found, its answers judged.
fn found(context: Context<'_>, outcome: &DyadChainOutcome, clockwise: bool, limit: u64) -> Found {
    let problem = context.problem;
    let judging = context.judging();
    let answers = outcome.answers.iter().chain(&outcome.best_of_kinds);
    let mut candidates: Vec<Candidate> = Vec::new();
    for answer in answers {
        if !judging.may_go_on() {
            break;
        }
        let Ok(linkage) = MultiLoop::of_dyad_chain(&answer.chain) else { continue };
        if candidates.iter().any(|known| known.linkage.multi_loop() == Some(&linkage)) {
            continue;
        }
        let ground = answer.chain.ground_angle();
        let mut angles: Vec<f64> = answer.phases.iter().map(|phase| wrapped(phase + ground)).collect();
        if clockwise {
            angles.reverse();
        }
        if problem.task().repeats_first() {
            angles.push(angles[0]);
        }
        let assemblies = vec![linkage.assembly(); angles.len()];
        let (crank_deg, t1_at): (Vec<f64>, Vec<AssemblyMode>) =
            unwrapped(problem, linkage, angles, assemblies);
        candidates.extend(assess(problem, linkage, &crank_deg, &t1_at));
    }
    let best = outcome.islands.iter().copied().fold(f64::INFINITY, f64::min);
    let came =
        |within: f64| outcome.islands.iter().filter(|rms| **rms <= best * (1.0 + within)).count() as u64;
    let hits = came(1e-3);
    let is_exact = |c: &Candidate| c.accepted && c.error.objective <= exact_cost(problem);
    let reason = if candidates.iter().any(is_exact) {
        Reason::TargetReached
    } else if hits >= REPEATS as u64 {
        Reason::Converged
    } else if outcome.evaluations >= limit {
        Reason::EvaluationLimit
    } else {
        Reason::Stalled
    };
    let mut evaluations = context.cost(outcome.evaluations);
    evaluations.positions *= POSITIONS;
    Found {
        repeats: (hits > 0).then(|| Repeats::new(outcome.islands.len() as u64, came(1e-6), hits)),
        candidates,
        evaluations,
        reason,
        used: vec![PHASE.into()],
    }
}

/// Returns the points that are drawn: without the last one where it repeats the first, in reverse for a crank that has to turn
/// clockwise.
fn points(problem: &Problem, reversed: bool) -> Vec<Complex> {
    let task = problem.task();
    let count = task.len() - usize::from(task.repeats_first());
    let mut points = task.points()[..count].to_vec();
    if reversed {
        points.reverse();
    }
    points
}

/// Returns the limits of a problem.
fn limits(problem: &Problem) -> DyadChainLimits {
    let (require, design) = (&problem.spec().require, &problem.spec().design);
    let region = require.pivots_in.as_ref().map(|region| {
        let [x0, y0, x1, y1] = region.corners();
        [Complex::new(x0, y0), Complex::new(x1, y1)]
    });
    let both = |pivot: Option<[Limits; 2]>| {
        let own = pivot.map(|[x, y]| [Complex::new(x.0, y.0), Complex::new(x.1, y.1)]);
        match (own, region) {
            (Some([low, high]), Some([from, to])) => Some([
                Complex::new(low.re.max(from.re), low.im.max(from.im)),
                Complex::new(high.re.min(to.re), high.im.min(to.im)),
            ]),
            (own, region) => own.or(region),
        }
    };
    DyadChainLimits {
        transmission_min: require.transmission_deg_min.unwrap_or(0.0).to_radians(),
        longest_max: require.longest_max.unwrap_or(f64::INFINITY),
        link_ratio_max: require.link_ratio_max,
        footprint_in: require
            .footprint_in
            .map(|[x0, y0, x1, y1]| [Complex::new(x0, y0), Complex::new(x1, y1)]),
        extent_max: require.extent_max.unwrap_or(f64::INFINITY),
        pivots_in: [both(design.crank_pivot), both(design.follower_pivot), region],
    }
}
