//! Rows of a point that does not move in a box.

use super::{At, Row, RowKind, Side};
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;

/// Adds the rows of both fixed pivots: the distance of each to each side.
pub(super) fn pivots(at: &At<'_>, corners: [f64; 4], of: RequirementKind, each: &mut dyn FnMut(&Row)) {
    for (first, pivot) in [(0, at.shape.crank_pivot), (2, at.shape.follower_pivot)] {
        for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax] {
            let mut shape = [0.0; SHAPE];
            shape[first + side.axis()] = side.sign();
            let value = side.inwards(pivot) - side.sign() * corners[side.index()] - at.margin();
            each(&Row::still(RowKind::of(of, Some(side)), value, shape));
        }
    }
}
