//! What stands beside the answers: its time is said by name, and it can be left out.

use assert_cmd::Command;
use linkwright::internals::record::Record;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Ten points on a parabola, so near each other's tolerance that nothing is acceptable.
const REFUSED: &str = "format = 1\nname = \"refused\"\n[task.path]\npoints = [[0, 0], [10, 0], [20, 30], [30, 5], [40, 5], \
    [50, 0], [60, 20], [70, 0]]\ntolerance = 1e-6\n[solve]\nevaluations = 3000\ncandidates = 2\n";

fn synth(folder: &Path, more: &[&str]) -> (String, Option<i32>) {
    fs::write(folder.join("refused.toml"), REFUSED).expect("it can be written");
    let mut command = Command::cargo_bin("linkwright").expect("the program");
    command.current_dir(folder).args(["synth", "refused.toml", "--out", "out", "--quiet"]).args(more);
    let run = command.output().expect("it runs");
    (String::from_utf8(run.stdout).expect("text"), run.status.code())
}

fn json(folder: &Path, file: &str) -> serde_json::Value {
    let text = fs::read_to_string(folder.join("out").join(file)).expect("it is there");
    serde_json::from_str(&text).expect("JSON")
}

fn is_true(folder: &Path) {
    let mut command = Command::cargo_bin("linkwright").expect("the program");
    command.current_dir(folder).args(["verify", "out"]).assert().success();
}

#[test]
fn the_time_of_a_run_is_said_as_a_whole_and_by_its_parts() {
    let folder = TempDir::new().expect("a folder");
    let (text, code) = synth(folder.path(), &[]);
    assert_eq!(code, Some(1), "{text}");
    let timing = json(folder.path(), "timing.json");
    let seconds = |value: &serde_json::Value| value.as_f64().expect("seconds");
    let advice = &timing["advice_s"];
    let parts = seconds(&advice["costs"]) + seconds(&advice["conflicts"]) + seconds(&advice["buildable"]);
    assert!(seconds(&advice["conflicts"]) > 0.0, "{timing}");
    assert!(parts <= seconds(&timing["beside_s"]) + 1e-6, "{timing}");
    assert!(seconds(&timing["search_s"]) + parts <= seconds(&timing["total_s"]) + 1e-6, "{timing}");
    for said in [" s in all: ", " s of search, ", " s for what conflicts"] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn without_advice_the_answers_are_the_same_and_the_record_says_that_it_is_missing() {
    let folder = TempDir::new().expect("a folder");
    let (_, code) = synth(folder.path(), &[]);
    assert_eq!(code, Some(1));
    let record =
        |path: &Path| -> Record { serde_json::from_value(json(path, "record.json")).expect("a record") };
    let with = record(folder.path());
    for asked in [&["--no-advice"][..], &["--set", "solve.advice=false"]] {
        let (text, code) = synth(folder.path(), asked);
        assert_eq!(code, Some(1));
        let without = record(folder.path());
        assert!(!without.problem.resolved.solve.advice && with.problem.resolved.solve.advice);
        assert_eq!(without.problem.digest, with.problem.digest);
        assert!(without.conflict.is_none() && without.relaxations.is_empty() && without.buildable.is_none());
        let linkages = |record: &Record| record.candidates.iter().map(|c| c.linkage).collect::<Vec<_>>();
        assert_eq!(linkages(&without), linkages(&with));
        assert!(text.contains("No advice was asked for"), "{text}");
        assert!(!text.contains("what conflicts,") || text.contains("was not looked for"), "{text}");
        assert!(json(folder.path(), "timing.json").get("advice_s").is_none());
        is_true(folder.path());
        let page = fs::read_to_string(folder.path().join("out/report.html")).expect("a page");
        assert!(page.contains("No advice was asked for"));
    }
}
