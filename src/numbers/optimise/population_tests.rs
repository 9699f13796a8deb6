//! Tests of the properties that every population search has, whichever the algorithm.

use super::argmin_bridge::{
    Limits, PopulationOutcome, PopulationProgress, RestartsState, SearchArguments, StopReason, run,
    run_restarts,
};
use super::differential_evolution::{DifferentialEvolution, DifferentialEvolutionParameters};
use super::genetic::{Genetic, GeneticParameters};
use super::population::{PopulationError, PopulationProblem};
use super::random_search::{UniformSampling, UniformSamplingParameters};
use super::saved::Resumable;
use super::test_functions::{Constrained, Counted, Rosenbrock, Sphere};
use proptest::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

fn differential_evolution() -> Box<dyn Resumable> {
    Box::new(DifferentialEvolution::new(DifferentialEvolutionParameters::default()).unwrap())
}

fn genetic() -> Box<dyn Resumable> {
    Box::new(Genetic::new(GeneticParameters::default()).unwrap())
}

fn uniform_sampling() -> Box<dyn Resumable> {
    Box::new(UniformSampling::new(UniformSamplingParameters::default()).unwrap())
}

fn every_algorithm() -> [Box<dyn Resumable>; 3] {
    [differential_evolution(), genetic(), uniform_sampling()]
}

fn limit(evaluations: u64) -> Limits {
    Limits { evaluations, target: None }
}

/// A search with its arguments in a row: whether it restarts, the problem, the algorithm, starts, seed, limits, token
/// and observer.
type Asked<'a> = (
    bool,
    &'a dyn PopulationProblem,
    &'a mut dyn Resumable,
    &'a [Vec<f64>],
    u64,
    Limits,
    &'a AtomicBool,
    &'a mut dyn FnMut(PopulationProgress<'_>),
);

fn search(asked: Asked<'_>) -> Result<PopulationOutcome, PopulationError> {
    let (restarts, problem, algorithm, starts, seed, limits, cancel, observe) = asked;
    let keep = &mut |_: &dyn Fn() -> RestartsState| {};
    let arguments = SearchArguments { problem, algorithm, starts, seed, limits, cancel, observe, keep };
    if restarts { run_restarts(arguments, None) } else { run(arguments) }
}

fn once(
    problem: &dyn PopulationProblem,
    mut algorithm: Box<dyn Resumable>,
    seed: u64,
    limits: Limits,
) -> PopulationOutcome {
    let cancel = AtomicBool::new(false);
    search((false, problem, &mut *algorithm, &[], seed, limits, &cancel, &mut |_| {})).unwrap()
}

fn restarted(
    problem: &dyn PopulationProblem,
    mut algorithm: Box<dyn Resumable>,
    seed: u64,
    limits: Limits,
) -> PopulationOutcome {
    let cancel = AtomicBool::new(false);
    search((true, problem, &mut *algorithm, &[], seed, limits, &cancel, &mut |_| {})).unwrap()
}

#[test]
fn differential_evolution_finds_the_bottom_of_a_bowl_and_collapses_there() {
    let outcome = once(&Sphere::new(10), differential_evolution(), 1, limit(100_000));
    assert_eq!(outcome.reason, StopReason::Converged);
    assert!(outcome.evaluations < 100_000);
    // Ten genes that agree to 1e-10 of a width of 10, at worst all off by that.
    assert!(outcome.best.fitness.cost < 10.0 * 1e-18, "{:?}", outcome.best);
}

#[test]
fn differential_evolution_follows_the_valley_of_rosenbrock() {
    let outcome = once(&Rosenbrock::new(10), differential_evolution(), 1, limit(60_000));
    for x in &outcome.best.x {
        assert!((x - 1.0).abs() < 1e-6, "{:?}", outcome.best);
    }
}

#[test]
fn the_genetic_algorithm_finds_the_bottom_of_a_bowl_to_three_digits() {
    let outcome = once(&Sphere::new(10), genetic(), 1, limit(20_000));
    for (j, x) in outcome.best.x.iter().enumerate() {
        assert!((x - 1.0 / (j + 1) as f64).abs() < 1e-3, "{:?}", outcome.best);
    }
}

#[test]
fn an_optimum_on_a_constraint_is_found_by_the_feasibility_rules() {
    for (algorithm, tolerance) in [(differential_evolution(), 1e-8), (genetic(), 1e-3)] {
        let outcome = restarted(&Constrained, algorithm, 2, limit(20_000));
        assert!(outcome.best.fitness.is_feasible());
        assert!((outcome.best.fitness.cost + 1.25).abs() < tolerance, "{:?}", outcome.best);
        // Near a smooth optimum the point has half of the digits of the cost.
        let (x, y) = (outcome.best.x[0], outcome.best.x[1]);
        assert!((x + 0.5).hypot(y + 0.75) < 2.0 * f64::sqrt(tolerance), "{x} {y}");
    }
}

#[test]
fn both_learning_searches_beat_uniform_sampling_tenfold_at_equal_evaluations() {
    for problem in [&Sphere::new(10) as &dyn PopulationProblem, &Rosenbrock::new(10)] {
        for seed in 0..3 {
            let cost = |algorithm| restarted(problem, algorithm, seed, limit(10_000)).best.fitness.cost;
            let baseline = cost(uniform_sampling());
            assert!(10.0 * cost(differential_evolution()) < baseline);
            assert!(10.0 * cost(genetic()) < baseline);
        }
    }
}

#[test]
fn one_thread_and_two_give_the_same_digits() {
    // Every generation of this problem is shared, if there are threads to share it.
    let problem = Rosenbrock::new(6);
    for number in 0..3 {
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let [de, ga, sampling] = every_algorithm();
                let algorithm = [de, ga, sampling].into_iter().nth(number).unwrap();
                restarted(&problem, algorithm, 9, limit(12_345))
            })
        };
        assert_eq!(with_threads(1), with_threads(2));
    }
}

#[test]
fn another_seed_gives_another_search() {
    for (one, other) in every_algorithm().into_iter().zip(every_algorithm()) {
        let problem = Sphere::new(4);
        assert_ne!(once(&problem, one, 0, limit(500)).best, once(&problem, other, 1, limit(500)).best);
    }
}

#[test]
fn an_algorithm_that_was_used_before_searches_as_a_new_one_does() {
    let (cancel, problem) = (AtomicBool::new(false), Sphere::new(3));
    for (mut used, fresh) in every_algorithm().into_iter().zip(every_algorithm()) {
        let mut again = |seed| {
            let limits = limit(1500);
            search((false, &problem, &mut *used, &[], seed, limits, &cancel, &mut |_| {})).unwrap()
        };
        again(4);
        assert_eq!(again(5), once(&problem, fresh, 5, limit(1500)));
    }
}

#[test]
fn a_longer_search_is_never_worse() {
    for number in 0..3 {
        let search = |evaluations| {
            let algorithm = every_algorithm().into_iter().nth(number).unwrap();
            restarted(&Rosenbrock::new(3), algorithm, 6, limit(evaluations))
        };
        let costs: Vec<f64> =
            [1, 150, 400, 1000, 4000, 9001].map(|evaluations| search(evaluations).best.fitness.cost).to_vec();
        assert!(costs.is_sorted_by(|shorter, longer| longer <= shorter), "{costs:?}");
    }
}

#[test]
fn all_evaluations_are_used_and_not_one_more() {
    for evaluations in [1, 2, 49, 51, 199, 201, 381, 2000, 7777] {
        for algorithm in every_algorithm() {
            let problem = Counted::new(Sphere::new(2));
            let name = algorithm.name();
            let outcome = restarted(&problem, algorithm, 0, limit(evaluations));
            assert_eq!(problem.evaluations(), evaluations, "{name}");
            assert_eq!(outcome.evaluations, evaluations, "{name}");
            assert_eq!(outcome.reason, StopReason::EvaluationLimit, "{name}");
        }
    }
}

#[test]
fn the_target_stops_the_search_at_a_feasible_point() {
    let limits = Limits { evaluations: 1_000_000, target: Some(-1.2) };
    for algorithm in every_algorithm() {
        let outcome = restarted(&Constrained, algorithm, 0, limits);
        assert_eq!(outcome.reason, StopReason::TargetReached);
        assert!(outcome.best.fitness.is_feasible() && outcome.best.fitness.cost <= -1.2);
    }
}

#[test]
fn a_cancelled_search_stops_after_the_generation_and_keeps_its_best() {
    for mut algorithm in every_algorithm() {
        let (problem, cancel) = (Counted::new(Sphere::new(5)), AtomicBool::new(false));
        let mut observe = |progress: PopulationProgress<'_>| {
            cancel.store(progress.generation == 3, Ordering::Relaxed);
        };
        let limits = limit(1_000_000);
        let outcome =
            search((true, &problem, &mut *algorithm, &[], 0, limits, &cancel, &mut observe)).unwrap();
        assert_eq!(outcome.reason, StopReason::Cancelled);
        assert_eq!(outcome.generations, 4);
        assert_eq!(outcome.evaluations, problem.evaluations());
        assert_eq!(outcome.best.fitness, problem.evaluate(&outcome.best.x));
    }
}

#[test]
fn a_search_that_is_cancelled_beforehand_answers_from_its_first_population() {
    let cancel = AtomicBool::new(true);
    let (problem, limits) = (Sphere::new(5), limit(10_000));
    let outcome = search((true, &problem, &mut *genetic(), &[], 0, limits, &cancel, &mut |_| {})).unwrap();
    assert_eq!((outcome.reason, outcome.evaluations), (StopReason::Cancelled, 200));
}

#[test]
fn the_observer_sees_the_count_rise_and_the_best_fall() {
    for mut algorithm in every_algorithm() {
        let (cancel, limits) = (AtomicBool::new(false), limit(20_000));
        let mut seen: Vec<(u64, u64, f64)> = Vec::new();
        let mut observe = |progress: PopulationProgress<'_>| {
            let cost = progress.best.fitness.cost;
            seen.push((progress.restart, progress.evaluations, cost));
        };
        let problem = Sphere::new(2);
        let outcome =
            search((true, &problem, &mut *algorithm, &[], 3, limits, &cancel, &mut observe)).unwrap();
        assert_eq!(seen.len() as u64, outcome.generations);
        assert!(seen.is_sorted_by(|one, two| one.0 <= two.0 && one.1 < two.1 && one.2 >= two.2));
        let last = (outcome.restart_bests.len() as u64 - 1, 20_000, outcome.best.fitness.cost);
        assert_eq!(seen.last(), Some(&last));
    }
}

#[test]
fn restart_zero_is_the_single_search_and_the_best_restart_is_the_answer() {
    let single = once(&Sphere::new(2), differential_evolution(), 8, limit(50_000));
    let outcome = restarted(&Sphere::new(2), differential_evolution(), 8, limit(50_000));
    assert_eq!(single.restart_bests, outcome.restart_bests[..1]);
    assert!(outcome.restart_bests.len() > 2);
    assert!(outcome.restart_bests.contains(&outcome.best));
    for best in &outcome.restart_bests {
        assert!(outcome.best.fitness.compare(&best.fitness).is_le());
    }
    assert_eq!(outcome.population[0], outcome.best);
    assert!(outcome.population.is_sorted_by(|one, two| one.fitness.compare(&two.fitness).is_le()));
}

#[test]
fn starts_are_moved_into_the_box_and_never_lost() {
    let answer: Vec<f64> = vec![1.0; 6];
    let starts = [vec![99.0; 6], answer.clone()];
    for mut algorithm in every_algorithm() {
        let (problem, cancel) = (Counted::new(Rosenbrock::new(6)), AtomicBool::new(false));
        let limits = limit(3000);
        let outcome =
            search((true, &problem, &mut *algorithm, &starts, 0, limits, &cancel, &mut |_| {})).unwrap();
        assert_eq!(outcome.best.x, answer);
    }
}

#[test]
fn mistakes_of_the_caller_are_errors() {
    let cancel = AtomicBool::new(false);
    let attempt = |starts: &[Vec<f64>], evaluations| {
        let (problem, limits) = (Sphere::new(2), limit(evaluations));
        search((false, &problem, &mut *genetic(), starts, 0, limits, &cancel, &mut |_| {})).unwrap_err()
    };
    assert_eq!(attempt(&[], 0), PopulationError::NoEvaluations);
    let length = PopulationError::StartLength { start: 0, genes: 3, expected: 2 };
    assert_eq!(attempt(&[vec![0.0; 3]], 10), length);
}

/// A problem in which nothing is feasible and every number is NaN.
struct Nowhere;

impl PopulationProblem for Nowhere {
    fn bounds(&self) -> &[(f64, f64)] {
        &[(0.0, 1.0), (-1.0, 0.0)]
    }

    fn evaluate(&self, _x: &[f64]) -> super::population::Fitness {
        super::population::Fitness::UNKNOWN
    }
}

#[test]
fn a_problem_that_answers_nothing_but_nan_is_searched_to_the_limit() {
    for algorithm in every_algorithm() {
        let outcome = restarted(&Nowhere, algorithm, 0, limit(30_000));
        assert_eq!((outcome.reason, outcome.evaluations), (StopReason::EvaluationLimit, 30_000));
        assert!(!outcome.best.fitness.is_feasible());
    }
}

/// The distance to a corner of a box of any size and place.
struct Corner(Vec<(f64, f64)>);

impl PopulationProblem for Corner {
    fn bounds(&self) -> &[(f64, f64)] {
        &self.0
    }

    fn evaluate(&self, x: &[f64]) -> super::population::Fitness {
        let share = x.iter().zip(&self.0).map(|(x, (lower, upper))| (x - lower) / (upper - lower));
        super::population::Fitness::feasible(share.sum())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn no_point_outside_the_box_is_ever_evaluated(
        place in prop::collection::vec((-1e3..1e3, -9.0..9.0), 1..5),
        seed: u64,
    ) {
        // Widths from 1e-9 to 1e9; the answer is on the boundary, where points leave the box most. `Counted` checks.
        let bounds = place.iter().map(|&(lower, digits)| {
            let lower: f64 = lower;
            (lower, lower + 10_f64.powf(digits))
        });
        let problem = Counted::new(Corner(bounds.collect()));
        for algorithm in every_algorithm() {
            let outcome = restarted(&problem, algorithm, seed, limit(1500));
            prop_assert!(outcome.best.fitness.cost >= 0.0);
        }
    }
}
