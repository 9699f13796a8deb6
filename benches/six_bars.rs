//! Six-bars that can be built for the six shapes that no four-bar draws, and random six-bars asked back from their curves.
//!
//! ```text
//! cargo bench --bench six_bars                    every shape, then random six-bars
//! cargo bench --bench six_bars -- heart           shapes whose name contains the word
//! cargo bench --bench six_bars -- random          random six-bars alone
//!     --seeds N           searches of each shape, of seeds 1 to N (10)
//!     --time-limit S      seconds of a search of a shape (10), on one thread
//!     --as-in-file        the points of a shape as its file has them, not evenly by arc length
//!     --dyads K           1: four-bars, 2: six-bars (2), 3: eight-bars
//!     --curves N          random six-bars (60)
//!     --recovery S        seconds of a search of each of them (5)
//!     --show              every search
//! ```
//!
//! *Shapes*: 120 points; the crank turns fully, all points are met in order, every transmission angle is at least 30 degrees
//! over the turn, no distance between two joints of a body exceeds three diagonals, two of them differ by 100 times at most.
//! Errors are the rms over the rms radius. *Random six-bars*: their joints lie evenly in a square at one position; those whose
//! crank turns fully with transmission angles of at least 10 degrees are kept, and 120 points evenly along their curve are
//! asked for, with that angle and at most twenty diagonals (or those of the drawn one) as limits. *Recovered* is an error
//! below 1e-4 of the rms radius; a search ends at a tenth of that.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use linkwright::internals::mechanism::dyad_chain::extremes::extremes;
use linkwright::internals::mechanism::dyad_chain::proportions::{first_parameter, length_parameters};
use linkwright::internals::mechanism::dyad_chain::{
    DyadChain, DyadChainKind, Frames, Grid, MAX_DYADS, MAX_PARAMETERS, Placement, Proportions, Shape,
};
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, bounding_box, centroid_and_radius, cross, point, xy,
};
use linkwright::internals::numbers::arithmetic::complex_lanes::ComplexLanes;
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::record::statistics::median;
use linkwright::internals::synthesis::dyad_chains::{
    DyadChainAnswer, DyadChainLimits, Request, Watch, search,
};
use linkwright::internals::task::resampling::resample;
use std::path::Path;
use std::time::Instant;

/// The shapes, whether they are closed, and the largest median error of six-bars that is accepted after ten seconds.
const SHAPES: [(&str, bool, f64); 6] = [
    ("square", true, 0.022),
    ("heart", true, 0.026),
    ("figure-8", true, 0.002),
    ("letter-D", true, 0.014),
    ("L", true, 0.045),
    ("S", false, 0.001),
];
const POINTS: usize = 120;
/// Share of random six-bars that have to be recovered.
const RECOVERED: f64 = 0.8;

struct Options {
    filter: String,
    seeds: u64,
    time_limit_s: f64,
    as_in_file: bool,
    dyads: usize,
    curves: usize,
    recovery_s: f64,
    show: bool,
}

fn options() -> Options {
    let mut options = Options {
        filter: String::new(),
        seeds: 10,
        time_limit_s: 10.0,
        as_in_file: false,
        dyads: 2,
        curves: 60,
        recovery_s: 5.0,
        show: false,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--bench" => {}
            "--seeds" => options.seeds = value().parse().expect("a whole number"),
            "--time-limit" => options.time_limit_s = value().parse().expect("seconds"),
            "--as-in-file" => options.as_in_file = true,
            "--dyads" => options.dyads = value().parse().expect("1, 2 or 3"),
            "--curves" => options.curves = value().parse().expect("a whole number"),
            "--recovery" => options.recovery_s = value().parse().expect("seconds"),
            "--show" => options.show = true,
            other if other.starts_with('-') => panic!("{other} is no argument of this bench"),
            other => options.filter = other.into(),
        }
    }
    options
}

/// Reads the points of a shape.
fn shape(name: &str) -> Vec<Complex> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("problems/literature/shapes/{name}.csv"));
    let text = std::fs::read_to_string(&file).unwrap_or_else(|why| panic!("{}: {why}", file.display()));
    let row = |line: &str| {
        let (x, y) = line.split_once(',').expect("two columns");
        Complex::new(x.parse().expect("a number"), y.parse().expect("a number"))
    };
    text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == '-')).map(row).collect()
}

/// Returns points evenly by arc length.
fn evenly(points: &[Complex], closed: bool) -> Vec<Complex> {
    let corners: Vec<[f64; 2]> = points.iter().copied().map(xy).collect();
    resample(&corners, closed, POINTS).into_iter().map(point).collect()
}

fn radius(points: &[Complex]) -> f64 {
    centroid_and_radius(points).1
}

fn diagonal(points: &[Complex]) -> f64 {
    let [low, high] = bounding_box(points.iter().copied());
    (high - low).norm()
}

/// Searches for so many seconds; returns the best answer and the evaluations.
fn answer(request: &Request<'_>, seconds: f64) -> (DyadChainAnswer, u64) {
    let began = Instant::now();
    let stopped = || began.elapsed().as_secs_f64() > seconds;
    let watch = Watch { stopped: &stopped, ..Watch::silent() };
    let found = search(request, watch, None).expect("a usable request");
    let best = found.answers.into_iter().next().expect("there is an answer");
    (best, found.evaluations)
}

fn shapes(options: &Options) {
    println!("| shape | best | median | worst | evaluations |");
    println!("|---|---|---|---|---|");
    let kinds = DyadChainKind::all(options.dyads);
    for (name, closed, most) in SHAPES.iter().filter(|(name, ..)| name.contains(&options.filter)) {
        let points = shape(name);
        let points = if options.as_in_file { points } else { evenly(&points, *closed) };
        let limits = DyadChainLimits {
            transmission_min: 30_f64.to_radians(),
            longest_max: 3.0 * diagonal(&points),
            link_ratio_max: 100.0,
            pivots_in: [None; 3],
            footprint_in: None,
            extent_max: f64::INFINITY,
        };
        let (mut errors, mut evaluations) = (Vec::new(), Vec::new());
        for seed in 1..=options.seeds {
            let request = Request {
                points: &points,
                closed: *closed,
                timing: None,
                kinds: &kinds,
                counter_clockwise: false,
                limits,
                seed,
                evaluations: u64::MAX,
                enough: 0.0,
                repeats: None,
                answers: 4,
            };
            let (best, used) = answer(&request, options.time_limit_s);
            let error = if best.accepted { best.rms / radius(&points) } else { f64::INFINITY };
            if options.show {
                println!(
                    "{name}, seed {seed}: {error:.5}, {:.1} degrees, {:.2} diagonals, link ratio {:.1}, excursion {:.4}, {}",
                    best.transmission.to_degrees(),
                    best.longest / diagonal(&points),
                    best.link_ratio,
                    best.excursion / radius(&points),
                    best.chain.shape.kind.name()
                );
            }
            errors.push(error);
            evaluations.push(used as f64);
        }
        errors.sort_by(f64::total_cmp);
        let (best, worst) = (errors[0], errors[errors.len() - 1]);
        let [middle, used] = [&errors, &evaluations].map(|of| median(of).unwrap_or(f64::NAN));
        println!("| {name} | {best:.5} | {middle:.5} | {worst:.5} | {used:.0} |");
        let is_measured = options.dyads == 2 && options.time_limit_s >= 10.0 && !options.as_in_file;
        assert!(!is_measured || middle <= *most, "{name}: {middle} is above {most}");
    }
}

/// Returns alpha and beta of lengths; `None` if they do not close over the whole turn.
fn length_values([l1, l2]: [f64; 2], [least, greatest]: [f64; 2]) -> Option<[f64; 2]> {
    let (excess, share) = ((l1 + l2) / greatest - 1.0, (l1 - l2) / least);
    (excess > 1e-9 && share.abs() < 1.0 - 1e-9).then(|| [excess.ln(), share.atanh()])
}

/// Draws a six-bar whose joints lie evenly in a square; `None` if its crank does not turn fully, or transmits badly.
fn drawn(kind: DyadChainKind, draws: &mut Stream) -> Option<DyadChain> {
    let mut joint = || Complex::new(uniform(draws, 0.0, 1.0), uniform(draws, 0.0, 1.0));
    let (a, b) = (joint(), joint());
    // In the frame A = 0, B = 1.
    let [c, d, x, y, f, p] = [(); 6].map(|()| (joint() - a) / (b - a));
    let side = |x: Complex, y: Complex, f: Complex| {
        if cross(y - x, f - x) > 0.0 { AssemblyMode::Plus } else { AssemblyMode::Minus }
    };
    let one = Complex::new(1.0, 0.0);
    let crank = c.norm();
    let mut shape = Shape {
        kind: kind.first(1),
        assembly: [side(c, one, d), side(x, y, f), AssemblyMode::Plus],
        parameters: [0.0; MAX_PARAMETERS],
    };
    const { assert!(MAX_DYADS == 3) };
    shape.parameters[0] = crank.ln();
    let lengths = length_values([(d - c).norm(), (d - one).norm()], [(1.0 - crank).abs(), 1.0 + crank])?;
    let [alpha, beta] = length_parameters(0);
    [shape.parameters[alpha], shape.parameters[beta]] = lengths;
    let mut grid = Grid::default();
    let first = shape.resolve(&mut grid);
    let e = c / crank;
    let mut frames = Frames::<f64>::of(ComplexLanes { re: e.re, im: e.im });
    frames.assemble(&first, 0);
    shape.kind = kind;
    let number = |z: ComplexLanes<f64>| Complex::new(z.re, z.im);
    for ((body, at), k) in kind.anchors(1).into_iter().zip([x, y]).zip([0, 2]) {
        let place = (at - number(frames.origin[body])) / number(frames.along[body]);
        let own = first_parameter(1) + k;
        [shape.parameters[own], shape.parameters[own + 1]] = [place.re, place.im];
    }
    let of = Proportions { kind, anchors: shape.anchors(), ..first };
    let ends = extremes(&of, 1, &grid).map(|extreme| extreme.distance);
    let lengths = length_values([(f - x).norm(), (f - y).norm()], ends)?;
    let [alpha, beta] = length_parameters(1);
    [shape.parameters[alpha], shape.parameters[beta]] = lengths;
    let origin = if kind.traced() == 4 { x } else { y };
    let pointer = (p - origin) / (f - origin) * (b - a);
    let chain = DyadChain { shape, placement: Placement { origin: a, ground: b - a, pointer } };
    (chain.least_transmission() >= 10_f64.to_radians() && chain.link_ratio() <= 100.0).then_some(chain)
}

fn random(options: &Options) {
    let draws = &mut stream(77, 0);
    let (mut recovered, mut times) = (0, Vec::new());
    for i in 0..options.curves {
        let kind = DyadChainKind::SIX_BARS[i % 7];
        let chain = loop {
            if let Some(chain) = drawn(kind, draws) {
                break chain;
            }
        };
        let points = evenly(&chain.curve(20_000), true);
        let request = Request {
            points: &points,
            closed: true,
            timing: None,
            kinds: &DyadChainKind::SIX_BARS,
            counter_clockwise: false,
            limits: DyadChainLimits {
                transmission_min: 10_f64.to_radians(),
                longest_max: 20.0 * diagonal(&points).max(chain.longest() / 19.0),
                link_ratio_max: 100.0,
                pivots_in: [None; 3],
                footprint_in: None,
                extent_max: f64::INFINITY,
            },
            seed: 1,
            evaluations: u64::MAX,
            enough: 1e-5 * radius(&points),
            repeats: None,
            answers: 1,
        };
        let began = Instant::now();
        let (best, _) = answer(&request, options.recovery_s);
        let (error, time) = (best.rms / radius(&points), began.elapsed().as_secs_f64());
        let is_recovered = best.accepted && error < 1e-4;
        if options.show {
            println!(
                "{i}: {error:.2e} in {time:.2} s, {}, found as {}",
                kind.name(),
                best.chain.shape.kind.name()
            );
        }
        if is_recovered {
            recovered += 1;
            times.push(time);
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "random six-bars: {recovered} of {} recovered, median time {:.2} s",
        options.curves,
        median(&times).unwrap_or(f64::NAN)
    );
    assert!(recovered as f64 >= RECOVERED * options.curves as f64, "{recovered} of {}", options.curves);
}

fn main() {
    let options = options();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        if options.filter != "random" {
            shapes(&options);
        }
        if (options.filter.is_empty() || options.filter == "random") && options.dyads == 2 {
            random(&options);
        }
    });
}
