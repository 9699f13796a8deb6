//! The signed distance between two convex polygons, points and lines among them.
//!
//! It is the signed distance from the origin to the boundary of the Minkowski difference {p - q}, whose sides are
//! parallel to those of the two polygons: if the origin lies inside, the nearest side decides; outside, the nearest
//! pair of sides.

use crate::mechanism::{Complex, cross, dot, nearest_share, turned};

/// Computes the distance between two convex polygons (corners counter-clockwise, one or two for a point or a line), or
/// minus the least shift that separates them if they overlap.
pub(super) fn separation(p: &[Complex], q: &[Complex]) -> f64 {
    // The largest gap along a normal of a side: below zero the overlap, exact; above zero a lower bound only.
    // Any other direction bounds it too, so a few more do no harm.
    let mut gap = f64::NEG_INFINITY;
    for (own, other) in [(p, q), (q, p)] {
        for normal in normals(own) {
            let reach = own.iter().map(|z| dot(*z, normal)).fold(f64::NEG_INFINITY, f64::max);
            let nearest = other.iter().map(|z| dot(*z, normal)).fold(f64::INFINITY, f64::min);
            gap = gap.max(nearest - reach);
        }
    }
    if gap > f64::NEG_INFINITY && gap <= 0.0 {
        return gap;
    }
    let mut least = f64::INFINITY;
    for (from, to) in sides(p) {
        for (start, end) in sides(q) {
            least = least.min(between_segments(from, to, start, end));
        }
    }
    least
}

/// Returns the outward normals of the sides; of a line both, and both directions along it, which separate it from a
/// polygon ahead of its ends.
fn normals(corners: &[Complex]) -> Vec<Complex> {
    let n = corners.len();
    let mut normals = Vec::with_capacity(4);
    for i in (0..n).filter(|_| n > 1) {
        let along = corners[(i + 1) % n] - corners[i];
        let along = along / along.norm();
        normals.push(-turned(along));
        if n == 2 {
            normals.push(along);
        }
    }
    normals
}

/// Iterates over the sides; a point is one side without length.
fn sides(corners: &[Complex]) -> impl Iterator<Item = (Complex, Complex)> + '_ {
    let n = corners.len();
    let last = if n == 2 { 1 } else { n };
    (0..last).map(move |i| (corners[i], corners[(i + 1) % n]))
}

/// Computes the distance between two segments.
fn between_segments(a: Complex, b: Complex, c: Complex, d: Complex) -> f64 {
    let side = |from: Complex, to: Complex, z: Complex| cross(to - from, z - from);
    if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
        return 0.0;
    }
    let ends = [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])];
    let distance = |(z, [from, to]): (Complex, [Complex; 2])| {
        (from + (to - from) * nearest_share(z, [from, to]) - z).norm()
    };
    ends.into_iter().map(distance).fold(f64::INFINITY, f64::min)
}
