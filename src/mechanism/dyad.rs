//! Poses of a body in the plane, and dyads: the pin or slider that guides the body, held by the ground.
//!
//! With P the position of the body's origin and Q = e^{i theta} the direction of its x axis, the body's point m is at
//! P + Q m. A dyad puts one equation on a pose:
//!
//! ```text
//! RR   |P + Q m - G| = R              the pin m stays on a circle about the pivot G
//! PR   <n, P + Q m> = h               the pin m stays on a line of the ground
//! RP   <n, conj(Q) (G - P)> = h       a line of the body passes over the fixed pin G
//! ```
//!
//! A body on two RR dyads is the coupler of a four-bar; PR and RP are their limits as a link grows without end.

use super::{Complex, dot};

/// A pose: the place of a body's origin and the way the body lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// P, the position of the body's origin.
    pub position: Complex,
    /// Q = e^{i theta}, the unit vector along the body's x axis.
    pub direction: Complex,
}

impl Pose {
    /// Creates the pose at a position with the body turned by `angle` radians.
    pub fn new(position: Complex, angle: f64) -> Self {
        Pose { position, direction: Complex::from_polar(1.0, angle) }
    }

    /// Returns the place P + Q m of the body's point m.
    #[inline]
    pub fn at(&self, body_point: Complex) -> Complex {
        self.position + self.direction * body_point
    }

    /// Returns the point of the body that lies at a place of the ground, conj(Q) (G - P): the inverse of [`Pose::at`].
    #[inline]
    pub fn body_point(&self, place: Complex) -> Complex {
        self.direction.conj() * (place - self.position)
    }

    /// Returns the pose of the ground as the body sees it, whose [`Pose::at`] is this one's [`Pose::body_point`].
    pub fn inverse(&self) -> Self {
        Pose { position: -self.direction.conj() * self.position, direction: self.direction.conj() }
    }
}

/// A dyad: one constraint on a body's poses. R is a revolute joint, P a prismatic one; the first letter is the joint at
/// the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dyad {
    /// A link between a fixed pivot and a pin of the body.
    RR {
        /// m, the pin in the body's frame.
        pin: Complex,
        /// G, the fixed pivot.
        pivot: Complex,
        /// R, the length of the link.
        length: f64,
    },
    /// A pin of the body on a fixed line.
    PR {
        /// m, the pin in the body's frame.
        pin: Complex,
        /// n, the unit normal of the line.
        normal: Complex,
        /// h, the distance of the line from the ground's origin along n.
        distance: f64,
    },
    /// A line of the body over a fixed pin.
    RP {
        /// G, the fixed pin.
        pivot: Complex,
        /// n, the unit normal of the line, in the body's frame.
        normal: Complex,
        /// h, the distance of the line from the body's origin along n.
        distance: f64,
    },
}

impl Dyad {
    /// Returns the signed distance, a length, by which a pose misses the dyad's circle or line.
    pub fn residual(&self, pose: &Pose) -> f64 {
        match *self {
            Dyad::RR { pin, pivot, length } => (pose.at(pin) - pivot).norm() - length,
            Dyad::PR { pin, normal, distance } => dot(normal, pose.at(pin)) - distance,
            Dyad::RP { pivot, normal, distance } => dot(normal, pose.body_point(pivot)) - distance,
        }
    }

    /// Returns the greatest distance by which any of the poses misses the dyad's circle or line; 0 if there are none.
    pub fn largest_residual(&self, poses: &[Pose]) -> f64 {
        poses.iter().map(|pose| self.residual(pose).abs()).fold(0.0, f64::max)
    }

    /// Returns the dyad that guides the ground as the body sees it ([`Pose::inverse`]).
    pub fn inverse(&self) -> Self {
        match *self {
            Dyad::RR { pin, pivot, length } => Dyad::RR { pin: pivot, pivot: pin, length },
            Dyad::PR { pin, normal, distance } => Dyad::RP { pivot: pin, normal, distance },
            Dyad::RP { pivot, normal, distance } => Dyad::PR { pin: pivot, normal, distance },
        }
    }

    /// Returns whether every number of the dyad is finite.
    pub fn is_finite(&self) -> bool {
        let (Dyad::RR { pin: one, pivot: other, length: number }
        | Dyad::PR { pin: one, normal: other, distance: number }
        | Dyad::RP { pivot: one, normal: other, distance: number }) = *self;
        one.is_finite() && other.is_finite() && number.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSE: Pose =
        Pose { position: Complex { re: 3.0, im: -1.0 }, direction: Complex { re: 0.6, im: 0.8 } };

    #[test]
    fn a_pose_carries_points_there_and_back() {
        let point = Complex::new(2.0, 5.0);
        assert_eq!(POSE.at(Complex::new(0.0, 0.0)), POSE.position);
        // (0.6 + 0.8i)(2 + 5i) = -2.8 + 4.6i
        assert!((POSE.at(point) - Complex::new(0.2, 3.6)).norm() < 8.0 * f64::EPSILON);
        assert!((POSE.body_point(POSE.at(point)) - point).norm() < 32.0 * f64::EPSILON);
        assert!((POSE.inverse().at(POSE.at(point)) - point).norm() < 32.0 * f64::EPSILON);
    }

    #[test]
    fn residuals_are_distances_and_the_inverse_dyad_has_the_same() {
        let (pin, pivot) = (Complex::new(2.0, 5.0), Complex::new(0.2, 0.6));
        let normal = Complex::new(0.0, 1.0);
        let body_height = POSE.body_point(pivot).im;
        for (dyad, residual) in [
            (Dyad::RR { pin, pivot, length: 2.5 }, 0.5),
            (Dyad::PR { pin, normal, distance: 4.0 }, -0.4),
            (Dyad::RP { pivot, normal, distance: body_height - 0.25 }, 0.25),
        ] {
            assert!((dyad.residual(&POSE) - residual).abs() < 32.0 * f64::EPSILON, "{dyad:?}");
            let inverse = dyad.inverse();
            assert!((inverse.residual(&POSE.inverse()) - residual).abs() < 64.0 * f64::EPSILON);
            assert_eq!(inverse.inverse(), dyad);
            assert!(dyad.is_finite());
        }
        let at_infinity = Dyad::PR { pin: Complex::new(f64::INFINITY, 0.0), normal, distance: 0.0 };
        assert!(!at_infinity.is_finite());
    }
}
