//! Analysis of a given linkage: positions, velocities and accelerations at crank angles, by one method or by several
//! side by side, in one configuration or in all four.
//!
//! The results are plain data; reports are made from them elsewhere. A missing value is `None`, with a status that
//! gives the reason, never a NaN.

pub mod driven;
pub mod loaded;

pub use crate::mechanism::any::Status;

use crate::mechanism::Unit;
use crate::mechanism::four_bar::loop_closure::{
    Iteration, IterationOptions, IterationVerdict, LoopRoot, LoopRoots, Singularity,
};
use crate::mechanism::four_bar::motion::Motion;
use crate::mechanism::loads::{Drive, Instant};
use crate::mechanism::{
    AssemblyMode, Complex, CouplerSide, FourBar, LinkageType, NaturalCoordinates, point, xy,
};
use loaded::LoadRecord;
use serde::Serialize;

/// A method of position analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PositionMethod {
    /// Natural coordinates (Romero 2016, equations 10 to 19).
    Natural,
    /// Algebraic (Norton 4.2d-g).
    Algebraic,
    /// Complex numbers: the quadratic in e^{i theta4}.
    Complex,
    /// Fixed-point iteration (De Castro, equations 4 and 5, with atan2).
    FixedPoint,
}

impl PositionMethod {
    /// All methods, the natural coordinates first.
    pub const ALL: [PositionMethod; 4] = [
        PositionMethod::Natural,
        PositionMethod::Algebraic,
        PositionMethod::Complex,
        PositionMethod::FixedPoint,
    ];

    /// Returns the name of the method: natural, algebraic, complex or fixed-point.
    pub fn name(self) -> &'static str {
        match self {
            PositionMethod::Natural => "natural",
            PositionMethod::Algebraic => "algebraic",
            PositionMethod::Complex => "complex",
            PositionMethod::FixedPoint => "fixed-point",
        }
    }
}

/// The error of a word that names no method.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no method {0:?}: choose from natural, algebraic, complex, fixed-point")]
pub struct UnknownMethod(pub String);

impl std::str::FromStr for PositionMethod {
    type Err = UnknownMethod;
    fn from_str(text: &str) -> Result<Self, UnknownMethod> {
        let found = PositionMethod::ALL.into_iter().find(|m| m.name() == text.trim());
        found.ok_or_else(|| UnknownMethod(text.trim().to_owned()))
    }
}

/// A request for the analysis of a linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The linkage's name.
    pub name: String,
    /// The unit that labels its lengths.
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: FourBar,
    /// The crank angles, degrees from the x axis.
    pub crank_deg: Vec<f64>,
    /// The motion of the crank.
    pub input: Drive,
    /// The methods besides the natural coordinates, which are always used.
    pub methods: Vec<PositionMethod>,
    /// Whether all four (t1, t2) are analysed instead of the linkage's own.
    pub all_configurations: bool,
}

/// Position of the linkage: joints and link angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// C, the crank pin.
    #[serde(rename = "C")]
    pub crank_pin: [f64; 2],
    /// D, the follower pin.
    #[serde(rename = "D")]
    pub follower_pin: [f64; 2],
    /// P, the coupler point.
    #[serde(rename = "P")]
    pub coupler_point: [f64; 2],
    /// theta3, the direction from C to D, degrees.
    pub coupler_deg: f64,
    /// theta4, the direction from B to D, degrees.
    pub follower_deg: f64,
    /// mu, the transmission angle between coupler and follower, in [0, 180] degrees.
    pub transmission_deg: f64,
}

/// Velocities and accelerations of the joints and links.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "the letters of the analyze table")]
pub struct Rates {
    /// Angular velocity of the coupler.
    pub omega3_rad_s: f64,
    /// Angular velocity of the follower.
    pub omega4_rad_s: f64,
    /// Velocity of C.
    pub vC: [f64; 2],
    /// Velocity of D.
    pub vD: [f64; 2],
    /// Velocity of P.
    pub vP: [f64; 2],
    /// Angular acceleration of the coupler.
    pub alpha3_rad_s2: f64,
    /// Angular acceleration of the follower.
    pub alpha4_rad_s2: f64,
    /// Acceleration of C.
    pub aC: [f64; 2],
    /// Acceleration of D.
    pub aD: [f64; 2],
    /// Acceleration of P.
    pub aP: [f64; 2],
}

/// Results at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The crank angle, degrees from the x axis.
    pub crank_deg: f64,
    /// The status of the result.
    pub status: Status,
    /// The position, if there is one.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// The velocities and accelerations, if they are definite.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub rates: Option<Rates>,
    /// Romero's assembly condition at this position.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub assembly: Option<ConditionRecord>,
    /// The results of the other methods.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub methods: Vec<MethodRow>,
    /// Torque, joint forces and energies, if loads were added and the motion is definite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads: Option<Box<Instant>>,
}

/// Romero's condition (20) beside the sufficient one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConditionRecord {
    /// (b^2 + d^2)/(l1^2 + l2^2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// Whether (20) holds: the ratio is at least 1.
    pub necessary: bool,
    /// Whether both triangles close.
    pub sufficient: bool,
}

/// Result of another method at one crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodRow {
    /// The method.
    pub method: PositionMethod,
    /// `ok`, or the reason why it has no answer.
    pub status: &'static str,
    /// The assembly mode of the position that it found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub t1: Option<AssemblyMode>,
    /// theta3, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupler_deg: Option<f64>,
    /// theta4, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follower_deg: Option<f64>,
    /// P, the coupler point.
    #[serde(rename = "P", skip_serializing_if = "Option::is_none")]
    pub coupler_point: Option<[f64; 2]>,
    /// The distance of its P from that of the natural coordinates on the same assembly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_natural: Option<f64>,
    /// Number of rounds of the fixed-point iteration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterations: Option<u32>,
}

/// Results for one pair of signs (t1, t2).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// The linkage with these signs.
    pub linkage: FourBar,
    /// One row for each crank angle.
    pub rows: Vec<Row>,
}

/// Mobility of a linkage, which does not depend on the crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MobilityRecord {
    /// The type; absent if the links cannot be assembled.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// The Grashof margin p + q - s - l.
    pub grashof_margin: f64,
    /// The crank angles that can be reached, degrees: [from, to] of each arc; empty if there are none, or for a full
    /// turn.
    pub input_arcs_deg: Vec<[f64; 2]>,
    /// Whether the input turns fully.
    pub input_turns_fully: bool,
    /// Crank angles at which coupler and follower are in line, degrees.
    pub toggles_deg: Vec<f64>,
    /// Number of circuits.
    pub circuits: u8,
    /// Number of branches of each circuit.
    pub branches_per_circuit: u8,
    /// The least and the greatest transmission angle over the range of the input, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmission_deg: Option<[f64; 2]>,
    /// The worst transmission angle, the least min(mu, 180 - mu), degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_transmission_deg: Option<f64>,
    /// Ratio of the longest to the shortest link; absent for coincident pivots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub link_ratio: Option<f64>,
}

/// Result of the analysis of a linkage.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Analysis {
    /// Version of the format: 1.
    pub format: u32,
    /// The linkage's name.
    pub name: String,
    /// The unit that labels lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// The motion of the crank.
    #[serde(skip)]
    pub drive: Drive,
    /// omega2, the angular velocity of the crank; of a table of speeds its mean over time.
    pub omega2_rad_s: f64,
    /// alpha2, the angular acceleration of the crank; of a table of speeds 0, its mean over time.
    pub alpha2_rad_s2: f64,
    /// The mobility of the linkage.
    pub mobility: MobilityRecord,
    /// Loads over the range of the crank, if they were added.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads: Option<LoadRecord>,
    /// The configurations asked for, the linkage's own first.
    pub configurations: Vec<Configuration>,
}

/// Returns evenly spaced crank angles over a full turn from 0, degrees.
pub fn full_turn(positions: usize) -> Vec<f64> {
    (0..positions).map(|i| 360.0 * i as f64 / positions as f64).collect()
}

/// Analyses a linkage as requested.
pub fn analyze(request: &Request) -> Analysis {
    let own = request.linkage.natural_coordinates();
    let own_signs = (own.assembly, own.side);
    // Romero's order (figure 3): open and crossed, then the other side of the coupler.
    let all = [AssemblyMode::Plus, AssemblyMode::Minus]
        .into_iter()
        .flat_map(|t1| [CouplerSide::Plus, CouplerSide::Minus].map(|t2| (t1, t2)));
    let others = all.filter(|signs| request.all_configurations && *signs != own_signs);
    let configurations = std::iter::once(own_signs)
        .chain(others)
        .filter_map(|(assembly, side)| FourBar::new(NaturalCoordinates { assembly, side, ..own }).ok())
        .map(|linkage| Configuration {
            rows: request.crank_deg.iter().map(|deg| row(&linkage, *deg, request)).collect(),
            linkage,
        })
        .collect();
    Analysis {
        format: 1,
        name: request.name.clone(),
        unit: request.unit,
        omega2_rad_s: request.input.mean().speed_rad_s,
        alpha2_rad_s2: request.input.mean().acceleration_rad_s2,
        drive: request.input.clone(),
        mobility: mobility(&request.linkage),
        loads: None,
        configurations,
    }
}

fn row(linkage: &FourBar, crank_deg: f64, request: &Request) -> Row {
    let angle = crank_deg.to_radians();
    let motion = linkage.motion(angle, request.input.motion(angle));
    let status = match motion {
        Motion::Definite(_) => Status::Ok,
        Motion::Singular(_) => Status::Singular,
        Motion::Open => Status::Open,
        Motion::Undetermined => Status::Undetermined,
        Motion::NotFinite => Status::NotFinite,
    };
    let pose = motion.posture().map(|posture| Pose {
        crank_pin: xy(posture.joints.crank_pin),
        follower_pin: xy(posture.joints.follower_pin),
        coupler_point: xy(posture.joints.coupler_point),
        coupler_deg: posture.coupler_angle.to_degrees(),
        follower_deg: posture.follower_angle.to_degrees(),
        transmission_deg: linkage.angle_at_follower_pin(angle).to_degrees(),
    });
    let rates = motion.definite().map(|m| Rates {
        omega3_rad_s: m.coupler.speed_rad_s,
        omega4_rad_s: m.follower.speed_rad_s,
        vC: xy(m.crank_pin.velocity),
        vD: xy(m.follower_pin.velocity),
        vP: xy(m.coupler_point.velocity),
        alpha3_rad_s2: m.coupler.acceleration_rad_s2,
        alpha4_rad_s2: m.follower.acceleration_rad_s2,
        aC: xy(m.crank_pin.acceleration),
        aD: xy(m.follower_pin.acceleration),
        aP: xy(m.coupler_point.acceleration),
    });
    let assembly = linkage.assembly_condition(angle).map(|condition| ConditionRecord {
        ratio: condition.ratio,
        necessary: condition.necessary(),
        sufficient: condition.sufficient(),
    });
    let others = request.methods.iter().filter(|m| **m != PositionMethod::Natural);
    let methods = others.map(|method| method_row(linkage, angle, *method)).collect();
    Row { crank_deg, status, pose, rates, assembly, methods, loads: None }
}

fn method_row(linkage: &FourBar, angle: f64, method: PositionMethod) -> MethodRow {
    let mut iterations = None;
    let (status, root) = match method {
        PositionMethod::Natural => ("ok", None),
        PositionMethod::Algebraic => closed_form(linkage.close_by_algebra(angle), linkage.assembly()),
        PositionMethod::Complex => closed_form(linkage.close_by_complex_numbers(angle), linkage.assembly()),
        PositionMethod::FixedPoint => {
            let run: Iteration = linkage.close_by_iteration(angle, &IterationOptions::default());
            iterations = Some(run.iterations);
            let status = match run.verdict {
                IterationVerdict::Converged(_) => "ok",
                IterationVerdict::FalsePoint => "false point",
                IterationVerdict::Cycling => "cycling",
                IterationVerdict::NotConverged => "not converged",
                IterationVerdict::NoDirection => "no direction",
            };
            (status, run.root())
        }
    };
    let from_natural = root.and_then(|root| {
        let natural = linkage.position_with(angle, root.assembly).joints()?;
        Some((natural.coupler_point - root.joints.coupler_point).norm())
    });
    MethodRow {
        method,
        status,
        t1: root.map(|r| r.assembly),
        coupler_deg: root.map(|r| r.coupler_angle.to_degrees()),
        follower_deg: root.map(|r| r.follower_angle.to_degrees()),
        coupler_point: root.map(|r| xy(r.joints.coupler_point)),
        from_natural,
        iterations,
    }
}

fn closed_form(roots: LoopRoots, assembly: AssemblyMode) -> (&'static str, Option<LoopRoot>) {
    let status = match roots {
        LoopRoots::Closed(_) => "ok",
        LoopRoots::Open => "open",
        LoopRoots::Singular(Singularity::CrankPinOverFollowerPivot) => "singular: Ax = d",
        LoopRoots::Singular(Singularity::CrankPinOnFollowerPivot) => "singular: C on B",
    };
    (status, roots.root(assembly))
}

/// Computes the mobility of a linkage, which does not depend on the crank angle.
pub fn mobility(linkage: &FourBar) -> MobilityRecord {
    let mobility = linkage.mobility();
    let extremes = mobility.linkage_type.map(|_| linkage.transmission_over_cycle());
    let link_ratio = Some(linkage.link_ratio()).filter(|ratio| ratio.is_finite());
    MobilityRecord {
        linkage_type: mobility.linkage_type,
        grashof_margin: mobility.grashof_margin,
        input_turns_fully: mobility.input_turns_fully(),
        input_arcs_deg: mobility.input.arcs().iter().map(|arc| arc.ends().map(f64::to_degrees)).collect(),
        toggles_deg: mobility.toggles().iter().map(|t| t.crank_angle.to_degrees()).collect(),
        circuits: mobility.circuits(),
        branches_per_circuit: mobility.branches_per_circuit(),
        transmission_deg: extremes.map(|e| [e.min.to_degrees(), e.max.to_degrees()]),
        worst_transmission_deg: extremes.map(|e| e.worst().to_degrees()),
        link_ratio,
    }
}

/// Returns the joints A, B, C, D, P of a linkage at a row as complex numbers, for drawings; `None` if the row has no
/// position.
pub fn joints_of(linkage: &FourBar, row: &Row) -> Option<[Complex; 5]> {
    let pose = row.pose?;
    Some([
        linkage.crank_pivot(),
        linkage.follower_pivot(),
        point(pose.crank_pin),
        point(pose.follower_pin),
        point(pose.coupler_point),
    ])
}
