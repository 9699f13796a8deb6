//! Rows of the region of the pivots.

use super::{At, Row, RowKind, boxes};
use crate::task::forms::design_space::SHAPE;
use crate::task::region::{Region, inside};
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    match &at.require.pivots_in {
        None => {}
        Some(Region::Box(corners)) => boxes::pivots(at, *corners, RequirementKind::PivotsIn, each),
        Some(Region::Polygon(polygon)) => {
            for (first, pivot) in [(0, at.shape.crank_pivot), (2, at.shape.follower_pivot)] {
                let (depth, grows) = inside(polygon, pivot);
                let mut shape = [0.0; SHAPE];
                (shape[first], shape[first + 1]) = (grows.re, grows.im);
                let kind = RowKind::of(RequirementKind::PivotsIn, None);
                each(&Row::still(kind, depth - at.margin(), shape));
            }
        }
    }
}
