//! `compare`: ranks, front, differences, units, targets; what it prints and writes; records that are not true.

use crate::common::root;
use crate::corpora::readers::entry;
use crate::report::records::{detail, ellipse, k18};
use assert_cmd::Command;
use linkwright::internals::files::linkage_file;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::numbers::arithmetic::streams::{below, stream, unit};
use linkwright::internals::record::Record;
use linkwright::internals::report::Colour;
use linkwright::internals::report::compare::{
    Entry, Point, SortKey, compare, front, in_one_unit, percent_above,
};
use linkwright::internals::task::spec::Measure;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("linkwright")
        .expect("it is built")
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .args(arguments)
        .output()
        .expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

/// A true record of k18, found by a search of a moment.
fn run(folder: &Path, name: &str, extra: &[&str]) {
    let problem = root().join("problems/literature/k18.toml").display().to_string();
    let mut arguments = vec!["synth", &problem, "--out", name, "--quiet"];
    arguments.extend(extra);
    let (code, _, stderr) = linkwright(folder, &arguments);
    assert_eq!(code, 0, "{stderr}");
}

fn entries(record: &Record) -> Vec<Entry> {
    (0..record.candidates.len())
        .filter_map(|i| entry(&format!("{}:{}", record.problem.name, i + 1), record, i))
        .collect()
}

fn dominates(x: &Point, y: &Point) -> bool {
    let as_good = (x.accepted || !y.accepted) && x.error <= y.error && x.angle >= y.angle && x.size <= y.size;
    let better = (x.accepted && !y.accepted) || x.error < y.error || x.angle > y.angle || x.size < y.size;
    as_good && better
}

#[test]
fn the_front_is_what_brute_force_finds() {
    let mut draws = stream(7, 0);
    for round in 0..300 {
        // Few levels make equals and ties.
        let mut level = |missing: bool| {
            let value = below(&mut draws, 1 + round % 9) as f64;
            if missing && unit(&mut draws) < 0.05 { None } else { Some(value) }
        };
        let points: Vec<Point> = (0..40)
            .map(|_| Point {
                accepted: level(false) != Some(0.0),
                error: level(true),
                angle: level(true),
                size: level(true),
            })
            .collect();
        let whole = |p: &Point| p.error.is_some() && p.angle.is_some() && p.size.is_some();
        let expected: Vec<bool> = points
            .iter()
            .map(|p| whole(p) && !points.iter().any(|other| whole(other) && dominates(other, p)))
            .collect();
        assert_eq!(front(&points), expected, "{points:?}");
        assert!(expected.contains(&true) || !points.iter().any(whole));
    }
    assert!(front(&[]).is_empty());
    let infinite = Point { accepted: true, error: Some(f64::INFINITY), angle: Some(1.0), size: Some(1.0) };
    assert_eq!(front(&[infinite]), [false]);
}

#[test]
fn a_later_key_decides_between_equals_and_every_key_has_ranks_of_its_own() {
    let mut entries: Vec<Entry> = (0..4).map(|_| entries(&k18()).remove(0)).collect();
    // rms 2 1 2 1, transmission 10 20 30 20.
    for (i, (rms, angle)) in [(2.0, 10.0), (1.0, 20.0), (2.0, 30.0), (1.0, 20.0)].into_iter().enumerate() {
        entries[i].label = i.to_string();
        entries[i].candidate.error.rms = rms;
        entries[i].candidate.transmission_deg.worst = angle;
    }
    let comparison = compare(&entries, &[SortKey::Rms, SortKey::Transmission], None);
    let rows = &comparison.rows;
    assert_eq!(rows.iter().map(|row| row.entry.label.as_str()).collect::<Vec<_>>(), ["1", "3", "2", "0"]);
    assert_eq!(rows.iter().map(|row| row.rank).collect::<Vec<_>>(), [1, 1, 3, 4]);
    assert_eq!(
        rows.iter().map(|row| row.ranks.clone()).collect::<Vec<_>>(),
        [[1, 2], [1, 2], [3, 1], [3, 4]]
    );
    // The front: 1 and 3 are equal and marked once, 2 has the best angle, 0 is behind all.
    assert_eq!(rows.iter().map(|row| row.on_front).collect::<Vec<_>>(), [true, false, true, false]);
    let text = comparison.table(Colour::Never);
    assert!(text.contains("Ranked by rms, then transmission") && text.contains("1*"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn what_differs_by_rounding_is_equal() {
    let mut two = entries(&k18());
    two.truncate(1);
    two.push(two[0].clone());
    two[1].candidate.error.rms *= 1.0 - f64::EPSILON;
    assert_ne!(two[0].candidate.error.rms, two[1].candidate.error.rms);
    let rows = compare(&two, &[SortKey::Rms], Some(0)).rows;
    assert!(rows.iter().all(|row| row.rank == 1 && row.behind_percent == Some(0.0)));
    assert_eq!(rows.iter().map(|row| row.on_front).collect::<Vec<_>>(), [true, false]);
    // Nor does the margin within which a limit is met tell two figures apart; what is beyond it does.
    two[1].candidate.error.rms *= 1.0 - 1e-9;
    let comparison = compare(&two, &[SortKey::Rms], None);
    let marks: Vec<_> = comparison.rows.iter().map(|row| (row.rank, row.on_front)).collect();
    assert_eq!(marks, [(1, true), (1, false)]);
    assert!(!comparison.table(Colour::Never).contains("e-"), "{}", comparison.table(Colour::Never));
    two[1].candidate.error.rms *= 1.0 - 1e-6;
    let rows = compare(&two, &[SortKey::Rms], None).rows;
    assert_eq!(rows.iter().map(|row| (row.rank, row.on_front)).collect::<Vec<_>>(), [(1, true), (2, false)]);
}

#[test]
fn angles_that_print_alike_share_a_rank_and_one_of_them_is_on_the_front() {
    let mut many: Vec<Entry> = (0..9).map(|_| entries(&k18()).remove(0)).collect();
    for (i, entry) in many.iter_mut().enumerate() {
        entry.candidate.transmission_deg.worst = 35.0 + 3e-10 * i as f64;
        entry.candidate.error.rms *= 1.0 + 7e-13 * i as f64;
    }
    many[4].candidate.transmission_deg.worst = 34.0;
    let rows = compare(&many, &[SortKey::Transmission, SortKey::Rms], None).rows;
    assert_eq!(rows.iter().map(|row| row.rank).collect::<Vec<_>>(), [1, 1, 1, 1, 1, 1, 1, 1, 9]);
    assert_eq!(rows.iter().filter(|row| row.on_front).count(), 1);
    assert!(rows[..8].iter().all(|row| row.behind_percent == Some(0.0)));
}

#[test]
fn what_was_minimised_ranks_where_it_is_no_plain_sum() {
    let mut two = entries(&k18());
    two.truncate(2);
    for (entry, (objective, sum_sq)) in two.iter_mut().zip([(3.0, 1.0), (2.0, 4.0)]) {
        entry.measure = Measure::WeightedSum;
        (entry.candidate.error.objective, entry.candidate.error.sum_sq) = (objective, sum_sq);
    }
    let comparison = compare(&two, &[], None);
    assert_eq!(comparison.keys, [SortKey::Objective]);
    assert_eq!(comparison.rows[0].entry.candidate.error.sum_sq, 4.0);
    let text = comparison.table(Colour::Never);
    let head = text.lines().find(|line| line.contains("behind")).expect("a head");
    assert!(head.contains("weighted sq") && !head.contains("sum of sq"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    assert!(comparison.html().contains("weighted sq"));
    // Of several measures none is taken for all.
    two[1].measure = Measure::Sum;
    assert_eq!(compare(&two, &[], None).keys, [SortKey::SumSq]);
}

#[test]
fn per_cent_of_nothing_is_no_number() {
    assert_eq!(percent_above(3.0, 2.0), Some(50.0));
    assert_eq!(percent_above(1.0, 2.0), Some(-50.0));
    assert_eq!(percent_above(-1.0, -2.0), Some(50.0));
    assert_eq!((percent_above(0.0, 0.0), percent_above(-0.0, 0.0)), (Some(0.0), Some(0.0)));
    assert_eq!((percent_above(1.0, 0.0), percent_above(1e300, 1e-300)), (None, None));
    let mut two = entries(&k18());
    two.truncate(2);
    two[0].candidate.error.max = 0.0;
    let comparison = compare(&two, &[SortKey::Rms], Some(0));
    let of = |row: usize, key: SortKey| comparison.rows[row].difference_percent[key as usize];
    assert_eq!((of(0, SortKey::Max), of(1, SortKey::Max)), (Some(0.0), None));
    let (x, y) = (two[1].candidate.error.rms, two[0].candidate.error.rms);
    assert_eq!(of(1, SortKey::Rms), Some(100.0 * (x - y) / y));
    let json: serde_json::Value = serde_json::from_str(&comparison.json()).expect("JSON");
    assert!(json["rows"][1]["percent_above_reference"]["max"].is_null());
    let html = comparison.html();
    assert!(html.contains("<td data-value=\"\">-</td>") && html.contains(">reference</td>"));
}

#[test]
fn lengths_are_brought_to_one_unit_and_that_changes_no_verdict() {
    assert_eq!(Unit::In.factor_to(Unit::Mm), 25.4);
    assert_eq!((Unit::M.factor_to(Unit::Cm), Unit::Cm.factor_to(Unit::Cm)), (100.0, 1.0));
    let mut record = k18();
    record.problem.unit = Some(Unit::In);
    let inches = entries(&record);
    let converted = in_one_unit(&inches, Some(Unit::Mm)).expect("they are in range");
    let both: Vec<Entry> = inches.iter().chain(&converted).cloned().collect();
    let one = compare(&in_one_unit(&both, Some(Unit::In)).expect("in range"), &[SortKey::Rms], None);
    assert!(one.same_unit() && one.same_target(), "there and back");
    for (inch, mm) in inches.iter().zip(&converted) {
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-12 * y.abs();
        let (inch_error, mm_error) = (&inch.candidate.error, &mm.candidate.error);
        assert!(near(mm_error.rms, 25.4 * inch_error.rms) && near(mm_error.max, 25.4 * inch_error.max));
        assert!(near(mm_error.sum_sq, 645.16 * inch_error.sum_sq));
        assert!(near(mm_error.to_curve.rms, 25.4 * inch_error.to_curve.rms));
        assert!(near(mm.size(), 25.4 * inch.size()), "{} {}", mm.size(), inch.size());
        assert!(near(
            mm.candidate.linkage.four_bar().expect("a four-bar").coupler(),
            25.4 * inch.candidate.linkage.four_bar().expect("a four-bar").coupler()
        ));
        assert_eq!(mm.candidate.link_ratio, inch.candidate.link_ratio);
        assert_eq!(mm.candidate.accepted, inch.candidate.accepted);
    }
}

#[test]
fn many_rows_and_one_row_make_every_form() {
    for n in [1, 2, 25, 200] {
        let all = entries(&k18());
        let many: Vec<Entry> = (0..n).map(|i| all[i % all.len()].clone()).collect();
        let comparison = compare(&many, &[SortKey::Size], Some(n - 1));
        let svg = comparison.svg();
        roxmltree::Document::parse(&svg).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(svg.matches("class=\"curve\"").count(), n.min(24));
        assert_eq!(svg.contains("are drawn."), n > 24);
        let html = comparison.html();
        assert_eq!(html.matches("<tr data-row").count(), 3 * n);
        assert!(html.len() < if n > 25 { 800_000 } else { 400_000 }, "{n}: {}", html.len());
        assert_eq!(comparison.csv().lines().count(), n + 1);
        assert!(comparison.table(Colour::Never).lines().all(|line| line.chars().count() <= 100));
    }
    let nothing = compare(&[], &[], Some(3));
    assert!(nothing.html().contains("nothing to compare") && nothing.svg().contains("nothing to compare"));
}

#[test]
fn different_targets_are_said_to_differ_and_have_no_front() {
    let both: Vec<Entry> =
        [k18(), ellipse()].iter().flat_map(|record| entries(record).into_iter().take(1)).collect();
    let comparison = compare(&both, &[SortKey::Rms], None);
    assert!(comparison.rows.iter().all(|row| !row.on_front));
    for text in [comparison.table(Colour::Never), comparison.html(), comparison.svg(), comparison.json()] {
        assert!(text.contains("targets differ"), "{text}");
    }
}

#[test]
fn nothing_in_a_label_or_a_record_becomes_markup() {
    let hostile =
        "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'><svg/onload=alert(3)>&\u{202e}";
    let mut record = detail();
    record.problem.name = hostile.to_owned();
    for candidate in &mut record.candidates {
        for requirement in &mut candidate.requirements {
            requirement.name = hostile.to_owned();
            requirement.met = false;
        }
        candidate.accepted = false;
    }
    let mut all = entries(&record);
    for entry in &mut all {
        entry.label = hostile.to_owned();
        entry.untrue = vec![hostile.to_owned(); 2];
    }
    let mut comparison = compare(&all, &[SortKey::Rms], Some(0));
    comparison
        .left_out
        .push(linkwright::internals::report::compare::LeftOut { label: hostile.into(), why: hostile.into() });
    let html = comparison.html();
    assert_eq!(html.matches("<script").count(), 2, "the data and the script of the page alone");
    assert_eq!(html.matches("</script").count(), 2);
    assert!(html.contains("default-src 'none'") && !html.contains("<img") && !html.contains("<svg/"));
    assert!(!html.contains("src=\"") && !html.contains("http://") && !html.contains("https://"));
    // Boxes closed and given a value as XML wants it, the body is well-formed: no text opens or closes anything.
    let body = &html[html.find("<main>").expect("a body")..html.find("</main>").expect("its end") + 7];
    let boxes = body
        .replace(" checked data-row", " checked=\"\" data-row")
        .replace("\"><svg class=\"swatch", "\"/><svg class=\"swatch");
    roxmltree::Document::parse(&boxes).unwrap_or_else(|e| panic!("{e}"));
    let svg = comparison.svg();
    let document = roxmltree::Document::parse(&svg).unwrap_or_else(|e| panic!("{e}"));
    let odd = document
        .descendants()
        .find(|node| matches!(node.tag_name().name(), "script" | "img" | "foreignObject"));
    assert!(odd.is_none());
    assert!(comparison.csv().lines().skip(1).all(|line| !line.contains('\u{202e}')));
}

#[test]
fn the_keys_of_the_json_are_these() {
    let comparison = compare(&entries(&k18()), &[SortKey::Rms, SortKey::Size], Some(1));
    let json: serde_json::Value = serde_json::from_str(&comparison.json()).expect("JSON");
    let keys = |value: &serde_json::Value| {
        value.as_object().expect("an object").keys().cloned().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(json["format"], 1);
    assert_eq!(
        keys(&json),
        "format front_of left_out notes reference rows same_target same_unit sort tool unit"
    );
    assert_eq!(
        keys(&json["rows"][0]),
        "accepted behind_percent crank_deg defects figures label linkage max_at of_run on_front \
         percent_above_reference rank ranks recorded_differently target transmission_over type unit unmet"
    );
    assert_eq!(
        keys(&json["rows"][0]["figures"]),
        "extent link_ratio max objective rms size sum_sq to_curve transmission"
    );
    assert_eq!(keys(&json["rows"][0]["ranks"]), "rms size");
    assert_eq!(json["reference"], "eighteen-point:2");
}

#[test]
fn a_record_that_was_changed_is_not_believed() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &[]);
    let (code, honest, _) = linkwright(folder.path(), &["compare", "r", "--json"]);
    assert_eq!(code, 0);
    let path = folder.path().join("r/record.json");
    let mut record: Record =
        serde_json::from_str(&fs::read_to_string(&path).expect("text")).expect("a record");
    record.candidates[1].error.rms = 1e-9;
    record.candidates[1].transmission_deg.worst = 89.0;
    fs::write(&path, serde_json::to_string(&record).expect("JSON")).expect("there is room");
    let (code, text, _) = linkwright(folder.path(), &["compare", "r"]);
    assert_eq!(code, 1);
    assert!(text.contains("r:2 is not true") && text.contains("2!"), "{text}");
    let (code, told, stderr) = linkwright(folder.path(), &["compare", "r", "--json"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("is not true"), "{stderr}");
    let [honest, told] =
        [&honest, &told].map(|t| serde_json::from_str::<serde_json::Value>(t).expect("JSON"));
    for i in 0..record.candidates.len() {
        assert_eq!(honest["rows"][i]["figures"], told["rows"][i]["figures"]);
    }
    assert_eq!(told["rows"][1]["recorded_differently"].as_array().map(Vec::len), Some(2), "{told}");
    // A list that is too short is no reason to panic: the nearest positions are taken.
    record.candidates[0].crank_deg.truncate(3);
    record.problem.resolved.task.points[0][0] += 0.001;
    fs::write(&path, serde_json::to_string(&record).expect("JSON")).expect("there is room");
    let (code, text, _) = linkwright(folder.path(), &["compare", "r:1"]);
    assert_eq!(code, 1);
    assert!(text.contains("problem.digest") && text.contains("1*!"), "{text}");
}

#[test]
fn files_in_other_units_stand_beside_a_run_as_what_they_are() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &["--set", "unit=mm"]);
    let path = folder.path().join("r/linkage-1.toml");
    let file = linkage_file::load(&path).expect("a linkage");
    let inches = file.linkage.scaled(Unit::Mm.factor_to(Unit::In)).expect("in range");
    let write = |name: &str, unit, linkage| {
        fs::write(folder.path().join(name), linkage_file::to_toml("twin", unit, linkage)).expect("room");
    };
    write("inches.toml", Some(Unit::In), &inches);
    write("mm.toml", Some(Unit::Mm), &file.linkage);
    let arguments = ["compare", "r:1", "inches.toml", "mm.toml", "--reference", "mm.toml", "--json"];
    let (code, text, stderr) = linkwright(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("converted from in to mm: inches.toml."), "{stderr}");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!((&json["unit"], &json["reference"]), (&"mm".into(), &"mm.toml".into()));
    for row in json["rows"].as_array().expect("rows") {
        for (key, percent) in row["percent_above_reference"].as_object().expect("figures") {
            assert!(percent.as_f64().expect("a number").abs() < 1e-6, "{key}: {row}");
        }
    }
}

#[test]
fn a_target_without_a_unit_is_taken_to_be_in_that_of_the_first_linkage() {
    let folder = TempDir::new().expect("a folder");
    let target = root().join("problems/literature/k18.toml").display().to_string();
    let hoeken = root().join("problems/linkages/hoeken.toml");
    let file = linkage_file::load(&hoeken).expect("a linkage");
    let centimetres = file.linkage.scaled(0.1).expect("in range");
    for (name, unit, linkage) in [("mm", Unit::Mm, &file.linkage), ("cm", Unit::Cm, &centimetres)] {
        let path = folder.path().join(format!("{name}.toml"));
        fs::write(path, linkage_file::to_toml(name, Some(unit), linkage)).expect("room");
    }
    for (order, unit, size) in [(["mm.toml", "cm.toml"], "mm", 7.965), (["cm.toml", "mm.toml"], "cm", 0.7965)]
    {
        let arguments = [&["compare", "--target", &target, "--json"][..], &order].concat();
        let (code, text, stderr) = linkwright(folder.path(), &arguments);
        assert_eq!(code, 0, "{stderr}");
        assert!(stderr.contains(&format!("Without a unit, taken to be in {unit}: k18.")), "{stderr}");
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(json["unit"], unit);
        for key in ["rms", "size", "max"] {
            let [x, y] = [0, 1].map(|i| json["rows"][i]["figures"][key].as_f64().expect("a number"));
            assert!((x - y).abs() <= 1e-9 * x.abs(), "{key}: {x} {y}");
        }
        assert!((json["rows"][0]["figures"]["size"].as_f64().expect("a number") - size).abs() < 1e-3);
    }
}

#[test]
fn runs_of_different_targets_are_measured_on_one_that_is_named() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &[]);
    run(
        folder.path(),
        "q",
        &[
            "--set",
            "task.path.points=[[0,0],[1,0],[1,1],[0,1]]",
            "--set",
            "task.path.timing.crank_deg=[0,90,180,270]",
        ],
    );
    let linkage = root().join("problems/linkages/hoeken.toml").display().to_string();
    let (code, text, _) = linkwright(folder.path(), &["compare", "r:1", "q:1"]);
    assert!(code == 0 && text.contains("The targets differ"), "{text}");
    let (code, _, stderr) = linkwright(folder.path(), &["compare", "r:1", "q:1", &linkage]);
    assert!(code == 2 && stderr.contains("--target PROBLEM.toml"), "{stderr}");
    let target = root().join("problems/literature/k18.toml").display().to_string();
    let all = ["compare", "r:1", "q:1", &linkage, "--target", &target, "--json"];
    let (code, text, stderr) = linkwright(folder.path(), &all);
    assert_eq!(code, 0, "{stderr}");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(json["same_target"] == true && json["rows"].as_array().map(Vec::len) == Some(3), "{json}");
    assert_eq!(json["rows"][0]["label"], "r:1", "it was made for this one");
}

#[test]
fn what_is_proved_of_a_result_is_told() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &["--set", "task.path.timing.offset=ground"]);
    let (_, text, _) = linkwright(folder.path(), &["compare", "r"]);
    assert!(!text.contains("Proved"), "{text}");
    linkwright(folder.path(), &["certify", "r", "--gap", "0.02", "--quiet"]);
    let (code, text, _) = linkwright(folder.path(), &["compare", "r"]);
    let said = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let told = "r, as its record says: Proved: no linkage that the proof covers is better by more than";
    assert!(code == 0 && said.contains(told), "{text}");
    // Of other points nothing is proved.
    let target = root().join("problems/literature/k18b.toml").display().to_string();
    let (_, text, _) = linkwright(folder.path(), &["compare", "r", "--target", &target]);
    assert!(!text.contains("Proved"), "{text}");
}

#[test]
fn what_cannot_be_measured_is_left_out_and_told() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &[]);
    let apart = "format = 1\nname = \"apart\"\n[linkage]\nA = [0, 0]\nB = [9, 0]\na = 1\nb = 1\nc = 1\nd = 1\ne = 1\nt1 = 1\nt2 = 1\n";
    fs::write(folder.path().join("apart.toml"), apart).expect("room");
    let (code, text, _) = linkwright(folder.path(), &["compare", "r", "apart.toml"]);
    assert!(code == 1 && text.contains("Left out: apart: it cannot be assembled"), "{text}");
    let target = root().join("problems/literature/k18.toml").display().to_string();
    let (code, text, stderr) = linkwright(folder.path(), &["compare", "apart.toml", "--target", &target]);
    assert!(code == 1 && text.is_empty() && stderr.contains("cannot be assembled"), "{stderr}");
}

#[test]
fn a_reference_may_be_one_of_the_results_or_another() {
    let folder = TempDir::new().expect("a folder");
    run(folder.path(), "r", &[]);
    let ask = |arguments: &[&str]| {
        let (code, text, stderr) =
            linkwright(folder.path(), &[&["compare", "--json"][..], arguments].concat());
        assert_eq!(code, 0, "{arguments:?}: {stderr}");
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        (json["reference"].as_str().map(str::to_owned), json["rows"].as_array().map_or(0, Vec::len))
    };
    assert_eq!(ask(&["r"]), (None, 3));
    assert_eq!(ask(&["r", "--reference", "r"]), (Some("r:1".into()), 3));
    assert_eq!(ask(&["r", "--reference", "r:2"]), (Some("r:2".into()), 3));
    assert_eq!(ask(&["r", "--reference", "r/record.json:2"]), (Some("r:2".into()), 3));
    assert_eq!(ask(&["r:1", "--reference", "r:3"]), (Some("r:3".into()), 2));
    assert_eq!(ask(&["r:1", "--reference", "r/linkage-2.toml"]).1, 2);
    for (arguments, word) in [
        (&["compare", "r", "--reference", "nowhere"][..], "nowhere"),
        (&["compare", "r", "--sort", "rms,speed"], "sort by sum_sq"),
        (&["compare", "r:9"], "there is no candidate 9, the result has 3"),
        (&["compare", "r:x"], "after the colon stands a candidate's rank"),
        (&["compare", "r:buildable"], "no buildable candidate"),
        (&["verify", "r:2"], "verified as a whole"),
        (&["verify", "r/linkage-1.toml"], "a linkage without a run"),
        (&["compare", "r", "--html", "no/such/folder.html"], "no/such"),
    ] {
        let (code, stdout, stderr) = linkwright(folder.path(), arguments);
        assert_eq!((code, stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(stderr.contains(word), "{arguments:?}: {stderr}");
    }
}
