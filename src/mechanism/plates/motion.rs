//! The motion over which plates are made and examined: intervals of crank angles, and how far joints move within one.

use super::Joint;
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
    /// The bound of each joint, 0 of fixed pivots, and of guide pins, which depend on the block.
    joints: [f64; Joint::COUNT],
    /// Bound of the distance that a point of the coupler at 1 from C moves about C; 2 or less.
    pub coupler_chord: f64,
    /// Bound of the distance that a point of the block at 1 from D moves about D; 0 without a block that turns.
    pub block_chord: f64,
}

impl Reach {
    /// Returns the bounds of joints that move, with those of the directions of a coupler and of a block.
    pub(super) fn new(moving: &[(Joint, f64)], [coupler_chord, block_chord]: [f64; 2]) -> Self {
        let mut joints = [0.0; Joint::COUNT];
        moving.iter().for_each(|(joint, bound)| joints[*joint as usize] = *bound);
        Reach { joints, coupler_chord, block_chord }
    }

    /// Returns the bound of a joint.
    pub fn of(&self, joint: Joint) -> f64 {
        self.joints[joint as usize]
    }
}
