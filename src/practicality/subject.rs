//! All of it at once, for a candidate with its target or for a linkage by itself.

use super::clearance::{Build, PivotDistance, pivot_distances};
use super::layers::{Layering, layering};
use super::sensitivity::{At, Crank, Sensitivity, along, sensitivity};
use super::sweep::Sweep;
use crate::linkage::FourBar;
use crate::problem::Problem;
use crate::problem::spec::TransmissionOver;
use crate::record::Candidate;
use crate::task::referee::judge;
use crate::task::{AngleOffset, Timing};

/// Positions at which the path of a linkage without a target is looked at, each stretch of its motion.
const POSITIONS: usize = 72;

/// Layers, distances and sensitivities of one linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Practicality {
    /// The linkage and its motion.
    pub sweep: Sweep,
    /// How the links are made.
    pub build: Build,
    /// In which layers they stack; `None` where the loop is open in the motion.
    pub layering: Option<Layering>,
    /// How near the joints come to each other, nearest first; `None` where the loop is open in the motion.
    pub distances: Option<Vec<PivotDistance>>,
    /// How much each dimension moves the path; `None` where no position has a derivative.
    pub sensitivity: Option<Sensitivity>,
    /// Whether the path is looked at in a target's points, which count from 0; else all along the motion.
    pub at_points: bool,
}

impl Practicality {
    /// Of a candidate: over the cycle or the motion used, as its transmission angle is judged; the path at its
    /// positions on the target.
    ///
    /// `None` where it has no position for each of the problem's points, or a crank angle that is no number.
    pub fn of_candidate(problem: &Problem, candidate: &Candidate, build: Build) -> Option<Self> {
        let n = problem.task().len();
        let angles = &candidate.crank_deg;
        if angles.len() != n || candidate.t1_at.len() != n || !angles.iter().all(|deg| deg.is_finite()) {
            return None;
        }
        let radians: Vec<f64> = angles.iter().map(|deg| deg.to_radians()).collect();
        let verdict = judge(problem.task(), &candidate.linkage, &radians, &candidate.t1_at);
        let cycle = candidate.transmission_deg.over == TransmissionOver::Cycle;
        let sweep = Sweep::of_motion(&verdict.motion, cycle);
        let felt = sensitivity(&candidate.linkage, &At::of_candidate(candidate), crank_of(problem));
        Some(Practicality::of(sweep, build, felt, true))
    }

    /// Of a linkage by itself: over all that it can do without passing a toggle ([`Sweep::of_linkage`]), the path
    /// along that motion, wherever the crank stands. `None` where it cannot be joined.
    pub fn of_linkage(linkage: &FourBar, build: Build) -> Option<Self> {
        let sweep = Sweep::of_linkage(linkage)?;
        let felt = sensitivity(linkage, &along(&sweep, POSITIONS), Crank::Settles);
        Some(Practicality::of(sweep, build, felt, false))
    }

    fn of(sweep: Sweep, build: Build, sensitivity: Option<Sensitivity>, at_points: bool) -> Self {
        let (layering, distances) = (layering(&sweep, build), pivot_distances(&sweep));
        Practicality { sweep, build, layering, distances, sensitivity, at_points }
    }
}

impl At {
    /// The positions of a candidate, one a target point.
    pub fn of_candidate(candidate: &Candidate) -> Vec<At> {
        let positions = candidate.crank_deg.iter().zip(&candidate.t1_at);
        positions.map(|(deg, assembly)| At { crank_angle: deg.to_radians(), assembly: *assembly }).collect()
    }
}

/// What the crank angles of a problem do when a dimension is off.
pub fn crank_of(problem: &Problem) -> Crank {
    match problem.task().timing() {
        Timing::Free => Crank::Settles,
        Timing::Prescribed { offset: AngleOffset::Free, .. } => Crank::OffsetIsSet,
        Timing::Prescribed { offset: AngleOffset::Fixed, .. } => Crank::Stays,
        Timing::Prescribed { offset: AngleOffset::Ground, .. } => Crank::TurnsWithGround,
    }
}
