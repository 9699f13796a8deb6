//! The result at one crank angle, as data.

use crate::mechanism::four_bar::motion::CrankMotion;
use serde::Serialize;

/// The force that a body puts on another at a joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointForce {
    /// The name of the joint.
    pub at: String,
    /// The body on which the force acts.
    pub on: String,
    /// The body that it comes from.
    pub from: String,
    /// A pin's force along x and y, N; absent of a slider.
    #[serde(rename = "force_N", skip_serializing_if = "Option::is_none")]
    pub force: Option<[f64; 2]>,
    /// A slider's force across its line, to the left of its direction, N.
    #[serde(rename = "normal_N", skip_serializing_if = "Option::is_none")]
    pub normal: Option<f64>,
    /// A slider's moment about the joint, N m.
    #[serde(rename = "moment_N_m", skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
}

/// Torque, forces and energies at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Instant {
    /// The crank's speed and acceleration there; absent of a constant speed.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub input: Option<CrankMotion>,
    /// The torque of the motor on the crank, counter-clockwise positive, N m.
    #[serde(rename = "torque_N_m")]
    pub torque: f64,
    /// The power of the motor, W.
    #[serde(rename = "power_W")]
    pub power: f64,
    /// The forces of all pairs, in the order of the structure.
    pub forces: Vec<JointForce>,
    /// The shaking force: of the mechanism on the ground, springs included, N.
    #[serde(rename = "shaking_force_N")]
    pub shaking_force: [f64; 2],
    /// The shaking moment: of the mechanism and the motor on the ground about the crank's pivot, N m.
    #[serde(rename = "shaking_moment_N_m")]
    pub shaking_moment: f64,
    /// The kinetic energy, J.
    #[serde(rename = "kinetic_J")]
    pub kinetic: f64,
    /// The potential energy of gravity and springs, J.
    #[serde(rename = "potential_J")]
    pub potential: f64,
    /// The force along the path of the traced point for each N m on the crank, 1/m; absent where the point stands still.
    #[serde(rename = "advantage_per_m", skip_serializing_if = "Option::is_none")]
    pub advantage: Option<f64>,
    /// The output for each N m on the crank: N m of a body that turns, N of a slider; absent without an output, or where it stands
    /// still.
    #[serde(rename = "output_advantage", skip_serializing_if = "Option::is_none")]
    pub output_advantage: Option<f64>,
}
