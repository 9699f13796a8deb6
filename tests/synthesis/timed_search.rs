//! Prescribed timing from many seeds, and targets that a known linkage draws.

use crate::common::{literature, parse, run_on};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{AssemblyMode, FourBar, LinkageType, NaturalCoordinates};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::record::{Reason, Record};

fn best(record: &Record) -> f64 {
    record.candidates.first().filter(|c| c.accepted).map_or(f64::INFINITY, |c| c.error.sum_sq)
}

#[test]
fn the_published_problems_are_solved_from_every_seed() {
    let cases = [
        ("k18", 0.009_028_884_7, 60),
        ("k18b", 0.009_911_927_5, 60),
        ("e5", 7.41576e-7, 60),
        ("e5-free", 2.61e-7, 40),
        ("a6", 2.58036, 30),
        ("a6b", 1.4102, 30),
    ];
    for (name, at_most, seeds) in cases {
        for seed in 101..101 + seeds {
            let seed_text = seed.to_string();
            let record = run_on(
                1,
                literature(
                    name,
                    &[
                        ("solve.seed", seed_text.as_str()),
                        ("solve.candidates", "1"),
                        ("solve.advice", "false"),
                    ],
                ),
            );
            assert!(best(&record) <= at_most, "{name}, seed {seed}: {}", best(&record));
            assert_eq!(record.method.used[0], "variable-projection", "{name}");
            assert_eq!(record.termination.reason, Reason::Converged, "{name}, seed {seed}");
        }
    }
}

#[test]
fn the_eighteen_points_take_a_few_thousand_evaluations_and_no_polish() {
    for seed in ["1", "2", "3", "4", "5"] {
        let record = run_on(1, literature("k18", &[("solve.seed", seed), ("solve.candidates", "1")]));
        let for_picks = record.picks.as_ref().map_or(0, |picks| picks.evaluations);
        let searched = record.evaluations.objective - for_picks;
        assert_eq!(record.method.used, ["variable-projection"]);
        // Four batches of 128 draws, in two directions on two assemblies, and their fits.
        assert!((2048..8000).contains(&searched), "{searched}");
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
    }
    let least_squares = run_on(1, literature("k18", &[("solve.method", "least-squares")]));
    assert!(best(&least_squares) <= 0.009_028_884_7);
}

/// A linkage whose links lie between 1 and 4.
fn any_linkage(draws: &mut Stream) -> FourBar {
    let mut number = |low, high| uniform(draws, low, high);
    loop {
        let angle: f64 = number(-3.0, 3.0);
        let ground = number(1.0, 4.0);
        let pivot = [number(-3.0, 3.0), number(-3.0, 3.0)];
        let (coupler, offset) = (number(1.0, 4.0), [number(-2.0, 4.0), number(-3.0, 3.0)]);
        let linkage = FourBar::new(NaturalCoordinates {
            crank_pivot: pivot,
            follower_pivot: [pivot[0] + ground * angle.cos(), pivot[1] + ground * angle.sin()],
            crank: number(1.0, 4.0),
            coupler,
            follower: number(1.0, 4.0),
            crank_side: offset[0].hypot(offset[1]),
            follower_side: (offset[0] - coupler).hypot(offset[1]),
            assembly: if number(-1.0, 1.0) < 0.0 { AssemblyMode::Minus } else { AssemblyMode::Plus },
            side: linkwright::internals::mechanism::CouplerSide::Plus,
        });
        if let Ok(linkage) = linkage {
            return linkage;
        }
    }
}

/// The problem of the points that a linkage passes at these crank angles (degrees from what the offset says).
fn drawn_by(linkage: &FourBar, from_deg: f64, step_deg: f64, n: usize, offset: &str) -> Option<String> {
    let base = match offset {
        "ground" => linkage.ground_angle().to_degrees(),
        _ => 0.0,
    };
    let angles: Vec<f64> = (0..n).map(|i| from_deg + step_deg * i as f64).collect();
    let mut points = Vec::new();
    // The way between the points has to be open as well.
    for i in 0..=(8 * (n - 1)) {
        let deg = from_deg + step_deg * i as f64 / 8.0;
        let joints = linkage.position((base + deg).to_radians()).joints()?;
        if i % 8 == 0 {
            points.push(format!("[{:?}, {:?}]", joints.coupler_point.re, joints.coupler_point.im));
        }
    }
    Some(format!(
        "format = 1\n[task.path]\npoints = [{}]\n[task.path.timing]\ncrank_deg = {angles:?}\noffset = \"{offset}\"\n\
         [design]\nA = [[-100, 100], [-100, 100]]\nB = [[-100, 100], [-100, 100]]\na = [0, 100]\nb = [0, 100]\n\
         c = [0, 100]\ncoupler_x = [-100, 100]\ncoupler_y = [-100, 100]\n[require]\nlink_ratio_max = 100\n\
         [solve]\ncandidates = 1\n",
        points.join(", ")
    ))
}

#[test]
fn linkages_of_every_type_are_recovered_from_their_timed_points() {
    let mut draws = stream(21, 0);
    let mut kinds = std::collections::BTreeMap::<LinkageType, (u32, u32)>::new();
    let (mut tried, mut recovered) = (0, 0);
    while tried < 60 {
        let linkage = any_linkage(&mut draws);
        let kind = linkage.linkage_type().expect("its links close");
        let step = if kind.input_turns_fully() { 30.0 } else { 7.0 };
        let from = uniform(&mut draws, -180.0, 180.0);
        let offset = ["free", "fixed", "ground"][tried % 3];
        if kinds.get(&kind).is_some_and(|(seen, _)| *seen >= 20) {
            continue;
        }
        let Some(text) = drawn_by(&linkage, from, step, 11, offset) else { continue };
        tried += 1;
        let record = run_on(1, parse(&text));
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{text}");
        let exact = record.candidates.first().is_some_and(|c| c.accepted && c.error.rms_over_size <= 1e-9);
        let tally = kinds.entry(kind).or_default();
        *tally = (tally.0 + 1, tally.1 + u32::from(exact));
        recovered += usize::from(exact);
    }
    assert!(kinds.len() >= 5, "{kinds:?}");
    assert!(100 * recovered >= 95 * tried, "{recovered} of {tried}: {kinds:?}");
}

#[test]
fn a_problem_without_a_reduced_form_is_still_searched() {
    // Increments only, a ground of given length and free direction: a second angle would be needed.
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [2, 6], [7, 9], [13, 9], [18, 6], [20, 0]]\n\
                [task.path.timing]\ncrank_deg = [0, 30, 60, 90, 120, 150]\n[design]\nground = 20\n";
    let record = run_on(1, parse(text));
    assert_eq!(record.method.used, ["least-squares"]);
    assert!(best(&record).is_finite());
    // Two points: fewer equations than linear unknowns.
    let record = run_on(
        1,
        parse(
            "format = 1\n[task.path]\npoints = [[0, 0], [2, 6]]\n[task.path.timing]\ncrank_deg = [0, 30]\n",
        ),
    );
    assert_eq!(record.method.used, ["least-squares"]);
    assert!(best(&record) < 1e-18);
}
