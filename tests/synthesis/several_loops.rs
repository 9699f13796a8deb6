//! Six-bars and eight-bars from problem files: found, judged, recorded, verified, offered, and refused where they are not searched for.

use crate::common::{bytes, load, parse, root, run_on};
use linkwright::internals::files::linkage_file::parse_crank_linkage;
use linkwright::internals::files::problem_file;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{CrankLinkage, LinkageKind, MultiLoop};
use linkwright::internals::record::{Pick, Record};
use linkwright::internals::report::Colour;
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::svg::candidate_svg;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::task::Defect;
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
    let text = heart(SIX_BAR, "transmission_deg_min = 25", "");
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
    let record = run_on(2, parse(&heart("", "transmission_deg_min = 20", "tolerance = 0.12")));
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
