//! Fitness evaluations of the population searches: a core's rate, and two threads against one.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkwright::problem::Problem;
use linkwright::problem::fitness::PathFitness;
use linkwright::problem::spec::{
    DesignSpec, PathSpec, ProblemSpec, RequireSpec, SolveSpec, TaskSpec, TimingSpec,
};
use linkwright::solve::population::{Individual, PopulationProblem, draw_uniform, evaluate_generation};
use linkwright::solve::streams::stream;
use linkwright::task::AngleOffset;
use std::f64::consts::TAU;
use std::hint::black_box;

/// A closed target of `n` points, timed evenly or free.
fn problem(n: usize, timed: bool) -> Problem {
    let angle = |i: usize| TAU * i as f64 / n as f64;
    let points =
        (0..n).map(|i| [2.0 * angle(i).cos() + 0.3 * (2.0 * angle(i)).cos(), angle(i).sin()]).collect();
    let crank_deg = (0..n).map(|i| angle(i).to_degrees()).collect();
    let timing = timed.then_some(TimingSpec { crank_deg, offset: AngleOffset::Free });
    let path = PathSpec { points, closed: true, weight: None, tolerance: None, timing };
    let task = TaskSpec { path };
    let mut design = DesignSpec::default();
    design.resolve(&task.path.to_task().expect("the target is a path"));
    let spec = ProblemSpec { task, design, require: RequireSpec::default(), solve: SolveSpec::default() };
    Problem::new(spec).expect("the target is a path")
}

fn generation(problem: &PathFitness<'_>, size: usize) -> Vec<Individual> {
    let mut individuals = vec![Individual::blank(problem.bounds().len()); size];
    let mut draws = stream(1, 0);
    for individual in &mut individuals {
        draw_uniform(&mut draws, problem.bounds(), &mut individual.x);
    }
    individuals
}

fn rates(c: &mut Criterion) {
    for (name, n, timed) in [
        ("18 points, timed", 18, true),
        ("360 points, timed", 360, true),
        ("18 points, free", 18, false),
        ("60 points, free", 60, false),
    ] {
        let problem = problem(n, timed);
        let fitness = PathFitness::new(&problem);
        let mut individuals = generation(&fitness, 512);
        let once: Vec<_> = individuals.iter().map(|i| fitness.evaluate(&i.x)).collect();
        let mut group = c.benchmark_group("fitness evaluations, one core");
        group.throughput(Throughput::Elements(512));
        group.bench_function(name, |b| {
            b.iter(|| {
                for individual in &mut individuals {
                    individual.fitness = fitness.evaluate(black_box(&individual.x));
                }
            });
        });
        for (individual, fitness) in individuals.iter().zip(once) {
            assert!(individual.fitness.compare(&fitness).is_eq(), "the same design has the same fitness");
        }
        group.finish();
    }
}

fn threads(c: &mut Criterion) {
    for (name, n, size) in [("population 4,000, 360 points", 360, 4000), ("population 50, 18 points", 18, 50)]
    {
        let problem = problem(n, true);
        let fitness = PathFitness::new(&problem);
        let mut group = c.benchmark_group(format!("a generation: {name}"));
        group.throughput(Throughput::Elements(size as u64));
        let mut reference: Option<Vec<Individual>> = None;
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut individuals = generation(&fitness, size);
            pool.install(|| evaluate_generation(&fitness, &mut individuals));
            match &reference {
                None => reference = Some(individuals.clone()),
                Some(one) => {
                    for (x, y) in one.iter().zip(&individuals) {
                        assert!(x.fitness.compare(&y.fitness).is_eq(), "threads change no digit");
                    }
                }
            }
            group.bench_function(format!("{threads} thread(s)"), |b| {
                pool.install(|| b.iter(|| evaluate_generation(&fitness, black_box(&mut individuals))));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, rates, threads);
criterion_main!(benches);
