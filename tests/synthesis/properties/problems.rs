//! Random problems: any target, any timing, any requirements, small budgets.

#![allow(dead_code, reason = "every user takes its own part of it")]

use crate::random::{TYPES, bounding_box, chance, linkage, log_uniform, noisy, one_of, trace};
use linkwright::internals::files::problem_file;
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, stream, uniform, unit};
use linkwright::internals::task::spec::ClosingPolicy;
use std::f64::consts::TAU;
use std::fmt::Write;

/// A problem with its text; weights and tolerances a point, `solve.advice` and `require.closing` may differ from it.
pub struct Case {
    /// Which draw of the seed.
    pub index: u64,
    /// The problem file.
    pub text: String,
    /// The problem.
    pub file: ProblemFile,
}

/// Problem `index` of a seed; `None` where the draw contradicts itself and the reader refuses it.
pub fn case(seed: u64, index: u64) -> Option<Case> {
    let draws = &mut stream(seed, index);
    let (points, closed) = target(draws);
    let asks = Asks { evaluations: [50.0, 1500.0], small: 1.0, toleranced: 0.15, ..Asks::default() };
    parsed(draws, index, &points, closed, &asks)
}

/// As [`case`], from farther afield: targets up to 1e10 of their sizes from the origin, both objectives, digitised points,
/// budgets of 500 to 20,000 evaluations, with advice and without, closed by one way and by any.
pub fn wide_case(seed: u64, index: u64) -> Option<Case> {
    let draws = &mut stream(seed, index);
    let (mut points, closed) = target(draws);
    let [x0, y0, x1, y1] = bounding_box(&points);
    let size = (x1 - x0).hypot(y1 - y0);
    if chance(draws, 0.5) {
        // A coordinate of more than 1e12 is none.
        let away = (size * log_uniform(draws, 10.0, 1e10)).min(5e11);
        let by = Complex::from_polar(away, uniform(draws, 0.0, TAU));
        points.iter_mut().for_each(|p| *p += by);
    }
    let digitised = chance(draws, 0.15);
    let asks = Asks {
        evaluations: [500.0, 20_000.0],
        small: 1.5,
        // The dearest ones are rare: the least largest deviation is a row of cone programs.
        toleranced: 0.03,
        max_deviation: chance(draws, 0.04),
        smooth: (digitised && chance(draws, 0.6)).then(|| size * log_uniform(draws, 1e-3, 0.05)),
        samples: (digitised && chance(draws, 0.7)).then(|| 5 + below(draws, 40)),
    };
    let mut case = parsed(draws, index, &points, closed, &asks)?;
    let spec = &mut case.file.spec;
    // Looking for what conflicts costs several times what the answers do.
    spec.solve.advice = chance(draws, 0.3);
    if spec.task.closed && chance(draws, 0.3) {
        spec.require.closing = ClosingPolicy::Any;
    }
    Some(case)
}

/// What a problem asks besides what is drawn for every one.
#[derive(Default)]
struct Asks {
    /// The budget of evaluations lies between these.
    evaluations: [f64; 2],
    /// Spread evenly in their logarithm at 1; the more, the more of them are small.
    small: f64,
    /// The share of problems with one tolerance, and of the others that with one a point.
    toleranced: f64,
    /// The objective is the largest deviation.
    max_deviation: bool,
    /// The deviation of the smoothing.
    smooth: Option<f64>,
    /// The points are resampled; then they have no crank angles and no numbers of their own.
    samples: Option<usize>,
}

fn parsed(draws: &mut Stream, index: u64, points: &[Complex], closed: bool, asks: &Asks) -> Option<Case> {
    let text = text(draws, index, points, closed, asks);
    let mut file = problem_file::parse("random.toml", &text, None, &[]).ok()?;
    let path = &mut file.spec.task;
    let [x0, y0, x1, y1] = bounding_box(points);
    let size = (x1 - x0).hypot(y1 - y0);
    if asks.samples.is_some() {
        return Some(Case { index, text, file });
    }
    if chance(draws, 0.2) {
        path.weight = Some(points.iter().map(|_| log_uniform(draws, 0.01, 100.0)).collect());
    }
    if path.tolerance.is_none() && chance(draws, asks.toleranced) {
        path.tolerance = Some(points.iter().map(|_| size * log_uniform(draws, 0.003, 0.5)).collect());
    }
    Some(Case { index, text, file })
}

/// Points and whether they are a closed curve.
fn target(draws: &mut Stream) -> (Vec<Complex>, bool) {
    let n = match below(draws, 3) {
        0 => 3 + below(draws, 4),
        1 => 7 + below(draws, 12),
        _ => 19 + below(draws, 22),
    };
    let mut closed = chance(draws, 0.5);
    let mut points = match below(draws, 6) {
        0..=2 => curve(draws, n, closed),
        3 => {
            let corners = letter(draws);
            closed = corners[0] == corners[corners.len() - 1];
            along(&corners, n, closed)
        }
        4 => {
            // A random smooth loop, or a part of one.
            let span = if closed { TAU } else { uniform(draws, 0.5, 6.0) };
            let terms = [(); 3].map(|()| Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0)));
            (0..n)
                .map(|i| {
                    let t = span * i as f64 / n as f64;
                    let harmonic = |k: f64| Complex::from_polar(1.0, k * t);
                    terms[0] * harmonic(1.0)
                        + terms[1] * harmonic(-1.0) * 0.6
                        + terms[2] * harmonic(2.0) * 0.3
                })
                .collect()
        }
        _ => (0..n).map(|_| Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0))).collect(),
    };
    let [x0, y0, x1, y1] = bounding_box(&points);
    let size = (x1 - x0).hypot(y1 - y0);
    if chance(draws, 0.3) {
        let sigma = size * one_of(draws, &[1e-6, 1e-3, 0.01, 0.05]);
        points = noisy(draws, &points, sigma);
    }
    if closed && chance(draws, 0.2) {
        points.push(points[0]);
    }
    // Now and then far away: differences of coordinates lose digits there.
    let far = if chance(draws, 0.1) { 1e4 } else { 2.0 } * size;
    let scale = log_uniform(draws, 0.01, 1000.0) / size;
    let by = Complex::new(uniform(draws, -far, far), uniform(draws, -far, far));
    (points.iter().map(|p| (p + by) * scale).collect(), closed)
}

/// Points that some linkage draws.
fn curve(draws: &mut Stream, n: usize, closed: bool) -> Vec<Complex> {
    loop {
        let of = one_of(draws, &TYPES);
        let drawn = linkage(draws, of);
        let span = uniform(draws, 0.3, 6.0);
        if let Some(traced) = trace(draws, &drawn, n, (!closed).then_some(span)) {
            return traced.points;
        }
    }
}

/// Corners of a letter.
fn letter(draws: &mut Stream) -> Vec<Complex> {
    let letters: [&[[i8; 2]]; 6] = [
        &[[0, 2], [0, 0], [1, 0]],
        &[[0, 2], [2, 2], [0, 0], [2, 0]],
        &[[0, 2], [1, 0], [2, 2]],
        &[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]],
        &[[0, 0], [2, 0], [1, 2], [0, 0]],
        &[[0, 0], [3, 0]],
    ];
    let letter = letters[below(draws, letters.len())];
    letter.iter().map(|[x, y]| Complex::new(f64::from(*x), f64::from(*y))).collect()
}

/// `n` points evenly along a line through corners; of a closed one the end is not repeated.
fn along(corners: &[Complex], n: usize, closed: bool) -> Vec<Complex> {
    let lengths: Vec<f64> = corners.windows(2).map(|w| (w[1] - w[0]).norm()).collect();
    let whole: f64 = lengths.iter().sum();
    let steps = if closed { n } else { n - 1 };
    (0..n)
        .map(|i| {
            let mut left = whole * i as f64 / steps as f64;
            for (w, length) in corners.windows(2).zip(&lengths) {
                if left <= *length {
                    return w[0] + (w[1] - w[0]) * (left / length);
                }
                left -= length;
            }
            corners[corners.len() - 1]
        })
        .collect()
}

/// A problem file with random tables.
fn text(draws: &mut Stream, index: u64, points: &[Complex], closed: bool, asks: &Asks) -> String {
    let [x0, y0, x1, y1] = bounding_box(points);
    let (size, centre) = ((x1 - x0).hypot(y1 - y0), [0.5 * (x0 + x1), 0.5 * (y0 + y1)]);
    let listed: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p.re, p.im)).collect();
    let mut out = format!("format = 1\n[task.path]\npoints = [{}]\nclosed = {closed}\n", listed.join(", "));
    if chance(draws, asks.toleranced) {
        let tolerance = size * log_uniform(draws, 0.003, 0.5);
        writeln!(out, "tolerance = {tolerance:?}").expect("memory");
    }
    for (key, value) in [("smooth", asks.smooth), ("samples", asks.samples.map(|n| n as f64))] {
        if let Some(value) = value {
            writeln!(out, "{key} = {value}").expect("memory");
        }
    }
    let timed = chance(draws, 0.5) && asks.samples.is_none();
    let offset = if timed { timing(draws, points.len(), &mut out) } else { None };
    design(draws, size, centre, &mut out);
    require(draws, size, centre, offset.is_none_or(|o| o == "free"), &mut out);
    limits_of_size(&mut stream(LIMITS_OF_SIZE, index), size, &mut out);
    let method = one_of(
        draws,
        &[
            "auto",
            "auto",
            "auto",
            "auto",
            "least-squares",
            "least-squares",
            "genetic",
            "differential-evolution",
        ],
    );
    let [least, most] = asks.evaluations;
    let evaluations = (least * (most / least).powf(unit(draws).powf(asks.small))) as u64;
    let (candidates, seed) = (1 + below(draws, 4), below(draws, 1000));
    write!(
        out,
        "[solve]\nmethod = \"{method}\"\nevaluations = {evaluations}\ncandidates = {candidates}\nseed = {seed}\n"
    )
    .expect("memory");
    if asks.max_deviation {
        out.push_str("objective = \"max-deviation\"\n");
    }
    out
}

fn timing(draws: &mut Stream, n: usize, out: &mut String) -> Option<&'static str> {
    let mut at = if chance(draws, 0.5) { 0.0 } else { uniform(draws, -400.0, 400.0) };
    let way = if chance(draws, 0.5) { 1.0 } else { -1.0 };
    let even = chance(draws, 0.6);
    let span = one_of(draws, &[60.0, 180.0, 300.0, 360.0, 360.0, 800.0]);
    let angles: Vec<String> = (0..n)
        .map(|_| {
            let here = at;
            // Uneven steps go back now and then.
            at += way * span / n as f64 * if even { 1.0 } else { uniform(draws, -0.1, 2.0) };
            format!("{here:?}")
        })
        .collect();
    let offset = one_of(draws, &["free", "fixed", "ground"]);
    writeln!(out, "[task.path.timing]\ncrank_deg = [{}]\noffset = \"{offset}\"", angles.join(", "))
        .expect("memory");
    Some(offset)
}

fn design(draws: &mut Stream, size: f64, centre: [f64; 2], out: &mut String) {
    out.push_str("[design]\n");
    let mut key = |draws: &mut Stream, share: f64, name: &str, low: f64, high: f64| {
        if !chance(draws, share) {
            return;
        }
        let (one, other) = (uniform(draws, low, high), uniform(draws, low, high));
        if chance(draws, 0.3) {
            writeln!(out, "{name} = {one:?}").expect("memory");
        } else if one != other {
            writeln!(out, "{name} = [{:?}, {:?}]", one.min(other), one.max(other)).expect("memory");
        }
    };
    // Most problems say little of the design.
    let share = one_of(draws, &[0.0, 0.0, 0.1, 0.2, 0.4]);
    for name in ["a", "b", "c", "ground"] {
        let least = if chance(draws, 0.5) { 0.0 } else { 0.05 * size };
        key(draws, share, name, least, 3.0 * size);
    }
    if chance(draws, 0.3) {
        key(draws, share, "d", 0.0, 3.0 * size);
        key(draws, share, "e", 0.0, 3.0 * size);
    } else {
        key(draws, share, "coupler_x", -3.0 * size, 3.0 * size);
        key(draws, share, "coupler_y", -3.0 * size, 3.0 * size);
    }
    key(draws, 0.5 * share, "ground_angle_deg", -200.0, 200.0);
    for name in ["A", "B"] {
        if !chance(draws, share) {
            continue;
        }
        let axes = centre.map(|c| {
            let one = c + uniform(draws, -2.0, 2.0) * size;
            let width = uniform(draws, 0.1, 3.0) * size;
            if chance(draws, 0.3) { format!("{one:?}") } else { format!("[{one:?}, {:?}]", one + width) }
        });
        writeln!(out, "{name} = [{}]", axes.join(", ")).expect("memory");
    }
}

fn require(draws: &mut Stream, size: f64, centre: [f64; 2], turnable: bool, out: &mut String) {
    out.push_str("[require]\n");
    let mut line = |text: String| writeln!(out, "{text}").expect("memory");
    let boxed = |draws: &mut Stream, low: f64, high: f64| {
        let mut side = |c: f64, sign: f64| c + sign * size * uniform(draws, low, high);
        let [x, y] = centre;
        format!("[{:?}, {:?}, {:?}, {:?}]", side(x, -1.0), side(y, -1.0), side(x, 1.0), side(y, 1.0))
    };
    if chance(draws, 0.4) {
        let names: Vec<String> = (0..1 + below(draws, 3))
            .map(|_| if chance(draws, 0.05) { "change-point" } else { one_of(draws, &TYPES).name() })
            .map(|name| format!("\"{name}\""))
            .collect();
        line(format!("type = [{}]", names.join(", ")));
    }
    if chance(draws, 0.3) {
        line(format!("transmission_deg_min = {:?}", uniform(draws, 0.0, 50.0)));
        if chance(draws, 0.5) {
            line(format!("transmission_over = \"{}\"", one_of(draws, &["cycle", "used"])));
        }
    }
    if chance(draws, 0.5) {
        line(format!("link_ratio_max = {:?}", log_uniform(draws, 1.2, 200.0)));
    }
    if chance(draws, 0.25) {
        line(format!("pivots_in = {}", boxed(draws, 0.3, 4.0)));
    }
    if chance(draws, 0.2) {
        line(format!("footprint_in = {}", boxed(draws, 0.6, 5.0)));
    }
    if chance(draws, 0.3) {
        line("order = \"any\"".into());
    }
    if turnable && chance(draws, 0.25) {
        line(format!("direction = \"{}\"", one_of(draws, &["ccw", "cw"])));
    }
    if chance(draws, 0.2) {
        line("circuit = \"any\"".into());
    }
    if chance(draws, 0.35) {
        line("branch = \"any\"".into());
    }
}

/// The seed of the draws of [`limits_of_size`]: a stream of their own leaves the other draws as they are without them.
const LIMITS_OF_SIZE: u64 = 17;

/// Limits of the extent and of the longest link, each in one problem of ten; the table is `[require]`.
fn limits_of_size(draws: &mut Stream, size: f64, out: &mut String) {
    for (key, low, high) in [("extent_max", 1.5, 30.0), ("longest_max", 0.5, 15.0)] {
        if chance(draws, 0.1) {
            writeln!(out, "{key} = {:?}", size * log_uniform(draws, low, high)).expect("memory");
        }
    }
}
