//! The frame in which dyads are computed: poses about their middle, with the box of their positions of diagonal one.

use crate::mechanism::{Complex, Dyad, Pose, bounding_box, dot};

/// Magnitude of positions, and of one over their size, from which on products of them overflow.
const HUGE: f64 = 1e100;

/// A shift and a scale of the ground; the body's frame is scaled alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    centre: Complex,
    /// The diagonal of the box of the positions.
    pub size: f64,
}

impl Scale {
    /// Returns the scale of poses; `None` if their positions are all the same, or some number is not finite or so large or
    /// small that its square is not.
    pub fn of(poses: &[Pose]) -> Option<Self> {
        let finite = poses.iter().all(|pose| pose.position.is_finite() && pose.direction.is_finite());
        let [low, high] = bounding_box(poses.iter().map(|pose| pose.position));
        let size = (high - low).norm();
        // A difference of the positions' own rounding is no size.
        let rounding = 16.0 * f64::EPSILON * (low.norm() + high.norm());
        let scale = Scale { centre: (low + high) * 0.5, size };
        (finite && high.norm().max(low.norm()) < HUGE && size > rounding.max(1.0 / HUGE)).then_some(scale)
    }

    /// Returns a pose in the frame of the scale.
    pub fn pose(&self, pose: &Pose) -> Pose {
        Pose { position: (pose.position - self.centre) / self.size, direction: pose.direction }
    }

    /// Returns a place of the ground in the frame of the scale.
    pub fn place(&self, place: Complex) -> Complex {
        (place - self.centre) / self.size
    }

    /// Returns poses in the frame of the scale.
    pub fn poses(&self, poses: &[Pose]) -> Vec<Pose> {
        poses.iter().map(|pose| self.pose(pose)).collect()
    }

    /// Returns a dyad of the frame of the scale in the ground's own frame.
    pub fn back(&self, dyad: Dyad) -> Dyad {
        let place = |at: Complex| self.centre + at * self.size;
        match dyad {
            Dyad::RR { pin, pivot, length } => {
                Dyad::RR { pin: pin * self.size, pivot: place(pivot), length: length * self.size }
            }
            Dyad::PR { pin, normal, distance } => Dyad::PR {
                pin: pin * self.size,
                normal,
                distance: distance * self.size + dot(normal, self.centre),
            },
            Dyad::RP { pivot, normal, distance } => {
                Dyad::RP { pivot: place(pivot), normal, distance: distance * self.size }
            }
        }
    }
}
