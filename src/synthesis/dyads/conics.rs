//! The common points of two conics of the projective plane.
//!
//! A conic is a symmetric matrix M, its points the directions x with x' M x = 0. With x = (s, t, 1) the two conics are
//! quadratics in s whose coefficients are polynomials in t:
//!
//! ```text
//! f = a1 s^2 + b1(t) s + c1(t)          u = a1 c2 - a2 c1,  v = a1 b2 - a2 b1,  w = b1 c2 - b2 c1
//! g = a2 s^2 + b2(t) s + c2(t)          u^2 - v w = 0  (a quartic in t),   s = -u/v
//! ```
//!
//! The chart (s, t, 1) has a line at infinity, and v may vanish at a root; so the points are looked for in several
//! charts, each turned against the others.

use super::quartic;
use crate::mechanism::Complex;
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Steps of Newton's iteration on the two conics. Two suffice at simple points; near double ones it converges linearly.
const STEPS: usize = 20;

/// Greatest value of a conic of norm one at a point of norm one that counts as common.
const COMMON: f64 = 1e-12;

/// Greatest imaginary part of a real root, relative to the root: that of a double one.
const REAL: f64 = 1e-6;

/// Greatest norm that counts as zero for a quartic, a conic or its part, beside others of norm one.
const ZERO: f64 = 1e-11;

/// Two conics of norm one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conics {
    matrices: [Matrix3<f64>; 2],
}

impl Conics {
    /// Creates the pair; `None` if either is zero beside the other, or not finite.
    pub fn new(matrices: [Matrix3<f64>; 2]) -> Option<Self> {
        let norms = matrices.map(|m| m.norm());
        let largest = norms[0].max(norms[1]);
        let apart = largest.is_finite() && norms.iter().all(|&norm| norm > ZERO * largest);
        apart.then(|| Conics { matrices: [matrices[0] / norms[0], matrices[1] / norms[1]] })
    }

    /// Returns a unit vector for each root in a chart: the real part of its point; one for a pair of conjugate roots. None
    /// if the conics have a part in common.
    pub fn in_chart(&self, chart: usize) -> Vec<Vector3<f64>> {
        let turn = chart_axes(chart);
        let [one, other] = self.matrices.map(|m| Quadratic::of(&(turn.transpose() * m * turn)));
        let u = sum(scaled(other.c, one.a), scaled(one.c, -other.a));
        let v = sum(scaled(other.b, one.a), scaled(one.b, -other.a));
        let w = sum(product(one.b, other.c), scaled(product(other.b, one.c), -1.0));
        let resultant = sum(product(u, u), scaled(product(v, w), -1.0));
        if resultant.iter().all(|c| c.abs() < ZERO) {
            return Vec::new();
        }
        // A real root may have an imaginary part of rounding, of either sign.
        let upper = quartic::roots(resultant).into_iter().filter(|t| t.im >= -REAL * (1.0 + t.norm()));
        let point = |t: Complex| {
            let s = -value(u, t) / value(v, t);
            (turn * Vector3::new(s.re, t.re, 1.0))
                .try_normalize(0.0)
                .filter(|x| x.iter().all(|x| x.is_finite()))
        };
        upper.filter_map(point).collect()
    }

    /// Returns the number of charts.
    pub fn charts() -> usize {
        CHARTS.len()
    }

    /// Returns the common point that Newton's iteration reaches from a unit vector, as a unit vector; `None` if it reaches
    /// none.
    pub fn common_point(&self, from: Vector3<f64>) -> Option<Vector3<f64>> {
        let miss = |x: &Vector3<f64>| self.matrices.map(|m| x.dot(&(m * x)));
        let size = |[f, g]: [f64; 2]| f.abs().max(g.abs());
        let (mut best, mut value) = (from, miss(&from));
        for _ in 0..STEPS {
            let [f, g] = self.matrices.map(|m| m * best * 2.0);
            let slopes = Matrix3::from_rows(&[f.transpose(), g.transpose(), best.transpose()]);
            let Some(step) = slopes.lu().solve(&Vector3::new(-value[0], -value[1], 0.0)) else { break };
            let Some(next) = (best + step).try_normalize(0.0) else { break };
            let there = miss(&next);
            if size(there) >= size(value) || size(there).is_nan() {
                break;
            }
            (best, value) = (next, there);
        }
        (size(value) < COMMON).then_some(best)
    }

    /// Returns the common point beside the line l x = 0, if that line is part of both conics.
    ///
    /// Then M = (l k' + k l')/2 and the point is the one where the two other lines k meet.
    pub fn beside_line(&self, line: Vector3<f64>) -> Option<Vector3<f64>> {
        let l = line.try_normalize(0.0)?;
        let others = self.matrices.map(|m| {
            let k = m * l * 2.0 - l * l.dot(&(m * l));
            let product = (l * k.transpose() + k * l.transpose()) * 0.5;
            ((m - product).norm() < ZERO).then_some(k)
        });
        let (one, other) = (others[0]?, others[1]?);
        one.cross(&other).try_normalize(ZERO)
    }
}

/// Angles of the charts about the axes z, y and x.
const CHARTS: [[f64; 3]; 3] = [[0.4, 1.1, 2.3], [2.0, 0.5, 0.9], [1.2, 2.6, 1.7]];

/// Returns the rotation whose columns are the axes s, t, 1 of a chart.
fn chart_axes(chart: usize) -> Matrix3<f64> {
    let [z, y, x] = CHARTS[chart % CHARTS.len()];
    let plane = |angle: f64, i: usize, k: usize| {
        let mut turn = Matrix3::identity();
        turn.fixed_view_with_steps_mut::<2, 2>((i, i), (k - i - 1, k - i - 1)).copy_from(&Matrix2::new(
            angle.cos(),
            -angle.sin(),
            angle.sin(),
            angle.cos(),
        ));
        turn
    };
    plane(z, 0, 1) * plane(y, 0, 2) * plane(x, 1, 2)
}

/// A polynomial in t of degree four or less.
type Polynomial = [f64; 5];

/// A conic as the quadratic a s^2 + b(t) s + c(t).
struct Quadratic {
    a: f64,
    b: Polynomial,
    c: Polynomial,
}

impl Quadratic {
    fn of(m: &Matrix3<f64>) -> Self {
        Quadratic {
            a: m[(0, 0)],
            b: [2.0 * m[(0, 2)], 2.0 * m[(0, 1)], 0.0, 0.0, 0.0],
            c: [m[(2, 2)], 2.0 * m[(1, 2)], m[(1, 1)], 0.0, 0.0],
        }
    }
}

fn scaled(p: Polynomial, by: f64) -> Polynomial {
    p.map(|c| c * by)
}

fn sum(p: Polynomial, q: Polynomial) -> Polynomial {
    std::array::from_fn(|k| p[k] + q[k])
}

/// Returns the product of two polynomials of degrees that add to four at most.
fn product(p: Polynomial, q: Polynomial) -> Polynomial {
    std::array::from_fn(|k| (0..=k).map(|i| p[i] * q[k - i]).sum())
}

fn value(p: Polynomial, t: Complex) -> Complex {
    p.iter().rev().fold(Complex::new(0.0, 0.0), |sum, &c| sum * t + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the conic A x^2 + B xy + C y^2 + D x + E y + F = 0.
    fn conic([a, b, c, d, e, f]: [f64; 6]) -> Matrix3<f64> {
        Matrix3::new(a, b / 2.0, d / 2.0, b / 2.0, c, e / 2.0, d / 2.0, e / 2.0, f)
    }

    /// Returns the distinct common points of all charts, as (x, y), by x and y.
    fn common(one: [f64; 6], other: [f64; 6]) -> Vec<[f64; 2]> {
        let conics = Conics::new([conic(one), conic(other)]).expect("two conics");
        let mut points: Vec<[f64; 2]> = Vec::new();
        for point in (0..Conics::charts()).flat_map(|chart| conics.in_chart(chart)) {
            let Some(x) = conics.common_point(point) else { continue };
            let xy = [x[0] / x[2], x[1] / x[2]];
            if points.iter().all(|p| (p[0] - xy[0]).hypot(p[1] - xy[1]) > 1e-5) {
                points.push(xy);
            }
        }
        points.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
        points
    }

    fn assert_are(found: &[[f64; 2]], wanted: &[[f64; 2]], tolerance: f64) {
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        for (p, q) in found.iter().zip(wanted) {
            assert!((p[0] - q[0]).hypot(p[1] - q[1]) < tolerance, "{found:?} for {wanted:?}");
        }
    }

    #[test]
    fn charts_are_rotations() {
        for chart in 0..Conics::charts() {
            let axes = chart_axes(chart);
            assert!((axes.transpose() * axes - Matrix3::identity()).norm() < 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn conics_meet_in_four_two_one_or_no_points() {
        let ellipse = [1.0, 0.0, 4.0, 0.0, 0.0, -4.0];
        // x^2 + y^2 = 2 with x^2 + 4 y^2 = 4: y^2 = 2/3, x^2 = 4/3.
        let (x, y) = ((4.0_f64 / 3.0).sqrt(), (2.0_f64 / 3.0).sqrt());
        let circle = [1.0, 0.0, 1.0, 0.0, 0.0, -2.0];
        assert_are(&common(ellipse, circle), &[[-x, -y], [-x, y], [x, -y], [x, y]], 1e-13);
        // (x - 3)^2 + y^2 = 4 with it: 3 x^2 - 24 x + 24 = 0, x = 4 - 2 sqrt 2.
        let x = 4.0 - 8.0_f64.sqrt();
        let y = (1.0 - x * x / 4.0).sqrt();
        assert_are(&common(ellipse, [1.0, 0.0, 1.0, -6.0, 0.0, 5.0]), &[[x, -y], [x, y]], 1e-13);
        // (x - 3)^2 + y^2 = 1 touches it in (2, 0); a smaller circle misses it.
        assert_are(&common(ellipse, [1.0, 0.0, 1.0, -6.0, 0.0, 8.0]), &[[2.0, 0.0]], 1e-5);
        assert_are(&common(ellipse, [1.0, 0.0, 1.0, -6.0, 0.0, 8.01]), &[], 0.0);
    }

    #[test]
    fn lines_in_common_leave_one_point_beside_them() {
        // (x - 1)(y - 2) and (x - 1)(x + y): the point (-2, 2) and the line x = 1.
        let (one, other) = ([0.0, 1.0, 0.0, -2.0, -1.0, 2.0], [1.0, 1.0, 0.0, -1.0, -1.0, 0.0]);
        let conics = Conics::new([conic(one), conic(other)]).expect("two conics");
        assert!((0..Conics::charts()).all(|chart| conics.in_chart(chart).is_empty()));
        let point = conics.beside_line(Vector3::new(1.0, 0.0, -1.0)).expect("a point");
        assert!((point / point[2] - Vector3::new(-2.0, 2.0, 1.0)).norm() < 1e-13);
        assert_eq!(conics.beside_line(Vector3::new(0.0, 1.0, -2.0)), None);
        assert!(Conics::new([conic(one), Matrix3::zeros()]).is_none());
        assert!(Conics::new([conic(one), conic(one) * f64::NAN]).is_none());
    }
}
