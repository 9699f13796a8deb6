//! Multistart search for prescribed timing in the physical parameters: rounds ([`super::multistart`]) until `ROUND_HITS`
//! different ones have reached the best answer and as many distinct answers as were asked for are known. Where exact
//! answers form a family ([`super::family`]), several batches are searched and the best answers led to better transmission
//! angles.

use super::belief::{ROUND_HITS, SAME_OPTIMUM};
use super::constants::rounds::{BATCH, FUNCTION_BATCH, FUNCTION_HITS, KEPT, LEAST_BATCHES, QUIET_BATCHES};
use super::driver::{Allowance, Found, Standing, Strategy, are_enough, drive, in_parallel};
use super::family::{climb, freedom};
use super::multistart::{RoundOutcome, round};
use super::polish::promising;
use super::starts::Starts;
use super::states::{RoundsState, SearchState, of_as_many_points};
use super::{Context, HitsSoFar};
use crate::judge::rank::{exact_cost, searched, sort};
use crate::record::{Candidate, Repeats};

struct Rounds<'a> {
    starts: Starts<'a>,
    exact: f64,
    /// Rounds of a batch.
    batch: u64,
    /// Rounds that have to reach the best answer.
    hits: usize,
    /// The number of free parameters that are left when all targets are met.
    freedom: usize,
    at: RoundsState,
}

/// Searches until the best is believed, the limit is reached, or the patience is at an end.
pub(super) fn search(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().rounds.clone());
    let earlier = earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best));
    let is_function = problem.is_function();
    let mut search = Rounds {
        starts: Starts::new(problem),
        exact: exact_cost(problem),
        batch: if is_function { FUNCTION_BATCH } else { BATCH },
        hits: if is_function { FUNCTION_HITS } else { ROUND_HITS },
        freedom: if is_function { freedom(problem) } else { 0 },
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
        repeats: at.best.is_some().then(|| Repeats::new(at.batch * search.batch, hits, hits)),
        candidates: at.found,
        evaluations: at.evaluations,
        reason,
        used: vec![Rounds::PHASE.into()],
    })
}

impl Rounds<'_> {
    /// Returns whether a candidate hits the best one, which it becomes if it is better.
    fn take_hit(&mut self, context: Context<'_>, candidate: &Candidate) -> bool {
        if !promising(context.problem, candidate) {
            return false;
        }
        let error = searched(context.problem, candidate);
        let bar = self.at.best.as_ref().map_or(f64::INFINITY, |b| searched(context.problem, b));
        if error < bar - SAME_OPTIMUM * bar.max(self.exact) {
            self.at.hits = 0;
        }
        if error < bar {
            self.at.best = Some(candidate.clone());
        }
        error <= bar + (SAME_OPTIMUM * bar).max(self.exact)
    }
}

impl Strategy for Rounds<'_> {
    type Batch = Vec<RoundOutcome>;
    const PHASE: &'static str = "least-squares";

    fn save(&self, state: &mut SearchState) {
        state.rounds = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        let RoundsState { ref found, ref best, evaluations, draws, hits, .. } = self.at;
        Standing {
            evaluations: evaluations.objective,
            draws,
            best: best.as_ref(),
            nearest: found.first(),
            hits: best.as_ref().map(|_| HitsSoFar { came: hits, wanted: self.hits }),
            is_cut: false,
        }
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let run = |i, allowance| round(context, &self.starts, self.at.batch * self.batch + i, allowance);
        in_parallel((left, self.batch), run, |round| round.evaluations.objective)
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
        at.hits >= self.hits
            && at.batch >= LEAST_BATCHES
            && are_enough(context, &at.found, wanted, (&mut at.known, &mut at.quiet), QUIET_BATCHES)
    }
}
