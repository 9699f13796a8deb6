//! Regions of the plane: a box along the axes, or a polygon.

use crate::mechanism::{Complex, dot, point};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The most corners of a polygon.
pub const MOST_CORNERS: usize = 200;

/// A region of the plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Region {
    /// A box [xmin, ymin, xmax, ymax].
    Box([f64; 4]),
    /// A polygon by its corners, in either sense; the last is joined to the first.
    Polygon(Vec<[f64; 2]>),
}

impl Region {
    /// Returns the box, if it is one.
    pub fn as_box(&self) -> Option<[f64; 4]> {
        match self {
            Region::Box(corners) => Some(*corners),
            Region::Polygon(_) => None,
        }
    }

    /// Returns the least box along the axes that holds it.
    pub fn corners(&self) -> [f64; 4] {
        match self {
            Region::Box(corners) => *corners,
            Region::Polygon(points) => {
                let (low, high) = super::corners(points);
                [low[0], low[1], high[0], high[1]]
            }
        }
    }

    /// Returns its points: the lower left and the upper right corner of a box, all corners of a polygon.
    pub fn points_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        match self {
            Region::Box(corners) => corners.as_mut_slice().iter_mut(),
            Region::Polygon(points) => points.as_flattened_mut().iter_mut(),
        }
    }

    /// Returns the same numbers in a list.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Region::Box(corners) => corners.to_vec(),
            Region::Polygon(points) => points.as_flattened().to_vec(),
        }
    }
}

/// Returns the distance of a place from the boundary of a polygon, positive inside, and the direction in which it grows.
///
/// Inside is where a ray crosses the boundary an odd number of times. On the boundary the direction is the inward normal of
/// the nearest side.
pub fn inside(polygon: &[[f64; 2]], place: Complex) -> (f64, Complex) {
    let mut least = (f64::INFINITY, Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    let (mut odd, mut twice_area) = (false, 0.0);
    for (k, from) in polygon.iter().enumerate() {
        let (p, q) = (point(*from), point(polygon[(k + 1) % polygon.len()]));
        let side = q - p;
        twice_area += p.re * q.im - p.im * q.re;
        if (p.im > place.im) != (q.im > place.im) {
            let at = p.re + (place.im - p.im) / (q.im - p.im) * side.re;
            odd ^= place.re < at;
        }
        let length_sq = side.norm_sqr();
        if length_sq > 0.0 {
            let along = (dot(side, place - p) / length_sq).clamp(0.0, 1.0);
            let off = place - (p + side * along);
            if off.norm() < least.0 {
                least = (off.norm(), off, Complex::new(-side.im, side.re) / length_sq.sqrt());
            }
        }
    }
    let (distance, off, left) = least;
    let sign = if odd { 1.0 } else { -1.0 };
    // A polygon in the positive sense has its inside to the left of its sides.
    let inward = left * twice_area.signum();
    let size = polygon.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let grows = if distance > 1e-12 * size { off * (sign / distance) } else { inward };
    (sign * distance, grows)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTCHED: [[f64; 2]; 5] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];

    #[test]
    fn the_distance_from_the_boundary_is_positive_inside_and_its_direction_its_gradient() {
        let reversed: Vec<[f64; 2]> = NOTCHED.iter().rev().copied().collect();
        for polygon in [NOTCHED.to_vec(), reversed] {
            for (place, expected) in
                [([1.0, 0.25], 0.25), ([2.2, 3.0], -0.942_990_334), ([-1.0, 2.0], -1.0), ([3.9, 1.0], 0.1)]
            {
                let place = point(place);
                let (value, grows) = inside(&polygon, place);
                assert!((value - expected).abs() < 1e-8, "{place}: {value}");
                let step = 1e-6;
                let by = |direction: Complex| {
                    (inside(&polygon, place + direction * step).0
                        - inside(&polygon, place - direction * step).0)
                        / (2.0 * step)
                };
                assert!((by(Complex::new(1.0, 0.0)) - grows.re).abs() < 1e-6, "{place}");
                assert!((by(Complex::new(0.0, 1.0)) - grows.im).abs() < 1e-6, "{place}");
            }
            let (value, grows) = inside(&polygon, Complex::new(1.0, 0.0));
            assert!(value.abs() < 1e-12 && (grows - Complex::new(0.0, 1.0)).norm() < 1e-12);
        }
    }
}
