//! A recorded certificate: what follows from its bounds, and the bounds worked out again box by box.

use super::Mismatch;
use crate::certificate::{NoCertificate, Progress, Proof, Request, Subject, recheck};
use crate::record::{Certificate, Difference, Record};
use std::sync::atomic::AtomicBool;

fn mismatch(difference: Difference) -> Mismatch {
    Mismatch {
        rank: None,
        what: format!("certificate.{}", difference.what),
        recorded: difference.own,
        found: difference.other,
    }
}

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
    Ok(Some(recorded.differences(&found).into_iter().map(mismatch).collect()))
}

/// What a certificate says besides the bounds of its parts follows from these and the problem: its sentence, its bound,
/// gap and verdict, what it covers. The bounds themselves are worked out by [`verify_certificate`] alone.
pub(super) fn stated(record: &Record, mismatches: &mut Vec<Mismatch>) {
    let mut whole = |what: &str, recorded: String, found: String| {
        if recorded != found {
            mismatches.push(Mismatch { rank: None, what: what.into(), recorded, found });
        }
    };
    if let Some(why) = &record.no_certificate {
        let asked = record.problem.resolved.solve.certify.filter(|_| record.certificate.is_none());
        let found = match asked.map(|asked| Proof::new(record, &Request { gap: asked.gap })) {
            None => "nothing: no certificate is missing".to_owned(),
            Some(Ok(_)) => "nothing: there can be a certificate".to_owned(),
            Some(Err(why)) => why.to_string(),
        };
        whole("no_certificate", why.clone(), found);
    }
    let Some(recorded) = &record.certificate else { return };
    let subject = match Subject::new(record, recorded.wanted_gap) {
        Ok(subject) => subject,
        Err(why) => return whole("certificate", "there".into(), format!("none: {why}")),
    };
    parts(&subject, recorded, &mut whole);
    let found = subject.stated(recorded.parts.clone(), recorded.leaves_sha256.clone());
    mismatches.extend(recorded.differences(&found).into_iter().map(mismatch));
}

/// The parts are the classes and directions of the problem; no bound is above the one that closes the gap, and that of a
/// closed part is that one.
fn parts(subject: &Subject, recorded: &Certificate, whole: &mut dyn FnMut(&str, String, String)) {
    let names = |(class, way): (String, i8)| format!("{class} {way:+}");
    let own = recorded.parts.iter().map(|part| names((part.linkage_type.clone(), part.direction)));
    let asked = subject.parts();
    let asked =
        asked.iter().map(|(class, way)| names((class.name().to_owned(), if *way > 0.0 { 1 } else { -1 })));
    whole("certificate.parts", own.collect::<Vec<_>>().join(", "), asked.collect::<Vec<_>>().join(", "));
    let most = subject.wanted();
    for (i, part) in recorded.parts.iter().enumerate() {
        // What is open has a box whose bound is below it.
        let possible = part.lower_bound >= 0.0 && part.lower_bound <= most;
        if !possible || part.closed != (part.lower_bound == most) {
            let closes = if part.closed { "" } else { "less than " };
            whole(
                &format!("certificate.parts {}: lower_bound", i + 1),
                format!("{:e}", part.lower_bound),
                format!("{closes}{most:e}, which closes the gap"),
            );
        }
    }
}
