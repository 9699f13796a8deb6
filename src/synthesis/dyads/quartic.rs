//! The roots of a real polynomial of degree four or less, by the simultaneous iteration of Ehrlich (1967) and Aberth
//! (1973):
//!
//! ```text
//! z_k <- z_k - N_k / (1 - N_k sum_{i != k} 1/(z_k - z_i)),     N_k = p(z_k)/p'(z_k)
//! ```
//!
//! It converges cubically to simple roots and linearly to double ones, whose places carry an error of about the square
//! root of the rounding; the values of p there are those of rounding in any case.

use crate::mechanism::Complex;

/// Leading and trailing coefficients below this part of the largest count as zero: the roots that go with them are
/// beyond every scale.
const NEGLIGIBLE: f64 = 1e-15;

/// Iterations after which roots are taken as they are. Simple roots need about 8, double ones about 30.
const ITERATIONS: usize = 60;

/// Returns the roots of sum_k coefficients\[k\] t^k, as many as its degree; none if every coefficient is zero or one is
/// not finite.
pub(super) fn roots(coefficients: [f64; 5]) -> Vec<Complex> {
    let largest = coefficients.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    if !(largest > 0.0 && coefficients.iter().all(|c| c.is_finite())) {
        return Vec::new();
    }
    let counts = |c: &f64| c.abs() > NEGLIGIBLE * largest;
    let (Some(first), Some(last)) =
        (coefficients.iter().position(counts), coefficients.iter().rposition(counts))
    else {
        return Vec::new();
    };
    let zeros = std::iter::repeat_n(Complex::new(0.0, 0.0), first);
    zeros.chain(nonzero_roots(&coefficients[first..=last])).collect()
}

/// Returns the roots of a polynomial whose first and last coefficients are not zero.
fn nonzero_roots(coefficients: &[f64]) -> Vec<Complex> {
    let degree = coefficients.len() - 1;
    if degree == 0 {
        return Vec::new();
    }
    // In units of the geometric mean of the roots' magnitudes, their product has the magnitude one.
    let mean = (coefficients[0] / coefficients[degree]).abs().powf(1.0 / degree as f64);
    let mut scaled = coefficients.to_vec();
    scaled.iter_mut().enumerate().for_each(|(k, c)| *c *= mean.powi(k as i32 - degree as i32));
    let start = |k: usize| {
        // An irregular turn, so that no start lies on the axis of symmetry of the roots.
        Complex::from_polar(1.0, 0.7 + std::f64::consts::TAU * k as f64 / degree as f64)
    };
    let mut at: Vec<Complex> = (0..degree).map(start).collect();
    for _ in 0..ITERATIONS {
        let mut largest_step: f64 = 0.0;
        for k in 0..degree {
            let Some(newton) = newton_step(&scaled, at[k]) else { continue };
            let others = (0..degree).filter(|&i| i != k && at[i] != at[k]);
            let repulsion: Complex = others.map(|i| (at[k] - at[i]).inv()).sum();
            let step = newton / (1.0 - newton * repulsion);
            if step.is_finite() {
                at[k] -= step;
                largest_step = largest_step.max(step.norm() / at[k].norm().max(f64::MIN_POSITIVE));
            }
        }
        if largest_step < 4.0 * f64::EPSILON {
            break;
        }
    }
    at.into_iter().map(|root| root * mean).collect()
}

/// Returns p(z)/p'(z); `None` where p is zero within its rounding, or where p' is zero.
fn newton_step(coefficients: &[f64], z: Complex) -> Option<Complex> {
    let zero = Complex::new(0.0, 0.0);
    let (mut value, mut slope, mut magnitude) = (zero, zero, 0.0);
    for &c in coefficients.iter().rev() {
        slope = slope * z + value;
        value = value * z + c;
        magnitude = magnitude * z.norm() + c.abs();
    }
    let matters = value.norm() > f64::EPSILON * magnitude && slope != zero;
    matters.then(|| value / slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{below, stream, uniform};

    /// Returns the coefficients of the monic polynomial with these roots, which are real or in conjugate pairs.
    fn polynomial(roots: [Complex; 4]) -> [f64; 5] {
        let mut product = vec![Complex::new(1.0, 0.0)];
        for root in roots {
            let mut next = vec![Complex::new(0.0, 0.0); product.len() + 1];
            for (k, c) in product.iter().enumerate() {
                next[k] -= c * root;
                next[k + 1] += c;
            }
            product = next;
        }
        std::array::from_fn(|k| product[k].re)
    }

    /// Returns the distance of the farthest root from the one found for it.
    fn farthest(wanted: [Complex; 4], mut found: Vec<Complex>) -> f64 {
        assert_eq!(found.len(), 4);
        let mut most: f64 = 0.0;
        for root in wanted {
            let distance = |z: &Complex| (z - root).norm() / root.norm().max(1e-3);
            let nearest =
                (0..found.len()).min_by(|&i, &k| distance(&found[i]).total_cmp(&distance(&found[k])));
            most = most.max(distance(&found.swap_remove(nearest.expect("one"))));
        }
        most
    }

    #[test]
    fn simple_roots_are_found_to_their_condition() {
        let draws = &mut stream(3, 0);
        for case in 0..2000 {
            let mut root = || Complex::new(uniform(draws, -3.0, 3.0), uniform(draws, -3.0, 3.0));
            let (one, other) = (root(), root());
            let real = [one.re, one.im, other.re, other.im].map(|x| Complex::new(x, 0.0));
            let mixed = [one, one.conj(), real[2], real[3]];
            let wanted = [real, mixed, [one, one.conj(), other, other.conj()]][below(draws, 3)];
            let near = |i: usize, k: usize| (wanted[i] - wanted[k]).norm() < 0.05;
            if (0..4).any(|i| (0..i).any(|k| near(i, k))) {
                continue;
            }
            let error = farthest(wanted, roots(polynomial(wanted)));
            assert!(error < 1e-9, "case {case}: {error:e} for {wanted:?}");
        }
    }

    #[test]
    fn nearly_double_roots_are_found_to_the_root_of_the_rounding() {
        for gap in [1e-3, 1e-5, 1e-7, 1e-9, 0.0] {
            for (one, other) in [(1.0, -2.0), (0.3, 40.0), (-1e3, 1e-3)] {
                let wanted = [one, one + gap * one, other, 0.5].map(|x: f64| Complex::new(x, 0.0));
                let error = farthest(wanted, roots(polynomial(wanted)));
                assert!(error < 2e-7, "{gap}: {error:e} for {wanted:?}");
                let apart = Complex::new(one, gap * one);
                let wanted = [apart, apart.conj(), Complex::new(other, 0.0), Complex::new(0.5, 0.0)];
                let error = farthest(wanted, roots(polynomial(wanted)));
                assert!(error < 2e-7, "{gap}: {error:e} for {wanted:?}");
            }
        }
        let twice = [2.0, 2.0, -1.0, -1.0].map(|x| Complex::new(x, 0.0));
        assert!(farthest(twice, roots(polynomial(twice))) < 2e-7);
    }

    #[test]
    fn lower_degrees_and_roots_at_zero_are_counted() {
        assert_eq!(roots([0.0; 5]), []);
        assert_eq!(roots([3.0, 0.0, 0.0, 0.0, 0.0]), []);
        assert_eq!(roots([f64::NAN, 0.0, 0.0, 0.0, 1.0]), []);
        assert_eq!(roots([1.0, f64::INFINITY, 0.0, 0.0, 1.0]), []);
        let line = roots([-6.0, 2.0, 0.0, 0.0, 0.0]);
        assert!(line.len() == 1 && (line[0] - 3.0).norm() < 1e-14, "{line:?}");
        let found = roots([0.0, 0.0, -4.0, 1.0, 0.0]);
        assert!(found.len() == 3 && found[..2] == [Complex::new(0.0, 0.0); 2], "{found:?}");
        assert!((found[2] - 4.0).norm() < 1e-14);
        assert_eq!(roots([0.0, 0.0, 0.0, 0.0, 5.0]).len(), 4);
    }
}
