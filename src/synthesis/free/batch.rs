//! A batch of rounds: run in parallel, read in their order, followed by the fits of the ends that they share.
//!
//! As long as nothing acceptable is known, the evaluations left are shared evenly among the rounds, and all are read. After
//! that the first rounds that they suffice for are read, and the others are dropped: a search with more evaluations reads
//! the same rounds and further ones, so that its answer is no worse.

use super::parts::{Allowed, Reading, in_order};
use super::round::{Common, Finished, Round, Setup, finished, is_same, round, unfinished};
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Evaluations;
use crate::synthesis::Context;
use crate::synthesis::constants::free::{BATCH, DIFFERENT, LEADING};
use crate::synthesis::states::{End, StageState};
use std::ops::Range;

/// The results of a batch.
pub(super) struct Batch {
    pub(super) draws: u64,
    pub(super) cost: Evaluations,
    /// The least merit on all points of each independent round.
    pub(super) best_merits: Vec<f64>,
    pub(super) ends: Vec<End>,
    /// Whether the evaluations left sufficed for all of it.
    pub(super) whole: bool,
    /// The state of its stage after it.
    pub(super) stage: StageState,
}

impl Batch {
    /// Runs the rounds of a batch, the first of which draws from the stream `first`, with at most `left` evaluations;
    /// `stage` is the state of its stage before it. All rounds are read, cut short or not, if `all` is set.
    pub(super) fn run(
        context: Context<'_>,
        setup: &Setup<'_>,
        stage: &StageState,
        first: u64,
        (left, all): (u64, bool),
    ) -> Batch {
        let mut batch = Batch {
            draws: 0,
            cost: Evaluations::default(),
            best_merits: Vec::new(),
            ends: Vec::new(),
            whole: true,
            stage: stage.clone(),
        };
        let near_ends = stage.leading.iter().map(|(_, start)| start.clone()).collect();
        let common = Common { context, setup, first, first_of_stage: stage.index, near_ends };
        // If ends are finished after the rounds and an exact one would end the search, one round runs before the
        // others.
        let split = setup.finishes_apart() && setup.single && first == 0;
        let waves: &[(u64, u64)] = if split { &[(0, 1), (1, BATCH)] } else { &[(0, BATCH)] };
        for &(begin, end) in waves {
            let left = left.saturating_sub(batch.cost.objective);
            // Shared evenly among all rounds of the batch, each with the fits that follow from it.
            let (parts, of) = (end - begin, BATCH - begin);
            let left = if all { left / of * parts + left % of * parts / of } else { left };
            let is_exact = batch.wave(&common, begin..end, Allowed { left, parts, shared: all });
            if is_exact || !(all || batch.whole) {
                break;
            }
        }
        batch.stage.index += BATCH;
        batch.stage.leading.sort_by(|one, other| one.0.0.total_cmp(&other.0.0));
        batch.stage.leading.truncate(LEADING);
        batch
    }

    /// Runs some of the rounds in parallel, then finishes the ends that they share, and reads those that the evaluations
    /// allowed suffice for, or all if they are shared. Returns whether an exact answer is among them.
    fn wave(&mut self, common: &Common<'_>, wave: Range<u64>, allowed: Allowed) -> bool {
        let setup = common.setup;
        let (first, bar) = (wave.start, self.stage.bar);
        let reading = Reading::new(wave.clone(), allowed.left);
        let mut rounds: Vec<Round> =
            in_order(wave, |index| round(common, index, bar, allowed.of(index - first), &reading));
        if !setup.finishes_apart()
            && let Some(exact) = rounds.iter().position(Round::is_exact)
        {
            // Rounds after it may have been cut short.
            rounds.truncate(exact + 1);
        }
        self.keep_those_that_fit(&mut rounds, allowed, |_, round| round.cost.objective);
        let mut done: Vec<Finished> = Vec::new();
        if setup.finishes_apart() {
            done = self.finish(common, &mut rounds, allowed);
            let merits = done.iter().map(|done| (Exact(done.explored), Exact(done.end.merit)));
            self.stage.finished.extend(merits);
        }
        for round in &mut rounds {
            self.draws += round.draws;
            self.cost += round.cost;
            if round.independent {
                self.stage.round_merits.push(Exact(round.explored()));
                self.best_merits.push(self.least_on_all(round));
            }
            self.stage.bar = self.stage.bar.min(round.explored());
            done.append(&mut round.finished);
            let leading = &mut self.stage.leading;
            for (merit, start) in round.leaders.drain(..) {
                if leading.iter().all(|(Exact(other), _)| (merit - other).abs() > DIFFERENT * other) {
                    leading.push((Exact(merit), start));
                }
            }
        }
        let exact = done.iter().any(|done| done.exact);
        self.ends.extend(done.into_iter().map(|done| done.end));
        exact
    }

    /// Fits the ends of rounds to all points, each once, up to the first exact one. Drops the rounds that the evaluations
    /// allowed, if they are not shared, do not suffice for with the fits of their ends.
    fn finish(&mut self, common: &Common<'_>, rounds: &mut Vec<Round>, allowed: Allowed) -> Vec<Finished> {
        let ends = unfinished(common.setup, rounds, &self.stage);
        let parts = ends.len() as u64;
        let used: u64 = rounds.iter().map(|round| round.cost.objective).sum();
        let shared = Allowed { left: allowed.left.saturating_sub(used), parts, shared: true };
        let allowance = |i: u64, round: &Round| {
            if allowed.shared { shared.of(i) } else { allowed.left.saturating_sub(round.cost.objective) }
        };
        let reading = Reading::new(0..parts, u64::MAX);
        let mut finishes: Vec<(usize, Vec<Finished>, Evaluations)> = in_order(0..parts, |i| {
            let end = &ends[i as usize];
            let (done, cost) = finished(common, (i, end), allowance(i, &rounds[end.round]), &reading);
            (end.round, done, cost)
        });
        if let Some(exact) = finishes.iter().position(|(_, done, _)| done.iter().any(|end| end.exact)) {
            finishes.truncate(exact + 1);
        }
        if allowed.shared {
            let costs = finishes.iter().map(|(.., cost)| cost.objective);
            self.whole &= shared.suffice_for(costs) == finishes.len();
        } else {
            self.keep_those_that_fit(rounds, allowed, |i, round| {
                let own = finishes.iter().filter(|(round, ..)| *round == i);
                round.cost.objective + own.map(|(.., cost)| cost.objective).sum::<u64>()
            });
        }
        let mut done: Vec<Finished> = Vec::new();
        for (_, ends, cost) in finishes.into_iter().filter(|(round, ..)| *round < rounds.len()) {
            self.cost += cost;
            done.extend(ends);
        }
        done
    }

    /// Keeps the first rounds that the evaluations allowed suffice for, or all if they are shared, and records whether
    /// they limited any; `cost` returns the evaluations of a round.
    fn keep_those_that_fit(
        &mut self,
        rounds: &mut Vec<Round>,
        allowed: Allowed,
        cost: impl Fn(usize, &Round) -> u64,
    ) {
        let fit = allowed.suffice_for(rounds.iter().enumerate().map(|(i, round)| cost(i, round)));
        self.whole &= fit == rounds.len();
        if !allowed.shared {
            rounds.truncate(fit);
        }
    }

    /// Returns the least merit on all points of the ends of a round, whether they were finished in it or after a batch.
    fn least_on_all(&self, round: &Round) -> f64 {
        let own = round.finished.iter().map(|done| done.end.merit);
        let shared = self.stage.finished.iter().filter_map(|(explored, whole)| {
            round.leaders.iter().any(|(merit, _)| is_same(explored.0, *merit)).then_some(whole.0)
        });
        own.chain(shared).fold(f64::INFINITY, f64::min)
    }
}
