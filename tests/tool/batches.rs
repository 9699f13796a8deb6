//! Batches, and runs that go on where an earlier one was broken: `synth FILE...`, `synth FOLDER`, `synth --resume`.

use crate::common::root;
use assert_cmd::cargo::CommandCargoExt;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments);
    command
}

fn linkwright(folder: &Path, arguments: &[&str]) -> Answer {
    let output = command(folder, arguments).output().expect("it runs");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8(output.stdout).expect("text"),
        stderr: String::from_utf8(output.stderr).expect("text"),
    }
}

fn shipped(name: &str) -> String {
    root().join("problems").join(name).display().to_string()
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// A small problem: five points that many four-bars pass through.
fn small(i: usize) -> String {
    format!(
        "format = 1\nname = \"small {i}\"\n[task.path]\npoints = [[0, 0], [2, {}], [4, 1], [5, 0], [6, -2]]\n\
         [solve]\ncandidates = 1\nseed = {i}\n",
        1.0 + 0.1 * i as f64
    )
}

#[test]
fn a_bad_file_of_a_batch_never_touches_the_others() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("bad.toml"), "format = 1\n").expect("written");
    let k18 = shipped("literature/k18.toml");
    fs::create_dir_all(at.join("all/e5")).expect("made");
    fs::write(at.join("all/e5/diary.txt"), "mine").expect("written");
    let e5 = shipped("literature/e5.toml");
    let run = linkwright(at, &["synth", &e5, "bad.toml", &k18, "missing.toml", "--out", "all"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    for said in ["bad.toml", "missing.toml", "diary.txt"] {
        assert!(run.stderr.contains(said), "{said} in {}", run.stderr);
    }
    assert!(run.stdout.contains("1 with an accepted linkage, 3 refused"), "{}", run.stdout);
    assert_eq!(linkwright(at, &["verify", "all/k18"]).code, 0);
    let summary = read(at, "all/summary.csv");
    let lines: Vec<&str> = summary.lines().collect();
    assert!(lines[0].starts_with("problem,status,points,"), "{summary}");
    assert_eq!(lines.len(), 5, "{summary}");
    assert!(lines[1].starts_with("e5,refused,") && lines[1].contains("diary.txt"), "{summary}");
    assert!(lines[2].starts_with("bad.toml,refused,"), "{summary}");
    assert!(lines[3].starts_with("k18,accepted,18,") && lines[3].contains("0.00902888463"), "{summary}");
    assert!(lines[4].starts_with("missing.toml,refused,"), "{summary}");
    assert_eq!(read(at, "all/e5/diary.txt"), "mine");
}

#[test]
fn a_folder_is_a_batch_of_its_problem_files_and_threads_change_no_byte() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::create_dir(at.join("many")).expect("made");
    for i in 0..9 {
        fs::write(at.join(format!("many/p{i}.toml")), small(i)).expect("written");
    }
    fs::copy(shipped("linkages/watt.toml"), at.join("many/watt.toml")).expect("copied");
    fs::write(at.join("many/notes.txt"), "no problem").expect("written");
    fs::write(at.join("many/torn.toml"), "format = ").expect("written");
    let run = |out: &str, threads: &str| {
        let run = linkwright(at, &["synth", "many", "--out", out, "--threads", threads]);
        assert_eq!(run.code, 2, "one of them is torn: {}", run.stderr);
        assert!(run.stderr.contains("watt.toml is no problem file"), "{}", run.stderr);
        assert!(run.stderr.contains("torn.toml"), "{}", run.stderr);
        run
    };
    let (one, two) = (run("one", "1"), run("two", "2"));
    assert_eq!(read(at, "one/summary.csv"), read(at, "two/summary.csv"));
    assert_eq!(read(at, "one/summary.csv").lines().count(), 11);
    for i in 0..9 {
        let name = format!("small {i}/record.json");
        assert_eq!(read(&at.join("one"), &name), read(&at.join("two"), &name));
    }
    let tail = |answer: &Answer| answer.stdout.lines().rev().take(16).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(tail(&one), tail(&two), "pages and summary come in the order of the files");
    let nothing = TempDir::new().expect("a folder");
    let empty = linkwright(at, &["synth", &nothing.path().display().to_string()]);
    assert_eq!(empty.code, 2);
    assert!(empty.stderr.contains("holds no problem file (*.toml"), "{}", empty.stderr);
}

#[test]
fn resume_skips_what_is_done_and_runs_the_rest() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for i in 0..3 {
        fs::write(at.join(format!("p{i}.toml")), small(i)).expect("written");
    }
    let files = ["synth", "p0.toml", "p1.toml", "p2.toml"];
    assert_eq!(linkwright(at, &files).code, 0);
    let summary = read(at, "results/summary.csv");
    let record = read(at, "results/small 1/record.json");
    fs::remove_dir_all(at.join("results/small 1")).expect("removed");
    let stamp = |i: usize| {
        let path = at.join(format!("results/small {i}/record.json"));
        fs::metadata(path).expect("it is there").modified().expect("a time")
    };
    let before = [stamp(0), stamp(2)];
    let again = linkwright(at, &["synth", "p0.toml", "p1.toml", "p2.toml", "--resume"]);
    assert_eq!(again.code, 0, "{}", again.stderr);
    assert_eq!(again.stdout.matches("Done before").count(), 2, "{}", again.stdout);
    assert_eq!([stamp(0), stamp(2)], before);
    assert_eq!(read(at, "results/small 1/record.json"), record);
    assert_eq!(read(at, "results/summary.csv"), summary);
    // Another seed is another problem; more candidates are another answer.
    for set in ["solve.seed=77", "solve.candidates=2"] {
        let other = linkwright(at, &["synth", "p0.toml", "--resume", "--set", set]);
        assert!(!other.stdout.contains("Done before"), "{set}: {}", other.stdout);
    }
}

/// A search of a second or two with many boundaries, and its arguments.
fn long(at: &Path) -> Vec<String> {
    let k18 = shipped("literature/k18.toml");
    fs::copy(k18, at.join("long.toml")).expect("copied");
    let words = ["synth", "long.toml", "--method", "genetic", "--set", "solve.evaluations=150000", "--out"];
    words.map(String::from).to_vec()
}

fn with<'a>(words: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    words.iter().map(String::as_str).chain(more.iter().copied()).collect()
}

#[test]
fn a_run_that_met_its_time_limit_goes_on_to_the_bytes_of_an_unbroken_one() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let long = long(at);
    linkwright(at, &with(&long, &["whole", "--threads", "2"]));
    let cut = linkwright(at, &with(&long, &["cut", "--threads", "2", "--set", "solve.time_limit_s=0.02"]));
    assert!(cut.code <= 1, "{}", cut.stderr);
    assert!(read(at, "cut/record.json").contains("\"time-limit\""));
    let checkpoint = read(at, "cut/checkpoint.json");
    // Broken in another way: a changed number, a torn file, another seed.
    let before = read(at, "cut/record.json");
    fs::write(at.join("cut/checkpoint.json"), checkpoint.replacen("\"generation\":", "\"generation\":1", 1))
        .expect("written");
    let changed = linkwright(at, &with(&long, &["cut", "--resume"]));
    assert_eq!(changed.code, 2);
    assert!(changed.stderr.contains("checksum") && changed.stderr.contains("--resume"), "{}", changed.stderr);
    fs::write(at.join("cut/checkpoint.json"), &checkpoint[..checkpoint.len() - 9]).expect("written");
    let torn = linkwright(at, &with(&long, &["cut", "--resume"]));
    assert_eq!((torn.code, torn.stderr.contains("not a whole linkwright checkpoint")), (2, true));
    fs::write(at.join("cut/checkpoint.json"), &checkpoint).expect("written");
    let other = linkwright(at, &with(&long, &["cut", "--resume", "--seed", "5"]));
    assert_eq!((other.code, other.stderr.contains("another problem")), (2, true), "{}", other.stderr);
    assert_eq!(read(at, "cut/record.json"), before);
    let resumed = linkwright(at, &with(&long, &["cut", "--resume", "--threads", "1"]));
    assert!(resumed.code <= 1, "{}", resumed.stderr);
    assert_eq!(read(at, "cut/record.json"), read(at, "whole/record.json"));
    assert!(!at.join("cut/checkpoint.json").exists() && !at.join("cut/.lock").exists());
}

#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("it runs");
    assert!(sent.success());
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_its_best_and_goes_on_and_a_second_interrupt_ends_at_once() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let long = long(at);
    linkwright(at, &with(&long, &["whole"]));
    let endless = ["cut", "--set", "solve.evaluations=1000000000", "--set", "solve.time_limit_s=60"];
    let child = command(at, &with(&long, &endless)).stderr(Stdio::piped()).stdout(Stdio::null()).spawn();
    let mut child = child.expect("it runs");
    let lock = at.join("cut/.lock");
    let begun = Instant::now();
    while !lock.exists() && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(60));
    let second = linkwright(at, &with(&long, &["cut"]));
    assert_eq!(
        (second.code, second.stderr.contains("in use by another run")),
        (2, true),
        "{}",
        second.stderr
    );
    interrupt(&child);
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert!(read(at, "cut/record.json").contains("\"cancelled\""));
    // The smaller budget begins anew, and says so.
    let anew = linkwright(at, &with(&long, &["cut", "--resume"]));
    assert!(anew.stderr.contains("begins anew") && anew.stderr.contains("1000000000"), "{}", anew.stderr);
    assert_eq!(read(at, "cut/record.json"), read(at, "whole/record.json"));
    let endless = ["twice", "--set", "solve.evaluations=1000000000", "--set", "solve.time_limit_s=60"];
    let child = command(at, &with(&long, &endless)).stderr(Stdio::null()).stdout(Stdio::null()).spawn();
    let mut child = child.expect("it runs");
    std::thread::sleep(Duration::from_millis(300));
    interrupt(&child);
    interrupt(&child);
    let begun = Instant::now();
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert!(begun.elapsed() < Duration::from_secs(10));
}

#[cfg(unix)]
#[test]
fn a_killed_run_goes_on_from_its_checkpoint() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let long = long(at);
    linkwright(at, &with(&long, &["whole", "--set", "solve.evaluations=400000"]));
    let words = with(&long, &["killed", "--set", "solve.evaluations=400000"]);
    let child = command(at, &words).stderr(Stdio::null()).stdout(Stdio::null()).spawn();
    let mut child = child.expect("it runs");
    let begun = Instant::now();
    while !at.join("killed/checkpoint.json").exists() && begun.elapsed() < Duration::from_secs(30) {
        if child.try_wait().expect("it can be asked").is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    // Where the search was over within a second there is nothing to kill: the run is done.
    let _ = child.kill();
    let _ = child.wait();
    let resumed = linkwright(at, &with(&long, &["killed", "--set", "solve.evaluations=400000", "--resume"]));
    assert!(resumed.code <= 1, "{}", resumed.stderr);
    assert_eq!(read(at, "killed/record.json"), read(at, "whole/record.json"));
    assert!(!at.join("killed/checkpoint.json").exists());
}
