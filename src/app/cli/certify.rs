//! `certify`: lower bounds of the error, by branch and bound.

use super::arguments::Certify;
use super::progress::Shown;
use super::result;
use super::{Ended, interrupt, refuse, refuse_path, terminal};
use crate::app::certificates;
use crate::app::job::files;
use crate::app::job::files::Timing;
use crate::app::job::folder::{CERTIFICATE_CHECKPOINT, LEAVES, RECORD, ResultsFolder, TIMING, replace_file};
use crate::app::job::save::SaveError;
use crate::judge::certificate::{Proof, ResumeError};
use crate::record::Record;
use crate::report::certificate::{certificate_text, parts_text, repeats_text};
use crate::task::spec::CertifySpec;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The time between two checkpoints, so that a process that is killed loses no more.
const KEPT_EVERY: Duration = Duration::from_secs(60);

/// Runs the command.
pub fn run(options: &Certify) -> Result<Ended, Ended> {
    let begun = Instant::now();
    if !options.result.is_dir() {
        result::read_run_of(&options.result, "certify")?;
        return Err(refuse_path(&options.result, "certify writes into the result's folder; give the folder"));
    }
    if !options.result.join(RECORD).is_file() {
        // A folder that never held a result is refused for that, not for its contents.
        result::read_run_of(&options.result, "certify")?;
    }
    // Taken before the record is read, so that no other run changes it, and before the work, so that a place that cannot
    // be written to is reported at once.
    let mut folder = ResultsFolder::take(&options.result).map_err(refuse)?;
    let mut record = result::read_run_of(&options.result, "certify")?.record;
    let cancel = interrupt::watch("keeping what is proved by now");
    let mut proof = begin(options, &record)?;
    prove(options, &mut proof, &record.problem.name, begun, cancel);
    match certificates::put(&mut record, &proof) {
        None => {
            tell_of(options, "its certificate proves more than this run: it stays as it is");
            if !proof.ended() {
                replace_file(&options.result, CERTIFICATE_CHECKPOINT, &proof.checkpoint()).map_err(refuse)?;
            }
        }
        Some(leaves) => {
            let files = files(options, &record, begun, &proof, leaves.to_bytes())?;
            if folder.has_checkpoint() {
                folder.keep_checkpoint();
            }
            folder.replace(&files).map_err(|e| refuse(SaveError::rescued(e, &files)))?;
        }
    }
    let Some(certificate) = &record.certificate else { return Err(Ended::Bad) };
    terminal::answer(certificate_text(&record, terminal::colour()).trim_start_matches('\n'));
    terminal::answer(&parts_text(certificate));
    if certificate.gap <= options.gap {
        return Ok(Ended::Good);
    }
    let go_on = if proof.ended() { "no more boxes can be kept" } else { "certify --resume goes on" };
    terminal::answer(&format!("  Not closed: {go_on}.\n"));
    Ok(if cancel.load(Ordering::SeqCst) { Ended::Interrupted } else { Ended::Bad })
}

/// Tells the user something about the result.
fn tell_of(options: &Certify, text: &str) {
    terminal::tell(&format!("{}: {text}", terminal::shown(&options.result)));
}

/// Begins the proof, or takes it up where a run was stopped. If nothing can be proved, the forecast of the search itself
/// is shown.
fn begin(options: &Certify, record: &Record) -> Result<Proof, Ended> {
    let proof = certificates::begin(record, options.gap, kept(options)?.as_deref());
    proof.map_err(|e| match e {
        ResumeError::NoCertificate(e) => {
            if let Some(repeats) = &record.repeats {
                terminal::answer(&repeats_text(repeats));
            }
            refuse_path(&options.result, e)
        }
        e => refuse_path(&certificates::checkpoint_of(&options.result), e),
    })
}

/// Proves until the end, the time limit or Ctrl-C, with checkpoints on the way.
fn prove(options: &Certify, proof: &mut Proof, name: &str, begun: Instant, cancel: &AtomicBool) {
    let limit = options.set.last().map_or(CertifySpec::default().time_limit_s, |(_, seconds)| *seconds);
    let deadline = begun + Duration::from_secs_f64(limit);
    let shown = Shown::of_proof(name, options.quiet);
    let mut warned = false;
    loop {
        let pause = deadline.min(Instant::now() + KEPT_EVERY);
        proof.run(cancel, Some(pause), &mut |progress| shown.proof(progress));
        if proof.ended() || pause == deadline || cancel.load(Ordering::SeqCst) {
            break;
        }
        if let Err(e) = replace_file(&options.result, CERTIFICATE_CHECKPOINT, &proof.checkpoint()) {
            if !warned {
                terminal::tell(&format!("warning: no checkpoint could be written, the proof goes on: {e}"));
            }
            warned = true;
        }
    }
}

/// Reads the checkpoint of a run that was stopped, if the proof is to go on from it.
fn kept(options: &Certify) -> Result<Option<Vec<u8>>, Ended> {
    if !options.resume {
        return Ok(None);
    }
    let found = certificates::read_checkpoint(&options.result).map_err(refuse)?;
    if found.is_none() && !options.quiet {
        tell_of(options, "no run of certify was stopped here: it begins anew");
    }
    Ok(found)
}

/// The files of the result with the certificate, its leaves if they are wanted, and its checkpoint if it can go on; the
/// times of its search stay.
fn files(
    options: &Certify,
    record: &Record,
    begun: Instant,
    proof: &Proof,
    leaves: Vec<u8>,
) -> Result<Vec<(String, Vec<u8>)>, Ended> {
    let place = &options.result;
    let total_s = begun.elapsed().as_secs_f64();
    let threads = rayon::current_num_threads();
    let timing = Timing { search_s: total_s, beside_s: 0.0, advice_s: None, total_s, threads };
    let mut files = files::files(record, &timing).map_err(refuse)?;
    if let Ok(kept) = std::fs::read(place.join(TIMING)) {
        for (_, bytes) in files.iter_mut().filter(|(name, _)| name == TIMING) {
            bytes.clone_from(&kept);
        }
    }
    let had = std::fs::read(place.join(LEAVES)).ok();
    if options.leaves || had.as_ref() == Some(&leaves) {
        files.push((LEAVES.into(), leaves));
    } else if had.is_some() {
        let gone = format!("{LEAVES} was of another certificate and is gone; --leaves keeps the new ones");
        tell_of(options, &gone);
    }
    if !proof.ended() {
        files.push((CERTIFICATE_CHECKPOINT.into(), proof.checkpoint()));
    }
    Ok(files)
}
