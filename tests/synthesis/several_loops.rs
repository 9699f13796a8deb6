//! Six-bars and eight-bars from problem files: found, judged, recorded, verified, offered, and refused where they are not searched for.

use crate::common::thorough::cases;
use crate::common::{bytes, load, parse, root, run_on};
use linkwright::internals::files::linkage_file::parse_crank_linkage;
use linkwright::internals::files::problem_file;
use linkwright::internals::judge::certificate::Subject;
use linkwright::internals::judge::practicality::layers::layering;
use linkwright::internals::judge::practicality::{Build, Sweep};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{CrankLinkage, LinkageKind, MultiLoop};
use linkwright::internals::record::{Candidate, Pick, Record, WarningKind};
use linkwright::internals::report::Colour;
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::svg::candidate_svg;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::synthesis::snap::Length;
use linkwright::internals::task::{Defect, Problem};
use std::f64::consts::TAU;

/// A problem of the heart, closed, with these lines after the points.
fn heart(design: &str, require: &str, more: &str) -> String {
    let file = root().join("problems/literature/shapes/heart.csv");
    let text = std::fs::read_to_string(file).expect("it is there");
    let rows: Vec<&str> =
        text.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit() || c == '-')).collect();
    let points: Vec<String> = rows.iter().step_by(3).map(|row| format!("[{row}]")).collect();
    format!(
        "format = 1\n[task.path]\npoints = [{}]\nclosed = true\n{more}\n[design]\n{design}\n[require]\n{require}\n\
         [solve]\nevaluations = 40000\n",
        points.join(", ")
    )
}

fn multi_loop(record: &Record, index: usize) -> MultiLoop {
    *record.candidates[index].linkage.multi_loop().expect("a six-bar")
}

const SIX_BAR: &str = "mechanism = \"six-bar\"";

#[test]
fn a_six_bar_draws_the_heart_within_its_limits_and_its_record_verifies() {
    let require = "transmission_deg_min = 30\npivots_in = [-2, -2, 2, 1]\nfootprint_in = [-2.3, -2.3, 2.3, 1.8]\nextent_max = 5.5";
    let record = run_on(2, parse(&heart(SIX_BAR, require, "")));
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.rms < 0.06, "{}", best.error.rms);
    assert_eq!(best.linkage.kind(), LinkageKind::SixBar);
    assert_eq!(verify(&record).expect("a record"), []);
    assert!(record.evaluations.objective <= 40_000 + record.picks.as_ref().expect("picks").evaluations);
    // Every joint stays in its box, at positions that no search looked at.
    let linkage = multi_loop(&record, 0);
    for i in 0..3000 {
        let bodies = linkage.bodies(TAU * f64::from(i) / 3000.0).expect("it turns fully");
        for p in linkage.moving(&bodies).chain(linkage.pivots()) {
            assert!(p.re.abs() <= 2.3 + 1e-6 && (-2.3 - 1e-6..=1.8 + 1e-6).contains(&p.im), "{p}");
        }
    }
    // The record reads back, and holds a sign for each dyad at each point.
    let text = bytes(&record);
    let read: Record = serde_json::from_str(&text).expect("it was written");
    assert_eq!(bytes(&read), text);
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let first = &value["candidates"][0];
    assert_eq!(first["linkage"]["kind"], "six-bar");
    assert_eq!(first["t1_at"][7].as_array().map(Vec::len), Some(2));
    // What a person sees.
    let table = candidates_table(&record, Colour::Never);
    assert!(table.contains("six-bar") && table.contains("crank A-C"), "{table}");
    assert!(report_html(&record, 0).contains("\"track\""));
    let drawing = candidate_svg(&record, 0);
    assert!(drawing.contains(">F2<") && drawing.contains(">X2<"));
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let evaluations = format!("evaluations = {}", cases(15_000, 40_000));
    let text = heart(SIX_BAR, "transmission_deg_min = 25", "").replace("evaluations = 40000", &evaluations);
    let of = |threads| bytes(&run_on(threads, parse(&text)));
    assert_eq!(of(1), of(3));
}

#[test]
fn the_crank_turns_in_the_sense_that_is_asked_for() {
    for (sense, sign) in [("ccw", 1.0), ("cw", -1.0)] {
        let require = format!("transmission_deg_min = 20\ndirection = \"{sense}\"");
        let record = run_on(2, parse(&heart(SIX_BAR, &require, "")));
        let best = &record.candidates[0];
        assert!(best.accepted && best.error.rms < 0.09, "{sense}: {}", best.error.rms);
        let turned = best.crank_deg[best.crank_deg.len() - 1] - best.crank_deg[0];
        assert!(turned * sign > 180.0 && turned.abs() <= 360.0, "{sense}: {turned}");
        assert_eq!(verify(&record).expect("a record"), []);
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_further_dyad_is_searched_for_where_the_tolerance_asks_for_it() {
    let kinds = "mechanism = [\"four-bar\", \"six-bar\", \"eight-bar\"]";
    let run = |tolerance: f64| {
        let text = heart(kinds, "transmission_deg_min = 20", &format!("tolerance = {tolerance}"));
        run_on(2, parse(&text.replace("evaluations = 40000", "evaluations = 90000")))
    };
    let loose = run(0.6);
    assert!(loose.candidates[0].accepted && loose.candidates.iter().all(|c| c.linkage.four_bar().is_some()));
    assert_eq!(loose.of_kinds.iter().map(|best| best.kind).collect::<Vec<_>>(), [LinkageKind::FourBar]);
    assert!(candidates_table(&loose, Colour::Never).contains("not needed: six-bar, eight-bar"));
    let tight = run(0.12);
    let best = &tight.candidates[0];
    assert!(best.accepted && best.linkage.four_bar().is_none(), "{:?}", tight.of_kinds);
    let four_bar = tight.of_kinds.iter().find(|one| one.kind == LinkageKind::FourBar).expect("one");
    assert!(!four_bar.accepted && four_bar.max > 0.12);
    for record in [&loose, &tight] {
        assert_eq!(verify(record).expect("a record"), []);
    }
}

#[test]
fn a_six_bar_is_offered_where_no_four_bar_keeps_the_tolerance() {
    let text = heart("", "transmission_deg_min = 20", "tolerance = 0.12");
    let evaluations = format!("evaluations = {}", cases(6_000, 40_000));
    let record = run_on(2, parse(&text.replace("evaluations = 40000", &evaluations)));
    assert!(record.candidates.iter().all(|c| !c.accepted));
    let other = record.pick(Pick::OtherKind).expect("a six-bar");
    assert!(other.accepted && other.error.max <= 0.12 && other.linkage.multi_loop().is_some());
    assert_eq!(verify(&record).expect("a record"), []);
    let table = candidates_table(&record, Colour::Never);
    assert!(table.contains("design.mechanism=") && table.contains("linkage-other-kind.toml"), "{table}");
    // A record that claims it where a candidate is accepted is not true.
    let mut untrue = record.clone();
    untrue.problem.resolved.task.tolerance = None;
    assert!(!verify(&untrue).expect("a record").is_empty());
}

#[test]
fn records_of_six_bars_that_were_changed_do_not_verify() {
    let record = run_on(2, parse(&heart(SIX_BAR, "transmission_deg_min = 30", "")));
    let changed = |change: &dyn Fn(&mut Record)| {
        let mut other = record.clone();
        change(&mut other);
        verify(&other).map(|found| found.len()).unwrap_or(1)
    };
    let with = |record: &mut Record, from: &str, to: &str| {
        let text = bytes(record).replacen(from, to, 1);
        *record = serde_json::from_str(&text).expect("it reads");
    };
    let length = format!("\"length\": {:?}", multi_loop(&record, 0).crank());
    let longer = format!("\"length\": {:?}", multi_loop(&record, 0).crank() * 1.0001);
    assert!(changed(&|r| with(r, &length, &longer)) > 0);
    assert!(changed(&|r| r.candidates[0].crank_deg[3] += 0.01) > 0);
    assert!(changed(&|r| r.candidates[0].transmission_deg.min += 0.01) > 0);
    assert!(changed(&|r| r.candidates[0].link_ratio *= 1.001) > 0);
    assert!(changed(&|r| r.candidates[0].defects.push(Defect::Order { at: vec![3] })) > 0);
    assert_eq!(changed(&|_| ()), 0);
}

#[test]
fn what_six_bars_are_not_searched_for_is_refused_with_a_remedy() {
    let said = |text: &str| match problem_file::parse("it.toml", text, None, &[]) {
        Ok(_) => panic!("it is refused"),
        Err(diagnostic) => diagnostic.to_string(),
    };
    let plain = heart(SIX_BAR, "", "");
    for (change, to, message) in [
        ("[require]", "[task.path.timing]\ncrank_deg = [0]\n[require]", "crank_deg"),
        ("evaluations = 40000", "method = \"genetic\"", "least squares alone"),
        ("evaluations = 40000", "objective = \"max-deviation\"", "not by the largest deviation"),
        ("[require]", "[require]\norder = \"any\"", "in their order alone"),
        ("[require]", "[require]\ntype = [\"crank-rocker\"]", "type is about four-bars"),
        (SIX_BAR, "mechanism = \"six-bar\"\nc = [1, 2]", "c bounds nothing of a six-bar"),
        (SIX_BAR, "mechanism = \"six-bar\"\nA = [0, 0]", "A is fixed"),
        (SIX_BAR, "mechanism = \"seven-bar\"", "\"seven-bar\" is not known"),
    ] {
        let text = said(&plain.replacen(change, to, 1));
        assert!(text.contains(message), "{message}: {text}");
    }
    let chain = "format = 1\n[chain]\n[chain.pivots]\nA = [0, 0]\n[chain.crank]\npivot = \"A\"\njoint = \"C\"\nlength = 1\n";
    let text = parse_crank_linkage("it.toml", chain).expect_err("no six-bar").to_string();
    assert!(text.contains("a six-bar has two dyads"), "{text}");
}

#[test]
fn a_shipped_problem_of_a_letter_is_met() {
    let file = load(&root().join("problems/shapes/letter-D.toml"), &[("solve.evaluations", "60000")]);
    let record = run_on(2, file);
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.rms_over_size < 0.01, "{}", best.error.rms_over_size);
    assert!(matches!(best.linkage, CrankLinkage::MultiLoop(_)));
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn plates_that_cannot_be_stacked_are_told_and_the_best_that_can_is_named() {
    let stacks = |candidate: &Candidate| !candidate.warnings.iter().any(|w| w.kind == WarningKind::Stacking);
    let (mut can, mut cannot) = (0, 0);
    for shape in ["letter-K", "arrow"] {
        let file = root().join(format!("problems/shapes/{shape}.toml"));
        let record = run_on(2, load(&file, &[("solve.evaluations", "40000")]));
        let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
        let pick = record.pick(Pick::Buildable).expect("one that can be stacked");
        assert!(!stacks(&record.candidates[0]) && pick.accepted && pick.warnings.is_empty(), "{shape}");
        for candidate in record.candidates.iter().chain([pick]) {
            let sweep = Sweep::of_candidate(&problem, candidate).expect("it closes");
            let hole = Build::usual_hole_of(&sweep, None).expect("there is room");
            let found = layering(&sweep, &Build::new(hole, hole)).expect("it closes");
            assert_eq!(stacks(candidate), found.stack.is_some(), "{shape} {}", candidate.rank);
            *(if stacks(candidate) { &mut can } else { &mut cannot }) += 1;
        }
        let table = candidates_table(&record, Colour::Never);
        assert!(table.contains("cannot be stacked") && table.contains("buildable"), "{table}");
        assert_eq!(verify(&record).expect("a record"), []);
    }
    assert!(can > 1 && cannot > 5, "{can} can, {cannot} cannot");
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_stroke_with_a_dwell_is_drawn_at_the_given_crank_angles() {
    let more = [("solve.evaluations", "60000"), ("design.mechanism", "[\"six-bar\"]")];
    let file = root().join("problems/examples/dwell-stroke.toml");
    let record = run_on(2, load(&file, &more));
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.max <= 4.0, "{}", best.error.max);
    assert!(best.crank_deg.windows(2).all(|pair| ((pair[1] - pair[0]).abs() - 5.0).abs() < 1e-9));
    assert_eq!(verify(&record).expect("a record"), []);
    // The errors that are told are those at these angles.
    let (linkage, task) = (multi_loop(&record, 0), &record.problem.resolved.task);
    let points = &task.points;
    let mut sum_sq = 0.0;
    for (deg, [x, y]) in best.crank_deg.iter().zip(points.iter()) {
        let p = linkage.point_at(deg.to_radians()).expect("it turns fully");
        sum_sq += (p.re - x).powi(2) + (p.im - y).powi(2);
    }
    let rms = (sum_sq / points.len() as f64).sqrt();
    assert!((rms - best.error.rms).abs() < 1e-9, "{rms} {}", best.error.rms);
    assert_eq!(bytes(&record), bytes(&run_on(1, load(&file, &more))));
}

/// A problem of Watt's six-bar: its points at these crank angles from the first, mirrored if asked for.
fn of_watts(angles: &[f64], closed: bool, mirrored: bool, require: &str) -> String {
    let file = root().join("problems/linkages/watt-six-bar.toml");
    let text = std::fs::read_to_string(file).expect("it is there");
    let read = parse_crank_linkage("watt-six-bar.toml", &text).expect("a linkage");
    let linkage = *read.linkage.multi_loop().expect("a six-bar");
    let at = |deg: &f64| {
        let p = linkage.point_at((40.0 + deg).to_radians()).expect("it turns fully");
        format!("[{}, {}]", p.re, if mirrored { -p.im } else { p.im })
    };
    let points: Vec<String> = angles.iter().map(at).collect();
    let written: Vec<String> = angles.iter().map(f64::to_string).collect();
    format!(
        "format = 1\n[task.path]\npoints = [{}]\nclosed = {closed}\n[task.path.timing]\ncrank_deg = [{}]\n[design]\n\
         {SIX_BAR}\n[require]\n{require}\n[solve]\nevaluations = 80000\n",
        points.join(", "),
        written.join(", ")
    )
}

#[test]
fn a_crank_that_goes_to_and_fro_and_ends_where_it_began_is_timed_at_every_point() {
    let there: Vec<f64> = (0..12).map(|i| 14.0 * f64::from(i)).collect();
    let angles: Vec<f64> = there.iter().chain(there.iter().rev().skip(1)).copied().collect();
    for mirrored in [true, false].into_iter().take(cases(1, 2)) {
        let require = "longest_max = 200\nfootprint_in = [-60, -120, 130, 120]";
        let record = run_on(2, parse(&of_watts(&angles, false, mirrored, require)));
        let best = &record.candidates[0];
        assert_eq!(best.crank_deg.len(), angles.len());
        assert!(best.error.rms < 1e-3, "{} {mirrored}", best.error.rms);
        assert_eq!(verify(&record).expect("a record"), []);
        // A timed record is snapped as any other, without the bounds of a four-bar's lengths.
        let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
        let length = Length::named("X2F2").expect("a length");
        let limits = length.limits(&problem.spec().design, &best.linkage);
        assert_eq!((limits.0, limits.1), (0.0, f64::INFINITY));
        assert_eq!(Length::Ground.limits(&problem.spec().design, &best.linkage), limits);
    }
}

#[test]
fn what_is_proved_of_four_bars_is_not_said_of_a_six_bar() {
    let angles: Vec<f64> = (0..12).map(|i| 30.0 * f64::from(i)).collect();
    let record = run_on(2, parse(&of_watts(&angles, true, false, "longest_max = 200")));
    let refused = Subject::new(&record, 1e-3).expect_err("a six-bar");
    assert!(refused.to_string().contains("a six-bar: the proof covers four-bars"), "{refused}");
}
