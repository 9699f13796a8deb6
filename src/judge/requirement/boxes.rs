//! The regions that hold the pivots and the whole motion.

use super::{Finding, Judged, at_least, at_most};
use crate::mechanism::Complex;
use crate::record::Figure;
use crate::task::region::Region;
use std::f64::consts::TAU;

fn inside(held: [f64; 4], limit: [f64; 4]) -> Finding {
    let met = (0..2).all(|i| at_least(held[i], limit[i]) && at_most(held[i + 2], limit[i + 2]));
    Finding { value: Figure::Numbers(held.to_vec()), limit: Figure::Numbers(limit.to_vec()), met }
}

pub(super) fn pivots(judged: &Judged<'_>) -> Option<Finding> {
    let linkage = &judged.candidate.linkage;
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let limit = match judged.require().pivots_in.as_ref()? {
        Region::Box(corners) => *corners,
        Region::Polygon(polygon) => {
            // The distance from the boundary of the pivot that is nearer to it or farther outside.
            let depth = |pivot: Complex| depth(polygon, pivot);
            return Some(Finding::least(depth(a).min(depth(b)), 0.0));
        }
    };
    Some(inside([a.re.min(b.re), a.im.min(b.im), a.re.max(b.re), a.im.max(b.im)], limit))
}

/// Returns the distance of a place from the boundary of a polygon, positive inside, by the winding of its corners around
/// the place.
fn depth(polygon: &[[f64; 2]], place: Complex) -> f64 {
    let corner = |k: usize| Complex::new(polygon[k][0], polygon[k][1]) - place;
    let (mut turned, mut nearest) = (0.0, f64::INFINITY);
    for k in 0..polygon.len() {
        let (p, q) = (corner(k), corner((k + 1) % polygon.len()));
        turned += (q * p.conj()).arg();
        let side = q - p;
        let length = side.norm();
        let ahead = if length > 0.0 { -(p * side.conj()).re / length } else { 0.0 };
        let distance = if ahead <= 0.0 {
            p.norm()
        } else if ahead >= length {
            q.norm()
        } else {
            ((p * side.conj()).im / length).abs()
        };
        nearest = nearest.min(distance);
    }
    if (turned / TAU).round() as i64 % 2 == 0 { -nearest } else { nearest }
}

pub(super) fn footprint(judged: &Judged<'_>) -> Option<Finding> {
    let limit = judged.require().footprint_in?;
    Some(inside(judged.verdict.motion.footprint(), limit))
}
