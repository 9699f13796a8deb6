//! The plates of a six-bar or an eight-bar: ground with all fixed pivots, crank, and two links a dyad.
//!
//! How far they move on a stretch is in [`displacement`](super::displacement).

use super::displacement::Displacements;
use super::kind::{Kind, Shape};
use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch};
use crate::mechanism::dyad_chain::kinds::{GROUND, MAX_DYADS};
use crate::mechanism::multi_loop::Bodies;
use crate::mechanism::{Complex, LoopJoints, MultiLoop};

/// Returns the ends X and Y and the joint F of a dyad.
fn joints_of(dyad: usize) -> [Joint; 3] {
    match dyad {
        0 => [Joint::C, Joint::B, Joint::D],
        further => Joint::OF_DYADS[(further - 1).min(1)],
    }
}

/// Returns the joint of a name of [`MultiLoop::joints`], all of which have one.
fn named(name: &str) -> Joint {
    Joint::named(name).unwrap_or(Joint::P)
}

/// Returns the place of a joint, or of P; `None` if the linkage has none of that name.
pub(super) fn joint_of(linkage: &MultiLoop, joint: Joint, bodies: &Bodies) -> Option<Complex> {
    if joint == Joint::A {
        return Some(linkage.crank_pivot());
    }
    if joint == Joint::P {
        return Some(bodies.place(linkage.chain_kind().traced(), linkage.coupler_point()));
    }
    linkage.dyads().iter().enumerate().find_map(|(dyad, pair)| {
        let on = linkage.chain_kind().anchors(dyad);
        Some(match joints_of(dyad).iter().position(|other| *other == joint)? {
            2 => bodies.place(2 + 2 * dyad, Complex::new(pair.lengths[0], 0.0)),
            end => bodies.place(on[end], pair.ends[end]),
        })
    })
}

/// Returns the frame of a link.
pub(super) fn frame_of(linkage: &MultiLoop, link: Link, bodies: &Bodies) -> Placement {
    match Link::OF_BODIES.iter().position(|other| *other == link).unwrap_or(GROUND) {
        GROUND => Placement::between(linkage.crank_pivot(), linkage.follower_pivot()),
        body => Placement { origin: bodies.origins[body], direction: bodies.directions[body] },
    }
}

/// Returns the bodies at a position.
pub(super) fn bodies(linkage: &MultiLoop, at: &LoopJoints) -> Option<Bodies> {
    linkage.bodies((at.joints.crank_pin - linkage.crank_pivot()).arg())
}

impl Kind for MultiLoop {
    fn links(&self) -> Vec<Link> {
        Link::OF_BODIES[..2 + 2 * self.dyad_count()].to_vec()
    }

    fn pins(&self) -> Vec<Pin> {
        let mut pins = vec![Pin::new(Joint::A, Link::Ground, Link::Crank)];
        for dyad in 0..self.dyad_count() {
            let (on, own) = (
                self.chain_kind().anchors(dyad),
                [Link::OF_BODIES[2 + 2 * dyad], Link::OF_BODIES[3 + 2 * dyad]],
            );
            let [x, y, f] = joints_of(dyad);
            pins.push(Pin::new(x, Link::OF_BODIES[on[0]], own[0]));
            pins.push(Pin::new(y, Link::OF_BODIES[on[1]], own[1]));
            pins.push(Pin::new(f, own[0], own[1]));
        }
        pins
    }

    fn points(&self) -> Vec<Joint> {
        self.joints().iter().map(|joint| named(joint.name)).collect()
    }

    fn traced(&self) -> Link {
        Link::OF_BODIES[self.chain_kind().traced()]
    }

    fn guide(&self, _: Sizes, _: &[Stretch]) -> Option<Guide> {
        None
    }

    fn shape(&self, link: Link, _: Option<&Guide>) -> Shape {
        let ground = Placement::between(self.crank_pivot(), self.follower_pivot());
        let own = |at: Complex| match link {
            Link::Ground => (at - ground.origin) * ground.direction.conj(),
            _ => at,
        };
        let body = MultiLoop::links(self).into_iter().find(|body| Link::OF_BODIES[body.body] == link);
        let joints = body.map_or(Vec::new(), |body| body.joints);
        Shape::with_holes(joints.into_iter().map(|(name, at)| (named(name), own(at))).collect())
    }

    fn placement(&self, link: Link, at: &LoopJoints) -> Placement {
        // The crank angle of a position is one at which the linkage closes.
        bodies(self, at).map_or(Placement::HOME, |bodies| frame_of(self, link, &bodies))
    }

    fn reach(&self, stretch: &Stretch, at: &LoopJoints) -> Reach {
        let mut moving = [(Joint::P, f64::INFINITY); 1 + 3 * MAX_DYADS];
        for (i, moved) in moving[1..].iter_mut().enumerate() {
            moved.0 = joints_of(i / 3)[i % 3];
        }
        let moving = &mut moving[..1 + 3 * self.dyad_count()];
        if let Some(bodies) = bodies(self, at) {
            let bounds = Displacements::new(self, &bodies, stretch.half());
            moving[0].1 = bounds.of(self.chain_kind().traced(), self.coupler_point());
            for (dyad, pair) in self.dyads().iter().enumerate() {
                let on = self.chain_kind().anchors(dyad);
                for end in 0..2 {
                    moving[1 + 3 * dyad + end].1 = bounds.of(on[end], pair.ends[end]);
                }
                moving[3 + 3 * dyad].1 = bounds.of(2 + 2 * dyad, Complex::new(pair.lengths[0], 0.0));
            }
        }
        Reach::new(moving, [0.0; 2])
    }
}
