//! Rows of the box of the pivots.

use super::{At, Row, boxes};
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    if let Some(corners) = at.require.pivots_in {
        boxes::pivots(at, corners, RequirementKind::PivotsIn, each);
    }
}
