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
        for (side, limit) in Side::ALL.into_iter().zip(b) {
            let kind = RowKind::of(RequirementKind::FootprintIn, Some(side));
            let row = positions.as_ref().and_then(|swept| {
                let extreme = swept.extreme(joint, side)?;
                let (shape, by_crank) = extreme.derivative(at.shape, joint, side);
                let value = side.inwards(extreme.joints[joint]) - side.sign() * limit - at.margin();
                Some(Row { turns: Turn::at(extreme.place, by_crank), ..Row::still(kind, value, shape) })
            });
            // A linkage without any position has no footprint: its violation is the target's size.
            each(&row.unwrap_or(Row::still(kind, -at.size, [0.0; SHAPE])));
        }
    }
}
