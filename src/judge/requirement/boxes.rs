//! The boxes that hold the pivots and the whole motion.

use super::{Finding, Judged, at_least, at_most};
use crate::record::Figure;

fn inside(held: [f64; 4], limit: [f64; 4]) -> Finding {
    let met = (0..2).all(|i| at_least(held[i], limit[i]) && at_most(held[i + 2], limit[i + 2]));
    Finding { value: Figure::Numbers(held.to_vec()), limit: Figure::Numbers(limit.to_vec()), met }
}

pub(super) fn pivots(judged: &Judged<'_>) -> Option<Finding> {
    let limit = judged.require().pivots_in?;
    let linkage = &judged.candidate.linkage;
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    Some(inside([a.re.min(b.re), a.im.min(b.im), a.re.max(b.re), a.im.max(b.im)], limit))
}

pub(super) fn footprint(judged: &Judged<'_>) -> Option<Finding> {
    let limit = judged.require().footprint_in?;
    Some(inside(judged.verdict.motion.footprint(), limit))
}
