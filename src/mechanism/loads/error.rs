//! Reasons why loads do not fit a linkage, each with the load and the key that it is about.

use std::f64::consts::TAU;
use std::fmt;

/// A load, and one of its keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadKey {
    /// Gravity, or the speed.
    Top(&'static str),
    /// A body's mass, by the name of the body.
    Body(String, &'static str),
    /// A force, counted from 0.
    Force(usize, &'static str),
    /// A couple, counted from 0.
    Couple(usize, &'static str),
    /// A spring, counted from 0.
    Spring(usize, &'static str),
}

/// A load that does not fit its linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadError {
    /// The load and the key.
    pub key: LoadKey,
    /// The fault.
    pub fault: LoadFault,
}

/// A fault of a load.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadFault {
    /// The linkage has no such body.
    UnknownBody {
        /// The name.
        name: String,
        /// The names of its bodies.
        known: Vec<String>,
    },
    /// The linkage has no such joint.
    UnknownJoint {
        /// The name.
        name: String,
        /// The names of its joints.
        known: Vec<String>,
    },
    /// The body has its mass already, under another of its names.
    SecondMass(String),
    /// The body is the ground, which does not move.
    OnGround,
    /// A joint that is not on the body.
    NotOnBody {
        /// The joint.
        joint: String,
        /// The body.
        body: String,
        /// The bodies that carry the joint.
        carriers: Vec<String>,
    },
    /// A force at a fixed point.
    ForceAtFixedPoint,
    /// The two ends of a spring are the same, or both do not move.
    SameEnds,
    /// The two bodies of a torsion spring are one.
    SameBodies,
    /// A body whose outline does not follow from its joints.
    NoPlate(String),
    /// A number that is not finite.
    NotFinite(f64),
    /// A number that may not be negative.
    Negative(f64),
    /// A table of fewer than two rows, or not in ascending order within one turn.
    BadTable,
    /// A table of speeds with two speeds at one crank angle, its first and its last row a turn apart.
    SpeedJumps {
        /// The row, counted from 0.
        row: usize,
    },
    /// A table of speeds with a row of 0 or of the other sign.
    SpeedStops {
        /// The row, counted from 0.
        row: usize,
        /// Its speed.
        speed_rad_s: f64,
    },
    /// A table of speeds whose smooth curve reaches 0 between two rows.
    SpeedStopsBetween {
        /// The crank angle of its slowest speed, radians.
        crank_angle: f64,
        /// That speed.
        speed_rad_s: f64,
    },
    /// An acceleration beside a table of speeds.
    AccelerationOfTable,
    /// The linkage is beyond the limits of a chain.
    NoChain,
    /// The linkage has no unit of lengths.
    NoUnit,
}

impl fmt::Display for LoadFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LoadFault::UnknownBody { name, .. } => write!(f, "the linkage has no body {name:?}"),
            LoadFault::UnknownJoint { name, .. } => write!(f, "the linkage has no joint or point {name:?}"),
            LoadFault::SecondMass(name) => write!(f, "{name} has its mass already, under another name"),
            LoadFault::OnGround => {
                f.write_str("the ground does not move: neither its mass nor a load on it counts")
            }
            LoadFault::NotOnBody { joint, body, .. } => write!(f, "{joint} is not on {body}"),
            LoadFault::ForceAtFixedPoint => f.write_str("a force at a fixed point moves nothing"),
            LoadFault::SameEnds => f.write_str("the two ends of this spring never move against each other"),
            LoadFault::SameBodies => {
                f.write_str("a torsion spring acts between two bodies, and these are one")
            }
            LoadFault::NoPlate(name) => write!(f, "the outline of {name} does not follow from its joints"),
            LoadFault::NotFinite(value) => write!(f, "{value} is not a finite number"),
            LoadFault::Negative(value) => write!(f, "{value} is negative"),
            LoadFault::BadTable => {
                f.write_str("a table needs two rows or more, with ascending crank angles within one turn")
            }
            LoadFault::AccelerationOfTable => f.write_str(
                "the loads give the speed over the crank angle, and the acceleration follows from it",
            ),
            LoadFault::SpeedJumps { .. } => {
                f.write_str("the first and the last row are a turn apart, and their speeds differ")
            }
            LoadFault::SpeedStops { speed_rad_s: 0.0, .. } => {
                f.write_str("the crank stops in this row: a speed over the crank angle is nowhere 0")
            }
            LoadFault::SpeedStops { speed_rad_s, .. } => write!(
                f,
                "the crank turns back in this row, at {} rpm: all speeds over the crank angle have one sign",
                rpm(*speed_rad_s)
            ),
            LoadFault::SpeedStopsBetween { crank_angle, speed_rad_s } => write!(
                f,
                "between two rows, at {:.2} degrees, the smooth curve through the speeds falls to {:.3} rpm: it is nowhere 0",
                crank_angle.to_degrees(),
                rpm(*speed_rad_s)
            ),
            LoadFault::NoUnit => {
                f.write_str("the linkage has no unit, so that its lengths in metres are not known")
            }
            LoadFault::NoChain => f.write_str("the linkage is beyond the limits of a chain"),
        }
    }
}

impl LoadFault {
    /// Returns the remedy.
    pub fn remedy(&self) -> String {
        match self {
            LoadFault::UnknownBody { known, .. } => format!("bodies of this linkage: {}", listed(known)),
            LoadFault::UnknownJoint { known, .. } => {
                format!("joints and points of this linkage: {}", listed(known))
            }
            LoadFault::SecondMass(_) => "keep one of the two tables".into(),
            LoadFault::OnGround => "name a body that moves, or leave this out".into(),
            LoadFault::NotOnBody { joint, carriers, .. } if carriers.len() == 1 => format!(
                "{joint} is on {}; what hangs at {joint}, whatever body carries it, is the body {joint:?}",
                listed(carriers)
            ),
            LoadFault::NotOnBody { joint, carriers, .. } => format!("{joint} is on {}", listed(carriers)),
            LoadFault::ForceAtFixedPoint => {
                "name a joint, or a place on a body: { body = \"coupler\", at = [20, 5] }".into()
            }
            LoadFault::SameEnds => {
                "name two places on two bodies, one of which may be a fixed point [x, y]".into()
            }
            LoadFault::SameBodies => "name another body, or leave `against` out for the ground".into(),
            LoadFault::NoPlate(_) => {
                "give mass_kg, center and inertia_kg_m2 in place of density_kg_m3".into()
            }
            LoadFault::NotFinite(_) => "write a finite number".into(),
            LoadFault::Negative(_) => "write a number of 0 or more".into(),
            LoadFault::BadTable => "write rows such as [[0, 5], [90, 8], [270, 2]]".into(),
            LoadFault::AccelerationOfTable => {
                "leave the acceleration out, or give a constant speed with it (omega or rpm)".into()
            }
            LoadFault::SpeedJumps { .. } => "write the same speed in both, or leave the last row out".into(),
            LoadFault::SpeedStops { .. } => {
                "write speeds of one sign, none of them 0: a crank that stops or turns back has no speed over its angle".into()
            }
            LoadFault::SpeedStopsBetween { .. } => "add rows there, or make the change less steep".into(),
            LoadFault::NoUnit => "write unit = \"mm\" (or cm, m, in) into the linkage's file".into(),
            LoadFault::NoChain => "use smaller numbers".into(),
        }
    }
}

/// Returns a speed in turns a minute.
fn rpm(speed_rad_s: f64) -> f64 {
    // To six digits after the point: the speed was converted.
    (speed_rad_s * 60.0 / TAU * 1e6).round() / 1e6
}

/// Returns names as a list; more than 24 are no help.
fn listed(names: &[String]) -> String {
    const LISTED: usize = 24;
    let more = if names.len() > LISTED { ", .." } else { "" };
    format!("{}{more}", names[..names.len().min(LISTED)].join(", "))
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.key {
            LoadKey::Top(key) => write!(f, "{key}: ")?,
            LoadKey::Body(name, key) => write!(f, "body {name}, {key}: ")?,
            LoadKey::Force(i, key) => write!(f, "force {}, {key}: ", i + 1)?,
            LoadKey::Couple(i, key) => write!(f, "couple {}, {key}: ", i + 1)?,
            LoadKey::Spring(i, key) => write!(f, "spring {}, {key}: ", i + 1)?,
        }
        self.fault.fmt(f)
    }
}

impl std::error::Error for LoadError {}
