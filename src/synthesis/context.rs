//! The inputs that every search is given, as one value.

use super::keeper::Keeper;
use super::{Budget, Judging, Observer};
use crate::record::{Evaluations, Reason};
use crate::task::Problem;

/// The problem of a search, the limits that stop it from outside, and the receivers of its progress and its states.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The problem to solve.
    pub problem: &'a Problem,
    /// The limits from outside.
    pub budget: &'a Budget<'a>,
    /// The callback that receives the progress.
    pub observer: &'a Observer<'a>,
    /// The keeper of the states, from which the search resumes; `None` if none are saved.
    pub keeper: Option<&'a Keeper<'a>>,
}

impl<'a> Context<'a> {
    /// Creates the inputs of a search that reports no progress and saves no states.
    pub fn new(problem: &'a Problem, budget: &'a Budget<'a>) -> Self {
        Context { problem, budget, observer: &|_| {}, keeper: None }
    }

    /// Returns the same inputs for another problem.
    #[must_use]
    pub fn of(self, problem: &'a Problem) -> Self {
        Context { problem, ..self }
    }

    /// Returns the same inputs without an observer and a keeper: for a search within another one.
    #[must_use]
    pub fn silent(self) -> Self {
        Context::new(self.problem, self.budget)
    }

    /// Returns the number of target points.
    pub fn points(self) -> usize {
        self.problem.task().len()
    }

    /// Returns whether the search should end now.
    pub fn stopped(self) -> bool {
        self.budget.stopped()
    }

    /// Returns the reason why the search should end now, if there is one.
    pub fn stop_reason(self) -> Option<Reason> {
        self.budget.stop_reason()
    }

    /// Counts how many candidates may still be judged once the search is stopped.
    pub fn judging(self) -> Judging<'a> {
        self.budget.judging(self.points())
    }

    /// Returns the cost of so many evaluations of the objective, each of which computes one position per target point.
    pub(super) fn cost(self, evaluations: u64) -> Evaluations {
        Evaluations { objective: evaluations, positions: self.points() as u64 * evaluations }
    }
}
