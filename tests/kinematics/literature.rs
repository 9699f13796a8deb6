//! The shipped problem and linkage files against their own figures: published vectors give the sums that
//! stand beside them, best known linkages give the best known sums, classical linkages run as straight as
//! they should.

use crate::reference::{linkage, shipped_linkage};
use linkwright::internals::judge::error::distances_to_curve;
use linkwright::internals::mechanism::{AssemblyMode, Complex, CouplerCurve, FourBar, LinkageType};
use linkwright::internals::task::{AngleOffset, Task, TaskOptions, Timing};
use std::f64::consts::{PI, TAU};

fn read(folder: &str, name: &str) -> toml::Table {
    let path = format!("{}/problems/{folder}/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    text.parse().unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn numbers(value: &toml::Value) -> Vec<f64> {
    let number = |v: &toml::Value| v.as_float().or(v.as_integer().map(|i| i as f64)).expect("a number");
    value.as_array().expect("a list").iter().map(number).collect()
}

fn task(problem: &toml::Table) -> Task {
    let path = &problem["task"]["path"];
    let points = path["points"].as_array().expect("points");
    let points = points.iter().map(|p| [numbers(p)[0], numbers(p)[1]]).collect();
    let timing = match path.get("timing") {
        None => Timing::Free,
        Some(timing) => Timing::Prescribed {
            crank_angles: numbers(&timing["crank_deg"]).into_iter().map(f64::to_radians).collect(),
            offset: timing["offset"].clone().try_into().expect("an offset"),
        },
    };
    Task::new(points, timing, TaskOptions::default()).expect("a task")
}

/// The literature's [ground, crank, coupler, follower, x, y, Ax, Ay, ground angle] with its sign.
fn from_vector(v: &[f64], s: i64) -> FourBar {
    let a = Complex::new(v[6], v[7]);
    let b = a + Complex::from_polar(v[0], v[8]);
    let assembly = AssemblyMode::try_from(s).expect("a sign");
    FourBar::with_coupler_offset([a, b], [v[1], v[2], v[3]], Complex::new(v[4], v[5]), assembly)
        .expect("a linkage")
}

fn sum_at(task: &Task, linkage: &FourBar, angles: &[f64]) -> f64 {
    let assemblies = vec![linkage.assembly(); angles.len()];
    task.errors(linkage, angles, &assemblies, None).map_or(f64::INFINITY, |e| e.sum_sq)
}

/// The least of a function of one angle: a grid, then golden section.
fn least(f: impl Fn(f64) -> f64) -> f64 {
    let step = TAU / 720.0;
    let best = (0..720).map(|i| f64::from(i) * step).min_by(|x, y| f(*x).total_cmp(&f(*y))).expect("a grid");
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..80 {
        let (left, right) = (high - 0.618 * (high - low), low + 0.618 * (high - low));
        if f(left) < f(right) { high = right } else { low = left }
    }
    f(0.5 * (low + high))
}

/// What a linkage gives on a problem, as the problem's timing asks.
fn sum_of(task: &Task, linkage: &FourBar) -> f64 {
    match task.timing() {
        Timing::Free => {
            distances_to_curve(task.points(), linkage, 0.0, linkage.assembly()).expect("a curve").sum_sq
        }
        Timing::Prescribed { crank_angles, offset } => {
            let shifted = |by: f64, direction: f64| {
                let angles: Vec<f64> = crank_angles.iter().map(|angle| by + direction * angle).collect();
                sum_at(task, linkage, &angles)
            };
            match offset {
                AngleOffset::Fixed => shifted(0.0, 1.0),
                AngleOffset::Ground => shifted(linkage.ground_angle(), 1.0),
                AngleOffset::Free => least(|by| shifted(by, 1.0)).min(least(|by| shifted(by, -1.0))),
            }
        }
    }
}

const PROBLEMS: [&str; 10] = ["v6", "e5", "e5-free", "k18", "k18b", "k18f", "a6", "a6b", "l10", "p12"];

#[test]
fn every_published_vector_gives_the_sum_that_stands_beside_it() {
    let mut seen = 0;
    for name in PROBLEMS {
        let problem = read("literature", name);
        let task = task(&problem);
        let Some(published) = problem["expect"].get("published") else { continue };
        for entry in published.as_array().expect("a list") {
            let vector = from_vector(&numbers(&entry["vector"]), entry["t1"].as_integer().expect("t1"));
            let wanted = entry["recomputed_sum_sq"].as_float().expect("a sum");
            let got = sum_of(&task, &vector);
            // Ten digits are printed. Coordinates near 60 are good to 1e-14, so that an exact answer's sum is
            // rounding only.
            let slack = 1e-9 * wanted + 1e-14 * wanted.sqrt() * 60.0f64.sqrt();
            let same = (got - wanted).abs() <= slack || (wanted < 1e-15 && got < 1e-18);
            assert!(same, "{name}, {}: {got:e} for {wanted:e}", entry["source"]);
            if let Some(best) = problem["expect"]["best_known_sum_sq"].as_float() {
                assert!(wanted >= best, "{name}: {} beats the best known", entry["source"]);
            }
            seen += 1;
        }
    }
    assert_eq!(seen, 17);
}

#[test]
fn best_known_linkages_give_the_best_known_sums() {
    let k18 = linkage(
        [[0.5483085928380659, 0.7165120992749661], [1.2791366906661708, 0.45079620415323596]],
        [
            0.31274881685597095,
            0.44190041062522994,
            0.6745635568571409,
            0.3569014735710573,
            0.5989168228431991,
        ],
        -1,
        -1,
    );
    let k18_angles: Vec<f64> =
        (0..18).map(|i| 0.542832786236755 + (20.0 * f64::from(i)).to_radians()).collect();
    let e5 = linkage(
        [[0.0, 0.0], [3.66972834432468, 0.0]],
        [1.9978121398901507, 3.9963157208255047, 2.7048859102789318, 2.3703550229584733, 2.8679387883994103],
        1,
        1,
    );
    let e5_angles: Vec<f64> = [30.0f64, 45.0, 60.0, 75.0, 90.0].map(f64::to_radians).to_vec();
    let l10 = linkage(
        [[8.49444014241005, -0.7579575962945292], [-50.16775390870027, -55.152323013218705]],
        [8.04568331202292, 50.81911017625806, 42.208049816053105, 10.880960120007188, 61.498984057032416],
        1,
        -1,
    );
    let mut l10_angles = vec![
        0.055468113591,
        0.760003238553,
        1.443150150854,
        2.126206624522,
        2.810834246351,
        3.504569410119,
        4.205421576935,
        4.912770663027,
        5.628207526376,
    ];
    l10_angles.push(l10_angles[0] + TAU);
    for (name, best, angles) in [("k18", k18, k18_angles), ("e5", e5, e5_angles), ("l10", l10, l10_angles)] {
        let problem = read("literature", name);
        let wanted = problem["expect"]["best_known_sum_sq"].as_float().expect("a sum");
        let got = sum_at(&task(&problem), &best, &angles);
        // Ten digits are printed; near a minimum, parameters rounded to 1e-15 and angles to 1e-12 change
        // less.
        assert!((got - wanted).abs() <= 1e-9 * wanted, "{name}: {got:e} for {wanted:e}");
        assert_eq!(best.linkage_type(), Some(LinkageType::CrankRocker));
    }
}

#[test]
fn an_error_names_its_worst_point_and_weights_enter_the_objective_only() {
    let problem = read("literature", "e5");
    let plain = task(&problem);
    let points = plain.points().iter().map(|p| [p.re, p.im]).collect();
    let weights = vec![1.0, 2.0, 3.0, 4.0, 5.0];
    let options = TaskOptions { weights: Some(weights.clone()), ..TaskOptions::default() };
    let weighted = Task::new(points, plain.timing().clone(), options).unwrap();
    let l = linkage([[0.0, 0.0], [3.7, 0.0]], [2.0, 4.0, 2.7, 2.37, 2.87], 1, 1);
    let angles = [30.0f64, 45.0, 60.0, 75.0, 90.0].map(f64::to_radians);
    let assemblies = [AssemblyMode::Plus; 5];
    let error = weighted.errors(l, &angles, &assemblies, None).unwrap();
    let sq: Vec<f64> = error.structural.iter().map(|e| e.norm_sqr()).collect();
    for (j, &target) in plain.points().iter().enumerate() {
        let generated = l.position(angles[j]).joints().unwrap().coupler_point;
        assert_eq!(error.structural[j], target - generated, "desired minus generated");
    }
    let slack = 8.0 * f64::EPSILON * error.objective;
    assert!((error.sum_sq - sq.iter().sum::<f64>()).abs() <= slack);
    assert!((error.objective - sq.iter().zip(weights).map(|(e, w)| e * w).sum::<f64>()).abs() <= slack);
    assert_eq!(error.sum_sq, plain.errors(l, &angles, &assemblies, None).unwrap().sum_sq);
    assert_eq!(error.max, error.structural[error.max_at].norm());
    assert!(sq.iter().all(|e| e.sqrt() <= error.max * (1.0 + 4.0 * f64::EPSILON)));
}

#[test]
fn hoekens_linkage_runs_straight_over_half_a_turn() {
    let l = shipped_linkage("hoeken");
    assert_eq!(l.linkage_type(), Some(LinkageType::CrankRocker));
    let y: Vec<f64> = (0..=18_000)
        .map(|i| l.position((90.0 + 0.01 * f64::from(i)).to_radians()).joints().unwrap().coupler_point.im)
        .collect();
    let (low, high) =
        (y.iter().copied().fold(f64::MAX, f64::min), y.iter().copied().fold(f64::MIN, f64::max));
    // 4.0097537 is printed to 5e-8; samples 0.01 degrees apart miss an extreme by 1e-8 at most.
    assert!((low - 4.0).abs() <= 1e-12 && (high - 4.0097537).abs() <= 6e-8, "{low} to {high}");
    let ends = [90.0f64, 270.0].map(|deg| l.position(deg.to_radians()).joints().unwrap().coupler_point);
    assert!((ends[0] - Complex::new(4.0, 4.0)).norm() <= 1e-14);
    assert!((ends[1] - Complex::new(0.0, 4.0)).norm() <= 1e-14);
}

#[test]
fn chebyshevs_linkage_draws_the_curve_of_its_cognate() {
    let (chebyshev, hoeken) = (shipped_linkage("chebyshev"), shipped_linkage("hoeken"));
    assert_eq!(chebyshev.linkage_type(), Some(LinkageType::DoubleRocker));
    let middle = chebyshev.position(0.6f64.acos()).joints().unwrap().coupler_point;
    assert!((middle - Complex::new(2.0, 4.0)).norm() <= 1e-7, "a toggle of the symmetric position");
    let curve = CouplerCurve::through(&hoeken, 0.0, AssemblyMode::Plus, 720);
    let (mut low, mut high, mut seen) = (f64::MAX, f64::MIN, 0);
    for i in 1..1800 {
        for t1 in [AssemblyMode::Plus, AssemblyMode::Minus] {
            let Some(j) = chebyshev.position_with(PI * f64::from(i) / 1800.0, t1).joints() else { continue };
            let p = j.coupler_point;
            // On the curve to the root of the rounding near toggles, where D is known no better.
            let nearest = curve.nearest(p).unwrap();
            assert!(nearest.distance <= 1e-7, "{p} is {:e} off Hoeken's curve", nearest.distance);
            if (0.0..=4.0).contains(&p.re) && (0.5 * PI..=1.5 * PI).contains(&nearest.parameter) {
                (low, high, seen) = (low.min(p.im), high.max(p.im), seen + 1);
            }
        }
    }
    assert!(seen > 500 && low >= 4.0 - 1e-7 && high <= 4.0097537 + 6e-8, "{low} to {high} at {seen} points");
    assert!(high >= 4.0097537 - 1e-5);
}

/// The points of the circuit through a position, from there both ways while `near` holds.
fn stretch(l: &FourBar, crank_angle: f64, near: impl Fn(Complex) -> bool) -> Vec<Complex> {
    let n = 20_000;
    let curve = CouplerCurve::through(l, crank_angle, l.assembly(), n);
    let points: Vec<Complex> = curve.points().collect();
    assert_eq!(points.len(), n, "closed at every sample");
    let here = l.position(crank_angle).joints().expect("closed").coupler_point;
    let start =
        (0..n).min_by(|&i, &j| (points[i] - here).norm().total_cmp(&(points[j] - here).norm())).unwrap();
    let ahead = (0..n).map(|k| points[(start + k) % n]).take_while(|p| near(*p));
    let back = (1..n).map(|k| points[(start + n - k) % n]).take_while(|p| near(*p));
    ahead.chain(back).collect()
}

#[test]
fn robertss_linkage_stays_near_its_line_between_the_pivots() {
    for (leg, wanted, half_unit) in [(1.0f64, 0.031929, 5e-7), (1.2, 0.013642, 5e-7), (1.5, 0.0058737, 5e-8)]
    {
        let l = linkage([[0.0, 0.0], [2.0, 0.0]], [leg, 1.0, leg, leg, leg], 1, -1);
        let height = (leg * leg - 0.25).sqrt();
        let upright = height.atan2(0.5);
        let middle = l.position(upright).joints().unwrap().coupler_point;
        assert!((middle - 1.0).norm() <= 1e-14);
        // To within two thousandths of the pivots, several times the distance of the samples.
        let points = stretch(&l, upright, |p| p.norm() > 2e-3 && (p - 2.0).norm() > 2e-3);
        let (first, last) = (
            points.iter().map(|p| p.re).fold(f64::MAX, f64::min),
            points.iter().map(|p| p.re).fold(f64::MIN, f64::max),
        );
        assert!(
            first.abs() <= 3e-3 && (last - 2.0).abs() <= 3e-3,
            "P runs from one pivot to the other: {first} to {last}"
        );
        let largest = points.iter().map(|p| p.im.abs()).fold(0.0, f64::max);
        // Twenty thousand samples of the circuit miss the extreme by less than 1e-8.
        assert!((largest - wanted).abs() <= half_unit + 1e-8, "leg {leg}: {largest}");
    }
    assert_eq!(
        shipped_linkage("roberts"),
        linkage([[0.0, 0.0], [2.0, 0.0]], [1.2, 1.0, 1.2, 1.2, 1.2], 1, -1)
    );
}

#[test]
fn watts_linkage_runs_up_and_down_within_its_deviation() {
    let l = shipped_linkage("watt");
    let middle = l.position(0.0).joints().unwrap().coupler_point;
    assert!((middle - Complex::new(1.0, 0.25)).norm() <= 1e-14);
    let points = stretch(&l, 0.0, |p| (p.im - 0.25).abs() <= 0.25);
    let largest = points.iter().map(|p| (p.re - 1.0).abs()).fold(0.0, f64::max);
    // The deviation grows steeply to the ends, which samples 3e-4 apart in y cut off: 1e-3 of it.
    assert!((largest - 5.229e-4).abs() <= 5e-8 + 5e-3 * 5.229e-4, "{largest:e}");
    let doubled = linkage([[0.0, 0.0], [4.0, 1.0]], [2.0, 1.0, 2.0, 0.5, 0.5], 1, 1);
    let points = stretch(&doubled, 0.0, |p| (p.im - 0.5).abs() <= 0.5);
    let twice = points.iter().map(|p| (p.re - 2.0).abs()).fold(0.0, f64::max);
    assert!((twice - 2.0 * largest).abs() <= 1e-12, "twice the linkage, twice the deviation");
}

#[test]
fn evanss_linkage_runs_along_a_line_beyond_its_crank_pin() {
    let l = shipped_linkage("evans");
    assert!((l.ground() - 10.0).abs() <= 1e-14 && (l.ground_angle() + PI / 6.0).abs() <= 1e-15);
    let points: Vec<Complex> = (0..=4000)
        .map(|i| {
            let from_ground = (8.0 + 0.01 * f64::from(i)).to_radians();
            l.position(l.ground_angle() + from_ground).joints().unwrap().coupler_point
        })
        .collect();
    let chord = points[4000] - points[0];
    assert!((chord.norm() - 6.866).abs() <= 5e-4, "{}", chord.norm());
    let off: Vec<f64> = points.iter().map(|p| (chord.conj() * (p - points[0])).im / chord.norm()).collect();
    let (low, high) = (off.iter().copied().fold(0.0, f64::min), off.iter().copied().fold(0.0, f64::max));
    assert!((0.5 * (high - low) - 0.0155).abs() <= 5e-5, "along the chord: {low} to {high}");
    // The best line: the least width over directions, halved.
    let width = |turn: f64| {
        let direction = chord * Complex::from_polar(1.0, turn);
        let off = points.iter().map(|p| (direction.conj() * (p - points[0])).im / direction.norm());
        let (low, high) = off.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
        0.5 * (high - low)
    };
    let best = (-1000..=1000).map(|i| width(1e-5 * f64::from(i))).fold(f64::MAX, f64::min);
    assert!((best - 0.0121).abs() <= 5e-5, "{best}");
}

#[test]
fn every_shipped_example_has_the_tables_of_a_problem_file() {
    for name in ["straight-line", "walking-stride", "csv-tolerances", "pivot-box"] {
        let problem = read("examples", name);
        assert_eq!(problem["format"].as_integer(), Some(1));
        assert_eq!(problem["name"].as_str(), Some(name));
        if problem["task"]["path"].get("points").is_some() {
            let task = task(&problem);
            assert!(task.size() > 0.0);
        }
    }
}
