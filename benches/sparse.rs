//! Searches random targets of 10 to 45 points with free timing from several seeds: how often the best known error is reached,
//! and how often a search believes a worse one.
//!
//! ```text
//! cargo bench --bench sparse                   groups of 10 to 15, 16 to 23 and 24 to 45 points
//! cargo bench --bench sparse -- 10             the group that begins with 10 points
//!     --targets N          of each group (40)
//!     --seeds N            searches of each target (4)
//!     --reference FILE     best known errors in JSON: read, and lowered by what this run found
//! ```
//!
//! Every second target is closed: z = sum of c_k e^(ikt) for k = 1, -1, 2, -2, 3 at uneven t. The others are open: sums of
//! three cosines and sines. A third of each has no noise, a third 0.3 %, a third 2 % of about half its size. In turn nothing is
//! asked, or a crank that turns fully, or a transmission angle of 30 degrees, or a crank-rocker of links up to 6. Without
//! a file the reference is the best error of the run's own seeds: compare two programs with one file, each run twice.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::problem_file::load_any;
use linkwright::internals::record::Reason;
use nalgebra::Complex;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The numbers of points of the targets of a group.
const GROUPS: [RangeInclusive<usize>; 3] = [10..=15, 16..=23, 24..=45];
/// Lists the requirements that targets ask for, in turn.
const ASKED: [&str; 4] = [
    "",
    "[require]\ntype = [\"crank-rocker\", \"double-crank\"]\n",
    "[require]\ntransmission_deg_min = 30\n",
    "[design]\nA = [[-6, 6], [-6, 6]]\nground = [0, 6]\na = [0, 6]\nb = [0, 6]\nc = [0, 6]\ncoupler_x = [-6, 6]\n\
     coupler_y = [-6, 6]\n[require]\ntype = [\"crank-rocker\"]\nlink_ratio_max = 1000\n",
];
/// A sum of squares below which errors are exact.
const EXACT: f64 = 1e-12;

struct Arguments {
    /// The least number of points of the groups.
    from: Option<usize>,
    targets: usize,
    seeds: u64,
    reference: Option<PathBuf>,
}

impl Arguments {
    fn read() -> Arguments {
        let mut arguments = Arguments { from: None, targets: 40, seeds: 4, reference: None };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
            match word.as_str() {
                "--bench" => {}
                "--targets" => arguments.targets = value().parse().expect("a whole number"),
                "--seeds" => arguments.seeds = value().parse().expect("a whole number"),
                "--reference" => arguments.reference = Some(value().into()),
                other => arguments.from = Some(other.parse().expect("the least number of points of a group")),
            }
        }
        arguments
    }
}

/// Draws from a normal distribution (Box and Muller).
fn normal(draws: &mut Xoshiro256PlusPlus) -> f64 {
    let (radius, angle): (f64, f64) = (draws.random(), draws.random());
    (-2.0 * (1.0 - radius).ln()).sqrt() * (TAU * angle).cos()
}

/// Returns the problem file of a target of a group.
fn target(points: &RangeInclusive<usize>, index: usize) -> String {
    let mut draws = Xoshiro256PlusPlus::seed_from_u64((1000 * points.start() + index) as u64);
    let n = draws.random_range(points.clone());
    let mut coefficient = |scale: f64| scale * Complex::new(normal(&mut draws), normal(&mut draws));
    let closed = index.is_multiple_of(2);
    let terms: Vec<(f64, Complex<f64>)> = if closed {
        let others = [(-1.0, 0.6), (2.0, 0.25), (-2.0, 0.25), (3.0, 0.08)];
        let mut terms = vec![(1.0, Complex::new(1.0, 0.0))];
        terms.extend(others.map(|(k, scale)| (k, coefficient(scale))));
        terms
    } else {
        let orders = [0.5, -0.5, 1.0, -1.0, 1.5, -1.5];
        orders.map(|k: f64| (k, coefficient(0.7 / (2.0 * k.abs()).powf(1.5)))).to_vec()
    };
    let noise = [0.0, 0.003, 0.02][index / 2 % 3];
    let mut rows = String::new();
    for i in 0..n {
        let t = match closed {
            true => TAU * i as f64 / n as f64 + draws.random_range(-0.15..0.15),
            false => TAU * i as f64 / (n - 1) as f64,
        };
        let on_curve: Complex<f64> = terms.iter().map(|(k, c)| c * Complex::from_polar(1.0, k * t)).sum();
        let z = on_curve + noise * Complex::new(normal(&mut draws), normal(&mut draws));
        write!(rows, "[{:.5}, {:.5}], ", z.re, z.im).expect("a string takes all");
    }
    let asked = ASKED[index / 2 % ASKED.len()];
    format!("format = 1\n[task.path]\npoints = [{rows}]\nclosed = {closed}\n{asked}")
}

/// The outcome of a search.
struct Outcome {
    /// Infinite if nothing was accepted.
    sum_sq: f64,
    believed: bool,
    evaluations: u64,
}

fn searched(file: &Path, seed: u64) -> Outcome {
    let set = [
        ("solve.candidates", "1".into()),
        ("solve.advice", "false".into()),
        ("solve.seed", seed.to_string()),
    ];
    let set = set.map(|(key, value): (&str, String)| (key.to_owned(), value));
    let job = Job::from(load_any(file, &set).unwrap_or_else(|why| panic!("{why}")));
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let record = run(&job, &context).expect("it runs").record;
    let best = record.candidates.first().filter(|candidate| candidate.accepted);
    Outcome {
        sum_sq: best.map_or(f64::INFINITY, |best| best.error.sum_sq),
        believed: matches!(record.termination.reason, Reason::Converged | Reason::TargetReached),
        evaluations: record.evaluations.objective,
    }
}

fn main() {
    let arguments = Arguments::read();
    let place = tempfile::tempdir().expect("a folder");
    let mut best: BTreeMap<String, f64> = match &arguments.reference {
        Some(file) if file.exists() => {
            let text = fs::read_to_string(file).expect("the file of references");
            serde_json::from_str(&text).expect("sums of squares by target")
        }
        _ => BTreeMap::new(),
    };
    println!(
        "| points | searches | within 1 % | within 5 % | mean of ln(sum / best) | believed | believed, worse by over 1 % | evaluations, million | median |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for group in GROUPS.iter().filter(|group| arguments.from.is_none_or(|from| from == *group.start())) {
        let names: Vec<String> = (0..arguments.targets).map(|i| format!("{}-{i}", group.start())).collect();
        let files: Vec<PathBuf> = (0..)
            .zip(&names)
            .map(|(i, name)| {
                let file = place.path().join(format!("{name}.toml"));
                fs::write(&file, target(group, i)).expect("there is room");
                file
            })
            .collect();
        let jobs: Vec<(usize, u64)> =
            (0..files.len()).flat_map(|i| (1..=arguments.seeds).map(move |seed| (i, seed))).collect();
        let one = || rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let outcomes: Vec<Outcome> =
            jobs.par_iter().map(|&(i, seed)| one().install(|| searched(&files[i], seed))).collect();
        for ((i, _), outcome) in jobs.iter().zip(&outcomes).filter(|(_, outcome)| outcome.sum_sq.is_finite())
        {
            let known = best.entry(names[*i].clone()).or_insert(outcome.sum_sq);
            *known = known.min(outcome.sum_sq);
        }
        let ratio = |(i, _): &(usize, u64), outcome: &Outcome| {
            let known = best.get(&names[*i]).copied().unwrap_or(f64::INFINITY);
            // Nothing accepted counts as tenfold.
            if outcome.sum_sq.is_finite() { (outcome.sum_sq + EXACT) / (known + EXACT) } else { 10.0 }
        };
        let ratios: Vec<f64> = jobs.iter().zip(&outcomes).map(|(job, outcome)| ratio(job, outcome)).collect();
        let within = |factor: f64| ratios.iter().filter(|ratio| **ratio <= factor).count();
        let believed = outcomes.iter().filter(|outcome| outcome.believed).count();
        let wrongly =
            outcomes.iter().zip(&ratios).filter(|(outcome, ratio)| outcome.believed && **ratio > 1.01);
        let mut evaluations: Vec<u64> = outcomes.iter().map(|outcome| outcome.evaluations).collect();
        evaluations.sort_unstable();
        println!(
            "| {} to {} | {} | {} | {} | {:.4} | {believed} | {} | {:.2} | {} |",
            group.start(),
            group.end(),
            jobs.len(),
            within(1.01),
            within(1.05),
            ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64,
            wrongly.count(),
            evaluations.iter().sum::<u64>() as f64 / 1e6,
            evaluations[evaluations.len() / 2],
        );
    }
    if let Some(file) = &arguments.reference {
        let text = serde_json::to_string_pretty(&best).expect("numbers are data");
        fs::write(file, text + "\n").expect("the references are written");
    }
}
