//! Clearances: least distances between plates, pins and joints over a motion.

use super::closest::{Closest, closest};
use super::sweep::{Reach, Sweep};
use crate::mechanism::plates::{Link, Placement, Plate};
use crate::mechanism::{Complex, FourBar, Joints, Unit, length};

/// Radii of the plates and pins of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Build {
    /// Distance that a plate reaches beyond the hull of its hole centres.
    pub plate_radius: f64,
    /// The radius of the pins, half a hole.
    pub pin_radius: f64,
    /// The radii of a motor's shaft and boss at A, if they are not those of a pin.
    pub motor: Option<Motor>,
}

/// Radii of the holes for a motor at A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Of the shaft, in the crank.
    pub shaft_radius: f64,
    /// Of the boss around it, in the ground.
    pub boss_radius: f64,
}

/// Default diameter of a hole, in millimetres, if the unit is known.
const HOLE_MM: f64 = 4.0;
/// Default diameter of a hole without a unit, as a part of the longest link.
const HOLE_SHARE: f64 = 1.0 / 40.0;
/// Largest default diameter of a hole, as a part of the distance of the nearest two holes.
const HOLE_BESIDE: f64 = 1.0 / 3.0;

impl Build {
    /// Returns the radii for holes of diameter `hole` with material of width `margin` around them.
    pub fn new(hole: f64, margin: f64) -> Self {
        Build { plate_radius: margin + 0.5 * hole, pin_radius: 0.5 * hole, motor: None }
    }

    /// Returns the same with holes for a motor at A: of diameter `shaft` in the crank and `boss` in the ground, each by
    /// default as the one before it.
    #[must_use]
    pub fn with_motor(self, shaft: Option<f64>, boss: Option<f64>) -> Self {
        let shaft_radius = shaft.map_or(self.pin_radius, |shaft| 0.5 * shaft);
        let boss_radius = boss.map_or(shaft_radius, |boss| 0.5 * boss);
        let motor = Motor { shaft_radius, boss_radius };
        Build { motor: (shaft.is_some() || boss.is_some()).then_some(motor), ..self }
    }

    /// Returns the material around a hole.
    pub fn margin(&self) -> f64 {
        self.plate_radius - self.pin_radius
    }

    /// Returns the radius of a plate: wider than [`Build::plate_radius`] around a motor's hole that is wider than a pin's.
    pub fn radius_of(&self, link: Link) -> f64 {
        let hole = match (link, self.motor) {
            (Link::Ground, Some(motor)) => motor.boss_radius,
            (Link::Crank, Some(motor)) => motor.shaft_radius,
            _ => self.pin_radius,
        };
        self.plate_radius + (hole - self.pin_radius).max(0.0)
    }

    /// Returns the radius of what stands at a joint: a pin, or the motor's shaft.
    pub fn radius_at(&self, pin: Joint) -> f64 {
        match (pin, self.motor) {
            (Joint::A, Some(motor)) => motor.shaft_radius,
            _ => self.pin_radius,
        }
    }

    /// Returns the default diameter of a hole: 4 mm or, if the unit of the lengths is not known, a fortieth of the
    /// longest link; smaller if two holes of a plate are near each other.
    pub fn usual_hole(linkage: &FourBar, unit: Option<Unit>) -> f64 {
        let known = unit.map(|unit| HOLE_MM * Unit::Mm.factor_to(unit));
        let wanted = known.unwrap_or(HOLE_SHARE * linkage.longest_link());
        let holes = [linkage.crank_side(), linkage.follower_side()];
        let nearest = linkage.links().into_iter().chain(holes.into_iter().filter(|d| *d > 0.0));
        wanted.min(HOLE_BESIDE * nearest.fold(f64::INFINITY, f64::min))
    }
}

/// A joint: one of the four pins, each of which joins two plates, or the coupler point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joint {
    /// The pin of ground and crank.
    A,
    /// The pin of ground and follower.
    B,
    /// The pin of crank and coupler.
    C,
    /// The pin of coupler and follower.
    D,
    /// The coupler point.
    P,
}

impl Joint {
    /// All five joints.
    pub const ALL: [Joint; 5] = [Joint::A, Joint::B, Joint::C, Joint::D, Joint::P];
    /// The four pins.
    pub const PINS: [Joint; 4] = [Joint::A, Joint::B, Joint::C, Joint::D];

    /// Returns the letter of the joint.
    pub fn name(self) -> &'static str {
        ["A", "B", "C", "D", "P"][self as usize]
    }

    /// Returns the plates that carry the joint: the two that a pin joins, twice the coupler for the coupler point.
    pub fn joins(self) -> [Link; 2] {
        match self {
            Joint::A => [Link::Ground, Link::Crank],
            Joint::B => [Link::Ground, Link::Follower],
            Joint::C => [Link::Crank, Link::Coupler],
            Joint::D => [Link::Coupler, Link::Follower],
            Joint::P => [Link::Coupler; 2],
        }
    }

    /// Returns the position of the joint's centre.
    pub fn at(self, linkage: &FourBar, joints: &Joints) -> Complex {
        match self {
            Joint::A => linkage.crank_pivot(),
            Joint::B => linkage.follower_pivot(),
            Joint::C => joints.crank_pin,
            Joint::D => joints.follower_pin,
            Joint::P => joints.coupler_point,
        }
    }

    /// Returns the bound of the joint's displacement.
    fn moves(self, reach: &Reach) -> f64 {
        match self {
            Joint::A | Joint::B => 0.0,
            Joint::C => reach.crank_pin,
            Joint::D => reach.follower_pin,
            Joint::P => reach.coupler_point,
        }
    }
}

/// Returns the bound of the displacement of any point of a plate's hull: that of the farthest-moving of its holes.
fn plate_moves(link: Link, reach: &Reach) -> f64 {
    match link {
        Link::Ground => 0.0,
        Link::Crank => reach.crank_pin,
        Link::Follower => reach.follower_pin,
        Link::Coupler => reach.coupler(),
    }
}

/// The plates and pins of a linkage, with its motion.
#[derive(Clone, Debug)]
pub struct Workpieces<'a> {
    sweep: &'a Sweep,
    build: Build,
    plates: [Plate; 4],
}

impl<'a> Workpieces<'a> {
    /// Builds the plates of a linkage in motion.
    pub fn new(sweep: &'a Sweep, build: Build) -> Self {
        let plates = Link::ALL.map(|link| Plate::of(&sweep.linkage, link, build.radius_of(link)));
        Workpieces { sweep, build, plates }
    }

    fn plate(&self, link: Link) -> &Plate {
        &self.plates[link as usize]
    }

    fn placement(&self, link: Link, joints: &Joints) -> Placement {
        self.plate(link).placement(&self.sweep.linkage, joints)
    }

    /// Computes the distance between two plates at a position, below zero if they overlap.
    pub fn between_plates_at(&self, one: Link, other: Link, joints: &Joints) -> f64 {
        let (at, other_at) = (self.placement(one, joints), self.placement(other, joints));
        self.plate(one).separation(&at, self.plate(other), &other_at)
    }

    /// Computes the distance between a pin and a plate at a position, below zero if they overlap.
    pub fn pin_to_plate_at(&self, pin: Joint, plate: Link, joints: &Joints) -> f64 {
        let to = pin.at(&self.sweep.linkage, joints);
        self.plate(plate).distance(&self.placement(plate, joints), to) - self.build.radius_at(pin)
    }

    /// Computes the least distance between two plates over the motion, below zero if they overlap. `None` if the loop
    /// is open in the motion.
    pub fn between_plates(&self, one: Link, other: Link) -> Option<Closest> {
        let moves = |reach: &Reach| plate_moves(one, reach) + plate_moves(other, reach);
        closest(self.sweep, |joints| self.between_plates_at(one, other, joints), moves)
    }

    /// Computes the least distance between a pin and a plate over the motion.
    pub fn pin_to_plate(&self, pin: Joint, plate: Link) -> Option<Closest> {
        let moves = |reach: &Reach| pin.moves(reach) + plate_moves(plate, reach);
        closest(self.sweep, |joints| self.pin_to_plate_at(pin, plate, joints), moves)
    }

    /// Computes the least distance between the surfaces of two pins over the motion.
    pub fn between_pins(&self, one: Joint, other: Joint) -> Option<Closest> {
        let apart = |joints: &Joints| distance(&self.sweep.linkage, one, other, joints);
        let moves = |reach: &Reach| one.moves(reach) + other.moves(reach);
        let radii = self.build.radius_at(one) + self.build.radius_at(other);
        closest(self.sweep, |joints| apart(joints) - radii, moves)
    }
}

fn distance(linkage: &FourBar, one: Joint, other: Joint, joints: &Joints) -> f64 {
    length(one.at(linkage, joints) - other.at(linkage, joints))
}

/// Two joints and the least distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotDistance {
    /// Letters of the joints.
    pub between: [&'static str; 2],
    /// The least distance of their centres over the motion.
    pub closest: Closest,
    /// Whether one link carries both, so that the distance is constant.
    pub fixed: bool,
}

/// Computes the least distances between the centres of A, B, C, D and P over the motion, nearest first (ties in the
/// order of the letters). `None` if the loop is open in the motion.
pub fn pivot_distances(sweep: &Sweep) -> Option<Vec<PivotDistance>> {
    let mut distances = Vec::new();
    for (i, one) in Joint::ALL.into_iter().enumerate() {
        for other in Joint::ALL.into_iter().skip(i + 1) {
            let fixed = one.joins().iter().any(|link| other.joins().contains(link));
            let apart = |joints: &Joints| distance(&sweep.linkage, one, other, joints);
            let moves = |reach: &Reach| if fixed { 0.0 } else { one.moves(reach) + other.moves(reach) };
            let closest = closest(sweep, apart, moves)?;
            distances.push(PivotDistance { between: [one.name(), other.name()], closest, fixed });
        }
    }
    distances.sort_by(|x, y| x.closest.value.total_cmp(&y.closest.value));
    Some(distances)
}
