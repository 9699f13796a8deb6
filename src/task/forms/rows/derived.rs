//! Rows of the bounds of quantities that are no coordinates of the design space.

use super::{At, Row, RowKind};
use crate::mechanism::four_bar::gradient::ground_gradient;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::task::forms::design_space::{Derived, DerivedBound, SHAPE};

pub(super) fn rows(at: &At<'_>, bounds: &[DerivedBound], each: &mut dyn FnMut(&Row)) {
    let (size, shape, links) = (at.size, at.shape, at.links);
    for bound in bounds {
        let (low, high) = (bound.limits.0, bound.limits.1);
        let kind = |lower| RowKind::Derived(bound.quantity, lower);
        let (value, row) = match bound.quantity {
            Derived::Ground => (links[0], at.ground_row),
            Derived::CrankSide => at.crank_side(),
            Derived::FollowerSide => at.follower_side(),
            Derived::GroundAngle => {
                let ground = shape.follower_pivot - shape.crank_pivot;
                let middle = 0.5 * (low + high);
                let value = wrapped(ground.arg() - middle) * size;
                let mut row = [0.0; SHAPE];
                row[..4].copy_from_slice(
                    &ground_gradient(shape.crank_pivot, shape.follower_pivot).map(|by| by * size),
                );
                let half = 0.5 * (high - low) * size;
                for sign in [1.0, -1.0] {
                    let row = row.map(|by| -sign * by);
                    each(&Row::still(kind(sign < 0.0), half - sign * value, row));
                }
                continue;
            }
        };
        let margin = if low == high { 0.0 } else { at.margin() };
        each(&Row::still(kind(true), value - low - margin, row));
        each(&Row::still(kind(false), high - value - margin, row.map(|by| -by)));
    }
}
