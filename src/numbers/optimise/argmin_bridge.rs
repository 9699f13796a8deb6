//! Runs a population algorithm under argmin's executor: the one file that names argmin.
//!
//! Each algorithm implements [`Generations`]; the bridge makes any of them an `argmin::core::Solver` whose state is a
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
    Generations, GenerationsState, Individual, PopulationError, PopulationProblem, best_of, check_box,
    lies_in, sort_best_first,
};
use argmin::core::{
    Error, Executor, KV, PopulationState, Problem, Solver, State, TerminationReason, TerminationStatus,
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
/// besides the arguments of [`run_restarts_from`].
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

/// Searches once, with stream 0 of `seed`, until the algorithm converges or the limits are met.
///
/// `starts` are points that the first population shall contain, as many as fit; the others are drawn uniformly from
/// the box. `observe` is called on this thread after each generation. `cancel` is checked after each generation, so
/// even a search that is cancelled beforehand has an answer, from its first population. The outcome is a function of
/// the problem, the algorithm's parameters, the starts, the seed and the limits, unless the search is cancelled:
/// neither the number of threads nor the observer changes a digit.
///
/// # Errors
/// [`PopulationError`] if the box, a start or the limit makes no search; see [`check_box`].
///
/// # Panics
/// If the algorithm breaks the contract of [`Generations`].
pub fn run(
    problem: &dyn PopulationProblem,
    algorithm: &mut dyn Generations,
    starts: &[Vec<f64>],
    seed: u64,
    limits: &Limits,
    cancel: &AtomicBool,
    observe: &mut dyn FnMut(PopulationProgress<'_>),
) -> Result<PopulationOutcome, PopulationError> {
    check(problem, starts, limits)?;
    let keep = &mut |_: &dyn Fn() -> RestartsState| {};
    let mut search = Search { problem, algorithm, seed, limits, cancel, observe, keep, found: None };
    search.restart(0, starts, None);
    Ok(search.finish())
}

/// Searches with restarts until the limits are met: restart i begins afresh with stream i of `seed`, once restart
/// i - 1 has converged. The best of all restarts is kept.
///
/// `starts` are given to restart 0 only, since the later ones shall find something else. The other arguments are those
/// of [`run`], whose outcome is that of restart 0 alone. The reason is never [`StopReason::Converged`]; the last
/// restart is cut short by the limit.
///
/// # Errors
/// As [`run`].
///
/// # Panics
/// As [`run`].
pub fn run_restarts(
    problem: &dyn PopulationProblem,
    algorithm: &mut dyn Generations,
    starts: &[Vec<f64>],
    seed: u64,
    limits: &Limits,
    cancel: &AtomicBool,
    observe: &mut dyn FnMut(PopulationProgress<'_>),
) -> Result<PopulationOutcome, PopulationError> {
    let keep = &mut |_: &dyn Fn() -> RestartsState| {};
    run_restarts_from(None, problem, algorithm, starts, seed, limits, cancel, observe, keep)
}

/// Continues a search with restarts from `state`, which a search of the same problem, algorithm, starts and seed
/// handed out; the outcome is that of an unbroken search. If `state` is `None` or does not fit, it searches from the
/// beginning, as [`run_restarts`]. `keep` receives the states in between.
///
/// # Errors
/// As [`run`].
///
/// # Panics
/// As [`run`].
#[expect(clippy::too_many_arguments, reason = "those of a search, and where it comes from and goes to")]
pub fn run_restarts_from(
    state: Option<RestartsState>,
    problem: &dyn PopulationProblem,
    algorithm: &mut dyn Generations,
    starts: &[Vec<f64>],
    seed: u64,
    limits: &Limits,
    cancel: &AtomicBool,
    observe: &mut dyn FnMut(PopulationProgress<'_>),
    keep: &mut Keep<'_>,
) -> Result<PopulationOutcome, PopulationError> {
    check(problem, starts, limits)?;
    let mut search = Search { problem, algorithm, seed, limits, cancel, observe, keep, found: None };
    let state = state.filter(|state| state.fits(problem.bounds(), limits));
    let mut index = 0;
    let mut again = None;
    if let Some(state) = state
        && search.algorithm.restore(problem, state.algorithm)
    {
        index = state.restart;
        search.found = state.found;
        again = Some((state.generation, state.evaluations));
    }
    search.restart(index, if index == 0 { starts } else { &[] }, again);
    while search.wants_more() {
        index += 1;
        search.restart(index, &[], None);
    }
    Ok(search.finish())
}

fn check(
    problem: &dyn PopulationProblem,
    starts: &[Vec<f64>],
    limits: &Limits,
) -> Result<(), PopulationError> {
    check_box(problem.bounds(), starts)?;
    if limits.evaluations == 0 {
        return Err(PopulationError::NoEvaluations);
    }
    Ok(())
}

/// A search in progress: its arguments, and the result of the restarts that are over.
struct Search<'a> {
    problem: &'a dyn PopulationProblem,
    algorithm: &'a mut dyn Generations,
    seed: u64,
    limits: &'a Limits,
    cancel: &'a AtomicBool,
    observe: &'a mut dyn FnMut(PopulationProgress<'_>),
    keep: &'a mut Keep<'a>,
    found: Option<PopulationOutcome>,
}

impl Search<'_> {
    /// Returns whether the last restart converged with evaluations left.
    fn wants_more(&mut self) -> bool {
        let Some(found) = &mut self.found else {
            return true;
        };
        if found.reason == StopReason::Converged && found.evaluations >= self.limits.evaluations {
            found.reason = StopReason::EvaluationLimit;
        }
        found.reason == StopReason::Converged
    }

    /// Runs restart `index`; if the algorithm has been restored, it continues after `restored` = (generations,
    /// evaluations).
    fn restart(&mut self, index: u64, starts: &[Vec<f64>], restored: Option<(u64, u64)>) {
        let (evaluations, generations) =
            self.found.as_ref().map_or((0, 0), |found| (found.evaluations, found.generations));
        let (generation, evaluations) = restored.unwrap_or((0, evaluations));
        let bridge = Bridge {
            algorithm: self.algorithm,
            starts,
            seed: self.seed,
            restart: index,
            limits: self.limits,
            cancel: self.cancel,
            observe: self.observe,
            keep: self.keep,
            found: self.found.as_ref(),
            restored: restored.is_some(),
            evaluations,
            generation,
        };
        let result = Executor::new(self.problem, bridge)
            .ctrlc(false)
            .timer(false)
            .run()
            .expect("neither the bridge nor an executor without observers and checkpoints fails");
        let reason = stop_reason(result.state.get_termination_reason());
        let evaluations = result.solver.evaluations;
        let generations = generations + result.solver.generation + 1;
        let mut population = result.solver.algorithm.population().to_vec();
        sort_best_first(&mut population);
        let best = population[0].clone();
        match &mut self.found {
            None => {
                let restart_bests = vec![best.clone()];
                let outcome =
                    PopulationOutcome { best, population, restart_bests, evaluations, generations, reason };
                self.found = Some(outcome);
            }
            Some(found) => {
                (found.evaluations, found.generations) = (evaluations, generations);
                found.reason = reason;
                found.restart_bests.push(best.clone());
                if best.fitness.compare(&found.best.fitness).is_lt() {
                    (found.best, found.population) = (best, population);
                }
            }
        }
    }

    fn finish(self) -> PopulationOutcome {
        self.found.expect("a search makes at least one restart")
    }
}

/// Translates the termination reason that the bridge gave argmin.
fn stop_reason(reason: Option<&TerminationReason>) -> StopReason {
    match reason {
        Some(TerminationReason::SolverConverged) => StopReason::Converged,
        Some(TerminationReason::TargetCostReached) => StopReason::TargetReached,
        Some(TerminationReason::MaxItersReached) => StopReason::EvaluationLimit,
        Some(TerminationReason::Interrupt) => StopReason::Cancelled,
        Some(TerminationReason::Timeout | TerminationReason::SolverExit(_)) | None => {
            unreachable!("the bridge sets no timeout and names one of four reasons")
        }
    }
}

type BridgeState = PopulationState<Vec<f64>, f64>;

/// One restart of an algorithm, as an argmin solver.
struct Bridge<'a> {
    algorithm: &'a mut dyn Generations,
    starts: &'a [Vec<f64>],
    seed: u64,
    restart: u64,
    limits: &'a Limits,
    cancel: &'a AtomicBool,
    observe: &'a mut dyn FnMut(PopulationProgress<'_>),
    keep: &'a mut Keep<'a>,
    /// The result of the restarts before this one.
    found: Option<&'a PopulationOutcome>,
    /// Whether the algorithm has its population already.
    restored: bool,
    /// The number of evaluations over all restarts.
    evaluations: u64,
    /// The index of the generation within this restart.
    generation: u64,
}

impl Bridge<'_> {
    fn remaining(&self) -> u64 {
        self.limits.evaluations - self.evaluations
    }

    fn best(&self) -> &Individual {
        best_of(self.algorithm.population()).expect("an initialised algorithm has a population")
    }

    /// Counts the evaluations that a generation spent, calls the observer and the checkpoint callback, and gives
    /// argmin the best individual.
    fn book(&mut self, spent: u64, mut state: BridgeState) -> BridgeState {
        assert!(
            (1..=self.remaining()).contains(&spent),
            "{} spent {spent} evaluations of {}",
            self.algorithm.name(),
            self.remaining()
        );
        self.evaluations += spent;
        let best = best_of(self.algorithm.population()).expect("an initialised algorithm has a population");
        let overall = match self.found.map(|found| &found.best) {
            Some(before) if before.fitness.compare(&best.fitness).is_le() => before,
            _ => best,
        };
        (self.observe)(PopulationProgress {
            restart: self.restart,
            generation: self.generation,
            evaluations: self.evaluations,
            best: overall,
        });
        if self.remaining() > 0 {
            let (algorithm, found) = (&*self.algorithm, self.found);
            let (restart, generation, evaluations) = (self.restart, self.generation, self.evaluations);
            (self.keep)(&|| RestartsState {
                restart,
                generation,
                evaluations,
                found: found.cloned(),
                algorithm: algorithm.state(),
            });
        }
        state.cost = if best.fitness.is_feasible() { best.fitness.cost } else { f64::INFINITY };
        state.individual.get_or_insert_default().clone_from(&best.x);
        state
    }
}

impl<'p> Solver<&'p dyn PopulationProblem, BridgeState> for Bridge<'_> {
    fn name(&self) -> &str {
        self.algorithm.name()
    }

    fn init(
        &mut self,
        problem: &mut Problem<&'p dyn PopulationProblem>,
        state: BridgeState,
    ) -> Result<(BridgeState, Option<KV>), Error> {
        if self.restored {
            return Ok((state, None));
        }
        let draws = stream(self.seed, self.restart);
        let allowance = self.remaining();
        let (algorithm, starts) = (&mut self.algorithm, self.starts);
        let spent = problem
            .problem("evaluations", |problem| Ok(algorithm.initialise(*problem, starts, draws, allowance)))?;
        Ok((self.book(spent, state), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&'p dyn PopulationProblem>,
        state: BridgeState,
    ) -> Result<(BridgeState, Option<KV>), Error> {
        let allowance = self.remaining();
        let algorithm = &mut self.algorithm;
        let spent = problem.problem("evaluations", |problem| Ok(algorithm.advance(*problem, allowance)))?;
        self.generation += 1;
        Ok((self.book(spent, state), None))
    }

    fn terminate(&mut self, _state: &BridgeState) -> TerminationStatus {
        let best = self.best().fitness;
        let met = |target| best.is_feasible() && best.cost <= target;
        // A success is a success even if the token is set; a search that converges with its last evaluation converged.
        let reason = if self.limits.target.is_some_and(met) {
            TerminationReason::TargetCostReached
        } else if self.cancel.load(Ordering::Relaxed) {
            TerminationReason::Interrupt
        } else if self.algorithm.converged() {
            TerminationReason::SolverConverged
        } else if self.remaining() == 0 {
            TerminationReason::MaxItersReached
        } else {
            return TerminationStatus::NotTerminated;
        };
        TerminationStatus::Terminated(reason)
    }
}
