//! Proofs: verify and certify.

use crate::errors::{guarded, refused};
use crate::run::{Run, told_of_proof};
use crate::waiting::{Ended, Talk, carrying, run, run_whole};
use crate::{pools, values};
use linkwright::internals::app::certificates::{self, Unusable};
use linkwright::internals::judge::certificate::ResumeError;
use linkwright::internals::judge::verify::{Checked, unchecked, verify as verify_record, verify_certificate};
use linkwright::internals::task::spec::{CertifySpec, MAX_CERTIFY_S};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Returns the place of a run for messages and for the files beside its record: its folder, else its name.
fn place_of(run: &Run) -> PathBuf {
    run.folder.clone().unwrap_or_else(|| PathBuf::from(&run.record.problem.name))
}

/// Recomputes a record: what differs, in words, what its leaves show, and the keys that are not recomputed.
#[pyfunction]
#[pyo3(signature = (result, certificate = false, leaves = false))]
pub fn verify<'py>(
    py: Python<'py>,
    result: &Bound<'py, Run>,
    certificate: bool,
    leaves: bool,
) -> PyResult<Bound<'py, PyAny>> {
    guarded(|| {
        let of = result.get().clone();
        let record = &of.record;
        if certificate && record.certificate.is_none() {
            return Err(refused("the record has no certificate; run certify first"));
        }
        let found = run_whole(py, move |talk| {
            let record = &of.record;
            let mut found =
                verify_record(record).map_err(|e| format!("the recorded problem is none: {e}"))?;
            if certificate {
                let again = verify_certificate(record, &talk.cancel, &mut |_| {});
                found.extend(again.map_err(|e| e.to_string())?.unwrap_or_default());
            }
            let shown = leaves.then(|| leaves_shown(&of, talk)).transpose().map_err(|e| e.to_string())?;
            let told: Vec<_> = found
                .iter()
                .map(|m| {
                    json!({ "rank": m.rank, "what": m.what, "recorded": m.recorded, "found": m.found,
                            "text": m.to_string() })
                })
                .collect();
            let (limits, not) = (unchecked(record, Checked::Bounded), unchecked(record, Checked::Not));
            Ok::<_, String>(json!({ "mismatches": told, "leaves": shown, "held_to_limits": limits,
                                    "not_checked": not }))
        })?;
        values::to_python(py, &found.map_err(refused)?)
    })
}

/// Checks the leaves of a run's certificate: those that it holds, else those beside its record.
fn leaves_shown(of: &Run, talk: &Talk) -> Result<Value, Unusable> {
    let place = place_of(of);
    certificates::certificate_of(&place, &of.record)?;
    let bytes = match (&of.leaves, &of.folder) {
        (Some(leaves), _) => Arc::clone(leaves),
        (None, Some(folder)) => certificates::read_leaves(folder)?.into(),
        (None, None) => return Err(Unusable::NoLeaves(place.display().to_string())),
    };
    let checked = certificates::check_leaves(&place, &of.record, &bytes, &talk.cancel, &mut |_| {})?;
    Ok(match checked {
        Ok(checked) => json!({ "shown": true, "refuted": false, "leaves": checked.leaves,
                               "boxes": checked.boxes, "text": "" }),
        Err(why) => json!({ "shown": false, "refuted": why.is_refuted(), "leaves": null, "boxes": null,
                            "text": why.to_string() }),
    })
}

/// Returns the checkpoint from which the proof of a run goes on: the one that it holds, else the one beside its record.
fn checkpoint_of(of: &Run) -> PyResult<Option<Arc<Vec<u8>>>> {
    match (&of.checkpoint, &of.folder) {
        (Some(checkpoint), _) => Ok(Some(Arc::clone(checkpoint))),
        (None, Some(folder)) => Ok(certificates::read_checkpoint(folder).map_err(refused)?.map(Arc::new)),
        (None, None) => Ok(None),
    }
}

/// Proves a lower bound of the error; the run with its certificate.
#[pyfunction]
#[pyo3(signature = (result, gap = None, time_limit_s = None, threads = None, progress = None, resume = false))]
pub fn certify<'py>(
    py: Python<'py>,
    result: &Bound<'py, Run>,
    gap: Option<f64>,
    time_limit_s: Option<f64>,
    threads: Option<i64>,
    progress: Option<&Bound<'py, PyAny>>,
    resume: bool,
) -> PyResult<Run> {
    guarded(|| {
        let usual = CertifySpec::default();
        let (gap, seconds) = (gap.unwrap_or(usual.gap), time_limit_s.unwrap_or(usual.time_limit_s));
        if !(gap > 0.0 && gap < 1.0) {
            return Err(refused(format!(
                "gap = {gap}: a gap is between 0 and 1, such as 1e-4 for a hundredth of a per cent"
            )));
        }
        if !(seconds > 0.0 && seconds <= MAX_CERTIFY_S) {
            return Err(refused(format!(
                "time_limit_s = {seconds}: above 0, at most {MAX_CERTIFY_S:e} seconds"
            )));
        }
        let of = result.get().clone();
        let checkpoint = if resume { checkpoint_of(&of)? } else { None };
        let Ended { value, interrupt } = run(py, pools::threads(threads)?, progress, move |talk| {
            let deadline = Instant::now() + Duration::from_secs_f64(seconds);
            let begun =
                certificates::begin(&of.record, gap, checkpoint.as_ref().map(|bytes| bytes.as_slice()));
            let mut proof = begun.map_err(|why| match why {
                ResumeError::NoCertificate(why) => why.to_string(),
                why => format!("{}: {why}", certificates::checkpoint_of(&place_of(&of)).display()),
            })?;
            proof.run(&talk.cancel, Some(deadline), &mut |progress| talk.tell(|| told_of_proof(progress)));
            let checkpoint = (!proof.ended()).then(|| Arc::new(proof.checkpoint()));
            let mut record = (*of.record).clone();
            let leaves = match certificates::put(&mut record, &proof) {
                Some(leaves) => Some(leaves.to_bytes().into()),
                // The certificate of before stays, with its leaves.
                None => of.leaves.clone().or_else(|| {
                    let folder = of.folder.as_ref()?;
                    certificates::read_leaves(folder).ok().map(Arc::new)
                }),
            };
            Ok::<_, String>(Run { record: record.into(), leaves, checkpoint, folder: None, ..of })
        })?;
        let found = value.map_err(refused)?;
        match interrupt {
            None => Ok(found),
            Some(interrupt) => Err(carrying(py, interrupt, Bound::new(py, found)?.into_any())),
        }
    })
}
