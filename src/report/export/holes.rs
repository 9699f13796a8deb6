//! Diameters of the holes of plates: one for all pins, and those at A of the crank and of the ground for a motor.

use super::model::hole_distances;
use super::settings::{Refusal, Settings};
use crate::mechanism::plates::{Link, Parts};
use crate::report::text::{brief, exact};

/// The diameters of the holes, in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Holes {
    /// Of every hole without a size of its own.
    pub(super) pins: f64,
    /// Of the crank's hole at A: the shaft of a motor.
    pub(super) motor: f64,
    /// Of the ground's hole at A: the boss of a motor.
    pub(super) boss: f64,
}

impl Holes {
    /// Returns the diameters of the settings, `pins` for all that have none.
    pub(super) fn new(pins: f64, settings: &Settings) -> Self {
        let motor = settings.motor_hole_mm.unwrap_or(pins);
        Holes { pins, motor, boss: settings.boss_hole_mm.unwrap_or(motor) }
    }

    /// Returns whether the holes at A have sizes of their own.
    pub(super) fn are_for_a_motor(&self) -> bool {
        self.motor != self.pins || self.boss != self.pins
    }

    /// Returns the setting that a hole of a plate has its size from; `joints` are the letters of the hole.
    fn key(link: Link, joints: &str) -> &'static str {
        match link {
            Link::Crank if joints.contains('A') => "motor_hole_mm",
            Link::Ground if joints.contains('A') => "boss_hole_mm",
            _ => "hole_mm",
        }
    }

    /// Returns the diameter of a hole of a plate; `joints` are the letters of the hole.
    pub(super) fn of(&self, link: Link, joints: &str) -> f64 {
        match Holes::key(link, joints) {
            "motor_hole_mm" => self.motor,
            "boss_hole_mm" => self.boss,
            _ => self.pins,
        }
    }

    /// Returns the smallest diameter, with its setting.
    pub(super) fn smallest(&self) -> (&'static str, f64) {
        let all = [("hole_mm", self.pins), ("motor_hole_mm", self.motor), ("boss_hole_mm", self.boss)];
        all.into_iter().fold(all[0], |least, one| if one.1 < least.1 { one } else { least })
    }

    /// Returns the distance from the hull of a link's holes to the edge of its plate: `margin` around the largest.
    pub(super) fn radius(&self, link: Link, margin: f64) -> f64 {
        let largest = match link {
            Link::Ground => self.boss.max(self.pins),
            Link::Crank => self.motor.max(self.pins),
            _ => self.pins,
        };
        0.5 * largest + margin
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
        let (key, beside) =
            if one > other { (Holes::key(link, &from), other) } else { (Holes::key(link, &to), one) };
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
