//! The transmission angle mu between coupler and follower at D, in [0, 180] degrees, and its extremes.
//!
//! cos mu = (b^2 + c^2 - s^2)/(2 b c) with s = |CB|, and s^2 = g^2 + a^2 - 2 g a cos theta (theta from the
//! ground line): mu grows with s, and s is monotone between the crank along the ground (theta = 0) and
//! against it (theta = pi). So the extremes over any interval of crank angles are at its ends or at theta = 0
//! or pi if it contains one (Alt 1932; Hall 1961).

use crate::mechanism::{FourBar, least_and_greatest};
use std::f64::consts::{PI, TAU};

/// The least and the greatest transmission angle over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransmissionExtremes {
    /// The least transmission angle, radians, in [0, pi].
    pub min: f64,
    /// The greatest transmission angle, radians, in [0, pi].
    pub max: f64,
}

impl TransmissionExtremes {
    /// Returns the worst transmission angle, min over mu of min(mu, pi - mu): the distance of the motion from a toggle.
    pub fn worst(&self) -> f64 {
        self.min.min(PI - self.max).max(0.0)
    }
}

/// Rating of a linkage's force transmission by its worst transmission angle: min(mu, 180 - mu) over the motion.
///
/// The coupler's force F turns the follower with F sin mu and loads its pins with the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ForceTransmission {
    /// Worst angle below [`CERTAIN_JAM_DEG`].
    Jams,
    /// Worst angle below [`JAM_UNDER_LOAD_DEG`].
    MayJamUnderLoad,
    /// Worst angle below [`POOR_DEG`].
    Poor,
    /// Worst angle below [`GOOD_DEG`].
    Fair,
    /// Worst angle of [`GOOD_DEG`] or more.
    Good,
}

/// Least worst angle, degrees, of good force transmission: the usual demand of textbooks (Norton, *Design of
/// Machinery*, section on transmission angles: above about 40 degrees; after Alt 1932).
pub const GOOD_DEG: f64 = 40.0;
/// Least worst angle, degrees, that is enough for most loads: sin 30 = 1/2, so half of the coupler's force turns the
/// follower.
pub const POOR_DEG: f64 = 30.0;
/// Worst angle, degrees, below which the linkage may jam under load: sin 10 = 0.17, so the coupler's pins carry about
/// six times the follower's load, and their friction grows with it.
pub const JAM_UNDER_LOAD_DEG: f64 = 10.0;
/// Worst angle, degrees, below which friction alone holds the follower: in pins of radius r with a coefficient of
/// friction of 0.15 the force touches both friction circles, which turns it by asin(2 * 0.15 r/b); with r = b/10 by 1.7
/// degrees.
pub const CERTAIN_JAM_DEG: f64 = 2.0;
/// Relative tolerance of the limits, that of requirements: an angle that misses a limit by less misses it by rounding.
const ROUNDING: f64 = 1e-7;

impl ForceTransmission {
    /// Returns the rating of a worst transmission angle, degrees.
    pub fn of(worst_deg: f64) -> ForceTransmission {
        let reaches = |limit: f64| worst_deg >= limit - ROUNDING * limit;
        let ratings = [
            (GOOD_DEG, ForceTransmission::Good),
            (POOR_DEG, ForceTransmission::Fair),
            (JAM_UNDER_LOAD_DEG, ForceTransmission::Poor),
            (CERTAIN_JAM_DEG, ForceTransmission::MayJamUnderLoad),
        ];
        let found = ratings.into_iter().find(|(limit, _)| reaches(*limit));
        found.map_or(ForceTransmission::Jams, |(_, rating)| rating)
    }

    /// Returns the rating in words, as a clause, the same wherever it is shown.
    pub fn words(self) -> &'static str {
        match self {
            ForceTransmission::Good => "forces pass well",
            ForceTransmission::Fair => "good enough for most loads",
            ForceTransmission::Poor => "below 30° a loaded linkage may jam",
            ForceTransmission::MayJamUnderLoad => "it may jam under load",
            ForceTransmission::Jams => "it will jam",
        }
    }
}

/// Computes mu, the angle opposite to s in the triangle with sides b, c, s, by half angles: exact near 0 and pi.
///
/// A triangle that does not close gives the nearest flat angle, 0 or pi.
pub fn angle_opposite(s: f64, b: f64, c: f64) -> f64 {
    let near = ((s - (b - c)) * (s + (b - c))).max(0.0); // s^2 - (b-c)^2 = 4bc sin^2(mu/2)
    let far = (((b + c) - s) * ((b + c) + s)).max(0.0); // (b+c)^2 - s^2 = 4bc cos^2(mu/2)
    2.0 * near.sqrt().atan2(far.sqrt())
}

impl FourBar {
    /// Returns |CB| at a crank angle.
    pub fn diagonal(&self, crank_angle: f64) -> f64 {
        let pin = self.crank_pivot() + crate::mechanism::Complex::from_polar(self.crank(), crank_angle);
        (self.follower_pivot() - pin).norm()
    }

    /// Computes mu at a crank angle, radians; `None` if the loop is open.
    pub fn transmission_angle(&self, crank_angle: f64) -> Option<f64> {
        self.position(crank_angle).joints()?;
        Some(self.angle_at_follower_pin(crank_angle))
    }

    /// Computes mu at a crank angle, radians; the nearest flat angle, 0 or pi, if the loop is open.
    pub(crate) fn angle_at_follower_pin(&self, crank_angle: f64) -> f64 {
        angle_opposite(self.diagonal(crank_angle), self.coupler(), self.follower())
    }

    /// Computes the extremes while the crank turns fully: at |CB| = |g - a| and g + a. If the crank cannot turn fully,
    /// an extreme is flat (0 or pi), the angle at the linkage's toggle.
    pub fn transmission_over_cycle(&self) -> TransmissionExtremes {
        let (g, a, b, c) = (self.ground(), self.crank(), self.coupler(), self.follower());
        TransmissionExtremes { min: angle_opposite((g - a).abs(), b, c), max: angle_opposite(g + a, b, c) }
    }

    /// Computes the extremes over the crank angles between `from` and `to` (radians, either order, any number of
    /// turns): they lie at the ends or where the crank lies along the ground.
    pub fn transmission_over(&self, from: f64, to: f64) -> TransmissionExtremes {
        let [low, high] = [from.min(to), from.max(to)];
        let along = [0.0, PI].map(|theta| self.ground_angle() + theta);
        let extreme = [(self.ground() - self.crank()).abs(), self.ground() + self.crank()];
        let is_passed = |angle: f64| low + (angle - low).rem_euclid(TAU) <= high;
        let passed = along.into_iter().zip(extreme).filter(|(angle, _)| is_passed(*angle));
        let ends = [low, high].map(|angle| self.diagonal(angle));
        self.transmission_at(ends.into_iter().chain(passed.map(|(_, diagonal)| diagonal)))
    }

    /// Computes the extremes among some diagonals |CB|.
    pub(crate) fn transmission_at(&self, diagonals: impl Iterator<Item = f64>) -> TransmissionExtremes {
        let [least, greatest] = least_and_greatest(diagonals);
        let (b, c) = (self.coupler(), self.follower());
        TransmissionExtremes { min: angle_opposite(least, b, c), max: angle_opposite(greatest, b, c) }
    }
}
