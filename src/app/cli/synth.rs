//! `synth`: problems in, results out.

use super::arguments::Synth;
use super::error::CommandError;
use super::inputs;
use super::inputs::Input;
use super::progress::Shown;
use super::{Ended, interrupt, refuse, terminal};
use crate::app::job::folder::{FolderError, OutputFile, Replace, check_files, write_files};
use crate::app::job::run::Job;
use crate::app::job::save;
use crate::app::job::save::{Done, Listener, Options, Ran, SaveError, Written};
use crate::files::generator::FileKind;
use crate::record::Reason;
use crate::report::batch_csv::batch_csv;
use crate::report::certificate::certificate_text;
use crate::report::exact::exact_text;
use crate::report::html::Extent;
use crate::report::plot::{Glyphs, terminal_plot};
use crate::report::table::{BatchRow, batch_summary, candidates_table};
use rayon::ThreadPool;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SendError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// From this many jobs a thread on, jobs run side by side, each on one thread: then no thread waits for another.
const JOBS_A_THREAD: usize = 4;
/// The most results of a batch that wait for the disk; then the searches wait too.
const MOST_WAITING: usize = 64;
/// The summary of a batch.
const SUMMARY: &str = "summary.csv";

/// What came of an input.
enum Outcome {
    Done(Box<Done>),
    /// Why there is no result; it has been told.
    Refused(String),
    /// A panic: a bug of ours.
    Bug,
    /// The batch was interrupted before.
    NotRun,
}

/// Runs the command.
pub fn run(options: &Synth) -> Result<Ended, Ended> {
    let start = Instant::now();
    let inputs = inputs::load(options);
    let several = inputs.len() > 1 || options.files.iter().any(|path| path.is_dir());
    let jobs = inputs.iter().filter(|input| input.job.is_ok()).count();
    if jobs == 0 {
        return Err(Ended::Refused);
    }
    if several {
        // A place that is taken is told before the searches, not after them.
        let check = |file: OutputFile<'_>| check_files(&[file], Replace::Ours(&[]));
        summary(inputs::folder_of_all(options), &batch_csv(&[]), check).map_err(refuse)?;
    }
    let threads = options.threads.map_or_else(rayon::current_num_threads, usize::from);
    let side_by_side = threads > 1 && jobs >= JOBS_A_THREAD * threads;
    let (workers, threads_each) = if side_by_side { (threads, 1) } else { (1, threads) };
    let pools = (0..workers).map(|_| rayon::ThreadPoolBuilder::new().num_threads(threads_each).build());
    let pools: Vec<_> =
        pools.collect::<Result<_, _>>().map_err(|e| refuse(format!("no threads to search with: {e}")))?;
    let batch = Batch {
        options,
        inputs: &inputs,
        several,
        side_by_side,
        start,
        cancel: interrupt::watch("saving the best so far"),
        next: AtomicUsize::new(0),
        printed: Mutex::new(Printed::new(inputs.len())),
        shown: Shown::of_batch(options.quiet || !side_by_side),
    };
    batch.search(&pools);
    let outcomes = batch.printed.into_inner().unwrap_or_else(PoisonError::into_inner).outcomes();
    Ok(conclude(options, several, &inputs, &outcomes))
}

/// The inputs of one call with the state that all workers share.
struct Batch<'a> {
    options: &'a Synth,
    inputs: &'a [Input],
    /// Whether there is a summary beside the results.
    several: bool,
    /// Whether jobs run side by side, each on one thread.
    side_by_side: bool,
    start: Instant,
    cancel: &'a AtomicBool,
    /// The first input that no worker has taken yet.
    next: AtomicUsize,
    printed: Mutex<Printed>,
    shown: Shown,
}

impl Batch<'_> {
    /// Runs every job, as many at once as there are pools, and puts the results in their places meanwhile.
    fn search(&self, pools: &[ThreadPool]) {
        std::thread::scope(|scope| {
            let (to_put, written) = sync_channel(MOST_WAITING);
            scope.spawn(move || {
                while let Ok(first) = written.recv() {
                    self.put(std::iter::once(first).chain(written.try_iter()).collect());
                }
            });
            for pool in &pools[1..] {
                let to_put = to_put.clone();
                scope.spawn(move || self.work(pool, &to_put));
            }
            self.work(&pools[0], &to_put);
        });
        self.shown.finish();
    }

    /// Takes one input after the other until all are taken.
    fn work(&self, pool: &ThreadPool, to_put: &SyncSender<(usize, Written)>) {
        loop {
            let i = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(input) = self.inputs.get(i) else { return };
            let outcome = match &input.job {
                Err(why) => Outcome::Refused(why.to_string()),
                Ok(_) if self.cancel.load(Ordering::Relaxed) && i > 0 => Outcome::NotRun,
                Ok((job, place)) => match catch_unwind(AssertUnwindSafe(|| self.one(job, place, pool))) {
                    Ok(Ok(Ran::Written(written))) => {
                        // While one thread waits for the disk the others search.
                        if let Err(SendError(alone)) = to_put.send((i, written)) {
                            self.put(vec![alone]);
                        }
                        continue;
                    }
                    Ok(Ok(Ran::Before(done))) => Outcome::Done(Box::new(done)),
                    Ok(Err(why)) => Outcome::Refused(why.to_string()),
                    Err(panic) if !self.several => resume_unwind(panic),
                    Err(_) => Outcome::Bug,
                },
            };
            self.take(i, outcome);
        }
    }

    /// Runs one job and shows its progress.
    fn one(&self, job: &Job, place: &Path, pool: &ThreadPool) -> Result<Ran, SaveError> {
        let begun = if self.several { Instant::now() } else { self.start };
        let shown = Shown::of_search(&job.name, self.options.quiet || self.side_by_side);
        let proof = Shown::of_proof(&job.name, shown.is_silent());
        let listener = Listener {
            observer: &|progress| shown.search(progress),
            proving: &|progress| {
                shown.finish();
                proof.proof(progress);
            },
            tell: &|text| terminal::tell(text),
        };
        let how = Options {
            resume: self.options.resume,
            checkpoint_every: self.options.checkpoint_every,
            extent: if self.side_by_side { Extent::Brief } else { Extent::Full },
        };
        pool.install(|| {
            let ran = save::run(job, place, how, listener, self.cancel, begun);
            shown.finish();
            ran
        })
    }

    /// Puts results in their places.
    fn put(&self, group: Vec<(usize, Written)>) {
        let (indices, written): (Vec<_>, Vec<_>) = group.into_iter().unzip();
        for (i, put) in indices.into_iter().zip(save::put_in_place(written)) {
            let refused = |why: SaveError| Outcome::Refused(why.to_string());
            self.take(i, put.map_or_else(refused, |done| Outcome::Done(Box::new(done))));
        }
    }

    /// Takes the outcome of an input and prints the pages that are due.
    fn take(&self, i: usize, outcome: Outcome) {
        if let Outcome::Refused(why) = &outcome
            && self.inputs[i].job.is_ok()
        {
            terminal::complain(why);
        }
        self.shown.one_more(self.inputs.len() as u64);
        let mut printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
        printed.take(i, outcome, |outcome| {
            if let Outcome::Done(done) = outcome
                && !self.options.json
            {
                terminal::answer(&page(done, self.several || self.options.quiet, self.options.all));
            }
        });
    }
}

/// Prints the records or the summary, writes the summary of a batch, and returns the gravest end.
fn conclude(options: &Synth, several: bool, inputs: &[Input], outcomes: &[Outcome]) -> Ended {
    let mut ended = outcomes.iter().map(ended_of).max().unwrap_or(Ended::Good);
    if options.json {
        let records = outcomes.iter().filter_map(|outcome| match outcome {
            Outcome::Done(done) => Some(&done.record),
            _ => None,
        });
        let records: Vec<_> = records.collect();
        let text = match records.as_slice() {
            [record] if !several => serde_json::to_string_pretty(record),
            [] if !several => return ended,
            records => serde_json::to_string_pretty(records),
        };
        terminal::answer(&format!("{}\n", text.unwrap_or_default()));
    }
    if several {
        let rows: Vec<BatchRow<'_>> = inputs.iter().zip(outcomes).map(|(input, o)| row(input, o)).collect();
        if !options.json {
            terminal::answer(&batch_summary(&rows, terminal::colour()));
        }
        if let Err(why) = write_summary(inputs::folder_of_all(options), &batch_csv(&rows)) {
            ended = ended.max(refuse(why));
        }
    }
    ended
}

/// Outcomes as they come in, and how many of the first have been printed: pages come in the order of the inputs.
struct Printed {
    outcomes: Vec<Option<Outcome>>,
    count: usize,
}

impl Printed {
    fn new(inputs: usize) -> Self {
        Printed { outcomes: (0..inputs).map(|_| None).collect(), count: 0 }
    }

    fn take(&mut self, i: usize, outcome: Outcome, print: impl Fn(&Outcome)) {
        self.outcomes[i] = Some(outcome);
        while let Some(Some(outcome)) = self.outcomes.get(self.count) {
            print(outcome);
            self.count += 1;
        }
    }

    fn outcomes(self) -> Vec<Outcome> {
        self.outcomes.into_iter().map(|outcome| outcome.unwrap_or(Outcome::Bug)).collect()
    }
}

fn ended_of(outcome: &Outcome) -> Ended {
    match outcome {
        Outcome::Done(done) if done.interrupted || done.record.termination.reason == Reason::Cancelled => {
            Ended::Interrupted
        }
        Outcome::Done(done) if done.record.candidates.iter().any(|c| c.accepted) => Ended::Good,
        Outcome::Done(_) => Ended::Bad,
        Outcome::Refused(_) => Ended::Refused,
        Outcome::Bug => Ended::Bug,
        Outcome::NotRun => Ended::Interrupted,
    }
}

fn row<'a>(input: &'a Input, outcome: &'a Outcome) -> BatchRow<'a> {
    let name = input.job.as_ref().map_or(input.file.as_str(), |(job, _)| &job.name);
    let outcome = match outcome {
        Outcome::Done(done) => Ok(&done.record),
        Outcome::Refused(why) => Err(why.as_str()),
        Outcome::Bug => Err("a bug of linkwright: please report it with this input"),
        Outcome::NotRun => Err("not run: the batch was interrupted before"),
    };
    BatchRow { name, outcome }
}

fn write_summary(folder: &Path, csv: &str) -> Result<(), CommandError> {
    let failed = |source| CommandError::Io { path: folder.display().to_string(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    summary(folder, csv, |file| write_files(&[file], Replace::Ours(&[])))
}

/// Does something with the summary's file. One that is a user's stays, and there is no `--force` for it.
fn summary(
    folder: &Path,
    csv: &str,
    act: impl FnOnce(OutputFile<'_>) -> Result<(), FolderError>,
) -> Result<(), CommandError> {
    let path = folder.join(SUMMARY);
    act(OutputFile { path: &path, kind: FileKind::Csv, bytes: csv.as_bytes() }).map_err(|e| match e {
        FolderError::NotOurs { path, .. } => CommandError::NotASummary { path },
        e => e.into(),
    })
}

/// What is printed for one problem.
fn page(Done { record, folder, timing, .. }: &Done, brief: bool, all: bool) -> String {
    let mut text = candidates_table(record, terminal::colour());
    text.push_str(&exact_text(record, all, terminal::colour()));
    text.push_str(&certificate_text(record, terminal::colour()));
    if !brief && terminal::stdout_is_terminal() && !record.candidates.is_empty() {
        text.push('\n');
        text.push_str(&terminal_plot(record, 0, 72, 22, Glyphs::Braille));
    }
    let shown = crate::files::diagnostic::escaped(&folder.display().to_string());
    text.push_str(&match timing {
        Some(timing) => format!("\n  {}. Written to {shown}\n", timing.words()),
        None => format!("\n  Done before: nothing was run. It stands in {shown}\n"),
    });
    if !record.candidates.is_empty() && !brief {
        let quoted = if shown.contains(' ') { format!("\"{shown}\"") } else { shown };
        text.push_str(&format!("  Look at {quoted}/candidate-1.svg, then: linkwright verify {quoted}\n"));
    }
    text.push('\n');
    text
}
