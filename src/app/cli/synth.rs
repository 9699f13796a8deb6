//! `synth`: problems in, results out.

use super::arguments::Synth;
use super::error::CommandError;
use super::inputs;
use super::inputs::Input;
use super::progress::Shown;
use super::{Ended, interrupt, refuse, terminal};
use crate::app::job::folder::{FRONT_HTML, FolderError, OutputFile, Replace, check_files, write_files};
use crate::app::job::run::Job;
use crate::app::job::save;
use crate::app::job::save::{Done, Listener, Options, Ran, SaveError, Written};
use crate::app::job::workers::pools;
use crate::files::generator::FileKind;
use crate::record::{Reason, Record};
use crate::report::batch_csv::batch_csv;
use crate::report::certificate::certificate_text;
use crate::report::exact::exact_text;
use crate::report::front::front_text;
use crate::report::html::Extent;
use crate::report::plot::{Glyphs, terminal_plot};
use crate::report::table::{BatchRow, batch_summary, candidates_table};
use rayon::ThreadPool;
use std::io::{IsTerminal, stdout};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SendError, SyncSender, sync_channel};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// The most results of a batch that wait for the disk; then the searches wait too.
const MOST_WAITING: usize = 64;
/// The summary of a batch.
const SUMMARY: &str = "summary.csv";

/// The outcome of an input.
type Outcome = Result<Box<Done>, NoResult>;

/// The reason why an input has no result.
struct NoResult {
    ended: Ended,
    why: String,
}

impl NoResult {
    fn new(ended: Ended, why: impl ToString) -> Self {
        NoResult { ended, why: why.to_string() }
    }

    /// A panic.
    fn bug() -> Self {
        NoResult::new(Ended::Bug, "a bug of linkwright: please report it with this input")
    }
}

impl From<SaveError> for NoResult {
    fn from(why: SaveError) -> Self {
        NoResult::new(Ended::Refused, why)
    }
}

/// Runs the command.
pub fn run(options: &Synth) -> Result<Ended, Ended> {
    let start = Instant::now();
    let (inputs, several) = inputs::load(options);
    let jobs = inputs.iter().filter(|input| input.job.is_ok()).count();
    if jobs == 0 {
        return Err(Ended::Refused);
    }
    if several {
        // A place that is taken is reported before the searches, not after them.
        summary(options, &[], check_files).map_err(refuse)?;
    }
    let pools = pools(jobs, options.search.threads.map(usize::from))
        .map_err(|e| refuse(format!("no threads to search with: {e}")))?;
    let side_by_side = pools.len() > 1;
    let batch = Batch {
        options,
        inputs: &inputs,
        several,
        side_by_side,
        start,
        cancel: interrupt::watch("saving the best so far"),
        next: AtomicUsize::new(0),
        outcomes: inputs.iter().map(|_| OnceLock::new()).collect(),
        printed: Mutex::new(0),
        shown: Shown::of_batch(options.quiet || !side_by_side),
    };
    batch.search(&pools);
    let outcomes = batch.outcomes.into_iter();
    let outcomes = outcomes.map(|outcome| outcome.into_inner().unwrap_or_else(|| Err(NoResult::bug())));
    Ok(conclude(options, several, &inputs, &outcomes.collect::<Vec<_>>()))
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
    outcomes: Vec<OnceLock<Outcome>>,
    /// The number of the first outcomes that have been printed: pages come in the order of the inputs.
    printed: Mutex<usize>,
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
                Err(why) => Err(NoResult::new(Ended::Refused, why)),
                Ok(_) if self.cancel.load(Ordering::Relaxed) && i > 0 => {
                    Err(NoResult::new(Ended::Interrupted, "not run: the batch was interrupted before"))
                }
                Ok((job, place)) => match catch_unwind(AssertUnwindSafe(|| self.one(job, place, pool))) {
                    Ok(Ok(Ran::Written(written))) => {
                        // While one thread waits for the disk the others search.
                        if let Err(SendError(alone)) = to_put.send((i, written)) {
                            self.put(vec![alone]);
                        }
                        continue;
                    }
                    Ok(Ok(Ran::Before(done))) => Ok(Box::new(done)),
                    Ok(Err(why)) => Err(why.into()),
                    Err(panic) if !self.several => resume_unwind(panic),
                    Err(_) => Err(NoResult::bug()),
                },
            };
            self.take(i, outcome);
        }
    }

    /// Runs one job and shows its progress.
    fn one(&self, job: &Job, place: &Path, pool: &ThreadPool) -> Result<Ran, SaveError> {
        let begun = if self.several { Instant::now() } else { self.start };
        let silent = self.options.quiet || self.side_by_side;
        let (shown, proof) = (Shown::of_search(&job.name, silent), Shown::of_proof(&job.name, silent));
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
            checkpoint_every: self.options.search.checkpoint_every,
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
            self.take(i, put.map(Box::new).map_err(NoResult::from));
        }
    }

    /// Takes the outcome of an input and prints the pages that are due.
    fn take(&self, i: usize, outcome: Outcome) {
        if let Err(NoResult { ended: Ended::Refused, why }) = &outcome
            && self.inputs[i].job.is_ok()
        {
            terminal::complain(why);
        }
        self.shown.one_more(self.inputs.len() as u64);
        let mut printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
        // Every input has one outcome.
        let _ = self.outcomes[i].set(outcome);
        while let Some(outcome) = self.outcomes.get(*printed).and_then(OnceLock::get) {
            if let Ok(done) = outcome
                && !self.options.json
            {
                terminal::answer(&page(done, self.several || self.options.quiet, self.options.all));
            }
            *printed += 1;
        }
    }
}

/// Prints the records or the summary, writes the summary of a batch, and returns the gravest end.
fn conclude(options: &Synth, several: bool, inputs: &[Input], outcomes: &[Outcome]) -> Ended {
    let mut ended = outcomes.iter().map(ended_of).max().unwrap_or(Ended::Good);
    if options.json {
        let records: Vec<&Record> = outcomes.iter().flatten().map(|done| &done.record).collect();
        let text = match records.as_slice() {
            [record] if !several => serde_json::to_string_pretty(record),
            [] if !several => return ended,
            records => serde_json::to_string_pretty(records),
        };
        terminal::answer(&format!("{}\n", text.unwrap_or_default()));
    }
    if several {
        let rows = inputs.iter().zip(outcomes).map(|(input, outcome)| BatchRow {
            name: input.job.as_ref().map_or(input.file.as_str(), |(job, _)| &job.name),
            outcome: match outcome {
                Ok(done) => Ok(&done.record),
                Err(none) => Err(none.why.as_str()),
            },
        });
        let rows: Vec<BatchRow<'_>> = rows.collect();
        if !options.json {
            terminal::answer(&batch_summary(&rows, terminal::colour()));
        }
        if let Err(why) = write_summary(options, &rows) {
            ended = ended.max(refuse(why));
        }
    }
    ended
}

fn ended_of(outcome: &Outcome) -> Ended {
    match outcome {
        Ok(done) if done.interrupted || done.record.termination.reason == Reason::Cancelled => {
            Ended::Interrupted
        }
        Ok(done) if done.record.candidates.iter().any(|c| c.accepted) => Ended::Good,
        Ok(_) => Ended::Bad,
        Err(none) => none.ended,
    }
}

/// Writes the summary of a batch to its folder.
fn write_summary(options: &Synth, rows: &[BatchRow<'_>]) -> Result<(), CommandError> {
    let folder = inputs::folder_of_all(options);
    let failed = |source| FolderError::Io { path: folder.display().to_string(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    summary(options, rows, write_files)
}

/// Checks or writes the summary's file. A file that is a user's is kept, and there is no `--force` for it.
fn summary(
    options: &Synth,
    rows: &[BatchRow<'_>],
    act: fn(&[OutputFile<'_>], Replace<'_>) -> Result<(), FolderError>,
) -> Result<(), CommandError> {
    let path = inputs::folder_of_all(options).join(SUMMARY);
    let csv = batch_csv(rows);
    let file = OutputFile { path: &path, kind: FileKind::Csv, bytes: csv.as_bytes() };
    act(&[file], Replace::Ours(&[])).map_err(|e| match e {
        FolderError::NotOurs { path, .. } => CommandError::NotASummary { path },
        e => e.into(),
    })
}

/// Returns the text that is printed for one problem.
fn page(Done { record, folder, timing, .. }: &Done, brief: bool, all: bool) -> String {
    let colour = terminal::colour();
    let front = front_text(record, colour);
    let has_front = !front.is_empty();
    let mut text =
        if has_front { front } else { candidates_table(record, colour) + &exact_text(record, all, colour) };
    if record.front.is_some() && !has_front {
        text.push_str("\n  The front is empty: no linkage that was found is acceptable and near enough to the target.\n");
    }
    text.push_str(&certificate_text(record, colour));
    if !brief && !has_front && stdout().is_terminal() && !record.candidates.is_empty() {
        text.push('\n');
        text.push_str(&terminal_plot(record, 0, 72, 22, Glyphs::Braille));
    }
    let shown = terminal::shown(folder);
    text.push_str(&match timing {
        Some(timing) => format!("\n  {}. Written to {shown}\n", timing.words()),
        None => format!("\n  Done before: nothing was run. It stands in {shown}\n"),
    });
    if !record.candidates.is_empty() && !brief {
        let quoted = if shown.contains(' ') { format!("\"{shown}\"") } else { shown };
        let look = if has_front { FRONT_HTML } else { "candidate-1.svg" };
        text.push_str(&format!("  Look at {quoted}/{look}, then: linkwright verify {quoted}\n"));
    }
    text.push('\n');
    text
}
