//! Linkages with a slider under what goes beyond least squares: exact targets, tolerances, the largest deviation, crank angles of
//! which some are free, free ranges of functions; and the cognates of slider-cranks.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::motion::{ALONE, solved};
use crate::sliders::{inverted, slider_crank};
use linkwright::internals::judge::rank::is_exact;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{CrankLinkage, LinkageKind, SliderLinkage};
use linkwright::internals::record::{Candidate, Record};
use linkwright::internals::synthesis::nearest::nearest_positions;
use linkwright::internals::task::Problem;
use std::f64::consts::TAU;

const KINDS: [&str; 2] = ["slider-crank", "inverted-slider-crank"];

/// The best answer of a problem's text, its record verified.
fn best(text: &str) -> (Record, Candidate) {
    let record = solved(parse(text).spec);
    assert_eq!(verify(&record).expect("a record"), [], "{text}");
    let best = record.candidates.first().expect("a candidate").clone();
    (record, best)
}

/// The deviations of P from points, in their order.
fn deviations(candidate: &Candidate, points: &[[f64; 2]]) -> Vec<f64> {
    let at = points.iter().zip(&candidate.crank_deg).zip(&candidate.t1_at);
    at.map(|(([x, y], deg), t1)| {
        let at = candidate.linkage.joints_with(deg.to_radians(), *t1).expect("it closes").joints;
        (at.coupler_point.re - x).hypot(at.coupler_point.im - y)
    })
    .collect()
}

const ARC: [[f64; 2]; 7] =
    [[0.0, 0.0], [20.0, 14.0], [40.0, 21.0], [60.0, 25.0], [80.0, 21.0], [100.0, 12.0], [120.0, 0.0]];

/// Returns the kinds that a test looks at: one of them every day, all with `THOROUGH=1`.
fn kinds(of_every_day: usize) -> &'static [&'static str] {
    cases(&KINDS[of_every_day..=of_every_day], &KINDS[..])
}

#[test]
fn poses_are_met_exactly_where_they_have_to_be() {
    for kind in kinds(0) {
        let text = format!(
            "format = 1\n[task.motion]\nposes = [[0, 0, 0], [10, 12, 12], [22, 20, 31], [38, 22, 49], [55, 18, 66], \
             [70, 8, 80]]\nexact = [0, 5]\n[design]\nmechanism = \"{kind}\"\n{ALONE}"
        );
        let (_, best) = best(&text);
        assert!(best.accepted, "{kind}");
        let points = [[0.0, 0.0], [10.0, 12.0], [22.0, 20.0], [38.0, 22.0], [55.0, 18.0], [70.0, 8.0]];
        let off = deviations(&best, &points);
        assert!(off[0] < 1e-6 && off[5] < 1e-6, "{kind}: {off:?}");
        // The body's angle turns from the first to the last as it has to.
        let turned = |j: usize| {
            let at =
                best.linkage.joints_with(best.crank_deg[j].to_radians(), best.t1_at[j]).expect("it closes");
            at.coupler.arg()
        };
        let off = (turned(5) - turned(0)).to_degrees() - 80.0;
        assert!((off + 180.0).rem_euclid(360.0) - 180.0 < 1e-6, "{kind}: {off}");
    }
}

#[test]
fn the_ends_of_a_path_are_met_exactly_and_the_rest_within_its_tolerances() {
    for kind in kinds(1) {
        let text = format!(
            "format = 1\n[task.path]\npoints = {ARC:?}\ntolerance = [0, 4, 4, 4, 4, 4, 0]\n[design]\n\
             mechanism = \"{kind}\"\n{ALONE}"
        );
        let (_, best) = best(&text);
        let off = deviations(&best, &ARC);
        assert!(best.accepted && off[0] < 1e-6 && off[6] < 1e-6, "{kind}: {off:?}");
        assert!(off.iter().all(|off| *off < 4.0), "{kind}: {off:?}");
    }
}

/// A closed path that neither kind draws exactly.
fn rounded_triangle() -> Vec<[f64; 2]> {
    let at = |j: i32| {
        let (sin, cos) = (TAU * f64::from(j) / 30.0).sin_cos();
        let radius = 40.0 + 8.0 * (3.0 * TAU * f64::from(j) / 30.0).cos();
        [radius * cos, 0.7 * radius * sin]
    };
    (0..30).map(at).collect()
}

#[test]
fn the_largest_deviation_is_smaller_than_that_of_least_squares_and_many_points_share_it() {
    let points = rounded_triangle();
    for kind in kinds(0) {
        let with = |more: &str| {
            best(&format!(
                "format = 1\n[task.path]\nclosed = true\npoints = {points:?}\n{more}[design]\nmechanism = \"{kind}\"\n{ALONE}"
            ))
            .1
        };
        let squares = with("");
        let text = format!(
            "format = 1\n[task.path]\nclosed = true\npoints = {points:?}\n[design]\nmechanism = \"{kind}\"\n[solve]\n\
             objective = \"max-deviation\"\ncandidates = 1\nadvice = false\n"
        );
        let (record, least) = best(&text);
        assert!(least.accepted && record.repeats.is_none(), "{kind}");
        let largest = least.error.max;
        assert!(largest < 0.97 * squares.error.max, "{kind}: {largest} {}", squares.error.max);
        let off = deviations(&least, &points);
        let at_it = off.iter().filter(|off| **off > largest * (1.0 - 1e-6)).count();
        assert!(at_it >= 5, "{kind}: {at_it} of {off:?}");
        // A tolerance between the two is met by the polish alone.
        let between = 0.5 * (largest + squares.error.max);
        let within = with(&format!("tolerance = {between}\n"));
        assert!(within.accepted && within.error.max <= between, "{kind}: {} {between}", within.error.max);
        assert!(within.error.rms < least.error.rms * (1.0 + 1e-9), "{kind}");
    }
}

/// The crank angles of a known linkage at some targets of a path, of which those in `free` are not told.
fn partly_timed(linkage: &CrankLinkage, degrees: &[f64], free: &[usize]) -> String {
    let point = |deg: &f64| {
        let at = linkage.joints_with(deg.to_radians(), linkage.assembly()).expect("it closes").joints;
        [at.coupler_point.re, at.coupler_point.im]
    };
    let points: Vec<[f64; 2]> = degrees.iter().map(point).collect();
    let angle = |(j, deg): (usize, &f64)| match free.contains(&j) {
        true => "\"free\"".to_owned(),
        false => format!("{:?}", deg - degrees[0]),
    };
    let angles: Vec<String> = degrees.iter().enumerate().map(angle).collect();
    format!(
        "format = 1\n[task.path]\npoints = {points:?}\n[task.path.timing]\ncrank_deg = [{}]\n[design]\nmechanism = \"{}\"\n{ALONE}",
        angles.join(", "),
        linkage.kind()
    )
}

#[test]
fn free_crank_angles_among_prescribed_ones_are_found() {
    let degrees: Vec<f64> = (0..14).map(|j| 20.0 + 21.0 * f64::from(j) + f64::from(j % 3)).collect();
    for linkage in [slider_crank(), inverted()] {
        let text = partly_timed(&linkage, &degrees, &[3, 4, 9, 13]);
        let (record, best) = best(&text);
        let kind = linkage.kind();
        assert!(best.accepted && best.error.rms_over_size < 1e-10, "{kind}: {}", best.error.rms);
        // The turns of the crank are those of the linkage that the points were made of, also where they were free.
        for (found, made) in best.crank_deg.iter().zip(&degrees) {
            let off = (found - best.crank_deg[0]).abs() - (made - degrees[0]);
            assert!(off.abs() < 1e-6, "{kind}: {off}");
        }
        let problem = Problem::new(record.problem.resolved).expect("a problem");
        let (crank_deg, _) = nearest_positions(&problem, best.linkage).expect("it closes");
        for (found, nearest) in best.crank_deg.iter().zip(&crank_deg) {
            assert!((found - nearest).abs() < 1e-3, "{kind}: {found} {nearest}");
        }
    }
}

#[test]
fn functions_are_found_again_from_the_proportions_of_their_pairs() {
    let classes = [
        (LinkageKind::SliderCrank, "output", [1.7, 1.0], "input_range_deg = [10, 360]\n"),
        (LinkageKind::InvertedSliderCrank, "output_deg", [1.0, 0.6], "output_range_deg = [5, 180]\n"),
        (
            LinkageKind::InvertedSliderCrank,
            "output_deg",
            [0.7, 1.4],
            "input_range_deg = [10, 360]\noutput_range_deg = [5, 180]\n",
        ),
    ];
    for (kind, key, scales, free) in classes {
        let linkage = if kind == LinkageKind::SliderCrank { slider_crank() } else { inverted() };
        let measure = |deg: f64| {
            let at = linkage.joints_with(deg.to_radians(), linkage.assembly()).expect("it closes");
            match kind {
                LinkageKind::SliderCrank => linkage.slider_place(&at).expect("a slider"),
                _ => linkage.output_angle(&at).expect("an output link").to_degrees(),
            }
        };
        let degrees: Vec<f64> = (0..13).map(|j| 12.0 * f64::from(j)).collect();
        let inputs: Vec<f64> = degrees.iter().map(|deg| scales[0] * deg).collect();
        let outputs: Vec<f64> =
            degrees.iter().map(|deg| scales[1] * (measure(40.0 + deg) - measure(40.0))).collect();
        let text = format!(
            "format = 1\n[task.function]\ninput_deg = {inputs:?}\n{key} = {outputs:?}\n{free}[design]\n\
             mechanism = \"{kind}\"\n[require]\nlink_ratio_max = 100\n{ALONE}"
        );
        let (record, best) = best(&text);
        let problem = Problem::new(record.problem.resolved).expect("a problem");
        assert!(best.accepted && is_exact(&problem, &best), "{kind} {free}: {}", best.error.rms);
        let range = best.crank_deg[12] - best.crank_deg[0];
        assert_eq!(best.input_range_deg.is_some(), free.contains("input"));
        assert_eq!(best.output_range_deg.is_some(), free.contains("output"));
        if let Some(told) = best.input_range_deg {
            assert!((told - range.abs()).abs() < 1e-9, "{told} {range}");
        }
        assert!((range.abs() - 144.0).abs() < 1e-4, "{kind} {free}: {range}");
    }
}

#[test]
fn a_function_with_a_free_range_has_the_least_largest_deviation() {
    let with = |more: &str| {
        format!(
            "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\ninput_range_deg = [60, 150]\noutput_range = 50\n\
             samples = 31\n[design]\nmechanism = \"slider-crank\"\n[require]\ntransmission_deg_min = 30\n[solve]\n{more}\
             candidates = 1\nadvice = false\n"
        )
    };
    let (_, squares) = best(&with(""));
    let (_, least) = best(&with("objective = \"max-deviation\"\n"));
    assert!(squares.accepted && least.accepted);
    assert!(least.error.max < squares.error.max, "{} {}", least.error.max, squares.error.max);
    assert!(least.error.rms >= squares.error.rms * (1.0 - 1e-9));
}

#[test]
fn a_slider_crank_has_its_cognate_beside_it() {
    let degrees: Vec<f64> = (0..40).map(|j| 9.0 * f64::from(j)).collect();
    let linkage = slider_crank();
    let points: Vec<[f64; 2]> = degrees
        .iter()
        .map(|deg| {
            let at = linkage.joints_with(deg.to_radians(), linkage.assembly()).expect("it closes").joints;
            [at.coupler_point.re, at.coupler_point.im]
        })
        .collect();
    let text = format!(
        "format = 1\n[task.path]\nclosed = true\npoints = {points:?}\n[require]\nbranch = \"any\"\n[design]\n\
         mechanism = \"slider-crank\"\n[solve]\ncandidates = 1\n"
    );
    let (_, best) = best(&text);
    assert!(best.error.rms_over_size < 1e-10);
    let [cognate] = best.alternatives.as_slice() else { panic!("{} cognates", best.alternatives.len()) };
    let (own, other) = (best.linkage.slider_crank(), cognate.linkage.slider_crank());
    let (own, other) = (own.expect("a slider-crank"), other.expect("a slider-crank"));
    let ratio = (own.crank() / own.coupler()) * (other.crank() / other.coupler());
    assert!((ratio - 1.0).abs() < 1e-7, "{ratio}");
    for (([x, y], deg), t1) in points.iter().zip(&cognate.crank_deg).zip(&cognate.t1_at) {
        let at = cognate.linkage.joints_with(deg.to_radians(), *t1).expect("it closes").joints;
        let off = (at.coupler_point.re - x).hypot(at.coupler_point.im - y);
        assert!(off < 1e-6, "{off}");
    }
}

#[test]
fn the_buildable_answer_is_of_a_kind_that_is_asked_for() {
    // The nearest slider-crank of this stride transmits badly.
    let text = "format = 1\n[task.path]\nclosed = true\npoints = [[100, 0], [69, 0], [35, 0], [0, 0], [-35, 0], [-69, 0], \
                [-100, 0], [-117, 4], [-98, 24], [0, 46], [98, 21], [117, 1]]\n[design]\nmechanism = \"slider-crank\"\n";
    let (record, best) = best(text);
    assert!(best.transmission_deg.worst < 10.0);
    let buildable = record.buildable.expect("a buildable answer");
    assert_eq!(buildable.linkage.kind(), LinkageKind::SliderCrank);
    assert!(buildable.transmission_deg.worst >= 10.0 && buildable.warnings.is_empty());
}
