//! The diameters of holes and pins: one for all, and those of single joints in single plates.
//!
//! A hole with joints at one place (P on the pin C) has the largest of their own diameters. The pin of a joint is as thick as the
//! smaller of its two holes, unless it has a diameter of its own: a bearing seat of 10 mm in one plate and a hole of 4 mm in
//! the other are held together by a pin of 4 mm.

use super::{Joint, Link, Pin};

/// The diameters of the holes and of the pins of a linkage, in any unit of length.
#[derive(Clone, Debug, PartialEq)]
pub struct Bores {
    /// The diameter of every hole without one of its own, and the width of a slot.
    pub usual: f64,
    holes: Vec<(Joint, Link, f64)>,
    pins: Vec<(Joint, f64)>,
}

impl Bores {
    /// Returns one diameter for all holes.
    pub fn new(usual: f64) -> Self {
        Bores { usual, holes: Vec::new(), pins: Vec::new() }
    }

    /// Returns the same with a diameter for the hole of a joint in a link's plate.
    #[must_use]
    pub fn with_hole(mut self, joint: Joint, link: Link, diameter: f64) -> Self {
        self.holes.retain(|(at, of, _)| (*at, *of) != (joint, link));
        self.holes.push((joint, link, diameter));
        self
    }

    /// Returns the same with a diameter for the pin of a joint.
    #[must_use]
    pub fn with_pin(mut self, joint: Joint, diameter: f64) -> Self {
        self.pins.retain(|(at, _)| *at != joint);
        self.pins.push((joint, diameter));
        self
    }

    /// Returns the same with holes for a motor at A: for its shaft in the crank, and for the boss around it in the ground, by
    /// default as wide as that for the shaft. The shaft is the pin.
    #[must_use]
    pub fn with_motor(self, shaft: Option<f64>, boss: Option<f64>) -> Self {
        if shaft.is_none() && boss.is_none() {
            return self;
        }
        let shaft = shaft.or(self.own(Link::Crank, Joint::A)).unwrap_or(self.usual);
        let boss = boss.or(self.own(Link::Ground, Joint::A)).unwrap_or(shaft);
        self.with_hole(Joint::A, Link::Crank, shaft)
            .with_hole(Joint::A, Link::Ground, boss)
            .with_pin(Joint::A, shaft)
    }

    /// Returns the own diameter of the hole of a joint in a plate.
    pub fn own(&self, link: Link, joint: Joint) -> Option<f64> {
        self.holes.iter().find(|(at, of, _)| (*at, *of) == (joint, link)).map(|(.., diameter)| *diameter)
    }

    /// Returns the diameter of a hole of a plate; `letters` are the names of the joints at its place, one after the other.
    pub fn of(&self, link: Link, letters: &str) -> f64 {
        let own = Joint::all_named(letters).into_iter().filter_map(|joint| self.own(link, joint));
        own.reduce(f64::max).unwrap_or(self.usual)
    }

    /// Returns the largest diameter of a plate's holes, the usual one included.
    pub fn largest(&self, link: Link) -> f64 {
        let own = self.holes.iter().filter(|(_, of, _)| *of == link);
        own.map(|(.., diameter)| *diameter).fold(self.usual, f64::max)
    }

    /// Returns the smallest diameter of all holes with its place, if it is smaller than the usual one.
    pub fn smallest_own(&self) -> Option<(Joint, Link, f64)> {
        let least = self.holes.iter().copied().min_by(|one, other| one.2.total_cmp(&other.2));
        least.filter(|(.., diameter)| *diameter < self.usual)
    }

    /// Returns the diameter of a pin.
    pub fn pin(&self, pin: &Pin) -> f64 {
        let own = self.pins.iter().find(|(joint, _)| *joint == pin.joint).map(|(_, diameter)| *diameter);
        let [one, other] = pin.joins.map(|link| self.own(link, pin.joint).unwrap_or(self.usual));
        own.unwrap_or(one.min(other))
    }

    /// Returns the joints with a hole of its own in any plate.
    pub fn joints(&self) -> Vec<Joint> {
        let mut joints: Vec<Joint> = self.holes.iter().map(|(joint, ..)| *joint).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }

    /// Returns whether a hole has another diameter than the usual one.
    pub fn differ(&self) -> bool {
        self.holes.iter().any(|(.., diameter)| *diameter != self.usual)
    }

    /// Returns the diameters of each joint that has one of its own: of a pin in its two plates (the second of [`Pin::joins`] first), of
    /// a joint without a pin in `traced`.
    pub fn listed(&self, pins: &[Pin], traced: Link) -> Vec<(Joint, Vec<(Link, f64)>)> {
        let of = |joint: Joint| {
            let pin = pins.iter().find(|pin| pin.joint == joint);
            let links = pin.map_or(vec![traced], |pin| pin.joins.iter().rev().copied().collect());
            // A guide pin has a hole in its block alone.
            let guided = matches!(joint, Joint::E | Joint::F);
            let links = links.into_iter().filter(|link| !guided || *link == Link::Block);
            (joint, links.map(|link| (link, self.own(link, joint).unwrap_or(self.usual))).collect())
        };
        self.joints().into_iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coincident_holes_have_the_largest_own_diameter_and_pins_the_smaller_of_their_two() {
        let bores = Bores::new(4.0)
            .with_hole(Joint::C, Link::Coupler, 3.0)
            .with_hole(Joint::D, Link::Coupler, 10.0)
            .with_hole(Joint::X2, Link::Coupler, 6.0);
        assert_eq!(bores.of(Link::Coupler, "P"), 4.0);
        assert_eq!(bores.of(Link::Coupler, "CP"), 3.0);
        assert_eq!(bores.of(Link::Coupler, "CX2"), 6.0);
        assert_eq!((bores.of(Link::Crank, "C"), bores.of(Link::Coupler, "")), (4.0, 4.0));
        assert_eq!((bores.largest(Link::Coupler), bores.largest(Link::Crank)), (10.0, 4.0));
        let pin = |joint, other| bores.pin(&Pin::new(joint, Link::Coupler, other));
        assert_eq!((pin(Joint::C, Link::Crank), pin(Joint::D, Link::Follower)), (3.0, 4.0));
        let thin = bores.clone().with_pin(Joint::D, 2.5);
        assert_eq!(thin.pin(&Pin::new(Joint::D, Link::Coupler, Link::Follower)), 2.5);
        assert_eq!(Joint::all_named("ABX2F3P"), [Joint::A, Joint::B, Joint::X2, Joint::F3, Joint::P]);
    }

    #[test]
    fn a_boss_is_as_wide_as_the_shaft_unless_it_has_a_size() {
        let of = |bores: &Bores| {
            let holes = [Link::Crank, Link::Ground].map(|link| bores.of(link, "A"));
            (holes, bores.pin(&Pin::new(Joint::A, Link::Ground, Link::Crank)))
        };
        assert_eq!(of(&Bores::new(4.0).with_motor(Some(6.0), None)), ([6.0, 6.0], 6.0));
        assert_eq!(of(&Bores::new(4.0).with_motor(None, Some(20.0))), ([4.0, 20.0], 4.0));
        let given = Bores::new(4.0).with_hole(Joint::A, Link::Ground, 22.0);
        assert_eq!(of(&given.clone().with_motor(Some(6.0), None)), ([6.0, 22.0], 6.0));
        assert_eq!(of(&given.with_motor(None, None)), ([4.0, 22.0], 4.0));
    }
}
