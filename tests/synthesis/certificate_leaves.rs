//! The leaves of a certificate: the file, and the checker that shares nothing with the search.

use crate::certificate::{K18, KINDS, capped_sum, cell, directions, draws, points_of, turns};
use crate::common::thorough::cases;
use crate::common::{job, literature};
use linkwright::internals::app::job::run::{Context, run};
use linkwright::internals::judge::certificate::{CheckError, Checked, Proof, Request, check};
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::checker::{
    claim::Claim,
    region::{Region, Shown},
};
use linkwright::internals::numbers::leaves::ROOT;
use linkwright::internals::numbers::leaves::{Leaves, LeavesError};
use linkwright::internals::record::{Certificate, Record};
use sha2::{Digest, Sha256};
use std::sync::atomic::{AtomicBool, Ordering};

pub fn k18() -> Record {
    let idle = AtomicBool::new(false);
    let context = Context { cancel: &idle, observer: &|_| {} };
    run(&job(literature("k18", &[])), &context).expect("it runs").record
}

/// The same points with crank angles from the ground line: three numbers instead of four, and soon decided. The best of
/// all has longer links than the problem allows, so that a gap of 1.4 % remains.
pub fn from_ground() -> Record {
    let idle = AtomicBool::new(false);
    let context = Context { cancel: &idle, observer: &|_| {} };
    let file = literature("k18", &[("task.path.timing.offset", "ground")]);
    run(&job(file), &context).expect("it runs").record
}

/// A search that ends by itself.
pub fn whole(record: &Record, gap: f64) -> Proof {
    let mut proof = Proof::new(record, &Request { gap }).expect("there is a certificate");
    proof.run(&AtomicBool::new(false), None, &mut |_| {});
    proof
}

/// A search that is stopped after some batches.
pub fn stopped(record: &Record, gap: f64, batches: usize) -> Proof {
    let mut proof = Proof::new(record, &Request { gap }).expect("there is a certificate");
    let cancel = AtomicBool::new(false);
    let mut seen = 0;
    proof.run(&cancel, None, &mut |_| {
        seen += 1;
        cancel.store(seen >= batches, Ordering::Relaxed);
    });
    proof
}

fn checked(record: &Record, certificate: &Certificate, bytes: &[u8]) -> Result<Checked, CheckError> {
    check(record, certificate, bytes, &AtomicBool::new(false), &mut |_| {})
}

/// The file with its checksum put right again after a change.
pub fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let body = bytes.len() - 32;
    let sum: [u8; 32] = Sha256::digest(&bytes[..body]).into();
    bytes[body..].copy_from_slice(&sum);
    bytes
}

#[test]
fn the_root_holds_the_whole_chart() {
    let pi = std::f64::consts::PI;
    let chart = [[0.0, 1.0], [-pi, pi], [0.0, pi], [-pi / 2.0, pi / 2.0]];
    for (k, [low, high]) in chart.into_iter().enumerate() {
        assert!(ROOT.low[k] <= low && high <= ROOT.high[k]);
    }
}

#[test]
fn leaves_are_read_as_they_were_written_and_what_was_changed_is_refused() {
    let record = k18();
    let proof = stopped(&record, 1e-4, 6);
    let leaves = proof.leaves();
    let certificate = proof.certificate();
    let bytes = leaves.to_bytes();
    assert_eq!(Leaves::from_bytes(&bytes), Ok(leaves.clone()));
    let boxes: u64 = certificate.parts.iter().map(|part| part.boxes).sum();
    assert_eq!(boxes, certificate.boxes);
    assert_eq!(leaves.parts.iter().map(|part| part.nodes.len() - 1).sum::<u64>(), boxes);
    // The certificate's bound is 0 by now: every leaf holds it.
    let found = checked(&record, &certificate, &bytes).expect("true");
    assert_eq!(found.leaves, boxes / 2 + 4, "a tree of n boxes beside the first has n/2 + 1 leaves");
    // Any byte.
    for at in [0, 9, 13, 20, 30, bytes.len() / 2, bytes.len() - 40, bytes.len() - 1] {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        assert!(matches!(checked(&record, &certificate, &changed), Err(CheckError::Leaves(_))), "byte {at}");
    }
    for length in [0, 7, 12, 31, 40, bytes.len() - 1] {
        assert!(Leaves::from_bytes(&bytes[..length]).is_err(), "{length} bytes");
    }
    let mut other_version = bytes.clone();
    other_version[8] = 9;
    assert_eq!(Leaves::from_bytes(&sealed(other_version)), Err(LeavesError::Version { found: 9 }));
    // A leaf removed: a halved box becomes one without halves, or a leaf is halved; the checksum is right.
    let first = 16 + 24;
    for (nibble, code) in [(0, 0), (0, 3), (1, 1)] {
        let mut cut = bytes.clone();
        let byte = &mut cut[first + nibble / 2];
        *byte = if nibble % 2 == 0 { *byte & 0xf0 | code } else { *byte & 0x0f | code << 4 };
        let refused = Leaves::from_bytes(&sealed(cut));
        assert!(matches!(refused, Err(LeavesError::Uncovered { part: 1, .. })), "{refused:?}");
    }
    let leaf = leaves.parts[0].nodes.codes().position(|code| code < 4).expect("a leaf");
    for code in [4, 8] {
        let mut grown = bytes.clone();
        let byte = &mut grown[first + leaf / 2];
        *byte = if leaf % 2 == 0 { *byte & 0xf0 | code } else { *byte & 0x0f | code << 4 };
        let refused = Leaves::from_bytes(&sealed(grown));
        assert!(matches!(refused, Err(LeavesError::Uncovered { part: 1, .. })), "{refused:?}");
    }
    // Leaves of another certificate.
    let others = stopped(&record, 1e-4, 7).leaves().to_bytes();
    let refused = checked(&record, &certificate, &others);
    assert!(matches!(refused, Err(CheckError::Other { .. })), "{refused:?}");
}

#[test]
fn a_bound_that_was_raised_and_a_rule_that_does_not_hold_are_refused() {
    let record = k18();
    let proof = stopped(&record, 1e-4, 6);
    let leaves = proof.leaves();
    // In the record alone.
    let mut certificate = proof.certificate();
    certificate.lower_bound = 0.009;
    let refused = checked(&record, &certificate, &leaves.to_bytes());
    assert!(matches!(&refused, Err(CheckError::Other { what, .. }) if what == "lower_bound"), "{refused:?}");
    let mut certificate = proof.certificate();
    certificate.statement = certificate.statement.replace("coupler point", "pivot");
    assert!(matches!(
        checked(&record, &certificate, &leaves.to_bytes()),
        Err(CheckError::Other { what, .. }) if what == "statement"
    ));
    // In both, above what a known linkage has.
    let subject = linkwright::internals::judge::certificate::Subject::new(&record, 1e-4).expect("a subject");
    let mut raised = leaves.clone();
    for part in &mut raised.parts {
        part.lower_bound = 1.5 * subject.best;
    }
    let refused = checked(&record, &subject.certificate(&raised), &raised.to_bytes());
    assert!(matches!(refused, Err(CheckError::Leaf { .. })), "{refused:?}");
    // An open box that the file gives out for decided by one rule or another.
    let bytes = leaves.to_bytes();
    let open = leaves.parts[0].nodes.codes().position(|code| code == 0).expect("an open box");
    for code in [1, 2] {
        let mut wrong = bytes.clone();
        wrong[16 + 24 + open / 2] |= code << (4 * (open % 2));
        let wrong = Leaves::from_bytes(&sealed(wrong)).expect("a tree");
        let refused = checked(&record, &subject.certificate(&wrong), &wrong.to_bytes());
        assert!(matches!(refused, Err(CheckError::Leaf { part: 1, .. })), "{refused:?}");
    }
}

#[test]
fn what_the_checker_shows_of_a_box_holds_at_its_points() {
    let random = &mut stream(11, 0);
    let size = KINDS.map(|(_, direction)| {
        let target =
            linkwright::internals::numbers::bound::Target::new(&K18, &turns(), direction).expect("a target");
        target.size_sq()
    });
    let (mut shown, mut near) = (0, 0);
    for i in 0..draws(cases(30_000, 60_000)) {
        let (class, direction) = KINDS[i % 4];
        let cell = cell(random);
        let region = Region { low: cell.low, high: cell.high };
        let sum = 0.98 * size[i % 4] * unit(random).powi(2);
        let cap = 10.0_f64.powf(3.0 * unit(random));
        let claim = Claim::new(class, direction, &K18, &turns(), cap, sum).expect("a claim");
        if claim.look(&region) != Shown::Yes || region.is_outside() || region.has_cognates() {
            continue;
        }
        shown += 1;
        for x in points_of(&cell, random).into_iter().step_by(3) {
            let u = directions(&x, class, direction, &turns());
            let least = capped_sum(&K18, &turns(), direction, &u, cap);
            assert!(least >= sum * (1.0 - 1e-9), "{class:?} {region:?} {x:?}: {least} below {sum}");
            near += usize::from(least < 1.2 * sum);
        }
    }
    assert!(
        shown > draws(cases(3_000, 6_000)) && near > draws(cases(300, 600)),
        "{shown} shown, {near} near"
    );
}

#[test]
fn what_the_checker_takes_for_empty_or_mirrored_is() {
    let random = &mut stream(12, 0);
    let mut seen = [0; 2];
    for _ in 0..draws(100_000) {
        let cell = cell(random);
        let region = Region { low: cell.low, high: cell.high };
        let (out, mirrored) = (region.is_outside(), region.has_cognates());
        seen[0] += usize::from(out);
        seen[1] += usize::from(mirrored);
        for x in points_of(&cell, random).iter().filter(|_| out || mirrored) {
            if out {
                assert!(x.d.abs() > x.g.min(std::f64::consts::PI - x.g), "{cell:?} {x:?}");
            }
            if mirrored {
                let (sin, cos) = ((x.g.sin() * x.d.sin()).abs(), (x.g.cos() * x.d.cos()).abs());
                assert!(sin < x.p * cos, "{cell:?} {x:?}");
            }
        }
    }
    assert!(seen.iter().all(|n| *n > draws(5_000)), "{seen:?}");
}

#[test]
fn a_closed_certificate_is_proved_by_its_leaves_and_by_nothing_less() {
    let record = from_ground();
    let gap = 0.02;
    let proof = whole(&record, gap);
    let (leaves, certificate) = (proof.leaves(), proof.certificate());
    let best = record.candidates[0].error.sum_sq;
    assert!(
        certificate.closed && certificate.gap <= gap && certificate.lower_bound < best,
        "{certificate:?}"
    );
    assert!(certificate.statement.contains("from the ground line") && certificate.parts.len() == 2);
    let found = checked(&record, &certificate, &leaves.to_bytes()).expect("true");
    assert_eq!(found.leaves, certificate.boxes / 2 + 2);
    assert!(found.boxes < 4 * found.leaves, "{found:?}");
    // The file of another question: any first crank angle.
    let mut other = leaves.clone();
    other.parts[0].origin = 0;
    let subject = linkwright::internals::judge::certificate::Subject::new(&record, gap).expect("a subject");
    let refused = checked(&record, &subject.certificate(&other), &other.to_bytes());
    assert_eq!(refused, Err(CheckError::Parts));
    // A bound above the best candidate's sum, in the record and in the file: some leaf does not hold it.
    let mut raised = leaves.clone();
    for part in &mut raised.parts {
        part.lower_bound = best * (1.0 + 1e-6);
    }
    let refused = checked(&record, &subject.certificate(&raised), &raised.to_bytes());
    assert!(matches!(refused, Err(CheckError::Leaf { rule: "bounded", .. })), "{refused:?}");
    // Leaves with another rule: bounded ones given out for outside or for mirrored.
    let bytes = leaves.to_bytes();
    let bounded: Vec<usize> =
        leaves.parts[0].nodes.codes().enumerate().filter(|(_, code)| *code == 3).map(|(at, _)| at).collect();
    for code in [1, 2] {
        let mut wrong = bytes.clone();
        // A few are mirrored too.
        for at in bounded.iter().step_by(bounded.len() / 8) {
            let byte = &mut wrong[16 + 24 + at / 2];
            *byte = if at % 2 == 0 { *byte & 0xf0 | code } else { *byte & 0x0f | code << 4 };
        }
        let wrong = Leaves::from_bytes(&sealed(wrong)).expect("a tree");
        let refused = checked(&record, &subject.certificate(&wrong), &wrong.to_bytes());
        assert!(matches!(refused, Err(CheckError::Leaf { part: 1, .. })), "{refused:?}");
    }
}
