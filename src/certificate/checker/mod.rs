//! The check of a certificate's leaves, in arithmetic of its own.
//!
//! The check shares with the search the file of the leaves, the record's figures ([`Subject`]) and the chart's extent
//! and classes ([`super::leaves::root`], [`Class`](super::chart::Class)): no bound and no arithmetic. The tree is
//! replayed: its halves cover the chart. On each leaf the least sum of squares is enclosed from below: intervals with
//! outward rounding ([`interval`]), functions over a box as polynomials of second degree with an enclosed rest
//! ([`model`]), the target's directions in intervals ([`frame`]). A leaf that is too large for that is halved here
//! until it is proved ([`region`]).

pub mod frame;
pub mod interval;
pub mod model;
mod real;
pub mod region;

use super::bound::Cell;
use super::leaves::{Angles, Leaves, LeavesError, LeavesPart};
use super::subject::{NoCertificate, Subject};
use crate::record::{Certificate, Difference, Record};
use rayon::prelude::*;
use region::{Claim, Region, Shown};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The number of leaves checked between two reports of progress and checks for cancellation.
const BLOCK: usize = 1 << 15;
/// The largest number of boxes into which a leaf is halved.
const MOST_BOXES: u64 = 20_000;

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
        "leaf {leaf} of part {part} is not shown within {MOST_BOXES} boxes: p {p:?}, phi {phi:?}, g {g:?}, d {d:?} as \
         \"{rule}\"; verify --certificate works it out by the rules of the search"
    )]
    Leaf {
        /// The part, from 1.
        part: usize,
        /// The leaf, from 1, in the order of the file.
        leaf: u64,
        /// The range of p.
        p: [f64; 2],
        /// The range of phi.
        phi: [f64; 2],
        /// The range of g.
        g: [f64; 2],
        /// The range of d.
        d: [f64; 2],
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
}

/// The counts of a check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// The number of leaves of the file checked.
    pub leaves: u64,
    /// The number of boxes into which they were halved.
    pub boxes: u64,
}

/// A leaf: its box and its rule in the file.
type Leaf = (Region, u8);

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
    let mut checked = Checked::default();
    for (i, part) in leaves.parts.iter().enumerate() {
        check_part(i + 1, part, &subject, cancel, &mut checked, progress)?;
    }
    Ok(checked)
}

/// Checks one part's leaves.
fn check_part(
    number: usize,
    part: &LeavesPart,
    subject: &Subject,
    cancel: &AtomicBool,
    checked: &mut Checked,
    progress: &mut dyn FnMut(&Checked),
) -> Result<(), CheckError> {
    part.nodes.covers().map_err(|what| LeavesError::Uncovered { part: number, what })?;
    let (points, turns, cap) = (&subject.points, &subject.turns_deg, subject.cap);
    let claim = match &subject.angles {
        Angles::Increments | Angles::Ground => {
            Claim::new(part.class, f64::from(part.direction), points, turns, cap, part.lower_bound)
        }
        Angles::Axis(axis) => Claim::on_axis(part.class, points, turns, cap, part.lower_bound, axis),
    }
    .ok_or(NoCertificate::Target(super::TargetError::Degenerate))?;
    let mut replay = Replay::new(part, subject.root());
    let mut before = 0;
    loop {
        let block: Vec<Leaf> = replay.by_ref().take(BLOCK).collect();
        if block.is_empty() {
            return Ok(());
        }
        let boxes = AtomicU64::new(0);
        let failed = block.par_iter().with_min_len(64).position_first(|leaf| {
            let shown = shows(&claim, leaf);
            boxes.fetch_add(shown.unwrap_or(0), Ordering::Relaxed);
            shown.is_none()
        });
        if let Some(at) = failed {
            let (Region { low, high }, rule) = block[at];
            let side = |k: usize| [low[k], high[k]];
            return Err(CheckError::Leaf {
                part: number,
                leaf: before + at as u64 + 1,
                p: side(0),
                phi: side(1),
                g: side(2),
                d: side(3),
                rule: ["open", "outside", "cognate", "bounded"].get(usize::from(rule)).unwrap_or(&"unknown"),
            });
        }
        before += block.len() as u64;
        checked.leaves += block.len() as u64;
        checked.boxes += boxes.load(Ordering::Relaxed);
        progress(checked);
        if cancel.load(Ordering::Relaxed) {
            return Err(CheckError::Stopped);
        }
    }
}

/// Proves a leaf; returns the number of boxes that it took, or `None` if it could not be proved.
fn shows(claim: &Claim, (region, rule): &Leaf) -> Option<u64> {
    match rule {
        1 => return claim.is_outside(region).then_some(1),
        2 => return claim.has_cognates(region).then_some(1),
        _ => {}
    }
    let mut boxes = 0;
    let mut waiting = vec![*region];
    while let Some(region) = waiting.pop() {
        boxes += 1;
        if boxes > MOST_BOXES {
            return None;
        }
        if let Shown::Not(axis) = claim.look(&region) {
            let middle = 0.5 * (region.low[axis] + region.high[axis]);
            waiting.extend(region.parts(axis, middle));
        }
    }
    Some(boxes)
}

/// An iterator over the leaves of a part in order, with their boxes.
struct Replay<'a> {
    codes: Box<dyn Iterator<Item = u8> + 'a>,
    waiting: Vec<Region>,
}

impl<'a> Replay<'a> {
    fn new(part: &'a LeavesPart, whole: Cell) -> Self {
        let whole = Region { low: whole.low, high: whole.high };
        Replay { codes: Box::new(part.nodes.codes()), waiting: vec![whole] }
    }
}

impl Iterator for Replay<'_> {
    type Item = Leaf;

    fn next(&mut self) -> Option<Leaf> {
        loop {
            let region = self.waiting.pop()?;
            let code = self.codes.next()?;
            let Some(axis @ 0..4) = code.checked_sub(4).map(usize::from) else { return Some((region, code)) };
            // The middle in single precision, as the file's format says.
            let middle = f64::from((0.5 * (region.low[axis] + region.high[axis])) as f32);
            let [lower, upper] = region.parts(axis, middle);
            self.waiting.extend([upper, lower]);
        }
    }
}
