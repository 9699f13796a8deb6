//! Fixed pivots on lines and at points: the search holds them, exactly where enough freedom is left, and a record says how far off
//! they are.

use crate::common::parse;
use crate::motion::{ALONE, assert_true, problem, solved};
use crate::poses::{taken, wide};
use linkwright::internals::judge::rank::is_exact;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::results::Figure;
use linkwright::spec::ProblemSpec;
use linkwright::{Candidate, Problem, Record};
use std::f64::consts::PI;

/// Two points of a line through a place, slanted.
fn line(draws: &mut Stream, place: Complex, size: f64) -> [[f64; 2]; 2] {
    let along = Complex::from_polar(1.0, uniform(draws, -PI, PI));
    let points = [uniform(draws, -2.0, -0.5), uniform(draws, 0.5, 2.0)].map(|s| place + along * (s * size));
    points.map(|p| [p.re, p.im])
}

/// The distance of a place from a line through two points, by the area of the triangle.
fn off(place: Complex, [[x0, y0], [x1, y1]]: [[f64; 2]; 2]) -> f64 {
    ((x1 - x0) * (place.im - y0) - (y1 - y0) * (place.re - x0)).abs() / (x1 - x0).hypot(y1 - y0)
}

/// The value of the requirement in a record, and whether it is met.
fn recorded(candidate: &Candidate) -> (f64, bool) {
    let row = candidate.requirements.iter().find(|row| row.name == "pivot_on").expect("it is asked for");
    let Figure::Number(value) = row.value else { panic!("{:?}", row.value) };
    assert_eq!(row.limit, Figure::Number(0.0));
    (value, row.met)
}

#[test]
fn poses_of_random_linkages_are_met_exactly_with_the_pivots_on_lines_through_their_own() {
    let draws = &mut stream(131, 0);
    let mut missed = Vec::new();
    for case in 0..24 {
        let n = [3, 4, 5][case % 3];
        let taken = taken(draws, n, 0.0);
        let size = taken.poses.iter().map(|(p, _)| (p - taken.poses[0].0).norm()).fold(0.0, f64::max);
        let far = 6.0 * (size + taken.linkage.longest_link());
        let [a, b] =
            [taken.linkage.crank_pivot(), taken.linkage.follower_pivot()].map(|g| line(draws, g, size));
        // Four and three poses leave room for both lines, five for none: there its own pivots are the only ones known.
        let lines = match case / 3 % 3 {
            0 => format!("A = {a:?}"),
            1 => format!("B = {b:?}"),
            _ => format!("A = {a:?}, B = {b:?}"),
        };
        let text = format!(
            "{}[require]\nlink_ratio_max = 100\npivot_on = {{ {lines} }}\norder = \"any\"\n{ALONE}",
            wide(taken.poses[0].0, far)
        );
        let record = solved(problem(&taken.poses, &text));
        assert_true(&record);
        let best = &record.candidates[0];
        let (value, met) = recorded(best);
        for (name, pivot, line) in [
            ("A", best.linkage.four_bar().expect("a four-bar").crank_pivot(), a),
            ("B", best.linkage.four_bar().expect("a four-bar").follower_pivot(), b),
        ] {
            if lines.contains(name) {
                assert!(off(pivot, line) <= value + 1e-12 * far, "case {case}: {} {value}", off(pivot, line));
            }
        }
        let checked = Problem::new(record.problem.resolved.clone()).expect("a problem");
        if !(best.accepted && met && value < 1e-9 * far && is_exact(&checked, best)) {
            missed.push((case, best.error.rms / size, value));
        }
    }
    assert!(missed.len() <= 2, "{missed:?}");
}

#[test]
fn eight_poses_with_noise_are_approached_as_nearly_as_the_line_allows() {
    let draws = &mut stream(132, 0);
    for case in 0..4 {
        let taken = taken(draws, 8, 0.01);
        let size = taken.poses.iter().map(|(p, _)| (p - taken.poses[0].0).norm()).fold(0.0, f64::max);
        let a = line(draws, taken.linkage.crank_pivot(), size);
        let bounds = wide(taken.poses[0].0, 6.0 * (size + taken.linkage.longest_link()));
        let of = |more: &str, seed: u64| {
            let lines = format!(
                "{bounds}[require]\nlink_ratio_max = 100\n{more}order = \"any\"\n{ALONE}seed = {seed}\n"
            );
            let record = solved(problem(&taken.poses, &lines));
            assert_true(&record);
            record.candidates[0].clone()
        };
        let without = of("", 1);
        let with = [1, 2].map(|seed| of(&format!("pivot_on = {{ A = {a:?} }}\n"), seed));
        for held in &with {
            assert!(held.accepted && recorded(held).0 < 1e-9 * size, "case {case}");
            assert!(held.error.objective >= without.error.objective * (1.0 - 1e-6), "case {case}");
        }
        let [one, other] = with.map(|held| held.error.objective);
        assert!((one - other).abs() <= 1e-4 * one, "case {case}: {one} {other}");
    }
}

/// A path with timing or without, and these lines.
fn path(timed: bool, lines: &str) -> Record {
    let timing = if timed { "[task.path.timing]\ncrank_deg = [0, 40, 80, 120, 160, 200]\n" } else { "" };
    let text = format!(
        "format = 1\n[task.path]\npoints = [[0, 0], [2, 1.5], [4, 2], [6, 1.8], [8, 1], [9, -0.5]]\n{timing}\
         [require]\ntransmission_deg_min = 25\n{lines}\n{ALONE}"
    );
    let record = solved(parse(&text).spec);
    assert_eq!(verify(&record).expect("a record"), []);
    record
}

#[test]
fn paths_hold_lines_and_points_too() {
    for timed in [false, true] {
        let free = path(timed, "");
        for (lines, a, b) in [
            ("A = [[0, -3], [5, -4]]", Some([[0.0, -3.0], [5.0, -4.0]]), None),
            ("B = [[9, -4], [9, 3]]", None, Some([[9.0, -4.0], [9.0, 3.0]])),
            ("A = [[1, -3]], B = [[7, -5], [9, -2]]", None, Some([[7.0, -5.0], [9.0, -2.0]])),
        ] {
            let record = path(timed, &format!("pivot_on = {{ {lines} }}"));
            let best = &record.candidates[0];
            let (value, met) = recorded(best);
            assert!(best.accepted && met && value < 1e-9, "{timed} {lines}: {value}");
            assert!(a.is_none_or(|line| off(best.linkage.crank_pivot(), line) < 1e-9));
            assert!(
                b.is_none_or(
                    |line| off(best.linkage.four_bar().expect("a four-bar").follower_pivot(), line) < 1e-9
                )
            );
            if lines.contains("[[1, -3]]") {
                assert!((best.linkage.crank_pivot() - Complex::new(1.0, -3.0)).norm() < 1e-12);
            }
            let floor = 1e-12;
            assert!(best.error.objective + floor >= free.candidates[0].error.objective * (1.0 - 1e-6));
        }
    }
}

/// Returns a problem of three poses with these requirements.
fn three_poses(require: &str) -> ProblemSpec {
    let poses = [(0.0, 0.0, 0.0), (20.0, 10.0, 0.3), (40.0, 12.0, 0.6)];
    let poses = poses.map(|(x, y, angle)| (Complex::new(x, y), angle));
    let rest = format!("tolerance = 1\n[require]\n{require}\n[solve]\ncandidates = 1\nevaluations = 20000\n");
    problem(&poses, &rest)
}

#[test]
fn a_pivot_off_its_line_is_found_out() {
    let mut record = solved(three_poses("pivot_on = { A = [[0, -20], [40, -30]] }"));
    assert_true(&record);
    assert!(record.candidates[0].accepted);
    let row = |record: &mut Record| {
        let rows = &mut record.candidates[0].requirements;
        rows.iter().position(|row| row.name == "pivot_on").expect("it is asked for")
    };
    let at = row(&mut record);
    record.candidates[0].requirements[at].value = Figure::Number(0.5);
    let mismatches = verify(&record).expect("a record");
    assert!(mismatches.iter().any(|m| m.to_string().contains("pivot_on")), "{mismatches:?}");
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_line_that_no_link_reaches_the_body_from_is_named() {
    let spec =
        three_poses("pivot_on = { A = [[-60, 150], [90, 160]] }\nextent_max = 90\nlink_ratio_max = 50");
    let record = solved(spec);
    assert_true(&record);
    assert!(!record.candidates.iter().any(|candidate| candidate.accepted));
    let conflict = record.conflict.expect("something is in the way");
    assert!(conflict.among.iter().any(|key| key == "require.pivot_on"), "{:?}", conflict.among);
}
