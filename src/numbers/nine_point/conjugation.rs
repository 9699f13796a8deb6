//! The proof that a certified solution is real, or draws a real curve, or does neither.
//!
//! For real points (delta*_j = conj(delta_j)) the map
//!
//! ```text
//! sigma: (x, y, a, b, x*, y*, a*, b*, T_j)
//!     -> (conj x*, conj y*, conj a*, conj b*, conj x, conj y, conj a, conj b, 1 / conj T_j)
//! ```
//!
//! takes solutions to solutions: it conjugates each equation and swaps its two factors. Its fixed points are the real
//! linkages: x* = conj(x), .., |T_j| = 1. The exchange of the links, e: (x, a) <-> (y, b), and Roberts' map
//!
//! ```text
//! r: (x, a, y, b) -> ((x - a) y / (x - y), (b x - a y) / (x - y), a - x, a)    T_j -> (x T_j + delta_j - a) / (x - a)
//! ```
//!
//! (starred alike) take solutions to the others of their class, and sigma commutes with both. So sigma maps a class
//! to a class, and if to itself, then as one of the six; being an involution, as the identity or as one of the three
//! exchanges e, e r, e r^2 = r e (of a target with poses there are no cognates, and e alone is left; of seven
//! points with one pivot given e r, which leaves that pivot in its place; of others with given pivots none; of a slider-crank its one
//! cognate, of an inverted slider-crank none). The identity: the six solutions are real. An exchange: a curve that is real, as its
//! class is, drawn by linkages that are not.
//!
//! Let w be the solution, known to lie in an enclosure, and to be the only solution in the polydisc D. If the image
//! of the enclosure under sigma, sigma e, sigma e r or sigma r e lies in D, the image of w is a solution in D, so it
//! is w. If one component of the image is disjoint from that component of the enclosure, w is certainly not fixed.

use super::discs::{Disc, Upper};
use super::double_discs::DoubleDisc;
use super::polynomial::{ExactDisplacements, PIVOTS, UNKNOWNS};
use super::refinement::Midpoint;
use super::target::{Closure, Kind, STEPS};
use linkwright_arithmetic::Complex;

/// The effect of conjugation on a solution: found to rounding in a [`super::Class`], proved in a
/// [`super::Certificate`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reality {
    /// Real: a linkage of the plane, and so are its cognates.
    Real,
    /// In one class with its conjugate, but not real: a real coupler curve drawn by no real linkage.
    RealCurve,
    /// Neither: the conjugate is of another class.
    Complex,
    /// Not proved either way, or the displacements are not those of real points.
    Undecided,
}

/// A disc for each unknown.
type Enclosure = [DoubleDisc; UNKNOWNS];

/// The image of the solution under a map, as far as it is proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Image {
    Itself,
    Another,
    Unknown,
}

/// Decides the reality of the solution that lies within `errors` of the midpoint and is the only one within `radii`.
pub(super) fn reality(
    displacements: &ExactDisplacements,
    midpoint: &Midpoint,
    errors: &[Upper; UNKNOWNS],
    radii: &[f64; UNKNOWNS],
) -> Reality {
    let enclosure = std::array::from_fn(|i| DoubleDisc { mid: midpoint[i], radius: errors[i] });
    let image_of = |of: Option<Enclosure>, exchanged: bool| {
        let offsets = of.and_then(|of| conjugate_offsets(&of, midpoint, exchanged));
        offsets.map_or(Image::Unknown, |offsets| image(&offsets, errors, radii))
    };
    let by_identity = image_of(Some(enclosure), false);
    if by_identity == Image::Itself {
        return Reality::Real;
    }
    let mut by_exchanges = Vec::with_capacity(3);
    // Where a pivot is given, the links have places of their own; and cognates turn the coupler differently: where its turns
    // are given they are no solutions.
    if displacements.kind.pivots == 0 && !displacements.kind.slides() {
        by_exchanges.push(image_of(Some(enclosure), true));
    }
    if displacements.kind.closure == Closure::SliderCrank {
        by_exchanges.push(image_of(slider_cognate(displacements, &enclosure), false));
    } else if !displacements.kind.slides() && displacements.kind.poses == 0 && displacements.kind.pivots <= 1
    {
        by_exchanges.push(image_of(roberts(displacements, &enclosure), true));
    }
    if displacements.kind == Kind::default() {
        by_exchanges.push(image_of(roberts(displacements, &exchange(&enclosure)), false));
    }
    if by_identity == Image::Unknown {
        Reality::Undecided
    } else if by_exchanges.contains(&Image::Itself) {
        Reality::RealCurve
    } else if by_exchanges.contains(&Image::Unknown) {
        Reality::Undecided
    } else {
        Reality::Complex
    }
}

/// Compares an image with the solution, from discs that contain (image - midpoint).
fn image(offsets: &[Disc; UNKNOWNS], errors: &[Upper; UNKNOWNS], radii: &[f64; UNKNOWNS]) -> Image {
    let all = || (0..UNKNOWNS).map(|i| (offsets[i], errors[i], radii[i]));
    if all().all(|(offset, _, radius)| offset.magnitude().get() <= radius) {
        Image::Itself
    } else if all().any(|(offset, error, _)| offset.is_disjoint(&Disc { mid: Complex::ZERO, radius: error }))
    {
        Image::Another
    } else {
        Image::Unknown
    }
}

/// Applies the exchange e of the links to the discs.
fn exchange(of: &Enclosure) -> Enclosure {
    std::array::from_fn(|i| of[twin(i, 0, true)])
}

/// Returns the index of an unknown's twin (`starred` = 4) or its own (0), on the other link if these are exchanged.
fn twin(i: usize, starred: usize, exchanged: bool) -> usize {
    if i < PIVOTS { i ^ starred ^ usize::from(exchanged) } else { i }
}

/// Applies sigma to the discs, or sigma e, and subtracts the midpoint; `None` if the disc of a rotation cannot be
/// inverted.
fn conjugate_offsets(of: &Enclosure, midpoint: &Midpoint, exchanged: bool) -> Option<[Disc; UNKNOWNS]> {
    let mut offsets = [Disc::point(Complex::ZERO); UNKNOWNS];
    for (i, offset) in offsets.iter_mut().enumerate() {
        let conjugate = of[twin(i, 4, exchanged)].conj();
        let image = if i < PIVOTS { conjugate } else { conjugate.inverse()? };
        *offset = (image - DoubleDisc::point(midpoint[i])).rounded();
    }
    Some(offsets)
}

/// Gives the image of a cognate map its rotations, those of the crank: (x T_j + delta_j - a)/(x - a); `None` if x = a cannot be
/// excluded.
fn rotations_of_the_crank(
    displacements: &ExactDisplacements,
    of: &Enclosure,
    image: &mut Enclosure,
) -> Option<()> {
    let (x, a) = (of[0], of[2]);
    let per_crank = (x - a).inverse()?;
    for j in 0..displacements.kind.places() {
        let delta = DoubleDisc::point(displacements.delta[j]);
        image[PIVOTS + j] = (x * of[PIVOTS + j] + delta - a) * per_crank;
    }
    Some(())
}

/// Applies Roberts' map r to the discs; `None` if x = y or x = a cannot be excluded.
fn roberts(displacements: &ExactDisplacements, of: &Enclosure) -> Option<Enclosure> {
    let mut image = *of;
    for first in [0, 4] {
        let [x, y, a, b] = [0, 1, 2, 3].map(|i| of[first + i]);
        let per_side = (x - y).inverse()?;
        let pivots = [(x - a) * y * per_side, a - x, (b * x - a * y) * per_side, a];
        image[first..first + 4].copy_from_slice(&pivots);
    }
    rotations_of_the_crank(displacements, of, &mut image)?;
    Some(image)
}

/// Applies the map to a slider-crank's cognate ([`super::classes`]) to the discs; `None` if x = y, x = a or a normal of no size
/// cannot be excluded.
fn slider_cognate(displacements: &ExactDisplacements, of: &Enclosure) -> Option<Enclosure> {
    let mut image = *of;
    let [n, n_s] = [displacements.delta, displacements.starred].map(|z| DoubleDisc::point(z[STEPS - 1]));
    let twin = |first: usize| {
        let [x, y, a, b] = [0, 1, 2, 3].map(|i| of[first + i]);
        let k = x * (x - y).inverse()?;
        Some((a - x, a - x + k * (x - a), a, k * (y - b)))
    };
    let (one, other) = (twin(0)?, twin(4)?);
    let size = (n_s * one.3 + n * other.3).inverse()?;
    for (first, (x, y, a, v)) in [(0, one), (4, other)] {
        image[first..first + 4].copy_from_slice(&[x, y, a, y - v * size]);
    }
    rotations_of_the_crank(displacements, of, &mut image)?;
    Some(image)
}
