//! The check of the leaves that a certificate names.

use super::subject::{NoCertificate, Subject};
use crate::numbers::bound::TargetError;
use crate::numbers::checker::{self, MOST_BOXES, Unproved};
use crate::numbers::leaves::{Leaves, LeavesError, LeavesPart};
use crate::record::{Certificate, Difference, Record};
use std::sync::atomic::AtomicBool;

pub use crate::numbers::checker::Checked;

/// The reason for which a certificate's leaves do not prove it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// The file of leaves is faulty.
    #[error(transparent)]
    Leaves(#[from] LeavesError),
    /// The record's problem has no certificate.
    #[error(transparent)]
    NoCertificate(#[from] NoCertificate),
    /// The leaves are not those of the certificate.
    #[error(
        "the leaves are not those of this certificate: {what} is {found} by the leaves, {recorded} in the record"
    )]
    Other {
        /// The first key that differs.
        what: String,
        /// The value by the leaves.
        found: String,
        /// The value in the record.
        recorded: String,
    },
    /// A part is missing, or occurs twice.
    #[error("the leaves have other classes or directions of the crank than the record's problem")]
    Parts,
    /// A leaf could not be proved.
    #[error(
        "leaf {leaf} of part {part} is not shown within {MOST_BOXES} boxes: p {:?}, phi {:?}, g {:?}, d {:?} as \
         \"{rule}\"; verify --certificate works it out by the rules of the search",
        sides[0], sides[1], sides[2], sides[3]
    )]
    Leaf {
        /// The part, from 1.
        part: usize,
        /// The leaf, from 1, in the order of the file.
        leaf: u64,
        /// The ranges of p, phi, g and d.
        sides: [[f64; 2]; 4],
        /// The rule that the file gives for it.
        rule: &'static str,
    },
    /// The check was stopped.
    #[error("the check was stopped: nothing is said about the certificate")]
    Stopped,
}

impl CheckError {
    /// Returns whether the leaves are not as the record describes them. A leaf that could not be proved may be true
    /// all the same.
    pub fn is_refuted(&self) -> bool {
        !matches!(self, CheckError::Leaf { .. } | CheckError::Stopped)
    }

    fn of(unproved: Unproved, part: usize) -> Self {
        match unproved {
            Unproved::Uncovered(what) => LeavesError::Uncovered { part, what }.into(),
            Unproved::Degenerate => NoCertificate::Target(TargetError::Degenerate).into(),
            Unproved::Leaf { leaf, sides, rule } => CheckError::Leaf { part, leaf, sides, rule },
            Unproved::Stopped => CheckError::Stopped,
        }
    }
}

/// Checks that the leaves in `bytes` prove the certificate of a record.
///
/// # Errors
/// [`CheckError`]: the first fault.
pub fn check(
    record: &Record,
    recorded: &Certificate,
    bytes: &[u8],
    cancel: &AtomicBool,
    progress: &mut dyn FnMut(&Checked),
) -> Result<Checked, CheckError> {
    let leaves = Leaves::from_bytes(bytes)?;
    let subject = Subject::new(record, recorded.wanted_gap)?;
    let parts = subject.parts();
    let named = |part: &LeavesPart| (part.class, f64::from(part.direction));
    let alike = leaves.parts.iter().all(|part| part.origin == subject.angles.origin());
    if !alike || leaves.parts.iter().map(named).ne(parts.iter().copied()) {
        return Err(CheckError::Parts);
    }
    if let Some(first) = recorded.differences(&subject.certificate(&leaves)).into_iter().next() {
        let Difference { what, own: recorded, other: found } = first;
        return Err(CheckError::Other { what, found, recorded });
    }
    let question = checker::Question {
        points: &subject.points,
        turns_deg: &subject.turns_deg,
        cap: subject.cap,
        angles: &subject.angles,
        chart: subject.root(),
    };
    let mut checked = Checked::default();
    for (i, part) in leaves.parts.iter().enumerate() {
        checker::check(part, &question, cancel, &mut checked, progress)
            .map_err(|unproved| CheckError::of(unproved, i + 1))?;
    }
    Ok(checked)
}
