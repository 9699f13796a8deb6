//! Multistart search for the poses of a body with free timing: starts from dyads, joint Levenberg-Marquardt fits on the
//! torus with a row for the body's angle, and a stopping rule by repeated hits of the best answer.
//!
//! A round makes a linkage of every two of its dyads ([`starts`]), fits the `SHORT` most promising for a few steps and the
//! best `LONG` of them to convergence, and has the ends judged, driven from either side. Rounds run in parallel in batches
//! and are read in their order: the number of threads changes nothing but the time. The search ends when enough rounds
//! have reached the best answer and as many distinct answers as were asked for are known, or no new one has come for
//! `QUIET_BATCHES` batches; an exact answer needs no second hit. Where exact answers form a family ([`family`]), several
//! batches are searched and the best answers led to better transmission angles.

mod family;
mod starts;

use super::belief::SAME_OPTIMUM;
use super::constants::motion::{
    BATCH, FAMILY_BATCHES, HITS, KEPT, LEAST_BATCHES, LONG, QUIET_BATCHES, SHORT,
};
use super::driver::{Allowance, Found, Standing, Strategy, are_enough, drive, in_parallel};
use super::multistart::{LONG_FIT, RoundOutcome, SHORT_FIT, Spender, by_merit, judged, promise};
use super::polish::promising;
use super::states::{RoundsState, SearchState, of_as_many_points};
use super::{Context, HitsSoFar};
use crate::judge::rank::{exact_cost, searched, sort};
use crate::numbers::arithmetic::streams::stream;
use crate::record::{Candidate, Repeats};
use crate::task::forms::start::Start;
use family::{climb, freedom};
use starts::{DyadStarts, least_sine, swapped};

struct Motion<'a> {
    starts: DyadStarts<'a>,
    exact: f64,
    /// The number of free parameters that are left when all targets are met.
    freedom: usize,
    at: RoundsState,
}

/// Searches until the best is believed, the limit is reached, or the patience is at an end; `None` if the task is no
/// motion.
pub(super) fn search(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    problem.task().body()?;
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().motion.clone());
    let earlier = earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best));
    let mut search = Motion {
        starts: DyadStarts::new(problem),
        exact: exact_cost(problem),
        freedom: freedom(problem),
        at: earlier.unwrap_or_default(),
    };
    let reason = drive(context, allowance, &mut search);
    let mut at = search.at;
    if search.freedom > 0 {
        let left = allowance.limit.saturating_sub(at.evaluations.objective);
        at.evaluations += context.cost(climb(context, &mut at.found, left));
    }
    let hits = at.hits as u64;
    Some(Found {
        repeats: at.best.is_some().then(|| Repeats::new(at.batch * BATCH, hits, hits)),
        candidates: at.found,
        evaluations: at.evaluations,
        reason,
        used: vec![Motion::PHASE.into()],
    })
}

impl Motion<'_> {
    /// Runs round `index` of the search with at most `allowance` evaluations.
    fn round(&self, context: Context<'_>, index: u64, allowance: u64) -> RoundOutcome {
        let problem = context.problem;
        let mut spender = Spender::new(context, allowance);
        let mut outcome = RoundOutcome::default();
        let mut draws = stream(problem.spec().solve.seed, index);
        let dyads = self.starts.dyads(index == 0, &mut draws);
        let mut screened: Vec<(f64, Start)> = Vec::new();
        for mut start in self.starts.pairs(&dyads) {
            if spender.is_at_its_end() {
                break;
            }
            outcome.draws += 1;
            spender.spend(problem, 1);
            let promise = promise(problem, &mut start).map(|promise| {
                // Exact starts are compared by how they transmit.
                let is_exact = self.freedom > 0 && promise <= self.exact;
                if is_exact { -1.0 - least_sine(problem, &start) } else { promise }
            });
            screened.extend(promise.map(|promise| (promise, start)));
        }
        // A round without a start counts as one draw, so that the search comes to its end.
        outcome.draws = outcome.draws.max(1);
        by_merit(&mut screened, SHORT);
        let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(SHORT);
        for (_, start) in screened {
            fitted.extend(spender.fit(problem, start, SHORT_FIT, u64::MAX));
        }
        // Exact ends are different answers, of which the best transmitting is wanted.
        by_merit(&mut fitted, SHORT);
        let exact = fitted.iter().take_while(|(merit, _)| *merit <= self.exact).count();
        fitted.truncate(LONG.max(exact));
        let judging = context.judging();
        for (_, start) in fitted {
            let Some((_, end)) = spender.fit_as_required(problem, start, LONG_FIT) else { continue };
            if !judging.may_go_on() {
                break;
            }
            let driven_otherwise = swapped(problem, &end).and_then(|end| judged(problem, &end));
            let both = judged(problem, &end).into_iter().chain(driven_otherwise);
            let accepted = |candidate: &Candidate| candidate.accepted;
            let both: Vec<Candidate> = both.collect();
            let any = both.iter().any(accepted);
            outcome.found.extend(both.into_iter().filter(|candidate| !any || accepted(candidate)));
        }
        outcome.evaluations = spender.cost;
        outcome
    }

    /// Returns whether a candidate hits the best one, which it becomes if it is better.
    fn take_hit(&mut self, context: Context<'_>, candidate: &Candidate) -> bool {
        if !promising(context.problem, candidate) {
            return false;
        }
        let error = searched(context.problem, candidate);
        let bar = self.at.best.as_ref().map_or(f64::INFINITY, |best| searched(context.problem, best));
        if error < bar - SAME_OPTIMUM * bar.max(self.exact) && bar > self.exact {
            self.at.hits = 0;
        }
        if error < bar {
            self.at.best = Some(candidate.clone());
        }
        error <= bar + (SAME_OPTIMUM * bar).max(self.exact)
    }
}

impl Strategy for Motion<'_> {
    type Batch = Vec<RoundOutcome>;
    const PHASE: &'static str = "least-squares";

    fn save(&self, state: &mut SearchState) {
        state.motion = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        let RoundsState { ref found, ref best, evaluations, draws, hits, .. } = self.at;
        Standing {
            evaluations: evaluations.objective,
            draws,
            best: best.as_ref(),
            nearest: found.first(),
            hits: best.as_ref().map(|_| HitsSoFar { came: hits, wanted: HITS }),
            is_cut: false,
        }
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let run = |i, allowance| self.round(context, self.at.batch * BATCH + i, allowance);
        in_parallel((left, BATCH), run, |round| round.evaluations.objective)
    }

    fn read(&mut self, context: Context<'_>, batch: Self::Batch) {
        self.at.batch += 1;
        for outcome in batch {
            self.at.draws += outcome.draws;
            self.at.evaluations += outcome.evaluations;
            let mut hit = false;
            for candidate in outcome.found {
                hit |= self.take_hit(context, &candidate);
                self.at.found.push(candidate);
            }
            self.at.hits += usize::from(hit);
        }
        sort(context.problem, &mut self.at.found);
        self.at.found.truncate(KEPT);
    }

    fn is_done(&mut self, context: Context<'_>) -> bool {
        let at = &mut self.at;
        let wanted = context.problem.spec().solve.candidates;
        let is_exact = at.best.as_ref().is_some_and(|best| searched(context.problem, best) <= self.exact);
        if self.freedom > 0 && is_exact && at.batch < FAMILY_BATCHES {
            return false;
        }
        let is_believed = at.hits >= HITS && at.batch >= LEAST_BATCHES;
        (is_believed || is_exact && at.hits > 0)
            && are_enough(context, &at.found, wanted, (&mut at.known, &mut at.quiet), QUIET_BATCHES)
    }
}
