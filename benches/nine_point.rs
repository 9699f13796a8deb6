//! Exact synthesis: how long nine points take, or poses and points, and how often everything is found.
//!
//! ```text
//! cargo bench --bench nine_point                     all parts
//! cargo bench --bench nine_point -- full             a full solve of problem 3 of 1992, on 1 and 2 threads,
//!                                                 without and with certificates
//! cargo bench --bench nine_point -- move             one point moved by 2 % of the size, a frame after the other, 1 thread
//! cargo bench --bench nine_point -- targets 100      100 targets each: coupler curves, normal points, noisy ellipses
//! cargo bench --bench nine_point -- poses 100        positions of 100 random linkages each: 5 poses, 4, 3, 2 and 2, 4, 6 points
//! cargo bench --bench nine_point -- pivots 100       points of 100 random linkages each, with both fixed pivots given and with one
//! cargo bench --bench nine_point -- sliders 100      eight points of 100 random slider-cranks, and of as many inverted ones
//! cargo bench --bench nine_point -- dyads 1000       all real dyads of five poses of 1000 random linkages
//! ```
//!
//! Every part asserts its answer before it prints a time. Times are medians of [`RUNS`] runs.

#![expect(clippy::print_stdout, reason = "the tables are what this program is for")]

#[path = "../tests/common/poses.rs"]
mod poses;
#[path = "../tests/common/random.rs"]
mod random;

use linkwright::internals::mechanism::{
    AssemblyMode, Complex, Dyad, FourBar, InvertedSliderCrank, Pose, SliderCrank, SliderLinkage,
};
use linkwright::internals::numbers::arithmetic::streams::{Stream, normal, stream, uniform};
use linkwright::internals::numbers::nine_point::target::{Closure, Kind};
use linkwright::internals::numbers::nine_point::{
    Certificate, Class, Completeness, Options, Reality, Solution, Solved, Target, certify_all,
    not_proved_distinct, resolve_from, solve,
};
use linkwright::internals::synthesis::dyads::through_five;
use random::{TYPES, linkage, one_of, trace};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const RUNS: usize = 15;
const CLASSES: usize = 1442;
/// Noise of the ellipses' points, in half axes.
const NOISE: f64 = 0.01;
/// Nine frames: each point moves once.
const FRAMES: usize = 9;
/// A generating linkage is found when pivots and pins are met within this part of its size.
const FOUND: f64 = 1e-5;

/// Wampler, Morgan & Sommese 1992, problem 3.
fn wms3() -> [Complex; 9] {
    [
        (0.25, 0.0),
        (0.52, 0.1),
        (0.8, 0.7),
        (1.2, 1.0),
        (1.4, 1.3),
        (1.1, 1.48),
        (0.7, 1.4),
        (0.2, 1.0),
        (0.02, 0.4),
    ]
    .map(|(x, y)| Complex::new(x, y))
}

fn solved(points: [Complex; 9]) -> Solved {
    let target = Target::new(points).expect("nine different points");
    solve(&target, &Options::default(), &|_, _| {}, &AtomicBool::new(false))
}

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

/// The certificates of all classes; every one is there and no two are of one class.
fn proved(answer: &Solved) -> Vec<Certificate> {
    let solutions: Vec<Solution> = answer.classes.iter().map(|class| class.solution).collect();
    let proofs: Vec<Certificate> = certify_all(&answer.target, &solutions).into_iter().flatten().collect();
    assert_eq!(proofs.len(), CLASSES);
    assert!(not_proved_distinct(&proofs).is_empty());
    proofs
}

fn full() {
    let reference = solved(wms3());
    assert_eq!(reference.completeness(), Completeness::Complete);
    assert_eq!((reference.census.distinct, reference.census.real), (CLASSES, 64));
    let certificates = proved(&reference);
    for threads in [1, 2] {
        let pool = pool(threads);
        let times = (0..RUNS).map(|_| {
            let clock = Instant::now();
            let answer = pool.install(|| solved(wms3()));
            let found = clock.elapsed().as_secs_f64();
            let proofs = pool.install(|| proved(&answer));
            let all = clock.elapsed().as_secs_f64();
            assert_eq!((&answer, &proofs), (&reference, &certificates), "threads change no digit");
            (found, all)
        });
        let (found, all): (Vec<f64>, Vec<f64>) = times.unzip();
        println!(
            "full solve, {threads} thread(s): {:.3} s; with all certificates {:.3} s",
            median(found),
            median(all)
        );
    }
}

fn moved() {
    let mut points = wms3();
    let size = 2.0;
    let mut before = solved(points);
    let (mut times, mut kept) = (Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        points[frame] += Complex::from_polar(0.02 * size, frame as f64);
        let target = Target::new(points).expect("nine different points");
        let clock = Instant::now();
        let moved =
            pool(1).install(|| resolve_from(&before, &target, &Options::default(), &AtomicBool::new(false)));
        times.push(clock.elapsed().as_secs_f64());
        let whole = solved(points);
        assert_eq!(moved.solved.census.real, whole.census.real, "frame {frame}");
        assert_eq!(moved.solved.census.distinct, whole.census.distinct, "frame {frame}");
        assert!(!moved.fell_back, "frame {frame}");
        let real = |of: &Solved| of.classes[..of.census.real].to_vec();
        for class in real(&whole) {
            let same = |other: &Class| other.solution.is_in_class_of(&class.solution, Closure::FourBar, 1e-7);
            assert!(real(&moved.solved).iter().any(same), "frame {frame}");
        }
        kept.push(moved.kept);
        before = moved.solved;
    }
    println!("one point moved, 1 thread: {:.3} s a frame; kept {kept:?}", median(times));
}

/// The fixed pivots and pins of a four-bar at the first point.
fn marks(linkage: &FourBar, [c, d]: [Complex; 2]) -> [Complex; 4] {
    [linkage.crank_pivot(), c, linkage.follower_pivot(), d]
}

/// Whether a linkage is among the real classes: its fixed pivot and its pin, of one link or of both, at the first point.
fn holds(answer: &Solved, wanted: &[Complex]) -> bool {
    let target = &answer.target;
    let size = wanted.iter().map(|z| (z - target.points[0]).norm()).fold(0.0, f64::max);
    answer.classes.iter().filter(|class| class.reality == Reality::Real).any(|class| {
        class.solution.images(&target.displacements).iter().any(|image| {
            let places = [image.grounds[0], image.pins[0], image.grounds[1], image.pins[1]];
            places
                .iter()
                .zip(wanted)
                .all(|(z, w)| (target.points[0] + z * target.scale - *w).norm() < FOUND * size)
        })
    })
}

fn on_a_curve(numbers: &mut Stream) -> ([Complex; 9], FourBar, [Complex; 2]) {
    loop {
        let of = one_of(numbers, &TYPES);
        let linkage = linkage(numbers, of);
        let Some(traced) = trace(numbers, &linkage, 9, None) else { continue };
        let (crank_angle, assembly) = traced.positions[0];
        let Some(joints) = linkage.position_with(crank_angle, assembly).joints() else { continue };
        if let Ok(points) = traced.points.try_into() {
            return (points, linkage, [joints.crank_pin, joints.follower_pin]);
        }
    }
}

fn targets(count: u64) {
    let (mut complete, mut found) = ([0; 3], 0);
    let mut times = Vec::new();
    for index in 0..count {
        let mut numbers = stream(9, index);
        let (curve, linkage, pins) = on_a_curve(&mut numbers);
        let gaussian = std::array::from_fn(|_| {
            Complex::new(normal(&mut numbers, 0.0, 1.0), normal(&mut numbers, 0.0, 1.0))
        });
        let minor = uniform(&mut numbers, 0.2, 1.0);
        let ellipse = std::array::from_fn(|j| {
            let angle = TAU * j as f64 / 9.0;
            Complex::new(
                normal(&mut numbers, angle.cos(), NOISE),
                normal(&mut numbers, minor * angle.sin(), NOISE),
            )
        });
        for (kind, points) in [curve, gaussian, ellipse].into_iter().enumerate() {
            let clock = Instant::now();
            let answer = solved(points);
            times.push(clock.elapsed().as_secs_f64());
            complete[kind] += u64::from(answer.census.distinct == CLASSES);
            if answer.census.distinct != CLASSES {
                println!("  {} {index}: {:?}", ["curve", "normal", "ellipse"][kind], answer.census);
            }
            if kind == 0 {
                let there = holds(&answer, &marks(&linkage, pins));
                found += u64::from(there);
                if !there {
                    println!("  curve {index}: its linkage was not found");
                }
            }
        }
    }
    println!(
        "all {CLASSES} classes: {} coupler curves, {} normal, {} ellipses of {count} each",
        complete[0], complete[1], complete[2]
    );
    println!("the generating linkage: {found} of {count}; median {:.3} s", median(times));
    assert_eq!(found, count);
    assert!(
        complete[0] * 100 >= 98 * count && complete[1] * 100 >= 99 * count && complete[2] * 100 >= 99 * count
    );
}

/// Returns the pivots and pins of a linkage at the first of the positions taken from it.
fn at_first(made: &poses::Taken) -> Vec<Complex> {
    let (crank_angle, assembly) = made.positions[0];
    let joints = made.linkage.position_with(crank_angle, assembly).joints().expect("closed");
    marks(&made.linkage, [joints.crank_pin, joints.follower_pin]).to_vec()
}

/// Solves a target made of positions of each of so many random linkages on one branch, without noise; at least `least` of them whole.
/// `draw` gives a target with the pivots and pins of the linkage that made it ([`holds`]).
fn survey(
    name: &str,
    classes: usize,
    (count, least): (u64, u64),
    draw: impl Fn(u64) -> (Target, Vec<Complex>),
) {
    let (mut complete, mut found, mut real, mut unproved) = (0, 0, 0, 0);
    let (mut times, mut proofs) = (Vec::new(), Vec::new());
    for index in 0..count {
        let (target, wanted) = draw(index);
        let clock = Instant::now();
        let answer = solve(&target, &Options::default(), &|_, _| {}, &AtomicBool::new(false));
        times.push(clock.elapsed().as_secs_f64());
        let solutions: Vec<Solution> = answer.classes.iter().map(|class| class.solution).collect();
        let clock = Instant::now();
        let proved = certify_all(&target, &solutions).iter().filter(|proof| proof.is_ok()).count();
        proofs.push(clock.elapsed().as_secs_f64());
        let whole = answer.census.distinct == classes;
        unproved += answer.census.distinct - proved;
        if !whole {
            println!("  {name} {index}: {:?}, {:?}", answer.census, answer.completeness());
        }
        complete += u64::from(whole);
        real += answer.census.real;
        let there = holds(&answer, &wanted);
        if !there {
            println!("  {name} {index}: its linkage was not found");
        }
        found += u64::from(there);
    }
    println!(
        "{name}: all {classes} classes {complete} of {count}, the generating linkage {found}; {:.1} real ones; {unproved} without a \
         certificate; median {:.2} ms, and {:.2} ms for certificates",
        real as f64 / count as f64,
        1e3 * median(times),
        1e3 * median(proofs)
    );
    assert_eq!(found, count);
    assert!(unproved as u64 * 1000 <= classes as u64 * count);
    assert!(complete >= least);
}

/// Solves positions of random linkages, some of them with the coupler's angle.
fn with_poses(count: u64) {
    for others in (1..=4).rev() {
        let n = 9 - others;
        let draw = |index: u64| {
            let made = poses::taken(&mut stream(70 + others as u64, index), n, 0.0);
            let (first, angle) = made.poses[0];
            let points: Vec<Complex> = made.poses[1..n - others].iter().map(|pose| pose.0).collect();
            let turned: Vec<(Complex, f64)> =
                made.poses[n - others..].iter().map(|(place, own)| (*place, own - angle)).collect();
            (Target::mixed(first, &points, &turned, &[]).expect("different places"), at_first(&made))
        };
        let least = if others == 1 { (97 * count).div_ceil(100) } else { count };
        let name = format!("{} poses, {} points", others + 1, 8 - 2 * others);
        survey(&name, Kind::new(others, 0).classes(), (count, least), draw);
    }
}

/// Solves points of random linkages with fixed pivots given.
fn with_pivots(count: u64) {
    for given in [2, 1] {
        let n = 9 - 2 * given;
        let draw = |index: u64| {
            let made = poses::taken(&mut stream(80 + given as u64, index), n, 0.0);
            let places: Vec<Complex> = made.poses.iter().map(|pose| pose.0).collect();
            let pivots = [made.linkage.crank_pivot(), made.linkage.follower_pivot()];
            let target = Target::mixed(places[0], &places[1..], &[], &pivots[..given]);
            (target.expect("different places"), at_first(&made))
        };
        let name = format!("{n} points, {given} given pivots");
        survey(&name, Kind::new(0, given).classes(), (count, count), draw);
    }
}

/// Returns eight points of a linkage with a slider on one assembly, at crank angles apart from each other where its transmission angle
/// is above 6 degrees, with A and, at the first point, C; `None` if it has not so many.
fn eight_points<L: SliderLinkage>(linkage: &L, draws: &mut Stream) -> Option<([Complex; 8], Vec<Complex>)> {
    let mut angles: Vec<f64> = Vec::new();
    for _ in 0..200 {
        let angle = uniform(draws, 0.0, TAU);
        let clear = linkage.transmission_angle(angle).is_some_and(|mu| mu > 0.1);
        if clear && angles.iter().all(|other| (other - angle).abs() > 0.05) {
            angles.push(angle);
        }
    }
    let at = |angle: &f64| linkage.position(*angle).joints();
    let points: Vec<Complex> = angles.iter().filter_map(|a| Some(at(a)?.coupler_point)).take(8).collect();
    let marks = vec![linkage.crank_pivot(), at(angles.first()?)?.crank_pin];
    Some((points.try_into().ok()?, marks))
}

/// Solves eight points of random linkages with a slider.
fn with_sliders(count: u64) {
    for closure in [Closure::SliderCrank, Closure::InvertedSliderCrank] {
        let name = format!("8 points, {closure:?}");
        let kind = Kind::of_points(closure);
        let draw = |index: u64| {
            let draws = &mut stream(100 + u64::from(closure == Closure::SliderCrank), index);
            loop {
                let mut place = || Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0));
                let (a, z, at) = (place(), place() * 2.0, place() * 2.0);
                let (crank, turn) = (uniform(draws, 0.4, 1.2), uniform(draws, 0.0, TAU));
                let (coupler, offset) = (uniform(draws, 0.6, 3.0), uniform(draws, -0.6, 0.6));
                let taken = if closure == Closure::SliderCrank {
                    let made =
                        SliderCrank::from_parts(a, [crank, coupler], (at, turn), z, AssemblyMode::Plus);
                    made.ok().and_then(|made| eight_points(&made, draws))
                } else {
                    let made = InvertedSliderCrank::from_parts([a, at], crank, offset, z, AssemblyMode::Plus);
                    made.ok().and_then(|made| eight_points(&made, draws))
                };
                if let Some((points, marks)) = taken {
                    return (Target::with_slider(points, closure).expect("different places"), marks);
                }
            }
        };
        survey(&name, kind.classes(), (count, (97 * count).div_ceil(100)), draw);
    }
}

/// Finds all real dyads of five poses of random linkages.
fn dyads(count: u64) {
    let draw = |index: u64| poses::taken(&mut stream(90, index), 5, 0.0);
    let all: Vec<poses::Taken> = (0..count).map(draw).collect();
    let sets: Vec<[Pose; 5]> =
        all.iter().map(|made| std::array::from_fn(|j| Pose::new(made.poses[j].0, made.poses[j].1))).collect();
    let clock = Instant::now();
    let found: Vec<Vec<Dyad>> = sets.iter().map(through_five).collect();
    let time = clock.elapsed().as_secs_f64();
    let mut generating = 0;
    let mut counts = [0; 5];
    for ((made, poses), found) in all.iter().zip(&sets).zip(&found) {
        counts[found.len()] += 1;
        let (angle, assembly) = made.positions[0];
        let joints = made.linkage.position_with(angle, assembly).joints().expect("closed");
        let both = [
            (made.linkage.crank_pivot(), joints.crank_pin),
            (made.linkage.follower_pivot(), joints.follower_pin),
        ];
        let span = made.linkage.longest_link().max(made.linkage.crank_side());
        let has = |(pivot, pin): &(Complex, Complex)| {
            found.iter().any(|dyad| match dyad {
                Dyad::RR { pin: m, pivot: g, .. } => {
                    (g - pivot).norm() < FOUND * span && (poses[0].at(*m) - pin).norm() < FOUND * span
                }
                _ => false,
            })
        };
        generating += u64::from(both.iter().all(has));
    }
    println!(
        "five poses: both generating dyads {generating} of {count}; 0 to 4 real dyads {counts:?}; {:.1} ms in all",
        1e3 * time
    );
    assert_eq!(generating, count);
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let part = words.first().map_or("", String::as_str);
    if part.is_empty() || part == "full" {
        full();
    }
    if part.is_empty() || part == "move" {
        moved();
    }
    if part.is_empty() || part == "targets" {
        targets(words.get(1).map_or(100, |word| word.parse().expect("a number of targets")));
    }
    if part.is_empty() || part == "poses" {
        with_poses(words.get(1).map_or(100, |word| word.parse().expect("a number of targets")));
    }
    if part.is_empty() || part == "pivots" {
        with_pivots(words.get(1).map_or(100, |word| word.parse().expect("a number of targets")));
    }
    if part.is_empty() || part == "sliders" {
        with_sliders(words.get(1).map_or(100, |word| word.parse().expect("a number of targets")));
    }
    if part.is_empty() || part == "dyads" {
        dyads(words.get(1).map_or(1000, |word| word.parse().expect("a number of targets")));
    }
}
