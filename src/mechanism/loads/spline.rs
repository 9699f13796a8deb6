//! Interpolates values over an angle by the periodic cubic spline, which is twice continuously differentiable.
//!
//! With knots x_i, h_i = x_{i+1} - x_i (the last one to x_0 + 2 pi), values y_i and d_i = (y_{i+1} - y_i)/h_i, the second derivatives
//! M_i solve
//!
//! ```text
//! h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (d_i - d_{i-1})        i modulo n
//! ```
//!
//! (C. de Boor, A Practical Guide to Splines, chapter IV, with periodic ends). The matrix is diagonally dominant; it is tridiagonal but
//! for its corners, which are a matrix of rank one (Sherman and Morrison 1950).

use std::f64::consts::TAU;

/// A periodic cubic spline over one turn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PeriodicSpline {
    knots: Vec<f64>,
    values: Vec<f64>,
    /// The second derivatives at the knots.
    bends: Vec<f64>,
}

/// A place of the spline with its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extreme {
    pub(super) at: f64,
    pub(super) value: f64,
}

impl PeriodicSpline {
    /// Fits the spline through rows (angle in radians, value), which ascend and span less than a turn. One row is a constant.
    pub(super) fn through(rows: &[(f64, f64)]) -> Self {
        let (knots, values): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
        let mut spline = PeriodicSpline { bends: vec![0.0; knots.len()], knots, values };
        spline.bends = spline.fitted();
        spline
    }

    /// Returns the width of a piece.
    fn width(&self, i: usize) -> f64 {
        self.knots.get(i + 1).copied().unwrap_or(self.knots[0] + TAU) - self.knots[i]
    }

    /// Returns the slope of the chord of a piece.
    fn chord(&self, i: usize) -> f64 {
        (self.values[(i + 1) % self.values.len()] - self.values[i]) / self.width(i)
    }

    /// Returns the ends of all pieces.
    pub(super) fn pieces(&self) -> impl Iterator<Item = [f64; 2]> {
        (0..self.knots.len()).map(|i| [self.knots[i], self.knots[i] + self.width(i)])
    }

    /// Solves for the second derivatives.
    fn fitted(&self) -> Vec<f64> {
        let n = self.knots.len();
        if n < 2 {
            return vec![0.0; n];
        }
        let before = |i: usize| (i + n - 1) % n;
        let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (self.width(before(i)) + self.width(i))).collect();
        let right: Vec<f64> = (0..n).map(|i| 6.0 * (self.chord(i) - self.chord(before(i)))).collect();
        // The corners, w in the first and in the last row, as u v' with u = (-p, 0, .., w) and v = (1, 0, .., -w/p).
        let corner = self.width(n - 1);
        let pivot = diagonal[0];
        diagonal[0] += pivot;
        diagonal[n - 1] += corner * corner / pivot;
        let mut column = vec![0.0; n];
        column[0] = -pivot;
        column[n - 1] = corner;
        let off: Vec<f64> = (0..n - 1).map(|i| self.width(i)).collect();
        let [plain, column] = [right, column].map(|right| tridiagonal(&diagonal, &off, right));
        let along = |x: &[f64]| x[0] - corner / pivot * x[n - 1];
        let share = along(&plain) / (1.0 + along(&column));
        plain.iter().zip(&column).map(|(x, z)| x - share * z).collect()
    }

    /// Returns value and first derivative at an angle.
    pub(super) fn at(&self, angle: f64) -> [f64; 2] {
        let begin = self.knots[0];
        let turned = begin + (angle - begin).rem_euclid(TAU);
        let i = self.knots.partition_point(|knot| *knot <= turned).max(1) - 1;
        self.in_piece(i, (turned - self.knots[i]).clamp(0.0, self.width(i)))
    }

    /// Returns value and first derivative in a piece, t after its knot.
    fn in_piece(&self, i: usize, t: f64) -> [f64; 2] {
        let [value, slope, bend, jerk] = self.piece(i);
        let first = slope + t * (bend + 0.5 * t * jerk);
        [value + t * (slope + t * (0.5 * bend + t * jerk / 6.0)), first]
    }

    /// Returns value, slope, second and third derivative at the knot of a piece.
    fn piece(&self, i: usize) -> [f64; 4] {
        let (h, next) = (self.width(i), (i + 1) % self.knots.len());
        let (bend, end) = (self.bends[i], self.bends[next]);
        [self.values[i], self.chord(i) - h / 6.0 * (2.0 * bend + end), bend, (end - bend) / h]
    }

    /// Returns the places of the least and of the greatest value.
    pub(super) fn extremes(&self) -> [Extreme; 2] {
        let mut places: Vec<Extreme> = Vec::new();
        for i in 0..self.knots.len() {
            let [value, slope, bend, jerk] = self.piece(i);
            places.push(Extreme { at: self.knots[i], value });
            let inside = roots(0.5 * jerk, bend, slope).into_iter().flatten();
            for t in inside.filter(|t| (0.0..=self.width(i)).contains(t)) {
                places.push(Extreme { at: self.knots[i] + t, value: self.in_piece(i, t)[0] });
            }
        }
        let of = |sign: f64| {
            let by = |p: &&Extreme, q: &&Extreme| (sign * p.value).total_cmp(&(sign * q.value));
            places.iter().max_by(by).copied().unwrap_or(Extreme { at: 0.0, value: 0.0 })
        };
        [of(-1.0), of(1.0)]
    }
}

/// Returns the real roots of a t^2 + b t + c, without cancellation.
fn roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let under = b * b - 4.0 * a * c;
    if under < 0.0 {
        return [None; 2];
    }
    let q = -0.5 * (b + under.sqrt().copysign(b));
    [q / a, c / q].map(|root| Some(root).filter(|root| root.is_finite()))
}

/// Solves a symmetric tridiagonal system, diagonally dominant, by elimination.
fn tridiagonal(diagonal: &[f64], off: &[f64], mut right: Vec<f64>) -> Vec<f64> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for i in 1..n {
        let factor = off[i - 1] / pivots[i - 1];
        pivots[i] -= factor * off[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - off[i] * right[i + 1]) / pivots[i];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spline_through_uneven_rows_is_smooth_and_periodic() {
        let rows = [(0.3, 4.0), (1.0, 5.0), (1.4, 3.0), (3.0, 4.5), (5.5, 6.0)];
        let spline = PeriodicSpline::through(&rows);
        for (i, (at, value)) in rows.into_iter().enumerate() {
            let [here, slope] = spline.at(at + TAU);
            assert!((here - value).abs() < 1e-12);
            let before = (i + rows.len() - 1) % rows.len();
            let h = spline.width(before);
            let [end, end_slope] = spline.in_piece(before, h);
            let [.., bend, jerk] = spline.piece(before);
            assert!((end - value).abs() < 1e-12 && (end_slope - slope).abs() < 1e-11);
            assert!((bend + h * jerk - spline.piece(i)[2]).abs() < 1e-11);
        }
    }

    #[test]
    fn a_spline_through_a_sine_is_near_it_in_value_and_slope() {
        // The error of a cubic spline is of the fourth order: 5/384 h^4 |y''''|, of the slope h^3/24.
        let h = TAU / 24.0;
        let rows: Vec<(f64, f64)> = (0..24).map(|i| h * f64::from(i)).map(|x| (x, 3.0 + x.sin())).collect();
        let spline = PeriodicSpline::through(&rows);
        for i in 0..500 {
            let x = 0.1 * f64::from(i);
            let [value, slope] = spline.at(x);
            assert!((value - 3.0 - x.sin()).abs() < 5.0 / 384.0 * h.powi(4));
            assert!((slope - x.cos()).abs() < h.powi(3) / 24.0);
        }
        let [least, greatest] = spline.extremes();
        assert!((least.value - 2.0).abs() < 1e-4 && (greatest.value - 4.0).abs() < 1e-4);
        assert!((greatest.at - TAU / 4.0).abs() < 1e-3);
    }

    #[test]
    fn two_rows_are_a_wave_and_one_is_a_constant() {
        let two = PeriodicSpline::through(&[(0.0, 1.0), (TAU / 2.0, 3.0)]);
        let [value, slope] = two.at(TAU / 4.0);
        assert!((value - 2.0).abs() < 1e-14 && slope > 0.0 && two.at(0.0)[1].abs() < 1e-14);
        assert_eq!(PeriodicSpline::through(&[(1.0, 7.0)]).at(5.0), [7.0, 0.0]);
    }
}
