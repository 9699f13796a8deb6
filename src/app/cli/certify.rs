//! `certify`: a bound below which no linkage that it covers can be.

use super::arguments::Certify;
use super::progress::Proving;
use super::result;
use super::result::Which;
use super::{Ended, interrupt, synth, terminal};
use crate::app::results_folder::{CERTIFICATE_CHECKPOINT, LEAVES, ResultsFolder, replace_file};
use crate::app::saved_run::saved_elsewhere;
use crate::files::diagnostic::escaped;
use crate::judge::certificate::checkpoint::{MAX_BYTES, REMEDY};
use crate::judge::certificate::{NoCertificate, Proof, Request, ResumeError};
use crate::record::Certificate;
use crate::report::certificate::{certificate_text, parts_text, repeats_text};
use crate::task::spec::CertifySpec;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// What is proved is kept this often, so that a process that is killed loses no more.
const KEPT_EVERY: Duration = Duration::from_secs(60);
/// The file with a run's times.
const TIMING: &str = "timing.json";

/// Runs the command.
pub fn run(options: &Certify) -> Ended {
    inner(options).unwrap_or_else(|ended| ended)
}

fn refuse(text: &str) -> Ended {
    terminal::complain(text);
    Ended::Refused
}

fn inner(options: &Certify) -> Result<Ended, Ended> {
    let begun = Instant::now();
    let shown = escaped(&options.result.display().to_string());
    let not_whole = || refuse(&format!("{shown}: certify writes into the result's folder; give the folder"));
    if !options.result.is_dir() {
        result::read_run_of(&options.result, "certify")?;
        return Err(not_whole());
    }
    // Taken before the record is read, so that no other run changes it, and before the work, so that a place that cannot
    // be written to is told at once.
    let mut folder = ResultsFolder::take(&options.result).map_err(|e| refuse(&e.to_string()))?;
    let run = result::read_run_of(&options.result, "certify")?;
    if run.which != Which::All {
        return Err(not_whole());
    }
    let mut record = run.record;
    let former = record.certificate.take();
    let limit = options.set.iter().map(|(_, seconds)| *seconds).next_back();
    let deadline = begun + Duration::from_secs_f64(limit.unwrap_or(CertifySpec::default().time_limit_s));
    let cancel = interrupt::watch("keeping what is proved by now");
    let mut proving = Proving::new(&record.problem.name, options.quiet);
    let request = Request { gap: options.gap };
    // Where nothing can be proved, what the search itself foretells.
    let none = |e: NoCertificate| {
        if let Some(repeats) = &record.repeats {
            terminal::answer(&repeats_text(repeats));
        }
        refuse(&format!("{shown}: {e}"))
    };
    let mut proof = match kept(options, &shown)? {
        Some(bytes) => Proof::resume(&record, &request, &bytes).map_err(|e| match e {
            ResumeError::NoCertificate(e) => none(e),
            e => refuse(&format!("{shown}/{CERTIFICATE_CHECKPOINT}: {e}")),
        })?,
        None => Proof::new(&record, &request).map_err(none)?,
    };
    let mut warned = false;
    loop {
        let pause = deadline.min(Instant::now() + KEPT_EVERY);
        proof.run(cancel, Some(pause), &mut |progress| proving.update(progress));
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
    let leaves = proof.leaves();
    let certificate = proof.certificate_of(&leaves);
    let go_on = if proof.ended() { "no more boxes can be kept" } else { "certify --resume goes on" };
    let proved = |certificate: &Certificate| (certificate.lower_bound, certificate.boxes);
    let stronger = former.filter(|former| proved(former) > proved(&certificate));
    let stays = stronger.is_some();
    record.certificate = Some(stronger.unwrap_or(certificate));
    if stays {
        terminal::tell(&format!("{shown}: its certificate proves more than this run: it stays as it is"));
        if !proof.ended() {
            replace_file(&options.result, CERTIFICATE_CHECKPOINT, &proof.checkpoint())
                .map_err(|e| refuse(&e.to_string()))?;
        }
    } else {
        let mut files = files(&options.result, &record, begun).map_err(|e| refuse(&e))?;
        let bytes = leaves.to_bytes();
        let had = std::fs::read(options.result.join(LEAVES)).ok();
        if options.leaves || had.as_ref() == Some(&bytes) {
            files.push((LEAVES.into(), bytes));
        } else if had.is_some() {
            terminal::tell(&format!(
                "{shown}: {LEAVES} was of another certificate and is gone; --leaves keeps the new ones"
            ));
        }
        if !proof.ended() {
            files.push((CERTIFICATE_CHECKPOINT.into(), proof.checkpoint()));
        }
        if folder.has_checkpoint() {
            folder.keep_checkpoint();
        }
        folder.replace(&files).map_err(|e| refuse(&saved_elsewhere(&e, &files)))?;
    }
    let Some(certificate) = &record.certificate else { return Err(Ended::Bad) };
    terminal::answer(certificate_text(&record, terminal::colour()).trim_start_matches('\n'));
    terminal::answer(&parts_text(certificate));
    if certificate.gap <= options.gap {
        return Ok(Ended::Good);
    }
    terminal::answer(&format!("  Not closed: {go_on}.\n"));
    Ok(if cancel.load(Ordering::SeqCst) { Ended::Interrupted } else { Ended::Bad })
}

/// What a run that was stopped has left, where it is to go on.
fn kept(options: &Certify, shown: &str) -> Result<Option<Vec<u8>>, Ended> {
    if !options.resume {
        return Ok(None);
    }
    let file = match File::open(options.result.join(CERTIFICATE_CHECKPOINT)) {
        Ok(file) => file,
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            if !options.quiet {
                terminal::tell(&format!("{shown}: no run of certify was stopped here: it begins anew"));
            }
            return Ok(None);
        }
        Err(e) => return Err(refuse(&format!("{shown}/{CERTIFICATE_CHECKPOINT}: {e}"))),
    };
    let mut bytes = Vec::new();
    let read = file.take(MAX_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|e| refuse(&format!("{shown}/{CERTIFICATE_CHECKPOINT}: {e}")))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(&format!(
            "{shown}/{CERTIFICATE_CHECKPOINT}: it has at most {MAX_BYTES} bytes; {REMEDY}"
        )));
    }
    Ok(Some(bytes))
}

/// The files of the result with the certificate; the times of its search stay.
fn files(
    place: &Path,
    record: &crate::record::Record,
    begun: Instant,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let total_s = begun.elapsed().as_secs_f64();
    let threads = rayon::current_num_threads();
    let timing = synth::Timing { search_s: total_s, beside_s: 0.0, advice_s: None, total_s, threads };
    let mut files = synth::files(record, &timing)?;
    if let Ok(kept) = std::fs::read(place.join(TIMING)) {
        for (_, bytes) in files.iter_mut().filter(|(name, _)| name == TIMING) {
            bytes.clone_from(&kept);
        }
    }
    Ok(files)
}
