//! Are the linkages behind real coupler curves found again? Random linkages of every type, points of their
//! curves with and without noise, and what a search makes of them.
//!
//! ```text
//! cargo bench --bench recovery                             every class, 40 curves each (240 in all)
//! cargo bench --bench recovery -- closed-60 10             classes whose name contains the word, 10 curves
//! cargo bench --bench recovery -- rocking 10 --noisy       --clean or --noisy: one of the two alone
//!     --seed N            of the curves (1); curve i of a class is the same whatever the other arguments
//!     --evaluations N     budget of a search (200000)
//!     --time-limit S      seconds of a search at most (none)
//!     --order any         the points in any order (required)
//!     --curve I           curve I of each class alone
//!     --search-alone      no advice: the evaluations are those of the search, as the times are always
//!     --show              every curve on its own line, with what went wrong
//! ```
//!
//! | class | targets |
//! |---|---|
//! | closed-60, closed-360 | the whole curve of a crank-rocker or double-crank |
//! | open | 60 points over 120 to 300 degrees of such a crank |
//! | small-crank | 60 points of the whole curve of a crank-rocker, all other links 10 to 50 cranks long |
//! | rocking-closed | 60 points of a whole circuit of a rocker-crank, double-rocker or triple-rocker |
//! | rocking-open | 60 points over 120 to 300 degrees of such a circuit's parameter |
//!
//! Points stand evenly in the parameter (crank angle; psi where the crank rocks). Rocking ones are asked for
//! with `branch = "any"`. Noise is normal, one hundredth of the clean curve's size in each coordinate. Except in small-crank
//! links differ by 10 times at most. The coupler point lies within 3 longest links of C, and the bounds hold the
//! generating linkage twice over. Types are not asked for; order and one circuit are.
//!
//! *Recovered* is, without noise, an accepted candidate with rms/size below 1e-9; with noise, an accepted
//! candidate whose objective is at most 1.01 of the yardstick: the fit that starts from the generating linkage
//! and its own positions, with the points kept in order, accepted by the same referee. Should that fit fail, the
//! generating linkage at its generating positions is the yardstick, which is weaker; `weak` counts those.
//! `/ yardstick` is the median of objective over yardstick of what was accepted.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

#[path = "../tests/common/random.rs"]
mod random;
#[path = "recovery/yardstick.rs"]
mod yardstick;

use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::mechanism::Complex;
use linkwright::internals::mechanism::LinkageType;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::task::Problem;
use linkwright::internals::task::spec::{
    DesignSpec, Limits, OnePolicy, OrderPolicy, ProblemSpec, RequireSpec, SolveSpec, TaskSpec,
};
use random::{ROCKING, TURNING, Traced, bounding_box, noisy, one_of, trace};
use std::sync::atomic::AtomicBool;
use yardstick::from_the_truth;

/// rms over size below which a clean curve counts as recovered.
const CLEAN: f64 = 1e-9;
/// An objective within this factor of the yardstick counts as recovered.
const WITHIN: f64 = 1.01;
/// Standard deviation of the noise in each coordinate, in sizes.
const NOISE: f64 = 0.01;
/// The box around a target holds the generating linkage this many times over.
const ROOM: f64 = 2.0;

/// Curves of a kind.
struct Class {
    name: &'static str,
    types: &'static [LinkageType],
    points: usize,
    closed: bool,
    branch_any: bool,
    /// Whether the crank is the only short link.
    small_crank: bool,
}

const CLASSES: [Class; 6] = [
    Class {
        name: "closed-60",
        types: &TURNING,
        points: 60,
        closed: true,
        branch_any: false,
        small_crank: false,
    },
    Class {
        name: "closed-360",
        types: &TURNING,
        points: 360,
        closed: true,
        branch_any: false,
        small_crank: false,
    },
    Class { name: "open", types: &TURNING, points: 60, closed: false, branch_any: false, small_crank: false },
    Class {
        name: "rocking-closed",
        types: &ROCKING,
        points: 60,
        closed: true,
        branch_any: true,
        small_crank: false,
    },
    Class {
        name: "rocking-open",
        types: &ROCKING,
        points: 60,
        closed: false,
        branch_any: true,
        small_crank: false,
    },
    Class {
        name: "small-crank",
        types: &[LinkageType::CrankRocker],
        points: 60,
        closed: true,
        branch_any: false,
        small_crank: true,
    },
];

struct Arguments {
    class: String,
    count: u64,
    seed: u64,
    evaluations: u64,
    time_limit_s: Option<f64>,
    order: OrderPolicy,
    noises: Vec<f64>,
    advice: bool,
    only: Option<u64>,
    show: bool,
}

impl Arguments {
    fn read() -> Arguments {
        let mut arguments = Arguments {
            class: String::new(),
            count: 40,
            seed: 1,
            evaluations: 200_000,
            time_limit_s: None,
            order: OrderPolicy::Required,
            noises: vec![0.0, NOISE],
            advice: true,
            only: None,
            show: false,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
            match word.as_str() {
                "--bench" => {}
                "--seed" => arguments.seed = value().parse().expect("a whole number"),
                "--evaluations" => arguments.evaluations = value().parse().expect("a whole number"),
                "--time-limit" => arguments.time_limit_s = Some(value().parse().expect("seconds")),
                "--order" => {
                    arguments.order = match value().as_str() {
                        "any" => OrderPolicy::Any,
                        "required" => OrderPolicy::Required,
                        other => panic!("--order any or required, not {other}"),
                    }
                }
                "--clean" => arguments.noises = vec![0.0],
                "--noisy" => arguments.noises = vec![NOISE],
                "--search-alone" => arguments.advice = false,
                "--curve" => arguments.only = Some(value().parse().expect("a whole number")),
                "--show" => arguments.show = true,
                other if other.starts_with('-') => panic!("{other} is no argument of this bench"),
                other => match other.parse() {
                    Ok(count) => arguments.count = count,
                    Err(_) => arguments.class = other.into(),
                },
            }
        }
        arguments
    }
}

/// Every curve has a random stream of its own: this many are kept for each index.
const STREAMS: u64 = 5;

/// Curve `index` of a class.
fn curve(class: &Class, seed: u64, index: u64) -> Traced {
    let which = CLASSES.iter().position(|c| c.name == class.name).expect("it is one of them") as u64;
    let draws = &mut stream(seed + which / STREAMS, index * STREAMS + which % STREAMS);
    loop {
        let of = one_of(draws, class.types);
        let linkage =
            if class.small_crank { random::with_small_crank(draws) } else { random::linkage(draws, of) };
        let span = uniform(draws, 120.0, 300.0).to_radians();
        if let Some(traced) = trace(draws, &linkage, class.points, (!class.closed).then_some(span)) {
            return traced;
        }
    }
}

fn problem(class: &Class, traced: &Traced, points: &[Complex], seed: u64, with: &Arguments) -> ProblemSpec {
    let [x0, y0, x1, y1] = bounding_box(points);
    let (centre, size) = (Complex::new(0.5 * (x0 + x1), 0.5 * (y0 + y1)), (x1 - x0).hypot(y1 - y0));
    let linkage = &traced.linkage;
    let far = |z: Complex| z.re.abs().max(z.im.abs());
    let pivots = far(linkage.crank_pivot() - centre).max(far(linkage.follower_pivot() - centre));
    let reach = (ROOM * pivots).max(5.0 * size);
    let longest = (ROOM * linkage.longest_link()).max(5.0 * size);
    let coupler = (ROOM * far(linkage.coupler_offset())).max(5.0 * size);
    let pivot =
        Some([Limits(centre.re - reach, centre.re + reach), Limits(centre.im - reach, centre.im + reach)]);
    let length = Some(Limits(0.0, longest));
    let offset = Some(Limits(-coupler, coupler));
    ProblemSpec {
        loads: None,
        task: TaskSpec::path(points.iter().map(|p| [p.re, p.im]).collect(), class.closed),
        design: DesignSpec {
            crank_pivot: pivot,
            follower_pivot: pivot,
            a: length,
            b: length,
            c: length,
            ground: length,
            coupler_x: offset,
            coupler_y: offset,
            ..DesignSpec::default()
        },
        require: RequireSpec {
            link_ratio_max: 100.0,
            order: with.order,
            branch: if class.branch_any { OnePolicy::Any } else { OnePolicy::One },
            ..RequireSpec::default()
        },
        solve: SolveSpec {
            seed,
            candidates: 1,
            evaluations: with.evaluations,
            time_limit_s: with.time_limit_s,
            advice: with.advice,
            ..SolveSpec::default()
        },
    }
}

/// What a noisy target is measured by: the objective and whether it is the weak one.
fn yardstick(problem: &Problem, traced: &Traced) -> (f64, bool) {
    let fitted = from_the_truth(problem, traced).map(|c| c.error.objective);
    let angles: Vec<f64> = traced.positions.iter().map(|(angle, _)| angle.to_degrees()).collect();
    let assemblies: Vec<_> = traced.positions.iter().map(|(_, t1)| *t1).collect();
    let generating = assess(problem, traced.linkage, &angles, &assemblies).expect("it closes there");
    assert!(generating.accepted, "the generating linkage meets what is asked: {generating:?}");
    (fitted.unwrap_or(f64::INFINITY).min(generating.error.objective), fitted.is_none())
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2])
}

fn row(class: &Class, noise: f64, with: &Arguments) {
    let (mut recovered, mut accepted, mut weak) = (0_u64, 0_u64, 0_u64);
    let (mut times, mut evaluations, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let curves = with.only.map_or(0..with.count, |only| only..only + 1);
    for index in curves.clone() {
        let traced = curve(class, with.seed, index);
        let points = if noise > 0.0 {
            // Its own stream: the clean curve is the same with and without.
            let draws = &mut stream(with.seed ^ u64::MAX, index);
            noisy(draws, &traced.points, noise * traced.size())
        } else {
            traced.points.clone()
        };
        let spec = problem(class, &traced, &points, index, with);
        let yard = (noise > 0.0)
            .then(|| yardstick(&Problem::new(spec.clone()).expect("the targets are paths"), &traced));
        weak += u64::from(yard.is_some_and(|(_, weak)| weak));
        let job = Job { name: class.name.into(), source: None, unit: None, spec, front: None };
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let finished = run(&job, &context).expect("it runs");
        times.push(finished.search_s * 1e3);
        evaluations.push(finished.record.evaluations.objective as f64);
        let best = finished.record.candidates.first().filter(|c| c.accepted);
        let hit = best.is_some_and(|c| match yard {
            None => c.error.rms_over_size < CLEAN,
            Some((yard, _)) => c.error.objective <= WITHIN * yard,
        });
        ratios.extend(best.zip(yard).map(|(c, (yard, _))| c.error.objective / yard));
        accepted += u64::from(best.is_some());
        recovered += u64::from(hit);
        if with.show {
            let kind = traced.linkage.mobility().linkage_type.map_or("none", LinkageType::name);
            let found = best.map_or("nothing accepted".into(), |c| {
                let beside = yard.map_or(String::new(), |(y, _)| {
                    format!(", {:.4} of the yardstick", c.error.objective / y)
                });
                format!(
                    "{} at rms/size {:.2e}{beside}",
                    c.linkage_type.expect("a type"),
                    c.error.rms_over_size
                )
            });
            let word = if hit { "hit " } else { "MISS" };
            println!("  {word} {} {index} ({kind}): {found}; {:.1} ms", class.name, finished.search_s * 1e3);
        }
    }
    let share = |count: u64| 100.0 * count as f64 / curves.clone().count() as f64;
    let worst = times.iter().copied().fold(0.0, f64::max);
    let kind = if noise > 0.0 { "1 % noise" } else { "clean" };
    let ratio = if ratios.is_empty() { "-".into() } else { format!("{:.4}", median(&ratios)) };
    println!(
        "| {} | {kind} | {} | {:.1} % | {:.1} % | {ratio} | {weak} | {:.1} | {worst:.1} | {:.0} |",
        class.name,
        curves.clone().count(),
        share(recovered),
        share(accepted),
        median(&times),
        median(&evaluations)
    );
}

fn main() {
    let arguments = Arguments::read();
    let classes: Vec<_> = CLASSES.iter().filter(|c| c.name.contains(&arguments.class)).collect();
    assert!(!classes.is_empty(), "no class is called {}", arguments.class);
    assert!(arguments.count > 0, "no curve, no share");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    println!(
        "| class | target | curves | recovered | accepted | / yardstick | weak | median ms | worst ms | median evaluations |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    pool.install(|| {
        for class in classes {
            for &noise in &arguments.noises {
                row(class, noise, &arguments);
            }
        }
    });
}
