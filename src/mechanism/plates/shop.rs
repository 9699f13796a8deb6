//! Shop data: the sizes of holes, pins, plates and rims that a linkage is built with.

use super::{Bores, Joint, Link, Pin, parts};
use crate::mechanism::{CrankLinkage, Unit};

/// The least rim around a hole by default, in diameters of the hole: a hole's centre is at least 1.2 diameters from the edge
/// (EN 1993-1-8:2005, table 3.3, the least edge distances e1 and e2 of a bolt's hole).
pub const RIM_SHARE: f64 = 0.7;

/// The thickness of a plate by default, in diameters of the usual hole.
pub const THICKNESS_SHARE: f64 = 0.75;

/// The sizes of a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointSizes {
    /// The diameter of its holes in all plates without one of their own.
    pub hole: Option<f64>,
    /// The diameter of its hole in single plates.
    pub hole_in: Vec<(Link, f64)>,
    /// The diameter of its pin.
    pub pin: Option<f64>,
    /// The least rim around its holes.
    pub rim: Option<f64>,
}

/// The sizes of a body's plate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodySizes {
    /// Its thickness.
    pub thickness: Option<f64>,
    /// Its width across the line of two holes: twice the distance from the hull of its holes to its edge.
    pub width: Option<f64>,
}

/// The sizes that a linkage is built with; lengths are in `unit`, or in that of the linkage where it is missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shop {
    /// The unit of lengths.
    pub unit: Option<Unit>,
    /// The diameter of every hole without one of its own.
    pub hole: Option<f64>,
    /// The distance from a hole's edge to the edge of a plate without a width of its own.
    pub margin: Option<f64>,
    /// The thickness of every plate without one of its own.
    pub thickness: Option<f64>,
    /// The least rim around every hole without one of its own; by default [`RIM_SHARE`] of its diameter.
    pub rim: Option<f64>,
    /// The sizes of joints.
    pub joints: Vec<(Joint, JointSizes)>,
    /// The sizes of bodies.
    pub bodies: Vec<(Link, BodySizes)>,
}

/// The place of a size in a table of shop data: `joint.A.hole_in.crank`.
pub type Key = Vec<String>;

/// A size that does not fit its linkage.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShopFault {
    /// The plate of the body has no hole at the joint.
    #[error("the {body} has no hole at {joint}")]
    NoHole {
        /// The joint.
        joint: &'static str,
        /// The name of the body.
        body: String,
        /// The bodies that have one.
        known: Vec<&'static str>,
    },
    /// The linkage has no such joint.
    #[error("this linkage has no joint \"{name}\"")]
    UnknownJoint {
        /// The name.
        name: String,
        /// The joints that it has.
        known: Vec<&'static str>,
    },
    /// The linkage has no such body.
    #[error("this linkage has no body \"{name}\"")]
    UnknownBody {
        /// The name.
        name: String,
        /// The bodies that it has.
        known: Vec<&'static str>,
    },
    /// A joint of which no pin is made.
    #[error("no pin passes through {0}")]
    NoPin(&'static str),
    /// The hole is wider than the plate around it.
    #[error("a hole of {hole} at {joint} does not fit into the {body}, which is {width} wide")]
    WiderThanPlate {
        /// The joint.
        joint: &'static str,
        /// The body.
        body: &'static str,
        /// The diameter of the hole.
        hole: f64,
        /// The width of the plate.
        width: f64,
    },
    /// The pin is thicker than a hole that it passes through.
    #[error("a pin of {pin} does not fit into the hole of {hole} at {joint} in the {body}")]
    PinTooThick {
        /// The joint.
        joint: &'static str,
        /// The body.
        body: &'static str,
        /// The diameter of the pin.
        pin: f64,
        /// The diameter of the hole.
        hole: f64,
    },
}

impl ShopFault {
    /// Returns the remedy.
    pub fn remedy(&self) -> String {
        match self {
            ShopFault::UnknownJoint { known, .. } => format!("joints of this linkage: {}", known.join(", ")),
            ShopFault::UnknownBody { known, .. } => format!("bodies of this linkage: {}", known.join(", ")),
            ShopFault::NoHole { joint, known, .. } => format!("{joint} has holes in: {}", known.join(", ")),
            ShopFault::NoPin(joint) => format!("remove pin, and give {joint} a hole alone"),
            ShopFault::WiderThanPlate { hole, .. } => {
                format!("write a width above {hole}, or a smaller hole")
            }
            ShopFault::PinTooThick { hole, .. } => {
                format!("write a pin of at most {hole}, or a larger hole")
            }
        }
    }
}

/// The names of a linkage: its links, pins and holes.
pub struct Names {
    links: Vec<Link>,
    pins: Vec<Pin>,
    /// The joints with the links in whose plates they have holes.
    holes: Vec<(Joint, Vec<Link>)>,
}

impl Names {
    /// Returns the names of a linkage.
    pub fn of(linkage: &CrankLinkage) -> Self {
        Names { links: parts::links(linkage), pins: parts::pins(linkage), holes: parts::drilled(linkage) }
    }

    /// Returns the joint of a name.
    ///
    /// # Errors
    /// [`ShopFault::UnknownJoint`].
    pub fn joint(&self, name: &str) -> Result<Joint, ShopFault> {
        let found = self.holes.iter().map(|(joint, _)| *joint).find(|joint| joint.name() == name);
        found.ok_or_else(|| ShopFault::UnknownJoint {
            name: name.to_owned(),
            known: self.holes.iter().map(|(joint, _)| joint.name()).collect(),
        })
    }

    /// Returns the body of a name.
    ///
    /// # Errors
    /// [`ShopFault::UnknownBody`].
    pub fn body(&self, name: &str) -> Result<Link, ShopFault> {
        self.links.iter().copied().find(|link| link.name() == name).ok_or_else(|| ShopFault::UnknownBody {
            name: name.to_owned(),
            known: self.links.iter().map(|link| link.name()).collect(),
        })
    }

    /// Returns the body of a name in whose plate a joint has a hole.
    ///
    /// # Errors
    /// [`ShopFault::UnknownBody`], [`ShopFault::NoHole`].
    pub fn drilled(&self, joint: Joint, name: &str) -> Result<Link, ShopFault> {
        let link = self.body(name)?;
        let holes = self.links_of(joint);
        if holes.contains(&link) {
            return Ok(link);
        }
        let known = holes.iter().map(|link| link.name()).collect();
        Err(ShopFault::NoHole { joint: joint.name(), body: name.to_owned(), known })
    }

    /// Returns the links in whose plates a joint has holes.
    fn links_of(&self, joint: Joint) -> &[Link] {
        self.holes.iter().find(|(at, _)| *at == joint).map_or(&[], |(_, links)| links)
    }
}

impl Shop {
    /// Returns the same with every length multiplied by a factor, in another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64, unit: Option<Unit>) -> Self {
        let of = |length: Option<f64>| length.map(|length| length * factor);
        let joint = |(joint, sizes): &(Joint, JointSizes)| {
            let hole_in = sizes.hole_in.iter().map(|(link, hole)| (*link, hole * factor)).collect();
            let scaled = JointSizes { hole: of(sizes.hole), hole_in, pin: of(sizes.pin), rim: of(sizes.rim) };
            (*joint, scaled)
        };
        let body = |(link, sizes): &(Link, BodySizes)| {
            (*link, BodySizes { thickness: of(sizes.thickness), width: of(sizes.width) })
        };
        Shop {
            unit,
            hole: of(self.hole),
            margin: of(self.margin),
            thickness: of(self.thickness),
            rim: of(self.rim),
            joints: self.joints.iter().map(joint).collect(),
            bodies: self.bodies.iter().map(body).collect(),
        }
    }

    /// Returns the diameters of holes and pins of a linkage, `usual` for all that have none.
    pub fn bores(&self, names: &Names, usual: f64) -> Bores {
        let mut bores = Bores::new(usual);
        for (joint, sizes) in &self.joints {
            for link in names.links_of(*joint) {
                let own = sizes.hole_in.iter().find(|(of, _)| of == link).map(|(_, hole)| *hole);
                if let Some(hole) = own.or(sizes.hole) {
                    bores = bores.with_hole(*joint, *link, hole);
                }
            }
            if let Some(pin) = sizes.pin {
                bores = bores.with_pin(*joint, pin);
            }
        }
        bores
    }

    fn body(&self, link: Link) -> BodySizes {
        self.bodies.iter().find(|(of, _)| *of == link).map_or_else(BodySizes::default, |(_, sizes)| *sizes)
    }

    /// Returns the thickness of a plate, `usual` if it has none.
    pub fn thickness_of(&self, link: Link, usual: f64) -> f64 {
        self.body(link).thickness.unwrap_or(usual)
    }

    /// Returns the width of a plate that has one of its own.
    pub fn width_of(&self, link: Link) -> Option<f64> {
        self.body(link).width
    }

    /// Returns the least rim that a hole of this diameter needs; `letters` are the names of the joints at its place.
    pub fn rim_of(&self, letters: &str, hole: f64) -> f64 {
        let joints = Joint::all_named(letters);
        let own =
            self.joints.iter().filter(|(joint, _)| joints.contains(joint)).filter_map(|(_, sizes)| sizes.rim);
        own.reduce(f64::max).or(self.rim).unwrap_or(RIM_SHARE * hole)
    }

    /// Checks that holes are narrower than plates of a width of their own, and pins no thicker than their holes. A diameter of `bores`
    /// that is not known is NaN, and fits.
    ///
    /// # Errors
    /// The first [`ShopFault`] with the key that it is about.
    pub fn check(&self, names: &Names, bores: &Bores) -> Result<(), (Key, ShopFault)> {
        let key = |parts: &[&str]| parts.iter().map(|part| (*part).to_owned()).collect::<Key>();
        for (joint, links) in &names.holes {
            let name = joint.name();
            for link in links {
                let (body, hole) = (link.name(), bores.own(*link, *joint).unwrap_or(bores.usual));
                if let Some(width) = self.width_of(*link).filter(|width| hole >= *width) {
                    let fault = ShopFault::WiderThanPlate { joint: name, body, hole, width };
                    return Err((key(&["body", body, "width"]), fault));
                }
            }
        }
        for (joint, sizes) in &self.joints {
            let (Some(pin), name) = (sizes.pin, joint.name()) else { continue };
            let Some(joined) = names.pins.iter().find(|pin| pin.joint == *joint) else {
                return Err((key(&["joint", name, "pin"]), ShopFault::NoPin(name)));
            };
            // A guide pin also runs in a slot, which is as wide as the usual hole.
            for link in &joined.joins {
                let hole = bores.own(*link, *joint).unwrap_or(bores.usual);
                if pin > hole {
                    let fault = ShopFault::PinTooThick { joint: name, body: link.name(), pin, hole };
                    return Err((key(&["joint", name, "pin"]), fault));
                }
            }
        }
        Ok(())
    }
}
