//! The hot loops allocate nothing: counted by an allocator of this test's own.

mod common;
#[path = "common/coupler_points.rs"]
mod coupler_points;

use common::{literature, load, root};
use coupler_points::CouplerPoints;
use linkwright::internals::mechanism::four_bar::position::Kernel;
use linkwright::internals::numbers::arithmetic::streams::stream;
use linkwright::internals::numbers::optimise::population::{
    Individual, PopulationProblem, draw_uniform, evaluate_generation,
};
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::fitness::PathFitness;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

#[expect(unsafe_code, reason = "an allocator cannot be written without")]
// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = COUNT.try_with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promise is handed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is handed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> usize {
    let before = COUNT.get();
    work();
    COUNT.get() - before
}

#[test]
fn the_counter_counts() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1.0; 100]))) >= 1);
}

#[test]
fn a_fitness_evaluation_allocates_nothing() {
    let example = |name: &str| load(&root().join(format!("problems/examples/{name}.toml")), &[]);
    let footprint = [("require.footprint_in", "[-50, -50, 50, 50]"), ("require.transmission_deg_min", "20")];
    let files = [
        literature("k18", &[]),
        literature("k18", &footprint),
        literature("l10", &footprint),
        literature("v6", &[]),
        literature("a6", &[]),
        example("pivot-box"),
        example("csv-tolerances"),
    ];
    for file in files {
        let name = file.name.clone();
        let problem = Problem::new(file.spec).expect("it is one");
        let fitness = PathFitness::new(&problem);
        let mut individuals = vec![Individual::blank(fitness.bounds().len()); 64];
        let mut draws = stream(3, 0);
        for individual in &mut individuals {
            draw_uniform(&mut draws, fitness.bounds(), &mut individual.x);
        }
        // Once for what the standard library sets up on first use.
        std::hint::black_box(fitness.evaluate(&individuals[0].x));
        let each = allocations(|| {
            for individual in &mut individuals {
                individual.fitness = fitness.evaluate(&individual.x);
            }
        });
        assert_eq!(each, 0, "{name}");
        if fitness.cost_hint_ns() * 64.0 < 200_000.0 {
            assert_eq!(allocations(|| evaluate_generation(&fitness, &mut individuals)), 0, "{name}");
        }
    }
}

#[test]
fn filling_a_curve_allocates_nothing() {
    let linkage =
        linkwright::internals::files::linkage_file::load(&root().join("problems/seeds/romero.toml"))
            .expect("it is one")
            .linkage;
    let kernel = Kernel::new(&linkage);
    let (cos, sin): (Vec<f64>, Vec<f64>) =
        (0..360).map(|i| f64::from(i).to_radians().sin_cos()).map(|(s, c)| (c, s)).unzip();
    let mut out = CouplerPoints::with_room(360);
    out.fill(&kernel, &cos, &sin);
    assert_eq!(allocations(|| out.fill(&kernel, &cos, &sin)), 0);
}
