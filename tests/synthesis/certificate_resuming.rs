//! A search for a certificate that is stopped and goes on ends in the bytes of one that was never broken.

use crate::certificate_leaves::{from_ground, k18, sealed, stopped, whole};
use linkwright::internals::judge::certificate::{Proof, Request, ResumeError};
use std::sync::atomic::{AtomicBool, Ordering};

const GAP: Request = Request { gap: 1e-4 };

/// Some more batches on some threads.
fn more(mut proof: Proof, batches: usize, threads: usize) -> Proof {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let cancel = AtomicBool::new(false);
    let mut seen = 0;
    pool.install(|| {
        proof.run(&cancel, None, &mut |_| {
            seen += 1;
            cancel.store(seen >= batches, Ordering::Relaxed);
        });
    });
    proof
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_stopped_search_goes_on_to_the_same_bytes_on_any_number_of_threads() {
    let record = k18();
    let unbroken = stopped(&record, GAP.gap, 60);
    let (end, certificate) = (unbroken.checkpoint(), unbroken.certificate());
    for (first, second, threads) in [(1, 2, 1), (20, 30, 2), (59, 1, 3)] {
        let kept = stopped(&record, GAP.gap, first).checkpoint();
        let proof = Proof::resume(&record, &GAP, &kept).expect("it goes on");
        assert_eq!(proof.checkpoint(), kept, "what was read is what was written");
        let kept = more(proof, second, threads).checkpoint();
        let proof = Proof::resume(&record, &GAP, &kept).expect("it goes on");
        let proof = if first + second < 60 { more(proof, 60 - first - second, 4 - threads) } else { proof };
        assert!(proof.checkpoint() == end, "{first} {second} {threads}");
        assert_eq!(proof.certificate(), certificate);
        assert_eq!(proof.leaves(), unbroken.leaves());
    }
    assert!(certificate.boxes > 50_000, "{}", certificate.boxes);
}

#[test]
fn a_stopped_search_closes_the_gap_as_an_unbroken_one_does() {
    let record = from_ground();
    let wide = Request { gap: 0.02 };
    let unbroken = whole(&record, wide.gap);
    assert!(unbroken.certificate().closed && unbroken.ended());
    let mut broken = stopped(&record, wide.gap, 1);
    let mut times = 0;
    while !broken.ended() {
        broken = Proof::resume(&record, &wide, &broken.checkpoint()).expect("it goes on");
        broken = more(broken, 4, 1 + times % 2);
        times += 1;
    }
    assert!(times > 2, "{times}");
    assert_eq!(broken.certificate(), unbroken.certificate());
    assert_eq!(broken.leaves().to_bytes(), unbroken.leaves().to_bytes());
    assert_eq!(broken.checkpoint(), unbroken.checkpoint());
}

#[test]
fn what_is_not_the_same_search_is_refused() {
    let record = k18();
    let kept = stopped(&record, GAP.gap, 5).checkpoint();
    let refused = |bytes: &[u8]| Proof::resume(&record, &GAP, bytes).err();
    assert_eq!(refused(b"{}"), Some(ResumeError::Foreign));
    assert_eq!(refused(b""), Some(ResumeError::Foreign));
    for length in [8, 12, 20, 60, 200, kept.len() - 1] {
        assert!(refused(&kept[..length]).is_some(), "{length} bytes");
    }
    for at in [25, 60, 100, kept.len() / 2, kept.len() - 1] {
        let mut changed = kept.clone();
        changed[at] ^= 4;
        assert_eq!(refused(&changed), Some(ResumeError::Changed), "byte {at}");
    }
    let mut other = kept.clone();
    other[8] = 7;
    assert!(matches!(refused(&sealed(other)), Some(ResumeError::OtherVersion { .. })));
    // Another gap, and another answer to compare with.
    assert_eq!(Proof::resume(&record, &Request { gap: 1e-3 }, &kept).err(), Some(ResumeError::Other));
    let mut better = record.clone();
    better.candidates[0].error.sum_sq *= 0.5;
    assert_eq!(Proof::resume(&better, &GAP, &kept).err(), Some(ResumeError::Other));
    // Its checksum is right, and it holds no search all the same.
    let begin = 8 + 4 + 1 + usize::from(kept[12]) + 32 + 4;
    for (at, byte) in [(begin + 7, 0x7f), (begin + 8, 0xff), (begin + 16, 0), (kept.len() - 33, 9)] {
        let mut wrong = kept.clone();
        wrong[at] = byte;
        assert_eq!(refused(&sealed(wrong)), Some(ResumeError::Changed), "byte {at}");
    }
}
