//! The regions that hold the pivots and the whole motion.

use super::{Finding, Judged, at_least, at_most};
use crate::mechanism::{Complex, bounding_box};
use crate::record::Figure;
use crate::task::region::Region;
use std::f64::consts::TAU;

fn inside(held: [f64; 4], limit: [f64; 4]) -> Finding {
    let met = (0..2).all(|i| at_least(held[i], limit[i]) && at_most(held[i + 2], limit[i + 2]));
    Finding { value: Figure::Numbers(held.to_vec()), limit: Figure::Numbers(limit.to_vec()), met }
}

pub(super) fn pivots(judged: &Judged<'_>) -> Option<Finding> {
    let linkage = &judged.candidate.linkage;
    let region = judged.require().pivots_in.as_ref()?;
    Some(all_inside(region, &linkage.pivots().collect::<Vec<Complex>>()))
}

/// The moving pins, in the frame of the body whose origin is P.
pub(super) fn pins(judged: &Judged<'_>) -> Option<Finding> {
    let region = judged.require().pins_in.as_ref()?;
    let linkage = &judged.candidate.linkage;
    // The body's x axis as seen from the coupler, whose own runs from C to D.
    let axis = Complex::from_polar(1.0, judged.candidate.frame_deg?.to_radians());
    let from_origin = |along: f64| (Complex::new(along, 0.0) - linkage.coupler_offset()) / axis;
    // A coupler that slides through its block has one pin, C.
    let second = linkage.coupler().unwrap_or(0.0);
    Some(all_inside(region, &[from_origin(0.0), from_origin(second)]))
}

/// Returns whether a region holds all places: their box or, of a polygon, the distance from its boundary of the place that is
/// nearest to it or farthest outside.
fn all_inside(region: &Region, places: &[Complex]) -> Finding {
    match region {
        Region::Box(corners) => {
            let [low, high] = bounding_box(places.iter().copied());
            inside([low.re, low.im, high.re, high.im], *corners)
        }
        Region::Polygon(polygon) => {
            let depths = places.iter().map(|place| depth(polygon, *place));
            Finding::least(depths.fold(f64::INFINITY, f64::min), 0.0)
        }
    }
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
