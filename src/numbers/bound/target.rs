//! The target, prepared for bounds: T', its length, and the directions that the linear unknowns take away.
//!
//! With P_j = A + K e_j + Z u_j the span of 1 and e_j = e^{i (phi_0 + s Delta_j)} does not depend on phi_0. T' is the
//! target off that span, S = |T'|^2 and tau = T'/|T'|.

use super::ball::Ball;
use linkwright_leaves::{Axis, Line};

/// The largest number of points of a target: the arrays of a box are on the stack.
pub const MAX_POINTS: usize = 64;

/// The reason for which there is no certificate for a target.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TargetError {
    /// The number of points is too small or too large.
    #[error("{points} points: a certificate needs from 5 to {MAX_POINTS}")]
    Points {
        /// The number of points.
        points: usize,
    },
    /// The crank angles are all alike, or a fit by A and K alone is nearly exact.
    #[error("the crank angles or the points are too much alike: the figures of a bound would be rounding")]
    Degenerate,
}

/// The points of a target (all, or all but one), in one direction of the crank.
#[derive(Clone, Debug)]
pub struct Target {
    /// The turn of the crank at each point, e^{i turn}.
    pub(super) turn: Vec<[Ball; 2]>,
    /// The unit vectors 1/sqrt n, e' and tau, rounded.
    pub(super) basis: [Vec<[f64; 2]>; 3],
    /// The squared length |T'|^2.
    pub(super) size_sq: Ball,
    /// An upper bound of the distance of each rounded basis vector from the exact one.
    pub(super) basis_error: f64,
    /// <e'/|e'|, T>: the part of T that e' takes away.
    pub(super) along: [Ball; 2],
    /// The length |e'|.
    pub(super) crank: Ball,
    /// Whether A is known: then ' takes away nothing, and the first basis vector is 0.
    pub(super) pivot_known: bool,
}

type BallVector = Vec<[Ball; 2]>;

/// Computes the inner product <b, v> = sum conj(b_j) v_j.
fn product(b: &BallVector, v: &BallVector) -> [Ball; 2] {
    b.iter().zip(v).fold([Ball::exact(0.0); 2], |[re, im], (b, v)| {
        [re + b[0] * v[0] + b[1] * v[1], im + b[0] * v[1] - b[1] * v[0]]
    })
}

fn without(v: &BallVector, b: &BallVector) -> BallVector {
    let [re, im] = product(b, v);
    b.iter().zip(v).map(|(b, v)| [v[0] - (b[0] * re - b[1] * im), v[1] - (b[0] * im + b[1] * re)]).collect()
}

fn norm_sq(v: &BallVector) -> Ball {
    v.iter().fold(Ball::exact(0.0), |sum, v| sum + v[0].square() + v[1].square())
}

fn unit(v: &BallVector) -> BallVector {
    let norm = norm_sq(v).root();
    v.iter().map(|v| [v[0].over(norm), v[1].over(norm)]).collect()
}

/// Encloses e^{i direction angle} of an angle in degrees.
fn unit_at(deg: f64, direction: f64) -> [Ball; 2] {
    // pi/180 and its rounding; the angle is first brought to at most half a turn, exactly.
    let degree = Ball { mid: std::f64::consts::PI / 180.0, rad: 4e-18 };
    let rest = deg % 360.0;
    let rest = Ball::exact(rest) - Ball::exact(if rest.abs() > 180.0 { rest.signum() * 360.0 } else { 0.0 });
    let angle = rest * degree * Ball::exact(direction.signum());
    // cos and sin are 1-Lipschitz.
    Ball::cos_sin(angle.mid).map(|b| Ball { mid: b.mid, rad: b.rad + 2.0 * angle.rad })
}

impl Target {
    /// Creates the target of points with the crank's increments in degrees, in the direction of the crank (+1 or -1).
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn new(points: &[[f64; 2]], turns_deg: &[f64], direction: f64) -> Result<Self, TargetError> {
        Target::placed(points, turns_deg, direction, None)
    }

    /// Creates the target of points with crank angles from the x axis and the known pivots; if the ground line is
    /// known, all is turned so that it is the x axis.
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn on_axis(points: &[[f64; 2]], angles_deg: &[f64], axis: &Axis) -> Result<Self, TargetError> {
        Target::placed(points, angles_deg, 1.0, Some(axis))
    }

    fn placed(
        points: &[[f64; 2]],
        turns_deg: &[f64],
        direction: f64,
        axis: Option<&Axis>,
    ) -> Result<Self, TargetError> {
        let (pivot, line) = axis.map_or((None, None), |axis| (axis.pivot, axis.line));
        let n = points.len();
        if !(4..=MAX_POINTS).contains(&n) || turns_deg.len() != n {
            return Err(TargetError::Points { points: n });
        }
        let from = pivot.unwrap_or_default().map(Ball::exact);
        let from_pivot = |p: &[f64; 2]| match pivot {
            Some(_) => [Ball::exact(p[0]) - from[0], Ball::exact(p[1]) - from[1]],
            None => p.map(Ball::exact),
        };
        let mut turn: BallVector = turns_deg.iter().map(|&deg| unit_at(deg, direction)).collect();
        let mut points: BallVector = points.iter().map(from_pivot).collect();
        if let Some(line) = line {
            let along = match line {
                Line::Angle(deg) => unit_at(deg, 1.0),
                Line::To(b) => {
                    let [x, y] = from_pivot(&b);
                    let length = (x.square() + y.square()).root();
                    [x.over(length), y.over(length)]
                }
            };
            for v in turn.iter_mut().chain(&mut points) {
                *v = [v[0] * along[0] + v[1] * along[1], v[1] * along[0] - v[0] * along[1]];
            }
        }
        let zero = Ball::exact(0.0);
        let first = match pivot {
            Some(_) => vec![[zero; 2]; n],
            None => unit(&vec![[Ball::exact(1.0), zero]; n]),
        };
        let crank = without(&turn, &first);
        let second = unit(&crank);
        let centred = without(&points, &first);
        let along = product(&second, &centred);
        let rest = without(&centred, &second);
        let size_sq = norm_sq(&rest);
        let basis = [first, second, unit(&rest)];
        let error = |b: &BallVector| {
            b.iter().map(|b| b[0].rad * b[0].rad + b[1].rad * b[1].rad).sum::<f64>().sqrt() * 1.001
        };
        let basis_error =
            basis.iter().map(error).fold(0.0, |worst: f64, e| if e <= worst { worst } else { e });
        if !(basis_error < 1e-9 && size_sq.low() > 0.0) {
            return Err(TargetError::Degenerate);
        }
        let basis = basis.map(|b| b.iter().map(|b| [b[0].mid, b[1].mid]).collect());
        let (crank, pivot_known) = (norm_sq(&crank).root(), pivot.is_some());
        Ok(Target { turn, basis, size_sq, basis_error, along, crank, pivot_known })
    }

    /// Returns the number of points.
    pub(super) fn len(&self) -> usize {
        self.turn.len()
    }

    /// Returns a lower bound of S.
    pub fn size_sq(&self) -> f64 {
        self.size_sq.low()
    }
}
