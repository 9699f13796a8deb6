//! The ellipse through the points of a closed target that is nearly one.
//!
//! A crank that is short beside the other links moves these by small angles, and the coupler point draws an ellipse but
//! for terms of second order in crank over link:
//!
//! ```text
//! P(theta) = c_0 + c_1 exp(i theta) + c_-1 exp(-i theta) + ...
//! ```
//!
//! The points then stand on it at the phases theta, not evenly in their arc length.

use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, centroid_and_radius};
use nalgebra::{Matrix5, Vector5};
use std::f64::consts::TAU;

/// Greatest rms distance of the points from the ellipse, in parts of their distance from its centre.
const NEARLY: f64 = 0.05;

/// Returns the phases of the points on the ellipse that fits them best, in turns from the first point on, growing along
/// the path; `None` if they are not nearly on an ellipse, or do not go round it once.
///
/// The ellipse is the conic with the least sum of (A x^2 + B xy + C y^2 + D x + E y - 1)^2, with x and y from the
/// points' mean. An affine map takes it to the unit circle and the phases to angles.
pub(super) fn phases(points: &[Complex]) -> Option<Vec<f64>> {
    let (mean, size) = centroid_and_radius(points);
    let unit: Vec<Complex> = points.iter().map(|p| (p - mean) / size).collect();
    let (mut matrix, mut right) = (Matrix5::zeros(), Vector5::zeros());
    for z in &unit {
        let row = Vector5::new(z.re * z.re, z.re * z.im, z.im * z.im, z.re, z.im);
        matrix += row * row.transpose();
        right += row;
    }
    let conic = matrix.cholesky()?.solve(&right);
    let [a, b, c, d, e] = conic.into();
    let determinant = a * c - 0.25 * b * b;
    if !(determinant > 0.0 && a > 0.0) {
        return None;
    }
    let centre = Complex::new(0.25 * b * e - 0.5 * c * d, 0.25 * b * d - 0.5 * a * e) / determinant;
    // (z - centre)' M (z - centre) = level, with M = L L': L' (z - centre) lies on a circle.
    let level = 1.0 - 0.5 * (d * centre.re + e * centre.im);
    if level <= 0.0 {
        return None;
    }
    let on_circle: Vec<Complex> = unit
        .iter()
        .map(|z| {
            let from = z - centre;
            let along = (a * from.re + 0.5 * b * from.im) / a.sqrt();
            Complex::new(along, (determinant / a).sqrt() * from.im) / level.sqrt()
        })
        .collect();
    let away = on_circle.iter().map(|z| (z.norm() - 1.0).powi(2)).sum::<f64>() / points.len() as f64;
    if away.sqrt() > NEARLY {
        return None;
    }
    let steps = on_circle.windows(2).map(|w| wrapped((w[1] * w[0].conj()).arg()));
    let mut turns = vec![0.0];
    turns.extend(steps.scan(0.0, |sum, step| {
        *sum += step / TAU;
        Some(*sum)
    }));
    let way = turns[turns.len() - 1].signum();
    turns.iter_mut().for_each(|turn| *turn *= way);
    let goes_round_once = turns.is_sorted() && turns[turns.len() - 1] <= 1.0 + 1e-6;
    goes_round_once.then_some(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse(turn: f64) -> Complex {
        let angle = TAU * turn;
        Complex::new(3.0, -2.0)
            + Complex::from_polar(1.0, 0.4) * Complex::new(5.0 * angle.cos(), 0.5 * angle.sin())
    }

    #[test]
    fn phases_are_those_of_the_ellipse_whichever_way_it_is_run() {
        let at = [0.0, 0.03, 0.1, 0.22, 0.3, 0.45, 0.6, 0.71, 0.8, 0.93];
        let forward = phases(&at.map(ellipse)).expect("an ellipse");
        let backward = phases(&at.map(|turn| ellipse(-turn))).expect("an ellipse");
        for found in [forward, backward] {
            for (found, turn) in found.iter().zip(at) {
                assert!((found - turn).abs() < 1e-12, "{found} for {turn}");
            }
        }
    }

    #[test]
    fn what_is_no_ellipse_or_is_run_twice_has_no_phases() {
        let twice: Vec<Complex> = (0..24).map(|i| ellipse(f64::from(i) / 11.5)).collect();
        assert_eq!(phases(&twice), None);
        let square: Vec<Complex> = (0..40)
            .map(|i| {
                let along = f64::from(i % 10) / 5.0 - 1.0;
                Complex::new(0.0, 1.0).powi(i / 10) * Complex::new(1.0, along)
            })
            .collect();
        assert_eq!(phases(&square), None);
        let line: Vec<Complex> = (0..9).map(|i| Complex::new(f64::from(i), 0.0)).collect();
        assert_eq!(phases(&line), None);
    }
}
