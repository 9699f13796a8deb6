//! The check of a saved state, and the verdicts on its ends.

use crate::synthesis::constants::free::BATCH;
use crate::synthesis::multistart::glanced;
use crate::synthesis::states::{End, FreeState};
use crate::task::Problem;
use rayon::prelude::*;

impl FreeState {
    /// Returns whether the state lies between two batches.
    pub(super) fn is_counted(&self) -> bool {
        self.stages.iter().map(|stage| stage.index).sum::<u64>() == self.counts.batch * BATCH
    }

    /// Returns whether the state can be one of this problem's; `points` are the numbers of points that its stages
    /// explore.
    pub(super) fn is_of(&self, problem: &Problem, points: &[usize]) -> bool {
        let n = problem.task().len();
        let mut explored = self.stages.iter().zip(points);
        self.stages.len() == points.len()
            && self.is_counted()
            && explored.all(|(stage, n)| stage.leading.iter().all(|(_, start)| start.positions.len() == *n))
            && self.ends.iter().all(|end| end.start.positions.len() == n)
    }

    /// Judges the ends again that were judged before the state was saved.
    pub(super) fn judged_again(mut self, problem: &Problem) -> Self {
        let before = self.ends.par_iter_mut().filter(|end| end.judged);
        before.for_each(|end| end.verdict = glanced(problem, &end.start));
        self
    }
}

impl End {
    /// Judges the end unless it has been judged before.
    pub(super) fn judge(&mut self, problem: &Problem) {
        if !self.judged {
            (self.judged, self.verdict) = (true, glanced(problem, &self.start));
        }
    }
}
