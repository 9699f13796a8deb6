//! One job of `synth`, from its folder to its files: lock, resume, run, checkpoints on the way, result.

use super::arguments::Synth;
use super::progress::Shown;
use super::{synth, terminal};
use crate::checkpoint::{Checkpoint, Writer};
use crate::record::{Reason, Record};
use crate::results_folder::{CHECKPOINT, ResultsFolder, read_record, replace_file, rescue};
use crate::run::{Context, Finished, Job, digest, run_kept};
use crate::search::keeper::{Keeper, Pace, SearchState};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What came of a job.
pub struct Done {
    /// The record.
    pub record: Record,
    /// Where it is.
    pub folder: PathBuf,
    /// Seconds of search and of what stands beside it; `None` where it was done before.
    pub seconds: Option<(f64, f64)>,
}

/// Runs a job on the current thread pool and writes its result. The time that is written counts from `begun`.
///
/// # Errors
/// What a person has to know; nothing is half written.
pub fn run(
    job: &Job,
    place: &Path,
    options: &Synth,
    shown: &Shown,
    cancel: &AtomicBool,
    begun: Instant,
) -> Result<Done, String> {
    let mut folder = ResultsFolder::take(place).map_err(|e| e.to_string())?;
    let mut earlier = SearchState::default();
    if options.resume {
        if let Some(record) = done_before(job, place)? {
            folder.remove_checkpoint().map_err(|e| e.to_string())?;
            return Ok(Done { record, folder: place.to_path_buf(), seconds: None });
        }
        let path = place.join(CHECKPOINT);
        if let Some(checkpoint) = Checkpoint::read(&path, job).map_err(|e| e.to_string())? {
            match checkpoint.leads_to(job) {
                Some(why) => terminal::tell(&format!("{} begins anew: {why}", job.name)),
                None => earlier = checkpoint.into_state(),
            }
        }
    } else if folder.has_checkpoint() {
        let name = &job.name;
        terminal::tell(&format!(
            "{name} begins anew; --resume would go on from the checkpoint that is there"
        ));
    }
    let writer = Writer::new(job).map_err(|e| e.to_string())?;
    let failed = AtomicBool::new(false);
    let sink = |state: &SearchState| {
        let Some(bytes) = writer.bytes(state) else { return };
        if let Err(e) = replace_file(place, CHECKPOINT, &bytes)
            && !failed.swap(true, Ordering::Relaxed)
        {
            terminal::tell(&format!("warning: no checkpoint could be written, the search goes on: {e}"));
        }
    };
    let keeper = Keeper::new(earlier, Pace::Seldom, &sink);
    let observer = |progress: &_| shown.update(progress);
    let outcome = run_kept(job, &Context { cancel, observer: &observer }, Some(&keeper));
    shown.finish();
    let Finished { record, search_s, beside_s } = outcome.map_err(|e| format!("{}: {e}", job.name))?;
    if matches!(record.termination.reason, Reason::Cancelled | Reason::TimeLimit) {
        folder.keep_checkpoint();
    }
    let total_s = begun.elapsed().as_secs_f64();
    let timing = synth::Timing { search_s, beside_s, total_s, threads: rayon::current_num_threads() };
    let files = synth::files(&record, &timing)?;
    save(&mut folder, &files)?;
    Ok(Done { record, folder: place.to_path_buf(), seconds: Some((search_s, beside_s)) })
}

/// Puts a result into its folder; one that the folder does not take is saved elsewhere, and that is told.
fn save(folder: &mut ResultsFolder, files: &[(String, Vec<u8>)]) -> Result<(), String> {
    folder.replace(files).map_err(|e| match rescue(files) {
        Ok(place) => format!("{e}; the result was saved in {}", place.display()),
        Err(also) => format!("{e}; nor can it be saved elsewhere: {also}"),
    })
}

/// The record of a run of the same problem that has nothing left to do: of the same version, for as many candidates,
/// neither interrupted nor ended by a time limit, nor by a budget that has been raised since.
fn done_before(job: &Job, place: &Path) -> Result<Option<Record>, String> {
    let Ok(record) = read_record(place) else { return Ok(None) };
    let (then, now) = (&record.problem.resolved.solve, &job.spec.solve);
    let same = record.problem.digest == digest(&job.spec).map_err(|e| e.to_string())?
        && record.tool.version == env!("CARGO_PKG_VERSION")
        && then.candidates == now.candidates;
    let over = match record.termination.reason {
        Reason::Cancelled | Reason::TimeLimit => false,
        Reason::EvaluationLimit | Reason::Stalled => now.evaluations <= then.evaluations,
        Reason::Converged | Reason::TargetReached => true,
    };
    Ok(Some(record).filter(|_| same && over))
}
