//! Complete solutions: published counts, every real linkage, targets in special position, targets that move.

use linkwright::exact::{
    Census, Completeness, Options, Reality, Solution, Solved, Target, resolve_from, solve,
};
use linkwright::linkage::Complex;
use std::sync::atomic::{AtomicBool, Ordering};

fn solved(points: [Complex; 9]) -> Solved {
    let target = Target::new(points).expect("nine points");
    solve(&target, &Options::default(), &|_, _| {}, &AtomicBool::new(false))
}

fn adds_up(census: &Census) {
    assert_eq!(census.tracked, census.finite + census.singular + census.failed);
    assert_eq!(census.finite, census.distinct + census.duplicates);
    assert_eq!(census.distinct, census.real + census.curve_only + census.complex);
}

/// Points, number of real curves with a complex linkage, and the real linkages [A, C, B, D] of a stored problem.
fn stored(name: &str) -> ([Complex; 9], u64, Vec<[Complex; 4]>) {
    let text = include_str!("nine-point-solutions.json");
    let all: serde_json::Value = serde_json::from_str(text).expect("it is JSON");
    let list = all["problems"].as_array().expect("a list");
    let problem = list.iter().find(|p| p["name"] == name).expect("it is there");
    let point = |v: &serde_json::Value| Complex::new(v[0].as_f64().expect("x"), v[1].as_f64().expect("y"));
    let points = problem["points"].as_array().expect("points").iter().map(point).collect::<Vec<_>>();
    let linkage = |v: &serde_json::Value| std::array::from_fn(|i| point(&v[i]));
    let real = problem["real"].as_array().expect("linkages").iter().map(linkage).collect();
    (
        points.try_into().expect("nine"),
        problem["real_curve_complex_linkage"].as_u64().expect("a number"),
        real,
    )
}

/// How far a real class is from a linkage [A, C, B, D]: over its six images, in units of the points.
fn distance(target: &Target, solution: &Solution, linkage: &[Complex; 4]) -> f64 {
    let images = solution.images(&target.displacements);
    let apart = |image: &Solution| {
        let places = [image.grounds[0], image.pins[0], image.grounds[1], image.pins[1]];
        let there = places.map(|z| target.points[0] + z * target.scale);
        there.iter().zip(linkage).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max)
    };
    images.iter().map(apart).fold(f64::INFINITY, f64::min)
}

fn holds_the_stored_solution(name: &str, reals: usize) {
    let (points, curves, linkages) = stored(name);
    let answer = solved(points);
    adds_up(&answer.census);
    assert_eq!(answer.completeness(), Completeness::Complete);
    assert_eq!(answer.census.distinct, 1442);
    assert_eq!(answer.census.real, reals);
    assert_eq!(answer.census.curve_only as u64, curves);
    assert_eq!(linkages.len(), reals);
    let real: Vec<_> = answer.classes.iter().filter(|class| class.reality == Reality::Real).collect();
    let mut met: Vec<usize> = linkages
        .iter()
        .map(|linkage| {
            let near = |at: &usize| distance(&answer.target, &real[*at].solution, linkage);
            let best = (0..real.len()).min_by(|a, b| near(a).total_cmp(&near(b))).expect("there are some");
            // Stored to 12 decimals.
            assert!(near(&best) < 1e-9 * (1.0 + linkage[0].norm() + linkage[2].norm()), "{linkage:?}");
            best
        })
        .collect();
    met.sort_unstable();
    met.dedup();
    assert_eq!(met.len(), reals, "every stored class is another one of ours");
    assert!(answer.classes.iter().all(|class| class.newton_step <= 1e-9));
}

#[test]
fn problem_three_of_1992_has_1442_classes_and_64_real_ones() {
    holds_the_stored_solution("wms3", 64);
}

#[test]
fn random_points_have_1442_classes_and_the_stored_real_ones() {
    holds_the_stored_solution("gaussian", 8);
}

#[test]
fn a_moved_point_keeps_every_class_and_gives_what_a_full_solve_gives() {
    let (points, ..) = stored("wms3");
    let before = solved(points);
    let mut moved_points = points;
    moved_points[4] += Complex::new(0.02, -0.02);
    let target = Target::new(moved_points).expect("nine points");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let quiet = AtomicBool::new(false);
    let moved = pool.install(|| resolve_from(&before, &target, &Options::default(), &quiet));
    let full = solved(moved_points);
    assert_eq!((moved.kept, moved.fell_back), (1442, false));
    assert_eq!(moved.solved.completeness(), Completeness::Complete);
    let counts = |c: &Census| [c.real, c.curve_only, c.complex];
    assert_eq!(counts(&moved.solved.census), counts(&full.census));
    for (one, other) in moved.solved.classes.iter().zip(&full.classes).take(full.census.real) {
        let there = &other.solution;
        let linkage = [there.grounds[0], there.pins[0], there.grounds[1], there.pins[1]]
            .map(|z| target.points[0] + z * target.scale);
        assert!(distance(&target, &one.solution, &linkage) < 1e-6);
    }
    // The same again on another number of threads: not a digit differs.
    assert_eq!(resolve_from(&before, &target, &Options::default(), &quiet), moved);
}

#[test]
fn special_targets_have_fewer_isolated_solutions_and_none_is_called_failed() {
    let ellipse = std::array::from_fn(|j| {
        let angle = std::f64::consts::TAU * (j as f64 + 0.1) / 9.0;
        Complex::new(angle.cos(), 0.5 * angle.sin())
    });
    let answer = solved(ellipse);
    adds_up(&answer.census);
    assert_eq!((answer.census.failed, answer.census.duplicates), (0, 0), "{:?}", answer.census);
    let isolated = answer.census.distinct;
    assert!((1000..1442).contains(&isolated), "{isolated}");
    assert_eq!(answer.completeness(), Completeness::NonGeneric { isolated });
}

#[test]
fn a_cancelled_solve_says_so() {
    let (points, ..) = stored("wms3");
    let target = Target::new(points).expect("nine points");
    let cancel = AtomicBool::new(true);
    let answer = solve(&target, &Options::default(), &|_, _| {}, &cancel);
    assert_eq!(answer.completeness(), Completeness::Cancelled);
    assert!(answer.classes.is_empty());
    cancel.store(false, Ordering::Relaxed);
}
