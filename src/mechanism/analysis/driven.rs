//! Analysis of a linkage of any kind: every joint's position, velocity and acceleration at crank angles, and for kinds with
//! one coupler its angle, the slider's place and the transmission angle.

use super::Status;
use super::loaded::LoadRecord;
pub use crate::mechanism::chain::kind::CYCLE_SAMPLES;
use crate::mechanism::loads::{Drive, Instant};
use crate::mechanism::{Complex, Linkage, Mechanism, Output, OutputRate, Unit, bounding_box, xy};
use serde::Serialize;
use std::f64::consts::TAU;

/// A request for the analysis of a linkage of any kind.
#[derive(Clone, Debug)]
pub struct MechanismRequest {
    /// Its name.
    pub name: String,
    /// The unit that labels its lengths.
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: Linkage,
    /// The crank angles, degrees from the x axis.
    pub crank_deg: Vec<f64>,
    /// The motion of the crank.
    pub input: Drive,
}

/// Position, velocity and acceleration of a point at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointRow {
    /// Its name.
    pub name: String,
    /// Its position; absent for points of and after a stage that does not close.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// Its velocity; absent at a toggle of its stage or one before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<[f64; 2]>,
    /// Its acceleration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<[f64; 2]>,
}

/// Coupler and slider at one crank angle; a value is absent where it is not known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CouplerRow {
    /// theta3, the direction of the coupler, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupler_deg: Option<f64>,
    /// mu, the transmission angle, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmission_deg: Option<f64>,
    /// Angular velocity of the coupler.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega3_rad_s: Option<f64>,
    /// Angular acceleration of the coupler.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha3_rad_s2: Option<f64>,
    /// The slider's place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider: Option<f64>,
    /// Its first derivative, in units of length a second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider_speed: Option<f64>,
    /// Its second derivative, in units of length a second squared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider_acceleration: Option<f64>,
}

/// Results at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MechanismRow {
    /// The crank angle, degrees from the x axis.
    pub crank_deg: f64,
    /// The status of the result.
    pub status: Status,
    /// The joint that cannot be placed, or whose motion is not decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    /// Every point that moves: the crank's joint first.
    pub points: Vec<PointRow>,
    /// Coupler and slider; absent for chains.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub coupler: Option<CouplerRow>,
    /// Torque, joint forces and energies, if loads were added and the motion is definite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads: Option<Box<Instant>>,
}

/// Bounding box of the traced point's path over a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stroke {
    /// Least x and y.
    pub low: [f64; 2],
    /// Greatest x and y.
    pub high: [f64; 2],
}

/// Mobility of a kind of one loop, in closed form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoopRecord {
    /// The crank turns fully if this length is at least zero.
    pub full_turn_margin: f64,
    /// Crank angles of the toggles, degrees.
    pub toggles_deg: Vec<f64>,
    /// Number of circuits.
    pub circuits: u8,
    /// Number of branches of each circuit.
    pub branches_per_circuit: u8,
    /// The least and the greatest transmission angle over the range of the crank, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmission_deg: Option<[f64; 2]>,
    /// The worst transmission angle, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_transmission_deg: Option<f64>,
    /// Ratio of the longest to the shortest link; absent for coincident pivots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub link_ratio: Option<f64>,
    /// The least and the greatest place of the slider over a turn, from [`CYCLE_SAMPLES`] samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider_range: Option<[f64; 2]>,
}

/// Result of the analysis of a linkage of any kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MechanismAnalysis {
    /// Version of the format: 1.
    pub format: u32,
    /// The linkage's name.
    pub name: String,
    /// The unit that labels lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// The kind; absent for chains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<&'static str>,
    /// The motion of the crank.
    #[serde(skip)]
    pub drive: Drive,
    /// omega2, the angular velocity of the crank; of a table of speeds its mean over time.
    pub omega2_rad_s: f64,
    /// alpha2, the angular acceleration of the crank; of a table of speeds 0, its mean over time.
    pub alpha2_rad_s2: f64,
    /// Number of stages that follow the crank of a chain; absent for other kinds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<usize>,
    /// Name of the point whose path is shown.
    pub trace: String,
    /// Whether the crank turns fully (of a chain found from [`CYCLE_SAMPLES`] samples).
    pub input_turns_fully: bool,
    /// [from, to] of each arc that the crank can reach, degrees; empty for a full turn, or if there is none.
    pub input_arcs_deg: Vec<[f64; 2]>,
    /// Mobility in closed form; absent for chains.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub mobility: Option<LoopRecord>,
    /// Bounding box of the traced path; absent if the point is known at no crank angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Stroke>,
    /// Loads over the range of the crank, if they were added.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads: Option<LoadRecord>,
    /// One row for each crank angle requested.
    pub rows: Vec<MechanismRow>,
}

/// Analyses a linkage as requested.
pub fn analyze_mechanism(request: &MechanismRequest) -> MechanismAnalysis {
    let mechanism = request.linkage.mechanism();
    let range = mechanism.crank_range();
    let path: Vec<Complex> = mechanism.path(CYCLE_SAMPLES).into_iter().flatten().collect();
    let stroke = (!path.is_empty()).then(|| {
        let [low, high] = bounding_box(path.iter().copied()).map(xy);
        Stroke { low, high }
    });
    let stages = match &request.linkage {
        Linkage::Chain(chain) => Some(chain.stages()),
        _ => None,
    };
    let of_loop = |([circuits, branches_per_circuit], full_turn_margin): ([u8; 2], f64)| {
        let extremes = mechanism.transmission_extremes();
        LoopRecord {
            full_turn_margin,
            toggles_deg: range.toggles.iter().copied().map(f64::to_degrees).collect(),
            circuits,
            branches_per_circuit,
            transmission_deg: extremes.map(|e| [e.min.to_degrees(), e.max.to_degrees()]),
            worst_transmission_deg: extremes.map(|e| e.worst().to_degrees()),
            link_ratio: mechanism.longest_to_shortest(),
            slider_range: slider_range(mechanism),
        }
    };
    MechanismAnalysis {
        format: 1,
        name: request.name.clone(),
        unit: request.unit,
        kind: stages.is_none().then_some(mechanism.kind()),
        omega2_rad_s: request.input.mean().speed_rad_s,
        alpha2_rad_s2: request.input.mean().acceleration_rad_s2,
        drive: request.input.clone(),
        stages,
        trace: mechanism.joint_names()[mechanism.traced()].to_owned(),
        input_turns_fully: range.turns_fully,
        input_arcs_deg: range.arcs.iter().map(|arc| arc.map(f64::to_degrees)).collect(),
        mobility: range.circuits.zip(range.margin).map(of_loop),
        stroke,
        loads: None,
        rows: request.crank_deg.iter().map(|deg| row(mechanism, *deg, &request.input)).collect(),
    }
}

/// Returns the least and the greatest place of the slider over a turn; `None` without a slider or a position.
pub fn slider_range(mechanism: &dyn Mechanism) -> Option<[f64; 2]> {
    let place = |i: usize| match mechanism.pose_at(TAU * i as f64 / CYCLE_SAMPLES as f64).output {
        Some(Output::Slider(place)) => Some(place),
        Some(Output::Follower(_)) | None => None,
    };
    (0..CYCLE_SAMPLES)
        .filter_map(place)
        .map(|place| [place, place])
        .reduce(|[low, high], [x, y]| [low.min(x), high.max(y)])
}

fn row(mechanism: &dyn Mechanism, crank_deg: f64, input: &Drive) -> MechanismRow {
    let angle = crank_deg.to_radians();
    let motion = mechanism.motion_at(angle, input.motion(angle));
    let (names, pose) = (mechanism.joint_names(), &motion.pose);
    let point = |(i, name): (usize, &&str)| PointRow {
        name: (*name).to_owned(),
        at: pose.joints[i].map(xy),
        velocity: motion.velocities[i].map(xy),
        acceleration: motion.accelerations[i].map(xy),
    };
    let place = match pose.output {
        Some(Output::Slider(place)) => Some(place),
        Some(Output::Follower(_)) | None => None,
    };
    let sliding = match motion.output {
        Some(OutputRate::Slider(sliding)) => Some(sliding),
        Some(OutputRate::Follower(_)) | None => None,
    };
    let coupler = (mechanism.kind() != "chain").then(|| CouplerRow {
        coupler_deg: pose.coupler.map(|u| u.arg().to_degrees()),
        transmission_deg: pose.transmission.map(f64::to_degrees),
        omega3_rad_s: motion.coupler.map(|turning| turning.speed_rad_s),
        alpha3_rad_s2: motion.coupler.map(|turning| turning.acceleration_rad_s2),
        slider: place,
        slider_speed: sliding.map(|s| s.speed),
        slider_acceleration: sliding.map(|s| s.acceleration),
    });
    MechanismRow {
        crank_deg,
        status: pose.status,
        joint: pose.stuck.map(|i| names[i].to_owned()),
        // The pivots, which come first among the names, stay where they are.
        points: names.iter().enumerate().skip(mechanism.pivots()).map(point).collect(),
        coupler,
        loads: None,
    }
}
