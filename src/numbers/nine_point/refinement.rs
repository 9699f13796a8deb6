//! Newton's method with residuals in double-double: a solution to more digits than a double holds.
//!
//! The unknowns are measured in weights s_i, powers of two: the one at or above max(|w_i|, 1) for a pivot, at or above
//! |T_j| for a rotation. With the scaled Jacobian A = R J S (R brings the rows near one) and Y near its inverse, a step
//! is -S Y R f(m). The inverse is in doubles and renewed while steps are large; the residual and the sum are in
//! double-double, so each step with an old inverse still gains about ten digits.

use super::discs::Upper;
use super::polynomial::{
    Equation, ExactDisplacements, PIVOTS, UNKNOWNS, equation, slopes, solution, unknowns, value,
};
use super::target::{Displacements, STEPS, Solution, power_of_two_above};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::double_double::{DoubleComplex, RELATIVE_ERROR};
use nalgebra::SMatrix;
use thiserror::Error;

/// Sixteen unknowns as double-doubles.
pub(super) type Midpoint = [DoubleComplex; UNKNOWNS];
/// A matrix of the sixteen equations and unknowns.
pub(super) type Square = SMatrix<Complex, UNKNOWNS, UNKNOWNS>;

/// The largest magnitude of an unknown, 2^100, and the inverse of the smallest one of a rotation: no product then
/// overflows, and what underflows is less than [`UNDERFLOW`].
const LARGEST: f64 = (1_u128 << 100) as f64;
/// A bound above all that a residual can lose by underflow: each of fewer than 2^10 operations loses less than
/// 2^-1070, which later products multiply by less than 2^400.
const UNDERFLOW: f64 = f64::MIN_POSITIVE * LARGEST * LARGEST * LARGEST * LARGEST;
/// The largest number of Newton steps.
const MOST_STEPS: usize = 12;
/// The size of a step, in weights, below which it is the last rounding of a double-double.
const FINISHED: f64 = 1e-29;
/// The size of a step below which the inverse is good enough to be used again.
const SETTLED: f64 = 1e-9;
/// The last step, in weights, below which a solution counts as refined.
const CONVERGED: f64 = 1e-16;

/// A solution after Newton's method in double-double.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// The solution, rounded to doubles.
    pub solution: Solution,
    /// The largest component of the last Newton step, in weights: relative to max(|w_i|, 1) for pivots and to |T_j| for
    /// rotations, up to a factor of two.
    pub last_step: f64,
    /// The distance of the solution from the one given, in the same weights.
    pub moved: f64,
}

/// The reason for which Newton's method found no solution.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NotRefined {
    /// An unknown is not finite, above 1e30, or a rotation is below 1e-30.
    #[error("an unknown is out of range")]
    OutOfRange,
    /// The Jacobian has no inverse in doubles.
    #[error("the Jacobian is singular")]
    Singular,
    /// The steps did not become small.
    #[error("Newton's method does not converge: its last step is {last_step:.1e}")]
    Diverged {
        /// The last step, in weights.
        last_step: f64,
    },
}

/// Refines a solution by Newton's method with double-double residuals.
///
/// The displacements are any complex numbers, taken as exact. About 20 digits are right afterwards, and [`Solution`]
/// holds the first 16 of them, unless the Jacobian is singular to doubles. Nothing is proved: see
/// [`super::certificate`].
///
/// # Errors
///
/// When Newton's method does not converge.
pub fn refine(displacements: &Displacements, given: &Solution) -> Result<Refined, NotRefined> {
    let (midpoint, last_step, moved) = newton(&displacements.map(Into::into), given)?;
    Ok(Refined { solution: solution(&midpoint.map(DoubleComplex::to_complex)), last_step, moved })
}

/// Applies Newton's method; returns the refined solution, its last step, and its distance from the one given, both in
/// weights.
pub(super) fn newton(
    displacements: &ExactDisplacements,
    given: &Solution,
) -> Result<(Midpoint, f64, f64), NotRefined> {
    let given = unknowns(given);
    let mut midpoint: Midpoint = given.map(Into::into);
    let mut linear = Linearisation::at(displacements, &midpoint)?;
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let step = linear.step(displacements, &midpoint);
        let size = step.iter().map(|z| z.norm()).fold(0.0, f64::max);
        if size.is_nan() {
            return Err(NotRefined::OutOfRange);
        }
        if last_step < CONVERGED && size >= 0.5 * last_step {
            break;
        }
        for i in 0..UNKNOWNS {
            midpoint[i] = midpoint[i] - (step[i] * linear.weights[i]).into();
        }
        last_step = size;
        if size < FINISHED {
            break;
        }
        if size > SETTLED {
            linear = Linearisation::at(displacements, &midpoint)?;
        }
    }
    if last_step.is_nan() || last_step >= CONVERGED {
        return Err(NotRefined::Diverged { last_step });
    }
    let weights = weights(&midpoint)?;
    let off = |i: usize| (midpoint[i].to_complex() - given[i]).norm() / weights[i];
    Ok((midpoint, last_step, (0..UNKNOWNS).map(off).fold(0.0, f64::max)))
}

/// The scaled Jacobian's inverse at a point, in doubles, with its scaling.
pub(super) struct Linearisation {
    /// The weights s_i, powers of two.
    pub(super) weights: [f64; UNKNOWNS],
    /// The row scales R, powers of two: row 8 link + j.
    pub(super) rows: [f64; UNKNOWNS],
    /// The matrix Y, near the inverse of A = R J S.
    pub(super) inverse: Square,
}

impl Linearisation {
    pub(super) fn at(displacements: &ExactDisplacements, midpoint: &Midpoint) -> Result<Self, NotRefined> {
        let weights = weights(midpoint)?;
        let at = midpoint.map(DoubleComplex::to_complex);
        let mut rows = [1.0; UNKNOWNS];
        let mut scaled = Square::zeros();
        for (row, link, j) in equations() {
            let (delta, starred) =
                (displacements.delta[j].to_complex(), displacements.starred[j].to_complex());
            let slopes = slopes(equation(displacements, link, j), &at, delta, starred, Complex::ONE);
            let largest = slopes.iter().map(|(place, d)| (d * weights[*place]).norm()).fold(0.0, f64::max);
            if !(f64::MIN_POSITIVE * 2.0..=f64::MAX / 4.0).contains(&largest) {
                return Err(NotRefined::Singular);
            }
            rows[row] = power_of_two_above(largest).recip();
            for (place, slope) in slopes {
                scaled[(row, place)] = slope * weights[place] * rows[row];
            }
        }
        let inverse = scaled.try_inverse().ok_or(NotRefined::Singular)?;
        if inverse.iter().all(|z| z.re.is_finite() && z.im.is_finite()) {
            Ok(Linearisation { weights, rows, inverse })
        } else {
            Err(NotRefined::Singular)
        }
    }

    /// Computes Newton's step Y R f(m), in weights.
    fn step(&self, displacements: &ExactDisplacements, midpoint: &Midpoint) -> [Complex; UNKNOWNS] {
        let residual = residuals(displacements, midpoint);
        let mut step = [Complex::ZERO; UNKNOWNS];
        for (row, of) in residual.iter().enumerate() {
            let value = of.to_complex() * self.rows[row];
            for (sum, entry) in step.iter_mut().zip(self.inverse.column(row).iter()) {
                *sum += entry * value;
            }
        }
        step
    }
}

/// Iterates over the equations as (row, link, j), row = 8 link + j.
pub(super) fn equations() -> impl Iterator<Item = (usize, usize, usize)> {
    (0..UNKNOWNS).map(|row| (row, row / STEPS, row % STEPS))
}

/// Computes f(m), each component within [`residual_error`] of the exact one.
pub(super) fn residuals(displacements: &ExactDisplacements, midpoint: &Midpoint) -> Midpoint {
    std::array::from_fn(|row| {
        let (link, j) = (row / STEPS, row % STEPS);
        let (delta, starred) = (displacements.delta[j], displacements.starred[j]);
        value(equation(displacements, link, j), midpoint, delta, starred, Complex::ONE.into())
    })
}

/// Returns a bound of |computed f - f| at one row of [`residuals`].
///
/// With e = [`RELATIVE_ERROR`]: a complex sum errs by at most e times its own magnitude, a complex product by 4 e
/// times the product of magnitudes. With every difference replaced by the sum of magnitudes, L and M err by at most
/// (1 + 4 + 1) e, their product by (6 + 6 + 4) e, T (U V) by (1 + 1 + 4 + 4) e, and f by (16 + 1) e of their
/// majorants, but for terms in e^2; 32 e covers these as well. Of a slider's line M and N err by at most 6 e, a product with T
/// by 10 e, one with v by (10 + 1 + 4) e, and f by 16 e. The equation of a normal is two products of a difference, their sum and
/// a difference: 7 e. That of a turn is one product and one difference, that of
/// a given pivot one difference.
pub(super) fn residual_error(
    displacements: &ExactDisplacements,
    midpoint: &Midpoint,
    link: usize,
    j: usize,
) -> Upper {
    let size = |i: usize| Upper::magnitude_of_double(midpoint[i]);
    let delta = Upper::magnitude_of_double(displacements.delta[j]);
    let starred = Upper::magnitude_of_double(displacements.starred[j]);
    let majorant = match equation(displacements, link, j) {
        Equation::Length(places) => {
            let [p, g, ps, gs, t] = places.map(size);
            (p * t + (delta + g)) * (ps + (starred + gs) * t) + t * ((p + g) * (ps + gs))
        }
        Equation::Line(places) => {
            let [p, g, ps, gs, t] = places.map(size);
            (p + g) * (ps + (starred + ps) * t) + (ps + gs) * (t * (p * t + (delta + p)))
        }
        Equation::CouplerLine(places) => {
            let [p, g, ps, gs, t] = places.map(size);
            (p + g) * (t * ((gs + starred) * t + gs)) + (ps + gs) * (g + delta + g * t)
        }
        Equation::Normal(places) => {
            let [p, g, ps, gs] = places.map(size);
            starred * (p + g) + delta * (ps + gs) + Upper::exactly(1.0)
        }
        Equation::Turn(place) => size(place) * starred + delta,
        Equation::Ground(place) => size(place) + delta,
        Equation::GroundStarred(place) => size(place) + starred,
    };
    Upper::exactly(32.0 * RELATIVE_ERROR) * majorant + Upper::exactly(UNDERFLOW)
}

/// Computes the weights s_i, once every unknown is in range.
pub(super) fn weights(midpoint: &Midpoint) -> Result<[f64; UNKNOWNS], NotRefined> {
    let mut weights = [1.0; UNKNOWNS];
    for (i, weight) in weights.iter_mut().enumerate() {
        let size = midpoint[i].to_complex().norm();
        let least = if i < PIVOTS { 0.0 } else { LARGEST.recip() };
        if !(least..=LARGEST).contains(&size) {
            return Err(NotRefined::OutOfRange);
        }
        *weight = power_of_two_above(if i < PIVOTS { size.max(1.0) } else { size });
    }
    Ok(weights)
}
