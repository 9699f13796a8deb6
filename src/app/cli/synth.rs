//! `synth`: problems in, results out.

use super::arguments::Synth;
use super::inputs;
use super::inputs::Input;
use super::progress::{BatchShown, Proving, Shown};
use super::{Ended, interrupt, terminal};
pub use crate::app::result_files::{Timing, files};
use crate::app::results_folder::{FolderError, OutputFile, Replace, check_files, write_files};
use crate::app::saved_run;
use crate::app::saved_run::{Done, Listener, Options, Ran, Written};
use crate::files::generator::FileKind;
use crate::record::Reason;
use crate::report::batch_csv::batch_csv;
use crate::report::certificate::certificate_text;
use crate::report::exact::exact_text;
use crate::report::html::Extent;
use crate::report::plot::{Glyphs, terminal_plot};
use crate::report::table::{BatchOutcome, BatchRow, batch_summary, candidates_table};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
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
pub fn run(options: &Synth) -> Ended {
    let start = Instant::now();
    let inputs = inputs::load(options);
    let several = inputs.len() > 1 || options.files.iter().any(|path| path.is_dir());
    let jobs = inputs.iter().filter(|input| input.job.is_ok()).count();
    if jobs == 0 {
        return Ended::Refused;
    }
    if several {
        // A place that is taken is told before the searches, not after them.
        let check = |file: OutputFile<'_>| check_files(&[file], Replace::Ours(&[]));
        if let Err(why) = summary(inputs::folder_of_all(options), &batch_csv(&[]), check) {
            terminal::complain(&why);
            return Ended::Refused;
        }
    }
    let threads = options.threads.map_or_else(rayon::current_num_threads, usize::from);
    let side_by_side = threads > 1 && jobs >= JOBS_A_THREAD * threads;
    let (workers, threads_each) = if side_by_side { (threads, 1) } else { (1, threads) };
    let pools = (0..workers).map(|_| rayon::ThreadPoolBuilder::new().num_threads(threads_each).build());
    let pools = match pools.collect::<Result<Vec<_>, _>>() {
        Ok(pools) => pools,
        Err(e) => {
            terminal::complain(&format!("no threads to search with: {e}"));
            return Ended::Refused;
        }
    };
    let cancel = interrupt::watch("saving the best so far");
    let next = AtomicUsize::new(0);
    let printed = Mutex::new(Printed::new(inputs.len()));
    let shown_batch = BatchShown::new(inputs.len(), options.quiet || !side_by_side);
    let take = |i: usize, outcome: Outcome| {
        if let Outcome::Refused(why) = &outcome
            && inputs[i].job.is_ok()
        {
            terminal::complain(why);
        }
        shown_batch.one_more();
        let mut printed = printed.lock().unwrap_or_else(PoisonError::into_inner);
        printed.take(i, outcome, |outcome| {
            if let Outcome::Done(done) = outcome
                && !options.json
            {
                terminal::answer(&page(done, several || options.quiet, options.all));
            }
        });
    };
    let put = |group: Vec<(usize, Written)>| {
        let (indices, written): (Vec<_>, Vec<_>) = group.into_iter().unzip();
        for (i, put) in indices.into_iter().zip(saved_run::put_in_place(written)) {
            take(i, put.map_or_else(Outcome::Refused, |done| Outcome::Done(Box::new(done))));
        }
    };
    let worker = |pool: &rayon::ThreadPool, to_put: &SyncSender<(usize, Written)>| {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(input) = inputs.get(i) else { return };
            let outcome = match &input.job {
                Err(why) => Outcome::Refused(why.clone()),
                Ok(_) if cancel.load(Ordering::Relaxed) && i > 0 => Outcome::NotRun,
                Ok((job, place)) => {
                    let begun = if several { Instant::now() } else { start };
                    let shown = Shown::new(&job.name, options.quiet || side_by_side);
                    let extent = if side_by_side { Extent::Brief } else { Extent::Full };
                    let observer = |progress: &_| shown.update(progress);
                    let proving = Mutex::new(Proving::new(&job.name, shown.is_silent()));
                    let listener = Listener {
                        observer: &observer,
                        proving: &|progress| {
                            shown.finish();
                            proving.lock().unwrap_or_else(PoisonError::into_inner).update(progress);
                        },
                        tell: &|text| terminal::tell(text),
                    };
                    let how = Options {
                        resume: options.resume,
                        checkpoint_every: options.checkpoint_every,
                        extent,
                    };
                    let run = || {
                        let ran = saved_run::run(job, place, how, listener, cancel, begun);
                        shown.finish();
                        ran
                    };
                    match catch_unwind(AssertUnwindSafe(|| pool.install(run))) {
                        Ok(Ok(Ran::Written(written))) => {
                            // While one thread waits for the disk the others search.
                            if let Err(SendError(alone)) = to_put.send((i, written)) {
                                put(vec![alone]);
                            }
                            continue;
                        }
                        Ok(Ok(Ran::Before(done))) => Outcome::Done(Box::new(done)),
                        Ok(Err(why)) => Outcome::Refused(why),
                        Err(panic) if !several => resume_unwind(panic),
                        Err(_) => Outcome::Bug,
                    }
                }
            };
            take(i, outcome);
        }
    };
    std::thread::scope(|scope| {
        let (to_put, written) = sync_channel(MOST_WAITING);
        let (put, worker) = (&put, &worker);
        scope.spawn(move || {
            while let Ok(first) = written.recv() {
                put(std::iter::once(first).chain(written.try_iter()).collect());
            }
        });
        for pool in &pools[1..] {
            let to_put = to_put.clone();
            scope.spawn(move || worker(pool, &to_put));
        }
        worker(&pools[0], &to_put);
    });
    shown_batch.finish();
    let outcomes = printed.into_inner().unwrap_or_else(PoisonError::into_inner).outcomes();
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
        let rows: Vec<BatchRow<'_>> = inputs.iter().zip(&outcomes).map(|(input, o)| row(input, o)).collect();
        if !options.json {
            terminal::answer(&batch_summary(&rows, terminal::colour()));
        }
        if let Err(why) = write_summary(inputs::folder_of_all(options), &batch_csv(&rows)) {
            terminal::complain(&why);
            ended = ended.max(Ended::Refused);
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
        Outcome::Done(done) => BatchOutcome::Ran(&done.record),
        Outcome::Refused(why) => BatchOutcome::Refused(why),
        Outcome::Bug => BatchOutcome::Refused("a bug of linkwright: please report it with this input"),
        Outcome::NotRun => BatchOutcome::Refused("not run: the batch was interrupted before"),
    };
    BatchRow { name, outcome }
}

fn write_summary(folder: &Path, csv: &str) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    summary(folder, csv, |file| write_files(&[file], Replace::Ours(&[])))
}

/// Does something with the summary's file. One that is a user's stays, and there is no `--force` for it.
fn summary(
    folder: &Path,
    csv: &str,
    act: impl FnOnce(OutputFile<'_>) -> Result<(), FolderError>,
) -> Result<(), String> {
    let path = folder.join(SUMMARY);
    act(OutputFile { path: &path, kind: FileKind::Csv, bytes: csv.as_bytes() }).map_err(|e| match e {
        FolderError::NotOurs { path, .. } => {
            format!("{path} is no summary of a batch of this version: move it away, or give another folder with --out")
        }
        e => e.to_string(),
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
