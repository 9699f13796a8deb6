//! A batch of rounds: run in parallel, read in their order, followed by the fits of the ends that they share.

use super::round::{Common, Finished, Round, Setup, finished, is_same, round, unfinished};
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Evaluations;
use crate::synthesis::Context;
use crate::synthesis::constants::free::{BATCH, DIFFERENT, LEADING};
use crate::synthesis::driver::{in_parallel, share, spared};
use crate::synthesis::states::{End, StageState};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicU64;

/// The results of a batch.
pub(super) struct Batch {
    pub(super) draws: u64,
    pub(super) cost: Evaluations,
    /// The least merit on all points of each independent round.
    pub(super) best_merits: Vec<f64>,
    pub(super) ends: Vec<End>,
    /// Whether every part of it stayed well below its allowance of evaluations.
    pub(super) ample: bool,
    /// The state of its stage after it.
    pub(super) stage: StageState,
}

impl Batch {
    /// Runs the rounds of a batch, the first of which draws from the stream `first`, with at most `left` evaluations;
    /// `stage` is the state of its stage before it.
    pub(super) fn run(
        context: Context<'_>,
        setup: &Setup<'_>,
        stage: &StageState,
        first: u64,
        left: u64,
    ) -> Batch {
        let mut batch = Batch {
            draws: 0,
            cost: Evaluations::default(),
            best_merits: Vec::new(),
            ends: Vec::new(),
            ample: true,
            stage: stage.clone(),
        };
        let near_ends = stage.leading.iter().map(|(_, start)| start.clone()).collect();
        let common = Common { context, setup, first, first_of_stage: stage.index, near_ends };
        // If ends are finished after the rounds and an exact one would end the search, one round runs before the
        // others.
        let split = setup.finishes_apart() && setup.single && first == 0;
        let waves: &[(u64, u64)] = if split { &[(0, 1), (1, BATCH)] } else { &[(0, BATCH)] };
        for &(begin, end) in waves {
            // Shared evenly among all rounds of the batch, each with the fits that follow from it.
            let left = left.saturating_sub(batch.cost.objective);
            let (parts, of) = (end - begin, BATCH - begin);
            let is_exact = batch.wave(&common, begin..end, left / of * parts + left % of * parts / of);
            if is_exact {
                break;
            }
        }
        batch.stage.index += BATCH;
        batch.stage.leading.sort_by(|one, other| one.0.0.total_cmp(&other.0.0));
        batch.stage.leading.truncate(LEADING);
        batch
    }

    /// Runs some of the rounds in parallel, then finishes the ends that they share. Returns whether an exact answer is
    /// among them.
    fn wave(&mut self, common: &Common<'_>, wave: Range<u64>, left: u64) -> bool {
        let setup = common.setup;
        let (found, bar) = (AtomicU64::new(u64::MAX), self.stage.bar);
        let run = |i, allowance| round(common, wave.start + i, bar, allowance, &found);
        let (mut rounds, ample): (Vec<Round>, bool) =
            in_parallel((left, wave.end - wave.start), run, |round| round.cost.objective);
        let used: u64 = rounds.iter().map(|round| round.cost.objective).sum();
        self.ample &= ample;
        let mut done: Vec<Finished> = Vec::new();
        if setup.finishes_apart() {
            done = self.finish(common, &rounds, left.saturating_sub(used));
            let merits = done.iter().map(|done| (Exact(done.explored), Exact(done.end.merit)));
            self.stage.finished.extend(merits);
        } else if let Some(exact) = rounds.iter().position(Round::is_exact) {
            // Rounds after it may have been cut short.
            rounds.truncate(exact + 1);
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

    /// Fits the ends of rounds to all points, each once, up to the first exact one.
    fn finish(&mut self, common: &Common<'_>, rounds: &[Round], left: u64) -> Vec<Finished> {
        let ends = unfinished(common.setup, rounds, &self.stage);
        let parts = ends.len() as u64;
        let found = AtomicU64::new(u64::MAX);
        let finishes: Vec<(Vec<Finished>, Evaluations)> = ends
            .into_par_iter()
            .enumerate()
            .map(|(i, end)| finished(common, (i as u64, end), share(left, parts, i as u64), &found))
            .collect();
        let mut done: Vec<Finished> = Vec::new();
        for (i, (finished, cost)) in (0..).zip(finishes) {
            self.cost += cost;
            self.ample &= spared(cost.objective, share(left, parts, i));
            let is_exact = finished.iter().any(|end| end.exact);
            done.extend(finished);
            if is_exact {
                break;
            }
        }
        done
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
