//! Runs long searches as jobs: begins, watches and stops them, and takes them up again. Each runs as `linkwright synth`
//! runs it, by [`save`], into a folder of its own.
//!
//! Every job has as many threads as there are cores, all of low priority, so that jobs share the cores evenly, one
//! that is alone has them all, and the hand's own answers come first. Memory holds only the progress of a job;
//! everything else is read from its folder. The problem of a job that runs is in `.studio/NAME.json`
//! beside the folders of results, until its result is saved: so one that was broken off or has failed can go on.

use super::asked::{AskError, MOST_POINTS};
use super::job_messages::{JobAsk, JobList, JobProgress, JobShown, JobState};
use super::shelf::{Shelf, ShelfError, names_in, plain_file};
use super::tab::BUG;
use crate::app::job::folder::{is_in_use, replace_file};
use crate::app::job::run::Job;
use crate::app::job::save::{self, Listener, Options, Ran};
use crate::files::name::{self, NameError};
use crate::files::problem_file::{self, ProblemFile};
use crate::report::text::at_most;
use crate::synthesis::Progress;
use crate::task::Problem;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Jobs at once.
pub(super) const MOST_JOBS: usize = 16;
/// Reasons of failed jobs that are kept.
const MOST_FAILED: usize = 64;
/// The most jobs in a list.
const MOST_LISTED: usize = 500;
/// The folder of the problems of running jobs.
const STARTED: &str = ".studio";
/// The niceness of a job's threads, above the usual.
const NICE: i32 = 10;

/// The reason why something is not done with a job.
#[derive(Debug, thiserror::Error)]
pub(super) enum Refusal {
    /// No job has this name.
    #[error("there is no job named {0}")]
    Absent(String),
    #[error("no job named {0} is running")]
    NotRunning(String),
    #[error(transparent)]
    Name(#[from] NameError),
    /// Its request makes no problem.
    #[error(transparent)]
    Ask(#[from] AskError),
    #[error("there is a result named {0} already: take another name, or replace it")]
    Taken(String),
    #[error("the folder {folder} holds the result of {other}: run it with `linkwright synth`")]
    OtherResult { folder: String, other: String },
    #[error(transparent)]
    Unreadable(#[from] ShelfError),
    #[error("a job named {0} is running")]
    Running(String),
    #[error("another program works in the folder {0}: wait for it")]
    InUse(String),
    #[error("the studio is closing")]
    Closing,
    #[error("{MOST_JOBS} jobs are running: wait for one or stop it")]
    TooMany,
    #[error("the job cannot begin: {0}")]
    NotBegun(Failure),
}

/// The reason why a job failed, whatever it was: it is only shown.
pub(super) type Failure = Box<dyn Error + Send + Sync>;

/// All jobs of a studio.
pub(super) struct Jobs {
    /// The folder of the results.
    pub(super) shelf: Shelf,
    running: Mutex<Running>,
    ended: Condvar,
}

#[derive(Default)]
struct Running {
    jobs: BTreeMap<String, Arc<OneJob>>,
    failed: BTreeMap<String, String>,
    closed: bool,
}

/// A job that runs.
struct OneJob {
    cancel: AtomicBool,
    begun: Instant,
    points: usize,
    told: Mutex<Told>,
}

#[derive(Default)]
struct Told {
    /// The latest progress, and the evaluations before the first.
    progress: Option<(Progress, u64)>,
    said: String,
}

impl OneJob {
    fn told(&self) -> MutexGuard<'_, Told> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, progress: &Progress) {
        let mut told = self.told();
        let before = told.progress.as_ref().map_or(progress.evaluations, |(_, before)| *before);
        told.progress = Some((progress.clone(), before));
    }

    /// Returns how it is shown.
    fn shown(&self, name: &str) -> JobShown {
        let said = match &*self.told().said {
            _ if self.cancel.load(Ordering::SeqCst) => "Stopping; what was found is being saved.".to_owned(),
            "" => "Searching.".to_owned(),
            said => said.to_owned(),
        };
        JobShown { progress: self.progress(), ..JobShown::new(name, JobState::Running, said, false) }
    }

    /// Returns how far it is; `None` before its search has begun.
    fn progress(&self) -> Option<JobProgress> {
        let told = self.told();
        let (progress, before) = told.progress.as_ref()?;
        let elapsed_s = self.begun.elapsed().as_secs_f64();
        let rate = progress.evaluations.saturating_sub(*before) as f64 / elapsed_s.max(1e-3);
        let left = progress.budget.saturating_sub(progress.evaluations) as f64 / rate;
        Some(JobProgress {
            phase: progress.phase.to_owned(),
            evaluations: progress.evaluations,
            budget: progress.budget,
            rate,
            best_rms: progress.best_sum_sq.map(|sum| (sum / self.points.max(1) as f64).sqrt()),
            accepted: progress.accepted,
            elapsed_s,
            left_s: Some(left).filter(|left| left.is_finite()),
        })
    }
}

impl JobAsk {
    /// Returns the problem that is asked.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn problem(&self) -> Result<ProblemFile, AskError> {
        let text = match (&self.ask, &self.problem) {
            // Read as every edit is, so that its limits hold.
            (Some(ask), None) => ask.problem_with_text()?.1,
            (None, Some(text)) => text.clone(),
            _ => return Err(AskError::NotOne),
        };
        if let Some(other) = self.set.keys().find(|key| !key.starts_with("solve.")) {
            return Err(AskError::Set(other.clone()));
        }
        let set: Vec<_> = self.set.iter().map(|(key, value)| (key.clone(), value.clone())).collect();
        let file = problem_file::parse("problem", &text, None, &set).map_err(AskError::Text)?;
        if file.spec.task.points.len() > MOST_POINTS {
            return Err(AskError::TooManyPoints);
        }
        Problem::new(file.spec.clone())?;
        Ok(file)
    }
}

impl Jobs {
    /// Creates the jobs whose results are in `folder`.
    pub(super) fn new(folder: &Path) -> Self {
        Jobs { shelf: Shelf::new(folder), running: Mutex::default(), ended: Condvar::new() }
    }

    fn running(&self) -> MutexGuard<'_, Running> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns all jobs and results, by name.
    pub(super) fn list(&self) -> JobList {
        let folder = &self.shelf.folder;
        let running: BTreeSet<String> = self.running().jobs.keys().cloned().collect();
        let mut names: BTreeSet<String> = self.running().failed.keys().chain(&running).cloned().collect();
        names.extend(names_in(folder));
        let begun = names_in(&folder.join(STARTED));
        names.extend(begun.iter().filter_map(|file| file.strip_suffix(".json")).map(str::to_owned));
        names.retain(|name| name::check(name).is_ok());
        let (mut jobs, mut more) = (Vec::new(), 0);
        for name in names {
            if jobs.len() >= MOST_LISTED && !running.contains(&name) {
                more += 1;
            } else {
                jobs.extend(self.one(&name));
            }
        }
        JobList { folder: folder.display().to_string(), jobs, more }
    }

    /// Returns one job; `None` if there is none of that name.
    pub(super) fn one(&self, name: &str) -> Option<JobShown> {
        let (job, failed) = {
            let running = self.running();
            (running.jobs.get(name).cloned(), running.failed.get(name).cloned())
        };
        if let Some(job) = job {
            return Some(job.shown(name));
        }
        let begun = self.begun(name).is_some();
        let shown = self.shelf.shown(name, begun).or_else(|| {
            let said = "The studio ended before it did. It can go on from the beginning.".to_owned();
            begun.then(|| JobShown::new(name, JobState::BrokenOff, said, true))
        });
        let Some(why) = failed else { return shown };
        let result = shown.and_then(|shown| shown.result);
        Some(JobShown { result, ..JobShown::new(name, JobState::Failed, why, begun) })
    }

    fn started(&self, name: &str) -> (PathBuf, String) {
        (self.shelf.folder.join(STARTED), format!("{name}.json"))
    }

    /// Returns the problem of a job that was begun and has not ended.
    fn begun(&self, name: &str) -> Option<JobAsk> {
        name::check(name).ok()?;
        let (folder, file) = self.started(name);
        serde_json::from_slice(&plain_file(&folder.join(file))?).ok()
    }

    /// Begins a job and returns its name.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn start(self: &Arc<Self>, ask: &JobAsk) -> Result<String, Refusal> {
        let file = ask.problem()?;
        let name = file.name.clone();
        if !ask.replace && (self.shelf.holds(&name) || self.begun(&name).is_some()) {
            return Err(Refusal::Taken(name));
        }
        self.begin(Job::from(file), Options::default(), Some(ask))?;
        Ok(name)
    }

    /// Takes up a job that was stopped or broken off, from its checkpoint where there is one.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn resume(self: &Arc<Self>, name: &str) -> Result<(), Refusal> {
        name::check(name)?;
        let how = Options { resume: true, ..Options::default() };
        if let Some(ask) = self.begun(name) {
            let file = ask.problem()?;
            return self.begin(Job::from(file), how, Some(&ask));
        }
        if self.shelf.place(name).is_none() {
            return Err(Refusal::Absent(name.to_owned()));
        }
        let asked = self.shelf.record(name)?.problem;
        if asked.name != name {
            return Err(Refusal::OtherResult { folder: name.to_owned(), other: asked.name });
        }
        self.begin(Job::from(asked), how, None)
    }

    /// Stops a job: its threads end at once, its best so far is saved.
    ///
    /// # Errors
    /// [`Refusal::NotRunning`] if no such job runs.
    pub(super) fn cancel(&self, name: &str) -> Result<(), Refusal> {
        let job = self.running().jobs.get(name).cloned();
        job.ok_or_else(|| Refusal::NotRunning(name.to_owned()))?.cancel.store(true, Ordering::SeqCst);
        Ok(())
    }

    /// Begins the work; `ask` is kept until it has ended.
    fn begin(self: &Arc<Self>, job: Job, options: Options, ask: Option<&JobAsk>) -> Result<(), Refusal> {
        let name = job.name.clone();
        let points = job.spec.task.points.len();
        let (cancel, told) = (AtomicBool::new(false), Mutex::default());
        let one = Arc::new(OneJob { cancel, begun: Instant::now(), points, told });
        {
            let mut running = self.running();
            if running.closed {
                return Err(Refusal::Closing);
            }
            if running.jobs.contains_key(&name) {
                return Err(Refusal::Running(name));
            }
            if is_in_use(&self.shelf.folder.join(&name)) {
                return Err(Refusal::InUse(name));
            }
            if running.jobs.len() >= MOST_JOBS {
                return Err(Refusal::TooMany);
            }
            running.failed.remove(&name);
            running.jobs.insert(name.clone(), Arc::clone(&one));
        }
        let jobs = Arc::clone(self);
        let begun = self.keep(&name, ask).and_then(|()| {
            let work = move || jobs.work(&job, options, &one);
            Ok(std::thread::Builder::new().name("job".into()).spawn(work)?)
        });
        begun.map(drop).map_err(|why| {
            self.over(&name, Some(&why));
            Refusal::NotBegun(why)
        })
    }

    fn keep(&self, name: &str, ask: Option<&JobAsk>) -> Result<(), Failure> {
        let Some(ask) = ask else { return Ok(()) };
        let (folder, file) = self.started(name);
        std::fs::create_dir_all(&folder)?;
        Ok(replace_file(&folder, &file, &serde_json::to_vec(ask)?)?)
    }

    fn work(&self, job: &Job, options: Options, one: &OneJob) {
        let ran = catch_unwind(AssertUnwindSafe(|| self.run(job, options, one)));
        self.over(&job.name, ran.unwrap_or_else(|_| Err(BUG.into())).err().as_ref());
    }

    fn run(&self, job: &Job, options: Options, one: &OneJob) -> Result<(), Failure> {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).start_handler(|_| stand_back());
        let pool = pool.build().map_err(|e| format!("no threads to search with: {e}"))?;
        let listener = Listener {
            observer: &|progress| one.note(progress),
            proving: &|progress| {
                one.told().said = format!("certificate: no sum below {}", at_most(progress.lower_bound, 7));
            },
            tell: &|text| one.told().said = text.into(),
        };
        let place = self.shelf.folder.join(&job.name);
        let run = || save::run(job, &place, options, listener, &one.cancel, one.begun);
        if let Ran::Written(written) = pool.install(run)? {
            for put in save::put_in_place(vec![written]) {
                put?;
            }
        }
        Ok(())
    }

    /// Notes that a job has ended. One that has failed keeps its problem, so that it can be taken up.
    fn over(&self, name: &str, failed: Option<&Failure>) {
        if failed.is_none() {
            let (folder, file) = self.started(name);
            // If the file stays, the job is shown as broken off, and can be taken up to its end.
            let _ = std::fs::remove_file(folder.join(file));
        }
        let mut running = self.running();
        running.jobs.remove(name);
        if let Some(why) = failed {
            if running.failed.len() >= MOST_FAILED {
                running.failed.pop_first();
            }
            running.failed.insert(name.to_owned(), why.to_string());
        }
        drop(running);
        self.ended.notify_all();
    }

    /// Stops every job; none begins from now on.
    pub(super) fn close(&self) {
        let mut running = self.running();
        running.closed = true;
        running.jobs.values().for_each(|job| job.cancel.store(true, Ordering::SeqCst));
    }

    /// Waits until no job runs, not longer than this.
    pub(super) fn wait(&self, longest: Duration) {
        let running = self.running();
        let waited = self.ended.wait_timeout_while(running, longest, |running| !running.jobs.is_empty());
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }
}

/// Lowers the priority of the thread that asks, where threads have one of their own.
fn stand_back() {
    #[cfg(target_os = "linux")]
    {
        // Without it the job runs as well, only beside everything else.
        let _ = rustix::process::setpriority_process(None, NICE);
    }
    #[cfg(not(target_os = "linux"))]
    let _ = NICE;
}
