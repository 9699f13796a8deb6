//! Nine points, and eight of linkages with a slider, from the command line.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(arguments).output().expect("it runs");
    let code = output.status.code().expect("it ends by itself");
    let stderr = String::from_utf8(output.stderr).expect("text");
    (code, String::from_utf8(output.stdout).expect("text") + &stderr)
}

#[test]
fn a_nine_point_problem_prints_its_census_and_draws_every_linkage() {
    let folder = TempDir::new().expect("a folder");
    let problem = root().join("problems/exact/wms3.toml").display().to_string();
    let (code, few) = linkwright(folder.path(), &["synth", &problem, "--out", "r"]);
    assert_eq!(code, 0, "{few}");
    for words in [
        "1,442 solutions up to cognates: as many as nine points in general position have",
        "64 are linkages, 116 more have a real curve",
        "30 can pass all points on one circuit, 3 of them in order, 1 of these on one",
        "56 more: --all",
    ] {
        assert!(few.contains(words), "{words}: {few}");
    }
    let (_, all) = linkwright(folder.path(), &["synth", &problem, "--out", "r", "--all"]);
    assert_eq!(all.lines().filter(|line| line.contains("two circuits  ")).count(), 34, "{all}");
    assert!(all.lines().count() >= few.lines().count() + 50);
    let sheet = fs::read_to_string(folder.path().join("r/exact.svg")).expect("it is drawn");
    let drawing = roxmltree::Document::parse(&sheet).expect("XML");
    assert_eq!(drawing.descendants().filter(|node| node.has_tag_name("clipPath")).count(), 64);
    let (code, verdict) = linkwright(folder.path(), &["verify", "r"]);
    assert_eq!(code, 0, "{verdict}");
    for more in [&["compare", "r"][..], &["analyze", "r/linkage-1.toml"]] {
        let (code, text) = linkwright(folder.path(), more);
        assert_eq!(code, 0, "{text}");
    }
}

#[test]
fn nine_points_of_which_none_can_be_used_end_with_exit_code_1() {
    let folder = TempDir::new().expect("a folder");
    let problem = root().join("problems/exact/gaussian.toml").display().to_string();
    let (code, text) = linkwright(folder.path(), &["synth", &problem, "--out", "r"]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("8 are linkages"), "{text}");
}

#[test]
fn eight_points_of_linkages_with_a_slider_are_solved_written_and_verified() {
    let folder = TempDir::new().expect("a folder");
    for (name, real, words) in [
        (
            "slider-exact",
            19,
            "279 solutions up to cognates: as many as eight points in general position have",
        ),
        ("inverted-exact", 174, "2,220 solutions: as many as eight points in general position have"),
    ] {
        let problem = root().join(format!("problems/sliders/{name}.toml")).display().to_string();
        let (code, text) = linkwright(folder.path(), &["synth", &problem, "--out", name, "--all"]);
        assert_eq!(code, 0, "{text}");
        assert!(text.contains(words), "{text}");
        let list = text.split("radius  verdict").nth(1).expect("a table");
        let rows = list.lines().filter(|line| line.contains("slider-crank  ")).count();
        assert_eq!(rows, real, "{text}");
        for more in [&["verify", name][..], &["compare", name], &["report", name]] {
            let (code, text) = linkwright(folder.path(), more);
            assert_eq!(code, 0, "{text}");
        }
        let first = format!("{name}/linkage-1.toml");
        let (code, text) = linkwright(folder.path(), &["analyze", &first]);
        assert_eq!(code, 0, "{text}");
        let record = folder.path().join(name).join("record.json");
        let text = fs::read_to_string(&record).expect("a record");
        let tampered = text.replacen("\"in_order\": 9", "\"in_order\": 10", 1);
        let tampered = tampered.replacen("\"in_order\": 6", "\"in_order\": 7", 1);
        assert_ne!(tampered, text);
        fs::write(&record, tampered).expect("a record");
        let (code, text) = linkwright(folder.path(), &["verify", name]);
        assert_eq!(code, 1, "{text}");
        assert!(text.contains("exact.census.in_order"), "{text}");
    }
}
