//! Analysis of a chain (compound mechanism): every point's position, velocity and acceleration at crank angles.

use super::Status;
use crate::mechanism::Unit;
use crate::mechanism::chain::{ChainInput, Motion, Outcome, PointId};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::{Chain, Complex, bounding_box, xy};
use serde::Serialize;

/// Number of crank angles from which the input range and the traced path are found.
pub const CYCLE_SAMPLES: usize = 720;

/// A request for the analysis of a chain.
#[derive(Clone, Debug)]
pub struct ChainRequest {
    /// Its name.
    pub name: String,
    /// The unit that labels its lengths.
    pub unit: Option<Unit>,
    /// The chain.
    pub chain: Chain,
    /// The crank angles, degrees from the x axis.
    pub crank_deg: Vec<f64>,
    /// The motion of the crank.
    pub input: CrankMotion,
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

/// Results at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChainRow {
    /// The crank angle, degrees from the x axis.
    pub crank_deg: f64,
    /// The status of the result.
    pub status: Status,
    /// The joint whose stage is open or singular.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    /// Every point that moves: the crank's joint, then one a stage.
    pub points: Vec<PointRow>,
}

/// Bounding box of the traced point's path over a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stroke {
    /// Least x and y.
    pub low: [f64; 2],
    /// Greatest x and y.
    pub high: [f64; 2],
}

/// Result of the analysis of a chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChainAnalysis {
    /// Version of the format: 1.
    pub format: u32,
    /// The chain's name.
    pub name: String,
    /// The unit that labels lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// omega2, the angular velocity of the crank.
    pub omega2_rad_s: f64,
    /// alpha2, the angular acceleration of the crank.
    pub alpha2_rad_s2: f64,
    /// Number of stages that follow the crank.
    pub stages: usize,
    /// Name of the point whose path is shown.
    pub trace: String,
    /// Whether the crank turns fully (found from [`CYCLE_SAMPLES`] samples).
    pub input_turns_fully: bool,
    /// [from, to] of each arc that the crank can reach, degrees; empty for a full turn, or if there is none.
    pub input_arcs_deg: Vec<[f64; 2]>,
    /// Bounding box of the traced path; absent if the point is known at no crank angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Stroke>,
    /// One row for each crank angle requested.
    pub rows: Vec<ChainRow>,
}

/// Analyses a chain as requested.
pub fn analyze_chain(request: &ChainRequest) -> ChainAnalysis {
    let chain = &request.chain;
    let input = chain.input(CYCLE_SAMPLES);
    let path: Vec<Complex> = chain.path(chain.trace(), CYCLE_SAMPLES).into_iter().flatten().collect();
    let stroke = (!path.is_empty()).then(|| {
        let [low, high] = bounding_box(path.iter().copied()).map(xy);
        Stroke { low, high }
    });
    let mut motion = chain.motion();
    let rows = request.crank_deg.iter().map(|deg| row(chain, *deg, request.input, &mut motion)).collect();
    ChainAnalysis {
        format: 1,
        name: request.name.clone(),
        unit: request.unit,
        omega2_rad_s: request.input.speed_rad_s,
        alpha2_rad_s2: request.input.acceleration_rad_s2,
        stages: chain.stages(),
        trace: chain.names()[chain.trace().index()].clone(),
        input_turns_fully: input.is_full(),
        input_arcs_deg: match input {
            ChainInput::Full | ChainInput::Never => Vec::new(),
            ChainInput::Arcs(arcs) => {
                arcs.iter().map(|arc| [arc.from.to_degrees(), arc.to.to_degrees()]).collect()
            }
        },
        stroke,
        rows,
    }
}

fn row(chain: &Chain, crank_deg: f64, input: CrankMotion, motion: &mut Motion) -> ChainRow {
    let outcome = chain.move_at(crank_deg.to_radians(), input.speed_rad_s, input.acceleration_rad_s2, motion);
    let status = match outcome {
        Outcome::Closed => Status::Ok,
        Outcome::Open { .. } => Status::Open,
        Outcome::Singular { .. } => Status::Singular,
        Outcome::InputNotUsable => Status::NotFinite,
    };
    let joint = outcome.stage().and_then(|stage| chain.joint_of(stage));
    let point = |(i, name): (usize, &String)| PointRow {
        name: name.clone(),
        at: motion.point(PointId(i)).map(xy),
        velocity: motion.velocity(PointId(i)).map(xy),
        acceleration: motion.acceleration(PointId(i)).map(xy),
    };
    ChainRow {
        crank_deg,
        status,
        joint: joint.map(|id| chain.names()[id.index()].clone()),
        // The pivots, which come first among the names, stay where they are.
        points: chain.names().iter().enumerate().skip(chain.pivots.len()).map(point).collect(),
    }
}
