//! SIMD lanes: the arithmetic of the position solver, written once for one `f64` and for eight of them side by side.
//!
//! Every operation is a single IEEE-754 operation a lane (no fused multiply-add), so eight lanes give the
//! very bits that one lane gives. The eight-lane type is a plain array: the compiler turns its loops into
//! whatever vector instructions the enclosing function may use (see [`super::dispatch`]).

use std::ops::{Add, Mul, Neg, Sub};

/// Number of values in an [`F64x8`].
pub const LANES: usize = 8;

/// One number or several numbers that take part in the same calculation.
pub trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// Returns the same number in every lane.
    fn splat(value: f64) -> Self;
    /// Returns 1 / self.
    fn recip(self) -> Self;
    /// Returns the square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// Returns the larger of self and zero; zero for NaN.
    fn positive_part(self) -> Self;
    /// Returns the smaller of the two numbers; `other` if self is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns `yes` in the lanes with self >= limit, `no` in the others and if self is NaN.
    fn at_least(self, limit: Self, yes: Self, no: Self) -> Self;
}

impl Lane for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn positive_part(self) -> Self {
        if self > 0.0 { self } else { 0.0 }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn at_least(self, limit: Self, yes: Self, no: Self) -> Self {
        if self >= limit { yes } else { no }
    }
}

/// Eight numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct F64x8(pub [f64; LANES]);

impl F64x8 {
    /// Loads the eight numbers that start at `slice[at]`.
    ///
    /// # Panics
    /// When fewer than eight are left.
    #[inline(always)]
    pub fn load(slice: &[f64], at: usize) -> Self {
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&slice[at..at + LANES]);
        F64x8(lanes)
    }

    /// Writes the eight numbers to `slice[at..at + 8]`.
    ///
    /// # Panics
    /// When there is no room for eight.
    #[inline(always)]
    pub fn store(self, slice: &mut [f64], at: usize) {
        slice[at..at + LANES].copy_from_slice(&self.0);
    }

    /// Returns the sum of the lanes, always added in the same order (halves, then quarters, then the pair).
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let l = self.0;
        ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]))
    }

    /// Returns the size of each number.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// Returns the quotient of each two numbers.
    #[inline(always)]
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        self.zip(other, |x, y| x / y)
    }

    /// Returns whether any number is above the limit, or NaN.
    #[inline(always)]
    pub fn any_above(self, limit: f64) -> bool {
        let mut above = 0_u64;
        for lane in self.0 {
            above |= u64::from(lane > limit || lane.is_nan());
        }
        above != 0
    }

    #[expect(clippy::needless_range_loop, reason = "indexed loops over arrays become vector instructions")]
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = f(self.0[i], other.0[i]);
        }
        F64x8(out)
    }

    #[expect(clippy::needless_range_loop, reason = "indexed loops over arrays become vector instructions")]
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = f(self.0[i]);
        }
        F64x8(out)
    }
}

crate::operators! { F64x8:
    Add add(x, y) { x.zip(y, |x, y| x + y) }
    Sub sub(x, y) { x.zip(y, |x, y| x - y) }
    Mul mul(x, y) { x.zip(y, |x, y| x * y) }
    Neg neg(x) { x.map(|x| -x) }
}

impl Lane for F64x8 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        F64x8([value; LANES])
    }
    #[inline(always)]
    fn recip(self) -> Self {
        self.map(|x| 1.0 / x)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn positive_part(self) -> Self {
        self.map(Lane::positive_part)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, Lane::min)
    }
    #[expect(clippy::needless_range_loop, reason = "indexed loops over arrays become vector instructions")]
    #[inline(always)]
    fn at_least(self, limit: Self, yes: Self, no: Self) -> Self {
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = if self.0[i] >= limit.0[i] { yes.0[i] } else { no.0[i] };
        }
        F64x8(out)
    }
}
