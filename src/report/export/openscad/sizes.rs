//! The names of sizes in a script: one for all holes and plates, or with shop data one for each hole and each plate.
//!
//! The text of a script has marks in place of names:
//!
//! | mark | without shop data | with shop data |
//! |---|---|---|
//! | `@hole:crank:A@` | `motor_hole` (`boss_hole` of the ground, `hole` elsewhere) | `hole_crank_A` |
//! | `@r:crank@` | `r_crank` (`r_ground`, `r` of the others) | `r_crank`, one for each plate |
//! | `@t:crank@` | nothing | the argument `thickness_crank` |
//! | `@t@` | nothing | the parameter of that argument |
//! | `@pitch@` | `(thickness + washer)` | `pitch`, from the thickest plate |
//! | `@both@` | `2 * r` | the sum of the radii of coupler and follower |
//! | `@radii@` | the radii of ground, crank and the others | a radius of each plate |

use super::super::model::Model;
use crate::mechanism::plates::{Joint, Link, Plate, parts};
use crate::report::text::exact;

/// The names of sizes for one model.
pub(super) struct Names<'a> {
    model: &'a Model<'a>,
    plates: Vec<Plate>,
}

impl<'a> Names<'a> {
    pub(super) fn of(model: &'a Model<'a>, plates: Vec<Plate>) -> Self {
        Names { model, plates }
    }

    fn are_single(&self) -> bool {
        self.model.holes.shop.is_some()
    }

    /// Returns the diameter of a hole at a joint in a link, which is that of all joints at its place.
    fn diameter(&self, link: Link, joint: Joint) -> f64 {
        let holes = self.plates.iter().filter(|plate| plate.link == link).flat_map(Plate::distinct_holes);
        let here = |letters: &String| Joint::all_named(letters).contains(&joint);
        let letters = holes.map(|(letters, _)| letters).find(here);
        self.model.holes.of(link, letters.as_deref().unwrap_or(joint.name()))
    }

    /// Returns the lines with the sizes of single holes and plates.
    pub(super) fn parameters(&self) -> String {
        let settings = self.model.settings;
        if !self.are_single() {
            let own_size = |set: Option<f64>, usual: &str| set.map_or(usual.to_owned(), exact);
            let motor = own_size(settings.motor_hole_mm, "hole");
            let boss = own_size(settings.boss_hole_mm, "motor_hole");
            return format!(
                "motor_hole = {motor}; // of the crank at A, for a motor's shaft\n\
                 boss_hole = {boss}; // of the ground at A, for its boss\n"
            );
        }
        let same_or = |value: f64, usual: f64, name: &str| {
            if value == usual { name.to_owned() } else { exact(value) }
        };
        let mut out = String::new();
        for (joint, links) in parts::drilled(&self.model.linkage) {
            for link in links {
                let size = same_or(self.diameter(link, joint), self.model.holes.pins, "hole");
                let (link, joint) = (link.name(), joint.name());
                out.push_str(&format!("hole_{link}_{joint} = {size}; // of the {link} at {joint}\n"));
            }
        }
        for plate in &self.plates {
            let (link, thickness) = (plate.link.name(), self.model.thickness);
            let own = same_or(self.model.thickness_of(plate.link), thickness, "thickness");
            out.push_str(&format!("thickness_{link} = {own}; // of the {link}\n"));
        }
        let shop = self.model.holes.shop.as_ref();
        for plate in &self.plates {
            if let Some(width) = shop.and_then(|shop| shop.width_of(plate.link)) {
                let link = plate.link.name();
                out.push_str(&format!(
                    "width_{link} = {}; // of the {link}, across its line\n",
                    exact(width)
                ));
            }
        }
        out
    }

    /// Returns the lines with the radii of the plates.
    fn radii(&self) -> String {
        if !self.are_single() {
            return "r = radius(hole);\nr_ground = radius(boss_hole);\nr_crank = radius(motor_hole);\n"
                .to_owned();
        }
        let shop = self.model.holes.shop.as_ref();
        let holes = parts::drilled(&self.model.linkage);
        let mut out = String::new();
        for plate in &self.plates {
            let link = plate.link.name();
            let own = holes.iter().filter(|(_, links)| links.contains(&plate.link));
            let own: Vec<String> = own.map(|(joint, _)| format!("hole_{link}_{}", joint.name())).collect();
            let radius = match shop.and_then(|shop| shop.width_of(plate.link)) {
                Some(_) => format!("width_{link} / 2"),
                None => format!("radius(max([{}]))", own.join(", ")),
            };
            out.push_str(&format!("r_{link} = {radius};\n"));
        }
        let all: Vec<String> =
            self.plates.iter().map(|plate| format!("thickness_{}", plate.link.name())).collect();
        out.push_str(&format!(
            "pitch = max([{}]) + washer; // from layer to layer of the assembly\n",
            all.join(", ")
        ));
        out
    }

    /// Returns the text of a mark.
    fn name(&self, mark: &str) -> String {
        let single = self.are_single();
        let parts: Vec<&str> = mark.split(':').collect();
        match (parts.as_slice(), single) {
            (["hole", link, joint], true) => format!("hole_{link}_{joint}"),
            (["hole", "ground", "A"], false) => "boss_hole".to_owned(),
            (["hole", "crank", "A"], false) => "motor_hole".to_owned(),
            (["hole", ..], false) => "hole".to_owned(),
            (["r", link], true) => format!("r_{link}"),
            (["r", "ground"], false) => "r_ground".to_owned(),
            (["r", "crank"], false) => "r_crank".to_owned(),
            (["r", _], false) => "r".to_owned(),
            (["t", link], true) => format!(", thickness_{link}"),
            (["t"], true) => ", thickness".to_owned(),
            (["pitch"], true) => "pitch".to_owned(),
            (["pitch"], false) => "(thickness + washer)".to_owned(),
            (["both"], true) => "r_coupler + r_follower".to_owned(),
            (["both"], false) => "2 * r".to_owned(),
            (["radii"], _) => self.radii(),
            _ => String::new(),
        }
    }

    /// Returns a text with its marks replaced by names.
    pub(super) fn fill(&self, text: &str) -> String {
        // Every second part is a mark.
        text.split('@')
            .enumerate()
            .map(|(i, part)| if i % 2 == 0 { part.to_owned() } else { self.name(part) })
            .collect()
    }
}
