//! Ball arithmetic: numbers with a bound of their error, on which every discarded box relies.
//!
//! A [`Ball`] (m, r) represents every real x with |x - m| <= r. Each operation encloses its exact result: the new
//! radius holds the effect of the radii of its arguments, plus 2^-52 of the new middle, twice what rounding to
//! nearest can do, plus `TINY` against underflow; and it is enlarged by `UP` for its own few roundings. No rounding
//! mode is set. A result that cannot be enclosed has an infinite radius or is NaN, and certifies nothing.

use std::ops::{Add, Mul, Neg, Sub};

/// Twice the unit roundoff.
const EPS: f64 = f64::EPSILON;
/// A bound above everything that underflow can do.
const TINY: f64 = 1e-290;
/// At least (1 + 2^-53)^6: the roundings of a radius.
const UP: f64 = 1.0 + 8.0 * f64::EPSILON;

/// The ball of all x with |x - mid| <= rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The middle m.
    pub mid: f64,
    /// The radius r >= 0.
    pub rad: f64,
}

/// Returns max(x, 0); NaN stays NaN, and certifies nothing.
#[inline(always)]
pub(super) fn not_negative(x: f64) -> f64 {
    if x < 0.0 { 0.0 } else { x }
}

impl Ball {
    /// Returns the ball of an exact number.
    pub const fn exact(mid: f64) -> Self {
        Ball { mid, rad: 0.0 }
    }

    #[inline(always)]
    fn rounded(mid: f64, rad: f64) -> Self {
        Ball { mid, rad: (rad + EPS * mid.abs() + TINY) * UP }
    }

    /// Returns an upper bound of every |x|.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        (self.mid.abs() + self.rad) * UP
    }

    /// Returns a lower bound of every x.
    #[inline(always)]
    pub fn low(self) -> f64 {
        let low = self.mid - self.rad;
        low - (low.abs() + self.rad) * EPS - TINY
    }

    /// Returns x^2.
    #[inline(always)]
    pub fn square(self) -> Self {
        self * self
    }

    /// Returns x / y; of infinite radius if y may be near zero.
    #[inline(always)]
    pub fn over(self, y: Ball) -> Self {
        let quotient = self.mid / y.mid;
        if y.rad < 0.5 * y.mid.abs() {
            // |x/y - m| <= (r_x + |m| r_y)/|y|, and the difference below is exact up to one rounding.
            let rad = (self.rad + quotient.abs() * y.rad) / (y.mid.abs() - y.rad);
            Ball::rounded(quotient, rad * UP)
        } else {
            Ball { mid: 0.0, rad: f64::INFINITY }
        }
    }

    /// Returns the root of max(x, 0).
    #[inline(always)]
    pub fn root(self) -> Self {
        // |sqrt x - sqrt m| = |x - m|/(sqrt x + sqrt m) <= min(r/sqrt m, sqrt r).
        let mid = not_negative(self.mid).sqrt();
        let far = self.rad.sqrt() * UP;
        let rad = if mid > far { self.rad / mid } else { far };
        Ball::rounded(mid, rad)
    }

    /// Returns cos x and sin x of a number |x| <= 4 (of infinite radius beyond).
    ///
    /// Horner's form of the Taylor series to x^33; the remainder is below 4^34/34! < 1.1e-18.
    pub fn cos_sin(x: f64) -> [Ball; 2] {
        if x.is_nan() || x.abs() > 4.0 {
            return [Ball { mid: 0.0, rad: f64::INFINITY }; 2];
        }
        let square = Ball::exact(x).square();
        let one = Ball::exact(1.0);
        let (mut cos, mut sin) = (one, one);
        for k in (1..=16).rev() {
            let k = f64::from(2 * k);
            cos = one - (square * cos).over(Ball::exact(k * (k - 1.0)));
            sin = one - (square * sin).over(Ball::exact(k * (k + 1.0)));
        }
        let mut pair = [cos, sin * Ball::exact(x)];
        for ball in &mut pair {
            ball.rad = (ball.rad + 2e-18) * UP;
        }
        pair
    }
}

impl Add for Ball {
    type Output = Ball;
    #[inline(always)]
    fn add(self, y: Ball) -> Ball {
        Ball::rounded(self.mid + y.mid, self.rad + y.rad)
    }
}

impl Sub for Ball {
    type Output = Ball;
    #[inline(always)]
    fn sub(self, y: Ball) -> Ball {
        Ball::rounded(self.mid - y.mid, self.rad + y.rad)
    }
}

impl Mul for Ball {
    type Output = Ball;
    #[inline(always)]
    fn mul(self, y: Ball) -> Ball {
        let rad = self.mid.abs() * y.rad + self.rad * (y.mid.abs() + y.rad);
        Ball::rounded(self.mid * y.mid, rad)
    }
}

impl Neg for Ball {
    type Output = Ball;
    #[inline(always)]
    fn neg(self) -> Ball {
        Ball { mid: -self.mid, rad: self.rad }
    }
}
