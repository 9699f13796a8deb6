//! Running one job with its folder: lock, resume, run, checkpoints on the way, result files.
//!
//! `linkwright synth` and the studio both run jobs with this module only, so that the same problem and seed give the
//! same bytes.

use crate::app::job::checkpoint::{Checkpoint, CheckpointError, Writer};
use crate::app::job::files::{NotJson, Timing, files_of};
use crate::app::job::folder::{
    CHECKPOINT, FolderError, ResultsFolder, put_together, read_record, replace_file, rescue,
};
use crate::app::job::run::{Context, Finished, Job, RunError, prove, run_kept};
use crate::judge::certificate;
use crate::record::digest::{NotWritten, digest};
use crate::record::{Reason, Record};
use crate::report::html::Extent;
use crate::synthesis::Observer;
use crate::synthesis::keeper::{Keeper, LEAST_PAUSE, SearchState};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The reason why a job cannot be run or its result not be saved in its folder.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The checkpoint of an earlier run cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The problem cannot be written as data.
    #[error(transparent)]
    Problem(#[from] NotWritten),
    /// The record cannot be written as data.
    #[error(transparent)]
    Record(#[from] NotJson),
    /// The job cannot be searched.
    #[error("{job}: {source}")]
    Run {
        /// The job's name.
        job: String,
        /// The reason.
        source: RunError,
    },
    /// The folder cannot be written to; the result is in another place.
    #[error("{source}; the result was saved in {place}")]
    Elsewhere {
        /// The reason.
        source: FolderError,
        /// The folder of the result.
        place: String,
    },
    /// The folder cannot be written to, nor any other place: the result is lost.
    #[error("{source}; nor can it be saved elsewhere: {also}")]
    Lost {
        /// The reason.
        source: FolderError,
        /// The reason why it cannot be saved elsewhere.
        also: Box<FolderError>,
    },
}

impl SaveError {
    /// Saves a result that cannot be written to its folder in another place, and returns the error that says so.
    pub(crate) fn rescued(source: FolderError, files: &[(String, Vec<u8>)]) -> Self {
        match rescue(files) {
            Ok(place) => SaveError::Elsewhere { source, place: place.display().to_string() },
            Err(also) => SaveError::Lost { source, also: Box::new(also) },
        }
    }
}

/// Options for running a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether the job continues from the checkpoint of an earlier run, and is skipped if it was finished before.
    pub resume: bool,
    /// The shortest time between two checkpoints; zero: a checkpoint at every boundary of the search.
    pub checkpoint_every: Duration,
    /// The extent of the result's page.
    pub extent: Extent,
}

impl Default for Options {
    fn default() -> Self {
        Options { resume: false, checkpoint_every: LEAST_PAUSE, extent: Extent::Full }
    }
}

/// Callbacks that receive the progress and the messages of a job.
#[derive(Clone, Copy)]
pub struct Listener<'a> {
    /// Receives the progress of the search.
    pub observer: &'a Observer<'a>,
    /// Receives the progress of the certificate that the problem asks for.
    pub proving: &'a (dyn Fn(&certificate::Progress) + Sync),
    /// Receives messages for the user, one sentence each.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// A finished job.
#[derive(Clone, Debug)]
pub struct Done {
    /// The record.
    pub record: Record,
    /// The folder of the result.
    pub folder: PathBuf,
    /// The times of the run's parts; `None` if the job was finished before.
    pub timing: Option<Timing>,
    /// Whether the certificate was interrupted.
    pub interrupted: bool,
}

/// The outcome of running a job.
pub enum Ran {
    /// The job was finished before.
    Before(Done),
    /// The result's files are written, but not yet in their place.
    Written(Written),
}

/// A result that is written but not yet in its place, with its folder.
pub struct Written {
    done: Done,
    folder: ResultsFolder,
    files: Vec<(String, Vec<u8>)>,
}

/// Runs a job on the current thread pool and writes its result to the folder `place`; [`put_in_place`] completes it.
/// The time that is written counts from `begun`. Setting `cancel` ends the search: the best linkages so far are the
/// result, and the checkpoint is kept.
///
/// # Errors
/// [`SaveError`]; nothing is half written.
pub fn run(
    job: &Job,
    place: &Path,
    options: Options,
    listener: Listener<'_>,
    cancel: &AtomicBool,
    begun: Instant,
) -> Result<Ran, SaveError> {
    let mut folder = ResultsFolder::take(place)?;
    let mut earlier = SearchState::default();
    if options.resume {
        if let Some(record) = done_before(job, place)? {
            folder.remove_checkpoint()?;
            return Ok(Ran::Before(Done {
                record,
                folder: place.to_path_buf(),
                timing: None,
                interrupted: false,
            }));
        }
        let path = place.join(CHECKPOINT);
        if let Some(checkpoint) = Checkpoint::read(&path, job)? {
            match checkpoint.leads_to(job) {
                Some(why) => (listener.tell)(&format!("{} begins anew: {why}", job.name)),
                None => earlier = checkpoint.into_state(),
            }
        }
    } else if folder.has_checkpoint() {
        let name = &job.name;
        (listener.tell)(&format!(
            "{name} begins anew; --resume would go on from the checkpoint that is there"
        ));
    }
    let writer = Writer::new(job)?;
    let failed = AtomicBool::new(false);
    let sink = |state: &SearchState| {
        let Some(bytes) = writer.bytes(state) else { return };
        if let Err(e) = replace_file(place, CHECKPOINT, &bytes)
            && !failed.swap(true, Ordering::Relaxed)
        {
            (listener.tell)(&format!("warning: no checkpoint could be written, the search goes on: {e}"));
        }
    };
    let keeper = Keeper::new(earlier, options.checkpoint_every, &sink);
    let outcome = run_kept(job, &Context { cancel, observer: listener.observer }, Some(&keeper));
    let Finished { mut record, search_s, beside_s, advice_s } =
        outcome.map_err(|source| SaveError::Run { job: job.name.clone(), source })?;
    prove(&mut record, cancel, &mut |progress| (listener.proving)(progress));
    let interrupted =
        cancel.load(Ordering::Relaxed) && record.certificate.as_ref().is_some_and(|c| !c.closed);
    if matches!(record.termination.reason, Reason::Cancelled | Reason::TimeLimit) {
        folder.keep_checkpoint();
    }
    let total_s = begun.elapsed().as_secs_f64();
    let advice_s = Some(advice_s).filter(|_| job.spec.solve.advice);
    let threads = rayon::current_num_threads();
    let mut timing = Timing { search_s, beside_s, advice_s, total_s, threads };
    let files = files_of(&record, &timing, options.extent)?;
    folder.write(&files).map_err(|e| SaveError::rescued(e, &files))?;
    // The file is written by now; the time that is reported includes the writing.
    timing.total_s = begun.elapsed().as_secs_f64();
    let done = Done { record, folder: place.to_path_buf(), timing: Some(timing), interrupted };
    Ok(Ran::Written(Written { done, folder, files }))
}

/// Puts results in their places, with one wait for the disk. A result that cannot be put into its folder is saved
/// elsewhere.
///
/// # Errors
/// [`SaveError`], one for each result that failed.
pub fn put_in_place(mut written: Vec<Written>) -> Vec<Result<Done, SaveError>> {
    let mut folders: Vec<_> = written.iter_mut().map(|result| &mut result.folder).collect();
    let put = put_together(&mut folders);
    let ended = |(result, put): (Written, Result<(), FolderError>)| {
        put.map_err(|e| SaveError::rescued(e, &result.files)).map(|()| result.done)
    };
    written.into_iter().zip(put).map(ended).collect()
}

/// Returns the record of an earlier run of the same problem that has nothing left to do: of the same version, with the
/// same number of candidates, with the same picks and front, with advice if that is asked for,
/// neither interrupted nor ended by a time limit, nor by a
/// budget that has been raised since.
fn done_before(job: &Job, place: &Path) -> Result<Option<Record>, NotWritten> {
    let Ok(record) = read_record(place) else { return Ok(None) };
    let (then, now) = (&record.problem.resolved.solve, &job.spec.solve);
    let same = record.problem.digest == digest(&job.spec)?
        && record.tool.version == env!("CARGO_PKG_VERSION")
        && then.candidates == now.candidates
        && then.advice == now.advice
        && then.picks_within == now.picks_within
        && is_front_of(job, &record);
    let over = match record.termination.reason {
        Reason::Cancelled | Reason::TimeLimit | Reason::Snapped | Reason::ByHand => false,
        Reason::EvaluationLimit | Reason::Stalled => now.evaluations <= then.evaluations,
        Reason::Converged | Reason::TargetReached => true,
    };
    Ok(Some(record).filter(|record| same && over && is_proved(job, record)))
}

/// Returns whether a record has the front that a job asks for: with the same axes and number of members, or none at all.
fn is_front_of(job: &Job, record: &Record) -> bool {
    let recorded = record.front.as_ref().map(|front| (&front.axes, front.points));
    recorded == job.front.as_ref().map(|request| (&request.axes, request.points))
}

/// Returns whether nothing is left to prove of what the job asks for: the bound is proved with the gap that is asked
/// for, or there can be no certificate.
fn is_proved(job: &Job, record: &Record) -> bool {
    let Some(asked) = job.spec.solve.certify else { return true };
    match &record.certificate {
        Some(certificate) => certificate.closed && certificate.gap <= asked.gap,
        None => {
            let request = certificate::Request { gap: asked.gap };
            certificate::certify(record, &request, &AtomicBool::new(true), None, &mut |_| {}).is_err()
        }
    }
}
