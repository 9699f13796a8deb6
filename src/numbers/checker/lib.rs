//! The check of a certificate's leaves, in arithmetic of its own.
//!
//! The check shares with the search the file of the leaves and its data (`linkwright-leaves`): no bound and no
//! arithmetic. The tree is replayed: its halves cover the chart. On each leaf the least sum of squares is enclosed from
//! below: intervals with outward rounding ([`interval`]), functions over a box as polynomials of second degree with an
//! enclosed rest ([`model`]), the target's directions in intervals ([`frame`]). A leaf that is too large for that is
//! halved here until it is proved ([`region`]).
//!
//! | module | holds |
//! |---|---|
//! | [`claim`] | the claim that a box is checked for, and linear functionals of the directions u over a box |
//! | [`frame`] | the target in intervals: the directions 1, e and T' with bounds of their errors |
//! | [`interval`] | interval arithmetic with outward rounding: every end is moved to the next number outwards |
//! | [`model`] | Taylor models of second degree: functions over a box, enclosed by a polynomial and an interval for the remainder (the rest) |
//! | [`real`] | the check of a box if K is a real length: crank angles from the x axis |
//! | [`region`] | the check of one box: a proof that every linkage in it has a sum of squares of at least the claimed one |

pub mod claim;
pub mod frame;
pub mod interval;
pub mod model;
mod real;
pub mod region;

use claim::Claim;
use linkwright_leaves::{Angles, Cell, LeavesPart};
use rayon::prelude::*;
use region::{Region, Shown};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The number of leaves checked between two reports of progress and checks for cancellation.
const BLOCK: usize = 1 << 15;
/// The largest number of boxes into which a leaf is halved.
pub const MOST_BOXES: u64 = 20_000;

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

/// The question that a tree answers: no linkage of the chart has a sum of squares below the bound.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The points.
    pub points: &'a [[f64; 2]],
    /// The crank's increments, or its angles, degrees.
    pub turns_deg: &'a [f64],
    /// The cap of |Z|.
    pub cap: f64,
    /// The reference direction of the crank angles.
    pub angles: &'a Angles,
    /// The part of the chart that the tree covers.
    pub chart: Cell,
}

/// The reason for which a tree does not prove its bound.
#[derive(Clone, Debug, PartialEq)]
pub enum Unproved {
    /// The tree does not cover the chart; the fault in words.
    Uncovered(&'static str),
    /// The points or angles are too much alike.
    Degenerate,
    /// A leaf could not be proved within [`MOST_BOXES`].
    Leaf {
        /// The leaf, from 1, in the order of the file.
        leaf: u64,
        /// The ranges of p, phi, g and d.
        sides: [[f64; 2]; 4],
        /// The rule that the file gives for it.
        rule: &'static str,
    },
    /// The check was stopped.
    Stopped,
}

/// Checks that the tree of one part proves its bound.
///
/// # Errors
/// [`Unproved`]: the first fault.
pub fn check(
    part: &LeavesPart,
    question: &Question<'_>,
    cancel: &AtomicBool,
    checked: &mut Checked,
    progress: &mut dyn FnMut(&Checked),
) -> Result<(), Unproved> {
    part.nodes.covers().map_err(Unproved::Uncovered)?;
    let Question { points, turns_deg: turns, cap, angles, chart } = *question;
    let claim = match angles {
        Angles::Increments | Angles::Ground => {
            Claim::new(part.class, f64::from(part.direction), points, turns, cap, part.lower_bound)
        }
        Angles::Axis(axis) => Claim::on_axis(part.class, points, turns, cap, part.lower_bound, axis),
    }
    .ok_or(Unproved::Degenerate)?;
    let mut replay = leaves(part, chart);
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
            return Err(Unproved::Leaf {
                leaf: before + at as u64 + 1,
                sides: std::array::from_fn(|k| [low[k], high[k]]),
                rule: ["open", "outside", "cognate", "bounded"].get(usize::from(rule)).unwrap_or(&"unknown"),
            });
        }
        before += block.len() as u64;
        checked.leaves += block.len() as u64;
        checked.boxes += boxes.load(Ordering::Relaxed);
        progress(checked);
        if cancel.load(Ordering::Relaxed) {
            return Err(Unproved::Stopped);
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

/// Iterates over the leaves of a part in order, with their boxes.
fn leaves(part: &LeavesPart, whole: Cell) -> impl Iterator<Item = Leaf> {
    let mut codes = part.nodes.codes();
    let mut waiting = vec![Region { low: whole.low, high: whole.high }];
    std::iter::from_fn(move || {
        loop {
            let region = waiting.pop()?;
            let code = codes.next()?;
            let Some(axis @ 0..4) = code.checked_sub(4).map(usize::from) else { return Some((region, code)) };
            // The middle in single precision, as the file's format says.
            let middle = f64::from((0.5 * (region.low[axis] + region.high[axis])) as f32);
            let [lower, upper] = region.parts(axis, middle);
            waiting.extend([upper, lower]);
        }
    })
}
