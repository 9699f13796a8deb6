//! Rows of the link ratio: l_i - l_j / R for all pairs.

use super::{At, LENGTH_MARGIN, Row, RowKind};
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let ratio = at.require.link_ratio_max;
    for i in 0..4 {
        for j in (0..4).filter(|&j| j != i) {
            let mut factors = [0.0; 4];
            factors[i] = 1.0;
            factors[j] = -1.0 / (ratio * (1.0 - LENGTH_MARGIN));
            let by_room = at.links[j] / (ratio * ratio);
            let kind = RowKind::Limit { of: RequirementKind::LinkRatio, side: None, by_room };
            each(&at.combined(kind, factors, 0.0));
        }
    }
}
