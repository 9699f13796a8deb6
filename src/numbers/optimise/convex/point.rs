//! Points of the convex model: their linear residuals, the parts of a residual that tolerances limit, and the points'
//! own steps.

use crate::levenberg_marquardt::block::{across_and_along, dot};
use crate::levenberg_marquardt::{MAX_TAU, PointBlock};
use std::array::from_fn;

/// Returns the number of parts of a residual of `rows` rows that have a tolerance each.
pub(super) const fn parts(rows: usize) -> usize {
    rows - 1
}

/// Returns the size of a part of a residual: part 0 is the length of rows 0 and 1 together, each further part the
/// magnitude of one further row.
fn part_size<const R: usize>(r: &[f64; R], part: usize) -> f64 {
    if part == 0 { r[0].hypot(r[1]) } else { r[part + 1].abs() }
}

/// Computes the deviation of a point: the largest part of its residual over the part's tolerance.
pub(super) fn deviation<const R: usize>(r: &[f64; R], tolerances: &[f64]) -> f64 {
    let size = |part: usize| part_size(r, part) / tolerances[part];
    (1..parts(R)).fold(size(0), |most, part| most.max(size(part)))
}

/// Returns whether tolerances hold a point's own unknown: its residual has several parts, of which one at least is
/// limited. A step along the tangent then trades one part against another, so it cannot be eliminated.
pub(super) fn is_traded<const N: usize, const R: usize>(
    block: &PointBlock<N, R>,
    tolerances: Option<&[f64]>,
) -> bool {
    let limited = || tolerances.is_some_and(|list| list.iter().any(|tol| tol.is_finite()));
    parts(R) > 1 && block.tangent_sq() > 0.0 && limited()
}

/// A point of the model: r + J dx + t tau.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModelPoint<const N: usize, const R: usize> {
    pub residual: [f64; R],
    pub jacobian: [[f64; N]; R],
    /// The tangent t_j, and |t_j|^2.
    pub tangent: [f64; R],
    pub tangent_sq: f64,
    /// Whether the point's own unknown takes up the residual along the tangent, so that only the components across it
    /// count.
    pub takes_up: bool,
    /// Whether the own unknown is a variable of the programs with cones for the point; see [`is_traded`].
    pub traded: bool,
    pub weight: f64,
}

impl<const N: usize, const R: usize> ModelPoint<N, R> {
    pub fn new(block: &PointBlock<N, R>, tolerances: Option<&[f64]>) -> Self {
        let tangent_sq = block.tangent_sq();
        let along = dot(&block.tangent, &block.residual);
        ModelPoint {
            residual: block.residual,
            jacobian: block.jacobian,
            tangent: block.tangent,
            tangent_sq,
            // Beyond its reach a point's own unknown cannot be relied on to take up the residual.
            takes_up: tangent_sq > 0.0 && along.abs() <= 0.5 * MAX_TAU * tangent_sq,
            traded: is_traded(block, tolerances),
            weight: block.weight,
        }
    }

    /// Computes the residual after a shared step, r + J dx.
    pub fn moved(&self, dx: &[f64; N]) -> [f64; R] {
        let mut r = self.residual;
        for (axis, value) in r.iter_mut().enumerate() {
            *value += self.jacobian[axis].iter().zip(dx).map(|(j, d)| j * d).sum::<f64>();
        }
        r
    }

    /// Computes r + t tau.
    pub fn along(&self, r: &[f64; R], tau: f64) -> [f64; R] {
        from_fn(|axis| r[axis] + self.tangent[axis] * tau)
    }

    /// Computes the own step that leaves the least |r + t tau|.
    pub fn foot(&self, r: &[f64; R], tau_limit: f64) -> f64 {
        (-dot(&self.tangent, r) / self.tangent_sq).clamp(-tau_limit, tau_limit)
    }

    /// Returns an orthonormal basis of the residuals whose last vector is along the tangent.
    pub fn basis(&self) -> [[f64; R]; R] {
        across_and_along(&self.tangent, self.tangent_sq)
    }

    /// Computes the own step that leaves the least deviation; of several the one with the least sum of squares of the
    /// parts over their tolerances.
    ///
    /// The square of each part is a parabola a + 2 b tau + c tau^2. The least of their maximum is at a vertex, at an
    /// intersection of two, or at an end.
    pub fn nearest(&self, r: &[f64; R], tolerances: &[f64], tau_limit: f64) -> f64 {
        let parabolas: Vec<[f64; 3]> = (0..parts(R))
            .filter(|&part| tolerances[part].is_finite())
            .map(|part| self.parabola(r, part, tolerances[part]))
            .collect();
        let mut best = (f64::INFINITY, f64::INFINITY, 0.0);
        let mut consider = |tau: f64| {
            let tau = tau.clamp(-tau_limit, tau_limit);
            let after = self.along(r, tau);
            let squares = (0..parts(R)).map(|part| (part_size(&after, part) / tolerances[part]).powi(2));
            let tried = (deviation(&after, tolerances), squares.sum::<f64>(), tau);
            if tried.0 < best.0 || (tried.0 == best.0 && tried.1 < best.1) {
                best = tried;
            }
        };
        consider(0.0);
        consider(-tau_limit);
        consider(tau_limit);
        for (i, one) in parabolas.iter().enumerate() {
            if one[2] > 0.0 {
                consider(-one[1] / one[2]);
            }
            for other in &parabolas[..i] {
                roots(from_fn(|k| one[k] - other[k])).into_iter().flatten().for_each(&mut consider);
            }
        }
        best.2
    }

    /// Returns (a, b, c) of the square of a part over its tolerance along the tangent, a + 2 b tau + c tau^2.
    fn parabola(&self, r: &[f64; R], part: usize, tolerance: f64) -> [f64; 3] {
        let rows = if part == 0 { 0..2 } else { part + 1..part + 2 };
        let mut sums = [0.0; 3];
        for row in rows {
            let (at, by) = (r[row] / tolerance, self.tangent[row] / tolerance);
            sums = [sums[0] + at * at, sums[1] + at * by, sums[2] + by * by];
        }
        sums
    }
}

/// Returns the real roots of a + 2 b x + c x^2.
fn roots([a, b, c]: [f64; 3]) -> [Option<f64>; 2] {
    let square = b * b - a * c;
    if square.is_nan() || square < 0.0 {
        return [None; 2];
    }
    // The larger in magnitude of -b +- sqrt(b^2 - a c): no digits cancel.
    let large = -(b + square.sqrt().copysign(b));
    [large / c, a / large].map(|root| root.is_finite().then_some(root))
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_arithmetic::streams::{stream, uniform};

    #[test]
    fn roots_are_those_of_the_factors() {
        // (x - 3)(x + 2) = -6 - x + x^2, a line 4 - 2 x, a double root, none.
        assert_eq!(roots([-6.0, -0.5, 1.0]), [Some(3.0), Some(-2.0)]);
        assert_eq!(roots([4.0, -1.0, 0.0]), [None, Some(2.0)]);
        assert_eq!(roots([9.0, -3.0, 1.0]), [Some(3.0), Some(3.0)]);
        assert_eq!(roots([1.0, 0.0, 1.0]), [None, None]);
    }

    #[test]
    fn the_nearest_own_step_is_where_a_scan_finds_it() {
        let mut draws = stream(5, 0);
        for case in 0..300 {
            let mut vector = || from_fn(|_| uniform(&mut draws, -1.0, 1.0));
            let (residual, mut tangent): ([f64; 4], [f64; 4]) = (vector(), vector());
            if case % 5 == 0 {
                tangent[2] = 0.0;
            }
            let mut tolerances: [f64; 3] = from_fn(|_| uniform(&mut draws, 0.05, 1.0));
            if case % 3 == 0 {
                tolerances[case % 9 / 3] = f64::INFINITY;
            }
            let block = PointBlock { residual, jacobian: [[0.0]; 4], tangent, weight: 1.0 };
            let point = ModelPoint::new(&block, Some(&tolerances));
            assert!(point.traded);
            let limit = 0.6;
            let size = |tau: f64| deviation(&point.along(&residual, tau), &tolerances);
            let tau = point.nearest(&residual, &tolerances, limit);
            let scanned =
                (-3000..=3000).map(|i| size(limit * f64::from(i) / 3000.0)).fold(f64::INFINITY, f64::min);
            assert!(tau.abs() <= limit && size(tau) <= scanned * (1.0 + 1e-12), "{case}: {tau}");
            // The slope of a part over its tolerance is 1.5 / 0.05 at most.
            assert!(size(tau) >= scanned - 30.0 * limit / 3000.0, "{case}: {tau}");
        }
    }
}
