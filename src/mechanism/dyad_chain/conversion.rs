//! Conversion of a dyad chain to a general [`Chain`], with lengths, pivots and named joints.
//!
//! A, B and C are those of a four-bar, D is the first dyad's joint; further dyads have the ends X2, Y2 and the joint F2, then
//! X3, Y3, F3; P is the traced point. Ends on the ground are pivots, others points of their links. A crank phase is an angle
//! from the line A-B; the chain's crank angle is measured from the x axis, so that the two differ by the angle of that line.

use super::DyadChain;
use super::kinds::{COUPLER, CRANK, FOLLOWER, GROUND};
use crate::mechanism::chain::ChainError;
use crate::mechanism::{AssemblyMode, Chain, ChainBuilder, Complex, xy};

/// Returns the names of the two joints that give a moving body its direction: the origin of its frame, and the end of v.
fn joints_of(body: usize) -> [String; 2] {
    match body {
        CRANK => ["A".into(), "C".into()],
        COUPLER => ["C".into(), "D".into()],
        FOLLOWER => ["B".into(), "D".into()],
        link => [end_name((link - 2) / 2, (link - 2) % 2), joint_name((link - 2) / 2)],
    }
}

fn end_name(dyad: usize, end: usize) -> String {
    match (dyad, end) {
        (0, 0) => "C".into(),
        (0, _) => "B".into(),
        _ => format!("{}{}", ["X", "Y"][end.min(1)], dyad + 1),
    }
}

fn joint_name(dyad: usize) -> String {
    if dyad == 0 { "D".into() } else { format!("F{}", dyad + 1) }
}

impl DyadChain {
    /// Returns the crank angle from the x axis at phase zero: the angle of the line from A to B, radians.
    pub fn ground_angle(&self) -> f64 {
        self.placement.ground.arg()
    }

    /// Returns the linkage as a general chain; its crank angle is the phase plus [`DyadChain::ground_angle`].
    ///
    /// # Errors
    /// If a length is zero or not finite.
    pub fn to_chain(&self) -> Result<Chain, Box<ChainError>> {
        let of = self.proportions();
        let [origin, ground, pointer] = self.placement.numbers();
        let size = ground.norm();
        let side = |dyad: usize| {
            if of.signs[dyad] > 0.0 { AssemblyMode::Plus } else { AssemblyMode::Minus }
        };
        // A place of a body's frame as lengths along and across the line between its two joints.
        let offset = |body: usize, place: Complex| {
            let unit = if body == CRANK { 1.0 } else { of.lengths[(body - 2) / 2][(body - 2) % 2] };
            xy(place * (unit * size))
        };
        let mut builder = ChainBuilder::new().pivot("A", xy(origin)).pivot("B", xy(origin + ground));
        let kind = self.shape.kind;
        for dyad in 1..kind.dyads() {
            for (end, body) in kind.anchors(dyad).into_iter().enumerate() {
                if body == GROUND {
                    let at = origin + ground * of.anchors[dyad][end];
                    builder = builder.pivot(&end_name(dyad, end), xy(at));
                }
            }
        }
        builder = builder.crank("A", "C", of.anchors[0][0].re * size);
        for dyad in 0..kind.dyads() {
            let ends = [0, 1].map(|end| end_name(dyad, end));
            if dyad > 0 {
                for (end, body) in kind.anchors(dyad).into_iter().enumerate() {
                    if body != GROUND {
                        let on = joints_of(body);
                        let at = offset(body, of.anchors[dyad][end]);
                        builder = builder.point(&ends[end], [&on[0], &on[1]], at);
                    }
                }
            }
            let lengths = of.lengths[dyad].map(|length| length * size);
            builder = builder.dyad(&joint_name(dyad), [&ends[0], &ends[1]], lengths, side(dyad));
        }
        let on = joints_of(kind.traced());
        let at = offset(kind.traced(), pointer / ground);
        builder.point("P", [&on[0], &on[1]], at).trace("P").build()
    }
}
