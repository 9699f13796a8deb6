//! The driving dyad of poses with given crank angles, by linear least squares.
//!
//! With the turns psi_j of the crank from a common start, P_j = A + K e^{i psi_j} + Z Q_j: the fixed pivot A, the crank K and
//! the body's origin from its pin, Z, enter linearly. Three poses are met exactly (three complex equations), more nearly.

use crate::mechanism::{Complex, Dyad, Pose};

/// The part of a column's length below which its remainder after projecting off the other one is rounding.
const SINGULAR: f64 = 1e-12;

/// A crank with its pin in the body, and its direction where its turn is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driving {
    /// The crank, as an RR dyad.
    pub dyad: Dyad,
    /// The crank's direction from the x axis at the turn 0, in radians.
    pub angle: f64,
}

/// Returns the dyad that drives the body through `poses` at the crank's `turns` (radians) with the least weighted sum of
/// squared errors of the places; `None` with fewer than three poses, or if turns or poses do not determine it.
///
/// # Panics
/// If there are fewer turns or weights than poses.
///
/// ```
/// # use linkwright::internals::mechanism::{Complex, Dyad, Pose};
/// # use linkwright::internals::synthesis::dyads::driving_dyad;
/// // A crank of length 2 about (1, 0) carries the body at its pin (0, -3); the body turns by a third as much.
/// let (pivot, pin) = (Complex::new(1.0, 0.0), Complex::new(0.0, -3.0));
/// let turns = [0.0, 0.6, 1.5, 2.4];
/// let pose = |turn: &f64| {
///     let direction = Complex::from_polar(1.0, turn / 3.0);
///     Pose { position: pivot + Complex::from_polar(2.0, 0.4 + turn) - direction * pin, direction }
/// };
/// let found = driving_dyad(&turns.each_ref().map(pose), &turns, &[1.0; 4]).unwrap();
/// let Dyad::RR { pin: m, pivot: g, length } = found.dyad else { unreachable!() };
/// assert!((m - pin).norm() + (g - pivot).norm() < 1e-12);
/// assert!((length - 2.0).abs() + (found.angle - 0.4).abs() < 1e-12);
/// ```
pub fn driving_dyad(poses: &[Pose], turns: &[f64], weights: &[f64]) -> Option<Driving> {
    if poses.len() < 3 {
        return None;
    }
    let total: f64 = weights.iter().take(poses.len()).sum();
    let mean =
        |of: &dyn Fn(usize) -> Complex| (0..poses.len()).map(|j| of(j) * weights[j]).sum::<Complex>() / total;
    let crank = |j: usize| Complex::from_polar(1.0, turns[j]);
    let (place, body) = (|j: usize| poses[j].position, |j: usize| poses[j].direction);
    let (of_crank, of_place, of_body) = (mean(&crank), mean(&place), mean(&body));
    let dot = |one: &dyn Fn(usize) -> Complex, other: &dyn Fn(usize) -> Complex| {
        mean(&|j| one(j).conj() * other(j))
    };
    let (e, q, p) =
        (|j: usize| crank(j) - of_crank, |j: usize| body(j) - of_body, |j: usize| place(j) - of_place);
    let e_sq = dot(&e, &e).re;
    if e_sq <= SINGULAR {
        return None;
    }
    let along = dot(&e, &q) / e_sq;
    let rest = |j: usize| q(j) - e(j) * along;
    let rest_sq = dot(&rest, &rest).re;
    if rest_sq.is_nan() || rest_sq <= SINGULAR {
        return None;
    }
    let z = dot(&rest, &p) / rest_sq;
    let k = dot(&e, &p) / e_sq - z * along;
    let pivot = of_place - k * of_crank - z * of_body;
    let length = k.norm();
    (length > 0.0 && length.is_finite())
        .then(|| Driving { dyad: Dyad::RR { pin: -z, pivot, length }, angle: k.arg() })
}
