//! Rows of the extent: the limit less the diagonal of the box of A, B, C, D and P over the motion.
//!
//! With least coordinates u of all joints in the directions +x, +y, -x, -y the box is w = -(u_1 + u_3) wide and
//! h = -(u_2 + u_4) high, and
//!
//! ```text
//! g = L - sqrt(w^2 + h^2),   dg = (w (du_1 + du_3) + h (du_2 + du_4)) / sqrt(w^2 + h^2),
//! ```
//!
//! with du the derivative of the extreme joint at its extreme position (Danskin 1967). Each side is the extreme of five
//! joints. One row has the extreme joint on every side; for each side and each of the other four joints there is one with
//! that joint in its place: never tighter, and as tight where two joints lie on that side.

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
    let extreme = reaches.map(|joints| {
        let reach = |joint: &usize| joints[*joint].value;
        (0..JOINTS).min_by(|i, j| reach(i).total_cmp(&reach(j))).unwrap_or(0)
    });
    let sides =
        [reaches[0][extreme[0]], reaches[1][extreme[1]], reaches[2][extreme[2]], reaches[3][extreme[3]]];
    each(&diagonal(at, kind, most, &sides));
    for (side, (joints, extreme)) in reaches.iter().zip(extreme).enumerate() {
        for (_, reach) in joints.iter().enumerate().filter(|(joint, _)| *joint != extreme) {
            let mut others = sides;
            others[side] = *reach;
            each(&diagonal(at, kind, most, &others));
        }
    }
}

/// Returns the row with these sides of the box.
fn diagonal(at: &At<'_>, kind: RowKind, most: f64, sides: &[Reach; 4]) -> Row {
    let (width, height) = (-(sides[0].value + sides[2].value), -(sides[1].value + sides[3].value));
    let long = width.hypot(height);
    let mut row = Row::still(kind, most - at.margin() - long, [0.0; SHAPE]);
    for (i, side) in sides.iter().enumerate() {
        let factor = if i % 2 == 0 { width } else { height } / long.max(f64::MIN_POSITIVE);
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
