//! Synthesizes linkages for the poses of bodies on the couplers of random four-bars, and compares each answer with the best
//! of many random starts of the same fit.
//!
//! ```text
//! cargo bench --bench motion
//!     --problems N        problems, of random linkages of all types (400)
//!     --starts N          random starts of each (3000); 0: none
//!     --seed N            the seed of the problems (9)
//!     --forms             compares two forms of the fit from the same random starts, in place of the searches
//! ```
//!
//! Problem i has 6, 8, 12 or 30 poses on one branch, with noise of 0, 0.5 or 2 % of the target's size and as many
//! hundredths of a radian. A random start takes two pins of the body at random within 2.5 sizes, each with its best circle,
//! and is fitted as every start of a search is, driven from either side. The search has one thread; the starts take all.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

#[path = "motion/gauss_helmert.rs"]
mod gauss_helmert;
#[path = "../tests/common/poses.rs"]
mod poses;
#[path = "../tests/common/random.rs"]
mod random;

use linkwright::internals::app::job::run::{Context as RunContext, Job, run};
use linkwright::internals::files::problem_file::parse;
use linkwright::internals::mechanism::{AssemblyMode, Complex, CouplerSide, Dyad, Pose};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::synthesis::dyads::{circle_fit, pair};
use linkwright::internals::synthesis::multistart::{LONG_FIT, judged, polish};
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::forms::start::{AS_WRITTEN, Start};
use linkwright::internals::task::{Problem, Setting};
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The time of a search, in milliseconds, beyond which it is listed.
const SLOW_MS: f64 = 200.0;

/// Returns the value of an option of the command line.
fn option(name: &str, default: u64) -> u64 {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.nth(1).map_or(default, |value| value.parse().unwrap_or_else(|_| panic!("{name}: {value}")))
}

/// Two pins of the body at random, each with its best circle.
fn drawn(poses: &[Pose], reach: f64, seed: u64, index: u64) -> Option<[Dyad; 2]> {
    let draws = &mut stream(seed, index);
    let mut dyad = || -> Option<Dyad> {
        let pin = Complex::new(uniform(draws, -reach, reach), uniform(draws, -reach, reach));
        Some(circle_fit(poses, pin, None)?.dyad(pin))
    };
    Some([dyad()?, dyad()?])
}

/// The start of a search's fit from two dyads.
fn start(problem: &Problem, crank: &Dyad, follower: &Dyad, poses: &[Pose]) -> Option<Start> {
    let pair = pair(crank, follower)?;
    let positions = pair.positions(poses)?;
    let side = CouplerSide::of(pair.shape.offset.im);
    let setting = Setting { aim: None, assembly: AssemblyMode::Plus, direction: 1.0, side };
    let design = problem.space(side).design(&pair.shape, pair.frame_angle);
    Some(Start { design, setting, positions, scales: AS_WRITTEN })
}

fn accepted(problem: &Problem, end: &Start) -> Option<f64> {
    let candidate = judged(problem, end).filter(|candidate| candidate.accepted)?;
    Some(candidate.error.objective)
}

fn poses_of(poses: &[(Complex, f64)]) -> Vec<Pose> {
    poses.iter().map(|(place, angle)| Pose::new(*place, *angle)).collect()
}

/// Returns the least objective of the accepted ends of so many random starts.
fn of_random_starts(problem: &Problem, poses: &[(Complex, f64)], starts: u64, seed: u64) -> f64 {
    let cancel = AtomicBool::new(false);
    let budget = Budget::new(&cancel, None);
    let context = Context::new(problem, &budget);
    let poses = poses_of(poses);
    let reach = 2.5 * problem.task().size();
    let end = |index: u64| {
        let [one, other] = drawn(&poses, reach, seed, index)?;
        let of = |crank: &Dyad, follower: &Dyad| {
            let start = start(problem, crank, follower, &poses)?;
            accepted(problem, &polish(context, start, LONG_FIT, 5000).end?)
        };
        let both = [of(&one, &other), of(&other, &one)];
        both.into_iter().flatten().min_by(f64::total_cmp)
    };
    (0..starts / 2).into_par_iter().filter_map(end).min_by(f64::total_cmp).unwrap_or(f64::INFINITY)
}

/// The fits of one form: how many ended at the best known value, and how long all took.
#[derive(Default)]
struct Form {
    hits: u64,
    seconds: f64,
}

/// Compares the fit of the searches with Gauss-Helmert fits, from the same starts, on one thread.
fn forms(problems: u64, starts: u64, seed: u64) {
    let (mut fits, mut torus, mut gauss_helmert) = (0, Form::default(), Form::default());
    for index in 0..problems {
        let (taken, text, n, noise) = drawn_problem(seed, index);
        let spec = parse("motion.toml", &text, None, &[]).unwrap_or_else(|why| panic!("{why}")).spec;
        let problem = Problem::new(spec).expect("a problem");
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let context = Context::new(&problem, &budget);
        let (poses, size) = (poses_of(&taken.poses), problem.task().size());
        let exact = (1e-10 * size).powi(2);
        let mut ends: [Vec<f64>; 2] = Default::default();
        let mut times = [0.0, 0.0];
        for number in 0..starts {
            let Some([crank, follower]) = drawn(&poses, 2.5 * size, 1000 + index, number) else { continue };
            let Some(begin) = start(&problem, &crank, &follower, &poses) else { continue };
            fits += 1;
            let begun = Instant::now();
            let one = polish(context, begin, LONG_FIT, 5000);
            times[0] += begun.elapsed().as_secs_f64();
            let begun = Instant::now();
            let other = gauss_helmert::fit([&crank, &follower], &poses, size, exact);
            times[1] += begun.elapsed().as_secs_f64();
            ends[0].extend(one.end.and_then(|end| accepted(&problem, &end)));
            // The same judge, at the same places. Gauss-Helmert fits know no bounds: an end beyond them is brought within,
            // and is another linkage then.
            let end = other.and_then(|end| {
                let [crank, follower] = &end.dyads;
                let objective = accepted(&problem, &start(&problem, crank, follower, &end.poses)?)?;
                ((objective - end.cost).abs() <= 1e-6 * end.cost + exact).then_some(objective)
            });
            ends[1].extend(end);
        }
        let best = ends.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let enough = (best * (1.0 + 1e-6)).max((1e-8 * size).powi(2));
        let hits = ends.map(|ends| ends.iter().filter(|end| **end <= enough).count() as u64);
        println!(
            "problem {index}: {n} poses, noise {noise}: best {best:.6e}; torus {} hits in {:.0} ms, Gauss-Helmert {} in {:.0} ms",
            hits[0],
            1e3 * times[0],
            hits[1],
            1e3 * times[1]
        );
        for (form, (hits, seconds)) in
            [&mut torus, &mut gauss_helmert].into_iter().zip(hits.into_iter().zip(times))
        {
            form.hits += hits;
            form.seconds += seconds;
        }
    }
    for (name, form) in [("torus", &torus), ("Gauss-Helmert", &gauss_helmert)] {
        println!(
            "{name}: {} of {fits} fits end at the best known value, {:.3} ms a fit, {:.2} ms a hit",
            form.hits,
            1e3 * form.seconds / f64::from(fits),
            1e3 * form.seconds / form.hits as f64
        );
    }
}

/// Problem `index`: its truth, its text, its number of poses and its noise.
fn drawn_problem(seed: u64, index: u64) -> (poses::Taken, String, usize, f64) {
    let draws = &mut stream(seed, index);
    let n = [6, 8, 12, 30][index as usize % 4];
    let noise = [0.0, 0.005, 0.02][index as usize % 3];
    let taken = poses::taken(draws, n, noise);
    let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
    let lines = poses::wide(taken.poses[0].0, far)
        + "[require]\nlink_ratio_max = 200\n[solve]\ncandidates = 1\nadvice = false\n";
    let text = poses::text(&taken.poses, &lines);
    (taken, text, n, noise)
}

fn main() {
    let (problems, starts) = (option("--problems", 400), option("--starts", 3000));
    let seed = option("--seed", 9);
    if std::env::args().any(|argument| argument == "--forms") {
        return forms(problems, starts, seed);
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let (mut times, mut reached, mut nothing) = (Vec::new(), 0, 0);
    for index in 0..problems {
        let (taken, text, n, noise) = drawn_problem(seed, index);
        let spec = parse("motion.toml", &text, None, &[]).unwrap_or_else(|why| panic!("{why}")).spec;
        let problem = Problem::new(spec.clone()).expect("a problem");
        let job = Job::new("motion", spec);
        let context = RunContext { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let begun = Instant::now();
        let record = one.install(|| run(&job, &context)).expect("a run").record;
        let took = begun.elapsed().as_secs_f64() * 1e3;
        times.push(took);
        if took > SLOW_MS {
            println!(
                "problem {index}: {n} poses, noise {noise}: {took:.0} ms, {:?} after {} evaluations, {:?}",
                record.termination.reason, record.evaluations.objective, record.repeats
            );
        }
        let best = record.candidates.iter().find(|candidate| candidate.accepted);
        nothing += u64::from(best.is_none());
        let own = best.map_or(f64::INFINITY, |best| best.error.objective);
        let other = of_random_starts(&problem, &taken.poses, starts, 1000 + index);
        let exact = (1e-9 * problem.task().size()).powi(2);
        if own <= (other * (1.0 + 1e-6)).max(exact) {
            reached += 1;
        } else {
            println!(
                "problem {index}: {n} poses, noise {noise}, {}: {own:.6e}, of random starts {other:.6e} ({:.3})",
                taken.linkage.linkage_type().map_or("none", |kind| kind.name()),
                own / other
            );
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize];
    println!(
        "{reached} of {problems} reach the best of {starts} random starts ({:.1} %); {nothing} without an answer; \
         {:.1} ms median, {:.1} ms in nine of ten, {:.1} ms at most",
        100.0 * reached as f64 / problems as f64,
        at(0.5),
        at(0.9),
        at(1.0)
    );
    assert!(reached * 100 >= problems * 98, "98 % reach the best of the random starts");
}
