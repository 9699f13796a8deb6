//! Clearances: least distances between plates, pins and joints over a motion.

use super::closest::{Closest, Until, closest};
use super::sweep::{Position, Positions, Reach, Sweep};
pub use crate::mechanism::plates::Joint;
use crate::mechanism::plates::shop::{Names, THICKNESS_SHARE};
use crate::mechanism::plates::{Bores, Guide, Link, Parts, Pin, Plate, Shop, Sizes, parts};
use crate::mechanism::{CrankLinkage, FourBar, LoopJoints, Unit, length};

/// Radii of the plates and pins of a linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Build {
    /// Distance that a plate without a width of its own reaches beyond the hull of its hole centres.
    pub plate_radius: f64,
    /// The radius of the pins without a diameter of their own, half a hole.
    pub pin_radius: f64,
    /// The diameters of holes and pins.
    pub bores: Bores,
    /// The sizes that are given for this linkage, in the unit of its lengths.
    pub shop: Option<Shop>,
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
        let (plate_radius, pin_radius) = (margin + 0.5 * hole, 0.5 * hole);
        Build { plate_radius, pin_radius, bores: Bores::new(hole), shop: None }
    }

    /// Returns these radii of plates and pins.
    pub fn of_radii(plate_radius: f64, pin_radius: f64) -> Self {
        Build { plate_radius, pin_radius, bores: Bores::new(2.0 * pin_radius), shop: None }
    }

    /// Returns the same with the sizes that are given for a linkage, in the unit of its lengths.
    #[must_use]
    pub fn with_shop(self, linkage: &CrankLinkage, shop: Shop) -> Self {
        Build { bores: shop.bores(&Names::of(linkage), self.bores.usual), shop: Some(shop), ..self }
    }

    /// Returns the same with holes for a motor at A: of diameter `shaft` in the crank and `boss` in the ground, each by
    /// default as the one before it.
    #[must_use]
    pub fn with_motor(self, shaft: Option<f64>, boss: Option<f64>) -> Self {
        Build { bores: self.bores.with_motor(shaft, boss), ..self }
    }

    /// Returns the material around a hole.
    pub fn margin(&self) -> f64 {
        self.plate_radius - self.pin_radius
    }

    /// Returns the radius of a plate: half its own width, else wider than [`Build::plate_radius`] around a hole that is wider than
    /// a pin's.
    pub fn radius_of(&self, link: Link) -> f64 {
        let own = self.shop.as_ref().and_then(|shop| shop.width_of(link));
        let usual = || self.plate_radius + (0.5 * self.bores.largest(link) - self.pin_radius).max(0.0);
        own.map_or_else(usual, |width| 0.5 * width)
    }

    /// Returns the thickness of a plate: its own, that of all plates, or a part of the usual hole.
    pub fn thickness_of(&self, link: Link) -> f64 {
        let usual = THICKNESS_SHARE * self.bores.usual;
        let of = |shop: &Shop| shop.thickness_of(link, shop.thickness.unwrap_or(usual));
        self.shop.as_ref().map_or(usual, of)
    }

    /// Returns the radius of a pin, or of the motor's shaft.
    pub fn radius_at(&self, pin: &Pin) -> f64 {
        0.5 * self.bores.pin(pin)
    }

    /// Returns the parts of a linkage of these sizes for its motion; `None` if a slider's loop is open in the motion.
    pub fn parts(&self, sweep: &Sweep) -> Option<Parts> {
        let sizes = Sizes { hole: 2.0 * self.pin_radius, margin: self.margin() };
        Parts::new(sweep.linkage, sizes, &sweep.stretches)
    }

    /// Returns the default diameter of a hole of a linkage in motion: as [`Build::usual_hole`] says of a four-bar; with a
    /// slider smaller where the slot comes near a hole. `None` if the loop of a slider is open in the motion, or its slot
    /// runs through a hole however small that is.
    pub fn usual_hole_of(sweep: &Sweep, unit: Option<Unit>) -> Option<f64> {
        let linkage = &sweep.linkage;
        if let CrankLinkage::FourBar(linkage) = linkage {
            return Some(Build::usual_hole(linkage, unit));
        }
        let wanted = wanted_hole(linkage.longest(), unit);
        let found = parts::largest_hole(linkage, &sweep.stretches, (wanted, 1.0 / HOLE_BESIDE))?;
        (found > 0.0).then_some(found)
    }

    /// Returns the default diameter of a hole of a four-bar: 4 mm or, if the unit of the lengths is not known, a fortieth of
    /// the longest link; smaller if two holes of a plate are near each other.
    pub fn usual_hole(linkage: &FourBar, unit: Option<Unit>) -> f64 {
        let wanted = wanted_hole(linkage.longest_link(), unit);
        let holes = [linkage.crank_side(), linkage.follower_side()];
        let nearest = linkage.links().into_iter().chain(holes.into_iter().filter(|d| *d > 0.0));
        wanted.min(HOLE_BESIDE * nearest.fold(f64::INFINITY, f64::min))
    }
}

/// Returns the default diameter of a hole where there is room for it.
fn wanted_hole(longest: f64, unit: Option<Unit>) -> f64 {
    let known = unit.map(|unit| HOLE_MM * Unit::Mm.factor_to(unit));
    known.unwrap_or(HOLE_SHARE * longest)
}

/// Returns the bound of a joint's displacement.
fn joint_moves(joint: Joint, reach: &Reach, guide: Option<&Guide>) -> f64 {
    match joint {
        Joint::E | Joint::F => reach.of(Joint::D) + guide.map_or(0.0, |guide| guide.half) * reach.block_chord,
        _ => reach.of(joint),
    }
}

/// Returns the bound of the displacement of any point of a plate's hull: that of the farthest-moving of its corners.
fn plate_moves(plate: &Plate, reach: &Reach) -> f64 {
    match plate.link {
        Link::Ground => 0.0,
        Link::Coupler if plate.slot.is_some() => reach.of(Joint::C) + plate.farthest() * reach.coupler_chord,
        Link::Block => reach.of(Joint::D) + plate.farthest() * reach.block_chord,
        _ => plate.holes.iter().map(|hole| reach.of(hole.joint)).fold(0.0, f64::max),
    }
}

/// The plates and pins of a linkage, with its motion.
#[derive(Debug)]
pub struct Workpieces<'a> {
    positions: Positions<'a>,
    parts: Parts,
    plates: Vec<Plate>,
    /// The pins with their radii.
    pins: Vec<(Pin, f64)>,
    until: Until,
}

impl<'a> Workpieces<'a> {
    /// Builds the plates of a linkage in motion; `None` if a slider's loop is open in the motion.
    pub fn new(sweep: &'a Sweep, build: &Build) -> Option<Self> {
        let parts = build.parts(sweep)?;
        let plates = parts.plates(|link| build.radius_of(link));
        let pins = parts.pins().into_iter().map(|pin| (pin, build.radius_at(&pin))).collect();
        Some(Workpieces { positions: Positions::of(sweep), parts, plates, pins, until: Until::Proved })
    }

    /// Returns the same, whose least distances are proved only until it is decided whether they are above zero.
    #[must_use]
    pub fn decided(self) -> Self {
        Workpieces { until: Until::Decided, ..self }
    }

    /// Returns the parts.
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Returns whether a pin always lies in the slot of a link and is no thicker than that.
    pub fn stands_in_slot(&self, pin: Joint, link: Link) -> bool {
        let width = self.parts.guide().map_or(0.0, |guide| guide.width);
        self.parts.stands_in_slot(pin, link) && 2.0 * self.radius_at(pin) <= width
    }

    /// Returns the radius of the pin of a joint, 0 of a joint without one.
    fn radius_at(&self, joint: Joint) -> f64 {
        self.pins.iter().find(|(pin, _)| pin.joint == joint).map_or(0.0, |(_, radius)| *radius)
    }

    fn plate(&self, link: Link) -> &Plate {
        &self.plates[link.place()]
    }

    fn position(&self, at: impl Into<LoopJoints>) -> Position {
        Position::new(self.parts.linkage(), at.into())
    }

    /// Computes the distance between two plates at a position, below zero if they overlap.
    pub fn between_plates_at(&self, one: Link, other: Link, at: impl Into<LoopJoints>) -> f64 {
        self.plates_in(one, other, &self.position(at))
    }

    fn plates_in(&self, one: Link, other: Link, position: &Position) -> f64 {
        let (of_one, of_other) = (self.parts.frame(one, position), self.parts.frame(other, position));
        self.plate(one).separation(&of_one, self.plate(other), &of_other)
    }

    /// Computes the distance between a pin and a plate at a position, below zero if they overlap.
    pub fn pin_to_plate_at(&self, pin: Joint, plate: Link, at: impl Into<LoopJoints>) -> f64 {
        self.pin_and_plate_in(pin, plate, &self.position(at))
    }

    fn pin_and_plate_in(&self, pin: Joint, plate: Link, position: &Position) -> f64 {
        let to = self.parts.joint_in(pin, position);
        self.plate(plate).distance(&self.parts.frame(plate, position), to) - self.radius_at(pin)
    }

    /// Computes the least distance between two plates over the motion, below zero if they overlap. `None` if the loop
    /// is open in the motion.
    pub fn between_plates(&self, one: Link, other: Link) -> Option<Closest> {
        let moves =
            |reach: &Reach| plate_moves(self.plate(one), reach) + plate_moves(self.plate(other), reach);
        closest(&self.positions, |at| self.plates_in(one, other, at), moves, self.until)
    }

    /// Computes the least distance between a pin and a plate over the motion.
    pub fn pin_to_plate(&self, pin: Joint, plate: Link) -> Option<Closest> {
        let guide = self.parts.guide();
        let moves = |reach: &Reach| joint_moves(pin, reach, guide) + plate_moves(self.plate(plate), reach);
        closest(&self.positions, |at| self.pin_and_plate_in(pin, plate, at), moves, self.until)
    }

    /// Computes the least distance between the surfaces of two pins over the motion.
    pub fn between_pins(&self, one: Joint, other: Joint) -> Option<Closest> {
        let apart = |at: &Position| length(self.parts.joint_in(one, at) - self.parts.joint_in(other, at));
        let guide = self.parts.guide();
        let moves = |reach: &Reach| joint_moves(one, reach, guide) + joint_moves(other, reach, guide);
        let radii = self.radius_at(one) + self.radius_at(other);
        closest(&self.positions, |at| apart(at) - radii, moves, self.until)
    }
}

/// Two joints and the least distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotDistance {
    /// Letters of the joints.
    pub between: [&'static str; 2],
    /// The least distance of their centres over the motion.
    pub closest: Closest,
    /// Whether one link keeps them apart, so that the distance is constant.
    pub fixed: bool,
}

/// Computes the least distances between the centres of the joints and P over the motion, nearest
/// first (ties in the order of the letters). `None` if the loop is open in the motion.
pub fn pivot_distances(sweep: &Sweep) -> Option<Vec<PivotDistance>> {
    let linkage = &sweep.linkage;
    let (points, links) = (parts::points(linkage), parts::links(linkage));
    let positions = Positions::of(sweep);
    let place = |joint: Joint, at: &Position| parts::joint_at(linkage, joint, at);
    let mut distances = Vec::new();
    for (i, one) in points.iter().copied().enumerate() {
        for other in points.iter().copied().skip(i + 1) {
            let carried = |link: Link| [one, other].iter().all(|joint| parts::carries(linkage, link, *joint));
            let fixed = links.iter().any(|link| carried(*link));
            let apart = |at: &Position| match (place(one, at), place(other, at)) {
                (Some(one), Some(other)) => length(one - other),
                _ => f64::INFINITY,
            };
            let moves = |reach: &Reach| match fixed {
                true => 0.0,
                false => joint_moves(one, reach, None) + joint_moves(other, reach, None),
            };
            let closest = closest(&positions, apart, moves, Until::Proved)?;
            distances.push(PivotDistance { between: [one.name(), other.name()], closest, fixed });
        }
    }
    distances.sort_by(|x, y| x.closest.value.total_cmp(&y.closest.value));
    Some(distances)
}
