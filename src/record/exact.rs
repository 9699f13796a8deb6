//! Exact synthesis: every four-bar through nine points, or through a mixture of poses and points that has finitely many, or every
//! linkage with a slider through eight points, counted, and the real ones listed.

use crate::mechanism::{AssemblyMode, CrankLinkage, LinkageKind, LinkageType};
use crate::numbers::nine_point::target::Kind;
use crate::task::Defect;
use crate::task::forms::precision::closure_of;
use serde::{Deserialize, Serialize};

/// So many classes pass through nine points in general position: C. W. Wampler, A. P. Morgan, A. J. Sommese (1992).
pub const GENERIC_CLASSES: usize = 1442;

/// Returns the number of classes of linkages of a kind for targets in general position, `poses` of them poses and the others
/// points, where `pivots` of the fixed pivots are given; 0 for a kind that is not solved for. One pose among points asks for no
/// more than a point does.
pub fn generic_classes(kind: LinkageKind, poses: usize, pivots: usize) -> usize {
    closure_of(kind).map_or(0, |closure| Kind { poses: poses.saturating_sub(1), pivots, closure }.classes())
}

/// The result of an exact solution: counts of all solutions, and the list of the real ones.
///
/// A class is one coupler curve through nine points: three cognates with two labels of their links. Where there are poses it
/// is one linkage, with two labels: cognates turn the coupler differently. So it is where a fixed pivot is given. Through eight
/// points it is a pair of slider-cranks, cognates, or one inverted slider-crank. That each linkage
/// marked as certified exists is proved; that no others do is not: that rests on the count
/// ([`generic_classes`]) for targets in general position, published or found by monodromy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExactRecord {
    /// The kind of linkages that were solved for; absent of four-bars.
    #[serde(default = "four_bar", skip_serializing_if = "is_four_bar")]
    pub kind: LinkageKind,
    /// The number of poses among the targets.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub poses: usize,
    /// The number of fixed pivots that the problem gives.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub pivots: usize,
    /// How the solutions are counted.
    pub census: Census,
    /// Whether as many classes were found as points in general position have.
    pub generic: bool,
    /// What may be said of the list as a whole.
    pub completeness: Completeness,
    /// Every real class by its best linkage, better first.
    pub linkages: Vec<ExactLinkage>,
}

impl ExactRecord {
    /// Returns the number of classes of such targets in general position.
    pub fn generic_classes(&self) -> usize {
        generic_classes(self.kind, self.poses, self.pivots)
    }
}

/// Returns the kind of a record that names none.
fn four_bar() -> LinkageKind {
    LinkageKind::FourBar
}

/// Whether it is the kind that is not written.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_four_bar(kind: &LinkageKind) -> bool {
    *kind == LinkageKind::FourBar
}

/// Whether there are none, which is not written.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// What may be said of the list of classes as a whole. None of it is proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Completeness {
    /// As many as points in general position have: all, by the count for these.
    Complete,
    /// Points that are not in general position: fewer isolated solutions, and no path was lost.
    NonGeneric,
    /// Paths were lost, or ended together: some classes may be missing.
    Incomplete,
    /// Stopped before the end.
    Cancelled,
}

/// Counts of solutions up to cognates and labels. They add up:
///
/// - tracked = finite + singular + failed, finite = classes + duplicate,
/// - classes = real + real_curve + complex = certified + not_certified,
/// - real = degenerate + how many linkages are listed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Census {
    /// Solution paths that were followed.
    pub tracked: usize,
    /// Paths that ended in an isolated solution.
    pub finite: usize,
    /// Different isolated solutions.
    pub classes: usize,
    /// Paths that ended where another one did, after all repeats.
    pub duplicate: usize,
    /// Paths that ended at infinity, where solutions meet, or in a whole family of them.
    pub singular: usize,
    /// Paths that were lost for no known reason.
    pub failed: usize,
    /// Classes that are linkages.
    pub real: usize,
    /// Real classes that make no linkage: a link of no length, or one beyond all bounds of numbers in files.
    pub degenerate: usize,
    /// Classes with a real curve that no real linkage draws.
    pub real_curve: usize,
    /// Classes with a complex curve.
    pub complex: usize,
    /// Classes that are proved to exist and to be alone within their radius.
    pub certified: usize,
    /// Classes for which the proof did not succeed.
    pub not_certified: usize,
    /// Certified classes that are also proved to be what they are counted as: real, a real curve, or complex.
    pub reality_proved: usize,
    /// Pairs of certified classes that are not proved to be different ones.
    pub not_told_apart: usize,
    /// Real classes that pass all points on one circuit, by some cognate and crank.
    pub one_circuit: usize,
    /// Of these, those that pass them in order.
    pub in_order: usize,
    /// Of these, those that stay on one branch.
    pub free_of_defects: usize,
}

/// A real class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExactLinkage {
    /// Its rank among the candidates, 0 where it is none of them.
    pub rank: usize,
    /// The best of its mechanisms under the problem's requirements.
    pub linkage: CrankLinkage,
    /// Its crank angle at each point, degrees, unwrapped.
    pub crank_deg: Vec<f64>,
    /// Its assembly at each point.
    pub t1_at: Vec<AssemblyMode>,
    /// The largest distance of its coupler point from a target point: rounding.
    pub miss: f64,
    /// Its type.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// Its defects.
    pub defects: Vec<Defect>,
    /// min(mu, 180 - mu) at its worst.
    pub transmission_worst_deg: f64,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// Whether it is acceptable.
    pub accepted: bool,
    /// The requirements that it does not meet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_met: Vec<String>,
    /// Whether one of its mechanisms stays on one circuit ..
    pub one_circuit: bool,
    /// .. passes the points in order ..
    pub in_order: bool,
    /// .. and stays on one branch.
    pub free_of_defects: bool,
    /// The proof that it exists, where it succeeded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certified: Option<Certified>,
    /// The other mechanisms of the class: cognates, and the same driven from the other side.
    pub others: Vec<ExactForm>,
}

impl ExactLinkage {
    /// Returns the type of a four-bar, of other kinds the kind.
    pub fn type_name(&self) -> &'static str {
        super::type_name(self.linkage_type, &self.linkage)
    }
}

/// Another mechanism of a class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExactForm {
    /// The linkage, assembled as at the first point.
    pub linkage: CrankLinkage,
    /// Its type.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// Its defects.
    pub defects: Vec<Defect>,
}

impl ExactForm {
    /// Returns the type of a four-bar, of other kinds the kind.
    pub fn type_name(&self) -> &'static str {
        super::type_name(self.linkage_type, &self.linkage)
    }
}

/// A proof that a linkage through the points exists.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Certified {
    /// One, and only one, real linkage whose coupler passes exactly through all points and poses has its fixed pivots and, at
    /// the first pose, or the first point where there is none, its pins within this distance of those recorded: C and D, of an
    /// inverted slider-crank C alone. So has the point of the line at one size of the target (the diagonal of its box) from D, along
    /// the slider's line, or from C, along the coupler's line: that bounds the direction. In the file's unit.
    pub radius: f64,
}
