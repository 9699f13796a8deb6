//! The checkpoint state of the search for free timing between two batches.

use super::{BATCH, End, Memory, Stage, WHOLE_MOST};
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Evaluations;
use crate::synthesis::multistart::judged;
use crate::task::Problem;
use crate::task::forms::start::Start;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Counters over all batches.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Counts {
    /// Distinct answers known; `quiet`: batches in a row without a new one.
    pub(super) known: usize,
    pub(super) quiet: u64,
    pub(super) batch: u64,
    pub(super) draws: u64,
}

/// The state on which the next batches depend, besides the problem and the budget.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FreeState {
    counts: Counts,
    evaluations: Evaluations,
    best_merits: Vec<Exact>,
    stages: Vec<StageState>,
    ends: Vec<EndState>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct StageState {
    bar: Exact,
    leading: Vec<(Exact, Start)>,
    finished: Vec<(Exact, Exact)>,
    index: u64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct EndState {
    merit: Exact,
    start: Start,
    /// Whether the referee has judged it; the verdict is computed again on resuming.
    judged: bool,
}

/// The state from which a search resumes, apart from its stages.
pub(super) struct Resumed {
    pub(super) counts: Counts,
    pub(super) evaluations: Evaluations,
    pub(super) best_merits: Vec<f64>,
    pub(super) ends: Vec<End>,
}

impl FreeState {
    pub(super) fn of(
        counts: Counts,
        evaluations: Evaluations,
        best_merits: &[f64],
        stages: &[Stage<'_>],
        ends: &[End],
    ) -> Self {
        let pair = |&(explored, whole): &(f64, f64)| (Exact(explored), Exact(whole));
        let leader = |(merit, start): &(f64, Start)| (Exact(*merit), start.clone());
        let end = |end: &End| EndState {
            merit: Exact(end.merit),
            start: end.start.clone(),
            judged: end.verdict.is_some(),
        };
        let stage = |Stage { memory, .. }: &Stage<'_>| StageState {
            bar: Exact(memory.bar),
            leading: memory.leading.iter().map(leader).collect(),
            finished: memory.finished.iter().map(pair).collect(),
            index: memory.index,
        };
        let state = FreeState {
            counts,
            evaluations,
            best_merits: best_merits.iter().copied().map(Exact).collect(),
            stages: stages.iter().map(stage).collect(),
            ends: ends.iter().map(end).collect(),
        };
        debug_assert!(state.is_counted(), "a state in the middle of a batch");
        state
    }

    /// Returns whether the state lies between two batches.
    fn is_counted(&self) -> bool {
        self.stages.iter().map(|stage| stage.index).sum::<u64>() == self.counts.batch * BATCH
    }

    /// Returns the number of stages that have begun, if the state can be one of this problem's; `points` is the number
    /// of points that the first stage explores.
    pub(super) fn stages(&self, problem: &Problem, points: usize) -> Option<usize> {
        let n = problem.task().len();
        let coarse = points != n;
        let stages = self.stages.len();
        let explored = |i: usize| if i == 0 { points } else { n };
        let leaders =
            self.stages.iter().enumerate().all(|(i, stage)| {
                stage.leading.iter().all(|(_, start)| start.positions.len() == explored(i))
            });
        let ends = self.ends.iter().all(|end| end.start.positions.len() == n);
        let possible = stages == 1 || (stages == 2 && coarse && n <= WHOLE_MOST);
        (possible && self.is_counted() && leaders && ends).then_some(stages)
    }

    /// Restores the memories of the stages and returns the rest; ends that were judged are judged again.
    pub(super) fn resume(&self, problem: &Problem, stages: &mut [Stage<'_>]) -> Resumed {
        for (stage, state) in stages.iter_mut().zip(&self.stages) {
            stage.memory = Memory {
                bar: state.bar.0,
                leading: state.leading.iter().map(|(merit, start)| (merit.0, start.clone())).collect(),
                finished: state.finished.iter().map(|(explored, whole)| (explored.0, whole.0)).collect(),
                index: state.index,
            };
        }
        let end = |end: &EndState| End {
            start: end.start.clone(),
            merit: end.merit.0,
            verdict: end.judged.then(|| judged(problem, &end.start)),
        };
        Resumed {
            counts: self.counts,
            evaluations: self.evaluations,
            best_merits: self.best_merits.iter().map(|merit| merit.0).collect(),
            ends: self.ends.par_iter().map(end).collect(),
        }
    }
}
