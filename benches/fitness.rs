//! Fitness evaluations of the population searches: a core's rate, and two threads against one.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkwright::internals::mechanism::AssemblyMode;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::compact_lm::CompactLeastSquares;
use linkwright::internals::numbers::optimise::population::{
    Individual, PopulationProblem, draw_uniform, evaluate_generation,
};
use linkwright::internals::task::AngleOffset;
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::fitness::PathFitness;
use linkwright::internals::task::forms::projection::{Batch, ProjectedFit, Projection};
use linkwright::internals::task::spec::{
    DesignSpec, ProblemSpec, RequireSpec, SolveSpec, TaskSpec, TimingSpec,
};
use std::f64::consts::TAU;
use std::hint::black_box;

/// A closed target of `n` points, timed evenly or free.
fn problem(n: usize, timed: bool) -> Problem {
    let angle = |i: usize| TAU * i as f64 / n as f64;
    let points =
        (0..n).map(|i| [2.0 * angle(i).cos() + 0.3 * (2.0 * angle(i)).cos(), angle(i).sin()]).collect();
    let crank_deg = (0..n).map(|i| angle(i).to_degrees()).collect();
    let timing = timed.then_some(TimingSpec { crank_deg, offset: AngleOffset::Free, free: Vec::new() });
    let task = TaskSpec { timing, ..TaskSpec::path(points, true) };
    let mut design = DesignSpec::default();
    design.resolve(&task.to_task().expect("the target is a path"));
    let spec = ProblemSpec {
        task,
        design,
        require: RequireSpec::default(),
        solve: SolveSpec::default(),
        loads: None,
    };
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
        // A filter may leave this benchmark out: then the first evaluation is compared with itself.
        individuals.iter_mut().zip(&once).for_each(|(individual, fitness)| individual.fitness = *fitness);
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

/// The reduced form: screening of 512 draws on both assemblies (1,024 costs), and what a step of a fit takes.
fn reduced(c: &mut Criterion) {
    for n in [18, 360] {
        let problem = problem(n, true);
        let form = Projection::new(&problem, 1.0).expect("the timing is prescribed");
        let mut draws = stream(1, 0);
        let mut number = |reach: f64| uniform(&mut draws, -reach, reach);
        let batch = Batch::new(
            (0..512).map(|_| [number(0.5) - 0.9, number(0.5), number(0.5), number(3.0)]).collect(),
        );
        let once = form.screen_unless(&batch, &|| false).expect("nothing stops it");
        let both = [AssemblyMode::Plus, AssemblyMode::Minus];
        for (assembly, costs) in both.into_iter().zip(&once) {
            let mut fit = ProjectedFit::new(&form, assembly);
            for (x, cost) in batch.draws().iter().zip(costs) {
                assert_eq!(cost.to_bits(), form.screen_one(x, assembly).to_bits(), "lanes change no digit");
                let near = |fitted: f64| (fitted - cost).abs() <= 1e-9 * (1.0 + cost);
                assert!(fit.cost(x).map_or(cost.is_infinite(), near), "screening and fit agree");
            }
        }
        let mut group = c.benchmark_group("reduced form, one core");
        group.throughput(Throughput::Elements(1024));
        group.bench_function(format!("{n} points, screened costs"), |b| {
            b.iter(|| form.screen_unless(black_box(&batch), &|| false))
        });
        let mut fit = ProjectedFit::new(&form, AssemblyMode::Plus);
        let start =
            batch.draws().iter().zip(&once[0]).find(|(_, cost)| cost.is_finite()).expect("one closes").0;
        group.throughput(Throughput::Elements(1));
        group.bench_function(format!("{n} points, cost of a fit"), |b| b.iter(|| fit.cost(black_box(start))));
        group.bench_function(format!("{n} points, cost and Jacobian of a fit"), |b| {
            b.iter(|| (fit.cost(black_box(start)), fit.normal()));
        });
        group.finish();
    }
}

criterion_group!(benches, rates, reduced, threads);
criterion_main!(benches);
