//! `build` and `snap` as a person meets them.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn linkwright(folder: &Path, arguments: &[&str]) -> Answer {
    let output = Command::cargo_bin("linkwright")
        .expect("it is built")
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .args(arguments)
        .output()
        .expect("it runs");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8(output.stdout).expect("text"),
        stderr: String::from_utf8(output.stderr).expect("text"),
    }
}

fn hoeken() -> String {
    root().join("problems/linkages/hoeken.toml").display().to_string()
}

#[test]
fn build_tells_layers_distances_and_the_worst_dimension() {
    let folder = TempDir::new().expect("a folder");
    let run = linkwright(folder.path(), &["build", &hoeken(), "--hole", "0.1", "--tolerance", "0.01"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for words in [
        "3 layers, from below: 1 ground; 2 crank and follower; 3 coupler.",
        "The ground (layer 1) passes under the end of pin C",
        "B-C",
        "The worst dimension is c",
    ] {
        assert!(run.stdout.contains(words), "{words} in\n{}", run.stdout);
    }
    for (arguments, words) in [
        (vec!["build", "nowhere.toml"], "nowhere.toml"),
        (vec!["build", "x.toml", "--hole", "0"], "a number above 0"),
    ] {
        let run = linkwright(folder.path(), &arguments);
        assert_eq!(run.code, 2, "{arguments:?}");
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}

#[test]
fn snap_writes_a_result_that_verify_accepts_and_compare_reads() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("bars.txt"), "# holes\n0.9 1.1, 2.4\n2.6 1.95 5.1\n").expect("written");
    let linkage = hoeken();
    let arguments = ["snap", &linkage, "--pitches", "bars.txt", "--snap", "a,b,c,ground"];
    let run = linkwright(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("stock"), "{}", run.stdout);
    let place = "results/hoeken-snapped";
    assert_eq!(linkwright(folder.path(), &["verify", place]).code, 0);
    assert_eq!(linkwright(folder.path(), &["compare", place]).code, 0);
    // The best linkage alone; and built at once.
    let alone = ["snap", &linkage, "--lengths", "1,2.5", "--snap", "a,b", "--out", "best.toml"];
    assert_eq!(linkwright(folder.path(), &alone).code, 0);
    assert_eq!(linkwright(folder.path(), &["build", "best.toml"]).code, 0);
}

#[test]
fn snap_refuses_what_is_no_stock_and_writes_nothing_then() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("bars.txt"), "1\nlong\n").expect("written");
    let linkage = hoeken();
    for (more, words) in [
        (vec![], "--grid"),
        (vec!["--grid", "-1"], "a number above 0"),
        (vec!["--pitches", "bars.txt"], "line 2: `long`"),
        (vec!["--pitches", "none.txt"], "none.txt: there is no such file\nhelp: check the spelling"),
        (vec!["--grid", "1", "--snap", "f"], "ground, a, b, c, d, e"),
        (vec!["--grid", "1", "--keep", "ground,a,b,c,d,e"], "nothing to snap"),
        (vec!["--grid", "1", "--set", "a=-3"], "a number above 0"),
    ] {
        let mut arguments = vec!["snap", linkage.as_str()];
        arguments.extend(&more);
        let run = linkwright(folder.path(), &arguments);
        assert_eq!(run.code, 2, "{more:?}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{words} in {}", run.stderr);
    }
    assert!(!folder.path().join("results").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn snap_does_not_read_a_list_of_lengths_without_end() {
    let folder = TempDir::new().expect("a folder");
    let run = linkwright(folder.path(), &["snap", &hoeken(), "--pitches", "/dev/zero"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("/dev/zero: the file has more than 16 MB"), "{}", run.stderr);
}
