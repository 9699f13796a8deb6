//! How the time of a search grows with the target's points, and what a second thread gains.
//!
//! ```text
//! cargo bench --bench scaling                      both tables
//! cargo bench --bench scaling -- points            the first: 10 to 10,000 points of one closed curve
//! cargo bench --bench scaling -- threads           the second: k18f and two shapes on 1 and on 2 threads
//! ```
//!
//! Times are medians of [`RUNS`] runs of the whole search (`search_s`: judging included), each with a fixed
//! budget of evaluations and no time limit. The record is asserted to be the same whatever the run and the
//! number of threads.

#![expect(clippy::print_stdout, reason = "the tables are what this program is for")]

#[path = "../tests/common/random.rs"]
mod random;

use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::problem_file;
use linkwright::internals::mechanism::LinkageType;
use linkwright::internals::numbers::arithmetic::streams::stream;
use linkwright::internals::record::Record;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const RUNS: usize = 3;
/// Evaluations of every number of points: equal budgets are spent alike on draws, fits and judging.
const EASY: u64 = 1000;
/// Evaluations of the hard problems.
const HARD: u64 = 10_000;
/// Noise of the targets, in sizes: nothing is exact, so that nothing ends early.
const NOISE: f64 = 1e-4;

/// The record and the median of its search's time, on this many threads.
fn timed(threads: usize, job: &Job) -> (Record, f64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let mut runs: Vec<_> = (0..RUNS).map(|_| pool.install(|| run(job, &context)).expect("it runs")).collect();
    assert!(runs.windows(2).all(|w| w[0].record == w[1].record), "a search repeats itself");
    runs.sort_by(|one, other| one.search_s.total_cmp(&other.search_s));
    let median = runs.swap_remove(RUNS / 2);
    (median.record, median.search_s)
}

fn by_points() {
    println!("| points | evaluations | search ms | µs an evaluation | ns an evaluation and point |");
    println!("|---|---|---|---|---|");
    for n in [10_usize, 100, 1000, 10_000] {
        let draws = &mut stream(1, 0);
        let linkage = random::linkage(draws, LinkageType::CrankRocker);
        let traced = random::trace(draws, &linkage, n, None).expect("a crank-rocker closes everywhere");
        let points = random::noisy(draws, &traced.points, NOISE * traced.size() / (n as f64).sqrt());
        let listed: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p.re, p.im)).collect();
        let text = format!(
            "format = 1\n[task.path]\npoints = [{}]\nclosed = true\n[require]\norder = \"any\"\n\
             [solve]\ncandidates = 1\nevaluations = {EASY}\n",
            listed.join(", ")
        );
        let file = problem_file::parse("scaling.toml", &text, None, &[]).unwrap_or_else(|e| panic!("{e}"));
        let job = Job { name: file.name, source: None, unit: None, spec: file.spec, front: None };
        let (record, search_s) = timed(1, &job);
        let used = record.evaluations.objective.max(1) as f64;
        let each = search_s / used;
        println!(
            "| {n} | {used} | {:.1} | {:.2} | {:.1} |",
            search_s * 1e3,
            each * 1e6,
            each * 1e9 / n as f64
        );
    }
}

fn by_threads() {
    println!("| problem | evaluations | 1 thread, ms | 2 threads, ms | times faster |");
    println!("|---|---|---|---|---|");
    for name in ["k18f", "shape-figure-8", "shape-heart"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("problems/literature/{name}.toml"));
        let set = [("solve.candidates".to_string(), "1".to_string())];
        let mut file = problem_file::load(&path, &set).unwrap_or_else(|e| panic!("{e}"));
        file.spec.solve.evaluations = HARD;
        let job = Job { name: file.name, source: file.source, unit: file.unit, spec: file.spec, front: None };
        let [(one, one_s), (two, two_s)] = [timed(1, &job), timed(2, &job)];
        assert!(one == two, "{name}: one and two threads differ");
        let used = one.evaluations.objective;
        println!("| {name} | {used} | {:.1} | {:.1} | {:.2} |", one_s * 1e3, two_s * 1e3, one_s / two_s);
    }
}

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let wants = |table: &str| asked.is_empty() || asked.iter().any(|a| a == table);
    assert!(asked.iter().all(|a| a == "points" || a == "threads"), "points or threads, not {asked:?}");
    if wants("points") {
        by_points();
    }
    if wants("threads") {
        by_threads();
    }
}
