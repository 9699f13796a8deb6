//! The best circle of a pin: the fit of Kasa (1976), then Newton's iteration to the least true distances.
//!
//! With x_j the places of the pin about their weighted mean and averages E weighted alike, Kasa's circle minimises
//! E(|x|^2 - 2 <x, g> - k)^2, which is linear:
//!
//! ```text
//! 2 E(x x') g = E(|x|^2 x),      R^2 = |g|^2 + E|x|^2
//! ```
//!
//! It shrinks the circle of a short arc with errors; so E(|x - g| - R)^2 is then minimised, with R = E|x - g|.

use crate::mechanism::{Complex, Dyad, Pose, cross};

/// Least ratio of the spread of places across their line to the spread along it, squared: flatter ones are a line.
const FLAT_SQ: f64 = 1e-14;

/// Steps of Newton's iteration; it stops as soon as the error stays.
const STEPS: usize = 20;

/// Times that a step which does not lower the error is halved.
const HALVINGS: i32 = 5;

/// Relative fall of the squared error below which the iteration stops.
const STAYS: f64 = 1e-9;

/// The best circle of a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircleFit {
    /// G, the centre.
    pub pivot: Complex,
    /// R, the radius.
    pub length: f64,
    /// The root of the weighted mean of the squared distances from the circle.
    pub rms: f64,
}

impl CircleFit {
    /// Returns the RR dyad of a pin on this circle.
    pub fn dyad(&self, pin: Complex) -> Dyad {
        Dyad::RR { pin, pivot: self.pivot, length: self.length }
    }
}

/// Fits a circle to the places of a body's pin at the poses, by least squares of the distances; `weights` has one weight a
/// pose, at least zero, or is absent where all are equal.
///
/// `None` if the places are fewer than three, on a line, or not finite.
pub fn circle_fit(poses: &[Pose], pin: Complex, weights: Option<&[f64]>) -> Option<CircleFit> {
    let shares = shares(poses.len(), weights)?;
    let places: Vec<Complex> = poses.iter().map(|pose| pose.at(pin)).collect();
    let average = |f: &dyn Fn(Complex) -> Complex| {
        places.iter().zip(&shares).map(|(&x, share)| f(x) * share).sum::<Complex>()
    };
    let mean = average(&|x| x);
    let spread = average(&|x| (x - mean) * (x - mean));
    let spread_sq = average(&|x| (x - mean).norm_sqr().into()).re;
    let third = average(&|x| (x - mean) * (x - mean).norm_sqr());
    // 4 det E(x x') = (E|x|^2)^2 - |E x^2|^2
    let determinant = spread_sq * spread_sq - spread.norm_sqr();
    let is_curved = determinant > FLAT_SQ * spread_sq * spread_sq;
    if !is_curved {
        return None;
    }
    let kasa = (third * spread_sq - spread * third.conj()) / determinant;
    let mut fit = at_centre(&places, &shares, mean + kasa)?;
    for _ in 0..STEPS {
        let Some(better) = step(&places, &shares, &fit) else { break };
        let stays = fit.rms - better.rms < STAYS * fit.rms;
        fit = better;
        if stays {
            break;
        }
    }
    Some(fit)
}

/// Returns the weights as shares of their sum; `None` if the sum is not positive and finite.
pub(super) fn shares(count: usize, weights: Option<&[f64]>) -> Option<Vec<f64>> {
    let weights = weights.map_or_else(|| vec![1.0; count], <[f64]>::to_vec);
    let sum: f64 = weights.iter().sum();
    let fits = weights.len() == count && sum > 0.0 && sum.is_finite() && weights.iter().all(|&w| w >= 0.0);
    fits.then(|| weights.iter().map(|weight| weight / sum).collect())
}

/// Returns the best circle about a centre.
fn at_centre(places: &[Complex], shares: &[f64], pivot: Complex) -> Option<CircleFit> {
    let average = |f: &dyn Fn(f64) -> f64| {
        places.iter().zip(shares).map(|(x, share)| share * f((x - pivot).norm())).sum::<f64>()
    };
    let length = average(&|distance| distance);
    let rms = average(&|distance| (distance - length) * (distance - length)).sqrt();
    (length.is_finite() && rms.is_finite() && length > 0.0).then_some(CircleFit { pivot, length, rms })
}

/// Returns the circle after one step of Newton's iteration on the centre, R eliminated; `None` if no part of the step
/// lowers the error.
///
/// With n_j = (G - x_j)/d_j the unit vectors of the distances d_j, f = E(d - R)^2 has the gradient 2 E(d - R) n and the
/// Hessian 2 (E n n' - E n E n' + E (d - R)/d (1 - n n')), whose last term is left out where the sum is not definite.
fn step(places: &[Complex], shares: &[f64], fit: &CircleFit) -> Option<CircleFit> {
    let rows = places.iter().zip(shares).map(|(&x, &share)| {
        let away = fit.pivot - x;
        let distance = away.norm();
        (away / distance, distance, share)
    });
    let mean = rows.clone().map(|(n, _, share)| n * share).sum::<Complex>();
    // Symmetric matrices as xx, xy, yy.
    let (mut gauss, mut bend, mut right) = ([0.0; 3], [0.0; 3], Complex::new(0.0, 0.0));
    for (n, distance, share) in rows {
        let error = share * (distance - fit.length);
        let (slope, bent) = (n - mean, error / distance);
        for (k, (one, other)) in
            [(slope.re, slope.re), (slope.re, slope.im), (slope.im, slope.im)].into_iter().enumerate()
        {
            gauss[k] += share * one * other;
        }
        for (k, part) in [n.im * n.im, -n.re * n.im, n.re * n.re].into_iter().enumerate() {
            bend[k] += bent * part;
        }
        right -= n * error;
    }
    let newton: [f64; 3] = std::array::from_fn(|k| gauss[k] + bend[k]);
    let whole = solve(newton, right).or_else(|| solve(gauss, right))?;
    let shorter = |halvings: i32| at_centre(places, shares, fit.pivot + whole * 0.5_f64.powi(halvings));
    (0..HALVINGS).filter_map(shorter).find(|next| next.rms < fit.rms)
}

/// Solves a symmetric system; `None` if its matrix is not positive definite.
fn solve([xx, xy, yy]: [f64; 3], right: Complex) -> Option<Complex> {
    let determinant = xx * yy - xy * xy;
    let (first, second) = (Complex::new(xx, xy), Complex::new(xy, yy));
    let definite = xx > 0.0 && determinant > f64::EPSILON * xx * yy;
    definite.then(|| Complex::new(cross(right, second), cross(first, right)) / determinant)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{KINZEL5, Moved, poses_deg, random_point};
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    #[test]
    fn a_circle_fit_is_exact_on_circles_and_stationary_elsewhere() {
        let draws = &mut stream(24, 0);
        for _ in 0..100 {
            let moved = Moved::random(draws, 9);
            for dyad in moved.dyads() {
                let Dyad::RR { pin, pivot, length } = dyad else { panic!("{dyad:?}") };
                let fit = circle_fit(&moved.poses, pin, None).expect("a circle");
                assert!(fit.rms < 1e-13 * (1.0 + length), "{fit:?}");
                assert!(
                    (fit.pivot - pivot).norm() + (fit.length - length).abs() < 1e-7,
                    "{fit:?} for {dyad:?}"
                );
            }
            let weights: Vec<f64> = moved.poses.iter().map(|_| uniform(draws, 0.5, 2.0)).collect();
            let pin = random_point(draws, 3.0);
            let rms = |pivot: Complex, length: f64| -> f64 {
                let dyad = Dyad::RR { pin, pivot, length };
                let miss_sq =
                    moved.poses.iter().zip(&weights).map(|(pose, w)| w * dyad.residual(pose).powi(2));
                (miss_sq.sum::<f64>() / weights.iter().sum::<f64>()).sqrt()
            };
            let Some(fit) = circle_fit(&moved.poses, pin, Some(&weights)) else { continue };
            assert!((rms(fit.pivot, fit.length) - fit.rms).abs() < 1e-12 * fit.length, "{fit:?}");
            for step in [
                Complex::new(1.0, 0.0),
                Complex::new(-1.0, 0.0),
                Complex::new(0.0, 1.0),
                Complex::new(0.0, -1.0),
            ] {
                let by = step * (1e-2 * fit.length);
                assert!(rms(fit.pivot + by, fit.length) > fit.rms * (1.0 - 1e-9), "{fit:?}");
                assert!(rms(fit.pivot, fit.length + by.re) > fit.rms * (1.0 - 1e-9), "{fit:?}");
            }
        }
        let poses = poses_deg(KINZEL5);
        assert_eq!(circle_fit(&poses[..2], Complex::new(1.0, 0.0), None), None);
        assert_eq!(circle_fit(&poses, Complex::new(1.0, 0.0), Some(&[1.0; 4])), None);
        let on_line = [0.0, 1.0, 2.0, 4.0].map(|x| Pose::new(Complex::new(x, 2.0 * x), x));
        assert_eq!(circle_fit(&on_line, Complex::new(0.0, 0.0), None), None);
    }
}
