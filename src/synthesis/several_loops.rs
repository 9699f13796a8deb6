//! Search for six-bars and eight-bars for a path: the limits of a problem as those of [`dyad_chains`](super::dyad_chains),
//! and its answers as judged candidates.

use super::driver::Found;
use super::dyad_chains::{
    DyadChainAnswer, DyadChainLimits, DyadChainOutcome, DyadChainProgress, DyadChainTiming, Held, Request,
    Watch, refit, run, search,
};
use super::{Context, Progress};
use crate::judge::assess::{assess, assess_again};
use crate::judge::rank::exact_cost;
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, DyadChainKind, LinkageKind, MultiLoop};
use crate::record::{Candidate, Reason, Repeats};
use crate::task::spec::{DesignSpec, DirectionPolicy, Limits};
use crate::task::without_several_loops::WithoutSeveralLoops;
use crate::task::{AngleOffset, Problem, Timing};

/// The name of the phase.
const PHASE: &str = "least-squares";
/// Islands that have to come to the best answer before the search ends.
const REPEATS: usize = 3;
/// The most evaluations of a search for a linkage that is offered beside four-bars.
const OFFERED: u64 = 120_000;
/// Points of a path below which none is offered: a linkage of many parameters passes a few points anyhow.
const LEAST_POINTS: usize = 20;
/// Trial steps of a fit under tightened limits.
const REFIT_STEPS: u64 = 60;
/// Greatest length of a linkage with prescribed timing where none is asked for, in sizes: as the default bounds of a four-bar's.
const LONGEST_TIMED: f64 = 5.0;
/// The most answers that are judged, for each that is listed.
const JUDGED: usize = 3;

/// Searches for six-bars, then for eight-bars, for the path of a problem of four-bars that has a tolerance, with at most
/// `OFFERED` evaluations each; returns the first acceptable one, annotated.
pub fn beside_four_bars(context: Context<'_>) -> Option<Candidate> {
    let problem = context.problem;
    let (spec, task) = (problem.spec(), problem.task());
    let tolerance = task.tolerances()?.iter().copied().reduce(f64::min)?;
    // Bounds of a four-bar's own lengths say nothing of a six-bar.
    let mut default = DesignSpec::default();
    default.resolve(task);
    if task.len() < LEAST_POINTS
        || spec.design != default
        || spec.require.types.iter().any(|kind| !kind.input_turns_fully())
        || WithoutSeveralLoops::of(&spec.task, &spec.solve, &spec.require).is_some()
    {
        return None;
    }
    [LinkageKind::SixBar, LinkageKind::EightBar].into_iter().find_map(|kind| {
        let mut asked = spec.clone();
        (asked.design.mechanism, asked.solve.candidates) = (vec![kind], 1);
        asked.require.types.clear();
        let within = problem.with(asked).ok()?;
        let within = context.of(&within).silent();
        if context.stopped() {
            return None;
        }
        // Errors of a third of the tolerance in the mean are hardly anywhere beyond it.
        let found = search_until(within, kind, spec.solve.evaluations.min(OFFERED), tolerance / 3.0);
        let judged = found.candidates.iter().filter_map(|c| assess_again(problem, c));
        let mut best = judged.into_iter().find(|c| c.accepted)?;
        super::answers::complete(problem, &mut best);
        Some(best)
    })
}

/// Fits a candidate of several loops under the limits of a problem with at most so many evaluations; returns the end, judged, and the
/// evaluations used.
pub(super) fn refitted(context: Context<'_>, from: &Candidate, evaluations: u64) -> (Option<Candidate>, u64) {
    refitted_holding(context, from, &[], evaluations.min(REFIT_STEPS))
}

/// As [`refitted`], with dimensions at given values, up to the rounding of a fit.
pub(super) fn refitted_holding(
    context: Context<'_>,
    from: &Candidate,
    held: &[Held],
    evaluations: u64,
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    let chain = from.linkage.multi_loop().and_then(MultiLoop::to_dyad_chain);
    let Some((chain, kind)) = chain.zip(from.linkage.kind().dyads()) else { return (None, 0) };
    let (points, kinds) = (points(problem, false), DyadChainKind::all(kind));
    let request = request(problem, &points, &kinds, evaluations);
    let ground = chain.ground_angle();
    let phases: Vec<f64> =
        from.crank_deg.iter().take(points.len()).map(|deg| deg.to_radians() - ground).collect();
    let steps = usize::try_from(evaluations).unwrap_or(usize::MAX);
    match refit(&request, &chain, &phases, held, steps) {
        Some((answer, used)) => (judged(problem, &answer, false), used),
        None => (None, 0),
    }
}

/// Returns the request of a problem for these of its points.
fn request<'a>(
    problem: &'a Problem,
    points: &'a [Complex],
    kinds: &'a [DyadChainKind],
    evaluations: u64,
) -> Request<'a> {
    Request {
        points,
        timing: timing(problem, points.len()),
        closed: problem.task().closed(),
        counter_clockwise: problem.spec().require.direction != DirectionPolicy::Any,
        kinds,
        limits: limits(problem),
        seed: problem.spec().solve.seed,
        evaluations,
        enough: 0.0,
        repeats: Some(REPEATS),
        answers: JUDGED * problem.spec().solve.candidates,
    }
}

/// Returns the candidate of an answer; of one to the reversed points if the crank has to turn clockwise.
fn judged(problem: &Problem, answer: &DyadChainAnswer, reversed: bool) -> Option<Candidate> {
    let linkage = MultiLoop::of_dyad_chain(&answer.chain).ok()?;
    let ground = answer.chain.ground_angle();
    if let Timing::Prescribed { crank_angles, offset } = problem.task().timing() {
        let run = run(&answer.phases, crank_angles);
        let base = match offset {
            AngleOffset::Free => wrapped(answer.phases[0] + ground - run * crank_angles[0]).to_degrees(),
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => ground.to_degrees(),
        };
        let written = &problem.spec().task.timing.as_ref()?.crank_deg;
        let crank_deg: Vec<f64> = written.iter().map(|deg| base + run * deg).collect();
        let t1_at = vec![linkage.assembly(); crank_deg.len()];
        return assess(problem, linkage, &crank_deg, &t1_at);
    }
    let mut angles: Vec<f64> = answer.phases.iter().map(|phase| wrapped(phase + ground)).collect();
    if reversed {
        angles.reverse();
    }
    if problem.task().repeats_first() {
        angles.push(angles[0]);
    }
    let assemblies = vec![linkage.assembly(); angles.len()];
    let (crank_deg, t1_at): (Vec<f64>, Vec<AssemblyMode>) = unwrapped(problem, linkage, angles, assemblies);
    assess(problem, linkage, &crank_deg, &t1_at)
}

/// Searches for linkages of a kind with several loops with at most `limit` evaluations; nothing where the kind has one loop.
pub(super) fn search_for(context: Context<'_>, kind: LinkageKind, limit: u64) -> Found {
    search_until(context, kind, limit, 0.0)
}

/// As [`search_for`], ending at an rms error of `enough`.
fn search_until(context: Context<'_>, kind: LinkageKind, limit: u64, enough: f64) -> Found {
    let problem = context.problem;
    let Some(dyads) = kind.dyads() else { return Found::nothing() };
    let kinds = DyadChainKind::all(dyads);
    // Of prescribed timing the runs say the sense.
    let clockwise =
        problem.spec().require.direction == DirectionPolicy::Cw && *problem.task().timing() == Timing::Free;
    let points = points(problem, clockwise);
    let request = Request { enough, ..request(problem, &points, &kinds, limit) };
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().dyad_chains.get(&kind).cloned());
    let observer = |now: &DyadChainProgress| {
        let sum_sq = now.best_rms * now.best_rms * points.len() as f64;
        (context.observer)(&Progress {
            best_sum_sq: Some(sum_sq).filter(|sum| sum.is_finite()),
            // Its fits keep every limit but a tolerance.
            accepted: !problem.task().has_tolerances(),
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
    found(context, &outcome, clockwise)
}

/// Returns what a search has found, its answers judged.
fn found(context: Context<'_>, outcome: &DyadChainOutcome, clockwise: bool) -> Found {
    let problem = context.problem;
    let judging = context.judging();
    let answers = outcome.answers.iter().chain(&outcome.best_of_kinds);
    let mut candidates: Vec<Candidate> = Vec::new();
    for answer in answers {
        if !judging.may_go_on() {
            break;
        }
        let is_known = |found: &Candidate, known: &Candidate| known.linkage == found.linkage;
        candidates.extend(
            judged(problem, answer, clockwise)
                .filter(|found| !candidates.iter().any(|known| is_known(found, known))),
        );
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
    } else {
        Reason::EvaluationLimit
    };
    Found {
        repeats: (hits > 0).then(|| Repeats::new(outcome.islands.len() as u64, came(1e-6), hits)),
        candidates,
        evaluations: context.cost(outcome.evaluations),
        reason,
        used: vec![PHASE.into()],
    }
}

/// Returns the points that are drawn: without the last one where it repeats the first, in reverse for a crank that has to turn
/// clockwise.
fn points(problem: &Problem, reversed: bool) -> Vec<Complex> {
    let task = problem.task();
    // Crank angles say how a point that repeats the first is reached.
    let repeats = task.repeats_first() && *task.timing() == Timing::Free;
    let count = task.len() - usize::from(repeats);
    let mut points = task.points()[..count].to_vec();
    if reversed {
        points.reverse();
    }
    points
}

/// Returns the crank angles of a problem with prescribed timing at its first so many points.
fn timing(problem: &Problem, count: usize) -> Option<DyadChainTiming<'_>> {
    match problem.task().timing() {
        Timing::Free => None,
        Timing::Prescribed { crank_angles, offset } => {
            let angles = &crank_angles[..count];
            Some(DyadChainTiming { angles, offset: *offset, runs: problem.directions() })
        }
    }
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
        longest_max: require.longest_max.unwrap_or(match problem.task().timing() {
            Timing::Free => f64::INFINITY,
            Timing::Prescribed { .. } => LONGEST_TIMED * problem.task().size(),
        }),
        link_ratio_max: require.link_ratio_max,
        footprint_in: require
            .footprint_in
            .map(|[x0, y0, x1, y1]| [Complex::new(x0, y0), Complex::new(x1, y1)]),
        extent_max: require.extent_max.unwrap_or(f64::INFINITY),
        pivots_in: [both(design.crank_pivot), both(design.follower_pivot), region],
    }
}
