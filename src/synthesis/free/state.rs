//! The checkpoint state of the search for free timing: from the search, and back.

use super::{End, Free, Memory, Stage};
use crate::numbers::optimise::exact_float::Exact;
use crate::synthesis::constants::free::{BATCH, WHOLE_MOST};
use crate::synthesis::multistart::judged;
use crate::synthesis::states::{EndState, FreeState, StageState};
use crate::task::Problem;
use rayon::prelude::*;

impl From<&Free<'_>> for FreeState {
    fn from(search: &Free<'_>) -> Self {
        let pair = |&(explored, whole): &(f64, f64)| (Exact(explored), Exact(whole));
        let end = |end: &End| EndState {
            merit: Exact(end.merit),
            start: end.start.clone(),
            judged: end.verdict.is_some(),
        };
        let stage = |Stage { memory, .. }: &Stage<'_>| StageState {
            bar: Exact(memory.bar),
            leading: memory.leading.iter().map(|(merit, start)| (Exact(*merit), start.clone())).collect(),
            finished: memory.finished.iter().map(pair).collect(),
            index: memory.index,
        };
        let state = FreeState {
            counts: search.counts,
            evaluations: search.evaluations,
            best_merits: search.best_merits.iter().copied().map(Exact).collect(),
            stages: search.stages.iter().map(stage).collect(),
            ends: search.ends.iter().map(end).collect(),
        };
        debug_assert!(state.is_counted(), "a state in the middle of a batch");
        state
    }
}

impl FreeState {
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

    /// Restores a search whose stages have begun; ends that were judged are judged again.
    pub(super) fn resume(&self, search: &mut Free<'_>) {
        for (stage, state) in search.stages.iter_mut().zip(&self.stages) {
            stage.memory = Memory {
                bar: state.bar.0,
                leading: state.leading.iter().map(|(merit, start)| (merit.0, start.clone())).collect(),
                finished: state.finished.iter().map(|(explored, whole)| (explored.0, whole.0)).collect(),
                index: state.index,
            };
        }
        let problem = search.problem;
        let end = |end: &EndState| End {
            start: end.start.clone(),
            merit: end.merit.0,
            verdict: end.judged.then(|| judged(problem, &end.start)),
        };
        search.counts = self.counts;
        search.evaluations = self.evaluations;
        search.best_merits = self.best_merits.iter().map(|merit| merit.0).collect();
        search.ends = self.ends.par_iter().map(end).collect();
    }
}
