//! `certify`: a bound below which no linkage can be.

use super::arguments::Certify;
use super::result::{self, Which};
use super::{Ended, interrupt, synth, terminal};
use crate::certificate::checkpoint::MAX_BYTES;
use crate::certificate::{NoCertificate, Progress, Proof, Request, ResumeError};
use crate::diagnostic::escaped;
use crate::record::Certificate;
use crate::report::certificate::repeats_text;
use crate::results_folder::{CERTIFICATE_CHECKPOINT, LEAVES, ResultsFolder, replace_file};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Progress lines come this often.
const LINE_EVERY: Duration = Duration::from_secs(5);
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
    let run = result::read_run_of(&options.result, "certify")?;
    if run.which != Which::All {
        return Err(refuse(&format!("{shown}: a result is certified as a whole; give {} alone", run.named)));
    }
    if !options.result.is_dir() {
        return Err(refuse(&format!("{shown}: certify writes into the result's folder; give the folder")));
    }
    let mut record = run.record;
    // Taken before the work, so that a place that cannot be written to is told at once.
    let mut folder = ResultsFolder::take(&options.result).map_err(|e| refuse(&e.to_string()))?;
    let limit = options.set.iter().map(|(_, seconds)| *seconds).next_back().unwrap_or(DEFAULT_LIMIT_S);
    let deadline = begun + Duration::from_secs_f64(limit);
    let cancel = interrupt::watch("keeping what is proved by now");
    let mut last = Instant::now();
    let mut tell = |progress: &Progress| {
        if !options.quiet && last.elapsed() >= LINE_EVERY {
            last = Instant::now();
            terminal::tell(&format!(
                "{:.0} s: {} boxes, {:.3} % of the linkages decided, no sum below {:.6e} (gap {:.4} %)",
                begun.elapsed().as_secs_f64(),
                progress.boxes,
                100.0 * progress.decided,
                progress.lower_bound,
                100.0 * progress.gap,
            ));
        }
    };
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
    loop {
        let pause = deadline.min(Instant::now() + KEPT_EVERY);
        proof.run(cancel, Some(pause), &mut tell);
        if proof.ended() || pause == deadline || cancel.load(Ordering::SeqCst) {
            break;
        }
        replace_file(&options.result, CERTIFICATE_CHECKPOINT, &proof.checkpoint())
            .map_err(|e| refuse(&e.to_string()))?;
    }
    let leaves = proof.leaves();
    let certificate = proof.certificate_of(&leaves);
    let text = text(&certificate, proof.ended());
    let closed = certificate.closed;
    record.certificate = Some(certificate);
    let mut files = files(&options.result, &record, begun).map_err(|e| refuse(&e))?;
    if options.leaves {
        files.push((LEAVES.into(), leaves.to_bytes()));
    }
    if !proof.ended() {
        files.push((CERTIFICATE_CHECKPOINT.into(), proof.checkpoint()));
    }
    if folder.has_checkpoint() {
        folder.keep_checkpoint();
    }
    folder.replace(&files).map_err(|e| refuse(&e.to_string()))?;
    terminal::answer(&text);
    Ok(match closed {
        true => Ended::Good,
        false if cancel.load(Ordering::SeqCst) => Ended::Interrupted,
        false => Ended::Bad,
    })
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
        return Err(refuse(&format!("{shown}/{CERTIFICATE_CHECKPOINT}: it has at most {MAX_BYTES} bytes")));
    }
    Ok(Some(bytes))
}

/// The time limit unless another is set, seconds.
const DEFAULT_LIMIT_S: f64 = 300.0;

/// The files of the result with the certificate; the times of its search stay.
fn files(
    place: &Path,
    record: &crate::record::Record,
    begun: Instant,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let total_s = begun.elapsed().as_secs_f64();
    let threads = rayon::current_num_threads();
    let timing = synth::Timing { search_s: total_s, beside_s: 0.0, total_s, threads };
    let mut files = synth::files(record, &timing)?;
    if let Ok(kept) = std::fs::read(place.join(TIMING)) {
        for (_, bytes) in files.iter_mut().filter(|(name, _)| name == TIMING) {
            bytes.clone_from(&kept);
        }
    }
    Ok(files)
}

/// What a person reads.
fn text(certificate: &Certificate, ended: bool) -> String {
    let mut text = format!("{}\n\n", certificate.statement);
    let state = match (certificate.closed, ended) {
        (true, _) => "closed",
        (false, true) => "not closed: no more boxes can be kept",
        (false, false) => "not closed: certify --resume goes on",
    };
    text.push_str(&format!("  gap {:.4} %, {state}; {} boxes\n", 100.0 * certificate.gap, certificate.boxes));
    for part in &certificate.parts {
        let way = if part.direction > 0 { "with" } else { "against" };
        text.push_str(&format!(
            "  {:<12} {way:<7} the increments: no sum below {:.9e}, {} boxes\n",
            part.linkage_type, part.lower_bound, part.boxes
        ));
    }
    text.push_str(&format!("  Covered: {}.\n", certificate.covered.join("; ")));
    text.push_str(&format!("  Not covered: {}.\n", certificate.not_covered.join("; ")));
    text
}
