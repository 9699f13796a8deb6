//! Machines are switched off and disks are full: no torn file, no lost result, and an error that says what to do.

use crate::common::root;
use crate::common::thorough::is_thorough;
use linkwright::internals::app::job::checkpoint;
use linkwright::internals::app::job::folder::{ResultsFolder, read_record};
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, stream, unit};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_linkwright");
/// Returns how many processes are killed.
fn kills_wanted() -> usize {
    if is_thorough() { 200 } else { 40 }
}

/// A job of some milliseconds: searching and writing take about the same time.
const PROBLEM: &str = "format = 1
name = \"small\"
[task.path]
points = [[0, 0], [1, 2], [2, 2.5], [3, 2], [4, 0]]
[solve]
candidates = 2
evaluations = 3000
";
/// What tells of time and differs from run to run.
const TIMING: &str = "timing.json";

type Files = BTreeMap<String, Vec<u8>>;

fn linkwright(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// The files of a folder that a person sees.
fn visible(folder: &Path) -> Files {
    let Ok(entries) = fs::read_dir(folder) else { return Files::new() };
    let entries = entries.map(|entry| entry.expect("it can be listed"));
    let named = entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()));
    let seen = named.filter(|(name, path)| !name.starts_with('.') && path.is_file());
    seen.map(|(name, path)| (name, fs::read(path).expect("it can be read"))).collect()
}

/// Without what differs from run to run, which has to be whole.
fn settled(mut files: Files) -> Files {
    if let Some(timing) = files.remove(TIMING) {
        let timing: serde_json::Value = serde_json::from_slice(&timing).expect("timing.json is whole");
        assert!(timing["total_s"].is_number());
    }
    files
}

/// A folder with a problem in it and the results of its two seeds, with the time that one takes.
fn jobs() -> (TempDir, [Files; 2], Duration) {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    let mut times = Vec::new();
    let results = ["1", "2"].map(|seed| {
        for _ in 0..3 {
            let start = Instant::now();
            let status = job(folder.path(), seed).status().expect("it runs");
            times.push(start.elapsed());
            assert!(matches!(status.code(), Some(0 | 1)), "{status}");
        }
        settled(visible(&folder.path().join("r")))
    });
    assert_ne!(results[0]["record.json"], results[1]["record.json"], "two results that can be told apart");
    times.sort();
    (folder, results, times[times.len() / 2])
}

fn job(folder: &Path, seed: &str) -> Command {
    linkwright(folder, &["synth", "small.toml", "--out", "r", "--seed", seed, "--threads", "1", "--quiet"])
}

/// Starts a job and kills it after a while; whether it was still there.
#[cfg(unix)]
fn killed(mut command: Command, after: Duration) -> bool {
    use std::os::unix::process::ExitStatusExt;
    let mut child = command.spawn().expect("it starts");
    sleep(after);
    let _ = child.kill();
    child.wait().expect("it ends").signal().is_some()
}

#[cfg(unix)]
#[test]
fn a_search_that_is_killed_at_any_instant_leaves_a_whole_result_and_can_be_run_again() {
    let (folder, results, time) = jobs();
    let place = folder.path().join("r");
    let mut random: Stream = stream(7, 1);
    let (mut kills, mut tries) = (0, 0);
    let mut instants = [0_usize; 3];
    let wanted = kills_wanted();
    while kills < wanted {
        tries += 1;
        assert!(tries < 5 * wanted, "{kills} of {tries} processes were killed");
        if below(&mut random, 5) == 0 && place.exists() {
            fs::remove_dir_all(&place).expect("it is ours");
        }
        let before = settled(visible(&place));
        let seed = below(&mut random, 2);
        let new = &results[seed];
        let after = time.mul_f64(unit(&mut random));
        if !killed(job(folder.path(), ["1", "2"][seed]), after) {
            continue;
        }
        kills += 1;
        // Each file by itself is the old one or the new one.
        for (name, bytes) in settled(visible(&place)) {
            let whole = before.get(&name) == Some(&bytes) || new.get(&name) == Some(&bytes);
            assert!(whole, "{name} is torn after {after:?}");
        }
        let read = read_record(&place).ok().map(|record| serde_json::to_vec_pretty(&record).expect("data"));
        if let Some(read) = &mut read.clone() {
            read.push(b'\n');
            let known = [before.get("record.json"), new.get("record.json")];
            assert!(known.contains(&Some(read)), "the record is neither the old one nor the new one");
        }
        assert!(read.is_some() || before.is_empty(), "a finished result was lost after {after:?}");
        // Whoever comes next finds the lock open and one result as a whole.
        drop(ResultsFolder::take(&place).expect("a lock without its process is none"));
        let now = settled(visible(&place));
        assert!(now == before || now == *new, "two results are mixed after {after:?}: {:?}", now.keys());
        instants[if now == before { usize::from(read.is_some()) } else { 2 }] += 1;
    }
    // Nothing yet, the old one, the new one.
    assert!(instants[0] > 0 && instants[1] > 0, "{instants:?}");
    let status = job(folder.path(), "1").status().expect("it runs");
    assert!(matches!(status.code(), Some(0 | 1)));
    assert_eq!(settled(visible(&place)), results[0]);
    assert!(
        fs::read_dir(&place).expect("it is there").count() == results[0].len() + 1,
        "nothing is left over"
    );
}

/// A search of some tenths of a second with many boundaries, each of which is kept.
#[cfg(unix)]
fn long_job(folder: &Path, out: &str, threads: usize) -> Command {
    let mut command =
        linkwright(folder, &["synth", "small.toml", "--out", out, "--method", "genetic", "--quiet"]);
    command.args(["--set", "solve.evaluations=10000", "--set", "solve.genetic.stall_generations=30"]);
    command.args(["--checkpoint-every", "0", "--threads", &threads.to_string()]);
    command
}

#[cfg(unix)]
#[test]
fn a_search_killed_again_and_again_goes_on_to_the_bytes_of_an_unbroken_one() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    let begun = Instant::now();
    assert!(matches!(long_job(folder.path(), "whole", 2).status().expect("it runs").code(), Some(0 | 1)));
    // A process is killed before this time is over. The machine may become slower or faster than it was for the whole
    // run: a kill lengthens the time and an end shortens it, so that about three kills come before each end.
    let mut longest = begun.elapsed().div_f64(2.0);
    let whole = settled(visible(&folder.path().join("whole")));
    let place = folder.path().join("r");
    let mut random: Stream = stream(11, 1);
    let (mut kills, mut with_checkpoint, mut ends, mut tries) = (0, 0, 0, 0);
    let wanted = kills_wanted();
    while kills < wanted || ends == 0 {
        tries += 1;
        assert!(tries < 5 * wanted, "{kills} kills, {ends} ends");
        // A run that is killed goes on, on one thread or two, until it comes to its end. The last one is left alone.
        let mut command = long_job(folder.path(), "r", 1 + below(&mut random, 2));
        command.arg("--resume");
        let after = longest.mul_f64(unit(&mut random));
        let is_killed = if kills < wanted {
            killed(command, after)
        } else {
            assert!(matches!(command.status().expect("it runs").code(), Some(0 | 1)));
            false
        };
        if is_killed {
            kills += 1;
            longest = longest.mul_f64(1.1);
            let files = visible(&place);
            let checkpoint = files.get("checkpoint.json");
            with_checkpoint += usize::from(checkpoint.is_some());
            if let Some(bytes) = checkpoint {
                checkpoint::parse("checkpoint.json", bytes).expect("a checkpoint is whole");
            }
            let is_half_done = checkpoint.is_some();
            if files.contains_key("record.json") {
                let known = settled(files).iter().all(|(name, bytes)| whole.get(name) == Some(bytes));
                assert!(known || is_half_done, "a result is not that of the unbroken run");
            }
            continue;
        }
        ends += 1;
        longest = longest.mul_f64(0.75);
        assert!(!place.join("checkpoint.json").exists() && !place.join(".lock").exists());
        assert_eq!(settled(visible(&place)), whole, "after {kills} kills");
        fs::remove_dir_all(&place).expect("it is ours");
    }
    assert!(with_checkpoint > wanted / 2, "{with_checkpoint} of {kills}");
    assert!(ends >= 2, "{ends}");
}

/// Runs a command whose files cannot be larger than so many blocks of 512 bytes, as on a disk that is full. The system
/// sends SIGXFSZ then, which ends a process that does nothing about it.
#[cfg(unix)]
fn with_room_for(blocks: usize, folder: &Path, arguments: &[&str]) -> Output {
    let script = format!("ulimit -f {blocks}; exec \"$@\"");
    let mut command = Command::new("sh");
    command.current_dir(folder).env("NO_COLOR", "1").env("TMPDIR", folder.join("temporary"));
    command.args(["-c", &script, "sh", PROGRAM]).args(arguments).stdin(Stdio::null());
    command.output().expect("it runs")
}

#[cfg(unix)]
#[test]
fn on_a_full_disk_a_result_is_written_as_a_whole_or_not_at_all() {
    let (folder, results, _) = jobs();
    fs::create_dir(folder.path().join("temporary")).expect("a folder");
    let old = visible(&folder.path().join("r"));
    let largest = results[0].values().map(Vec::len).max().expect("files");
    let sizes: Vec<usize> = results[0].values().map(|bytes| bytes.len() / 512).collect();
    let (mut full, mut written) = (0, 0);
    for blocks in sizes.into_iter().chain([0, largest / 512 + 1]) {
        let arguments = ["synth", "small.toml", "--out", "r", "--seed", "1", "--quiet", "--threads", "1"];
        let output = with_room_for(blocks, folder.path(), &arguments);
        let now = visible(&folder.path().join("r"));
        match output.status.code() {
            Some(2) => {
                full += 1;
                assert_eq!(now, old, "nothing is replaced");
                let said = said(&output);
                assert!(said.contains("error: r/") && said.contains("make room on the disk"), "{said}");
                assert!(said.contains("nor can it be saved elsewhere"), "{said}");
            }
            Some(0 | 1) => {
                written += 1;
                assert_eq!(settled(now), results[0]);
                assert!(blocks >= largest / 512);
            }
            other => panic!("{other:?}: {}", said(&output)),
        }
        assert!(!folder.path().join("r/.lock").exists());
    }
    assert!(full > 3 && written > 0, "{full} {written}");
    assert_eq!(fs::read_dir(folder.path().join("temporary")).expect("it is there").count(), 0);
}

#[cfg(unix)]
#[test]
fn no_command_leaves_half_a_file_on_a_full_disk() {
    let folder = TempDir::new().expect("a folder");
    let result = folder.path().join("r");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    assert!(matches!(job(folder.path(), "1").status().expect("it runs").code(), Some(0 | 1)));
    let linkage = root().join("problems/linkages/hoeken.toml").display().to_string();
    let chain = root().join("problems/linkages/jansen-leg.toml").display().to_string();
    fs::write(folder.path().join("kept.csv"), "what was there").expect("there is room");
    let before = visible(folder.path());
    let commands: [&[&str]; 11] = [
        &["new", "fresh"],
        &["compare", "r", "--csv", "kept.csv", "--force"],
        &["compare", "r", "--csv", "fresh.csv"],
        &["compare", "r", "--svg", "fresh.svg"],
        &["compare", "r", "--html", "kept.csv", "--force"],
        &["analyze", &linkage, "--csv", "kept.csv", "--force"],
        &["analyze", &linkage, "--svg", "fresh.svg"],
        &["analyze", &chain, "--csv", "fresh.csv"],
        &["analyze", &chain, "--svg", "fresh.svg"],
        &["cognates", &linkage],
        &["cognates", &linkage, "--svg", "fresh.svg"],
    ];
    for arguments in commands {
        let output = with_room_for(0, folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains("make room on the disk"), "{arguments:?}: {}", said(&output));
        assert_eq!(visible(folder.path()), before, "{arguments:?}");
        assert!(fs::read_dir(folder.path()).expect("a folder").count() == before.len() + 1, "{arguments:?}");
    }
    assert!(result.join("record.json").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_printed_is_told() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    assert!(matches!(job(folder.path(), "1").status().expect("it runs").code(), Some(0 | 1)));
    let linkage = root().join("problems/linkages/hoeken.toml").display().to_string();
    let commands: [&[&str]; 7] = [
        &["schema", "problem"],
        &["completions", "bash"],
        &["man"],
        &["verify", "r"],
        &["compare", "r"],
        &["check", "small.toml"],
        &["analyze", &linkage],
    ];
    for arguments in commands {
        let full = fs::File::options().write(true).open("/dev/full").expect("Linux has one");
        let output = Command::new(PROGRAM)
            .current_dir(folder.path())
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(said(&output).contains("cannot be written to standard output"), "{}", said(&output));
    }
}

#[test]
fn a_place_that_takes_no_files_is_told_before_the_search() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    let mut places = vec![("small.toml", "is a file"), ("small.toml/r", "")];
    if cfg!(target_os = "linux") {
        places.extend([("/proc/r", ""), ("/dev/full", "is a file")]);
    }
    for (place, words) in places {
        let output = Command::new(PROGRAM)
            .current_dir(folder.path())
            .args(["synth", "small.toml", "--out", place])
            .output()
            .expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{place}");
        let said = said(&output);
        assert!(said.contains(place) && said.contains(words) && said.lines().count() == 1, "{said}");
        assert!(output.stdout.is_empty());
    }
    assert_eq!(visible(folder.path()).len(), 1, "nothing is left behind");
}

type Change<'a> = &'a dyn Fn(&mut serde_json::Value);

/// A folder with a record of a small problem in which `change` was made.
fn altered(change: Change<'_>) -> (TempDir, Output) {
    let folder = TempDir::new().expect("a folder");
    let text = fs::read(root().join("tests/corpora/record/conflict.json")).expect("it is there");
    let mut record: serde_json::Value = serde_json::from_slice(&text).expect("it is JSON");
    change(&mut record);
    fs::write(folder.path().join("record.json"), record.to_string()).expect("there is room");
    let output = Command::new(PROGRAM).args(["verify"]).arg(folder.path()).output().expect("it runs");
    (folder, output)
}

#[test]
fn a_record_that_no_run_writes_is_refused_with_the_key_and_its_limit() {
    let cases: [(&str, Change<'_>); 4] = [
        ("raw.samples is 1e15, at most 100000 is read", &|record| {
            record["problem"]["resolved"]["task"]["path"]["raw"]["samples"] =
                1_000_000_000_000_000_u64.into();
        }),
        ("candidates is 101, at most 100 is read", &|record| {
            let one = record["candidates"][0].clone();
            record["candidates"] = vec![one; 101].into();
        }),
        ("a coordinate of problem.resolved.task.path is 1e13, at most 1e12 is read", &|record| {
            record["problem"]["resolved"]["task"]["path"]["points"][1] = vec![1e13, 0.0].into();
        }),
        ("candidate 1: alternatives is 101, at most 100 is read", &|record| {
            let one = record["candidates"][0]["alternatives"][0].clone();
            record["candidates"][0]["alternatives"] = vec![one; 101].into();
        }),
    ];
    for (words, change) in cases {
        let (folder, output) = altered(change);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        let file = folder.path().join("record.json").display().to_string();
        assert!(
            said.contains(&file) && said.contains(words) && said.contains("run the problem again"),
            "{said}"
        );
    }
    let (folder, output) = altered(&|_| {});
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    // Brackets in brackets are refused by the JSON reader before they fill the stack.
    fs::write(folder.path().join("record.json"), "[".repeat(1 << 20)).expect("there is room");
    let output = Command::new(PROGRAM).args(["verify"]).arg(folder.path()).output().expect("it runs");
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}

#[test]
fn brackets_in_brackets_are_refused_in_every_kind_of_file() {
    let folder = TempDir::new().expect("a folder");
    let deep = 1 << 20;
    let files = [
        ("list.toml", format!("format = 1\n[task.path]\npoints = {}", "[".repeat(deep))),
        ("tables.toml", format!("format = 1\n[task.path]\npoints = {}", "{a=".repeat(deep))),
        ("dotted.toml", format!("format = 1\na{} = 1", ".a".repeat(deep))),
        ("header.toml", format!("format = 1\n[a{}]", ".a".repeat(deep))),
        ("linkage.toml", format!("format = 1\n[linkage]\nA = {}", "[".repeat(deep))),
        ("chain.toml", format!("format = 1\n[chain]\npivots = {}", "[".repeat(deep))),
        ("deep.svg", format!("<svg>{}", "<g>".repeat(deep))),
        ("quotes.csv", format!("x,y\n{}", "\"".repeat(deep))),
    ];
    for (name, text) in &files {
        fs::write(folder.path().join(name), text).expect("there is room");
        let output =
            Command::new(PROGRAM).current_dir(folder.path()).args(["check", name]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{name}: {}", said(&output));
        assert!(said(&output).len() < 2000, "{name}");
    }
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    for (key, value) in [(format!("a{}", ".a".repeat(20_000)), "1".into()), ("a".into(), "[".repeat(60_000))]
    {
        let set = format!("{key}={value}");
        let output = Command::new(PROGRAM)
            .current_dir(folder.path())
            .args(["synth", "small.toml", "--set", &set])
            .output()
            .expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    }
}

/// A search of 0.7 s whose folder meets something once it is taken; `temporary` is where temporary files go.
fn under_way(meet: impl Fn(&Path)) -> (TempDir, Output) {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    fs::create_dir(folder.path().join("temporary")).expect("a folder");
    let place = folder.path().join("r");
    let mut command =
        linkwright(folder.path(), &["synth", "small.toml", "--out", "r", "--method", "genetic"]);
    command.args(["--set", "solve.evaluations=1e9", "--set", "solve.time_limit_s=0.7", "--threads", "1"]);
    command.args(["--set", "require.longest_max=any"]);
    command.env("TMPDIR", folder.path().join("temporary")).env("TMP", folder.path().join("temporary"));
    let child = command.stderr(Stdio::piped()).spawn().expect("it starts");
    while !place.join(".lock").exists() {
        sleep(Duration::from_millis(1));
    }
    sleep(Duration::from_millis(100));
    meet(&place);
    let output = child.wait_with_output().expect("it ends");
    (folder, output)
}

#[cfg(unix)]
#[test]
fn a_result_whose_folder_vanished_or_is_taken_is_not_lost() {
    let (folder, output) = under_way(|place| fs::remove_dir_all(place).expect("it is ours"));
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", said(&output));
    read_record(&folder.path().join("r")).expect("the folder was made anew");
    let (folder, output) = under_way(|place| {
        fs::remove_dir_all(place).expect("it is ours");
        fs::write(place, "in the way").expect("there is room");
    });
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    let (_, saved) = said.split_once("the result was saved in ").expect("it says where");
    let saved = Path::new(saved.trim());
    assert!(saved.starts_with(folder.path().join("temporary")), "{said}");
    let status = linkwright(folder.path(), &["verify"]).arg(saved).status().expect("it runs");
    assert_eq!(status.code(), Some(0));
    assert_eq!(fs::read(folder.path().join("r")).expect("it stays"), b"in the way");
}
