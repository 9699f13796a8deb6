//! The joints of a linkage of several loops, by the names that its chain has: A, B, C, D; of each further dyad its ends X2, Y2
//! and its joint F2, then X3, Y3, F3; and P.

use super::{Bodies, MultiLoop};
use crate::mechanism::Complex;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};

/// A joint, or P, with its place on one body that carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedJoint {
    /// Its name.
    pub name: &'static str,
    /// A body that carries it.
    pub body: usize,
    /// Its place there.
    pub at: Complex,
}

/// A body with its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its number: 0 the ground, 1 the crank.
    pub body: usize,
    /// Its joints, P among them, each with its place on the body.
    pub joints: Vec<(&'static str, Complex)>,
}

/// The name of the joint that the crank carries, on which the first dyad hangs.
pub(super) const CRANK_PIN: &str = "C";

/// Returns the name of an end (0: X, 1: Y) of a dyad.
pub(super) fn end_name(dyad: usize, end: usize) -> &'static str {
    [[CRANK_PIN, "B"], ["X2", "Y2"], ["X3", "Y3"]][dyad.min(2)][end.min(1)]
}

/// Returns the name of the joint F of a dyad.
pub(super) fn joint_name(dyad: usize) -> &'static str {
    ["D", "F2", "F3"][dyad.min(2)]
}

impl MultiLoop {
    /// Returns the joints, the fixed pivots first, then in the order of assembly; P is the last.
    pub fn joints(&self) -> Vec<NamedJoint> {
        let mut joints = vec![NamedJoint { name: "A", body: GROUND, at: self.crank_pivot }];
        let (kind, zero) = (self.kind, Complex::new(0.0, 0.0));
        let ends =
            |ground: bool| {
                (0..kind.dyads()).flat_map(move |dyad| {
                    let on = kind.anchors(dyad).into_iter().enumerate();
                    on.filter(move |(_, body)| (*body == GROUND) == ground).map(move |(end, body)| {
                        NamedJoint { name: end_name(dyad, end), body, at: self.dyads[dyad].ends[end] }
                    })
                })
            };
        joints.extend(ends(true));
        let mut moving: Vec<NamedJoint> = ends(false).collect();
        for dyad in 0..kind.dyads() {
            let at = zero + self.dyads[dyad].lengths[0];
            let joint = NamedJoint { name: joint_name(dyad), body: 2 + 2 * dyad, at };
            // After its own ends, before those of the next dyad.
            let place = moving.iter().position(|other| other.name == end_name(dyad + 1, 0));
            let place = place.or_else(|| moving.iter().position(|other| other.name == end_name(dyad + 1, 1)));
            match place.filter(|_| dyad + 1 < kind.dyads()) {
                Some(place) => moving.insert(place, joint),
                None => moving.push(joint),
            }
        }
        joints.append(&mut moving);
        joints.push(NamedJoint { name: "P", body: kind.traced(), at: self.coupler_point });
        joints
    }

    /// Returns the place of a joint of a name where C is at a place; `None` if the linkage has no such joint, or does not close.
    pub fn joint_at(&self, name: &str, crank_pin: Complex) -> Option<Complex> {
        let joint = self.joints().into_iter().find(|joint| joint.name == name)?;
        let bodies = self.bodies((crank_pin - self.crank_pivot).arg())?;
        Some(bodies.place(joint.body, joint.at))
    }

    /// Returns the fixed pivots: A, B and the ends of further dyads on the ground.
    pub fn pivots(&self) -> Vec<Complex> {
        self.joints().iter().filter(|joint| joint.body == GROUND).map(|joint| joint.at).collect()
    }

    /// Returns the fixed pivots with their names.
    pub fn named_pivots(&self) -> Vec<(&'static str, Complex)> {
        self.links().swap_remove(GROUND).joints
    }

    /// Returns the bodies, each with all of its joints: the ground, the crank, then the links of each dyad.
    pub fn links(&self) -> Vec<Body> {
        let (kind, zero) = (self.kind, Complex::new(0.0, 0.0));
        (0..2 + 2 * kind.dyads())
            .map(|body| {
                let mut joints = Vec::new();
                match body {
                    GROUND => joints.push(("A", self.crank_pivot)),
                    CRANK => joints.push(("A", zero)),
                    link => {
                        let (dyad, end) = ((link - 2) / 2, (link - 2) % 2);
                        joints.push((end_name(dyad, end), zero));
                        joints.push((joint_name(dyad), zero + self.dyads[dyad].lengths[end]));
                    }
                }
                for dyad in 0..kind.dyads() {
                    for (end, on) in kind.anchors(dyad).into_iter().enumerate() {
                        if on == body {
                            joints.push((end_name(dyad, end), self.dyads[dyad].ends[end]));
                        }
                    }
                }
                if kind.traced() == body {
                    joints.push(("P", self.coupler_point));
                }
                Body { body, joints }
            })
            .collect()
    }

    /// Returns the distances between every two joints of one body: without P, and those of P.
    fn distances(&self) -> [Vec<f64>; 2] {
        let mut all = [Vec::new(), Vec::new()];
        for Body { joints, .. } in self.links() {
            for (i, (name, at)) in joints.iter().enumerate() {
                for (other, place) in &joints[..i] {
                    let of_point = usize::from(*name == "P" || *other == "P");
                    all[of_point].push((at - place).norm());
                }
            }
        }
        all
    }

    /// Returns the largest distance between two joints of one body, P and pivots included.
    pub fn longest(&self) -> f64 {
        self.distances().iter().flatten().copied().fold(0.0, f64::max)
    }

    /// Returns the largest distance between two joints of one body, without P.
    pub fn longest_link(&self) -> f64 {
        self.distances()[0].iter().copied().fold(0.0, f64::max)
    }

    /// Returns the ratio of the largest to the least distance between two joints of one body, without P.
    pub fn link_ratio(&self) -> f64 {
        let least = self.distances()[0].iter().copied().fold(f64::INFINITY, f64::min);
        self.longest_link() / least
    }

    /// Returns the places of the moving joints and of P.
    pub fn moving(&self, bodies: &Bodies) -> impl Iterator<Item = Complex> {
        let moving = self.joints().into_iter().filter(|joint| joint.body != GROUND);
        moving.map(|joint| bodies.place(joint.body, joint.at))
    }
}
