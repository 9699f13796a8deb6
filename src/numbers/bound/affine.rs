//! Affine enclosures of functions over a box: a linear function and a bound of the remainder (the rest).
//!
//! An [`Affine`] represents every function of e in [-1, 1]^4 within `rest` of `mid + by . e`. The parts that an
//! operation leaves out (products of linear parts, rounding) go into the rest. Its sums are of a few non-negative
//! numbers: [`UP`].

use super::ball::{Ball, not_negative};
use std::ops::{Add, Mul, Neg, Sub};

/// Twice the unit roundoff.
const EPS: f64 = f64::EPSILON;
/// A factor above the rounding of a sum of 64 non-negative numbers.
const UP: f64 = 1.0 + 1e-13;
/// A bound above everything that underflow can do.
const TINY: f64 = 1e-290;

/// A linear function with a bound of the remainder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine {
    pub mid: f64,
    pub by: [f64; 4],
    pub rest: f64,
}

impl Affine {
    /// Returns the enclosure of a number with an error.
    pub fn constant(x: Ball) -> Self {
        Affine { mid: x.mid, by: [0.0; 4], rest: x.rad }
    }

    /// Returns the enclosure of an exact number.
    pub fn exact(x: f64) -> Self {
        Affine::constant(Ball::exact(x))
    }

    /// Returns the enclosure of the variable x_k in [mid - half, mid + half].
    pub fn variable(mid: f64, half: f64, k: usize) -> Self {
        let mut by = [0.0; 4];
        by[k] = half;
        Affine { mid, by, rest: 0.0 }
    }

    #[inline(always)]
    fn spread(&self) -> f64 {
        (self.by[0].abs() + self.by[1].abs() + self.by[2].abs() + self.by[3].abs()) * UP
    }

    /// Returns a lower bound of every value.
    #[inline(always)]
    pub fn low(&self) -> f64 {
        let away = (self.spread() + self.rest) * UP;
        let low = self.mid - away;
        low - 4.0 * EPS * (self.mid.abs() + away) - TINY
    }

    /// Returns an upper bound of every value.
    #[inline(always)]
    pub fn high(&self) -> f64 {
        -(-*self).low()
    }

    #[inline(always)]
    fn rounded(mid: f64, by: [f64; 4], rest: f64, size: f64) -> Self {
        Affine { mid, by, rest: (rest + 4.0 * EPS * size + TINY) * UP }
    }

    /// Returns x times a number.
    #[inline(always)]
    pub fn times(&self, factor: f64) -> Self {
        let (mid, by) = (self.mid * factor, self.by.map(|by| by * factor));
        let size = (self.mid.abs() + self.spread()) * factor.abs();
        Affine::rounded(mid, by, self.rest * factor.abs(), size)
    }

    /// Returns x^2: the square of the linear part lies between 0 and that of its size.
    #[inline(always)]
    pub fn square(&self) -> Self {
        let spread = self.spread();
        let half = 0.5 * spread * spread * UP;
        let size = self.mid.abs() + spread;
        let rest = half + self.rest * (2.0 * size + self.rest);
        let by = self.by.map(|by| 2.0 * self.mid * by);
        Affine::rounded(self.mid * self.mid + half, by, rest, size * size)
    }

    /// Returns sqrt max(x, 0): sqrt(1 + y) is in [1 + y/2 - y^2/2, 1 + y/2] for y >= -1.
    pub fn root(&self) -> Self {
        let (mid, spread) = (self.mid, (self.spread() + self.rest) * UP);
        if !(mid > 1e-12 && spread < 0.9 * mid) {
            let half = 0.5 * (not_negative(self.high()).sqrt() * UP);
            return Affine { mid: half, by: [0.0; 4], rest: half * UP };
        }
        let root = mid.sqrt();
        let by = self.by.map(|by| 0.5 * by / root);
        let rest = 0.5 * self.rest / root + 0.5 * (spread / mid) * (spread / mid) * root;
        Affine::rounded(root, by, rest, root * 4.0)
    }

    /// Returns 1/x; `None` if x may be near 0: 1/(1 + y) = 1 - y + y^2/(1 + y).
    pub fn inverse(&self) -> Option<Self> {
        let spread = (self.spread() + self.rest) * UP;
        let relative = spread / self.mid.abs();
        if !(self.mid.abs() > 1e-12 && relative < 0.9) {
            return None;
        }
        let inverse = 1.0 / self.mid;
        let by = self.by.map(|by| -by * inverse * inverse);
        let size = inverse.abs();
        let rest = self.rest * size * size + size * relative * relative / (1.0 - relative);
        Some(Affine::rounded(inverse, by, rest, size * 4.0))
    }
}

impl Add for Affine {
    type Output = Affine;
    #[inline(always)]
    fn add(self, y: Affine) -> Affine {
        let by = std::array::from_fn(|k| self.by[k] + y.by[k]);
        let size = self.mid.abs() + self.spread() + y.mid.abs() + y.spread();
        Affine::rounded(self.mid + y.mid, by, self.rest + y.rest, size)
    }
}

impl Neg for Affine {
    type Output = Affine;
    #[inline(always)]
    fn neg(self) -> Affine {
        Affine { mid: -self.mid, by: self.by.map(|by| -by), rest: self.rest }
    }
}

impl Sub for Affine {
    type Output = Affine;
    #[inline(always)]
    fn sub(self, y: Affine) -> Affine {
        self + -y
    }
}

impl Mul for Affine {
    type Output = Affine;
    #[inline(always)]
    fn mul(self, y: Affine) -> Affine {
        let by = std::array::from_fn(|k| self.mid * y.by[k] + y.mid * self.by[k]);
        let (a, b) = (self.spread(), y.spread());
        let (size_a, size_b) = (self.mid.abs() + a, y.mid.abs() + b);
        let rest = a * b + self.rest * (size_b + y.rest) + size_a * y.rest;
        Affine::rounded(self.mid * y.mid, by, rest, size_a * size_b)
    }
}

#[cfg(test)]
mod tests {
    use super::Affine;

    /// Asserts that `value` is within the rest of the linear part at e, and within the bounds.
    fn holds(x: &Affine, e: [f64; 4], value: f64) {
        let linear = x.mid + (0..4).map(|k| x.by[k] * e[k]).sum::<f64>();
        assert!((value - linear).abs() <= x.rest + 1e-14, "{x:?} {e:?}: {value}");
        assert!(x.low() <= value + 1e-14 && value <= x.high() + 1e-14, "{x:?}: {value}");
    }

    #[test]
    fn every_operation_encloses_the_function() {
        // A sequence of numbers in [-1, 1] that fills the box.
        let mut state = 0.5_f64;
        let mut draw = move || {
            state = (state + 0.618_033_988_749_894_9).fract();
            2.0 * (state * 7919.0).fract() - 1.0
        };
        let mut inverses = 0;
        for round in 0..2000 {
            let size = 10.0_f64.powf(-2.0 * (round % 5) as f64 * 0.5);
            let mut function = || {
                let by = [0; 4].map(|_| size * draw());
                Affine { mid: 2.0 * draw(), by, rest: 0.1 * size * draw().abs() }
            };
            let (x, y) = (function(), function());
            let (product, square, difference) = (x * y, x.square(), x - y.times(3.0));
            let positive = x.square() + Affine::exact(0.2);
            let (root, inverse) = (positive.root(), y.inverse());
            inverses += usize::from(inverse.is_some());
            for corner in 0..16 {
                let sign = |k: usize| if corner >> k & 1 == 0 { 1.0 } else { -1.0 };
                let e = std::array::from_fn(|k| if round % 2 == 0 { sign(k) } else { draw() });
                let at =
                    |x: &Affine, off: f64| x.mid + (0..4).map(|k| x.by[k] * e[k]).sum::<f64>() + off * x.rest;
                for (p, q) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 0.3), (0.0, 0.0)] {
                    let (a, b) = (at(&x, p), at(&y, q));
                    holds(&product, e, a * b);
                    holds(&square, e, a * a);
                    holds(&difference, e, a - 3.0 * b);
                    holds(&positive, e, a * a + 0.2);
                    holds(&root, e, (a * a + 0.2).sqrt());
                    if let Some(inverse) = &inverse {
                        let rest = inverse.rest + 1e-14 * (1.0 / b).abs();
                        holds(&Affine { rest, ..*inverse }, e, 1.0 / b);
                    }
                }
            }
        }
        assert!(inverses > 500, "{inverses}");
    }
}
