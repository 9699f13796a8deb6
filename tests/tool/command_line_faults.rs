//! Faults of the command line that were found from outside, each with its siblings.

use crate::common::root;
use linkwright::internals::record::{Reason, Record};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const PROBLEM: &str = "format = 1
name = \"small\"
[task.path]
points = [[0, 0], [1, 2], [2, 2.5], [3, 2], [4, 0]]
[solve]
candidates = 2
evaluations = 2000
";

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments).stdin(Stdio::null());
    command
}

fn linkwright(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("it runs")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A folder with the result `r` of a small problem.
fn place() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    let ran = linkwright(folder.path(), &["synth", "small.toml", "--out", "r", "--quiet", "--threads", "1"]);
    assert!(matches!(ran.status.code(), Some(0 | 1)), "{}", said(&ran));
    folder
}

/// Makes `r/record.json` untrue, as `bad/record.json`.
fn untrue(folder: &Path) {
    let text = fs::read(folder.join("r/record.json")).expect("it is there");
    let mut record: Record = serde_json::from_slice(&text).expect("a record");
    for candidate in &mut record.candidates {
        candidate.error.rms *= 2.0;
        candidate.link_ratio += 1.0;
    }
    fs::create_dir(folder.join("bad")).expect("a folder");
    fs::write(folder.join("bad/record.json"), serde_json::to_vec(&record).expect("data"))
        .expect("there is room");
}

#[test]
fn verify_goes_through_all_of_its_arguments_and_ends_with_the_gravest() {
    let place = place();
    let folder = place.path();
    untrue(folder);
    for (arguments, code) in [
        (vec!["r", "missing", "bad", "r"], 2),
        (vec!["r", "bad", "r"], 1),
        (vec!["bad", "r:1", "r"], 2),
        (vec!["small.toml", "r"], 2),
        (vec!["r", "r"], 0),
    ] {
        let output = linkwright(folder, &[vec!["verify"], arguments.clone()].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let true_ones = arguments.iter().filter(|argument| **argument == "r").count();
        let untrue_ones = arguments.iter().filter(|argument| **argument == "bad").count();
        assert_eq!(printed(&output).matches("r: true").count(), true_ones, "{}", printed(&output));
        assert_eq!(printed(&output).matches("bad: NOT true").count(), untrue_ones, "{}", printed(&output));
    }
}

#[test]
fn messages_of_several_lines_are_printed_as_lines() {
    let place = place();
    let folder = place.path();
    untrue(folder);
    let output = linkwright(folder, &["report", "bad"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(!said(&output).contains("\\n"), "{}", said(&output));
    assert!(said(&output).lines().count() > 3, "{}", said(&output));
}

#[test]
fn a_rhombus_is_drawn_at_a_crank_angle_at_which_it_closes() {
    let folder = TempDir::new().expect("a folder");
    let linkage = "format = 1\nname = \"rhombus\"\nunit = \"mm\"\n[linkage]\nA = [0, 0]\nB = [30, 0]\na = 30\nb = 30\nc = 30\n\
                   d = 30\ne = 30\nt1 = 1\nt2 = 1\n";
    fs::write(folder.path().join("rhombus.toml"), linkage).expect("there is room");
    for format in ["svg", "dxf", "scad"] {
        let output = linkwright(folder.path(), &["export", "rhombus.toml", "--format", format]);
        assert_eq!(output.status.code(), Some(0), "{format}: {}", said(&output));
    }
    let at_zero = ["export", "rhombus.toml", "--format", "svg", "--set", "crank_deg=0"];
    let output = linkwright(folder.path(), &at_zero);
    assert_eq!(output.status.code(), Some(2));
    let help = said(&output);
    let angle = help.split("such as ").nth(1).and_then(|rest| rest.split(',').next()).expect("one is named");
    let there = format!("crank_deg={angle}");
    let output = linkwright(folder.path(), &["export", "rhombus.toml", "--format", "svg", "--set", &there]);
    assert_eq!(output.status.code(), Some(0), "{help}{}", said(&output));
}

#[test]
fn analyze_and_cognates_take_what_build_and_export_take() {
    let place = place();
    let folder = place.path();
    let file = linkwright(folder, &["analyze", "r/linkage-2.toml", "--json"]);
    for result in ["r:2", "r/record.json:2"] {
        let output = linkwright(folder, &["analyze", result, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{result}: {}", said(&output));
        assert_eq!(printed(&output), printed(&file), "{result}");
    }
    for result in ["r", "r/record.json", "r:1"] {
        let analyzed = linkwright(folder, &["analyze", result]);
        assert_eq!(analyzed.status.code(), Some(0), "{result}: {}", said(&analyzed));
        let out = format!("cognates of {}", result.replace(['/', ':'], " "));
        let found = linkwright(folder, &["cognates", result, "--out", &out]);
        assert_eq!(found.status.code(), Some(0), "{result}: {}", said(&found));
        let same = linkwright(folder, &["cognates", "r/linkage-1.toml", "--out", "of the file"]);
        assert_eq!(same.status.code(), Some(0), "{}", said(&same));
        for n in [1, 2] {
            let name = format!("small-1-cognate-{n}.toml");
            let one = fs::read(folder.join(&out).join(&name)).expect("it is there");
            assert_eq!(one, fs::read(folder.join("of the file").join(&name)).expect("it is there"));
        }
        fs::remove_dir_all(folder.join("of the file")).expect("it is there");
    }
    let none = linkwright(folder, &["analyze", "r:99"]);
    assert_eq!(none.status.code(), Some(2), "{}", said(&none));
    let missing = linkwright(folder, &["cognates", "nowhere"]);
    assert_eq!(missing.status.code(), Some(2), "{}", said(&missing));
}

#[test]
fn cognates_of_a_linkage_with_the_longest_name_are_linkage_files() {
    let folder = TempDir::new().expect("a folder");
    let name = "n".repeat(64);
    let text = fs::read_to_string(root().join("problems/linkages/hoeken.toml")).expect("it is there");
    let lines = text.lines().map(|line| match line.starts_with("name") {
        true => format!("name = \"{name}\""),
        false => line.to_owned(),
    });
    fs::write(folder.path().join("long.toml"), lines.collect::<Vec<_>>().join("\n")).expect("there is room");
    let output = linkwright(folder.path(), &["cognates", "long.toml", "--out", "c"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    for entry in fs::read_dir(folder.path().join("c")).expect("it is there") {
        let path = entry.expect("it can be read").path().display().to_string();
        let checked = linkwright(folder.path(), &["check", &path]);
        assert_eq!(checked.status.code(), Some(0), "{}", said(&checked));
    }
}

#[test]
fn cognates_that_are_refused_make_no_folder() {
    let folder = TempDir::new().expect("a folder");
    let hoeken = root().join("problems/linkages/hoeken.toml").display().to_string();
    let arguments = ["cognates", &hoeken, "--out", "c", "--svg", "c/hoeken-cognate-1.toml"];
    let output = linkwright(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("named twice"), "{}", said(&output));
    assert!(!folder.path().join("c").exists());
}

#[test]
fn a_folder_without_a_record_is_refused_for_that_by_certify() {
    let folder = place();
    for place in [".", "nowhere"] {
        let output = linkwright(folder.path(), &["certify", place]);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("there is no such record; name the folder"), "{}", said(&output));
    }
}

#[test]
fn a_folder_that_cannot_be_made_is_refused_with_the_remedy() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("results"), "mine").expect("there is room");
    let output = linkwright(folder.path(), &["suite", "--write"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("; choose another name"), "{}", said(&output));
}

#[test]
fn the_page_of_a_record_that_is_named_in_its_own_folder_is_report_html() {
    let folder = place();
    let output = linkwright(&folder.path().join("r"), &["report", "record.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(printed(&output), "report.html\n");
    fs::copy(folder.path().join("r/record.json"), folder.path().join("other.json")).expect("there is room");
    let output = linkwright(folder.path(), &["report", "other.json"]);
    assert_eq!(printed(&output), "other.html\n", "{}", said(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn help_that_a_full_disk_takes_away_is_a_failure() {
    let folder = TempDir::new().expect("a folder");
    for arguments in [&["--help"][..], &["--version"], &["help", "synth"], &["synth", "--help"]] {
        let full = fs::File::options().write(true).open("/dev/full").expect("the system has one");
        let output = command(folder.path(), arguments).stdout(full).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains("cannot be written to standard output"), "{}", said(&output));
        let output = linkwright(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
    }
}

#[test]
fn names_that_a_system_or_a_shell_takes_for_something_else_are_refused() {
    let folder = TempDir::new().expect("a folder");
    for name in ["CON", "nul", "COM1", "lpt9.v2", "-rf", "--help", "end.", "end "] {
        let output = linkwright(folder.path(), &["new", "--", name]);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", said(&output));
        let problem = PROBLEM.replace("small", name);
        fs::write(folder.path().join("p.toml"), problem).expect("there is room");
        let output = linkwright(folder.path(), &["check", "p.toml"]);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", said(&output));
        assert!(said(&output).contains("help: "), "{}", said(&output));
    }
    // A file may be called so: its problem then has another name.
    fs::write(folder.path().join("con.csv"), "x,y\n0,0\n10,4\n18,9\n22,17\n").expect("there is room");
    let output =
        linkwright(folder.path(), &["synth", "con.csv", "--quiet", "--set", "solve.evaluations=500"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", said(&output));
    assert!(folder.path().join("results/problem con/record.json").is_file());
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 3, "nothing else was made");
}

#[test]
fn the_suite_runs_where_there_is_no_repository() {
    let folder = TempDir::new().expect("a folder");
    let output = linkwright(folder.path(), &["suite", "e5", "--seeds", "1", "--json"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", said(&output));
    let suite: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let names: Vec<&str> =
        suite["problems"].as_array().expect("a list").iter().filter_map(|p| p["name"].as_str()).collect();
    assert!(names.contains(&"e5"), "{names:?}");
    assert!(
        suite["command"].as_str().expect("text").starts_with("linkwright suite e5"),
        "{}",
        suite["command"]
    );
    let none = linkwright(folder.path(), &["suite", "no-such-problem"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(said(&none).contains("k18"), "the names are told: {}", said(&none));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "nothing is written");
}

#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("it runs");
    assert!(killed.success());
}

#[cfg(unix)]
#[test]
fn snap_that_is_interrupted_writes_its_best_so_far_and_says_so() {
    let folder = TempDir::new().expect("a folder");
    let mut before = 0;
    // Interrupted at several instants: it has ended already, or it has saved its best so far, or it says that there is
    // nothing yet.
    let linkage = root().join("problems/linkages/hoeken.toml").display().to_string();
    for (i, wait_ms) in [20, 50, 100, 200, 400].into_iter().enumerate() {
        let out = format!("out-{i}");
        let arguments = ["snap", linkage.as_str(), "--grid", "0.01", "--out", &out];
        let mut snap = command(folder.path(), &arguments);
        let child = snap.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        std::thread::sleep(std::time::Duration::from_millis(wait_ms));
        interrupt(&child);
        let output = child.wait_with_output().expect("it ends");
        let place = folder.path().join(&out);
        match output.status.code() {
            Some(130) if place.exists() => {
                before += 1;
                let text = fs::read(place.join("record.json")).expect("it is saved");
                let record: Record = serde_json::from_slice(&text).expect("a record");
                assert_eq!(record.termination.reason, Reason::Cancelled);
                assert!(!record.termination.reproducible);
                assert!(printed(&output).contains(&format!("Wrote {out}")), "{}", printed(&output));
                let verified = linkwright(folder.path(), &["verify", &out]);
                assert_eq!(verified.status.code(), Some(0), "{}", printed(&verified));
            }
            Some(130) => assert!(said(&output).contains("nothing was written"), "{}", said(&output)),
            Some(0 | 1) => assert!(place.exists()),
            // Before it watches for signals at all.
            None => assert!(!place.exists()),
            other => panic!("{other:?}: {}", said(&output)),
        }
    }
    assert!(before > 0, "it was interrupted in time at least once");
}

#[cfg(feature = "studio")]
#[test]
fn the_studio_takes_a_free_port_for_port_0_and_prints_it() {
    let studios = [(); 2].map(|()| crate::studio::Studio::start(&["--port", "0"]));
    let hosts = studios.each_ref().map(crate::studio::Studio::host);
    assert!(hosts[0] != hosts[1] && hosts.iter().all(|host| !host.ends_with(":0")), "{hosts:?}");
    for studio in &studios {
        drop(studio.socket());
    }
    for mut studio in studios {
        studio.child.kill().expect("it runs");
        studio.child.wait().expect("it ends");
    }
}
