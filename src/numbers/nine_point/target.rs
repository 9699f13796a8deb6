//! The problem, precision points, poses and given pivots, and its answer, a solution of the sixteen equations.

use linkwright_arithmetic::Complex;
use thiserror::Error;

/// The number of precision points beyond the first, where there are neither poses nor given pivots.
pub const STEPS: usize = 8;
/// The largest number of poses beyond the first.
pub const MOST_POSES: usize = STEPS / 2;

/// The constraint that closes the loop: that of the coupler's second link (y, b). The first is a crank, (x, a).
///
/// With v = y - b and M_j = y (T_j - 1) + delta_j, starred alike (the twin of T_j is 1 / T_j), it is at place j
///
/// ```text
/// four-bar                  v M_j* + v* M_j + M_j M_j* = 0
/// slider-crank              v M_j* + v* M_j = 0
/// inverted slider-crank     v N_j* + v* N_j = 0      N_j = (b - delta_j) / T_j - b
/// ```
///
/// The second is the limit of the first for a pivot b at infinity: the pin y runs on a fixed line, of which v is a normal. The
/// third is the second seen from the coupler: the fixed pivot b slides on a line of it, of which v is a normal at the first
/// place. Only the direction of v matters, so that it has an equation of its own, n* v + n v* = 1 with given n and n*.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Closure {
    /// Four-bar linkage: the link keeps its length.
    #[default]
    FourBar,
    /// Slider-crank: a pin of the coupler runs on a fixed line (a PR dyad).
    SliderCrank,
    /// Inverted slider-crank: a line of the coupler slides through a fixed pivot (an RP dyad).
    InvertedSliderCrank,
}

/// A kind of exact problem: p poses beyond the first and q given ground pivots leave n = 8 - 2 p - 2 q points beyond the
/// first place, one less where there is a slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kind {
    /// The number p of poses beyond the first.
    pub poses: usize,
    /// The number q of ground pivots that are given: of neither link, of the first, of both.
    pub pivots: usize,
    /// The constraint of the second link.
    pub closure: Closure,
}

impl Kind {
    /// Returns the kind of four-bars with so many poses beyond the first and given ground pivots.
    pub const fn new(poses: usize, pivots: usize) -> Kind {
        Kind { poses, pivots, closure: Closure::FourBar }
    }

    /// Returns the kind of linkages with this closure through points alone: nine of a four-bar, else eight.
    pub const fn of_points(closure: Closure) -> Kind {
        Kind { poses: 0, pivots: 0, closure }
    }

    /// Returns whether the second link has a slider.
    #[inline(always)]
    pub fn slides(self) -> bool {
        self.closure != Closure::FourBar
    }

    /// Returns whether an entry of [`Displacements`] holds n and n* of the equation of v: the last one, where there is a slider.
    #[inline(always)]
    pub fn is_normal(self, j: usize) -> bool {
        self.slides() && j == STEPS - 1
    }

    /// Returns the number of points beyond the first place.
    #[inline(always)]
    pub fn points(self) -> usize {
        STEPS - 2 * (self.poses + self.pivots) - self.slides() as usize
    }

    /// Returns the number of places of the coupler beyond the first: points, then poses.
    #[inline(always)]
    pub fn places(self) -> usize {
        self.points() + self.poses
    }

    /// Returns the number of entries of [`Displacements`] that are lengths: those of places, then given pivots.
    #[inline(always)]
    pub fn lengths(self) -> usize {
        self.places() + self.pivots
    }

    /// Returns the entry that holds the turn of a pose.
    #[inline(always)]
    pub fn turn(self, pose: usize) -> usize {
        self.lengths() + pose
    }

    /// Returns, for an entry that holds no place, the two rotations that are no unknowns of their own: the one in the place
    /// that belongs to the entry, and that in the entry's own place, which for n and n* are one.
    #[inline(always)]
    pub fn spare(self, j: usize) -> [usize; 2] {
        if self.is_normal(j) {
            return [j, j];
        }
        // A turn belongs to its pose, a spare entry to its pivot.
        if j < self.turn(self.poses) {
            [j - self.lengths() + self.points(), j]
        } else {
            [j - self.turn(self.poses) + self.places(), j]
        }
    }
}

/// delta_j = P_j - P_0 and their starred twins: the equations depend on nothing else of a target. Only real targets have
/// delta*_j = conj(delta_j); a path from target to target through complex numbers has not.
///
/// The entries hold, in this order: the n points; the p poses; the q given pivots, a and a* relative to P_0; the turn of
/// each pose from the first as a quotient, T = delta / starred, which in a real target are a number w and its conjugate, so
/// that |T| = 1 without rounding; for each given pivot a quotient of no meaning, one over one; and where there is a slider n
/// and n* of [`Closure`], in a real target conjugates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacements<Z = Complex> {
    /// The displacements delta_j, given pivots, and the numerators of the turns.
    pub delta: [Z; STEPS],
    /// Their starred twins, and the denominators of the turns.
    pub starred: [Z; STEPS],
    /// The kind of problem, which says what each entry holds.
    pub kind: Kind,
}

impl<Z: Copy> Displacements<Z> {
    /// Returns the values of a function of each displacement.
    #[inline(always)]
    pub fn map<Y>(&self, of: impl Fn(Z) -> Y) -> Displacements<Y> {
        Displacements { delta: self.delta.map(&of), starred: self.starred.map(&of), kind: self.kind }
    }

    /// Returns the values of a function of each displacement and the one in its place among `others`.
    pub fn zip<Y>(&self, others: &Self, of: impl Fn(Z, Z) -> Y) -> Displacements<Y> {
        let both = |one: &[Z; STEPS], other: &[Z; STEPS]| std::array::from_fn(|j| of(one[j], other[j]));
        Displacements {
            delta: both(&self.delta, &others.delta),
            starred: both(&self.starred, &others.starred),
            kind: self.kind,
        }
    }
}

impl Displacements {
    /// Returns delta multiplied by `by` and delta* by `by_starred`; turns have no unit, and n and n* that of a reciprocal length.
    pub fn in_other_units(&self, by: Complex, by_starred: Complex) -> Self {
        let mut other = *self;
        for j in 0..self.kind.lengths() {
            other.delta[j] = self.delta[j] * by;
            other.starred[j] = self.starred[j] * by_starred;
        }
        if self.kind.slides() {
            // n* v + n v* stays as it is.
            other.delta[STEPS - 1] = self.delta[STEPS - 1] / by_starred;
            other.starred[STEPS - 1] = self.starred[STEPS - 1] / by;
        }
        other
    }
}

/// n of a real target. Lines along it have no solution v of n* v + n v* = 1: a direction that none is likely to have.
const NORMAL: Complex = Complex::new(0.27, 0.42);

/// Nine precision points, or points and poses, scaled by a power of two so that the farthest from the first is at a
/// distance above 1/2 and at most 1.
///
/// As the scale is a power of two, scaling rounds nothing: a proof for the scaled points holds for the points as
/// given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The points as given, in the order in which the path passes them. With poses: the first pose, the points, the other
    /// poses, the given ground pivots, and zeros.
    pub points: [Complex; STEPS + 1],
    /// For each pose beyond the first a number w with w / w* = e^{i theta}, theta its turn from the first pose.
    pub half_turns: [Complex; MOST_POSES],
    /// The length, in units of the points, of one unit of a [`Solution`]: the least power of two that is not below
    /// max_j |P_j - P_0|.
    pub scale: f64,
    /// (P_j - P_0) / scale, rounded.
    pub displacements: Displacements,
}

/// The reason for which points and poses are no target.
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
    /// The number of points and poses is not one that has a finite number of answers.
    #[error(
        "{points} points, {poses} poses and {pivots} given pivots: twice the poses and the pivots and the points must make \
         ten"
    )]
    Number {
        /// The number of points without an angle.
        points: usize,
        /// The number of poses, the first included.
        poses: usize,
        /// The number of given ground pivots.
        pivots: usize,
    },
    /// Both given pivots are one.
    #[error("both given pivots are one")]
    OnePivot,
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
        Self::of(points, [Complex::ZERO; MOST_POSES], Kind::default())
    }

    /// Creates the target of a first pose, of points, of poses, each with its turn from the first in radians, and of given
    /// ground pivots: points and twice the poses and the pivots must make eight.
    ///
    /// # Errors
    ///
    /// When their numbers are others, a number is not finite, two points coincide, or two poses do, or a point and a pose, or
    /// both pivots, or all places lie within 1e-200, or extend over more than 1e200.
    pub fn mixed(
        first: Complex,
        points: &[Complex],
        poses: &[(Complex, f64)],
        pivots: &[Complex],
    ) -> Result<Self, TargetError> {
        let kind = Kind::new(poses.len(), pivots.len());
        if kind.poses + kind.pivots > MOST_POSES || kind.pivots > 2 || points.len() != kind.points() {
            return Err(TargetError::Number {
                points: points.len(),
                poses: poses.len() + 1,
                pivots: pivots.len(),
            });
        }
        let (mut all, mut half_turns) = ([Complex::ZERO; STEPS + 1], [Complex::ZERO; MOST_POSES]);
        let places = points.iter().copied().chain(poses.iter().map(|pose| pose.0));
        for (place, given) in
            all.iter_mut().zip(std::iter::once(first).chain(places).chain(pivots.iter().copied()))
        {
            *place = given;
        }
        for (half, (_, angle)) in half_turns.iter_mut().zip(poses) {
            *half = Complex::from_polar(1.0, 0.5 * angle.rem_euclid(std::f64::consts::TAU));
        }
        if let [one, other] = pivots
            && one == other
        {
            return Err(TargetError::OnePivot);
        }
        Self::of(all, half_turns, kind)
    }

    /// Creates the target of eight points of a linkage with a slider, in the order in which the path passes them.
    ///
    /// Lines at 57.265 degrees, the direction of the n of [`Closure`], have no normal of the size asked for: a slider-crank on one, and
    /// an inverted slider-crank whose coupler line lies so at the first point, is not found.
    ///
    /// # Errors
    ///
    /// As [`Target::new`].
    ///
    /// # Panics
    /// When the closure is that of a four-bar, which has nine points.
    pub fn with_slider(points: [Complex; STEPS], closure: Closure) -> Result<Self, TargetError> {
        assert!(closure != Closure::FourBar, "a four-bar has nine points");
        let mut all = [Complex::ZERO; STEPS + 1];
        all[..STEPS].copy_from_slice(&points);
        Self::of(all, [Complex::ZERO; MOST_POSES], Kind::of_points(closure))
    }

    fn of(
        points: [Complex; STEPS + 1],
        half_turns: [Complex; MOST_POSES],
        kind: Kind,
    ) -> Result<Self, TargetError> {
        let is_finite = |z: &Complex| z.re.is_finite() && z.im.is_finite();
        if let Some(at) = points.iter().position(|point| !is_finite(point)) {
            return Err(TargetError::NotFinite { point: at + 1 });
        }
        let places = &points[..=kind.places()];
        // Of the first pose, of points, of poses.
        let turn = |at: usize| match (at, at.checked_sub(1 + kind.points())) {
            (0, _) if kind.poses > 0 => Some(Complex::ONE),
            (_, Some(pose)) => Some(half_turns[pose] / half_turns[pose].conj()),
            _ => None,
        };
        if let Some(at) = (0..places.len()).find(|at| turn(*at).is_some_and(|turn| !is_finite(&turn))) {
            return Err(TargetError::NotFinite { point: at + 1 });
        }
        let size = places.iter().map(|p| (p - points[0]).norm()).fold(0.0, f64::max);
        if (size > 0.0 || kind.points() == 0) && !EXTENTS.contains(&size) {
            return Err(TargetError::Extent { size });
        }
        for second in 1..places.len() {
            for first in 0..second {
                let turned = turn(first).zip(turn(second)).is_some_and(|(a, b)| (a - b).norm() > COINCIDENT);
                if !turned && (points[second] - points[first]).norm() <= COINCIDENT * size {
                    return Err(TargetError::Coincident { first: first + 1, second: second + 1 });
                }
            }
        }
        let scale = power_of_two_above(size);
        let delta: [Complex; STEPS] = std::array::from_fn(|j| {
            quotient(kind, &half_turns, j).unwrap_or((points[j + 1] - points[0]) / scale)
        });
        let displacements = Displacements { delta, starred: delta.map(|d| d.conj()), kind };
        Ok(Target { points, half_turns, scale, displacements })
    }
}

/// Returns the numerator of the quotient that an entry of [`Displacements`] of a real target holds, the conjugate of its
/// denominator; `None` for a length.
pub(super) fn quotient(kind: Kind, half_turns: &[Complex; MOST_POSES], j: usize) -> Option<Complex> {
    match j.checked_sub(kind.lengths())? {
        _ if kind.is_normal(j) => Some(NORMAL),
        pose if pose < kind.poses => Some(half_turns[pose]),
        _ => Some(Complex::ONE),
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
