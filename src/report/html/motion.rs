//! The drive of a mechanism on the page: the input that moves it, its range, and the places of the points in it.

use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, CrankLinkage, InputRange};
use crate::report::scene::{middle_position, positions_at};
use serde::Serialize;

/// The meaning of the player's one parameter q, in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DriveKind {
    /// q is the crank angle; it turns fully on one assembly.
    Turn,
    /// q is the crank angle; it rocks within the range, on one assembly.
    Rock,
    /// The motion passes toggles: crank angle = middle + half width sin q, t1 = sign cos q.
    Through,
    /// The links cannot be joined.
    None,
}

/// The motion that a page plays: the circuit of the first point, and of it the branch used or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Drive {
    /// The meaning of the parameter.
    pub kind: DriveKind,
    /// The middle of the crank's range, degrees in (-180, 180].
    pub middle_deg: f64,
    /// Half of the crank's range; 180 where it turns fully.
    pub half_width_deg: f64,
    /// The assembly; where toggles are passed, that of the first point.
    pub t1: i64,
}

impl Drive {
    /// Returns the drive of a linkage that passes the points at these crank angles (degrees) and assemblies.
    pub fn new(linkage: impl Into<CrankLinkage>, crank_deg: &[f64], t1_at: &[AssemblyMode]) -> Self {
        let linkage = linkage.into();
        let mobility = linkage.mobility();
        let mut positions = positions_at(crank_deg, t1_at);
        positions.retain(|(angle, _)| angle.is_finite());
        let (angle, assembly) = positions.first().copied().unwrap_or_else(|| middle_position(linkage));
        let circuit = mobility.branch(angle, assembly).circuit;
        let arc = mobility.arc(circuit);
        let passes_toggles = || {
            let on_circuit = |angle, t1| mobility.branch(angle, t1).circuit == circuit;
            positions.iter().any(|(angle, t1)| *t1 != assembly && on_circuit(*angle, *t1))
        };
        Drive {
            kind: match arc {
                None if mobility.input == InputRange::None => DriveKind::None,
                None => DriveKind::Turn,
                Some(_) if passes_toggles() => DriveKind::Through,
                Some(_) => DriveKind::Rock,
            },
            middle_deg: arc.map_or(0.0, |arc| wrapped(arc.middle).to_degrees()),
            half_width_deg: arc.map_or(180.0, |arc| arc.half_width.to_degrees()),
            t1: i64::from(assembly),
        }
    }
}
