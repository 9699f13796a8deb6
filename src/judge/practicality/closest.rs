//! The least value of a distance over a motion, by branch and bound.
//!
//! A distance between moving parts changes by no more than they move. On a stretch it is therefore at least its
//! value in the middle less what [`Positions::middle_of`] allows; the stretch with the least such bound is halved until
//! the best value found is within a margin of it. Nothing between two samples can be missed.

use super::sweep::{Position, Positions, Reach, Stretch};
use crate::mechanism::AssemblyMode;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Accuracy to which least distances are proved, as a part of the longest link: far below the tolerance of a workshop.
pub const MARGIN: f64 = 1e-4;
/// Relative accuracy of a proved value, if [`MARGIN`] is less: the distance of parts far from touching need not be
/// known to the last digit.
pub const RELATIVE: f64 = 1e-3;
/// Number of pieces into which each stretch of a motion is cut at the start.
const FIRST: usize = 32;
/// Maximum number of evaluations; beyond it the bound is reported even if it is below the value by more than the
/// margin.
const MOST: usize = 200_000;

/// The least value of a distance over a motion, with a proved lower bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The least value found.
    pub value: f64,
    /// The crank angle of the least value, radians from the x axis.
    pub crank_angle: f64,
    /// The assembly mode of the least value.
    pub assembly: AssemblyMode,
    /// Proved lower bound of the distance over the motion.
    pub bound: f64,
}

/// How far a least distance is proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// To within [`MARGIN`] of the longest link or [`RELATIVE`] of itself.
    Proved,
    /// Until it is known whether it is above zero: a distance below [`MARGIN`] of the longest link counts as none.
    Decided,
}

/// A stretch with its bound, the least bound first in a heap.
struct Piece {
    bound: f64,
    stretch: Stretch,
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.stretch.from.total_cmp(&self.stretch.from))
    }
}

/// Finds the least value of `measure` over a motion, proved as far as `until` says; a bound above zero is proved in either case.
///
/// `moves` bounds the change of `measure` within a stretch by the joints' displacements. `None` if the loop is open in
/// the motion, or the motion is empty.
pub fn closest(
    positions: &Positions<'_>,
    measure: impl Fn(&Position) -> f64,
    moves: impl Fn(&Reach) -> f64,
    until: Until,
) -> Option<Closest> {
    let sweep = positions.sweep;
    let margin = MARGIN * sweep.linkage.longest_link();
    let mut best: Option<Closest> = None;
    let mut heap = BinaryHeap::new();
    let put = |stretch: Stretch, heap: &mut BinaryHeap<Piece>, best: &mut Option<Closest>| {
        let (position, reach) = positions.middle_of(&stretch)?;
        let value = measure(&position);
        let bound = value - moves(&reach);
        if best.is_none_or(|best| value < best.value) {
            let (crank_angle, assembly) = (stretch.middle(), stretch.assembly);
            *best = Some(Closest { value, crank_angle, assembly, bound: value });
        }
        heap.push(Piece { bound, stretch });
        Some(())
    };
    for stretch in &sweep.stretches {
        let width = (stretch.to - stretch.from) / FIRST as f64;
        for i in 0..FIRST {
            let from = stretch.from + width * i as f64;
            let to = if i + 1 == FIRST { stretch.to } else { from + width };
            put(Stretch { from, to, ..*stretch }, &mut heap, &mut best)?;
        }
    }
    let mut evaluations = FIRST * sweep.stretches.len();
    while let Some(piece) = heap.pop() {
        let found = best?;
        if until == Until::Decided && found.value <= margin {
            return Some(Closest { bound: f64::NEG_INFINITY, ..found });
        }
        if until == Until::Decided && piece.bound > 0.0 {
            return Some(Closest { bound: piece.bound, ..found });
        }
        let Stretch { from, to, .. } = piece.stretch;
        let middle = piece.stretch.middle();
        let indivisible = middle <= from || middle >= to;
        if found.value - piece.bound <= margin.max(RELATIVE * found.value.abs())
            || evaluations >= MOST
            || indivisible
        {
            let refined = refine(positions, &found, &measure);
            return Some(Closest { bound: piece.bound.min(refined.value), ..refined });
        }
        put(Stretch { to: middle, ..piece.stretch }, &mut heap, &mut best)?;
        put(Stretch { from: middle, ..piece.stretch }, &mut heap, &mut best)?;
        evaluations += 2;
    }
    None
}

/// Refines the best value, by golden section around its crank angle and at the ends of the motion.
fn refine(positions: &Positions<'_>, found: &Closest, measure: &impl Fn(&Position) -> f64) -> Closest {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    const ROUNDS: usize = 50;
    /// Half-width of the search interval, radians.
    const AROUND: f64 = 0.02;
    let mut best = *found;
    let mut try_at = |angle: f64, assembly: AssemblyMode| {
        let value = positions.at(angle, assembly).map_or(f64::INFINITY, |at| measure(&at));
        if value < best.value {
            best = Closest { value, crank_angle: angle, assembly, bound: value };
        }
        value
    };
    for stretch in &positions.sweep.stretches {
        try_at(stretch.from, stretch.assembly);
        try_at(stretch.to, stretch.assembly);
        if stretch.assembly != found.assembly
            || found.crank_angle < stretch.from
            || found.crank_angle > stretch.to
        {
            continue;
        }
        let mut low = (found.crank_angle - AROUND).max(stretch.from);
        let mut high = (found.crank_angle + AROUND).min(stretch.to);
        for _ in 0..ROUNDS {
            let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
            if try_at(left, stretch.assembly) <= try_at(right, stretch.assembly) {
                high = right;
            } else {
                low = left;
            }
        }
    }
    best
}
