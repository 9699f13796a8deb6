//! A recorded certificate, worked out again box by box.

use super::Mismatch;
use crate::certificate::{NoCertificate, recheck};
use crate::record::{Certificate, Record};

/// Compares a recorded certificate with one that is worked out anew from the recorded problem, with as many boxes;
/// an empty list: it is true. It takes as long as the certificate took. A record without one has nothing to compare.
///
/// # Errors
/// [`NoCertificate`] where there is none for the record's task.
pub fn verify_certificate(record: &Record) -> Result<Vec<Mismatch>, NoCertificate> {
    let Some(recorded) = &record.certificate else { return Ok(Vec::new()) };
    let found = recheck(record, recorded)?;
    let mut mismatches = Vec::new();
    let mut compare = |what: String, recorded: String, found: String| {
        if recorded != found {
            let what = format!("certificate.{what}");
            mismatches.push(Mismatch { rank: None, what, recorded, found });
        }
    };
    let words = |c: &Certificate| {
        [
            ("statement", c.statement.clone()),
            ("lower_bound", format!("{:e}", c.lower_bound)),
            ("gap", format!("{:e}", c.gap)),
            ("closed", c.closed.to_string()),
            ("boxes", c.boxes.to_string()),
            ("covered", c.covered.join("; ")),
            ("not_covered", c.not_covered.join("; ")),
            ("leaves_sha256", c.leaves_sha256.clone()),
            ("parts", c.parts.len().to_string()),
        ]
    };
    for ((what, recorded), (_, found)) in words(recorded).into_iter().zip(words(&found)) {
        compare(what.into(), recorded, found);
    }
    for (i, (recorded, found)) in recorded.parts.iter().zip(&found.parts).enumerate() {
        compare(format!("parts {}", i + 1), format!("{recorded:?}"), format!("{found:?}"));
    }
    Ok(mismatches)
}
