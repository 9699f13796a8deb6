//! The motion over which plates are made and examined: intervals of crank angles, and how far joints move within one.

use crate::mechanism::AssemblyMode;

/// An interval of crank angles that is passed with one assembly mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The lower crank angle, radians.
    pub from: f64,
    /// The higher crank angle, radians.
    pub to: f64,
    /// The assembly mode.
    pub assembly: AssemblyMode,
}

impl Stretch {
    /// Returns the crank angle in the middle.
    pub fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }

    /// Returns half the length of the interval.
    pub(super) fn half(&self) -> f64 {
        0.5 * (self.to - self.from)
    }

    /// Returns whether the interval holds a crank angle, whole turns apart.
    pub(super) fn holds(&self, angle: f64) -> bool {
        self.from + (angle - self.from).rem_euclid(std::f64::consts::TAU) <= self.to
    }
}

/// Bounds of the joints' distances from their positions in the middle of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Bound for C.
    pub crank_pin: f64,
    /// Bound for D.
    pub follower_pin: f64,
    /// Bound for P.
    pub coupler_point: f64,
    /// Bound of the distance that a point of the coupler at 1 from C moves about C; 2 or less.
    pub coupler_chord: f64,
    /// Bound of the distance that a point of the block at 1 from D moves about D; 0 without a block that turns.
    pub block_chord: f64,
}

impl Reach {
    /// Returns the largest of those of C, D and P.
    pub fn coupler(&self) -> f64 {
        self.crank_pin.max(self.follower_pin).max(self.coupler_point)
    }
}
