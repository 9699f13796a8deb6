//! A search that goes on from a checkpoint ends in the same bytes as one that was never broken.

use crate::common::{bytes, job, literature, parse};
use linkwright::internals::app::job::checkpoint::{Checkpoint, Writer};
use linkwright::internals::app::job::run::{Context, Job, run_kept};
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::record::{Reason, Record};
use linkwright::internals::synthesis::front::FrontRequest;
use linkwright::internals::synthesis::keeper::{Keeper, LEAST_PAUSE, SearchState};
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tempfile::TempDir;

/// Runs a job from a state; the record, and the checkpoints of all its boundaries.
fn run_from(
    job: &Job,
    state: SearchState,
    threads: usize,
    stop_after: Option<usize>,
) -> (Record, Vec<Vec<u8>>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let cancel = AtomicBool::new(false);
    let writer = Writer::new(job).expect("it has a digest");
    let written = Mutex::new(Vec::new());
    let sink = |state: &SearchState| {
        let mut written = written.lock().expect("no panic");
        written.push(writer.bytes(state).expect("it reads back"));
        if stop_after.is_some_and(|n| written.len() >= n) {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let keeper = Keeper::new(state, Duration::ZERO, &sink);
    let context = Context { cancel: &cancel, observer: &|_| {} };
    let finished = pool.install(|| run_kept(job, &context, Some(&keeper))).expect("it runs");
    (finished.record, written.into_inner().expect("no panic"))
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Folder(TempDir::new().expect("a folder"))
    }

    fn file(&self, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join("checkpoint.json");
        fs::write(&path, bytes).expect("it is written");
        path
    }

    fn state(&self, bytes: &[u8], job: &Job) -> SearchState {
        let checkpoint = Checkpoint::read(&self.file(bytes), job).expect("it is good").expect("it is there");
        assert_eq!(checkpoint.leads_to(job), None);
        checkpoint.into_state()
    }
}

/// Breaks a search at three of its boundaries, by a copy of its checkpoint and by hand, and goes on.
fn resumed_is_unbroken(file: ProblemFile, least_boundaries: usize) {
    let folder = Folder::new();
    let job = job(file);
    let (whole, checkpoints) = run_from(&job, SearchState::default(), 2, None);
    let n = checkpoints.len();
    assert!(n >= least_boundaries, "{}: {n} boundaries", job.name);
    for (i, at) in [0, n / 2, n - 1].into_iter().enumerate() {
        let state = folder.state(&checkpoints[at], &job);
        let (resumed, _) = run_from(&job, state, 1 + i % 2, None);
        assert_eq!(bytes(&resumed), bytes(&whole), "{} at boundary {at} of {n}", job.name);
    }
    let (broken, until) = run_from(&job, SearchState::default(), 1, Some(1 + n / 3));
    assert_eq!(broken.termination.reason, Reason::Cancelled);
    assert!(!broken.termination.reproducible);
    // Stopped in the middle of a batch it keeps the boundary before it, not where nothing goes on from.
    for kept in &until {
        assert!(checkpoints.contains(kept), "{}: a checkpoint that no unbroken search writes", job.name);
    }
    let state = folder.state(until.last().expect("one at least"), &job);
    let (resumed, _) = run_from(&job, state, 2, None);
    assert_eq!(bytes(&resumed), bytes(&whole), "{} broken by hand", job.name);
}

#[test]
fn genetic_and_differential_evolution() {
    let restarts = [
        ("solve.genetic.population", "40"),
        ("solve.genetic.elites", "4"),
        ("solve.genetic.stall_generations", "8"),
        ("solve.differential-evolution.population", "30"),
        ("solve.differential-evolution.stall_generations", "8"),
    ];
    for method in ["genetic", "differential-evolution"] {
        let mut set = vec![("solve.method", method), ("solve.evaluations", "5000")];
        set.extend(restarts);
        resumed_is_unbroken(literature("k18", &set), 20);
    }
    let set = [("solve.method", "differential-evolution"), ("solve.evaluations", "4000")];
    resumed_is_unbroken(literature("e5-free", &set), 20);
}

#[test]
fn a_front_between_its_generations() {
    let folder = Folder::new();
    let set = [("solve.evaluations", "40000"), ("solve.candidates", "2")];
    let request = FrontRequest { points: 6, ..FrontRequest::default() };
    let job = Job { front: Some(request), ..job(literature("k18", &set)) };
    let (whole, checkpoints) = run_from(&job, SearchState::default(), 2, None);
    assert!(whole.front.as_ref().is_some_and(|front| front.members.len() > 2));
    let state_of = |bytes: &[u8]| -> serde_json::Value { serde_json::from_slice(bytes).expect("JSON") };
    let of_front: Vec<&Vec<u8>> =
        checkpoints.iter().filter(|bytes| state_of(bytes)["state"]["front"].is_object()).collect();
    assert!(of_front.len() > 2, "{} boundaries", of_front.len());
    for (i, at) in [0, of_front.len() / 2, of_front.len() - 1].into_iter().enumerate() {
        let state = folder.state(of_front[at], &job);
        let (resumed, _) = run_from(&job, state, 1 + i % 2, None);
        assert_eq!(bytes(&resumed), bytes(&whole), "at boundary {at} of {}", of_front.len());
    }
    // A checkpoint of another front is no state of this one.
    let other = FrontRequest { points: 5, ..FrontRequest::default() };
    let other = Job { front: Some(other), ..job };
    let (whole, _) = run_from(&other, SearchState::default(), 1, None);
    let (resumed, _) = run_from(&other, folder.state(of_front[1], &other), 2, None);
    assert_eq!(bytes(&resumed), bytes(&whole));
}

#[test]
fn prescribed_timing() {
    resumed_is_unbroken(literature("k18", &[("solve.candidates", "3")]), 3);
    resumed_is_unbroken(literature("a6b", &[("solve.candidates", "2")]), 3);
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn free_timing_of_few_points_and_of_many() {
    resumed_is_unbroken(literature("k18f", &[("solve.candidates", "2")]), 3);
    resumed_is_unbroken(literature("shape-heart", &[("solve.candidates", "1")]), 3);
}

/// A path that no crank-rocker within these bounds comes near to: `auto` tries everything that it has.
const HOPELESS: &str = r#"
format = 1
name = "hopeless"
[task.path]
points = [[0, 0], [10, 0], [10, 10], [0, 10], [5, 5]]
tolerance = 1e-6
[task.path.timing]
crank_deg = [0, 60, 120, 180, 240]
[require]
type = ["crank-rocker"]
transmission_deg_min = 40
[solve]
candidates = 2
evaluations = 20000
"#;

#[test]
#[ignore = "slow: .ci/run runs it"]
fn auto_through_all_its_stages() {
    let file = parse(HOPELESS);
    let job = job(file.clone());
    let (whole, checkpoints) = run_from(&job, SearchState::default(), 2, None);
    assert!(whole.method.used.contains(&"differential-evolution".to_string()), "{:?}", whole.method.used);
    let last = String::from_utf8(checkpoints.last().expect("some").clone()).expect("text");
    assert!(last.contains("\"population\":{") && last.contains("\"timed\":{"), "{}", &last[..300]);
    resumed_is_unbroken(file, 5);
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_raised_budget_ends_as_if_it_had_been_given_from_the_beginning() {
    let folder = Folder::new();
    let with = |method: &str, evaluations: &str| {
        let set = [("solve.method", method), ("solve.evaluations", evaluations), ("solve.candidates", "9")];
        job(literature("k18f", &set))
    };
    for (method, budgets) in [("auto", ["120000", "150000"]), ("differential-evolution", ["6000", "9000"])] {
        let (less, more) = (with(method, budgets[0]), with(method, budgets[1]));
        let (whole, _) = run_from(&more, SearchState::default(), 2, None);
        let (_, checkpoints) = run_from(&less, SearchState::default(), 2, None);
        assert!(checkpoints.len() > 2, "{method}: {}", checkpoints.len());
        for at in [checkpoints.len() / 2, checkpoints.len() - 1] {
            let state = folder.state(&checkpoints[at], &more);
            let (resumed, _) = run_from(&more, state, 1, None);
            assert_eq!(bytes(&resumed), bytes(&whole), "{method} at {at}");
        }
        let path = folder.file(&run_from(&more, SearchState::default(), 2, Some(1)).1[0]);
        let checkpoint = Checkpoint::read(&path, &less).expect("it is good").expect("it is there");
        let why = checkpoint.leads_to(&less).expect("a smaller budget begins anew");
        assert!(budgets.iter().all(|budget| why.contains(budget)), "{why}");
    }
}

#[test]
fn a_checkpoint_that_is_not_what_was_written_is_refused() {
    let folder = Folder::new();
    let ours = job(literature("k18", &[("solve.candidates", "5")]));
    let (_, checkpoints) = run_from(&ours, SearchState::default(), 2, Some(2));
    let text = String::from_utf8(checkpoints[1].clone()).expect("text");
    let refused = |text: &str, job: &Job| {
        Checkpoint::read(&folder.file(text.as_bytes()), job).map(drop).expect_err("it is refused").to_string()
    };
    assert!(Checkpoint::read(&folder.file(text.as_bytes()), &ours).is_ok());
    let says = |why: String, what: &str| {
        assert!(why.contains(what) && why.contains("checkpoint.json") && why.contains("--resume"), "{why}");
    };
    says(refused(&text[..text.len() / 2], &ours), "not a whole linkwright checkpoint");
    says(refused("", &ours), "not a whole linkwright checkpoint");
    says(refused("[1, 2]", &ours), "not a whole linkwright checkpoint");
    says(refused(&text.replacen("\"state\":{", "\"state\":{\"more\":1,", 1), &ours), "unknown field");
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    says(refused(&text.replacen(&version, "\"version\":\"0.0.9\"", 1), &ours), "linkwright 0.0.9");
    says(refused(&text.replacen("\"format\":1", "\"format\":7", 1), &ours), "format 7");
    let wave = text.find("\"wave\":").expect("a counter") + 7;
    let mut changed = text.clone();
    let digit = if &text[wave..=wave] == "9" { "8" } else { "9" };
    changed.replace_range(wave..=wave, digit);
    says(refused(&changed, &ours), "checksum");
    says(refused(&text.replacen("\"candidates\":5", "\"candidates\":6", 1), &ours), "checksum");
    says(refused(&text, &job(literature("k18", &[("solve.seed", "2")]))), "another problem");
    says(refused(&text, &job(literature("e5", &[]))), "another problem");
    let other = job(literature("k18", &[("solve.candidates", "9")]));
    let checkpoint = Checkpoint::read(&folder.file(text.as_bytes()), &other).expect("it is good");
    assert!(
        checkpoint.expect("it is there").leads_to(&other).is_some_and(|why| why.contains("candidates = 5"))
    );
    let nowhere = folder.0.path().join("nothing-here.json");
    assert!(Checkpoint::read(&nowhere, &ours).expect("no error").is_none());
}

#[test]
fn a_short_search_keeps_nothing() {
    let job = job(literature("k18", &[]));
    let kept = AtomicBool::new(false);
    let sink = |_: &SearchState| kept.store(true, Ordering::Relaxed);
    let keeper = Keeper::new(SearchState::default(), LEAST_PAUSE, &sink);
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let begun = std::time::Instant::now();
    run_kept(&job, &context, Some(&keeper)).expect("it runs");
    assert!(!kept.load(Ordering::Relaxed) || begun.elapsed().as_secs_f64() >= 1.0);
}
