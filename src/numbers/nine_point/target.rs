//! The problem, nine precision points, and its answer, a solution of the sixteen equations.

use linkwright_arithmetic::Complex;
use thiserror::Error;

/// The number of precision points beyond the first.
pub const STEPS: usize = 8;

/// delta_j = P_j - P_0 and their starred twins, j = 1 .. 8: the equations depend on nothing else of a target. Only
/// real points have delta*_j = conj(delta_j); a path from target to target through complex numbers has not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacements<Z = Complex> {
    /// The displacements delta_j.
    pub delta: [Z; STEPS],
    /// Their starred twins delta*_j.
    pub starred: [Z; STEPS],
}

impl<Z: Copy> Displacements<Z> {
    /// Returns the values of a function of each displacement.
    #[inline(always)]
    pub fn map<Y>(&self, of: impl Fn(Z) -> Y) -> Displacements<Y> {
        Displacements { delta: self.delta.map(&of), starred: self.starred.map(&of) }
    }

    /// Returns the values of a function of each displacement and the one in its place among `others`.
    pub fn zip<Y>(&self, others: &Self, of: impl Fn(Z, Z) -> Y) -> Displacements<Y> {
        let both = |one: &[Z; STEPS], other: &[Z; STEPS]| std::array::from_fn(|j| of(one[j], other[j]));
        Displacements {
            delta: both(&self.delta, &others.delta),
            starred: both(&self.starred, &others.starred),
        }
    }
}

/// Nine precision points, scaled by a power of two so that the farthest from the first is at a distance above 1/2 and
/// at most 1.
///
/// As the scale is a power of two, scaling rounds nothing: a proof for the scaled points holds for the points as
/// given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The points as given, in the order in which the path passes them.
    pub points: [Complex; STEPS + 1],
    /// The length, in units of the points, of one unit of a [`Solution`]: the least power of two that is not below
    /// max_j |P_j - P_0|.
    pub scale: f64,
    /// (P_j - P_0) / scale, rounded.
    pub displacements: Displacements,
}

/// The reason for which nine points are no target.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TargetError {
    /// A coordinate is not a finite number.
    #[error("point {point} is not finite")]
    NotFinite {
        /// Number of the point, from one.
        point: usize,
    },
    /// The points lie too far apart, or too near to each other, for the numbers of a computer.
    #[error("the points extend over {size:e}; it must be between 1e-200 and 1e200")]
    Extent {
        /// The extent max_j |P_j - P_0|.
        size: f64,
    },
    /// Two points coincide to rounding (closer than 1e-12 of the scale): the equations then have whole families of
    /// solutions.
    #[error("points {first} and {second} coincide")]
    Coincident {
        /// Number of the first point, from one.
        first: usize,
        /// Number of the second point, from one.
        second: usize,
    },
}

/// The distance, relative to the extent, within which two points count as one.
const COINCIDENT: f64 = 1e-12;

/// Between these extents neither a square nor its inverse leaves the range of a double.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-200..=1e200;

/// Returns the least power of two that is not below a positive normal number.
pub(super) fn power_of_two_above(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let below = f64::from_bits(x.to_bits() & EXPONENT);
    if below == x { below } else { 2.0 * below }
}

impl Target {
    /// Creates the target of nine points, in the order in which the path passes them.
    ///
    /// # Errors
    ///
    /// When a coordinate is not finite, two points coincide, or the points extend over more than 1e200 or less than
    /// 1e-200.
    pub fn new(points: [Complex; STEPS + 1]) -> Result<Self, TargetError> {
        for (at, point) in points.iter().enumerate() {
            if !(point.re.is_finite() && point.im.is_finite()) {
                return Err(TargetError::NotFinite { point: at + 1 });
            }
        }
        let size = points.iter().map(|p| (p - points[0]).norm()).fold(0.0, f64::max);
        if size > 0.0 && !EXTENTS.contains(&size) {
            return Err(TargetError::Extent { size });
        }
        for second in 1..points.len() {
            for first in 0..second {
                if (points[second] - points[first]).norm() <= COINCIDENT * size {
                    return Err(TargetError::Coincident { first: first + 1, second: second + 1 });
                }
            }
        }
        let scale = power_of_two_above(size);
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
    /// The starred twins x*, y* of the pins.
    pub pins_starred: [Complex; 2],
    /// The starred twins a*, b* of the ground pivots.
    pub grounds_starred: [Complex; 2],
    /// The rotations T_j: that of the coupler from the first point to point j.
    pub rotations: [Complex; STEPS],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_the_power_of_two_at_or_above_the_extent() {
        for (extent, scale) in [(1.0, 1.0), (1.5, 2.0), (2.0, 2.0), (0.7, 1.0), (3e100, 2.0_f64.powi(334))] {
            let points = std::array::from_fn(|j| Complex::new(extent * j as f64 / 8.0, 0.0));
            let target = Target::new(points).expect("nine points on a line");
            assert_eq!(target.scale, scale);
            assert_eq!(target.displacements.delta[7] * scale, Complex::new(extent, 0.0));
        }
    }

    #[test]
    fn points_that_no_number_can_hold_are_refused() {
        let points = |size: f64| std::array::from_fn(|j| Complex::new(size * j as f64, 0.0));
        assert!(matches!(Target::new(points(1e250)), Err(TargetError::Extent { .. })));
        assert!(matches!(Target::new(points(1e-250)), Err(TargetError::Extent { .. })));
        assert!(matches!(Target::new(points(0.0)), Err(TargetError::Coincident { first: 1, second: 2 })));
        assert!(matches!(Target::new(points(f64::NAN)), Err(TargetError::NotFinite { .. })));
    }
}
