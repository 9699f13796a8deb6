//! The proof that a solution of the sixteen equations exists and is the only one near.
//!
//! # Existence and uniqueness
//!
//! Let f be the polynomials of `exact::polynomial`, m a point of C^16, s_i > 0 weights, D the polydisc |w_i - m_i| <=
//! rho s_i, and R, S the diagonal matrices of row scales and weights. For any matrix Y put, in the norm
//! max_i |w_i| / s_i,
//!
//! ```text
//! beta = |S Y R f(m)|          alpha = sup |I - Y R J S| over the matrices J whose entries lie in the discs of f'(D)
//! ```
//!
//! If alpha < 1 and beta + alpha rho < rho, then G(w) = w - S Y R f(w) maps D into the polydisc of radius
//! beta + alpha rho about m, which lies inside D: for w in D, f(w) - f(m) = (integral of f' along the segment) (w -
//! m), and that integral is a matrix with entries in the discs, as discs are convex; so G(w) - m = -S Y R f(m) + S
//! (I - Y R J S) S^-1 (w - m). In the same way |G(w) - G(v)| <= alpha |w - v|. By Banach's theorem G has exactly
//! one fixed point in D. Y is regular, as alpha < 1 makes Y R J S regular; so the fixed points of G are the zeros
//! of f. This is Krawczyk's test. The zero w lies within beta / (1 - alpha) of m, as |w - m| = |G(w) - m| <= beta +
//! alpha |w - m|. No T_j of D is zero, which is checked, so the zeros are solutions of the equations in their
//! original form.
//!
//! m is a double-double, Y is any matrix of doubles, s_i and R are powers of two, and alpha and beta are upper bounds
//! with outward rounding ([`super::discs`]). The displacements are taken as exact; of a [`Target`] they are those of
//! the points as given: differences of doubles are double-doubles, and the scale is a power of two.
//!
//! [`super::conjugation`] proves whether it is real.
//!
//! # Limits of the proof
//!
//! It is not proved that no further solution exists outside the discs. That there are 1442 classes is the published
//! generic count, and so are the 279 of slider-cranks; 2220 inverted ones were counted by this program.
//!
//! Sources: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969)
//! 187-201; S. M. Rump, "Solving algebraic problems with high accuracy", in A new approach to scientific computation
//! (1983) 51-120; P. Breiding, K. Rose, S. Timme, "Certifying zeros of polynomial systems using interval arithmetic",
//! ACM Trans. Math. Softw. 49 (2023) 11.

use super::conjugation;
use super::conjugation::Reality;
use super::discs::{Disc, Upper};
use super::polynomial::{ExactDisplacements, PIVOTS, UNKNOWNS, equation, slopes, solution, unknowns};
use super::refinement::{
    Linearisation, Midpoint, NotRefined, Square, equations, newton, residual_error, residuals,
};
use super::target::{Closure, Displacements, Solution, Target};
use linkwright_arithmetic::Complex;
use rayon::prelude::*;
use thiserror::Error;

/// The radii of D, in weights, that are tried in turn. A wide disc proves more (it is the only solution within), a
/// narrow one is for solutions that are close together or far out.
const RADII: [f64; 4] = [1.0 / (1_u64 << 36) as f64, 1e-15, 1e-20, 1e-25];

/// The farthest that a solution may move under refinement, in weights; one that moves further was none to begin with.
const FARTHEST_MOVE: f64 = 1e-4;

/// A bound above the rounding error of any one entry of Y A - I, or of Y f, relative to the sum of the terms'
/// magnitudes: one part is a sum of at most 2 * 16 products and a one, so it errs by at most 34 u / (1 - 34 u) of the
/// sum, and both parts by sqrt 2 times that, in all less than 49 u < 2^-47.
const DOT_ERROR: f64 = 1.0 / (1_u64 << 47) as f64;

/// A solution with the proof that it exists and is the only one near; see the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// The solution, refined and rounded to doubles.
    pub refined: Solution,
    /// Every unknown of the exact solution lies within this of `refined`: pivots in units of the scale, rotations
    /// without unit.
    pub radius: f64,
    /// The radius rho: in the polydisc of this radius, in weights, about the refined point there is no other
    /// solution. The weight of a pivot w is max(|w|, 1), that of a rotation |T_j|, up to a factor of two.
    pub alone_within: f64,
    /// The contraction constant alpha, less than one: a condition of the proof.
    pub contraction: f64,
    /// The reality of the solution, as far as it is proved.
    pub reality: Reality,
    /// The distance by which refinement moved the solution given, in weights.
    pub moved: f64,
    /// For each unknown a disc that contains the exact solution.
    enclosure: [Disc; UNKNOWNS],
    /// The constraint of the second link.
    pub closure: Closure,
}

impl Certificate {
    /// Returns whether the solution is proved real.
    pub fn is_real(&self) -> bool {
        self.reality == Reality::Real
    }

    /// Returns discs that contain x, y, a, b, x*, y*, a*, b*, T_1 .. T_8 of the exact solution.
    pub fn enclosure(&self) -> &[Disc; UNKNOWNS] {
        &self.enclosure
    }
}

/// The reason for which a solution is not certified. It may be a solution all the same.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Refused {
    /// Newton's method finds no solution from it.
    #[error(transparent)]
    NotRefined(#[from] NotRefined),
    /// Newton's method finds a solution, but so far away that it is another one or the one given was poor.
    #[error("Newton's method ends {moved:.1e} away: that is not the solution given")]
    Moved {
        /// The distance, in weights.
        moved: f64,
    },
    /// Krawczyk's test fails.
    #[error("no contraction: {residual:.1e} + {contraction:.1e} * {radius:.1e} is not below {radius:.1e}")]
    NotContained {
        /// The radius rho of the polydisc in weights; the last one tried.
        radius: f64,
        /// The distance beta of the midpoint's image from the midpoint.
        residual: f64,
        /// The bound alpha of |I - Y J|.
        contraction: f64,
    },
    /// The polydisc allows a rotation of zero, or its radius is no positive number.
    #[error("a polydisc of radius {radius:.1e} is no ground for a proof")]
    Radius {
        /// The radius, in weights.
        radius: f64,
    },
}

/// Refines a solution and proves that it exists, for the nine points as given.
///
/// # Errors
///
/// When refinement or Krawczyk's test fails: that refutes nothing.
pub fn certify(target: &Target, given: &Solution) -> Result<Certificate, Refused> {
    certify_exact(&target.into(), given, true)
}

/// Certifies many solutions, as [`certify`], on all threads of the pool, in the order given: the digits do not depend
/// on the threads.
pub fn certify_all(target: &Target, given: &[Solution]) -> Vec<Result<Certificate, Refused>> {
    let displacements = ExactDisplacements::from(target);
    given.par_iter().map(|solution| certify_exact(&displacements, solution, true)).collect()
}

/// Certifies a solution, as [`certify`], for displacements of any kind, which are taken as exact. Its reality is left
/// undecided.
///
/// # Errors
///
/// As [`certify`].
pub fn certify_displacements(
    displacements: &Displacements,
    given: &Solution,
) -> Result<Certificate, Refused> {
    certify_exact(&displacements.map(Into::into), given, false)
}

/// Proves existence and uniqueness alone, without refinement, in the polydisc of `radius` (in weights) about
/// `midpoint`.
///
/// # Errors
///
/// When Krawczyk's test fails there.
pub fn check(target: &Target, midpoint: &Solution, radius: f64) -> Result<Certificate, Refused> {
    prove(&target.into(), &unknowns(midpoint).map(Into::into), &[radius], true)
}

fn certify_exact(
    displacements: &ExactDisplacements,
    given: &Solution,
    real_points: bool,
) -> Result<Certificate, Refused> {
    let (midpoint, _, moved) = newton(displacements, given)?;
    if moved > FARTHEST_MOVE {
        return Err(Refused::Moved { moved });
    }
    prove(displacements, &midpoint, &RADII, real_points).map(|proved| Certificate { moved, ..proved })
}

/// Applies Krawczyk's test at each radius in turn until one holds.
fn prove(
    displacements: &ExactDisplacements,
    midpoint: &Midpoint,
    radii: &[f64],
    real_points: bool,
) -> Result<Certificate, Refused> {
    let linear = Linearisation::at(displacements, midpoint)?;
    let magnitudes = linear.inverse.map(Upper::magnitude);
    let residual = residual_bound(displacements, midpoint, &linear, &magnitudes);
    let mut refusal = Refused::Radius { radius: 0.0 };
    for &radius in radii {
        if !no_rotation_is_zero(midpoint, &linear.weights, radius) {
            refusal = Refused::Radius { radius };
            continue;
        }
        let contraction = contraction_bound(displacements, midpoint, &linear, &magnitudes, radius);
        let image = residual + contraction * Upper::exactly(radius);
        if contraction.get() < 1.0 && image.get() < radius {
            // The solution lies within this of the midpoint, in weights.
            let error = residual.over((1.0 - contraction.get()).next_down());
            let errors = linear.weights.map(|weight| error * Upper::exactly(weight));
            let enclosure: [Disc; UNKNOWNS] = std::array::from_fn(|i| Disc::about(midpoint[i], errors[i]));
            let reality = if real_points {
                let radii = linear.weights.map(|weight| radius * weight);
                conjugation::reality(displacements, midpoint, &errors, &radii)
            } else {
                Reality::Undecided
            };
            return Ok(Certificate {
                refined: solution(&enclosure.map(|disc| disc.mid)),
                radius: enclosure.iter().map(|disc| disc.radius).fold(Upper::ZERO, Upper::max).get(),
                alone_within: radius,
                contraction: contraction.get(),
                reality,
                moved: 0.0,
                enclosure,
                closure: displacements.kind.closure,
            });
        }
        refusal = Refused::NotContained { radius, residual: residual.get(), contraction: contraction.get() };
    }
    Err(refusal)
}

/// Returns whether rho is positive, and |T_j| > rho s_j for all j.
fn no_rotation_is_zero(midpoint: &Midpoint, weights: &[f64; UNKNOWNS], radius: f64) -> bool {
    // The parts of lo are at most 2^-53 of those of hi, so |hi + lo| >= |larger part of hi| / 2 > rho s.
    radius > 0.0
        && (PIVOTS..UNKNOWNS).all(|i| {
            let t = midpoint[i].to_complex();
            t.re.abs().max(t.im.abs()) > 4.0 * radius * weights[i]
        })
}

/// Returns an upper bound of |S Y R f(m)| in weights: max_i |(Y R f(m))_i|.
fn residual_bound(
    displacements: &ExactDisplacements,
    midpoint: &Midpoint,
    linear: &Linearisation,
    magnitudes: &nalgebra::SMatrix<Upper, UNKNOWNS, UNKNOWNS>,
) -> Upper {
    let values = residuals(displacements, midpoint);
    let (mut near, mut spread) = ([Complex::ZERO; UNKNOWNS], [Upper::ZERO; UNKNOWNS]);
    for (row, link, j) in equations() {
        let value = values[row].to_complex() * linear.rows[row];
        let error = (residual_error(displacements, midpoint, link, j) + Upper::magnitude(values[row].rest()))
            * Upper::exactly(linear.rows[row])
            + Upper::exactly(DOT_ERROR) * Upper::magnitude(value)
            + Upper::exactly(f64::MIN_POSITIVE);
        for i in 0..UNKNOWNS {
            near[i] += linear.inverse[(i, row)] * value;
            spread[i] = spread[i] + magnitudes[(i, row)] * error + Upper::exactly(f64::MIN_POSITIVE);
        }
    }
    (0..UNKNOWNS).map(|i| Upper::magnitude(near[i]) + spread[i]).fold(Upper::ZERO, Upper::max)
}

/// Returns an upper bound of |I - Y R J S| for every J with entries in the discs of f'(D): the largest sum over a
/// row.
fn contraction_bound(
    displacements: &ExactDisplacements,
    midpoint: &Midpoint,
    linear: &Linearisation,
    magnitudes: &nalgebra::SMatrix<Upper, UNKNOWNS, UNKNOWNS>,
    radius: f64,
) -> Upper {
    let discs: [Disc; UNKNOWNS] =
        std::array::from_fn(|i| Disc::about(midpoint[i], Upper::exactly(radius * linear.weights[i])));
    // -I + Y A at the discs' midpoints, and for each row of A a bound of how far its entries may differ from there,
    // added up.
    let mut defect = -Square::identity();
    let mut spread = [Upper::ZERO; UNKNOWNS];
    for (row, link, j) in equations() {
        let delta = Disc::about(displacements.delta[j], Upper::ZERO);
        let starred = Disc::about(displacements.starred[j], Upper::ZERO);
        let one = Disc::point(Complex::ONE);
        let slopes = slopes(equation(displacements, link, j), &discs, delta, starred, one);
        for (place, slope) in slopes {
            let entry = slope.times_power_of_two(linear.weights[place]).times_power_of_two(linear.rows[row]);
            spread[row] =
                spread[row] + entry.radius + Upper::exactly(DOT_ERROR) * Upper::magnitude(entry.mid);
            for i in 0..UNKNOWNS {
                defect[(i, place)] += linear.inverse[(i, row)] * entry.mid;
            }
        }
    }
    (0..UNKNOWNS)
        .map(|i| {
            // The one of the identity is a term of the sums as well.
            let start = Upper::exactly(DOT_ERROR) + Upper::exactly(f64::MIN_POSITIVE);
            (0..UNKNOWNS)
                .fold(start, |sum, k| sum + Upper::magnitude(defect[(i, k)]) + magnitudes[(i, k)] * spread[k])
        })
        .fold(Upper::ZERO, Upper::max)
}
