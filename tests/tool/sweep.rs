//! `sweep plan`, `sweep run` and `sweep merge`: the same bytes whoever ran the shards, in whatever order, however often
//! interrupted.

use crate::common::root;
use assert_cmd::cargo::CommandCargoExt;
use linkwright::internals::app::sweep::{
    How, PlanOptions, SweepError, merge, open, plan, run_missing, run_shard,
};
use linkwright::internals::files::sweep_file;
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const PROBLEM: &str = "format = 1\nname = \"small\"\n[task.path]\npoints = [[0, 0], [2, 1], [4, 1], [5, 0], [6, -2]]\n\
                       [solve]\ncandidates = 1\nevaluations = 2000\nadvice = false\n";

const SWEEP: &str = "format = 1\nproblem = \"small.toml\"\n[vary]\n\
                     require.transmission_deg_min = { from = 10, to = 50, steps = 5 }\nsolve.seed = [1, 2, 3, 4]\n";

/// A folder with the small problem and a sweep of it.
fn folder(sweep: &str) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("written");
    fs::write(folder.path().join("it.toml"), sweep).expect("written");
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments);
    command
}

/// Runs the program; returns its exit code, its answer and its messages.
fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = command(folder, arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let (code, stdout, stderr) = linkwright(folder, arguments);
    assert_eq!(code, 0, "{arguments:?}: {stdout}{stderr}");
    stdout
}

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(path.as_ref()).unwrap_or_else(|e| panic!("{}: {e}", path.as_ref().display()))
}

/// The merged files of a sweep.
fn merged(folder: &Path) -> [String; 4] {
    ["sweep.csv", "sweep.jsonl", "sweep.svg", "sweep.html"].map(|name| read(folder.join(name)))
}

static NEVER: AtomicBool = AtomicBool::new(false);

fn how(threads: usize, cancel: &AtomicBool) -> How<'_> {
    How { threads: Some(threads), cancel, observer: &|_, _| {} }
}

/// Plans a sweep with shards of three jobs.
fn planned(at: &Path, out: &str) -> std::path::PathBuf {
    let out = at.join(out);
    let options = PlanOptions { shard_size: Some(3), ..PlanOptions::default() };
    let plan = plan(&at.join("it.toml"), &out, options, &how(1, &NEVER)).expect("a plan");
    assert_eq!((plan.jobs, plan.shards), (20, 7));
    out
}

/// The folder of the sweep, run by one thread and merged: what others are compared with.
fn run_by_one_process(at: &Path) -> std::path::PathBuf {
    let out = planned(at, "first");
    run_missing(&out, &how(1, &NEVER)).expect("it runs");
    merge(&out).expect("it merges");
    out
}

#[test]
fn every_job_is_a_row_that_equals_the_run_of_its_problem() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let told = succeeds(at, &["sweep", "plan", "it.toml", "--out", "out", "--shard-size", "7"]);
    assert!(told.contains("20 jobs in 3 shards of 7"), "{told}");
    let told = succeeds(at, &["sweep", "run", "out"]);
    assert!(told.contains("3 shards run: 20 rows"), "{told}");
    let told = succeeds(at, &["sweep", "merge", "out"]);
    assert!(told.contains("20 rows"), "{told}");
    let rows: Vec<Value> = read(at.join("out/sweep.jsonl"))
        .lines()
        .map(|line| serde_json::from_str(line).expect("a row"))
        .collect();
    assert_eq!(rows.len(), 20);
    let table = read(at.join("out/sweep.csv"));
    let head = table.lines().next().expect("a header row");
    assert!(head.starts_with("job,require.transmission_deg_min,solve.seed,status,termination,"), "{head}");
    for (i, row) in rows.iter().enumerate() {
        let (angle, seed) = (10 + 10 * (i / 4), 1 + i % 4);
        assert_eq!(row["job"], i);
        assert_eq!(row["values"]["require.transmission_deg_min"], angle);
        assert_eq!(row["values"]["solve.seed"], seed);
        assert!(row["record"].is_null());
        let line = table.lines().nth(i + 1).expect("a line");
        assert!(
            line.starts_with(&format!("{i},{angle},{seed},{},", row["status"].as_str().unwrap())),
            "{line}"
        );
        if i % 7 == 0 {
            let set = [format!("require.transmission_deg_min={angle}"), format!("solve.seed={seed}")];
            let run = command(
                at,
                &["synth", "small.toml", "--set", &set[0], "--set", &set[1], "--json", "--quiet"],
            )
            .output()
            .expect("it runs");
            let record: Value = serde_json::from_slice(&run.stdout).expect("a record");
            let best = &record["candidates"][0];
            for (ours, theirs) in [
                (&row["best"]["error"], &best["error"]),
                (&row["best"]["linkage"], &best["linkage"]),
                (&row["best"]["type"], &best["type"]),
                (&row["best"]["transmission_worst_deg"], &best["transmission_deg"]["worst"]),
                (&row["best"]["link_ratio"], &best["link_ratio"]),
                (&row["best"]["accepted"], &best["accepted"]),
                (&row["termination"], &record["termination"]["reason"]),
                (&row["evaluations"], &record["evaluations"]["objective"]),
            ] {
                assert_eq!(ours, theirs, "job {i}");
            }
        }
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads_order_or_interruptions() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let first = run_by_one_process(at);
    let wanted = merged(&first);
    for seed in 0..6 {
        let out = planned(at, &format!("out{seed}"));
        let mut random = stream(seed, 7);
        // Shards one by one in any order, some twice, with one to three threads; in between runs of all that are
        // interrupted after a few jobs.
        for _ in 0..5 {
            let shard = (unit(&mut random) * 7.0) as u64;
            let done = run_shard(&out, shard, &how(1 + seed as usize % 3, &NEVER)).expect("it runs");
            assert_eq!((done.shard, done.rows), (shard, if shard == 6 { 2 } else { 3 }));
            let again = run_shard(&out, shard, &how(2, &NEVER)).expect("it runs");
            assert!(again.before && again.sha256 == done.sha256);
            let (cancel, most) = (AtomicBool::new(false), (unit(&mut random) * 9.0) as u64);
            let observer = |done: u64, _: u64| {
                if done >= most {
                    cancel.store(true, Ordering::Relaxed);
                }
            };
            run_missing(&out, &How { threads: Some(2), cancel: &cancel, observer: &observer })
                .expect("it runs");
        }
        let ran = run_missing(&out, &how(3, &NEVER)).expect("it runs");
        assert!(!ran.cancelled && ran.rows == 20 && ran.before + ran.done.len() as u64 == 7);
        merge(&out).expect("it merges");
        assert!(merged(&out) == wanted, "seed {seed}");
        assert_eq!(read(out.join("plan.json")), read(first.join("plan.json")));
    }
}

#[test]
fn a_killed_run_loses_no_shard_and_leaves_no_half_of_one() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let first = planned(at, "first");
    run_missing(&first, &how(2, &NEVER)).expect("it runs");
    merge(&first).expect("it merges");
    let out = planned(at, "out");
    let count = || {
        fs::read_dir(out.join("shards"))
            .expect("a folder")
            .filter(|e| e.as_ref().expect("an entry").path().extension().is_some_and(|e| e == "jsonl"))
            .count()
    };
    for kill in 1..=3 {
        let mut child = command(at, &["sweep", "run", "out", "--threads", "2", "--quiet"])
            .stdout(Stdio::null())
            .spawn()
            .expect("it runs");
        let since = Instant::now();
        while count() < 2 * kill
            && since.elapsed() < Duration::from_secs(60)
            && child.try_wait().expect("it is ours").is_none()
        {
            std::thread::sleep(Duration::from_millis(2));
        }
        let _ = child.kill();
        child.wait().expect("it ends");
        assert!(count() >= 2 * kill, "{} shards after kill {kill}", count());
    }
    succeeds(at, &["sweep", "run", "out"]);
    succeeds(at, &["sweep", "merge", "out"]);
    assert!(merged(&out) == merged(&first));
}

/// Shuffles by draws that a seed decides.
fn shuffled<T>(mut items: Vec<T>, seed: u64) -> Vec<T> {
    let mut random = stream(seed, 11);
    for i in (1..items.len()).rev() {
        items.swap(i, (unit(&mut random) * (i + 1) as f64) as usize);
    }
    items
}

/// Runs commands, three of them at a time; all succeed.
fn three_at_a_time(mut commands: Vec<Command>) {
    for commands in commands.chunks_mut(3) {
        let begin = |command: &mut Command| command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let children: Vec<_> = commands.iter_mut().map(|command| begin(command).expect("it runs")).collect();
        for child in children {
            let output = child.wait_with_output().expect("it ends");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

#[test]
fn shards_run_by_processes_of_their_own_have_the_bytes_of_one_process() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let first = run_by_one_process(at);
    for seed in 0..3 {
        let name = format!("out{seed}");
        let out = planned(at, &name);
        // Each shard once, three of them twice, and one that begins twice at the same time.
        let mut shards = shuffled((0..7).chain([0, 3, 6]).collect(), seed);
        shards.splice(0..0, [5, 5]);
        let run = |shard: &u64| {
            let shard = shard.to_string();
            command(at, &["sweep", "run", &name, "--shard", &shard, "--threads", "1", "--quiet"])
        };
        three_at_a_time(shards.iter().map(run).collect());
        succeeds(at, &["sweep", "merge", &name]);
        assert!(merged(&out) == merged(&first), "{shards:?}");
        for shard in 0..7 {
            let file = format!("shards/{shard}.jsonl");
            assert_eq!(read(out.join(&file)), read(first.join(&file)), "{shards:?}");
        }
        assert_eq!(fs::read_dir(out.join("shards")).expect("a folder").count(), 7, "{shards:?}");
    }
}

#[cfg(unix)]
#[test]
fn the_job_array_of_the_document_runs_every_shard() {
    let document = read(root().join("docs/python.md"));
    let (_, recipe) = document.split_once("```bash\n#!/bin/bash\n#SBATCH --array").expect("the recipe");
    let (recipe, _) = recipe.split_once("```").expect("its end");
    let folder = folder(SWEEP);
    let at = folder.path();
    let (first, out) = (run_by_one_process(at), planned(at, "out"));
    let place = out.display().to_string();
    let script = format!("set -e\n#{recipe}").replace("/shared/me/sweep", &place).replace("1000", "4");
    assert!(script.contains(&format!("{place}/plan.json")) && script.contains("i += 4"), "{script}");
    let program = assert_cmd::cargo::cargo_bin("linkwright");
    let beside = program.parent().expect("a folder").to_path_buf();
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::env::join_paths(std::iter::once(beside).chain(std::env::split_paths(&paths)));
    let paths = paths.expect("a list of folders");
    let task = |number: u64| {
        let mut task = Command::new("bash");
        task.args(["-c", &script]).env("PATH", &paths).env("SLURM_ARRAY_TASK_ID", number.to_string());
        task
    };
    three_at_a_time(vec![task(3), task(1)]);
    let (code, _, stderr) = linkwright(at, &["sweep", "merge", "out"]);
    assert!(code == 2 && stderr.contains("of 7 shards are missing"), "{stderr}");
    three_at_a_time([2, 0, 3, 1].map(task).into());
    succeeds(at, &["sweep", "merge", "out"]);
    assert!(merged(&out) == merged(&first));
}

#[test]
fn half_written_files_of_killed_processes_are_removed_when_they_are_old() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let out = planned(at, "out");
    run_missing(&out, &how(2, &NEVER)).expect("it runs");
    merge(&out).expect("it merges");
    let wanted = merged(&out);
    let hour = Duration::from_secs(3600);
    let aged = |name: &str, age: Duration| {
        let path = out.join(name);
        fs::write(&path, "half a sh").expect("written");
        let file = fs::File::options().write(true).open(&path).expect("opened");
        file.set_modified(std::time::SystemTime::now() - age).expect("aged");
        path
    };
    let gone = [aged("shards/.linkwright-a1B2c3", 25 * hour), aged(".linkwright-Zz09yX", 300 * hour)];
    let kept = [
        aged("shards/.linkwright-a1B2c4", 23 * hour),
        aged("shards/.linkwright-fresh0", Duration::ZERO),
        aged("shards/.linkwright-longer-name", 300 * hour),
        aged("shards/notes.txt", 300 * hour),
    ];
    // A file that another machine is writing, or that nobody will, hinders no run.
    let ran = run_missing(&out, &how(1, &NEVER)).expect("it runs");
    assert_eq!((ran.before, ran.rows, ran.done.len()), (7, 20, 0));
    // While shards are missing, all stays.
    let shard = fs::read(out.join("shards/4.jsonl")).expect("a shard");
    fs::remove_file(out.join("shards/4.jsonl")).expect("removed");
    assert!(matches!(merge(&out), Err(SweepError::Missing { .. })));
    assert!(gone.iter().all(|path| path.exists()));
    fs::write(out.join("shards/4.jsonl"), shard).expect("written");
    merge(&out).expect("it merges");
    assert!(gone.iter().all(|path| !path.exists()));
    assert!(kept.iter().all(|path| path.exists()));
    assert!(merged(&out) == wanted);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_complete_shards_and_the_next_run_goes_on() {
    let folder = folder(&SWEEP.replace("[1, 2, 3, 4]", "{ from = 1, to = 400, steps = 400 }"));
    let at = folder.path();
    succeeds(at, &["sweep", "plan", "it.toml", "--out", "out", "--shard-size", "10"]);
    let child = command(at, &["sweep", "run", "out", "--quiet"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs");
    let since = Instant::now();
    while !at.join("out/shards/1.jsonl").exists() && since.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    let interrupted = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(interrupted.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("complete shards are kept") && told.contains("goes on"), "{told}");
    let (code, _, stderr) = linkwright(at, &["sweep", "merge", "out"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("of 200 shards are missing") && stderr.contains("sweep run out"), "{stderr}");
}

#[test]
fn damaged_shards_are_made_again_and_those_of_another_plan_are_refused() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let out = planned(at, "out");
    run_missing(&out, &how(2, &NEVER)).expect("it runs");
    merge(&out).expect("it merges");
    let wanted = merged(&out);
    let damages: [&dyn Fn(&str) -> String; 5] = [
        &|text| text[..text.len() / 2].to_owned(),
        &|text| text.replacen("\"evaluations\":", "\"evaluations\": ", 1),
        &|_| String::new(),
        &|text| format!("{text}{}\n", text.lines().last().expect("a row")),
        &|_| "milk, eggs, butter\n".to_owned(),
    ];
    for (i, damage) in damages.iter().enumerate() {
        let shard = out.join(format!("shards/{i}.jsonl"));
        let whole = read(&shard);
        fs::write(&shard, damage(&whole)).expect("written");
        let why = merge(&out).expect_err("it is damaged").to_string();
        assert!(why.contains("is damaged: ") && why.contains("makes it again"), "{why}");
        assert_eq!(merged(&out), wanted, "a refused merge changes nothing");
        let ran = run_missing(&out, &how(1, &NEVER)).expect("it runs");
        assert_eq!((ran.before, ran.done.len()), (6, 1));
        assert_eq!(read(&shard), whole);
    }
    // The problem is edited: the plan keeps its text, and a new plan is another one.
    fs::write(at.join("small.toml"), PROBLEM.replace("[2, 1]", "[2, 1.5]")).expect("written");
    merge(&out).expect("it merges");
    assert_eq!(merged(&out), wanted);
    let options = PlanOptions { shard_size: Some(3), ..PlanOptions::default() };
    let why =
        plan(&at.join("it.toml"), &out, options, &how(1, &NEVER)).expect_err("another plan").to_string();
    assert!(why.contains("another plan") && why.contains("--force"), "{why}");
    let other = planned(at, "other");
    fs::copy(out.join("shards/0.jsonl"), other.join("shards/0.jsonl")).expect("copied");
    for why in
        [run_shard(&other, 0, &how(1, &NEVER)).map(drop), run_missing(&other, &how(1, &NEVER)).map(drop)]
    {
        assert!(matches!(why, Err(SweepError::OtherPlan(_))), "{why:?}");
    }
    let options = PlanOptions { replace: true, ..options };
    plan(&at.join("it.toml"), &out, options, &how(1, &NEVER)).expect("replaced");
    assert!(!out.join("shards/0.jsonl").exists() && !out.join("sweep.csv").exists());
}

#[test]
fn an_equal_plan_keeps_its_shards_and_a_changed_one_is_refused() {
    let folder = folder(SWEEP);
    let at = folder.path();
    let out = planned(at, "out");
    run_shard(&out, 2, &how(1, &NEVER)).expect("it runs");
    planned(at, "out");
    assert!(out.join("shards/2.jsonl").exists());
    let text = read(out.join("plan.json"));
    let changed = [
        text.replace("\"shard_size\": 3", "\"shard_size\": 4"),
        text.replace("[2, 1]", "[2, 9]"),
        text.replace("\"version\": \"", "\"version\": \"9."),
        "{}".into(),
        text[..text.len() / 2].to_owned(),
    ];
    for changed in changed {
        assert_ne!(changed, text);
        fs::write(out.join("plan.json"), changed).expect("written");
        let (code, _, stderr) = linkwright(at, &["sweep", "run", "out"]);
        assert!(code == 2 && stderr.contains("plan"), "{stderr}");
    }
    fs::write(out.join("plan.json"), text).expect("written");
    let (code, _, stderr) = linkwright(at, &["sweep", "run", "out", "--shard", "7"]);
    assert!(code == 2 && stderr.contains("there is no shard 7: this sweep has shards 0 to 6"), "{stderr}");
    let (code, _, stderr) = linkwright(at, &["sweep", "run", "nowhere"]);
    assert!(code == 2 && stderr.contains("nowhere holds no plan"), "{stderr}");
    fs::create_dir(at.join("mine")).expect("made");
    fs::write(at.join("mine/diary.txt"), "mine").expect("written");
    let (code, _, stderr) =
        linkwright(at, &["sweep", "plan", "it.toml", "--out", "mine", "--shard-size", "1"]);
    assert!(code == 2 && stderr.contains("diary.txt"), "{stderr}");
    assert!(!at.join("mine/plan.json").exists());
}

#[test]
fn contradictory_values_are_rows_and_words_and_lists_can_vary() {
    let sweep = "format = 1\nproblem = \"small.toml\"\n[vary]\ndesign.b = [[1, 3], [6, 9]]\n\
                 [vary.require]\ntype = [\"crank-rocker\", \"double-rocker\"]\n\
                 [vary.design.a]\nfrom = 2.5\nto = 3.5\nsteps = 2\n";
    let folder = folder(sweep);
    let at = folder.path();
    fs::write(at.join("small.toml"), PROBLEM.to_owned() + "[design]\nd = [1, 2]\ne = [1, 2]\n")
        .expect("written");
    succeeds(at, &["sweep", "plan", "it.toml", "--out", "out"]);
    succeeds(at, &["sweep", "run", "out"]);
    let (_, told, _) = linkwright(at, &["sweep", "merge", "out"]);
    assert!(told.contains("4 refused as their values contradict each other"), "{told}");
    let table = read(at.join("out/sweep.csv"));
    assert!(table.starts_with("job,design.b,require.type,design.a,status,"), "{table}");
    let refused: Vec<&str> = table.lines().filter(|line| line.contains(",refused,")).collect();
    assert_eq!(refused.len(), 4, "{table}");
    for line in refused {
        assert!(line.contains("\"[6, 9]\"") && line.contains("impossible triangle"), "{line}");
    }
    let page = read(at.join("out/sweep.html"));
    assert!(page.contains("What was refused") && page.contains("impossible triangle"));
}

#[test]
fn a_record_is_kept_where_it_is_asked_for() {
    let folder = folder(SWEEP);
    let at = folder.path();
    succeeds(at, &["sweep", "plan", "it.toml", "--out", "out", "--shard-size", "10", "--records"]);
    succeeds(at, &["sweep", "run", "out"]);
    succeeds(at, &["sweep", "merge", "out"]);
    let rows = read(at.join("out/sweep.jsonl"));
    let row: Value = serde_json::from_str(rows.lines().nth(5).expect("a row")).expect("JSON");
    let run = command(
        at,
        &[
            "synth",
            "small.toml",
            "--set",
            "require.transmission_deg_min=20",
            "--seed",
            "2",
            "--json",
            "--quiet",
        ],
    )
    .output()
    .expect("it runs");
    let record: Value = serde_json::from_slice(&run.stdout).expect("a record");
    assert_eq!(row["record"], record);
}

#[test]
fn points_and_drawings_are_in_the_plan() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for (name, text) in [
        ("one.csv", "x,y\n0,0\n2,1\n4,1\n5,0\n6,-2\n"),
        ("two.csv", "x,y\n0,0\n2,1.5\n4,1\n5,0\n6,-2\n"),
        ("oval.svg", "<svg><ellipse cx='5' cy='5' rx='4' ry='2'/></svg>"),
        (
            "it.toml",
            "format = 1\nproblem = \"p.toml\"\n[vary]\n\"task.path.file\" = [\"one.csv\", \"two.csv\"]\n",
        ),
        (
            "p.toml",
            "format = 1\n[task.path]\nfile = \"one.csv\"\n[solve]\nevaluations = 500\nadvice = false\n",
        ),
        (
            "drawn.toml",
            "format = 1\nproblem = \"oval.svg\"\n[vary]\ntask.path.samples = [8, 12]\nsolve.evaluations = [500]\nsolve.advice = [false]\n",
        ),
    ] {
        fs::write(at.join(name), text).expect("written");
    }
    for (sweep, out) in [("it.toml", "out"), ("drawn.toml", "drawn")] {
        succeeds(at, &["sweep", "plan", sweep, "--out", out, "--shard-size", "1"]);
    }
    for gone in ["one.csv", "two.csv", "oval.svg", "p.toml"] {
        fs::remove_file(at.join(gone)).expect("removed");
    }
    for out in ["out", "drawn"] {
        succeeds(at, &["sweep", "run", out]);
        linkwright(at, &["sweep", "merge", out]);
        let rows = read(at.join(out).join("sweep.jsonl"));
        assert_eq!(rows.lines().count(), 2);
        assert!(!rows.contains("refused"), "{rows}");
    }
}

#[test]
fn the_default_size_of_a_shard_is_the_same_on_every_run() {
    let folder = folder(SWEEP);
    let at = folder.path();
    for (out, threads) in [("one", 1), ("two", 2)] {
        plan(&at.join("it.toml"), &at.join(out), PlanOptions::default(), &how(threads, &NEVER))
            .expect("a plan");
    }
    assert_eq!(read(at.join("one/plan.json")), read(at.join("two/plan.json")));
    assert!(open(&at.join("one")).expect("a plan").shard_size > 1);
}

/// Every broken sweep file under `tests/bad/sweeps` is refused with the words beside it.
#[test]
fn every_bad_sweep_is_refused_in_the_expected_words() {
    let folder = root().join("tests/bad/sweeps");
    let mut files: Vec<_> = fs::read_dir(&folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .filter(|path| !path.file_name().expect("a name").to_string_lossy().starts_with("good-"))
        .collect();
    files.sort();
    let mut wrong = String::new();
    for path in &files {
        let prefix = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
        let shown = match sweep_file::load(path) {
            Ok(_) => "it was accepted\n".to_owned(),
            Err(diagnostic) => diagnostic.to_string().replace(&prefix, "") + "\n",
        };
        let expected = path.with_extension("toml.expected");
        if std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some() {
            fs::write(&expected, &shown).expect("written");
        }
        if shown != fs::read_to_string(&expected).unwrap_or_default().replace("\r\n", "\n") {
            wrong += &format!("--- {}\n{shown}", path.display());
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(files.len() >= 20, "only {} files", files.len());
}

#[test]
fn a_sweep_whose_jobs_can_all_not_run_is_refused() {
    let folder = folder("format = 1\nproblem = \"small.toml\"\n[vary]\ntask.path.tolerance = [-1, -2]\n");
    let at = folder.path();
    let (code, _, stderr) = linkwright(at, &["sweep", "plan", "it.toml", "--out", "out"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("no job of this sweep can be run: tolerance = -1"), "{stderr}");
    assert!(!at.join("out").exists());
    let checked = succeeds(at, &["check", "it.toml"]);
    assert!(checked.contains("sweep it: 2 jobs of small.toml over task.path.tolerance"), "{checked}");
}
