//! Rows of the lines and points on which the fixed pivots are to lie: as far as a margin to either side.

use super::{At, Row, RowKind};
use crate::mechanism::dot;
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let Some(pivot_on) = &at.require.pivot_on else { return };
    let pivots = [(0, at.shape.crank_pivot), (2, at.shape.follower_pivot)];
    for ((first, pivot), locus) in pivots.into_iter().zip(pivot_on.both()) {
        let Some(locus) = locus else { continue };
        for normal in locus.normals() {
            for way in [normal, -normal] {
                let mut shape = [0.0; SHAPE];
                (shape[first], shape[first + 1]) = (-way.re, -way.im);
                let kind = RowKind::of(RequirementKind::PivotOn, None);
                each(&Row::still(kind, at.margin() - dot(way, pivot - locus.first()), shape));
            }
        }
    }
}
