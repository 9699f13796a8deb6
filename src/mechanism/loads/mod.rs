//! Loads of a linkage: the torque that turns the crank, the forces that its joints carry, and its energies.
//!
//! With v, a the velocities and accelerations of the bodies' centres of mass G, omega and alpha their angular ones, F and M the
//! applied forces and couples, the power balance gives the crank's torque T without any joint force,
//!
//! ```text
//! T omega_crank = sum over bodies (m a . v + I alpha omega) - sum F . v - sum M omega
//! ```
//!
//! and Newton-Euler, three equations a moving body, gives it again with the forces at all joints,
//!
//! ```text
//! sum F = m a        sum (r - O) x F + sum M = (G - O) x m a + I alpha        about any point O of the plane
//! ```
//!
//! (R. L. Norton, Design of Machinery, chapters on dynamic force analysis and, for the power balance, virtual work; derived here in
//! the form that [`newton`] states.) Positions are functions of the crank angle phi: v = v' phi_dot and a = a'' phi_dot^2 + v'
//! phi_ddot, with v' and a'' the derivatives by phi. At a crank that stands still all inertia terms vanish: statics.
//!
//! Friction is left out: joints and sliders hand on forces without loss. A force that opposes a velocity is an applied force of a
//! given size, not one that follows from a joint's load.
//!
//! All quantities are in SI: m, kg, s, N, N m, J, rad; the linkage's lengths are converted from their [`Unit`](super::Unit).
//!
//! | module | holds |
//! |---|---|
//! | `applied` | forces, couples and springs at one position |
//! | [`balance`] | springs and counter-masses that balance a loaded linkage |
//! | [`drive`] | the crank's speed and acceleration, also of a table of speeds over the crank angle |
//! | [`error`] | why loads do not fit a linkage |
//! | [`figures`] | figures over the range of the crank: peaks, means, fluctuation |
//! | [`instant`] | the result at one crank angle, as data |
//! | `kinematics` | derivatives of all places by the crank angle |
//! | [`loaded`] | a linkage with its loads, prepared for many positions |
//! | [`newton`] | equilibrium of each group of two bodies: forces at the joints |
//! | `peaks` | refinement of the largest of sampled values |
//! | [`quantity`] | quantities that are constant, or given over the crank angle |
//! | `resolve` | names of bodies and joints resolved against a linkage |
//! | `spline` | periodic cubic splines |
//! | `torque_peak` | the torque of largest size over a stretch of crank angles |

mod applied;
pub mod balance;
pub mod drive;
pub mod error;
pub mod figures;
pub mod instant;
mod kinematics;
pub mod loaded;
pub mod newton;
mod peaks;
pub mod quantity;
mod resolve;
mod spline;
mod torque_peak;

pub use drive::{CrankSpeed, Drive, SpeedRange};
pub use error::{LoadError, LoadFault, LoadKey};
pub use figures::{LoadFigures, Peak};
pub use instant::{Instant, JointForce};
pub use loaded::{LoadedLinkage, Scratch};
pub use quantity::Quantity;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Masses, forces, couples and springs of a linkage, by the names of its bodies and joints; in SI units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Loads {
    /// The acceleration of free fall, m/s^2; 0 without gravity.
    #[serde(rename = "gravity_m_s2")]
    pub gravity: [f64; 2],
    /// The speed of the crank, rad/s, if none is given elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_rad_s: Option<CrankSpeed>,
    /// The masses of bodies; others have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<BodyMass>,
    /// The forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces: Vec<Force>,
    /// The couples.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub couples: Vec<Couple>,
    /// The springs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub springs: Vec<Spring>,
}

/// A body with its mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BodyMass {
    /// The name of the body.
    pub body: String,
    /// Its mass.
    pub mass: Mass,
}

/// Mass, centre of mass and inertia of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// As given.
    Given {
        /// kg.
        mass_kg: f64,
        /// Along and across from the body's first joint, m.
        #[serde(rename = "center_m")]
        center: [f64; 2],
        /// About the centre of mass, kg m^2.
        inertia_kg_m2: f64,
    },
    /// With its centre in one of the body's joints or points.
    AtJoint {
        /// kg.
        mass_kg: f64,
        /// The name of the joint or point.
        joint: String,
        /// About the centre of mass, kg m^2.
        inertia_kg_m2: f64,
    },
    /// Of a flat plate around the body's joints and points: every point within half a width of their hull.
    Plate {
        /// kg/m^3.
        density_kg_m3: f64,
        /// m.
        #[serde(rename = "thickness_m")]
        thickness: f64,
        /// The width of the plate about two joints, m.
        #[serde(rename = "width_m")]
        width: f64,
    },
}

/// A place at which a force or a spring acts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// A joint or an attached point, by its name.
    Joint(String),
    /// A fixed point of the plane, m.
    #[serde(rename = "fixed_m")]
    Fixed([f64; 2]),
    /// A place on a body, along and across from its first joint, m.
    #[serde(rename = "on_body_m")]
    OnBody(String, [f64; 2]),
}

/// A force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Force {
    /// The place at which it acts.
    pub at: Place,
    /// The body on which it acts, of those that a joint connects; `None`: the first that moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Its direction and size.
    pub vector: ForceVector,
}

/// Direction and size of a force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceVector {
    /// Along x and y, N; with a body along and across its direction, so that it turns with it.
    #[serde(rename = "vector_N")]
    Vector(Quantity<2>, Option<String>),
    /// Against the velocity of its point, N: of the crank that turns as it does, counter-clockwise if it stands still.
    #[serde(rename = "opposing_N")]
    Opposing(Quantity<1>),
}

/// A couple on a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Couple {
    /// The name of the body.
    pub body: String,
    /// N m, counter-clockwise positive.
    #[serde(rename = "moment_N_m")]
    pub moment: Quantity<1>,
}

/// A spring without mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spring {
    /// Between two places, along the line that joins them.
    Extension {
        /// The ends.
        ends: [Place; 2],
        /// N/m.
        #[serde(rename = "rate_N_per_m")]
        rate: f64,
        /// The length at which it bears no force, m.
        #[serde(rename = "free_length_m")]
        free_length: f64,
    },
    /// Between two bodies, by the angle between their directions.
    Torsion {
        /// The body on which it acts, and the one that bears it, often the ground.
        bodies: [String; 2],
        /// N m/rad.
        #[serde(rename = "rate_N_m_per_rad")]
        rate: f64,
        /// The angle of the first body's direction from the second's at which it bears no moment, radians. Its deflection is
        /// taken in (-pi, pi].
        #[serde(rename = "free_angle_rad")]
        free_angle: f64,
    },
}
