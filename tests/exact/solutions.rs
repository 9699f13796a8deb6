//! Complete solutions: published counts, every real linkage, targets in special position, targets that move.

use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::nine_point::certificate::check;
use linkwright::internals::numbers::nine_point::{
    Census, Certificate, Completeness, Options, Reality, Solution, Solved, Target, certify_all,
    not_proved_distinct, resolve_from, solve,
};
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

fn holds_the_stored_solution(name: &str, reals: usize, certified: usize) {
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
    let proofs = proofs(&answer);
    assert!(proofs.len() >= certified, "{}", proofs.len());
    let of = |reality: Reality| proofs.iter().filter(|proof| proof.reality == reality).count();
    assert_eq!(of(Reality::Real), reals);
    if certified == 1442 {
        assert_eq!(of(Reality::RealCurve) as u64, curves);
    }
    assert_eq!(not_proved_distinct(&proofs), Vec::<[usize; 2]>::new());
    // Moved by a part in a thousand they are no solutions, and no proof takes them for some.
    for class in answer.classes.iter().step_by(7) {
        let moved = class.solution.in_other_units(Complex::new(1.001, 0.0), Complex::new(1.001, 0.0));
        assert!(check(&answer.target, &moved, 1e-5).is_err());
    }
}

#[test]
fn problem_three_of_1992_has_1442_classes_and_64_real_ones() {
    holds_the_stored_solution("wms3", 64, 1442);
}

#[test]
fn random_points_have_1442_classes_and_the_stored_real_ones() {
    holds_the_stored_solution("gaussian", 8, 1441);
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

fn proofs(of: &Solved) -> Vec<Certificate> {
    let solutions: Vec<Solution> = of.classes.iter().map(|class| class.solution).collect();
    certify_all(&of.target, &solutions).into_iter().flatten().collect()
}

/// Says that the target is special, lists only what is proved, and proves that all of it is distinct.
fn is_special(points: [Complex; 9]) -> usize {
    let answer = solved(points);
    adds_up(&answer.census);
    assert_eq!(answer.census.failed, 0, "{:?}", answer.census);
    let isolated = answer.census.distinct;
    assert_eq!(answer.completeness(), Completeness::NonGeneric { isolated });
    let proofs = proofs(&answer);
    assert_eq!(proofs.len(), isolated);
    assert_eq!(not_proved_distinct(&proofs), Vec::<[usize; 2]>::new());
    isolated
}

#[test]
fn points_on_a_circle_or_a_line_have_no_isolated_solution() {
    // A coupler curve that is no circle meets a circle in six points at most, and a line as well.
    let on_a_circle =
        std::array::from_fn(|j| Complex::from_polar(1.0, 0.5 * j as f64 + 0.1 * (j as f64).sin()));
    assert_eq!(is_special(on_a_circle), 0);
    let on_a_line = std::array::from_fn(|j| Complex::new(j as f64 + 0.3 * (j as f64).sin(), 0.0));
    assert_eq!(is_special(on_a_line), 0);
}

#[test]
fn mirror_symmetric_points_have_fewer_isolated_solutions() {
    let symmetric =
        [(-4.0, 2.0), (-3.0, 1.7), (-2.0, 0.4), (-1.0, 0.9), (0.0, 0.3)].map(|(x, y)| Complex::new(x, y));
    let points = std::array::from_fn(|j| if j < 5 { symmetric[j] } else { -symmetric[8 - j].conj() });
    assert!((1300..1442).contains(&is_special(points)));
}

#[test]
fn nine_points_of_an_ellipse_have_fewer_isolated_solutions() {
    // Acharyya and Mandal's, without the tenth, which is the first.
    let points = [
        (20.0, 10.0),
        (17.66, 15.142),
        (11.736, 17.878),
        (5.0, 16.928),
        (0.60307, 12.736),
        (0.60307, 7.2638),
        (5.0, 3.0718),
        (11.736, 2.1215),
        (17.66, 4.8577),
    ];
    // Rounded to five digits they lie only nearly on an ellipse. A few paths stay together; that is not called complete.
    let rounded = solved(points.map(|(x, y)| Complex::new(x, y)));
    adds_up(&rounded.census);
    let missing = 1442 - rounded.census.distinct;
    assert!(missing <= 8, "{:?}", rounded.census);
    assert_eq!(rounded.completeness() == Completeness::Complete, missing == 0);
    let exact = std::array::from_fn(|j| {
        let angle = std::f64::consts::TAU * j as f64 / 9.0;
        Complex::new(10.0 + 10.0 * angle.cos(), 10.0 + 8.0 * angle.sin())
    });
    assert!((1200..1442).contains(&is_special(exact)));
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
