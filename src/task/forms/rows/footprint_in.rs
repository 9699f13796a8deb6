//! Rows of the box of the whole linkage: the distance to each side of each joint at its extreme position.

use super::swept::Swept;
use super::{At, Row, RowKind, Side, Turn, boxes};
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let Some(b) = at.require.footprint_in else { return };
    boxes::pivots(at, b, RequirementKind::FootprintIn, each);
    let positions = Swept::of(at.shape, at.motion);
    for joint in 0..3 {
        for (axis, limit, sign) in [(0, b[0], 1.0), (1, b[1], 1.0), (0, b[2], -1.0), (1, b[3], -1.0)] {
            let kind = RowKind::of(RequirementKind::FootprintIn, Some(Side::of(axis, sign > 0.0)));
            let row = positions.as_ref().and_then(|swept| {
                let extreme = swept.extreme(joint, axis, sign)?;
                let (shape, by_crank) = extreme.derivative(at.shape, joint, axis, sign);
                let coordinate = if axis == 0 { extreme.joints[joint].re } else { extreme.joints[joint].im };
                let value = sign * (coordinate - limit) - at.margin();
                Some(Row { kind, value, shape, turns: Turn::at(extreme.place, by_crank) })
            });
            // A linkage without any position has no footprint: its violation is the target's size.
            each(&row.unwrap_or(Row::still(kind, -at.size, [0.0; SHAPE])));
        }
    }
}
