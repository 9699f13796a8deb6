//! Area, centroid and second moment of a plate, as integrals along its outline (Green's theorem).
//!
//! ```text
//! A = 1/2 integral x dy - y dx      A c = 1/3 integral z (x dy - y dx)      J = 1/4 integral |z|^2 (x dy - y dx)
//! ```
//!
//! with z = x + i y and J about the origin of z: the form x dy - y dx of a sector (from the origin to a piece of the outline) is
//! twice its area, z/3 and |z|^2/4 are the means over the sector's radii. Segments and arcs have closed forms: with z = m + r e^{i t}
//! on an arc, x dy - y dx = r (r + <m, e>) dt.

use super::outline::outline;
use super::{COINCIDENT, Edge, hull};
use crate::mechanism::{Complex, cross, dot};

/// Area, centroid and second moment of a flat shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The area A, length^2.
    pub area: f64,
    /// The centroid c.
    pub centroid: Complex,
    /// The polar second moment of area about the centroid, length^4.
    pub polar: f64,
}

impl Moments {
    /// Computes the moments of the shape within a closed outline, counter-clockwise; all 0 of an empty one.
    pub fn of(outline: &[Edge]) -> Self {
        let Some(first) = outline.first() else {
            return Moments { area: 0.0, centroid: Complex::new(0.0, 0.0), polar: 0.0 };
        };
        // Near the shape no digits are lost to its distance from the origin.
        let origin = first.from();
        let (mut area, mut first_moment, mut polar) = (0.0, Complex::new(0.0, 0.0), 0.0);
        for edge in outline {
            let (a, s, j) = match *edge {
                Edge::Line { from, to } => segment(from - origin, to - origin),
                Edge::Arc { from, centre, turn, .. } => arc(from - centre, centre - origin, turn),
            };
            area += a;
            first_moment += s;
            polar += j;
        }
        if area <= 0.0 {
            return Moments { area: 0.0, centroid: origin, polar: 0.0 };
        }
        let arm = first_moment / area;
        Moments { area, centroid: origin + arm, polar: (polar - area * arm.norm_sqr()).max(0.0) }
    }

    /// Computes the moments of every point within `radius` of the convex hull of points.
    ///
    /// ```
    /// use linkwright::Complex;
    /// use linkwright::internals::mechanism::plates::moments::Moments;
    /// use std::f64::consts::PI;
    /// let disk = Moments::around(&[Complex::new(3.0, 1.0)], 2.0);
    /// assert!((disk.area - 4.0 * PI).abs() < 1e-13 && (disk.polar - 8.0 * PI).abs() < 1e-12);
    /// ```
    pub fn around(points: &[Complex], radius: f64) -> Self {
        if points.is_empty() {
            return Moments::of(&[]);
        }
        let corners = hull::hull(points, COINCIDENT * (hull::extent(points) + radius));
        Moments::of(&outline(&corners, radius))
    }
}

/// Computes A, A c and J of the triangle from the origin to a segment.
fn segment(p: Complex, q: Complex) -> (f64, Complex, f64) {
    let double = cross(p, q);
    (double / 2.0, (p + q) * (double / 6.0), double * (dot(p, p) + dot(p, q) + dot(q, q)) / 12.0)
}

/// Computes A, A c and J of the sector from the origin to an arc from `arm` off its centre m by an angle.
fn arc(arm: Complex, m: Complex, turn: f64) -> (f64, Complex, f64) {
    let (r, end) = (arm.norm(), arm * Complex::from_polar(1.0, turn));
    if r == 0.0 {
        return (0.0, Complex::new(0.0, 0.0), 0.0);
    }
    let (e0, e1) = (arm / r, end / r);
    let i = Complex::new(0.0, 1.0);
    // The integrals of e and of e^2 over the angle.
    let (e, e_sq) = ((e1 - e0) / i, (e1 * e1 - e0 * e0) / (2.0 * i));
    let along = dot(m, e);
    // <m, e>^2 = (|m|^2 + Re(conj(m)^2 e^2))/2 and e <m, e> = (m + conj(m) e^2)/2.
    let along_sq = 0.5 * (m.norm_sqr() * turn + (m.conj() * m.conj() * e_sq).re);
    let e_along = 0.5 * (m * turn + m.conj() * e_sq);
    let area = 0.5 * r * (r * turn + along);
    let first = (m * (r * turn + along) + e * (r * r) + e_along * r) * (r / 3.0);
    // |z|^2 = |m|^2 + r^2 + 2 r <m, e>.
    let base = m.norm_sqr() + r * r;
    let polar = 0.25 * r * (base * (r * turn + along) + 2.0 * r * (r * along + along_sq));
    (area, first, polar)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn near(value: f64, expected: f64) {
        assert!((value - expected).abs() <= 1e-12 * expected.abs(), "{value} instead of {expected}");
    }

    #[test]
    fn a_stadium_has_the_moments_of_its_rectangle_and_half_disks() {
        // Rectangle l x 2r, and two half disks with centroids 4r/(3 pi) beyond its ends.
        let (l, r) = (7.0, 1.5);
        let ends = [Complex::new(100.0, -40.0), Complex::new(100.0, -40.0 + l)];
        let found = Moments::around(&ends, r);
        near(found.area, 2.0 * l * r + PI * r * r);
        near(found.centroid.re, 100.0);
        near(found.centroid.im, -40.0 + 0.5 * l);
        let (half, beyond) = (0.5 * PI * r * r, 4.0 * r / (3.0 * PI));
        let of_half = 0.25 * PI * r.powi(4) - half * beyond * beyond + half * (0.5 * l + beyond).powi(2);
        near(found.polar, 2.0 * l * r * (l * l + 4.0 * r * r) / 12.0 + 2.0 * of_half);
    }

    #[test]
    fn a_triangle_without_radius_has_its_polygons_moments() {
        // About its centroid J = A (sum of squared sides)/36.
        let corners = [Complex::new(1.0, 2.0), Complex::new(5.0, 3.0), Complex::new(2.0, 7.0)];
        let found = Moments::around(&corners, 0.0);
        let side = |i: usize| (corners[(i + 1) % 3] - corners[i]).norm_sqr();
        let area = 0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]);
        near(found.area, area);
        near(found.polar, area * (side(0) + side(1) + side(2)) / 36.0);
        near(found.centroid.re, 8.0 / 3.0);
    }

    #[test]
    fn a_rounded_triangle_agrees_with_a_sum_over_thin_strips() {
        let corners = [Complex::new(0.0, 0.0), Complex::new(4.0, 0.5), Complex::new(1.0, 3.0)];
        let (r, strips) = (0.7, 1500_i32);
        let found = Moments::around(&corners, r);
        let plate = super::super::separation::separation;
        let (mut area, mut moment) = (0.0, 0.0);
        let step = 6.0 / f64::from(strips);
        for i in 0..strips {
            for j in 0..strips {
                let at = Complex::new(-1.0 + (f64::from(i) + 0.5) * step, -1.0 + (f64::from(j) + 0.5) * step);
                if plate(&corners, &[at]) <= r {
                    area += step * step;
                    moment += step * step * (at - found.centroid).norm_sqr();
                }
            }
        }
        assert!((area / found.area - 1.0).abs() < 1e-3 && (moment / found.polar - 1.0).abs() < 1e-3);
    }
}
