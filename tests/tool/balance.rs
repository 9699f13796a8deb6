//! `balance` as a person meets it, and the loads of a problem in the files of its result.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

/// A lamp: a four-bar whose crank is an arm of 300 mm with 1 kg at its end.
fn lamp(folder: &Path) {
    let text = "format = 1\nunit = \"mm\"\n[linkage]\nA = [0, 0]\nB = [500, 0]\na = 300\nb = 520\nc = 400\nd = 100\ne = 450\n\
        t1 = 1\nt2 = 1\n[loads]\ngravity = [0, -9.81]\n[loads.body.crank]\nmass_kg = 1\ncenter = [300, 0]\n";
    fs::write(folder.join("lamp.toml"), text).expect("a file");
}

const SPRING: [&str; 7] = ["balance", "lamp.toml", "--spring", "crank:150,0", "0,120", "--over", "20,70"];

#[test]
fn a_spring_is_found_written_and_read_back() {
    let folder = TempDir::new().expect("a folder");
    lamp(folder.path());
    let (code, stdout, stderr) =
        linkwright(folder.path(), &[&SPRING[..], &["--out", "held.toml"][..]].concat());
    assert_eq!(code, 0, "{stderr}");
    // k a b = m g r: 1 kg at 300 mm, from 150 mm on the arm to 120 mm above the pivot.
    for words in ["rate 163.5 N/m, free length 0 mm", "From (150, 0) of crank to (0, 120)", "% of the peak"] {
        assert!(stdout.contains(words), "{words}: {stdout}");
    }
    let held = fs::read_to_string(folder.path().join("held.toml")).expect("it was written");
    assert!(held.starts_with("# Loads of a linkage, written by linkwright"), "{held}");
    assert!(held.contains("rate_N_per_m = 163.5\n") && held.contains("center = [300.0, 0.0]"), "{held}");
    let (code, stdout, stderr) = linkwright(folder.path(), &["check", "held.toml"]);
    assert!(code == 0 && stdout.contains("1 spring"), "{stdout}{stderr}");
    let analyze = ["analyze", "lamp.toml", "--loads", "held.toml", "--angle", "30,45,60", "--json"];
    let (code, stdout, stderr) = linkwright(folder.path(), &analyze);
    assert_eq!(code, 0, "{stderr}");
    let json: serde_json::Value = serde_json::from_str(&stdout).expect("JSON");
    let rows = json["configurations"][0]["rows"].as_array().expect("rows").clone();
    for row in rows {
        let torque = row["loads"]["torque_N_m"].as_f64().expect("a torque");
        assert!(torque.abs() < 1e-9, "{torque}");
    }
    // It is replaced by another run, and what somebody else wrote is kept.
    let again = [&SPRING[..], &["--out", "held.toml", "--rates", "100,150,200"][..]].concat();
    let (code, stdout, _) = linkwright(folder.path(), &again);
    // A rate above the best one, with a free length, leaves less than one below it.
    assert!(code == 0 && stdout.contains("rate 200.0 N/m"), "{stdout}");
    fs::write(folder.path().join("own.toml"), "mine").expect("a file");
    let (code, _, stderr) = linkwright(folder.path(), &[&SPRING[..], &["--out", "own.toml"][..]].concat());
    assert!(code == 2 && stderr.contains("own.toml"), "{stderr}");
}

#[test]
fn counter_masses_are_found_with_what_is_left() {
    let folder = TempDir::new().expect("a folder");
    let pump = root().join("problems/linkages/slider-crank-loaded.toml").display().to_string();
    let masses = ["balance", &pump, "--masses", "crank", "--radius", "15", "--even", "shaking-force"];
    let (code, stdout, stderr) = linkwright(folder.path(), &masses);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("counter-masses, at 300 rpm") && stdout.contains("crank"), "{stdout}");
    let (code, stdout, _) = linkwright(folder.path(), &[&masses[..], &["--json"][..]].concat());
    let json: serde_json::Value = serde_json::from_str(&stdout).expect("JSON");
    let left = json["shaking_percent"].as_f64().expect("a number");
    assert!(code == 0 && (1.0..100.0).contains(&left), "one mass takes a part: {left}");
}

#[test]
fn what_cannot_be_balanced_is_refused_with_the_remedy() {
    let folder = TempDir::new().expect("a folder");
    lamp(folder.path());
    let bare = root().join("problems/linkages/hoeken.toml").display().to_string();
    let pump = root().join("problems/linkages/slider-crank-loaded.toml").display().to_string();
    for (arguments, words) in [
        (vec!["balance", "lamp.toml"], "--spring"),
        (vec!["balance", &bare, "--spring", "D", "0,1"], "unit"),
        (vec!["balance", "lamp.toml", "--spring", "Q", "0,1"], "joints and points of this linkage"),
        (vec!["balance", "lamp.toml", "--spring", "C", "1,x"], "two numbers"),
        (vec!["balance", "lamp.toml", "--spring", "C", "0,120", "--over", "30"], "two crank angles"),
        (vec!["balance", "lamp.toml", "--spring", "C", "0,120", "--over", "30,30"], "wider than 0"),
        (vec!["balance", "lamp.toml", "--masses", "crank"], "--radius"),
        (vec!["balance", &pump, "--masses", "coupler", "--radius", "15"], "fixed pivot"),
        (vec!["balance", &pump, "--masses", "crank", "--radius", "0"], "above 0"),
    ] {
        let (code, _, stderr) = linkwright(folder.path(), &arguments);
        assert!(code == 2 && stderr.contains(words), "{arguments:?}: {code} {stderr}");
    }
}

#[test]
fn a_result_under_loads_has_its_torques_in_table_csv_and_page() {
    let folder = TempDir::new().expect("a folder");
    let problem = root().join("problems/examples/walking-stride-loaded.toml").display().to_string();
    let few = [
        "--set",
        "solve.evaluations=4000",
        "--set",
        "solve.candidates=2",
        "--no-advice",
        "--quiet",
        "--out",
        "r",
    ];
    let (code, stdout, stderr) = linkwright(folder.path(), &[&["synth", &problem][..], &few[..]].concat());
    assert!(code < 2, "{stderr}");
    assert!(stdout.contains("Peak torque on the crank under the loads, N m"), "{stdout}");
    let read = |name: &str| fs::read_to_string(folder.path().join("r").join(name)).expect("it is there");
    assert!(read("candidates.csv").lines().next().expect("a header").contains("peak_torque_N_m"));
    let page = read("report.html");
    for words in ["Torque on the crank", "Largest force of every joint", "peak torque"] {
        assert!(page.contains(words), "{words}");
    }
    assert!(read("record.json").contains("\"peak_torque_N_m\""));
    let (code, stdout, stderr) = linkwright(folder.path(), &["verify", "r"]);
    assert_eq!(code, 0, "{stdout}{stderr}");
    let (code, stdout, stderr) = linkwright(folder.path(), &["check", &problem]);
    assert!(code == 0 && !stdout.contains("analyze LINKAGE"), "{stdout}{stderr}");
}
