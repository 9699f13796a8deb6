//! Discs of complex numbers and upper bounds, both with outward rounding.
//!
//! [`Upper`] is a number that is known to be at least some exact value. Each operation on it is one correctly rounded
//! operation followed by a step to the next larger double; an exact value lies at most one such step above its rounded
//! one, so the result is an upper bound again, underflow included. Overflow gives infinity, which no check accepts.
//!
//! [`Disc`] is the set |z - mid| <= radius. The result of an operation contains every exact result for members of the
//! discs. With u = 2^-53 the rounding of the midpoints is covered by
//!
//! ```text
//! |fl(z + w) - (z + w)| <= u |fl(z + w)|                      each part is rounded once; sums do not underflow
//! |fl(z w) - z w|       <= 4 u |z| |w| + 2^-1022              each part: two products, one difference, so at most
//!                                                             u (|z||w| + |z||w| (1 + u)^2) + 2^-1073; sqrt 2 for both
//! ```
//!
//! Source: I. Gargantini, P. Henrici, "Circular arithmetic and the determination of polynomial zeros", Numer. Math. 18
//! (1972) 305-320 (centred at the midpoint's image, not at the optimal centre).

use linkwright_arithmetic::Complex;
use linkwright_arithmetic::double_double::DoubleComplex;
use linkwright_arithmetic::operators;

/// The unit roundoff, 2^-53.
const UNIT: f64 = f64::EPSILON / 2.0;

/// An upper bound: at least the exact value that it stands for, never negative.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Upper(f64);

impl Upper {
    /// Zero, exactly.
    pub const ZERO: Upper = Upper(0.0);

    /// Returns the bound `value`, which is exact; its magnitude if it is negative.
    #[inline(always)]
    pub const fn exactly(value: f64) -> Self {
        Upper(value.abs())
    }

    /// Returns an upper bound of |z|.
    #[inline(always)]
    pub fn magnitude(z: Complex) -> Self {
        let square =
            Upper::exactly(z.re) * Upper::exactly(z.re) + Upper::exactly(z.im) * Upper::exactly(z.im);
        Upper(square.0.sqrt().next_up())
    }

    /// Returns an upper bound of |z|.
    #[inline(always)]
    pub fn magnitude_of_double(z: DoubleComplex) -> Self {
        Upper::magnitude(z.to_complex()) + Upper::magnitude(z.rest())
    }

    /// Returns an upper bound of the quotient, by a positive number that is a lower bound of the divisor.
    #[inline(always)]
    pub(super) fn over(self, least: f64) -> Self {
        Upper((self.0 / least).next_up())
    }

    /// Returns the larger one; NaN wins, as it must not be lost.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        if self.0.is_nan() || self.0 > other.0 { self } else { other }
    }

    /// Returns the bound.
    #[inline(always)]
    pub const fn get(self) -> f64 {
        self.0
    }
}

operators! { Upper:
    Add add(x, y) { Upper((x.0 + y.0).next_up()) }
    Mul mul(x, y) { Upper((x.0 * y.0).next_up()) }
}

/// The disc |z - mid| <= radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its midpoint.
    pub mid: Complex,
    /// Its radius.
    pub radius: Upper,
}

impl Disc {
    /// Returns the disc of one number, of radius zero.
    #[inline(always)]
    pub fn point(mid: Complex) -> Self {
        Disc { mid, radius: Upper::ZERO }
    }

    /// Returns a disc that contains the disc of `radius` about `mid`.
    #[inline(always)]
    pub fn about(mid: DoubleComplex, radius: Upper) -> Self {
        Disc { mid: mid.to_complex(), radius: Upper::magnitude(mid.rest()) + radius }
    }

    /// Returns an upper bound of |z| for every member z.
    #[inline(always)]
    pub fn magnitude(&self) -> Upper {
        Upper::magnitude(self.mid) + self.radius
    }

    /// Returns a lower bound of |z| for every member z; zero when the disc contains or all but contains zero.
    pub(super) fn least_magnitude(&self) -> f64 {
        let square = |x: f64| (x * x).next_down().max(0.0);
        let sum = (square(self.mid.re) + square(self.mid.im)).next_down().max(0.0);
        let least = sum.sqrt().next_down() - self.radius.0;
        if least.is_finite() { least.next_down().max(0.0) } else { 0.0 }
    }

    /// Returns the disc of the conjugates.
    #[inline(always)]
    pub fn conj(self) -> Self {
        Disc { mid: self.mid.conj(), radius: self.radius }
    }

    /// Returns the disc times a positive power of two.
    #[inline(always)]
    pub fn times_power_of_two(self, factor: f64) -> Self {
        // Only underflow is inexact: by less than 2^-1073 in both parts together.
        let radius = self.radius * Upper::exactly(factor) + Upper::exactly(f64::MIN_POSITIVE);
        Disc { mid: self.mid * factor, radius }
    }

    /// Returns a disc that contains 1/z for every member z; `None` when the disc contains or all but contains zero.
    ///
    /// With c near 1/mid and z = mid + e: 1/z - c = (1 - c mid - c e) / z, so |1/z - c| <= (|1 - c mid| + |c| r) /
    /// least
    /// |z|. The residual is evaluated in discs, so nothing is asked of c.
    pub fn inverse(self) -> Option<Self> {
        let least = self.least_magnitude();
        let near = self.mid.inv();
        if least <= 0.0 || !(near.re.is_finite() && near.im.is_finite()) {
            return None;
        }
        let one = Disc::point(Complex::new(1.0, 0.0));
        let rest = one - Disc::point(near) * Disc::point(self.mid);
        Some(Disc {
            mid: near,
            radius: (rest.magnitude() + Upper::magnitude(near) * self.radius).over(least),
        })
    }

    /// Returns whether the discs certainly have no number in common.
    pub fn is_disjoint(&self, other: &Disc) -> bool {
        let between = Disc { mid: self.mid, radius: self.radius + other.radius } - Disc::point(other.mid);
        between.least_magnitude() > 0.0
    }
}

operators! { Disc:
    Add add(z, w) {
        let mid = z.mid + w.mid;
        Disc { mid, radius: z.radius + w.radius + Upper(UNIT) * Upper::magnitude(mid) }
    }
    Sub sub(z, w) { z + -w }
    Neg neg(z) { Disc { mid: -z.mid, radius: z.radius } }
    Mul mul(z, w) {
        let [one, two] = [z, w].map(|d| Upper::magnitude(d.mid));
        let rounding = Upper(4.0 * UNIT) * one * two + Upper(f64::MIN_POSITIVE);
        let spread = one * w.radius + two * z.radius + z.radius * w.radius;
        Disc { mid: z.mid * w.mid, radius: spread + rounding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_arithmetic::double_double::DoubleDouble;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// Generates a disc and a member near its rim, as a double-double: what is left between them is far above 2^-100.
    fn disc_with_member() -> impl Strategy<Value = (Disc, DoubleComplex)> {
        let part = (-1.0..1.0_f64, -12..12_i32).prop_map(|(x, e)| x * 2.0_f64.powi(e));
        (part.clone(), part, prop_oneof![Just(-200), -60..-1_i32], 0.0..TAU).prop_map(
            |(re, im, exponent, turn)| {
                let mid = Complex::new(re, im);
                let radius = 2.0_f64.powi(exponent) * mid.norm();
                let offset = Complex::from_polar(radius * (1.0 - 1e-15), turn);
                (Disc { mid, radius: Upper(radius) }, DoubleComplex::from(mid) + DoubleComplex::from(offset))
            },
        )
    }

    /// Returns whether z lies in the disc, by double-double arithmetic: |z - mid|^2 <= radius^2.
    fn holds(disc: Disc, z: DoubleComplex) -> bool {
        let off = z - DoubleComplex::from(disc.mid);
        let square = off.re * off.re + off.im * off.im;
        let left = square - DoubleDouble::product_of(disc.radius.get(), disc.radius.get());
        left.hi <= 0.0
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn a_disc_holds_the_exact_results_of_its_members(
            (a, z) in disc_with_member(),
            (b, w) in disc_with_member(),
        ) {
            prop_assert!(holds(a, z) && holds(b, w));
            prop_assert!(holds(a + b, z + w));
            prop_assert!(holds(a - b, z - w));
            prop_assert!(holds(a * b, z * w));
            prop_assert!(holds(a.times_power_of_two(0.125), z.times_power_of_two(0.125)));
            let magnitude = a.magnitude().get();
            let square = z.re * z.re + z.im * z.im - DoubleDouble::product_of(magnitude, magnitude);
            prop_assert!(square.hi <= 0.0);
            let least = a.least_magnitude();
            prop_assert!((z.re * z.re + z.im * z.im - DoubleDouble::product_of(least, least)).hi >= 0.0);
            if let Some(inverse) = a.inverse() {
                prop_assert!(holds(inverse, DoubleComplex::from(Complex::new(1.0, 0.0)) / z));
            }
            let member = Disc::about(z, Upper::ZERO);
            prop_assert!(!a.is_disjoint(&member));
        }

        #[test]
        fn a_bound_lies_above_the_exact_value(a in 1e-3..1e3_f64, b in 1e-3..1e3_f64) {
            let (one, two) = (Upper::exactly(a), Upper::exactly(b));
            prop_assert!((DoubleDouble::sum_of(a, b) - (one + two).get().into()).hi < 0.0);
            prop_assert!((DoubleDouble::product_of(a, b) - (one * two).get().into()).hi < 0.0);
            let back = DoubleDouble::product_of(one.over(b).get(), b);
            prop_assert!((back - a.into()).hi > 0.0);
            let size = Upper::magnitude(Complex::new(a, -b)).get();
            let exact = DoubleDouble::product_of(a, a) + DoubleDouble::product_of(b, b);
            prop_assert!((exact - DoubleDouble::product_of(size, size)).hi < 0.0);
        }
    }

    /// If the radii left out the rounding of the midpoints, one of a thousand products would miss its exact value:
    /// the containment test above can fail.
    #[test]
    fn rounding_is_not_negligible() {
        let mut missed = 0;
        for i in 1..1000 {
            let z = Complex::new(1.0 / f64::from(i), 1.0 / f64::from(i + 1));
            let exact = DoubleComplex::from(z) * DoubleComplex::from(z);
            missed += usize::from(!holds(Disc::point(z * z), exact));
            assert!(holds(Disc::point(z) * Disc::point(z), exact));
        }
        assert!(missed > 900, "{missed}");
    }

    #[test]
    fn tiny_and_huge_numbers_are_bounded_or_refused() {
        let tiny = Disc::point(Complex::new(1e-200, 1e-200));
        assert!((tiny * tiny).radius.get() >= 2e-400_f64.max(f64::MIN_POSITIVE));
        let huge = Disc::point(Complex::new(1e300, 0.0));
        assert!(!(huge * huge).radius.get().is_finite());
        assert_eq!(Disc { mid: Complex::new(1.0, 0.0), radius: Upper(1.0) }.inverse(), None);
        assert_eq!(Disc { mid: Complex::new(1.0, 0.0), radius: Upper(f64::INFINITY) }.inverse(), None);
        assert!(Upper(f64::NAN).max(Upper(1.0)).get().is_nan());
        assert!(Upper(1.0).max(Upper(f64::NAN)).get().is_nan());
    }
}
