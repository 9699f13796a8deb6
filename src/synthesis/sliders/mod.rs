//! Multistart search for linkages with a slider, for paths and motions with prescribed or free timing: drawn shapes laid on
//! the target or dyads through its poses, Levenberg-Marquardt fits with the closure of their kind, and a stopping rule by
//! repeated hits of the best answer.
//!
//! A round draws `DRAWS` shapes of one kind ([`starts`]), or pairs dyads that suit the poses ([`guided`]), fits the `SHORT`
//! that are nearest to the target for a few steps and the best `LONG` of those to convergence, and has the ends judged. Kinds take turns. Rounds run in parallel in batches
//! and are read in their order: the number of threads changes nothing but the time. The search ends when enough rounds have
//! reached the best answer (or the search has gone on for several times as long as it took to reach it) and as many distinct
//! answers as were asked for are known, or no new one has come for `quiet_batches` of them; an exact answer needs no second
//! hit, and where one answer is asked for the rounds after it in its batch are not read. The best answers are fitted on to
//! the last digit at the end.

mod guided;
mod starts;

use super::Context;
use super::constants::Effort;
use super::constants::sliders::{
    BATCH, DRAWS, FAMILY_BATCHES, GLIMPSE, KEPT, LEAST_POLISHED, LONG, LONG_FIT, POLISH, SHORT, SHORT_FIT,
    STOPPING, TURNING,
};
use super::driver::{Allowance, Found, Standing, Strategy, drive, in_parallel};
use super::family::climb;
use super::multistart::{RoundOutcome, by_merit};
use super::states::{RepeatedState, SearchState};
use crate::judge::assess::assess_on_curve;
use crate::judge::rank::{exact_cost, searched, sort};
use crate::judge::unwrapped::unwrapped;
use crate::judge::warm::direction_and_offset;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, LoopKind};
use crate::numbers::arithmetic::streams::{Stream, stream, uniform};
use crate::numbers::optimise::levenberg_marquardt::{BlockLeastSquares, LmOptions, LmOutcome, solve};
use crate::record::{Candidate, CurveErrorRecord, ErrorRecord, Reason};
use crate::task::forms::slider::fit::{Angles, SliderFit};
use crate::task::forms::slider::limits::Limited;
use crate::task::forms::slider::shape::{Closure, FRAME, OFFSET, SliderShape};
use crate::task::ranges::Reference;
use crate::task::{AngleOffset, Problem, Timing};
use guided::Guided;
use rayon::prelude::*;
use starts::{Start, Target, free, prescribed};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicU64, Ordering};

/// The streams of the rounds begin here, so that they differ from those of the four-bars.
const STREAMS: u64 = 1 << 40;

/// A search for linkages with a slider, which may be run in two parts.
pub(super) struct Sliders<'a> {
    target: Target,
    /// The starts of a motion.
    guided: Option<Guided<'a>>,
    kinds: Vec<(LoopKind, Limited)>,
    exact: f64,
    /// The number of free parameters that are left when all targets are met.
    freedom: usize,
    /// The batches after which a glimpse ends.
    glimpse: Option<u64>,
    at: RepeatedState,
}

/// Fits a candidate with a slider to the context's problem from where it stands, with at most so many evaluations and until
/// the weighted sum of squares is at most `enough`. Returns the end, judged, and the evaluations used.
pub(super) fn refit(
    context: Context<'_>,
    from: &Candidate,
    (effort, evaluations, enough): (Effort, u64, f64),
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    let target = Target::of(problem);
    let Some(start) = start_at(problem, &target, from) else { return (None, 0) };
    let limits = Limited::of(problem, start.kind, target.centre, target.size);
    let exact = enough / (target.size * target.size);
    let mut fits = Fits { context, target: &target, exact, allowance: evaluations, used: 0 };
    let end = fits.run(&limits, start, effort);
    (end.and_then(|(_, end)| fits.judged(&end)), fits.used)
}

/// Returns the start at which a candidate stands; `None` of a four-bar, or if its loop is open at a point.
fn start_at(problem: &Problem, target: &Target, candidate: &Candidate) -> Option<Start> {
    let linkage = &candidate.linkage;
    let back = 1.0 / target.size;
    let shape = SliderShape::from_linkage(linkage)?.carried(Complex::new(back, 0.0), -target.centre * back);
    let position = |(deg, t1): (&f64, &AssemblyMode)| {
        let angle = deg.to_radians();
        let at = linkage.joints_with(angle, *t1)?;
        Some([Complex::from_polar(1.0, angle), at.coupler])
    };
    let (direction, offset) = direction_and_offset(problem, candidate);
    let is_free = matches!(problem.task().timing(), Timing::Free);
    let at = candidate.crank_deg.iter().zip(&candidate.t1_at);
    Some(Start {
        kind: linkage.kind(),
        x: shape.unknowns(offset, candidate.frame_deg.unwrap_or(0.0).to_radians()),
        positions: if is_free { at.map(position).collect::<Option<_>>()? } else { Vec::new() },
        assembly: linkage.assembly(),
        direction,
        turns: linkage.mobility().input_turns_fully(),
    })
}

/// Returns a start of a slider-crank with its line seen in the sense that is nearest to its bounds.
fn aligned(limits: &Limited, mut start: Start) -> Start {
    if start.kind == LoopKind::SliderCrank {
        let (angle, is_turned) = limits.line_angle(start.x[5]);
        start.x[5] = angle;
        if is_turned {
            start.x[4] = -start.x[4];
            start.assembly = start.assembly.opposite();
        }
    }
    start
}

/// A round's fits within an allowance of evaluations.
struct Fits<'a> {
    context: Context<'a>,
    target: &'a Target,
    /// The cost, in the target's units, below which nothing is left to gain.
    exact: f64,
    allowance: u64,
    used: u64,
}

impl Fits<'_> {
    fn is_at_its_end(&self) -> bool {
        self.context.stopped() || self.used >= self.allowance
    }

    /// Returns the fit of a start, its points in the order that they have.
    fn fit<'f, const R: usize>(&'f self, limits: &'f Limited, start: &Start) -> SliderFit<'f, R> {
        let problem = self.context.problem;
        let angles = match problem.task().timing() {
            Timing::Free => Angles::Free,
            Timing::Prescribed { offset, .. } => {
                Angles::Prescribed(problem.phases(start.direction), *offset, start.assembly)
            }
        };
        let fit = SliderFit {
            kind: start.kind,
            points: &self.target.points,
            weights: &self.target.weights,
            body: self.target.body.as_ref(),
            angles,
            limits,
            sense: 0.0,
            ends_meet: problem.task().repeats_first(),
        };
        if problem.order_required() { fit.in_order(&start.x, &start.positions) } else { fit }
    }

    /// Fits from a start, and returns the end with its merit; `None` if it is given up.
    fn run(&mut self, limits: &Limited, start: Start, effort: Effort) -> Option<(f64, Start)> {
        match self.target.body {
            None => self.run_on::<2>(limits, start, effort),
            Some(_) => self.run_on::<3>(limits, start, effort),
        }
    }

    /// As [`Fits::run`] with R rows a target.
    fn run_on<const R: usize>(
        &mut self,
        limits: &Limited,
        start: Start,
        effort: Effort,
    ) -> Option<(f64, Start)> {
        if self.is_at_its_end() {
            return None;
        }
        let (limits, start) = (limits.turning(start.turns), aligned(limits, start));
        let weight: f64 = self.target.weights.iter().sum();
        let options = LmOptions {
            max_steps: effort.steps,
            max_rounds: effort.rounds,
            max_evaluations: self.allowance - self.used,
            relative_reduction: effort.relative_reduction,
            exact_cost: 1e-6 * self.exact,
            feasibility: 1e-9,
            hopeless_cost: 0.04 * weight,
        };
        let fit = self.fit::<R>(&limits, &start);
        let (positions, context) = (start.positions.clone(), self.context);
        let end = solve(&fit, start.x, positions, &options, &|| context.stopped());
        self.used += end.evaluations;
        let usable = !matches!(end.outcome, LmOutcome::NoStart | LmOutcome::Abandoned);
        let merit = end.cost + weight * end.violation * end.violation;
        usable.then_some((merit, Start { x: end.x, positions: end.state, ..start }))
    }

    /// Draws the starts of a path with their misfits.
    fn drawn(&mut self, (kind, limits): (LoopKind, &Limited), draws: &mut Stream) -> Vec<(f64, Start)> {
        let (problem, target) = (self.context.problem, self.target);
        let is_free = matches!(problem.task().timing(), Timing::Free);
        let mut drawn: Vec<(f64, Start)> = Vec::new();
        for _ in 0..DRAWS {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let turns = limits.must_turn || uniform(draws, 0.0, 1.0) < TURNING;
            drawn.extend(if is_free {
                free(problem, target, (kind, turns), draws)
            } else {
                prescribed(problem, target, (kind, turns), draws)
            });
        }
        drawn
    }

    /// Returns the starts of a motion with their costs, those on one branch first if one is required.
    fn glanced(&mut self, limits: &Limited, starts: Vec<Start>) -> Vec<(f64, Start)> {
        let one_branch = !self.context.problem.branch_any();
        let weight: f64 = self.target.weights.iter().sum();
        let mut glanced = Vec::with_capacity(starts.len());
        for start in starts {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let start = aligned(limits, start);
            let Some(cost) = self.fit::<3>(limits, &start).cost(&start.x, &start.positions) else { continue };
            let Some(shape) = SliderShape::of(start.kind, &start.x) else { continue };
            let mut signs = start.positions.iter().map(|position| shape.assembly_of(*position));
            let first = signs.next();
            let strays = one_branch && !signs.all(|sign| Some(sign) == first);
            glanced.push((if strays { cost + weight } else { cost }, start));
        }
        glanced
    }

    /// Returns the judged candidate of an end; the distances to its whole curve are measured later, if it is listed.
    fn judged(&self, end: &Start) -> Option<Candidate> {
        const UNKNOWN: CurveErrorRecord = CurveErrorRecord { sum_sq: 0.0, rms: 0.0, max: 0.0 };
        let problem = self.context.problem;
        let Target { size, centre, .. } = *self.target;
        let unit = SliderShape::of(end.kind, &end.x)?;
        let shape = unit.carried(Complex::new(size, 0.0), centre);
        let own_sign = match problem.task().timing() {
            Timing::Free => unit.assembly_of(*end.positions.first()?),
            Timing::Prescribed { .. } => end.assembly,
        };
        let (linkage, crank_deg, assemblies) = match problem.task().timing() {
            Timing::Free => {
                let signs: Vec<AssemblyMode> = end.positions.iter().map(|p| unit.assembly_of(*p)).collect();
                let linkage = shape.linkage(own_sign).ok()?;
                // Seen from the first position, whose sign is +1.
                let own = |sign: AssemblyMode| AssemblyMode::of(sign.sign() * own_sign.sign());
                let angles = end.positions.iter().map(|[e, _]| e.arg()).collect();
                let (crank_deg, t1) =
                    unwrapped(problem, linkage, angles, signs.into_iter().map(own).collect());
                (linkage, crank_deg, t1)
            }
            Timing::Prescribed { offset, .. } => {
                let linkage = shape.linkage(own_sign).ok()?;
                let base = match offset {
                    AngleOffset::Free => wrapped(end.x[OFFSET]).to_degrees(),
                    AngleOffset::Fixed => 0.0,
                    AngleOffset::Ground => linkage.ground_angle().to_degrees(),
                };
                let written = &problem.spec().task.timing.as_ref()?.crank_deg;
                let run = problem.run(end.direction);
                let crank_deg: Vec<f64> = written.iter().map(|deg| base + run * deg).collect();
                let t1 = vec![AssemblyMode::Plus; crank_deg.len()];
                (linkage, crank_deg, t1)
            }
        };
        let frame = end.x[FRAME] + turn_of_coupler(&unit, own_sign);
        let own = self.target.body.as_ref().map(|_| Reference::frame(wrapped(frame).to_degrees()));
        let mut candidate = assess_on_curve(problem, linkage, (&crank_deg, &assemblies), own, Some(UNKNOWN))?;
        let ErrorRecord { sum_sq, rms, max, .. } = candidate.error;
        candidate.error.to_curve = CurveErrorRecord { sum_sq, rms, max };
        Some(candidate)
    }
}

/// Returns the number of free parameters of a kind within its limits that are left when all targets are met; 0 if there are
/// equations enough. With free timing each target takes one of its equations for its own crank angle.
fn freedom(problem: &Problem, limits: &Limited) -> usize {
    let task = problem.task();
    let free = limits.bounds.iter().filter(|(low, high)| low < high).count();
    let angles = task.body().map_or(0, |body| body.angles.iter().flatten().count());
    let of_places = if matches!(task.timing(), Timing::Free) { 1 } else { 2 };
    free.saturating_sub(of_places * task.len() + angles)
}

/// Returns the angle from the coupler's direction of a shape to that of its linkage with the assembly of one of its positions.
fn turn_of_coupler(shape: &SliderShape, assembly: AssemblyMode) -> f64 {
    match shape.closure {
        Closure::Block { .. } if assembly == AssemblyMode::Minus => PI,
        Closure::Block { .. } | Closure::Line { .. } => 0.0,
    }
}

impl<'a> Sliders<'a> {
    /// Creates the search of a problem, or goes on with the one that was kept; `None` if none of the kinds has a slider.
    pub(super) fn of(context: Context<'a>, kinds: &[LoopKind]) -> Option<Self> {
        let problem = context.problem;
        let target = Target::of(problem);
        let kinds: Vec<(LoopKind, Limited)> = kinds
            .iter()
            .filter(|kind| **kind != LoopKind::FourBar)
            .map(|kind| (*kind, Limited::of(problem, *kind, target.centre, target.size)))
            .collect();
        let earlier = context.keeper.and_then(|keeper| keeper.earlier().sliders.clone());
        let (guided, exact) = (Guided::of(problem), exact_cost(problem));
        let at = RepeatedState::of(problem, earlier);
        let freedom = kinds.iter().map(|(_, limits)| freedom(problem, limits)).max()?;
        Some(Sliders { target, guided, kinds, exact, freedom, glimpse: None, at })
    }

    /// Runs the first `GLIMPSE` batches with at most `limit` evaluations. Returns what has been found if that is an exact
    /// answer, and one is enough.
    pub(super) fn glimpse(&mut self, context: Context<'_>, limit: u64) -> Option<Found> {
        if self.at.batch < GLIMPSE {
            self.glimpse = Some(GLIMPSE);
            drive(context, Allowance { limit, patience: limit }, self);
            self.glimpse = None;
        }
        self.has_ended(context.problem).then(|| self.found(context.problem))
    }

    /// Returns whether one answer is asked for and an exact one is known that stands alone.
    fn has_ended(&self, problem: &Problem) -> bool {
        self.is_one_enough(problem) && self.at.best.as_ref().is_some_and(|best| self.is_exact(problem, best))
    }

    /// Searches on until the best is believed, the limit is reached, or the patience is at an end.
    pub(super) fn search(mut self, context: Context<'_>, allowance: Allowance) -> Found {
        let mut reason = if self.has_ended(context.problem) {
            Reason::TargetReached
        } else {
            drive(context, allowance, &mut self)
        };
        // Those of the rounds, whose best the polish takes on.
        let repeats = self.at.repeats();
        if self.freedom > 0 {
            let left = allowance.limit.saturating_sub(self.at.evaluations.objective);
            self.at.evaluations += context.cost(climb(context, &mut self.at.found, left));
        }
        if self.polish(context, allowance.limit) {
            reason = if reason == Reason::TargetReached { reason } else { Reason::Converged };
        }
        Found { repeats, reason, ..self.found(context.problem) }
    }

    /// Returns what has been found so far.
    pub(super) fn found(&self, problem: &Problem) -> Found {
        let reason = if self.has_ended(problem) { Reason::TargetReached } else { Reason::EvaluationLimit };
        Found {
            repeats: self.at.repeats(),
            candidates: self.at.found.clone(),
            evaluations: self.at.evaluations,
            reason,
            used: vec![Sliders::PHASE.into()],
        }
    }

    /// Runs round `index` of the search with at most `allowance` evaluations; nothing of it if a round before it in its
    /// batch was exact, of which `first_exact` holds the least index. Such a round is not read.
    fn round(
        &self,
        context: Context<'_>,
        index: u64,
        allowance: u64,
        first_exact: &AtomicU64,
    ) -> RoundOutcome {
        if first_exact.load(Ordering::Relaxed) < index {
            return RoundOutcome::default();
        }
        let problem = context.problem;
        let target = &self.target;
        let exact = self.exact / (target.size * target.size);
        let mut fits = Fits { context, target, exact, allowance, used: 0 };
        let mut outcome = RoundOutcome::default();
        let mut draws = stream(problem.spec().solve.seed, STREAMS + index);
        let (kind, limits) = &self.kinds[index as usize % self.kinds.len()];
        let mut drawn: Vec<(f64, Start)> = match &self.guided {
            Some(guided) => {
                let first = (index as usize) < self.kinds.len();
                let starts = guided.starts(target, *kind, first, &mut draws);
                outcome.draws += starts.len() as u64;
                fits.glanced(limits, starts)
            }
            None => fits.drawn((*kind, limits), &mut draws),
        };
        if self.guided.is_none() {
            outcome.draws += fits.used;
        }
        by_merit(&mut drawn, SHORT);
        let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(SHORT);
        for (_, start) in drawn {
            fitted.extend(fits.run(limits, start, SHORT_FIT));
        }
        by_merit(&mut fitted, LONG);
        let judging = context.judging();
        for (_, start) in fitted {
            let Some((_, end)) = fits.run(limits, start, LONG_FIT) else { continue };
            if !judging.may_go_on() {
                break;
            }
            outcome.found.extend(fits.judged(&end));
            if outcome.found.last().is_some_and(|found| self.is_exact(problem, found)) {
                if self.is_one_enough(problem) {
                    first_exact.fetch_min(index, Ordering::Relaxed);
                }
                break;
            }
        }
        outcome.evaluations = context.cost(fits.used);
        outcome
    }

    fn is_exact(&self, problem: &Problem, candidate: &Candidate) -> bool {
        candidate.accepted && searched(problem, candidate) <= self.exact
    }

    /// Returns whether one exact answer ends the search: where one is asked for, unless it is one of a family, of which the
    /// best transmitting one is wanted.
    fn is_one_enough(&self, problem: &Problem) -> bool {
        problem.spec().solve.candidates <= 1 && self.freedom == 0
    }

    /// Fits the best candidates on to the last digit, within a limit of evaluations: along a valley, or on a limit, a round's
    /// fit may end before it. Returns whether the best has become better.
    fn polish(&mut self, context: Context<'_>, limit: u64) -> bool {
        let problem = context.problem;
        let left = limit.saturating_sub(self.at.evaluations.objective);
        let most = (2 * problem.spec().solve.candidates).max(LEAST_POLISHED);
        let best = |search: &Sliders<'_>| search.at.best.as_ref().map(|best| searched(problem, best));
        let before = best(self);
        if left == 0 || context.stopped() || before.is_some_and(|before| before <= self.exact) {
            return false;
        }
        let exact = self.exact / (self.target.size * self.target.size);
        let share = left / most as u64;
        let polished = |candidate: &Candidate| {
            let mut fits = Fits { context, target: &self.target, exact, allowance: share, used: 0 };
            let start = start_at(problem, &self.target, candidate)?;
            let (_, limits) = self.kinds.iter().find(|(kind, _)| *kind == start.kind)?;
            let end = fits.run(limits, start, POLISH);
            Some((end.and_then(|(_, end)| fits.judged(&end)), fits.used))
        };
        let first: Vec<Candidate> = self.at.found.iter().take(most).cloned().collect();
        let ends: Vec<Option<(Option<Candidate>, u64)>> = first.par_iter().map(polished).collect();
        for (candidate, used) in ends.into_iter().flatten() {
            self.at.evaluations += context.cost(used);
            if let Some(candidate) = candidate {
                self.at.take(context.problem, &candidate, true);
                self.at.found.push(candidate);
            }
        }
        sort(problem, &mut self.at.found);
        best(self) < before
    }
}

impl Strategy for Sliders<'_> {
    type Batch = Vec<RoundOutcome>;
    const PHASE: &'static str = "least-squares";

    fn save(&self, state: &mut SearchState) {
        state.sliders = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        self.at.standing(STOPPING.hits)
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let first_exact = AtomicU64::new(u64::MAX);
        let run = |i, allowance| self.round(context, self.at.batch * BATCH + i, allowance, &first_exact);
        in_parallel((left, BATCH), run, |round| round.evaluations.objective)
    }

    fn read(&mut self, context: Context<'_>, batch: Self::Batch) {
        self.at.batch += 1;
        for outcome in batch {
            self.at.draws += outcome.draws;
            self.at.evaluations += outcome.evaluations;
            for candidate in outcome.found {
                self.at.take(context.problem, &candidate, true);
                self.at.found.push(candidate);
            }
            self.at.independent += 1;
            self.at.belief.end_batch();
            let is_exact = |best: &Candidate| self.is_exact(context.problem, best);
            if self.is_one_enough(context.problem) && self.at.best.as_ref().is_some_and(is_exact) {
                break;
            }
        }
        sort(context.problem, &mut self.at.found);
        self.at.found.truncate(KEPT);
    }

    fn is_done(&mut self, context: Context<'_>) -> bool {
        if self.freedom > 0 && self.at.is_exact(context.problem) && self.at.batch < FAMILY_BATCHES {
            return self.glimpse.is_some_and(|batches| self.at.batch >= batches);
        }
        self.at.is_done(context, &STOPPING) || self.glimpse.is_some_and(|batches| self.at.batch >= batches)
    }
}
