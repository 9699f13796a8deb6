//! The convex hull of a few points: A. M. Andrew's monotone chain (1979).

use crate::mechanism::{Complex, cross};

/// Computes the corners of the hull, counter-clockwise from the leftmost; points nearer than `near` to another corner
/// or to a side are left out. One corner if all points are in one place, two if all are in line.
pub(crate) fn hull(points: &[Complex], near: f64) -> Vec<Complex> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|p, q| p.re.total_cmp(&q.re).then(p.im.total_cmp(&q.im)));
    let mut distinct: Vec<Complex> = Vec::with_capacity(sorted.len());
    for p in sorted {
        if distinct.iter().all(|q| (p - q).norm() > near) {
            distinct.push(p);
        }
    }
    if distinct.len() < 3 {
        return distinct;
    }
    let mut corners = half(distinct.iter().copied(), near);
    let upper = half(distinct.iter().rev().copied(), near);
    corners.pop();
    corners.extend(&upper[..upper.len() - 1]);
    corners
}

/// Computes the chain from the first to the last point that turns left by more than `near` at each corner.
fn half(points: impl Iterator<Item = Complex>, near: f64) -> Vec<Complex> {
    let mut chain: Vec<Complex> = Vec::new();
    for p in points {
        while let [.., before, last] = chain[..] {
            let base = p - before;
            // `last` is kept if it lies more than `near` to the right of the line from `before` to p.
            if cross(last - before, base) > near * base.norm() {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

/// Computes the largest distance between two of the points.
pub(super) fn extent(points: &[Complex]) -> f64 {
    let pairs = points.iter().enumerate().flat_map(|(i, p)| points[..i].iter().map(move |q| (p - q).norm()));
    pairs.fold(0.0, f64::max)
}

/// Computes the area of a polygon given counter-clockwise.
pub(super) fn area(corners: &[Complex]) -> f64 {
    let n = corners.len();
    let origin = corners[0];
    0.5 * (0..n).map(|i| cross(corners[i] - origin, corners[(i + 1) % n] - origin)).sum::<f64>()
}

/// Computes the perimeter of a polygon: of a line twice its length.
pub(super) fn perimeter(corners: &[Complex]) -> f64 {
    let n = corners.len();
    (0..n).map(|i| (corners[(i + 1) % n] - corners[i]).norm()).sum()
}
