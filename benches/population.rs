//! The population searches on the eighteen-point problem, against uniform sampling and against the local
//! search, at equal evaluations: medians, best and worst of twenty seeds. Prints a Markdown table.
//!
//! A comparison of answers, not of times; every candidate is judged by the referee.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use linkwright::internals::files::problem_file;
use linkwright::internals::record::Candidate;
use linkwright::internals::synthesis::population::{Population, search};
use linkwright::internals::synthesis::{Budget, Context, plan};
use linkwright::internals::task::Problem;
use linkwright::internals::task::spec::{Method, Variables};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const SEEDS: u64 = 20;

fn problem(seed: u64, evaluations: u64, method: Method, variables: Variables) -> Problem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/literature/k18.toml");
    let mut spec = problem_file::load(&path, &[]).expect("it is shipped").spec;
    spec.solve.seed = seed;
    spec.solve.evaluations = evaluations;
    spec.solve.method = method;
    spec.solve.variables = variables;
    spec.solve.candidates = 1;
    Problem::new(spec).expect("it is one")
}

fn best(found: &[Candidate]) -> f64 {
    found.iter().filter(|c| c.accepted).map(|c| c.error.sum_sq).fold(f64::INFINITY, f64::min)
}

fn row(name: &str, evaluations: u64, mut run: impl FnMut(u64) -> f64) {
    let start = Instant::now();
    let mut sums: Vec<f64> = (1..=SEEDS).map(&mut run).collect();
    let each_ms = start.elapsed().as_secs_f64() * 1e3 / SEEDS as f64;
    sums.sort_by(f64::total_cmp);
    let last = sums.len() - 1;
    let median = 0.5 * (sums[last / 2] + sums[last.div_ceil(2)]);
    let (least, most) = (sums[0], sums[last]);
    println!("| {name} | {evaluations} | {median:.4e} | {least:.4e} | {most:.4e} | {each_ms:.0} |");
}

fn main() {
    let cancel = AtomicBool::new(false);
    let budget = Budget { cancel: &cancel, deadline: None };
    println!("| search | evaluations at most | median sum of squares | best | worst | ms a run |");
    println!("|---|---|---|---|---|---|");
    let all = [Population::UniformSampling, Population::Genetic, Population::DifferentialEvolution];
    for evaluations in [10_000, 20_000, 200_000] {
        for (variables, word) in [(Variables::Nine, ""), (Variables::Reduced, ", reduced")] {
            for which in all {
                row(&format!("{}{word}", which.name()), evaluations, |seed| {
                    let problem = problem(seed, evaluations, Method::DifferentialEvolution, variables);
                    let (end, _) =
                        search(Context::new(&problem, &budget), which, evaluations).expect("it runs");
                    assert!(end.evaluations.objective <= evaluations, "the budget is kept");
                    best(&end.candidates)
                });
            }
        }
        row("least-squares", evaluations, |seed| {
            let problem = problem(seed, evaluations, Method::LeastSquares, Variables::Nine);
            best(&plan::search(Context::new(&problem, &budget)).expect("it runs").candidates)
        });
    }
}
