//! Rows of the longest link: the limit less each of ground, a, b, c, d and e.

use super::{At, Row, RowKind};
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let Some(most) = at.require.longest_max.map(|most| most - at.margin()) else { return };
    let kind = RowKind::of(RequirementKind::LongestMax, None);
    for link in 0..4 {
        let mut factors = [0.0; 4];
        factors[link] = -1.0;
        each(&at.combined(kind, factors, most));
    }
    for (value, by) in [at.crank_side(), at.follower_side()] {
        each(&Row::still(kind, most - value, by.map(|by| -by)));
    }
}
