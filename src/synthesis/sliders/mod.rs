//! Multistart search for linkages with a slider, for paths and motions with prescribed or free timing and for functions:
//! drawn shapes laid on the target, dyads through its poses, or linear solutions of its pairs, Levenberg-Marquardt fits with
//! the closure of their kind, and a stopping rule by repeated hits of the best answer.
//!
//! A round draws `DRAWS` shapes of one kind ([`starts`]), or pairs dyads that suit the poses ([`guided`]), or solves for
//! shapes that suit the pairs of a function (`output_starts`), fits the `SHORT` that are nearest to the target for a few steps
//! and the best `LONG` of those that lie apart to convergence, and has the ends judged ([`fits`]); one that is nearly exact
//! after its few steps goes first. Kinds take turns. Of a path one round in `HOP_EVERY` changes known answers instead of
//! drawing, which says nothing for the belief in them, and a glimpse draws every kind in each round. Rounds run in parallel in
//! batches and are read in their order: the number of threads changes nothing but the time. The search ends when enough rounds have reached the best answer (or the search has gone on for
//! several times as long as it took to reach it) and as many distinct answers as were asked for are known, or no new one has
//! come for `quiet_batches` of them; an exact answer needs no second hit, and where one is enough the rounds after it in its
//! batch are not read. The best answers are fitted on to the last digit at the end; exact ones that form a family are led to
//! better transmission angles. For the largest deviation and for tolerances, exact targets among them, the answers are polished
//! afterwards ([`super::polish`]).

mod deviations;
mod fits;
mod guided;
mod output_starts;
mod starts;

use super::Context;
use super::constants::sliders::{
    APART, BATCH, DRAWS, FAMILY_BATCHES, HOP_EVERY, HOP_FROM, KEPT, LEAST_POLISHED, LONG, LONG_FIT, POLISH,
    SHORT, SHORT_FIT, STOPPING,
};
use super::driver::{Allowance, Found, Standing, Strategy, drive, in_parallel};
use super::family::{climb, freedom_within, one_is_enough};
use super::multistart::{RoundOutcome, by_merit};
use super::polish::{basins_wanted, improve, reserve};
use super::states::{RepeatedState, SearchState};
use crate::judge::rank::{exact_cost, searched, sort};
use crate::mechanism::LinkageKind;
use crate::numbers::arithmetic::streams::stream;
use crate::record::{Candidate, Evaluations, Reason};
use crate::task::Problem;
use crate::task::forms::slider::limits::Limited;
use crate::task::forms::slider::shape::SHAPE;
use crate::task::spec::Objective;
use fits::{Fits, start_at};
pub(super) use fits::{refit, unfitted};
use guided::Guided;
use output_starts::output_starts;
use rayon::prelude::*;
pub(super) use starts::Start;
use starts::Target;
use std::slice;
use std::sync::atomic::{AtomicU64, Ordering};

/// The streams of the rounds begin here, so that they differ from those of the four-bars.
const STREAMS: u64 = 1 << 40;

/// A search for linkages with a slider, which may be run in two parts.
pub(super) struct Sliders<'a> {
    target: Target,
    /// The starts of a motion.
    guided: Option<Guided<'a>>,
    kinds: Vec<(LinkageKind, Limited)>,
    exact: f64,
    /// The number of free parameters that are left when all targets are met.
    freedom: usize,
    /// The batches after which a glimpse ends.
    glimpse: Option<u64>,
    at: RepeatedState,
}

/// Searches for linkages with a slider for the problem of four-bars of a context, with at most `limit` evaluations. Returns the
/// accepted ones, the best first, and the evaluations used; none where they are not searched for.
pub(super) fn beside_four_bars(context: Context<'_>, limit: u64) -> (Vec<Candidate>, Evaluations) {
    let problem = context.problem;
    let mut spec = problem.spec().clone();
    if !spec.design.is_of_four_bars() || !spec.solve.method.finds_sliders() {
        return (Vec::new(), Evaluations::default());
    }
    let has_output =
        |kind: &LinkageKind| spec.task.output.as_ref().is_none_or(|output| output.output.is_of(*kind));
    let slides = |kind: &LinkageKind| kind.has_slider() && has_output(kind);
    let kinds: Vec<LinkageKind> = LinkageKind::ALL.into_iter().filter(slides).collect();
    spec.design.mechanism = kinds;
    match problem.with(spec) {
        Ok(within) => of_the_design(context.of(&within), limit),
        Err(_) => (Vec::new(), Evaluations::default()),
    }
}

/// Searches for one answer among the linkages with a slider that the context's problem asks for, with at most `limit` evaluations.
/// Returns the accepted ones, the best first, and the evaluations used.
pub(super) fn of_the_design(context: Context<'_>, limit: u64) -> (Vec<Candidate>, Evaluations) {
    let mut spec = context.problem.spec().clone();
    spec.solve.candidates = 1;
    let Ok(within) = context.problem.with(spec) else { return (Vec::new(), Evaluations::default()) };
    let context = Context { keeper: None, ..context.of(&within) }.silent();
    let kinds = &within.spec().design.mechanism;
    let Some(search) = Sliders::of(context, kinds) else { return (Vec::new(), Evaluations::default()) };
    let found = search.search(context, Allowance { limit, patience: limit });
    (found.candidates.into_iter().filter(|c| c.accepted).collect(), found.evaluations)
}

impl<'a> Sliders<'a> {
    /// Creates the search of a problem, or goes on with the one that was kept; `None` if none of the kinds has a slider.
    pub(super) fn of(context: Context<'a>, kinds: &[LinkageKind]) -> Option<Self> {
        let problem = context.problem;
        let target = Target::searched(problem);
        let kinds: Vec<(LinkageKind, Limited)> = kinds
            .iter()
            .filter(|kind| kind.has_slider())
            .map(|kind| (*kind, Limited::of(problem, *kind, target.centre, target.size)))
            .collect();
        let earlier = context.keeper.and_then(|keeper| keeper.earlier().sliders.clone());
        let (guided, exact) = (Guided::of(problem), exact_cost(problem));
        let at = RepeatedState::of(problem, earlier);
        let freedom =
            kinds.iter().map(|(kind, limits)| freedom_within(problem, *kind, &limits.bounds)).max()?;
        Some(Sliders { target, guided, kinds, exact, freedom, glimpse: None, at })
    }

    /// Runs the first `batches` with at most `limit` evaluations. Returns what has been found if that is an exact
    /// answer, and one is enough.
    pub(super) fn glimpse(&mut self, context: Context<'_>, limit: u64, batches: u64) -> Option<Found> {
        let used = self.at.evaluations.objective.max(self.at.draws);
        if self.at.batch < batches && used < limit {
            self.glimpse = Some(batches);
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
        // What the objective and the tolerances ask for beyond least squares comes after it.
        let left_over = reserve(context.problem, allowance.limit);
        let Allowance { limit, patience } = allowance;
        let allowance = Allowance { limit: limit - left_over, patience: patience.min(limit - left_over) };
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
        let of_squares = context.problem.spec().solve.objective == Objective::SumOfSquares;
        if of_squares && self.polish(context, allowance.limit) {
            reason = if reason == Reason::TargetReached { reason } else { Reason::Converged };
        }
        if left_over > 0 {
            let RepeatedState { found, evaluations, .. } = &mut self.at;
            improve::<Start>(context, found, evaluations, limit);
            sort(context.problem, found);
        }
        // The largest deviation has other basins than the sum of squares.
        let repeats = repeats.filter(|_| of_squares);
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
        let mut fits = Fits::new(context, target, self.exact, allowance);
        let mut outcome = RoundOutcome::default();
        let mut draws = stream(problem.spec().solve.seed, STREAMS + index);
        let turn = &self.kinds[index as usize % self.kinds.len()];
        let (kind, limits) = turn;
        let first = (index as usize) < self.kinds.len();
        // A glimpse of a path draws each kind in every round: the shapes that resemble it most tell which.
        let drawn_kinds = if self.glimpse.is_some() { &self.kinds[..] } else { slice::from_ref(turn) };
        let known: Vec<Start> =
            if self.hops(index) { self.known(problem, *kind).collect() } else { Vec::new() };
        let mut drawn: Vec<(f64, Start)> = match (&self.guided, &target.outputs) {
            (_, Some(outputs)) => {
                let starts = output_starts(problem, (target, outputs), (*kind, limits), first, &mut draws);
                fits.glanced_outputs(limits, starts)
            }
            (Some(guided), None) => fits.glanced(limits, guided.starts(target, *kind, first, &mut draws)),
            (None, None) if known.is_empty() => {
                let share = DRAWS / drawn_kinds.len();
                let of_kind =
                    |(kind, limits): &(LinkageKind, Limited)| fits.drawn((*kind, limits), share, &mut draws);
                drawn_kinds.iter().flat_map(of_kind).collect()
            }
            (None, None) => fits.hopped(limits, &known, &mut draws),
        };
        let limits_of = |start: &Start| {
            self.kinds.iter().find(|(kind, _)| *kind == start.kind).map_or(limits, |(_, limits)| limits)
        };
        outcome.draws = fits.used;
        by_merit(&mut drawn, SHORT);
        let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(SHORT);
        let mut nearly: Option<Start> = None;
        for (_, start) in drawn {
            let Some((merit, end)) = fits.run(limits_of(&start), start, SHORT_FIT) else { continue };
            if fits.is_nearly_exact(merit) {
                nearly = Some(end);
                break;
            }
            fitted.push((merit, end));
        }
        by_merit(&mut fitted, SHORT);
        let fitted = distinct(fitted, LONG);
        let judging = context.judging();
        for start in nearly.into_iter().chain(fitted.into_iter().map(|(_, start)| start)) {
            let Some((_, end)) = fits.run(limits_of(&start), start, LONG_FIT) else { continue };
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

    /// Returns whether a round begins near known answers: some of those of a path after the first batch.
    fn hops(&self, index: u64) -> bool {
        let is_path = self.guided.is_none() && self.target.outputs.is_none();
        is_path && index >= BATCH && index % HOP_EVERY == HOP_EVERY - 1
    }

    /// Returns the best known candidates of a kind, as starts.
    fn known<'s>(&'s self, problem: &'s Problem, kind: LinkageKind) -> impl Iterator<Item = Start> + 's {
        let of_kind = self.at.found.iter().filter(move |candidate| candidate.linkage.kind() == kind);
        of_kind.take(HOP_FROM).filter_map(|candidate| start_at(problem, &self.target, candidate))
    }

    fn is_exact(&self, problem: &Problem, candidate: &Candidate) -> bool {
        candidate.accepted && searched(problem, candidate) <= self.exact
    }

    /// Returns whether one exact answer ends the search.
    fn is_one_enough(&self, problem: &Problem) -> bool {
        one_is_enough(problem, self.freedom)
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
        let share = left / most as u64;
        let polished = |candidate: &Candidate| {
            let mut fits = Fits::new(context, &self.target, self.exact, share);
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

/// Returns the first `most` starts, in the order of their merits, that lie apart from those before them: two that run into one
/// another would come to the same end.
fn distinct(starts: Vec<(f64, Start)>, most: usize) -> Vec<(f64, Start)> {
    let mut taken: Vec<(f64, Start)> = Vec::with_capacity(most);
    for start in starts {
        if taken.len() < most && !taken.iter().any(|(_, other)| are_near(&start.1, other)) {
            taken.push(start);
        }
    }
    taken
}

/// Returns whether the unknowns of two starts differ by less than `APART` of their size.
fn are_near(one: &Start, other: &Start) -> bool {
    let [mut apart, mut size] = [0.0, 0.0];
    for (x, y) in one.x.iter().zip(&other.x).take(SHAPE) {
        apart += (x - y) * (x - y);
        size += x * x + y * y;
    }
    one.kind == other.kind && one.assembly == other.assembly && apart < APART * APART * size
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
        let begin = self.at.batch * BATCH;
        self.at.batch += 1;
        for (index, outcome) in (begin..).zip(batch) {
            // That an answer is found again from itself says nothing of others.
            let is_independent = !self.hops(index);
            self.at.draws += outcome.draws;
            self.at.evaluations += outcome.evaluations;
            for candidate in outcome.found {
                self.at.take(context.problem, &candidate, is_independent);
                self.at.found.push(candidate);
            }
            self.at.independent += u64::from(is_independent);
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
        let is_sampled = self.freedom == 0 || self.at.batch >= FAMILY_BATCHES;
        let is_family = !is_sampled && self.at.is_exact(context.problem);
        let is_glimpsed = self.glimpse.is_some_and(|batches| self.at.batch >= batches);
        is_glimpsed || !is_family && self.at.is_done(context, basins_wanted(context.problem), &STOPPING)
    }
}
