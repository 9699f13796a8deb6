//! Pairs of RR dyads as four-bars: the body is the coupler, its pins are C and D.
//!
//! With m1, m2 the pins and G1, G2, R1, R2 the pivots and lengths of the two dyads, and P the body's origin:
//!
//! ```text
//! A = G1    a = R1        b = |m2 - m1|                 u = (m2 - m1)/b     C -> D in the body's frame
//! B = G2    c = R2        P = C + Z (D - C)/b           Z = -m1 conj(u)
//!                         theta = arg(D - C) + beta     beta = arg conj(u)
//! ```

use crate::mechanism::{Complex, Dyad, Pose, length};
use crate::task::forms::design_space::Shape;

/// Greatest ratio of two lengths of a pair: pins or pivots that are nearer than this part of the longest link coincide.
const LENGTH_RATIO: f64 = 1e9;

/// A four-bar whose coupler carries a body: the first dyad is the crank, the second the follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The linkage, whose coupler point is the body's origin.
    pub shape: Shape,
    /// beta, the angle from C -> D to the body's x axis, in radians.
    pub frame_angle: f64,
    /// The moving pins C and D in the body's frame.
    pub pins: [Complex; 2],
}

impl Pair {
    /// Returns the unit vectors [e_j, u_j] along A -> C and C -> D at each pose; `None` if C falls on A at one of them.
    ///
    /// A pose that the dyads meet exactly is C = A + a e, D = C + b u; at any other, C is not at distance a from A.
    pub fn positions(&self, poses: &[Pose]) -> Option<Vec<[Complex; 2]>> {
        let along_body = Complex::from_polar(1.0, -self.frame_angle);
        let position = |pose: &Pose| {
            let crank = pose.at(self.pins[0]) - self.shape.crank_pivot;
            let distance = crank.norm();
            (distance > 0.0).then(|| [crank / distance, pose.direction * along_body])
        };
        poses.iter().map(position).collect()
    }
}

/// Returns the four-bar of two RR dyads; `None` if either is of another kind, or if their pins or their pivots coincide.
///
/// ```
/// # use linkwright::internals::mechanism::{Complex, Dyad};
/// # use linkwright::internals::synthesis::dyads::pair;
/// let crank = Dyad::RR { pin: Complex::new(-2.0, -1.0), pivot: Complex::new(0.0, 0.0), length: 1.0 };
/// let follower = Dyad::RR { pin: Complex::new(2.0, -1.0), pivot: Complex::new(4.0, 0.0), length: 3.0 };
/// let found = pair(&crank, &follower).unwrap();
/// assert_eq!(found.shape.links(), [4.0, 1.0, 4.0, 3.0]);
/// assert_eq!((found.shape.offset, found.frame_angle), (Complex::new(2.0, 1.0), 0.0));
/// assert_eq!(pair(&crank, &crank), None);
/// ```
pub fn pair(crank: &Dyad, follower: &Dyad) -> Option<Pair> {
    let Dyad::RR { pin: m1, pivot: crank_pivot, length: a } = *crank else { return None };
    let Dyad::RR { pin: m2, pivot: follower_pivot, length: c } = *follower else { return None };
    let b = length(m2 - m1);
    let along = (m2 - m1) / b;
    let shape =
        Shape { crank_pivot, follower_pivot, crank: a, coupler: b, follower: c, offset: -m1 * along.conj() };
    let links = shape.links();
    let longest = links.into_iter().fold(0.0, f64::max);
    let apart = |link: f64| link * LENGTH_RATIO > longest;
    // The frame's angle is 0 rather than -0 for pins along the body's x axis.
    let frame_angle = 0.0 - along.arg();
    (longest.is_finite() && links.into_iter().all(apart)).then_some(Pair {
        shape,
        frame_angle,
        pins: [m1, m2],
    })
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{FOUR, Moved, poses_deg, rr};
    use super::super::pin_on_line;
    use super::*;
    use crate::mechanism::AssemblyMode;
    use crate::mechanism::four_bar::mobility::wrapped;
    use crate::numbers::arithmetic::streams::stream;

    #[test]
    fn two_dyads_make_the_linkage_whose_positions_are_the_poses() {
        let draws = &mut stream(31, 0);
        for case in 0..200 {
            let moved = Moved::random(draws, 6);
            let [crank, follower] = moved.dyads();
            let made = pair(&crank, &follower).expect("a linkage");
            assert!(wrapped(made.frame_angle - moved.frame_angle).abs() < 1e-12, "case {case}");
            for (one, other) in made.shape.links().into_iter().zip(moved.linkage.links()) {
                assert!((one - other).abs() < 1e-12, "case {case}");
            }
            let positions = made.positions(&moved.poses).expect("positions");
            for (k, [e, u]) in positions.into_iter().enumerate() {
                let (shape, pose) = (made.shape, moved.poses[k]);
                assert!((e - Complex::from_polar(1.0, moved.crank_angles[k])).norm() < 1e-11, "case {case}");
                // By the position solver: P, and the body's angle from the joints.
                let to_follower = shape.follower_pivot - (shape.crank_pivot + e * shape.crank);
                let assembly = AssemblyMode::of((to_follower.conj() * u).im);
                let linkage = shape.linkage(assembly).expect("a linkage");
                let joints = linkage.position(e.arg()).joints().expect("closed");
                let coupler = joints.follower_pin - joints.crank_pin;
                assert!((coupler / coupler.norm() - u).norm() < 1e-6, "case {case}");
                assert!((joints.coupler_point - pose.position).norm() < 1e-6, "case {case}");
                let turned = wrapped(coupler.arg() + made.frame_angle - pose.direction.arg());
                assert!(turned.abs() < 1e-6, "case {case}: {turned:e}");
            }
        }
        let (crank, line) =
            (rr([1.0, 0.0], [0.0, 0.0], 1.0), pin_on_line(&poses_deg(FOUR[0].poses)).expect("a slider"));
        for other in [crank, rr([1.0, 0.0], [4.0, 0.0], 1.0), rr([3.0, 0.0], [0.0, 0.0], 1.0), line] {
            assert_eq!(pair(&crank, &other), None);
            assert_eq!(pair(&other, &crank), None);
        }
    }
}
