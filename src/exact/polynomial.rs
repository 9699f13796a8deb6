//! The sixteen equations as polynomials, over any numbers that can be added and multiplied.
//!
//! The loop equation of a link (p, g) (a moving pin and its ground pivot) at point j, multiplied by T_j:
//!
//! ```text
//! f = L M - T U V        L = p T + delta - g      M = p* + (delta* - g*) T       U = p - g      V = p* - g*
//!
//! df/dp = T (M - V)   df/dg = T V - M   df/dp* = L - T U   df/dg* = T (U - L)   df/dT = p M + L (delta* - g*) - U V
//! ```
//!
//! T = 0 is no solution of the original equations; for T != 0 both forms have the same solutions. The polynomial is
//! the better one to certify: no inverse of a disc, no quotient in double-double, and three products in all.

use super::double_double::DoubleComplex;
use super::target::{Displacements, STEPS, Solution, Target};
use crate::linkage::Complex;
use std::ops::{Add, Mul, Sub};

/// Unknowns, and equations: x, y, a, b, their starred twins, T_1 .. T_8.
pub const UNKNOWNS: usize = 16;
/// The unknowns before T_1.
pub const PIVOTS: usize = 8;

/// What can be added, subtracted and multiplied: complex numbers of doubles, of double-doubles, discs.
pub trait Ring: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}
impl<R: Copy + Add<Output = R> + Sub<Output = R> + Mul<Output = R>> Ring for R {}

/// The displacements without rounding: what a certificate speaks of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactDisplacements {
    /// delta_j.
    pub delta: [DoubleComplex; STEPS],
    /// delta*_j.
    pub starred: [DoubleComplex; STEPS],
}

impl From<&Displacements> for ExactDisplacements {
    fn from(given: &Displacements) -> Self {
        ExactDisplacements { delta: given.delta.map(Into::into), starred: given.starred.map(Into::into) }
    }
}

impl From<&Target> for ExactDisplacements {
    /// The difference of two doubles is a double-double, and the scale is a power of two: nothing is rounded. (A part
    /// below 2^-1022 of the scale may underflow; the bound of a residual covers it.)
    fn from(target: &Target) -> Self {
        let factor = target.scale.recip();
        let delta = std::array::from_fn(|j| {
            DoubleComplex::difference_of(target.points[j + 1], target.points[0]).times_power_of_two(factor)
        });
        ExactDisplacements { delta, starred: delta.map(DoubleComplex::conj) }
    }
}

/// The unknowns in a row: x, y, a, b, x*, y*, a*, b*, T_1 .. T_8.
pub fn unknowns(of: &Solution) -> [Complex; UNKNOWNS] {
    let [[x, y], [a, b], [xs, ys], [as_, bs]] = [of.pins, of.grounds, of.pins_starred, of.grounds_starred];
    let pivots = [x, y, a, b, xs, ys, as_, bs];
    std::array::from_fn(|i| if i < PIVOTS { pivots[i] } else { of.rotations[i - PIVOTS] })
}

/// The inverse of [`unknowns`].
pub fn solution(of: &[Complex; UNKNOWNS]) -> Solution {
    Solution {
        pins: [of[0], of[1]],
        grounds: [of[2], of[3]],
        pins_starred: [of[4], of[5]],
        grounds_starred: [of[6], of[7]],
        rotations: std::array::from_fn(|j| of[PIVOTS + j]),
    }
}

/// Which unknowns the equation of link 0 (x, a) or 1 (y, b) at point j is about: p, g, p*, g*, T.
#[inline(always)]
pub fn columns(link: usize, j: usize) -> [usize; 5] {
    [link, 2 + link, 4 + link, 6 + link, PIVOTS + j]
}

/// f at one link and point.
#[inline(always)]
pub fn value<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> R {
    let (l, m) = (p * t + (delta - g), ps + (starred - gs) * t);
    l * m - t * ((p - g) * (ps - gs))
}

/// df/dp, df/dg, df/dp*, df/dg*, df/dT at one link and point.
#[inline(always)]
pub fn derivatives<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> [R; 5] {
    let (reach, reach_starred) = (delta - g, starred - gs);
    let (l, m) = (p * t + reach, ps + reach_starred * t);
    let (u, v) = (p - g, ps - gs);
    [t * (m - v), t * v - m, l - t * u, t * (u - l), p * m + l * reach_starred - u * v]
}
