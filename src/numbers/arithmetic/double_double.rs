//! Real and complex numbers as unevaluated sums of two doubles, about 32 digits.
//!
//! A [`DoubleDouble`] is hi + lo with hi = fl(hi + lo). With u = 2^-53 and neither overflow nor underflow the relative
//! errors are at most
//!
//! ```text
//! sum, difference   3 u^2 / (1 - 4 u)      (of the exact sum: cancellation costs nothing)
//! product           7 u^2
//! quotient         15 u^2 + 56 u^3
//! ```
//!
//! [`RELATIVE_ERROR`] is above all of them. Products are split by Veltkamp and Dekker, not by fused multiply-add: the
//! baseline of x86-64 has none, and `f64::mul_add` without it is a slow library call. The digits are the same.
//!
//! Sources: T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18 (1971)
//! 224-242; M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of
//! double-word arithmetic", ACM Trans. Math. Softw. 44 (2017) 15res, algorithms 6 (sum), 10 (product), 17 (quotient).

use crate::Complex;

/// A bound above the relative error of any one operation on [`DoubleDouble`]: 2^-100 = 64 u^2.
pub const RELATIVE_ERROR: f64 = 1.0 / (1_u128 << 100) as f64;

/// hi + lo, exactly; |lo| is at most half a unit in the last place of hi.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The sum rounded to one double.
    pub hi: f64,
    /// The remainder that rounding left.
    pub lo: f64,
}

/// A complex number of two [`DoubleDouble`]s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleComplex {
    /// Real part.
    pub re: DoubleDouble,
    /// Imaginary part.
    pub im: DoubleDouble,
}

/// Computes a + b = fl(a + b) + error, exactly, if |a| >= |b| or a = 0 (Dekker).
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let hi = a + b;
    DoubleDouble { hi, lo: b - (hi - a) }
}

/// Splits a into a sum of two numbers of 26 bits (Veltkamp); |a| < 2^996.
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

impl DoubleDouble {
    /// Returns a + b = fl(a + b) + error, exactly (Knuth).
    #[inline(always)]
    pub fn sum_of(a: f64, b: f64) -> Self {
        let hi = a + b;
        let of_b = hi - a;
        DoubleDouble { hi, lo: (a - (hi - of_b)) + (b - of_b) }
    }

    /// Returns a b = fl(a b) + error, exactly unless the error lies below the smallest double (Dekker).
    #[inline(always)]
    pub fn product_of(a: f64, b: f64) -> Self {
        let hi = a * b;
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        DoubleDouble { hi, lo: a2 * b2 - (((hi - a1 * b1) - a2 * b1) - a1 * b2) }
    }

    /// Returns the nearest double.
    #[inline(always)]
    pub fn to_f64(self) -> f64 {
        self.hi
    }

    /// Returns the number times a power of two, exactly unless it underflows.
    #[inline(always)]
    pub fn times_power_of_two(self, factor: f64) -> Self {
        DoubleDouble { hi: self.hi * factor, lo: self.lo * factor }
    }
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(hi: f64) -> Self {
        DoubleDouble { hi, lo: 0.0 }
    }
}

crate::operators! { DoubleDouble:
    Neg neg(x) { DoubleDouble { hi: -x.hi, lo: -x.lo } }
    Add add(x, y) {
        let high = DoubleDouble::sum_of(x.hi, y.hi);
        let low = DoubleDouble::sum_of(x.lo, y.lo);
        let head = fast_two_sum(high.hi, high.lo + low.hi);
        fast_two_sum(head.hi, low.lo + head.lo)
    }
    Sub sub(x, y) { x + -y }
    Mul mul(x, y) {
        let head = DoubleDouble::product_of(x.hi, y.hi);
        fast_two_sum(head.hi, head.lo + (x.hi * y.lo + x.lo * y.hi))
    }
    Div div(x, y) {
        let quotient = x.hi / y.hi;
        let product = DoubleDouble::product_of(y.hi, quotient);
        let back = fast_two_sum(product.hi, product.lo + y.lo * quotient);
        let rest = (x.hi - back.hi) + (x.lo - back.lo);
        fast_two_sum(quotient, rest / y.hi)
    }
}

impl DoubleComplex {
    /// Returns the nearest complex number of two doubles.
    #[inline(always)]
    pub fn to_complex(self) -> Complex {
        Complex::new(self.re.hi, self.im.hi)
    }

    /// Returns the remainder that [`Self::to_complex`] leaves.
    #[inline(always)]
    pub fn rest(self) -> Complex {
        Complex::new(self.re.lo, self.im.lo)
    }

    /// Returns the complex conjugate.
    #[inline(always)]
    pub fn conj(self) -> Self {
        DoubleComplex { re: self.re, im: -self.im }
    }

    /// Returns a - b, exactly.
    #[inline(always)]
    pub fn difference_of(a: Complex, b: Complex) -> Self {
        DoubleComplex { re: DoubleDouble::sum_of(a.re, -b.re), im: DoubleDouble::sum_of(a.im, -b.im) }
    }

    /// Returns the number times a real power of two, exactly unless it underflows.
    #[inline(always)]
    pub fn times_power_of_two(self, factor: f64) -> Self {
        DoubleComplex { re: self.re.times_power_of_two(factor), im: self.im.times_power_of_two(factor) }
    }
}

impl From<Complex> for DoubleComplex {
    #[inline(always)]
    fn from(z: Complex) -> Self {
        DoubleComplex { re: z.re.into(), im: z.im.into() }
    }
}

crate::operators! { DoubleComplex:
    Neg neg(z) { DoubleComplex { re: -z.re, im: -z.im } }
    Add add(z, w) { DoubleComplex { re: z.re + w.re, im: z.im + w.im } }
    Sub sub(z, w) { DoubleComplex { re: z.re - w.re, im: z.im - w.im } }
    /// Error at most 4 [`RELATIVE_ERROR`] |z| |w|.
    Mul mul(z, w) { DoubleComplex { re: z.re * w.re - z.im * w.im, im: z.re * w.im + z.im * w.re } }
    /// z / w = z conj(w) / |w|^2.
    Div div(z, w) {
        let norm_sqr = w.re * w.re + w.im * w.im;
        let above = z * w.conj();
        DoubleComplex { re: above.re / norm_sqr, im: above.im / norm_sqr }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    /// Every double of these tests is a whole multiple of 2^-FRACTION.
    const FRACTION: i32 = 400;

    /// Returns x 2^FRACTION as a whole number, exactly.
    fn whole(x: f64) -> BigInt {
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        if exponent == 0 {
            assert_eq!(fraction, 0, "{x:e} is below the normal doubles");
            return BigInt::ZERO;
        }
        let shift = exponent - 1075 + FRACTION;
        assert!(shift >= 0, "{x:e} is no multiple of 2^-{FRACTION}");
        let magnitude = BigInt::from(fraction | (1 << 52)) << shift;
        if x < 0.0 { -magnitude } else { magnitude }
    }

    fn value(x: DoubleDouble) -> BigInt {
        whole(x.hi) + whole(x.lo)
    }

    fn magnitude(x: BigInt) -> BigInt {
        if x < BigInt::ZERO { -x } else { x }
    }

    /// Returns whether |found - exact| <= factor u^2 |exact|, all in one unit.
    fn within(found: BigInt, exact: BigInt, factor: u32) -> bool {
        (magnitude(found - &exact) << 106) <= magnitude(exact) * factor
    }

    /// Generates doubles of either sign over 40 binary orders.
    fn double() -> impl Strategy<Value = f64> {
        (-1.0..1.0_f64, -20..20_i32).prop_map(|(x, e)| x * 2.0_f64.powi(e))
    }

    fn double_double() -> impl Strategy<Value = DoubleDouble> {
        (double(), -1.0..1.0_f64)
            .prop_map(|(hi, part)| DoubleDouble::sum_of(hi, hi * part * f64::EPSILON / 2.0))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn sums_and_products_of_two_doubles_are_exact(a in double(), b in double()) {
            let (sum, product) = (DoubleDouble::sum_of(a, b), DoubleDouble::product_of(a, b));
            prop_assert_eq!(sum.hi, a + b);
            prop_assert_eq!(value(sum), whole(a) + whole(b));
            let difference = DoubleComplex::difference_of(Complex::new(a, b), Complex::new(b, a));
            prop_assert_eq!(value(difference.re), whole(a) - whole(b));
            prop_assert_eq!(value(difference.im), whole(b) - whole(a));
            prop_assert_eq!(product.hi, a * b);
            prop_assert_eq!(value(product) << FRACTION, whole(a) * whole(b));
            prop_assert_eq!(product.lo, a.mul_add(b, -(a * b)));
        }

        #[test]
        fn operations_keep_their_bounds(a in double_double(), b in double_double(), near in -4..4_i32) {
            prop_assert!(within(value(a + b), value(a) + value(b), 4));
            let close = DoubleDouble { hi: -a.hi * (1.0 + f64::from(near) * f64::EPSILON), lo: b.lo };
            let close = DoubleDouble::sum_of(close.hi, close.lo);
            prop_assert!(within(value(a + close), value(a) + value(close), 4), "cancellation");
            prop_assert!(within(value(a * b) << FRACTION, value(a) * value(b), 7));
            prop_assume!(b.hi != 0.0);
            // a / b = q  <=>  a = q b: the same relative error.
            let quotient = a / b;
            prop_assert!(within(value(quotient) * value(b), value(a) << FRACTION, 16));
        }
    }

    #[test]
    fn complex_products_and_quotients_undo_each_other() {
        let z = DoubleComplex::from(Complex::new(0.7, -1.3));
        let w = DoubleComplex::from(Complex::new(-2.1, 0.4));
        let exact = (
            whole(0.7) * whole(-2.1) - whole(-1.3) * whole(0.4),
            whole(0.7) * whole(0.4) + whole(-1.3) * whole(-2.1),
        );
        let product = z * w;
        assert!(within(value(product.re) << FRACTION, exact.0, 64));
        assert!(within(value(product.im) << FRACTION, exact.1, 64));
        let back = product / w - z;
        assert!(back.re.hi.hypot(back.im.hi) < 2.0 * RELATIVE_ERROR, "{back:?}");
        assert_eq!(z.conj().im.hi, 1.3);
    }
}
