//! What is asked (nine points) and what answers it (a solution of the sixteen equations).

use crate::linkage::Complex;
use thiserror::Error;

/// The number of precision points beyond the first.
pub const STEPS: usize = 8;

/// delta_j = P_j - P_0 and their starred twins, j = 1 .. 8: all that the equations know of a target. Only real points
/// have delta*_j = conj(delta_j); a path from target to target through complex numbers has not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacements {
    /// delta_j.
    pub delta: [Complex; STEPS],
    /// delta*_j.
    pub starred: [Complex; STEPS],
}

/// Nine precision points, scaled so that the farthest from the first is at distance one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The points as given, in the order in which the path passes them.
    pub points: [Complex; STEPS + 1],
    /// Length units of the points that are one unit of a [`Solution`]: max_j |P_j - P_0| > 0.
    pub scale: f64,
    /// (P_j - P_0) / scale.
    pub displacements: Displacements,
}

/// Why nine points are no target.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TargetError {
    /// A coordinate is not a finite number.
    #[error("point {point} is not finite")]
    NotFinite {
        /// Its number, from one.
        point: usize,
    },
    /// Two points coincide to rounding (closer than 1e-12 of the scale): the equations then have whole families of
    /// solutions.
    #[error("points {first} and {second} coincide")]
    Coincident {
        /// The number of one, from one.
        first: usize,
        /// The number of the other.
        second: usize,
    },
}

/// Points closer than this, in units of the scale, are one point.
const COINCIDENT: f64 = 1e-12;

impl Target {
    /// # Errors
    ///
    /// When a coordinate is not finite or two points coincide.
    pub fn new(points: [Complex; STEPS + 1]) -> Result<Self, TargetError> {
        for (at, point) in points.iter().enumerate() {
            if !(point.re.is_finite() && point.im.is_finite()) {
                return Err(TargetError::NotFinite { point: at + 1 });
            }
        }
        let scale = points.iter().map(|p| (p - points[0]).norm()).fold(0.0, f64::max);
        for second in 1..points.len() {
            for first in 0..second {
                if (points[second] - points[first]).norm() <= COINCIDENT * scale {
                    return Err(TargetError::Coincident { first: first + 1, second: second + 1 });
                }
            }
        }
        let delta: [Complex; STEPS] = std::array::from_fn(|j| (points[j + 1] - points[0]) / scale);
        Ok(Target { points, scale, displacements: Displacements { delta, starred: delta.map(|d| d.conj()) } })
    }
}

/// A solution of the sixteen equations, in the frame of P_0 and in units of [`Target::scale`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// The moving pins x, y at the first point.
    pub pins: [Complex; 2],
    /// The ground pivots a of x and b of y.
    pub grounds: [Complex; 2],
    /// x*, y*.
    pub pins_starred: [Complex; 2],
    /// a*, b*.
    pub grounds_starred: [Complex; 2],
    /// T_j, the rotation of the coupler from the first point to point j.
    pub rotations: [Complex; STEPS],
}
