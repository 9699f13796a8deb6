//! The transmission angle mu between coupler and follower at D, in [0, 180] degrees, and its extremes.
//!
//! cos mu = (b^2 + c^2 - s^2)/(2 b c) with s = |CB|, and s^2 = g^2 + a^2 - 2 g a cos theta (theta from the
//! ground line): mu grows with s, and s is monotone between the crank along the ground (theta = 0) and
//! against it (theta = pi). So the extremes over any stretch of crank angle are at its ends or at theta = 0
//! or pi where it holds one (Alt 1932; Hall 1961).

use super::FourBar;
use std::f64::consts::{PI, TAU};

/// The least and the greatest transmission angle over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransmissionExtremes {
    /// Radians, in [0, pi].
    pub min: f64,
    /// Radians, in [0, pi].
    pub max: f64,
}

impl TransmissionExtremes {
    /// min over mu of min(mu, pi - mu): how far the motion stays from a toggle.
    pub fn worst(&self) -> f64 {
        self.min.min(PI - self.max).max(0.0)
    }
}

/// mu, the angle opposite to s in the triangle with sides b, c, s: by half angles, exact near 0 and pi.
///
/// A triangle that does not close gives the nearest flat angle, 0 or pi.
pub fn angle_opposite(s: f64, b: f64, c: f64) -> f64 {
    let near = ((s - (b - c)) * (s + (b - c))).max(0.0); // s^2 - (b-c)^2 = 4bc sin^2(mu/2)
    let far = (((b + c) - s) * ((b + c) + s)).max(0.0); // (b+c)^2 - s^2 = 4bc cos^2(mu/2)
    2.0 * near.sqrt().atan2(far.sqrt())
}

impl FourBar {
    /// |CB| at a crank angle.
    pub fn diagonal(&self, crank_angle: f64) -> f64 {
        let pin = self.crank_pivot() + super::Complex::from_polar(self.crank(), crank_angle);
        (self.follower_pivot() - pin).norm()
    }

    /// mu at a crank angle, radians; `None` where the loop is open.
    pub fn transmission_angle(&self, crank_angle: f64) -> Option<f64> {
        self.position(crank_angle).joints()?;
        Some(angle_opposite(self.diagonal(crank_angle), self.coupler(), self.follower()))
    }

    /// The extremes while the crank turns fully: at |CB| = |g - a| and g + a. Where the crank cannot turn
    /// fully an extreme is flat (0 or pi), which is what the linkage meets at its toggle.
    pub fn transmission_over_cycle(&self) -> TransmissionExtremes {
        let (g, a, b, c) = (self.ground(), self.crank(), self.coupler(), self.follower());
        TransmissionExtremes { min: angle_opposite((g - a).abs(), b, c), max: angle_opposite(g + a, b, c) }
    }

    /// The extremes over the crank angles between `from` and `to` (radians, either order, any number of turns).
    pub fn transmission_over(&self, from: f64, to: f64) -> TransmissionExtremes {
        let (low, high) = if from <= to { (from, to) } else { (to, from) };
        let (b, c) = (self.coupler(), self.follower());
        let mut least = self.diagonal(low).min(self.diagonal(high));
        let mut greatest = self.diagonal(low).max(self.diagonal(high));
        let holds = |angle: f64| {
            let first = low + (angle - low).rem_euclid(TAU);
            first <= high
        };
        let ground = self.ground_angle();
        if holds(ground) {
            least = (self.ground() - self.crank()).abs();
        }
        if holds(ground + PI) {
            greatest = self.ground() + self.crank();
        }
        TransmissionExtremes { min: angle_opposite(least, b, c), max: angle_opposite(greatest, b, c) }
    }
}
