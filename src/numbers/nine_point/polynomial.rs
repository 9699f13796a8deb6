//! The sixteen equations as polynomials, over any numbers that can be added and multiplied.
//!
//! The turn T = delta / starred of a pose is given by the linear equation
//!
//! ```text
//! f = T starred - delta
//! ```
//!
//! once for the rotation in the pose's place and once for that in the place of the turn itself, which has no other use; and
//! a given pivot by the two equations g = delta, g* = starred. Rotations in the places of given pivots, which are none,
//! follow a quotient of their own.
//! The loop equation of a link (p, g) (a moving pin and its ground pivot) at point j, multiplied by T_j:
//!
//! ```text
//! f = L M - T U V        L = p T + delta - g      M = p* + (delta* - g*) T       U = p - g      V = p* - g*
//!
//! df/dp = T (M - V)   df/dg = T V - M   df/dp* = L - T U   df/dg* = T (U - L)   df/dT = p M + L (delta* - g*) - U V
//! ```
//!
//! The equations of a slider's line ([`Closure`]), multiplied by T, v = p - g:
//!
//! ```text
//! slider-crank            f = v M* + v* T M        M = p T + delta - p           M* = p* + (delta* - p*) T
//! inverted slider-crank   f = v T N* + v* N        N = g - delta - g T           N* = (g* - delta*) T - g*
//! ```
//!
//! T = 0 is no solution of the original equations; for T != 0 both forms have the same solutions. The polynomial is
//! the better one to certify: no inverse of a disc, no quotient in double-double, and three products in all.

use super::target::{Closure, Displacements, Solution, Target, quotient};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::double_double::DoubleComplex;
use std::ops::{Add, Mul, Sub};

/// The number of unknowns, and of equations: x, y, a, b, their starred twins, T_1 .. T_8.
pub const UNKNOWNS: usize = 16;
/// The number of unknowns before T_1.
pub const PIVOTS: usize = 8;

/// Numbers that can be added, subtracted and multiplied: complex numbers of doubles, of double-doubles, discs.
pub trait Ring: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}
impl<R: Copy + Add<Output = R> + Sub<Output = R> + Mul<Output = R>> Ring for R {}

/// The displacements without rounding, to which a certificate refers.
pub type ExactDisplacements = Displacements<DoubleComplex>;

impl From<&Target> for ExactDisplacements {
    /// Computes the displacements without rounding: the difference of two doubles is a double-double, and the scale
    /// is a power of two; turns are taken as they are. (A part below 2^-1022 of the scale may underflow; the bound of a residual covers it.)
    fn from(target: &Target) -> Self {
        let factor = target.scale.recip();
        let kind = target.displacements.kind;
        let delta = std::array::from_fn(|j| match quotient(kind, &target.half_turns, j) {
            Some(numerator) => numerator.into(),
            None => DoubleComplex::difference_of(target.points[j + 1], target.points[0])
                .times_power_of_two(factor),
        });
        ExactDisplacements { delta, starred: delta.map(DoubleComplex::conj), kind }
    }
}

/// Returns the unknowns as an array: x, y, a, b, x*, y*, a*, b*, T_1 .. T_8.
pub fn unknowns(of: &Solution) -> [Complex; UNKNOWNS] {
    let [[x, y], [a, b], [xs, ys], [as_, bs]] = [of.pins, of.grounds, of.pins_starred, of.grounds_starred];
    let pivots = [x, y, a, b, xs, ys, as_, bs];
    std::array::from_fn(|i| if i < PIVOTS { pivots[i] } else { of.rotations[i - PIVOTS] })
}

/// Returns the solution with these unknowns: the inverse of [`unknowns`].
pub fn solution(of: &[Complex; UNKNOWNS]) -> Solution {
    Solution {
        pins: [of[0], of[1]],
        grounds: [of[2], of[3]],
        pins_starred: [of[4], of[5]],
        grounds_starred: [of[6], of[7]],
        rotations: std::array::from_fn(|j| of[PIVOTS + j]),
    }
}

/// An equation, with the places of its unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equation {
    /// A link keeps its length from the first place to place j: p, g, p*, g*, T_j.
    Length([usize; 5]),
    /// A pin stays on its fixed line from the first place to place j: p, g, p*, g*, T_j.
    Line([usize; 5]),
    /// A ground pivot stays on its line of the coupler: p, g, p*, g*, T_j.
    CouplerLine([usize; 5]),
    /// The size of the normal of a slider's line is given: p, g, p*, g*.
    Normal([usize; 4]),
    /// The rotation of a pose is given, a quotient.
    Turn(usize),
    /// A ground pivot is given.
    Ground(usize),
    /// The starred twin of a ground pivot is given.
    GroundStarred(usize),
}

/// Returns equation `link` (0 of x and a, 1 of y and b) of entry j of the displacements; where that is no place, one of the
/// two equations of what is given there.
#[inline(always)]
pub fn equation<Z>(of: &Displacements<Z>, link: usize, j: usize) -> Equation {
    let kind = of.kind;
    if j < kind.places() {
        let places = [link, 2 + link, 4 + link, 6 + link, PIVOTS + j];
        match kind.closure {
            Closure::SliderCrank if link == 1 => Equation::Line(places),
            Closure::InvertedSliderCrank if link == 1 => Equation::CouplerLine(places),
            _ => Equation::Length(places),
        }
    } else if kind.is_normal(j) && link == 1 {
        Equation::Normal([1, 3, 5, 7])
    } else if j >= kind.lengths() {
        Equation::Turn(PIVOTS + kind.spare(j)[link])
    } else if link == 0 {
        Equation::Ground(2 + j - kind.places())
    } else {
        Equation::GroundStarred(6 + j - kind.places())
    }
}

/// Evaluates the polynomial of an equation; `one` is the number one.
#[inline(always)]
pub fn value<R: Ring>(equation: Equation, at: &[R; UNKNOWNS], delta: R, starred: R, one: R) -> R {
    match equation {
        Equation::Length(places) => length(places.map(|i| at[i]), delta, starred),
        Equation::Line(places) => line(places.map(|i| at[i]), delta, starred),
        Equation::CouplerLine(places) => coupler_line(places.map(|i| at[i]), delta, starred),
        Equation::Normal(places) => {
            let [p, g, ps, gs] = places.map(|i| at[i]);
            (starred * (p - g) + delta * (ps - gs)) - one
        }
        Equation::Turn(place) => at[place] * starred - delta,
        Equation::Ground(place) => at[place] - delta,
        Equation::GroundStarred(place) => at[place] - starred,
    }
}

/// Evaluates the derivatives of the polynomial of an equation, each with the place of its unknown; `one` is the number one.
#[inline(always)]
pub fn slopes<R: Ring + std::ops::Neg<Output = R>>(
    equation: Equation,
    at: &[R; UNKNOWNS],
    delta: R,
    starred: R,
    one: R,
) -> Vec<(usize, R)> {
    let of = |places: [usize; 5], derivatives: fn([R; 5], R, R) -> [R; 5]| {
        places.into_iter().zip(derivatives(places.map(|i| at[i]), delta, starred)).collect()
    };
    match equation {
        Equation::Length(places) => of(places, length_derivatives),
        Equation::Line(places) => of(places, line_derivatives),
        Equation::CouplerLine(places) => of(places, coupler_line_derivatives),
        Equation::Normal(places) => places.into_iter().zip([starred, -starred, delta, -delta]).collect(),
        Equation::Turn(place) => vec![(place, starred)],
        Equation::Ground(place) | Equation::GroundStarred(place) => vec![(place, one)],
    }
}

/// Evaluates f of a line: T M* and T M need no inverse.
#[inline(always)]
fn line<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> R {
    let (m, m_s) = (p * t + (delta - p), ps + (starred - ps) * t);
    (p - g) * m_s + (ps - gs) * (t * m)
}

/// Evaluates df/dp, df/dg, df/dp*, df/dg*, df/dT of a line.
#[inline(always)]
fn line_derivatives<R: Ring + std::ops::Neg<Output = R>>(
    [p, g, ps, gs, t]: [R; 5],
    delta: R,
    starred: R,
) -> [R; 5] {
    let (m, m_s) = (p * t + (delta - p), ps + (starred - ps) * t);
    let (v, v_s) = (p - g, ps - gs);
    [m_s + v_s * (t * t - t), -m_s, (v - v * t) + t * m, -(t * m), v * (starred - ps) + v_s * (m + t * p)]
}

/// Evaluates f of a coupler line.
#[inline(always)]
fn coupler_line<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> R {
    let (n, n_s) = ((g - delta) - g * t, (gs - starred) * t - gs);
    (p - g) * (t * n_s) + (ps - gs) * n
}

/// Evaluates df/dp, df/dg, df/dp*, df/dg*, df/dT of a coupler line.
#[inline(always)]
fn coupler_line_derivatives<R: Ring + std::ops::Neg<Output = R>>(
    [p, g, ps, gs, t]: [R; 5],
    delta: R,
    starred: R,
) -> [R; 5] {
    let (n, n_s) = ((g - delta) - g * t, (gs - starred) * t - gs);
    let (v, v_s) = (p - g, ps - gs);
    [t * n_s, (v_s - v_s * t) - t * n_s, n, v * (t * t - t) - n, v * (n_s + t * (gs - starred)) - v_s * g]
}

/// Evaluates f at one link and point.
#[inline(always)]
fn length<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> R {
    let (l, m) = (p * t + (delta - g), ps + (starred - gs) * t);
    l * m - t * ((p - g) * (ps - gs))
}

/// Evaluates df/dp, df/dg, df/dp*, df/dg*, df/dT at one link and point.
#[inline(always)]
fn length_derivatives<R: Ring>([p, g, ps, gs, t]: [R; 5], delta: R, starred: R) -> [R; 5] {
    let (reach, reach_starred) = (delta - g, starred - gs);
    let (l, m) = (p * t + reach, ps + reach_starred * t);
    let (u, v) = (p - g, ps - gs);
    [t * (m - v), t * v - m, l - t * u, t * (u - l), p * m + l * reach_starred - u * v]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discs::{Disc, Upper};
    use crate::refinement::{residual_error, residuals};
    use crate::target::{Kind, STEPS};
    use linkwright_arithmetic::streams::{Stream, stream, uniform};
    use num_bigint::BigInt;

    /// A whole number times 2^exponent.
    #[derive(Clone, Debug)]
    struct Dyadic(BigInt, i32);

    impl Dyadic {
        fn of(x: f64) -> Self {
            let bits = x.to_bits();
            let exponent = ((bits >> 52) & 0x7ff) as i32;
            let fraction = (bits & ((1 << 52) - 1)) as i64 | if exponent == 0 { 0 } else { 1 << 52 };
            let sign = if x < 0.0 { -1 } else { 1 };
            Dyadic(BigInt::from(sign * fraction), exponent.max(1) - 1075)
        }

        fn plus(&self, other: &Self, sign: i32) -> Self {
            let least = self.1.min(other.1);
            let raised = |of: &Self| of.0.clone() << (of.1 - least);
            Dyadic(raised(self) + raised(other) * sign, least)
        }

        fn times(&self, other: &Self) -> Self {
            Dyadic(&self.0 * &other.0, self.1 + other.1)
        }
    }

    /// An exact complex number.
    #[derive(Clone, Debug)]
    struct Exact(Dyadic, Dyadic);

    impl Exact {
        fn of(z: DoubleComplex) -> Self {
            let part = |hi: f64, lo: f64| Dyadic::of(hi).plus(&Dyadic::of(lo), 1);
            Exact(part(z.re.hi, z.re.lo), part(z.im.hi, z.im.lo))
        }

        fn plus(&self, other: &Self, sign: i32) -> Self {
            Exact(self.0.plus(&other.0, sign), self.1.plus(&other.1, sign))
        }

        fn times(&self, other: &Self) -> Self {
            Exact(
                self.0.times(&other.0).plus(&self.1.times(&other.1), -1),
                self.0.times(&other.1).plus(&self.1.times(&other.0), 1),
            )
        }

        /// Returns whether |z| <= bound.
        fn is_within(&self, bound: f64) -> bool {
            let square = self.0.times(&self.0).plus(&self.1.times(&self.1), 1);
            square.plus(&Dyadic::of(bound).times(&Dyadic::of(bound)), -1).0 <= BigInt::ZERO
        }
    }

    fn number(stream: &mut Stream) -> DoubleComplex {
        let size = 2.0_f64.powf(uniform(stream, -8.0, 8.0));
        let mut part = || uniform(stream, -size, size);
        let z = DoubleComplex::from(Complex::new(part(), part()));
        z + DoubleComplex::from(Complex::new(part(), part())).times_power_of_two(f64::EPSILON / 4.0)
    }

    #[test]
    fn a_residual_lies_within_its_bound_of_the_exact_one() {
        let mut needed = 0;
        for index in 0..100 {
            let mut stream = stream(1, index);
            let midpoint: [DoubleComplex; UNKNOWNS] = std::array::from_fn(|_| number(&mut stream));
            let displacements = ExactDisplacements {
                delta: std::array::from_fn(|_| number(&mut stream)),
                starred: std::array::from_fn(|_| number(&mut stream)),
                // Nine points, a mixture with poses and a given pivot, and eight points with a slider.
                kind: match index % 4 {
                    0 => Kind::default(),
                    1 => Kind::new(2, 1),
                    2 => Kind::of_points(Closure::SliderCrank),
                    _ => Kind::of_points(Closure::InvertedSliderCrank),
                },
            };
            let found = residuals(&displacements, &midpoint);
            for (row, of) in found.iter().enumerate() {
                let (link, j) = (row / STEPS, row % STEPS);
                let (delta, starred) =
                    (Exact::of(displacements.delta[j]), Exact::of(displacements.starred[j]));
                let at = |i: usize| Exact::of(midpoint[i]);
                let exact = match equation(&displacements, link, j) {
                    // The equation times T, in the form of the module: f = L M - T U V.
                    Equation::Length(places) => {
                        let [p, g, ps, gs, t] = places.map(at);
                        let l = p.times(&t).plus(&delta, 1).plus(&g, -1);
                        let m = starred.plus(&gs, -1).times(&t).plus(&ps, 1);
                        l.times(&m).plus(&t.times(&p.plus(&g, -1).times(&ps.plus(&gs, -1))), -1)
                    }
                    // v M* + v* T M, times out: v (p* - p* T + delta* T) + v* T (p T - p + delta).
                    Equation::Line(places) => {
                        let [p, g, ps, gs, t] = places.map(at);
                        let m = p.times(&t).plus(&p, -1).plus(&delta, 1);
                        let m_s = ps.plus(&ps.times(&t), -1).plus(&starred.times(&t), 1);
                        p.plus(&g, -1).times(&m_s).plus(&ps.plus(&gs, -1).times(&t).times(&m), 1)
                    }
                    // v T N* + v* N: v T (g* T - delta* T - g*) + v* (g - delta - g T).
                    Equation::CouplerLine(places) => {
                        let [p, g, ps, gs, t] = places.map(at);
                        let n = g.plus(&delta, -1).plus(&g.times(&t), -1);
                        let n_s = gs.times(&t).plus(&starred.times(&t), -1).plus(&gs, -1);
                        p.plus(&g, -1).times(&t).times(&n_s).plus(&ps.plus(&gs, -1).times(&n), 1)
                    }
                    Equation::Normal(places) => {
                        let [p, g, ps, gs] = places.map(at);
                        let sum = starred.times(&p.plus(&g, -1)).plus(&delta.times(&ps.plus(&gs, -1)), 1);
                        sum.plus(&Exact::of(Complex::ONE.into()), -1)
                    }
                    Equation::Turn(place) => at(place).times(&starred).plus(&delta, -1),
                    Equation::Ground(place) => at(place).plus(&delta, -1),
                    Equation::GroundStarred(place) => at(place).plus(&starred, -1),
                };
                let error = exact.plus(&Exact::of(*of), -1);
                let bound = residual_error(&displacements, &midpoint, link, j).get();
                assert!(error.is_within(bound), "{index} {row}");
                needed += usize::from(!error.is_within(bound / 2.0_f64.powi(16)));
            }
        }
        // The bound is 64 times that of the analysis for every operation, but no more than it should be.
        assert!(needed > 400, "{needed}");
    }

    #[test]
    fn derivatives_in_discs_hold_those_of_their_members() {
        for index in 0..300 {
            let mut stream = stream(2, index);
            let relative = 2.0_f64.powf(uniform(&mut stream, -60.0, -2.0));
            let mut both = || {
                let mid = number(&mut stream);
                let size = Upper::exactly(relative * mid.to_complex().norm());
                let turn = Complex::from_polar(size.get() * (1.0 - 1e-15), uniform(&mut stream, -3.0, 3.0));
                (Disc::about(mid, size), mid + DoubleComplex::from(turn))
            };
            let all: [_; 5] = std::array::from_fn(|_| both());
            let (delta, starred) = (both(), both());
            let (discs, members) = (all.map(|a| a.0), all.map(|a| a.1));
            let (of_discs, of_members): ([Disc; 5], [DoubleComplex; 5]) = match index % 3 {
                0 => (
                    length_derivatives(discs, delta.0, starred.0),
                    length_derivatives(members, delta.1, starred.1),
                ),
                1 => (
                    line_derivatives(discs, delta.0, starred.0),
                    line_derivatives(members, delta.1, starred.1),
                ),
                _ => (
                    coupler_line_derivatives(discs, delta.0, starred.0),
                    coupler_line_derivatives(members, delta.1, starred.1),
                ),
            };
            for (disc, member) in of_discs.into_iter().zip(of_members) {
                // A member's own rounding is 2^-95 of terms that are below 2^50; the discs' is above 2^-53 of them.
                let off = Exact::of(member).plus(&Exact::of(disc.mid.into()), -1);
                assert!(off.is_within(disc.radius.get()), "{index}");
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_polynomial() {
        let mut stream = stream(3, 0);
        let at: [DoubleComplex; 5] = std::array::from_fn(|_| number(&mut stream));
        let (delta, starred) = (number(&mut stream), number(&mut stream));
        type Function = fn([DoubleComplex; 5], DoubleComplex, DoubleComplex) -> DoubleComplex;
        type Derivatives = fn([DoubleComplex; 5], DoubleComplex, DoubleComplex) -> [DoubleComplex; 5];
        let all: [(Function, Derivatives); 3] = [
            (length, length_derivatives),
            (line, line_derivatives),
            (coupler_line, coupler_line_derivatives),
        ];
        for (function, derivatives) in all {
            for (i, slope) in derivatives(at, delta, starred).into_iter().enumerate() {
                // Quadratic in each unknown at most: the central difference is exact but for rounding.
                let by = DoubleComplex::from(Complex::new(0.25, 0.5));
                let (mut above, mut below) = (at, at);
                (above[i], below[i]) = (at[i] + by, at[i] - by);
                let difference =
                    (function(above, delta, starred) - function(below, delta, starred)) / (by + by);
                let (off, size) = ((difference - slope).to_complex().norm(), slope.to_complex().norm());
                assert!(off <= 1e-24 * (1.0 + size), "{i}: {off:e} of {size:e}");
            }
        }
    }
}
