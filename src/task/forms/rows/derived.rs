//! Rows of the bounds of quantities that are no coordinates of the design space.

use super::{At, Row, RowKind};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::turned;
use crate::task::forms::design_space::{Derived, DerivedBound, SHAPE, unit};

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
                let mut row = [0.0; SHAPE];
                let ground = shape.follower_pivot - shape.crank_pivot;
                let across = turned(unit(ground));
                let middle = 0.5 * (low + high);
                let value = wrapped(ground.arg() - middle) * size;
                let scale = size / links[0].max(f64::MIN_POSITIVE);
                (row[0], row[1]) = (-across.re * scale, -across.im * scale);
                (row[2], row[3]) = (across.re * scale, across.im * scale);
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
