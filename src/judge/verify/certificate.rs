//! Verification of a recorded certificate: the statements that follow from its bounds, and the bounds recomputed box by
//! box.

use super::{Comparison, Mismatch};
use crate::judge::certificate::{NoCertificate, Progress, Proof, Request, Subject, recheck};
use crate::record::{Certificate, Difference, Record};
use std::sync::atomic::AtomicBool;

/// Compares a recorded certificate with one that is computed again from the recorded problem, with as many boxes.
/// Returns the mismatches, an empty list if it is true, or `None` if `cancel` was set before the end. It takes as long
/// as the certificate took. A record without a certificate has nothing to compare.
///
/// # Errors
/// [`NoCertificate`] if there can be no certificate for the record's task.
pub fn verify_certificate(
    record: &Record,
    cancel: &AtomicBool,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<Vec<Mismatch>>, NoCertificate> {
    let Some(recorded) = &record.certificate else { return Ok(Some(Vec::new())) };
    let Some(found) = recheck(record, recorded, cancel, progress)? else { return Ok(None) };
    let mismatch = |Difference { what, own, other }| Mismatch {
        rank: None,
        what: format!("certificate.{what}"),
        recorded: own,
        found: other,
    };
    Ok(Some(recorded.differences(&found).into_iter().map(mismatch).collect()))
}

impl Comparison<'_> {
    /// Checks the statements of a certificate that follow from the bounds of its parts and the problem: its sentence,
    /// bound, gap and verdict, and its coverage. The bounds themselves are recomputed only by [`verify_certificate`].
    pub(super) fn certificate(&mut self, record: &Record) {
        if let Some(why) = &record.no_certificate {
            let asked = record.problem.resolved.solve.certify.filter(|_| record.certificate.is_none());
            let found = match asked.map(|asked| Proof::new(record, &Request { gap: asked.gap })) {
                None => "nothing: no certificate is missing".to_owned(),
                Some(Ok(_)) => "nothing: there can be a certificate".to_owned(),
                Some(Err(why)) => why.to_string(),
            };
            self.same("no_certificate", why, &found);
        }
        let Some(recorded) = &record.certificate else { return };
        let subject = match Subject::new(record, recorded.wanted_gap) {
            Ok(subject) => subject,
            Err(why) => return self.differ("certificate", "there", format!("none: {why}")),
        };
        self.parts(&subject, recorded);
        let found = subject.stated(recorded.parts.clone(), recorded.leaves_sha256.clone());
        for Difference { what, own, other } in recorded.differences(&found) {
            self.differ(&format!("certificate.{what}"), own, other);
        }
    }

    /// Checks that the parts are the classes and directions of the problem, that no bound is above the one that closes
    /// the gap, and that the bound of a closed part is equal to that one.
    fn parts(&mut self, subject: &Subject, recorded: &Certificate) {
        let own = recorded.parts.iter().map(|part| format!("{} {:+}", part.linkage_type, part.direction));
        let asked = subject.parts().into_iter().map(|(class, way)| format!("{} {way:+}", class.name()));
        let list = |names: Vec<String>| names.join(", ");
        self.same("certificate.parts", list(own.collect()), list(asked.collect()));
        let most = subject.wanted();
        for (i, part) in recorded.parts.iter().enumerate() {
            // An open part has a box whose bound is below it.
            let possible = part.lower_bound >= 0.0 && part.lower_bound <= most;
            if !possible || part.closed != (part.lower_bound == most) {
                let closes = if part.closed { "" } else { "less than " };
                self.differ(
                    &format!("certificate.parts {}: lower_bound", i + 1),
                    format!("{:e}", part.lower_bound),
                    format!("{closes}{most:e}, which closes the gap"),
                );
            }
        }
    }
}
