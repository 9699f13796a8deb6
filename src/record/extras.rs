//! Additions to a candidate's figures: warnings, the same curve by other linkages, families of answers.

use crate::mechanism::{AssemblyMode, CrankLinkage, LinkageType};
use serde::{Deserialize, Serialize};

/// Why a linkage that meets every requirement may still be a poor one to build.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum WarningKind {
    /// The worst transmission angle is below 10 degrees.
    TransmissionAngle,
    /// The longest link is more than 20 times the shortest.
    LinkRatio,
    /// The Grashof margin is below a thousandth of the longest link.
    ChangePoint,
    /// The plates of a six-bar or an eight-bar cannot be stacked, each in one layer.
    Stacking,
    /// A limit of the problem decides the answer.
    OnBound,
    /// The motion returns to its first point only by going back through all others.
    ToAndFro,
}

impl WarningKind {
    /// The name in records.
    pub fn name(self) -> &'static str {
        match self {
            WarningKind::TransmissionAngle => "transmission-angle",
            WarningKind::LinkRatio => "link-ratio",
            WarningKind::ChangePoint => "change-point",
            WarningKind::Stacking => "stacking",
            WarningKind::OnBound => "on-bound",
            WarningKind::ToAndFro => "to-and-fro",
        }
    }
}

/// How the text of a [`WarningKind::OnBound`] ends, after the key and its limit.
pub const ON_BOUND_TEXT: &str = " is on its limit: the problem's bounds decide it";

/// One reason to look twice before building a candidate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Warning {
    /// Which.
    pub kind: WarningKind,
    /// In plain words.
    pub text: String,
    /// The figure or the problem's key that it is about, such as `transmission_deg.worst` or `design.ground`.
    pub key: String,
    /// What the candidate has.
    pub value: f64,
    /// What it is held against.
    pub limit: f64,
}

/// A Roberts cognate of a candidate: another linkage whose coupler point draws the same curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Alternative {
    /// The linkage.
    pub linkage: CrankLinkage,
    /// Its crank angle at each target point, degrees, unwrapped.
    pub crank_deg: Vec<f64>,
    /// Its assembly at each target point.
    pub t1_at: Vec<AssemblyMode>,
    /// Its type.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// Whether it would be accepted in the candidate's place.
    pub accepted: bool,
    /// The unweighted sum of squared distances at the points: the candidate's, up to rounding.
    pub sum_sq: f64,
    /// min(mu, 180 - mu) at its worst, over the motion that the candidate's is judged over.
    pub transmission_worst_deg: f64,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// The requirements that it does not meet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_met: Vec<String>,
}

impl Alternative {
    /// Returns the type of a four-bar, of other kinds the kind.
    pub fn type_name(&self) -> &'static str {
        super::type_name(self.linkage_type, &self.linkage)
    }
}

/// The best answer is one of a whole family of exact answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Family {
    /// How many parameters can be chosen with all points still met: the free unknowns less the rank of the
    /// points' derivatives at the best answer. Limits that are not equations are not counted.
    pub dimension: usize,
    /// Whether its members meet all points exactly; always so today.
    pub exact: bool,
    /// In plain words.
    pub text: String,
}
