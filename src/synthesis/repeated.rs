//! The state of a multistart search by repeated hits: it keeps the best answer so far and decides when that is believed.
//!
//! A search ends when enough independent rounds have reached its best answer, or when it has gone on for several times as
//! long as it took to reach it, and as many distinct answers as were asked for are known or no new one comes.

use super::belief::{Belief, NEARLY};
use super::constants::Stopping;
use super::driver::{Standing, are_enough};
use super::polish::promising;
use super::states::{RepeatedState, of_as_many_points};
use super::{Context, HitsSoFar};
use crate::judge::rank::{exact_cost, searched};
use crate::record::{Candidate, Repeats};
use crate::task::Problem;

impl RepeatedState {
    /// Returns the state of an earlier run if it is of this problem, or that of a search which begins.
    pub(super) fn of(problem: &Problem, earlier: Option<RepeatedState>) -> Self {
        earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best)).unwrap_or_else(|| {
            RepeatedState { belief: Belief::new(exact_cost(problem)), ..Default::default() }
        })
    }

    /// Returns where the search stands; `wanted` hits of the best are asked for.
    pub(super) fn standing(&self, wanted: usize) -> Standing<'_> {
        let best = self.best.as_ref();
        Standing {
            evaluations: self.evaluations.objective,
            draws: self.draws,
            best,
            nearest: self.found.first(),
            hits: best.map(|_| HitsSoFar { came: self.belief.hits().0, wanted }),
            is_cut: false,
        }
    }

    /// Takes a candidate as the best if it is better. One of an independent round counts as a hit; any other only if it is
    /// better than the best.
    pub(super) fn take(&mut self, problem: &Problem, candidate: &Candidate, independent: bool) {
        if !promising(problem, candidate) {
            return;
        }
        let error = searched(problem, candidate);
        if independent || self.belief.would_improve(error) {
            self.belief.came_to(error);
        }
        let bar = self.best.as_ref().map_or(f64::INFINITY, |best| searched(problem, best));
        if error < bar {
            if error < bar * (1.0 - NEARLY) {
                self.reached = self.evaluations.objective;
            }
            self.best = Some(candidate.clone());
        }
    }

    /// Returns whether the best answer is exact: nothing can be better.
    pub(super) fn is_exact(&self, problem: &Problem) -> bool {
        self.best.as_ref().is_some_and(|best| searched(problem, best) <= exact_cost(problem))
    }

    /// Returns whether the best answer is believed or exact, and as many answers are known as are wanted or come.
    pub(super) fn is_done(&mut self, context: Context<'_>, wanted: usize, stopping: &Stopping) -> bool {
        let (hits, near) = self.belief.hits();
        let is_quiet = self.independent >= stopping.quiet_rounds
            && self.evaluations.objective >= stopping.quiet_times * self.reached;
        let is_believed = self.batch >= stopping.least_batches
            && (hits >= stopping.hits || near >= stopping.near_hits || is_quiet && self.best.is_some());
        (is_believed || self.is_exact(context.problem))
            && are_enough(
                context,
                &self.found,
                wanted,
                (&mut self.known, &mut self.quiet),
                stopping.quiet_batches,
            )
    }

    /// Returns how often the best answer was reached; `None` if there is none.
    pub(super) fn repeats(&self) -> Option<Repeats> {
        let (hits, near) = self.belief.hits();
        self.best.is_some().then(|| Repeats::new(self.independent, hits as u64, near as u64))
    }
}
