//! A batch of rounds: run in parallel, read in their order, followed by the fits of the ends that they share.
//!
//! The first rounds that the evaluations left suffice for are read, and the others are dropped: a search with more
//! evaluations reads the same rounds and further ones, so that its answer is no worse. As long as nothing acceptable is
//! known, the first round that they do not suffice for is read too, cut short.

use super::noise::Scatter;
use super::parts::{Reading, in_order, suffice_for};
use super::round::{Common, Finished, Round, Setup, apart, finished, lead_to_digits, round, unfinished};
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Evaluations;
use crate::synthesis::Context;
use crate::synthesis::belief::{NEARLY, SAME_OPTIMUM};
use crate::synthesis::constants::free::{
    ALIKE_ENDS, BATCH, DIFFERENT, FINISHING, HALF_BATCH, LEADING, SAME_END,
};
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

/// Holds what is known before a batch: it limits what the batch has to fit.
pub(super) struct Known {
    /// The error of the best answer, infinite if there is none.
    pub(super) best: f64,
    /// Whether its errors are noise.
    pub(super) in_noise: bool,
    /// The scatter of the points about the groups' means that the stages have shown.
    pub(super) scatter: Option<Scatter>,
    /// Whether half of its rounds may be enough.
    pub(super) in_halves: bool,
}

/// The verdict about the first rounds of a batch, and all before them, in a search for one answer.
pub(super) struct SoFar {
    /// Whether the errors of the best answer are noise.
    pub(super) is_noise: bool,
    /// Whether enough rounds have come to equally good answers.
    pub(super) is_enough: bool,
}

impl Batch {
    /// Runs the rounds of a batch with at most `left` evaluations; `stage` is the state of its stage before it, `first` the
    /// index of its first round in the whole search. The first batch of a search for one answer, and one in halves, ask for a
    /// verdict about their first rounds by `so_far`, and end once these are enough.
    pub(super) fn run(
        context: Context<'_>,
        setup: &Setup<'_>,
        stage: &StageState,
        first: u64,
        Known { best, in_noise, scatter, in_halves }: Known,
        left: u64,
        so_far: impl Fn(&mut Batch) -> SoFar,
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
        let first_of_stage = stage.index;
        let mut common = Common { context, setup, first_of_stage, near_ends, best, in_noise, scatter };
        // If ends are finished after the rounds and an exact one would end the search, one round runs before the
        // others.
        let split = common.finishes_apart() && setup.single && first == 0;
        let first_wave = match split {
            true => 1,
            false if in_halves => HALF_BATCH,
            false => BATCH,
        };
        let (mut begin, mut end) = (0, first_wave);
        loop {
            let is_exact = batch.wave(&common, begin..end, left.saturating_sub(batch.cost.objective));
            if is_exact || !batch.whole || end == BATCH {
                break;
            }
            let so_far = so_far(&mut batch);
            if so_far.is_enough {
                break;
            }
            common.in_noise = so_far.is_noise;
            (begin, end) = (end, if end == 1 && so_far.is_noise { HALF_BATCH } else { BATCH });
        }
        batch.stage.index += BATCH;
        batch.stage.leading.sort_by(|one, other| one.0.0.total_cmp(&other.0.0));
        batch.stage.leading.truncate(LEADING);
        batch
    }

    /// Runs some of the rounds in parallel, then finishes the ends that they share, and reads those that the evaluations
    /// left suffice for. Returns whether an exact answer is among them.
    fn wave(&mut self, common: &Common<'_>, wave: Range<u64>, left: u64) -> bool {
        let (first, bar, before) = (wave.start, self.stage.bar, self.cost.objective);
        let reading = Reading::new(wave.clone(), left);
        let mut rounds: Vec<Round> = in_order(wave, |index| round(common, index, bar, left, &reading));
        if !common.finishes_apart()
            && let Some(exact) = rounds.iter().position(Round::is_exact)
        {
            // Rounds after it may have been cut short.
            rounds.truncate(exact + 1);
        }
        self.keep_those_that_fit(&mut rounds, left, |_, round| round.cost.objective);
        let mut done: Vec<Finished> = Vec::new();
        if common.finishes_apart() {
            done = self.finish(common, &mut rounds, left);
        }
        let exact = done.iter().any(|done| done.exact);
        let next = first + rounds.len() as u64;
        self.read(common, rounds, done);
        if !self.whole && common.best.is_infinite() {
            let used = self.cost.objective - before;
            self.read_cut_short(common, next, left.saturating_sub(used));
        }
        exact
    }

    /// Adds the results of rounds, and of their ends that were finished after them.
    fn read(&mut self, common: &Common<'_>, mut rounds: Vec<Round>, mut done: Vec<Finished>) {
        let merits = done.iter().map(|done| (Exact(done.explored), Exact(done.end.merit)));
        self.stage.finished.extend(merits);
        for round in &mut rounds {
            self.draws += round.draws;
            self.cost += round.cost;
            if round.independent {
                self.stage.round_merits.push(Exact(round.explored()));
                self.best_merits.push(self.least_on_all(common, round));
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
        self.ends.extend(done.into_iter().map(|done| done.end));
    }

    /// Fits the ends of rounds to all points, each once, up to the first exact one. Drops the rounds that the evaluations
    /// left do not suffice for with the fits of their ends.
    fn finish(&mut self, common: &Common<'_>, rounds: &mut Vec<Round>, left: u64) -> Vec<Finished> {
        let before = self.cost.objective;
        let ends = unfinished(common, rounds, &self.stage);
        let parts = ends.len() as u64;
        let scatter = common.scatter(&self.stage);
        let reading = Reading::new(0..parts, u64::MAX);
        let mut finishes: Vec<(usize, Vec<Finished>, Evaluations)> = in_order(0..parts, |i| {
            let end = &ends[i as usize];
            let allowance = left.saturating_sub(rounds[end.round].cost.objective);
            let (done, cost) = finished(common, (i, end), (allowance, scatter.is_some()), &reading);
            (end.round, done, cost)
        });
        if let Some(exact) = finishes.iter().position(|(_, done, _)| done.iter().any(|end| end.exact)) {
            finishes.truncate(exact + 1);
        }
        self.keep_those_that_fit(rounds, left, |i, round| {
            let own = finishes.iter().filter(|(round, ..)| *round == i);
            round.cost.objective + own.map(|(.., cost)| cost.objective).sum::<u64>()
        });
        let mut done: Vec<Finished> = Vec::new();
        for (_, ends, cost) in finishes.into_iter().filter(|(round, ..)| *round < rounds.len()) {
            self.cost += cost;
            done.extend(ends);
        }
        if let Some(scatter) = scatter {
            let rounds: u64 = rounds.iter().map(|round| round.cost.objective).sum();
            let used = self.cost.objective - before + rounds;
            self.cost += lead_to_digits(common, scatter, &mut done, left.saturating_sub(used));
        }
        done
    }

    /// Runs and reads a round with the evaluations left, which do not suffice for all of it. If its ends are finished
    /// after it, a part of them is kept for that.
    fn read_cut_short(&mut self, common: &Common<'_>, index: u64, left: u64) {
        let for_ends = if common.finishes_apart() { left / FINISHING } else { 0 };
        let alone = || Reading::new(0..0, u64::MAX);
        let cut = vec![round(common, index, self.stage.bar, left - for_ends, &alone())];
        let mut done: Vec<Finished> = Vec::new();
        if common.finishes_apart() {
            let mut left = left.saturating_sub(cut[0].cost.objective);
            for end in unfinished(common, &cut, &self.stage) {
                let (ends, cost) = finished(common, (0, &end), (left, false), &alone());
                left = left.saturating_sub(cost.objective);
                self.cost += cost;
                done.extend(ends);
            }
        }
        self.read(common, cut, done);
    }

    /// Keeps the first rounds that the evaluations left suffice for, and records whether these limited any; `cost` returns
    /// the evaluations of a round.
    fn keep_those_that_fit(
        &mut self,
        rounds: &mut Vec<Round>,
        left: u64,
        cost: impl Fn(usize, &Round) -> u64,
    ) {
        let fit = suffice_for(left, rounds.iter().enumerate().map(|(i, round)| cost(i, round)));
        self.whole &= fit == rounds.len();
        rounds.truncate(fit);
    }

    /// Returns the least merit on all points of the ends of a round, whether they were finished in it or after a batch. An
    /// end that is only like one that was finished is near it; in noise one that was not finished has the merit that can be
    /// expected.
    fn least_on_all(&self, common: &Common<'_>, round: &Round) -> f64 {
        let own = round.finished.iter().map(|done| done.end.merit);
        let scatter = common.scatter(&self.stage);
        let shared = round.leaders.iter().filter_map(|&(merit, _)| {
            let known = self.stage.finished.iter().filter_map(|&(Exact(explored), Exact(whole))| {
                // Nearly exact ends are told apart to the last.
                let (same, alike) = if whole > common.setup.nearly_exact {
                    (SAME_END, ALIKE_ENDS)
                } else {
                    (SAME_OPTIMUM, SAME_OPTIMUM)
                };
                match apart(explored, merit) {
                    apart if apart <= same => Some(whole),
                    apart if apart <= alike => Some(whole * (1.0 + 0.5 * NEARLY)),
                    _ => None,
                }
            });
            let least = known.min_by(f64::total_cmp);
            least.or_else(|| scatter.map(|scatter| scatter.expected(merit) * (1.0 + 0.5 * NEARLY)))
        });
        own.chain(shared).fold(f64::INFINITY, f64::min)
    }
}
