//! The population searches on the design vector or in reduced variables: genetic, differential evolution, and uniform
//! sampling as the baseline for comparison.

use super::constants::population::{KEPT, LONG_TARGET};
use super::multistart::{judged, settle_positions};
use super::reduced_fitness::{ReducedFitness, forms};
use super::starts::Searched;
use super::{Context, Found, Progress};
use crate::judge::rank::{exact_objective, holds_an_exact};
use crate::numbers::optimise::argmin_bridge::{
    Limits, PopulationProgress, RestartsState, SearchArguments, StopReason, run_restarts,
};
use crate::numbers::optimise::differential_evolution::DifferentialEvolution;
use crate::numbers::optimise::genetic::Genetic;
use crate::numbers::optimise::population::{Fitness, PopulationError, PopulationProblem};
use crate::numbers::optimise::random_search::{UniformSampling, UniformSamplingParameters};
use crate::numbers::optimise::saved::Resumable;
use crate::record::{Candidate, Evaluations, Reason};
use crate::task::Timing;
use crate::task::forms::body_fitness::BodyFitness;
use crate::task::forms::fitness::PathFitness;
use crate::task::forms::genes::DesignFitness;
use crate::task::forms::reduced::refusal;
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::spec::Objective;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The population search to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Population {
    /// The real-coded genetic algorithm.
    Genetic,
    /// Differential evolution.
    DifferentialEvolution,
    /// Uniform random sampling of the box.
    UniformSampling,
}

impl Population {
    /// Returns the name in records.
    pub fn name(self) -> &'static str {
        match self {
            Population::Genetic => "genetic",
            Population::DifferentialEvolution => "differential-evolution",
            Population::UniformSampling => "uniform-sampling",
        }
    }
}

/// Runs a population search, restarting with the next stream whenever it has converged, until `evaluations`
/// are used.
///
/// Returns also the starts for a polish, best first, one for each individual kept; the candidates found are those of
/// these starts, judged without a polish.
///
/// It moves in reduced variables if the method is a population search and `variables` asks for them
/// ([`crate::task::spec::SolveSpec::moves_reduced`]). If everything is fixed there is one design, and it is
/// evaluated once.
///
/// # Errors
/// [`PopulationError`] if the parameters are out of range, or if there are no reduced variables.
pub fn search(
    context: Context<'_>,
    which: Population,
    evaluations: u64,
) -> Result<(Found, Vec<Start>), PopulationError> {
    let problem = context.problem;
    if problem.task().body().is_some() {
        let why = "the ranges of a function are free".to_owned();
        let fitness = BodyFitness::new(problem).ok_or(PopulationError::Form { why })?;
        return search_in(context, &fitness, which, evaluations);
    }
    if !problem.spec().solve.moves_reduced() {
        return search_in(context, &PathFitness::new(problem), which, evaluations);
    }
    if let Some(refusal) = refusal(problem) {
        return Err(PopulationError::Form { why: refusal.to_string() });
    }
    let forms = forms(problem);
    search_in(context, &ReducedFitness::new(problem, &forms), which, evaluations)
}

/// A fitness that checks for a stop before each evaluation, if one takes long: evaluations after a stop are skipped and
/// give [`Fitness::UNKNOWN`], which no point is worse than. The first is always computed, so that there is an answer.
struct Stoppable<'a, F> {
    fitness: &'a F,
    context: Context<'a>,
    is_long: bool,
    begun: AtomicBool,
    skipped: AtomicU64,
}

impl<F: Searched> PopulationProblem for Stoppable<'_, F> {
    fn bounds(&self) -> &[(f64, f64)] {
        self.fitness.bounds()
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        if self.is_long && self.begun.swap(true, Ordering::Relaxed) && self.context.stopped() {
            self.skipped.fetch_add(1, Ordering::Relaxed);
            return Fitness::UNKNOWN;
        }
        self.fitness.evaluate(x)
    }

    fn cost_hint_ns(&self) -> f64 {
        self.fitness.cost_hint_ns()
    }
}

fn search_in<F: Searched>(
    context: Context<'_>,
    fitness: &F,
    which: Population,
    evaluations: u64,
) -> Result<(Found, Vec<Start>), PopulationError> {
    let problem = context.problem;
    let spec = &problem.spec().solve;
    let mut algorithm: Box<dyn Resumable> = match which {
        Population::Genetic => Box::new(Genetic::new(spec.genetic)?),
        Population::DifferentialEvolution => {
            Box::new(DifferentialEvolution::new(spec.differential_evolution)?)
        }
        Population::UniformSampling => Box::new(UniformSampling::new(UniformSamplingParameters::default())?),
    };
    let found = |candidates: Vec<Candidate>, objective: u64, reason: Reason| {
        let evaluations = Evaluations { objective, positions: objective * fitness.positions() };
        Found { candidates, evaluations, reason, used: vec![which.name().into()], repeats: None }
    };
    if fitness.bounds().is_empty() {
        let starts: Vec<Start> = fitness.start(&[], context).into_iter().collect();
        let candidates = starts.iter().filter_map(|start| judged(problem, start)).collect();
        return Ok((found(candidates, 1, Reason::Converged), starts));
    }
    let limits = Limits { evaluations, target: Some(exact_objective(problem)) };
    let sums = spec.objective == Objective::SumOfSquares;
    let stop = AtomicBool::new(context.stopped());
    let stoppable = Stoppable {
        fitness,
        context,
        is_long: context.points() >= LONG_TARGET,
        begun: AtomicBool::new(false),
        skipped: AtomicU64::new(0),
    };
    let skipped = || stoppable.skipped.load(Ordering::Relaxed);
    let mut observe = |at: PopulationProgress<'_>| {
        if context.stopped() {
            stop.store(true, Ordering::Relaxed);
        }
        let accepted = at.best.fitness.is_feasible();
        (context.observer)(&Progress {
            best_sum_sq: (sums && accepted).then_some(at.best.fitness.cost),
            accepted,
            ..Progress::of(which.name(), at.evaluations, evaluations)
        });
    };
    let mut keep = |state: &dyn Fn() -> RestartsState| {
        // The state after a generation that was cut short is not saved.
        if let Some(keeper) = context.keeper.filter(|_| skipped() == 0) {
            keeper.keep(stop.load(Ordering::Relaxed), |at| at.population = Some(state()));
        }
    };
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().population.clone());
    let arguments = SearchArguments {
        problem: &stoppable,
        algorithm: &mut *algorithm,
        starts: &[],
        seed: spec.seed,
        limits,
        cancel: &stop,
        observe: &mut observe,
        keep: &mut keep,
    };
    let outcome = run_restarts(arguments, earlier)?;
    let mut starts = Vec::new();
    let mut candidates = Vec::new();
    let kept =
        [&outcome.best].into_iter().chain(&outcome.restart_bests).chain(outcome.population.iter().take(KEPT));
    let (skipped, judging) = (skipped(), context.judging());
    for individual in kept {
        if skipped > 0 && individual.fitness.violation.is_nan() {
            continue;
        }
        if !judging.may_go_on() {
            break;
        }
        let Some(start) = fitness.start(&individual.x, context) else { continue };
        candidates.extend(judged(problem, &start));
        starts.push(start);
    }
    let reason = match outcome.reason {
        StopReason::Cancelled => context.stop_reason().unwrap_or(Reason::Cancelled),
        // The fitness does not judge: an exact answer has to pass the referee too.
        StopReason::TargetReached if holds_an_exact(problem, &candidates) => Reason::TargetReached,
        StopReason::TargetReached | StopReason::Converged => Reason::Stalled,
        StopReason::EvaluationLimit => Reason::EvaluationLimit,
    };
    Ok((found(candidates, outcome.evaluations - skipped, reason), starts))
}

impl<F: DesignFitness + Sync> Searched for F {
    fn positions(&self) -> u64 {
        self.positions_per_evaluation()
    }

    fn start(&self, x: &[f64], context: Context<'_>) -> Option<Start> {
        debug_assert_eq!(x.len(), self.bounds().len());
        let problem = self.genes().problem();
        let reading = self.read(x);
        let space = self.genes().space(reading.setting.side);
        let design = space.from_free(x);
        let positions = match problem.task().timing() {
            Timing::Prescribed { .. } => Vec::new(),
            Timing::Free => {
                let shape = space.shape(&design)?;
                let sampled = DesignFitness::positions(self, &shape, space.offset(&design), &reading)?;
                settle_positions(context.of(problem), &design, reading.setting, sampled)?
            }
        };
        Some(Start { design, setting: reading.setting, positions, scales: AS_WRITTEN })
    }
}
