//! Rows of the extent: the limit less the diagonal of the box of A, B, C, D and P over the motion.
//!
//! There is a row for each diagonal of the box ([`diagonals`]); du is the derivative of the extreme joint at its extreme
//! position (Danskin 1967).

use super::diagonal::{Diagonal, diagonals};
use super::swept::Swept;
use super::{At, MOST_TURNS, Row, RowKind, Side, Turn};
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;

/// The joints C, D, P, A, B.
const JOINTS: usize = 5;

/// The least coordinate of a joint in a direction over the motion, with its derivatives.
#[derive(Clone, Copy)]
struct Reach {
    value: f64,
    shape: [f64; SHAPE],
    turn: Turn,
}

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let Some(most) = at.require.extent_max else { return };
    let kind = RowKind::of(RequirementKind::ExtentMax, None);
    let Some(reaches) = reaches(at) else {
        // A linkage without any position has no extent: its violation is the target's size.
        let lacking = Row::still(kind, -at.size, [0.0; SHAPE]);
        (0..1 + Side::ALL.len() * (JOINTS - 1)).for_each(|_| each(&lacking));
        return;
    };
    let least = reaches.map(|joints| joints.map(|reach| reach.value));
    diagonals(least.each_ref().map(|joints| &joints[..]), &mut |diagonal| {
        each(&row(at, kind, most, &reaches, diagonal));
    });
}

/// Returns the row of a diagonal.
fn row(at: &At<'_>, kind: RowKind, most: f64, reaches: &[[Reach; JOINTS]; 4], diagonal: &Diagonal) -> Row {
    let mut row = Row::still(kind, most - at.margin() - diagonal.length, [0.0; SHAPE]);
    for (i, (joint, factor)) in diagonal.joints.into_iter().zip(diagonal.factors).enumerate() {
        let side = &reaches[i][joint];
        for (sum, by) in row.shape.iter_mut().zip(&side.shape) {
            *sum += factor * by;
        }
        row.turns[i] = Turn { by: factor * side.turn.by, ..side.turn };
    }
    row
}

/// Returns the least coordinate of every joint in every direction; `None` if the loop closes nowhere.
fn reaches(at: &At<'_>) -> Option<[[Reach; JOINTS]; 4]> {
    const _: () = assert!(Side::ALL.len() == MOST_TURNS);
    let swept = Swept::of(at.shape, at.motion)?;
    let nowhere = Reach { value: 0.0, shape: [0.0; SHAPE], turn: Turn::NONE };
    let mut found = [[nowhere; JOINTS]; 4];
    for (reaches, side) in found.iter_mut().zip(Side::ALL) {
        for (joint, reach) in reaches.iter_mut().enumerate().take(3) {
            let extreme = swept.extreme(joint, side)?;
            let (shape, by) = extreme.derivative(at.shape, joint, side);
            let turn = Turn { by, place: extreme.place };
            *reach = Reach { value: side.inwards(extreme.joints[joint]), shape, turn };
        }
        for (first, pivot) in [at.shape.crank_pivot, at.shape.follower_pivot].into_iter().enumerate() {
            let mut shape = [0.0; SHAPE];
            shape[2 * first + side.axis()] = side.sign();
            reaches[3 + first] = Reach { value: side.inwards(pivot), shape, turn: Turn::NONE };
        }
    }
    Some(found)
}
