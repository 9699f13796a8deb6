//! Synthesizes linkages for the poses of bodies on the couplers of random four-bars, and compares each answer with the best
//! of many random starts of the same fit.
//!
//! ```text
//! cargo bench --bench motion
//!     --problems N        problems, of random linkages of all types (400)
//!     --starts N          random starts of each (3000); 0: none
//!     --seed N            the seed of the problems (9)
//! ```
//!
//! Problem i has 6, 8, 12 or 30 poses on one branch, with noise of 0, 0.5 or 2 % of the target's size and as many
//! hundredths of a radian. A random start takes two pins of the body at random within 2.5 sizes, each with its best circle,
//! and is fitted as every start of a search is, driven from either side. The search has one thread; the starts take all.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

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

/// Returns the least objective of the accepted ends of so many random starts.
fn of_random_starts(problem: &Problem, poses: &[(Complex, f64)], starts: u64, seed: u64) -> f64 {
    let cancel = AtomicBool::new(false);
    let budget = Budget::new(&cancel, None);
    let context = Context::new(problem, &budget);
    let poses: Vec<Pose> = poses.iter().map(|(place, angle)| Pose::new(*place, *angle)).collect();
    let reach = 2.5 * problem.task().size();
    let end = |index: u64| {
        let draws = &mut stream(seed, index);
        let mut dyad = || -> Option<Dyad> {
            let pin = Complex::new(uniform(draws, -reach, reach), uniform(draws, -reach, reach));
            Some(circle_fit(&poses, pin, None)?.dyad(pin))
        };
        let (one, other) = (dyad()?, dyad()?);
        let of = |crank: &Dyad, follower: &Dyad| {
            let pair = pair(crank, follower)?;
            let positions = pair.positions(&poses)?;
            let side = CouplerSide::of(pair.shape.offset.im);
            let setting = Setting { aim: None, assembly: AssemblyMode::Plus, direction: 1.0, side };
            let design = problem.space(side).design(&pair.shape, pair.frame_angle);
            let fit =
                polish(context, Start { design, setting, positions, scales: AS_WRITTEN }, LONG_FIT, 5000);
            let candidate = judged(problem, &fit.end?).filter(|candidate| candidate.accepted)?;
            Some(candidate.error.objective)
        };
        let both = [of(&one, &other), of(&other, &one)];
        both.into_iter().flatten().min_by(f64::total_cmp)
    };
    (0..starts / 2).into_par_iter().filter_map(end).min_by(f64::total_cmp).unwrap_or(f64::INFINITY)
}

fn main() {
    let (problems, starts) = (option("--problems", 400), option("--starts", 3000));
    let seed = option("--seed", 9);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let (mut times, mut reached, mut nothing) = (Vec::new(), 0, 0);
    for index in 0..problems {
        let draws = &mut stream(seed, index);
        let n = [6, 8, 12, 30][index as usize % 4];
        let noise = [0.0, 0.005, 0.02][index as usize % 3];
        let taken = poses::taken(draws, n, noise);
        let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
        let lines = poses::wide(taken.poses[0].0, far)
            + "[require]\nlink_ratio_max = 200\n[solve]\ncandidates = 1\nadvice = false\n";
        let text = poses::text(&taken.poses, &lines);
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
