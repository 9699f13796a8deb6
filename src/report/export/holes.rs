//! Sizes of the holes and the plates around them: one diameter for all holes, and those of single holes from the settings and from
//! shop data.

use super::model::hole_distances;
use super::settings::{Refusal, Settings};
use crate::mechanism::CrankLinkage;
use crate::mechanism::plates::shop::Names;
use crate::mechanism::plates::{Bores, Joint, Link, Parts, Pin, Shop, parts};
use crate::report::text::{brief, exact};

/// The diameters of the holes and the widths of the plates, in mm.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Holes {
    /// The diameter of every hole without a size of its own.
    pub(super) pins: f64,
    /// The diameters of all holes and pins.
    pub(super) bores: Bores,
    /// The shop data, in mm.
    pub(super) shop: Option<Shop>,
    joints: Vec<Pin>,
    traced: Link,
}

impl Holes {
    /// Returns the diameters of the settings and of shop data in mm, `pins` for all holes that have none.
    pub(super) fn new(
        pins: f64,
        linkage: &CrankLinkage,
        (settings, shop): (&Settings, Option<Shop>),
    ) -> Self {
        let own =
            shop.as_ref().map_or_else(|| Bores::new(pins), |shop| shop.bores(&Names::of(linkage), pins));
        let bores = own.with_motor(settings.motor_hole_mm, settings.boss_hole_mm);
        Holes { pins, bores, shop, joints: parts::pins(linkage), traced: parts::traced(linkage) }
    }

    /// Returns the holes with diameters of their own, if they differ from the others, with a comma before each joint.
    pub(super) fn listed(&self) -> String {
        if !self.bores.differ() {
            return String::new();
        }
        let hole = |(link, hole): &(Link, f64)| format!("{} mm in {}", exact(*hole), link.in_words());
        let joint = |(joint, holes): (Joint, Vec<(Link, f64)>)| {
            let holes: Vec<String> = holes.iter().map(hole).collect();
            format!(", at {} {}", joint.name(), holes.join(" and "))
        };
        self.bores.listed(&self.joints, self.traced).into_iter().map(joint).collect()
    }

    /// Returns the diameter of what stands at a joint in drawings: the usual one, or with shop data its pin, or the hole at P.
    pub(super) fn drawn(&self, name: &str) -> f64 {
        let Some(joint) = self.shop.as_ref().and_then(|_| Joint::named(name)) else { return self.pins };
        match self.joints.iter().find(|pin| pin.joint == joint) {
            Some(pin) => self.bores.pin(pin),
            None => self.bores.of(self.traced, name),
        }
    }

    /// Returns the setting that a hole of a plate has its size from; `letters` are the names of its joints.
    fn key(&self, link: Link, letters: &str, settings: &Settings) -> String {
        let joints = Joint::all_named(letters);
        let is_at_a = joints.contains(&Joint::A);
        let motor = settings.motor_hole_mm.is_some() || settings.boss_hole_mm.is_some();
        let own = joints.iter().find(|joint| self.bores.own(link, **joint).is_some());
        match (link, own) {
            (Link::Crank, _) if is_at_a && (motor || own.is_none()) => "motor_hole_mm".to_owned(),
            (Link::Ground, _) if is_at_a && (motor || own.is_none()) => "boss_hole_mm".to_owned(),
            (_, Some(joint)) => format!("the hole of [shop.joint.{}]", joint.name()),
            _ => "hole_mm".to_owned(),
        }
    }

    /// Returns the diameter of a hole of a plate; `joints` are the letters of the hole.
    pub(super) fn of(&self, link: Link, joints: &str) -> f64 {
        self.bores.of(link, joints)
    }

    /// Returns the smallest diameter, with its setting.
    pub(super) fn smallest(&self, settings: &Settings) -> (String, f64) {
        let own = self.bores.smallest_own();
        own.map_or_else(
            || ("hole_mm".to_owned(), self.pins),
            |(joint, link, hole)| (self.key(link, joint.name(), settings), hole),
        )
    }

    /// Returns the distance from the hull of a link's holes to the edge of its plate: half its own width, or `margin` around its
    /// largest hole.
    pub(super) fn radius(&self, link: Link, margin: f64) -> f64 {
        let own = self.shop.as_ref().and_then(|shop| shop.width_of(link));
        own.map_or_else(|| 0.5 * self.bores.largest(link) + margin, |width| 0.5 * width)
    }

    /// Checks that no hole is wider than its plate, and no pin thicker than its hole.
    pub(super) fn check_shop(&self, linkage: &CrankLinkage) -> Result<(), Refusal> {
        let Some(shop) = &self.shop else { return Ok(()) };
        let found = shop.check(&Names::of(linkage), &self.bores);
        found.map_err(|(_, fault)| Refusal::new(format!("{fault} (mm)"), fault.remedy()))
    }

    /// Checks that no two holes of a plate run into each other, nor the slot into a hole.
    pub(super) fn check(&self, parts: &Parts, settings: &Settings) -> Result<(), Refusal> {
        self.check_slot(parts, settings)?;
        let pairs = parts.links().into_iter().flat_map(|link| {
            let plate = parts.plate(link, 0.0);
            hole_distances(&plate).into_iter().map(move |(from, to, apart)| {
                let room = apart - 0.5 * (self.of(link, &from) + self.of(link, &to));
                (room, link, from, to, apart)
            })
        });
        let nearest = pairs.min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((_, link, from, to, apart)) = nearest.filter(|(room, ..)| *room <= 0.0) else {
            return Ok(());
        };
        let [one, other] = [&from, &to].map(|joints| self.of(link, joints));
        let (distance, plate) = (brief(apart, 3), link.in_words());
        if one == other {
            return Err(Refusal::about(
                settings,
                "hole_mm",
                format!(
                    "holes of {} mm run into each other: {from} and {to} of {plate} are {distance} mm apart",
                    exact(one)
                ),
                format!("choose hole_mm below {distance}, or a larger scale"),
            ));
        }
        // What the larger one may be beside the other; where that is nothing, the other is too large already.
        let (joints, beside) = if one > other { (&from, other) } else { (&to, one) };
        let key = &*self.key(link, joints, settings);
        let most = 2.0 * apart - beside;
        let help = match most > 0.0 {
            true => format!("choose {key} below {}, or a larger scale", brief(most, 3)),
            false => format!("choose smaller holes (hole_mm, {key}), or a larger scale"),
        };
        Err(Refusal::about(
            settings,
            key,
            format!(
                "a hole of {} mm at {from} and one of {} mm at {to} of {plate} run into each other: they are \
                 {distance} mm apart",
                exact(one),
                exact(other)
            ),
            help,
        ))
    }

    /// Checks that the slot of a plate does not run into one of its holes.
    fn check_slot(&self, parts: &Parts, settings: &Settings) -> Result<(), Refusal> {
        let Some((link, joints, distance)) = parts.hole_in_slot(|link, joints| self.of(link, joints)) else {
            return Ok(());
        };
        let message = format!(
            "the slot of the {} runs into its hole at {joints}: the line on which the block's pins run comes within {} mm of \
             it",
            link.name(),
            brief(distance, 3)
        );
        let help = "choose a smaller hole_mm and margin_mm, which shorten the block and its slot, or a linkage whose block \
            keeps farther from that hole over its motion";
        Err(Refusal::about(settings, "hole_mm", message, help))
    }
}
