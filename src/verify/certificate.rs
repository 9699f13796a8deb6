//! A recorded certificate, worked out again box by box.

use super::Mismatch;
use crate::certificate::{NoCertificate, Progress, recheck};
use crate::record::{Difference, Record};
use std::sync::atomic::AtomicBool;

/// Compares a recorded certificate with one that is worked out anew from the recorded problem, with as many boxes;
/// an empty list: it is true; `None`: `cancel` was set before. It takes as long as the certificate took. A record without
/// one has nothing to compare.
///
/// # Errors
/// [`NoCertificate`] where there is none for the record's task.
pub fn verify_certificate(
    record: &Record,
    cancel: &AtomicBool,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<Vec<Mismatch>>, NoCertificate> {
    let Some(recorded) = &record.certificate else { return Ok(Some(Vec::new())) };
    let Some(found) = recheck(record, recorded, cancel, progress)? else { return Ok(None) };
    let mismatch = |difference: Difference| Mismatch {
        rank: None,
        what: format!("certificate.{}", difference.what),
        recorded: difference.own,
        found: difference.other,
    };
    Ok(Some(recorded.differences(&found).into_iter().map(mismatch).collect()))
}
