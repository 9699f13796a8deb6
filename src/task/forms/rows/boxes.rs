//! Rows of a point that does not move in a box.

use super::{At, Row, RowKind, Side};
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;

/// Adds the rows of both fixed pivots: the distance of each to each side.
pub(super) fn pivots(at: &At<'_>, corners: [f64; 4], of: RequirementKind, each: &mut dyn FnMut(&Row)) {
    for (first, pivot) in [(0, at.shape.crank_pivot), (2, at.shape.follower_pivot)] {
        for (axis, coordinate) in [pivot.re, pivot.im].into_iter().enumerate() {
            for (limit, sign) in [(corners[axis], 1.0), (corners[axis + 2], -1.0)] {
                let mut shape = [0.0; SHAPE];
                shape[first + axis] = sign;
                let kind = RowKind::of(of, Some(Side::of(axis, sign > 0.0)));
                each(&Row::still(kind, sign * (coordinate - limit) - at.margin(), shape));
            }
        }
    }
}
