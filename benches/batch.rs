//! What a batch costs beyond its searches, and what checkpoints cost a search.
//!
//! ```text
//! a job's overhead = (wall time x threads - sum of search_s - sum of beside_s) / jobs
//! busy = (user + system time of the process) / (wall time x threads)
//! ```
//!
//! `cargo bench --bench batch`; on a machine that does other things too the first figure counts these as well, so the
//! least of three runs is shown.

#![allow(clippy::print_stdout, reason = "a benchmark prints")]

use linkwright::internals::app::job::checkpoint::{Checkpoint, Writer};
use linkwright::internals::app::job::folder::{CHECKPOINT, replace_file};
use linkwright::internals::app::job::run::{Context, Job, run_kept};
use linkwright::internals::files::problem_file;
use linkwright::internals::synthesis::keeper::{Keeper, LEAST_PAUSE, SearchState};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const JOBS: usize = 1000;
const THREADS: usize = 2;

fn small(i: usize) -> String {
    format!(
        "format = 1\nname = \"small {i}\"\n[task.path]\npoints = [[0, 0], [2, {}], [4, 1], [5, 0], [6, -2]]\n\
         [solve]\ncandidates = 1\nseed = {i}\n",
        1.0 + 0.001 * i as f64
    )
}

/// Seconds of processor time of the children that have ended (Linux; ticks are hundredths of a second there).
fn children_s() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |i: usize| fields.get(i)?.parse::<f64>().ok();
    Some((ticks(13)? + ticks(14)?) / 100.0)
}

fn batch(place: &Path) {
    let problems = place.join("problems");
    fs::create_dir(&problems).expect("a folder");
    for i in 0..JOBS {
        fs::write(problems.join(format!("p{i:04}.toml")), small(i)).expect("there is room");
    }
    let mut least = (f64::INFINITY, String::new());
    for run in 0..3 {
        let out = place.join(format!("out-{run}"));
        let before = children_s();
        let begun = Instant::now();
        let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
        command.arg("synth").arg(&problems).arg("--out").arg(&out).arg("--quiet");
        let status = command.args(["--threads", &THREADS.to_string()]).stdout(Stdio::null()).status();
        let wall = begun.elapsed().as_secs_f64();
        assert_eq!(status.expect("it runs").code(), Some(0));
        let mut searched = 0.0;
        for i in 0..JOBS {
            let text = fs::read(out.join(format!("small {i}/timing.json"))).expect("every job is done");
            let timing: serde_json::Value = serde_json::from_slice(&text).expect("it is whole");
            searched += timing["search_s"].as_f64().expect("s") + timing["beside_s"].as_f64().expect("s");
        }
        let (jobs, wall_s) = (JOBS as f64, wall * THREADS as f64);
        let overhead = (wall_s - searched) / jobs * 1e3;
        let used = before.zip(children_s()).map(|(before, after)| after - before);
        let busy = used.map_or("?".into(), |used| format!("{:.0} %", 100.0 * used / wall_s));
        let beyond = used.map_or("?".into(), |used| format!("{:.2} ms", (used - searched) / jobs * 1e3));
        if overhead < least.0 {
            let search = searched / jobs * 1e3;
            let line = format!(
                "{JOBS} jobs on {THREADS} threads: {wall:.2} s; a job: search {search:.2} ms, beyond it \
                 {overhead:.2} ms of the threads' time ({beyond} of processor time); busy {busy}"
            );
            least = (overhead, line);
        }
    }
    println!("{}", least.1);
}

/// A search that is measured lasts at least this long, and keeps its state at least so often.
const LEAST_S: f64 = 4.0;
const LEAST_KEPT: usize = 3;

/// A search that does not end by itself within its time limit, so that states are kept at their usual pace.
fn checkpoints(place: &Path, problem: &str, method: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/literature").join(problem);
    let set = [
        ("solve.method", method),
        ("solve.candidates", "40"),
        ("solve.evaluations", "1e8"),
        ("solve.time_limit_s", "12"),
    ];
    let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let file = problem_file::load(&file, &set).expect("it is a problem");
    let job = Job { name: file.name, source: file.source, unit: file.unit, spec: file.spec, front: None };
    let writer = Writer::new(&job).expect("it has a digest");
    let spent = Mutex::new((0_usize, Duration::ZERO, 0));
    let sink = |state: &SearchState| {
        let begun = Instant::now();
        let bytes = writer.bytes(state).expect("it reads back");
        replace_file(place, CHECKPOINT, &bytes).expect("there is room");
        let mut spent = spent.lock().expect("no panic");
        *spent = (spent.0 + 1, spent.1 + begun.elapsed(), bytes.len());
    };
    let keeper = Keeper::new(SearchState::default(), LEAST_PAUSE, &sink);
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let finished = run_kept(&job, &context, Some(&keeper)).expect("it runs");
    let (count, spent, bytes) = *spent.lock().expect("no panic");
    let search_s = finished.search_s;
    assert!(search_s >= LEAST_S, "{problem}, {method}: over after {search_s:.2} s, too short to be measured");
    assert!(count >= LEAST_KEPT, "{problem}, {method}: {count} checkpoints in {search_s:.2} s");
    let kept = Checkpoint::read(&place.join(CHECKPOINT), &job).expect("it is whole").expect("it is there");
    assert_eq!(kept.leads_to(&job), None, "the search could go on from the last one");
    println!(
        "{problem}, {method}: {count} checkpoints (the last of {} kB) in {search_s:.2} s of search: {:.2} % of it",
        bytes / 1000,
        100.0 * spent.as_secs_f64() / search_s
    );
}

fn main() {
    let place = tempfile::tempdir().expect("a folder");
    batch(place.path());
    for (problem, method) in [
        ("shape-square.toml", "least-squares"),
        ("k18f.toml", "genetic"),
        ("k18f.toml", "differential-evolution"),
    ] {
        checkpoints(place.path(), problem, method);
    }
}
