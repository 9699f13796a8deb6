//! Runs a population algorithm under argmin's executor: the one file that names argmin.
//!
//! Each algorithm implements [`Resumable`]; the bridge makes any of them an `argmin::core::Solver` whose state is a
//! `PopulationState<Vec<f64>, f64>`. Four tasks are not left to argmin:
//!
//! - *counting*: argmin counts evaluations only on request, per call of the problem, and from zero after a resume. The
//!   algorithms report their own evaluations, and the limit is met to the evaluation;
//! - *infeasible points*: argmin knows one cost. It sees infinity until a feasible point is found, while the algorithms
//!   go by the feasibility rules of [`Fitness`](super::population::Fitness);
//! - *signals*: its handler is for the whole process. A search checks the cancellation token of its own job after
//!   each generation.
//!
//! - *checkpoints*: argmin's would replace the solver and the limits by what was written. Here a search hands out its
//!   [`RestartsState`] after whole generations and can begin from one; limits are those of the call.
//!
//! A search that stops at its limit, by cancellation or in a stall is an outcome, not an error.

use super::population::{
    Individual, PopulationError, PopulationProblem, best_of, check_box, lies_in, sort_best_first,
};
use super::saved::{GenerationsState, Resumable};
use argmin::core::{
    Error, Executor, KV, PopulationState, Problem, Solver, TerminationReason, TerminationStatus,
};
use linkwright_arithmetic::streams::stream;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The largest number of evaluations, at least 1.
    pub evaluations: u64,
    /// The target cost: a search stops as soon as a feasible point costs no more. It is checked after each
    /// generation; NaN is never reached.
    pub target: Option<f64>,
}

/// The reason for which a search stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum StopReason {
    /// Convergence: the best stalled or the population collapsed.
    Converged,
    /// A feasible point reached the target.
    TargetReached,
    /// All evaluations were used.
    EvaluationLimit,
    /// The cancellation token was set.
    Cancelled,
}

/// The progress of a search after a generation.
#[derive(Clone, Copy, Debug)]
pub struct PopulationProgress<'a> {
    /// The index of the restart, from zero.
    pub restart: u64,
    /// The index of the generation within the restart; zero is the first population.
    pub generation: u64,
    /// The number of evaluations so far, over all restarts.
    pub evaluations: u64,
    /// The best individual so far, over all restarts.
    pub best: &'a Individual,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PopulationOutcome {
    /// The best individual of all. It may be infeasible, if no feasible one was met.
    pub best: Individual,
    /// The last population of the restart that found the best, sorted best first: `best` is its first.
    pub population: Vec<Individual>,
    /// The best individual of each restart, in the order of the restarts.
    pub restart_bests: Vec<Individual>,
    /// The exact number of evaluations.
    pub evaluations: u64,
    /// The number of generations over all restarts, first populations included.
    pub generations: u64,
    /// The reason for which the search stopped.
    pub reason: StopReason,
}

/// The checkpoint of a search with restarts between two generations: everything that its continuation depends on
/// besides the [`SearchArguments`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RestartsState {
    /// The index of the restart, from zero.
    restart: u64,
    /// The index of the generation within this restart.
    generation: u64,
    /// The number of evaluations over all restarts.
    evaluations: u64,
    /// The result of the restarts before this one.
    found: Option<PopulationOutcome>,
    /// The state of the algorithm.
    algorithm: GenerationsState,
}

impl RestartsState {
    /// Returns whether the state is consistent with this box and these limits.
    fn fits(&self, bounds: &[(f64, f64)], limits: &Limits) -> bool {
        let found = self.found.as_ref().is_none_or(|found| {
            let individuals = [&found.best].into_iter().chain(&found.population).chain(&found.restart_bests);
            found.evaluations < self.evaluations
                && found.restart_bests.len() as u64 == self.restart
                && individuals.into_iter().all(|individual| lies_in(&individual.x, bounds))
        });
        found
            && self.found.is_some() == (self.restart > 0)
            && (1..limits.evaluations).contains(&self.evaluations)
    }
}

/// A callback for checkpoints, called after every whole generation that is not the last one. Its argument is a
/// function that returns the state of the search; the callback need not call it.
pub type Keep<'k> = dyn FnMut(&dyn Fn() -> RestartsState) + 'k;

/// The arguments of a search.
pub struct SearchArguments<'a> {
    /// The problem.
    pub problem: &'a dyn PopulationProblem,
    /// The algorithm.
    pub algorithm: &'a mut dyn Resumable,
    /// Points that the first population shall contain, as many as fit; the others are drawn uniformly from the box.
    /// They are given to restart 0 only, since the later ones shall find something else.
    pub starts: &'a [Vec<f64>],
    /// The seed: restart i draws from its stream i.
    pub seed: u64,
    /// The limits.
    pub limits: Limits,
    /// The cancellation token. It is checked after each generation, so even a search that is cancelled beforehand has
    /// an answer, from its first population.
    pub cancel: &'a AtomicBool,
    /// A callback for progress, called on this thread after each generation.
    pub observe: &'a mut dyn FnMut(PopulationProgress<'_>),
    /// A callback for checkpoints.
    pub keep: &'a mut Keep<'a>,
}

/// Searches once until the algorithm converges or the limits are met.
///
/// The outcome is a function of the problem, the algorithm's parameters, the starts, the seed and the limits, unless
/// the search is cancelled: neither the number of threads nor the observer changes a digit.
///
/// # Errors
/// [`PopulationError`] if the box, a start or the limit makes no search; see [`check_box`].
///
/// # Panics
/// If the algorithm breaks the contract of [`Generations`](super::population::Generations).
pub fn run(arguments: SearchArguments<'_>) -> Result<PopulationOutcome, PopulationError> {
    Search::new(arguments, false)?.run()
}

/// Searches with restarts until the limits are met: restart i begins afresh with stream i of the seed, once restart
/// i - 1 has converged. The best of all restarts is kept.
///
/// The outcome of [`run`] is that of restart 0 alone. The reason is never [`StopReason::Converged`]; the last restart
/// is cut short by the limit. If `state` is one that a search of the same problem, algorithm, starts and seed handed
/// out, the search continues from there, and its outcome is that of an unbroken search; a state that does not fit is
/// ignored.
///
/// # Errors
/// As [`run`].
///
/// # Panics
/// As [`run`].
pub fn run_restarts(
    arguments: SearchArguments<'_>,
    state: Option<RestartsState>,
) -> Result<PopulationOutcome, PopulationError> {
    let mut search = Search::new(arguments, true)?;
    if let Some(state) = state {
        search.restore(state);
    }
    search.run()
}

/// A search in progress, as an argmin solver.
struct Search<'a> {
    arguments: SearchArguments<'a>,
    /// Whether the search restarts when the algorithm has converged.
    restarting: bool,
    /// The result of the restarts before this one.
    found: Option<PopulationOutcome>,
    /// The index of the restart.
    restart: u64,
    /// The index of the last generation within this restart; `None` before its first population.
    generation: Option<u64>,
    /// The number of evaluations over all restarts.
    evaluations: u64,
    reason: StopReason,
}

type SearchState = PopulationState<Vec<f64>, f64>;

impl<'a> Search<'a> {
    fn new(arguments: SearchArguments<'a>, restarting: bool) -> Result<Self, PopulationError> {
        check_box(arguments.problem.bounds(), arguments.starts)?;
        if arguments.limits.evaluations == 0 {
            return Err(PopulationError::NoEvaluations);
        }
        let reason = StopReason::Converged;
        Ok(Search {
            arguments,
            restarting,
            found: None,
            restart: 0,
            generation: None,
            evaluations: 0,
            reason,
        })
    }

    /// Continues from a state if it fits.
    fn restore(&mut self, state: RestartsState) {
        let bounds = self.arguments.problem.bounds();
        if state.fits(bounds, &self.arguments.limits)
            && self.arguments.algorithm.restore(bounds, state.algorithm)
        {
            (self.found, self.restart) = (state.found, state.restart);
            (self.generation, self.evaluations) = (Some(state.generation), state.evaluations);
        }
    }

    fn run(self) -> Result<PopulationOutcome, PopulationError> {
        let executor = Executor::new(self.arguments.problem, self).ctrlc(false).timer(false);
        let result = executor.run().map_err(|error| PopulationError::Executor { why: error.to_string() })?;
        let mut search = result.solver;
        search.conclude();
        search.found.ok_or(PopulationError::NoEvaluations)
    }

    fn remaining(&self) -> u64 {
        self.arguments.limits.evaluations - self.evaluations
    }

    /// Adds the present restart to the result.
    fn conclude(&mut self) {
        let mut population = self.arguments.algorithm.population().to_vec();
        sort_best_first(&mut population);
        let Some(best) = population.first().cloned() else { return };
        let (evaluations, reason) = (self.evaluations, self.reason);
        let found = self.found.get_or_insert_with(|| PopulationOutcome {
            best: best.clone(),
            population: population.clone(),
            restart_bests: Vec::new(),
            evaluations,
            generations: 0,
            reason,
        });
        (found.evaluations, found.reason) = (evaluations, reason);
        found.generations += self.generation.map_or(0, |last| last + 1);
        found.restart_bests.push(best.clone());
        if best.fitness.compare(&found.best.fitness).is_lt() {
            (found.best, found.population) = (best, population);
        }
    }

    /// Makes one generation, the first of a restart if there is none yet or the last restart has converged.
    fn generate(&mut self, problem: &Evaluated<'_>, state: SearchState) -> SearchState {
        if self.generation.is_some() && self.arguments.algorithm.converged() {
            self.conclude();
            self.restart += 1;
            self.generation = None;
        }
        let allowance = self.remaining();
        let SearchArguments { algorithm, starts, seed, .. } = &mut self.arguments;
        let spent = match self.generation {
            Some(_) => algorithm.advance(*problem, allowance),
            None => {
                let starts = if self.restart == 0 { starts } else { &[][..] };
                algorithm.initialise(*problem, starts, stream(*seed, self.restart), allowance)
            }
        };
        self.generation = Some(self.generation.map_or(0, |last| last + 1));
        self.book(spent, state)
    }

    /// Counts the evaluations that a generation spent, calls the observer and the checkpoint callback, and gives
    /// argmin the best individual.
    fn book(&mut self, spent: u64, mut state: SearchState) -> SearchState {
        let (remaining, generation) = (self.remaining(), self.generation.unwrap_or(0));
        let algorithm = &*self.arguments.algorithm;
        assert!(
            (1..=remaining).contains(&spent),
            "{} spent {spent} evaluations of {remaining}",
            algorithm.name()
        );
        self.evaluations += spent;
        let (restart, evaluations, found) = (self.restart, self.evaluations, &self.found);
        let Some(best) = best_of(algorithm.population()) else { return state };
        let overall = match found {
            Some(before) if before.best.fitness.compare(&best.fitness).is_le() => &before.best,
            _ => best,
        };
        (self.arguments.observe)(PopulationProgress { restart, generation, evaluations, best: overall });
        if remaining > spent {
            (self.arguments.keep)(&|| RestartsState {
                restart,
                generation,
                evaluations,
                found: found.clone(),
                algorithm: algorithm.state(),
            });
        }
        state.cost = if best.fitness.is_feasible() { best.fitness.cost } else { f64::INFINITY };
        state.individual.get_or_insert_default().clone_from(&best.x);
        state
    }

    /// Returns the reason to stop after a generation, with argmin's name of it.
    fn stop(&self) -> Option<(StopReason, TerminationReason)> {
        let SearchArguments { algorithm, limits, cancel, .. } = &self.arguments;
        let best = best_of(algorithm.population()).map(|best| best.fitness);
        let met = |target| best.is_some_and(|best| best.is_feasible() && best.cost <= target);
        // A success is a success even if the token is set; a search that converges with its last evaluation converged.
        if limits.target.is_some_and(met) {
            Some((StopReason::TargetReached, TerminationReason::TargetCostReached))
        } else if cancel.load(Ordering::Relaxed) {
            Some((StopReason::Cancelled, TerminationReason::Interrupt))
        } else if algorithm.converged() && !self.restarting {
            Some((StopReason::Converged, TerminationReason::SolverConverged))
        } else if self.remaining() == 0 {
            Some((StopReason::EvaluationLimit, TerminationReason::MaxItersReached))
        } else {
            None
        }
    }
}

type Evaluated<'p> = &'p dyn PopulationProblem;

impl<'p> Solver<Evaluated<'p>, SearchState> for Search<'_> {
    fn name(&self) -> &str {
        self.arguments.algorithm.name()
    }

    fn init(
        &mut self,
        problem: &mut Problem<Evaluated<'p>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        // A search that continues from a state has its population.
        if self.generation.is_some() { Ok((state, None)) } else { self.next_iter(problem, state) }
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<Evaluated<'p>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        Ok((problem.problem("evaluations", |problem| Ok(self.generate(problem, state)))?, None))
    }

    fn terminate(&mut self, _state: &SearchState) -> TerminationStatus {
        match self.stop() {
            Some((reason, named)) => {
                self.reason = reason;
                TerminationStatus::Terminated(named)
            }
            None => TerminationStatus::NotTerminated,
        }
    }
}
