//! All parts of a linkage: its plates with their holes and slots, its pins, and where they lie in a position.

use super::kind::plated;
use super::{Guide, Joint, Link, Pin, Placement, Plate, Reach, Sizes, Slot, Stretch, multi_loop};
use crate::mechanism::multi_loop::Bodies;
use crate::mechanism::{Complex, CrankLinkage, LoopJoints};
use std::f64::consts::TAU;

/// Steps of the search for the largest hole: each halves the interval.
const HALVINGS: usize = 60;

/// A position of a linkage, in which frames and joints are cheap to read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    at: LoopJoints,
    /// The bodies of a six-bar or an eight-bar.
    bodies: Option<Bodies>,
}

impl Position {
    /// Returns a position of a linkage with its bodies.
    pub fn new(linkage: &CrankLinkage, at: LoopJoints) -> Self {
        Position { at, bodies: linkage.multi_loop().and_then(|linkage| multi_loop::bodies(linkage, &at)) }
    }
}

/// The parts that a linkage is built from.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    linkage: CrankLinkage,
    guide: Option<Guide>,
}

impl Parts {
    /// Returns the parts of a linkage for a motion; the slot of a crank that turns fully is long enough for the whole turn.
    /// `None` if a slider's loop is open in the motion.
    pub fn new(linkage: impl Into<CrankLinkage>, sizes: Sizes, motion: &[Stretch]) -> Option<Self> {
        let linkage = linkage.into();
        let kind = plated(&linkage);
        if !kind.links().contains(&Link::Block) {
            return Some(Parts { linkage, guide: None });
        }
        let motion: Vec<Stretch> = match linkage.mobility().input_turns_fully() {
            true => motion.iter().map(|stretch| Stretch { from: 0.0, to: TAU, ..*stretch }).collect(),
            false => motion.to_vec(),
        };
        let guide = Some(kind.guide(sizes, &motion)?);
        Some(Parts { linkage, guide })
    }

    /// Returns the linkage.
    pub fn linkage(&self) -> &CrankLinkage {
        &self.linkage
    }

    /// Returns the links in the order of drawings and lists: ground, crank, coupler, and the others.
    pub fn links(&self) -> Vec<Link> {
        plated(&self.linkage).links()
    }

    /// Returns the pins.
    pub fn pins(&self) -> Vec<Pin> {
        plated(&self.linkage).pins()
    }

    /// Returns the link that carries P.
    pub fn traced(&self) -> Link {
        plated(&self.linkage).traced()
    }

    /// Returns whether a pin always lies in the slot of a link, so that it may stand through it.
    pub fn stands_in_slot(&self, pin: Joint, link: Link) -> bool {
        self.slot().is_some_and(|slot| slot.link == link) && plated(&self.linkage).in_slot() == Some(pin)
    }

    /// Returns the guide of the slider; `None` of a four-bar.
    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_ref()
    }

    /// Returns the slot that the block runs in; `None` of a four-bar.
    pub fn slot(&self) -> Option<Slot> {
        let kind = plated(&self.linkage);
        self.links().into_iter().find_map(|link| kind.shape(link, self.guide.as_ref()).slot)
    }

    /// Builds the plate of a link.
    pub fn plate(&self, link: Link, radius: f64) -> Plate {
        Plate::shaped(link, plated(&self.linkage).shape(link, self.guide.as_ref()), radius)
    }

    /// Builds the plates of all links, in their order.
    pub fn plates(&self, radius: impl Fn(Link) -> f64) -> Vec<Plate> {
        self.links().into_iter().map(|link| self.plate(link, radius(link))).collect()
    }

    /// Returns the frame of a link at a position.
    pub fn placement(&self, link: Link, at: &LoopJoints) -> Placement {
        self.frame(link, &Position::new(&self.linkage, *at))
    }

    /// Returns the frame of a link at a position that is looked at more than once.
    pub fn frame(&self, link: Link, position: &Position) -> Placement {
        match (&self.linkage, &position.bodies) {
            (CrankLinkage::MultiLoop(linkage), Some(bodies)) => multi_loop::frame_of(linkage, link, bodies),
            _ => plated(&self.linkage).placement(link, &position.at),
        }
    }

    /// Returns the place of a joint at a position.
    pub fn joint(&self, joint: Joint, at: &LoopJoints) -> Complex {
        self.joint_in(joint, &Position::new(&self.linkage, *at))
    }

    /// Returns the place of a joint at a position that is looked at more than once.
    pub fn joint_in(&self, joint: Joint, position: &Position) -> Complex {
        let half = self.guide.as_ref().map_or(0.0, |guide| guide.half);
        let guided = |along: f64| self.frame(Link::Block, position).of(Complex::new(along, 0.0));
        joint_at(&self.linkage, joint, position)
            .unwrap_or_else(|| guided(if joint == Joint::E { -half } else { half }))
    }

    /// Returns the hole that the slot of its plate runs into, with its letters and its distance from the slot's centre line;
    /// `None` if there is none. `diameter` gives the size of a hole by its link and letters.
    pub fn hole_in_slot(&self, diameter: impl Fn(Link, &str) -> f64) -> Option<(Link, String, f64)> {
        let (guide, slot) = (self.guide?, self.slot()?);
        let holes = self.plate(slot.link, 0.0).distinct_holes().into_iter();
        let near = holes.map(|(joints, at)| {
            let distance = slot.distance(at);
            (distance - 0.5 * (diameter(slot.link, &joints) + guide.width), joints, distance)
        });
        let (room, joints, distance) = near.min_by(|one, other| one.0.total_cmp(&other.0))?;
        (room <= 0.0).then_some((slot.link, joints, distance))
    }

    /// Returns P if it lies in the slot of the coupler, or so near it that there is no room for a hole.
    pub fn undrilled(&self) -> Option<Joint> {
        let plate = self.plate(self.traced(), 0.0);
        (!plate.holes.iter().any(|hole| hole.joint == Joint::P)).then_some(Joint::P)
    }
}

/// Returns the joints whose distances over the motion matter, the coupler point among them.
pub(crate) fn points(linkage: &CrankLinkage) -> Vec<Joint> {
    plated(linkage).points()
}

/// Returns whether a joint, or P, is on a link; a guide pin is on none.
pub(crate) fn carries(linkage: &CrankLinkage, link: Link, joint: Joint) -> bool {
    let kind = plated(linkage);
    match joint {
        Joint::P => kind.traced() == link,
        _ => kind.pins().iter().any(|pin| pin.joint == joint && pin.joins.contains(&link)),
    }
}

/// Returns the links of a linkage in their places.
pub(crate) fn links(linkage: &CrankLinkage) -> Vec<Link> {
    plated(linkage).links()
}

/// Returns the pins of a linkage.
pub(crate) fn pins(linkage: &CrankLinkage) -> Vec<Pin> {
    plated(linkage).pins()
}

/// Returns the link that carries P.
pub(crate) fn traced(linkage: &CrankLinkage) -> Link {
    plated(linkage).traced()
}

/// Returns the joints with the links in whose plates they have holes: a guide pin in its block, P in the link that carries it.
pub(crate) fn drilled(linkage: &CrankLinkage) -> Vec<(Joint, Vec<Link>)> {
    let kind = plated(linkage);
    let guided = |joint: Joint| matches!(joint, Joint::E | Joint::F);
    let of = |pin: Pin| {
        let links = pin.joins.into_iter().filter(|link| !guided(pin.joint) || *link == Link::Block);
        (pin.joint, links.collect())
    };
    let mut holes: Vec<(Joint, Vec<Link>)> = kind.pins().into_iter().map(of).collect();
    holes.sort_by_key(|(joint, _)| *joint);
    holes.push((Joint::P, vec![kind.traced()]));
    holes
}

/// Computes how far joints move within a stretch, from the position in its middle; `None` if the loop is open there.
pub(crate) fn reach(linkage: &CrankLinkage, stretch: &Stretch) -> Option<(LoopJoints, Reach)> {
    let at = linkage.joints_with(stretch.middle(), stretch.assembly)?;
    Some((at, plated(linkage).reach(stretch, &at)))
}

/// Returns the place of a joint at a position; `None` of a guide pin, which depends on the block.
pub(crate) fn joint_at(linkage: &CrankLinkage, joint: Joint, position: &Position) -> Option<Complex> {
    let at = &position.at;
    match joint {
        Joint::A => Some(linkage.crank_pivot()),
        Joint::B => Some(linkage.second_pivot().unwrap_or(at.joints.follower_pin)),
        Joint::C => Some(at.joints.crank_pin),
        Joint::D => Some(at.joints.follower_pin),
        Joint::P => Some(at.joints.coupler_point),
        Joint::E | Joint::F => None,
        of_dyad => multi_loop::joint_of(linkage.multi_loop()?, of_dyad, position.bodies.as_ref()?),
    }
}

/// Returns the least distance of two holes, or of a hole and the slot, of one plate of a linkage with a slider; its block,
/// which grows with the holes, and holes that are left out do not count.
fn nearest(parts: &Parts) -> f64 {
    let plates = parts.links().into_iter().filter(|link| *link != Link::Block);
    let of_plate = |link: Link| {
        let plate = parts.plate(link, 0.0);
        let holes: Vec<Complex> = plate.distinct_holes().into_iter().map(|(_, at)| at).collect();
        let pairs = (0..holes.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let apart = pairs.map(|(i, j)| (holes[i] - holes[j]).norm()).fold(f64::INFINITY, f64::min);
        let fixed = plate.holes.iter().filter(|hole| hole.joint != Joint::P);
        let beside = fixed.map(|hole| plate.slot.map_or(f64::INFINITY, |slot| slot.distance(hole.at)));
        beside.fold(apart, f64::min)
    };
    plates.map(of_plate).fold(f64::INFINITY, f64::min)
}

/// Computes the largest diameter of the holes, at most `most`, for which the holes and the slot of every plate of a linkage
/// with a slider are at least `apart` diameters from each other, with a margin as wide as a hole. 0 if there is none; `None`
/// if the loop is open in the motion.
pub(crate) fn largest_hole(
    linkage: &CrankLinkage,
    motion: &[Stretch],
    (most, apart): (f64, f64),
) -> Option<f64> {
    let fits = |hole: f64| -> Option<bool> {
        let parts = Parts::new(linkage, Sizes { hole, margin: hole }, motion)?;
        Some(nearest(&parts) >= apart * hole)
    };
    if fits(most)? {
        return Some(most);
    }
    let (mut low, mut high) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    // What the halvings cannot tell from nothing is nothing.
    Some(if low > most * 1e-9 { low } else { 0.0 })
}
