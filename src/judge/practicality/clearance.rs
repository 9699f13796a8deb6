//! Clearances: least distances between plates, pins and joints over a motion.

use super::closest::{Closest, closest};
use super::sweep::{Reach, Sweep};
use crate::mechanism::plates::{Link, Placement, Plate};
use crate::mechanism::{Complex, FourBar, Joints, Unit, length};

/// Accuracy to which least distances are proved, as a part of the longest link: far below the tolerance of a workshop.
pub const MARGIN: f64 = 1e-4;

/// Radii of the plates and pins of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Build {
    /// Distance that a plate reaches beyond the hull of its hole centres.
    pub plate_radius: f64,
    /// The radius of the pins, half a hole.
    pub pin_radius: f64,
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
        Build { plate_radius: margin + 0.5 * hole, pin_radius: 0.5 * hole }
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

/// A pin, which joins two plates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pin {
    /// The pin of ground and crank.
    A,
    /// The pin of ground and follower.
    B,
    /// The pin of crank and coupler.
    C,
    /// The pin of coupler and follower.
    D,
}

impl Pin {
    /// All four pins.
    pub const ALL: [Pin; 4] = [Pin::A, Pin::B, Pin::C, Pin::D];

    /// Returns the letter of the pin.
    pub fn name(self) -> &'static str {
        match self {
            Pin::A => "A",
            Pin::B => "B",
            Pin::C => "C",
            Pin::D => "D",
        }
    }

    /// Returns the two plates that the pin joins.
    pub fn joins(self) -> [Link; 2] {
        match self {
            Pin::A => [Link::Ground, Link::Crank],
            Pin::B => [Link::Ground, Link::Follower],
            Pin::C => [Link::Crank, Link::Coupler],
            Pin::D => [Link::Coupler, Link::Follower],
        }
    }

    /// Returns the position of the pin's centre.
    pub fn at(self, linkage: &FourBar, joints: &Joints) -> Complex {
        match self {
            Pin::A => linkage.crank_pivot(),
            Pin::B => linkage.follower_pivot(),
            Pin::C => joints.crank_pin,
            Pin::D => joints.follower_pin,
        }
    }

    /// Returns the bound of the pin's displacement.
    fn moves(self, reach: &Reach) -> f64 {
        match self {
            Pin::A | Pin::B => 0.0,
            Pin::C => reach.crank_pin,
            Pin::D => reach.follower_pin,
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

/// Returns [`MARGIN`] in the unit of lengths.
pub fn margin(linkage: &FourBar) -> f64 {
    MARGIN * linkage.longest_link()
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
        Workpieces { sweep, build, plates: Plate::all(&sweep.linkage, build.plate_radius) }
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
    pub fn pin_to_plate_at(&self, pin: Pin, plate: Link, joints: &Joints) -> f64 {
        let to = pin.at(&self.sweep.linkage, joints);
        self.plate(plate).distance(&self.placement(plate, joints), to) - self.build.pin_radius
    }

    /// Computes the least distance between two plates over the motion, below zero if they overlap. `None` if the loop
    /// is open in the motion.
    pub fn between_plates(&self, one: Link, other: Link) -> Option<Closest> {
        closest(
            self.sweep,
            margin(&self.sweep.linkage),
            |joints| self.between_plates_at(one, other, joints),
            |reach| plate_moves(one, reach) + plate_moves(other, reach),
        )
    }

    /// Computes the least distance between a pin and a plate over the motion.
    pub fn pin_to_plate(&self, pin: Pin, plate: Link) -> Option<Closest> {
        closest(
            self.sweep,
            margin(&self.sweep.linkage),
            |joints| self.pin_to_plate_at(pin, plate, joints),
            |reach| pin.moves(reach) + plate_moves(plate, reach),
        )
    }

    /// Computes the least distance between the surfaces of two pins over the motion.
    pub fn between_pins(&self, one: Pin, other: Pin) -> Option<Closest> {
        let linkage = &self.sweep.linkage;
        closest(
            self.sweep,
            margin(linkage),
            |joints| {
                length(one.at(linkage, joints) - other.at(linkage, joints)) - 2.0 * self.build.pin_radius
            },
            |reach| one.moves(reach) + other.moves(reach),
        )
    }
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
    type Place = fn(&FourBar, &Joints) -> Complex;
    type Moves = fn(&Reach) -> f64;
    let joints: [(&'static str, Place, Moves); 5] = [
        ("A", |linkage, _| linkage.crank_pivot(), |_| 0.0),
        ("B", |linkage, _| linkage.follower_pivot(), |_| 0.0),
        ("C", |_, joints| joints.crank_pin, |reach| reach.crank_pin),
        ("D", |_, joints| joints.follower_pin, |reach| reach.follower_pin),
        ("P", |_, joints| joints.coupler_point, |reach| reach.coupler_point),
    ];
    let held = [["A", "B"], ["A", "C"], ["B", "D"], ["C", "D"], ["C", "P"], ["D", "P"]];
    let linkage = &sweep.linkage;
    let mut distances = Vec::new();
    for (i, (name, place, moves)) in joints.iter().enumerate() {
        for (other_name, other_place, other_moves) in &joints[i + 1..] {
            let fixed = held.contains(&[*name, *other_name]);
            let measure = |joints: &Joints| length(place(linkage, joints) - other_place(linkage, joints));
            let slack = |reach: &Reach| if fixed { 0.0 } else { moves(reach) + other_moves(reach) };
            let closest = closest(sweep, margin(linkage), measure, slack)?;
            distances.push(PivotDistance { between: [name, other_name], closest, fixed });
        }
    }
    distances.sort_by(|x, y| x.closest.value.total_cmp(&y.closest.value));
    Some(distances)
}
