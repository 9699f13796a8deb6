//! Practicality of a candidate with its target, or of a linkage by itself: layers, distances and sensitivities
//! together.

use super::clearance::{Build, PivotDistance, pivot_distances};
use super::layers::{Layering, layering};
use super::sensitivity::{At, Crank, Sensitivity, along, output_sensitivity, sensitivity};
use super::sweep::Sweep;
use crate::judge::referee::judge;
use crate::mechanism::{AssemblyMode, CrankLinkage};
use crate::record::Candidate;
use crate::task::spec::TransmissionOver;
use crate::task::{AngleOffset, Output, Problem, TaskKind, Timing};

/// Number of positions on each stretch of the motion at which the path of a linkage without a target is examined.
const POSITIONS: usize = 72;

/// Layers, distances and sensitivities of one linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Practicality {
    /// The linkage and its motion.
    pub sweep: Sweep,
    /// The radii of plates and pins.
    pub build: Build,
    /// The layers of the plates; `None` if the loop is open in the motion.
    pub layering: Option<Layering>,
    /// The least distances between the joints, nearest first; `None` if the loop is open in the motion.
    pub distances: Option<Vec<PivotDistance>>,
    /// The sensitivity of the path to errors of the dimensions; `None` if no position has a derivative.
    pub sensitivity: Option<Sensitivity>,
    /// Whether the path is examined at a target's points, counted from 0; else all along the motion.
    pub at_points: bool,
    /// The kind of the task. Of a motion, the path of the body's origin is examined, of a function the output.
    pub kind: TaskKind,
    /// The output of a function; `None` of another task.
    pub output: Option<Output>,
}

impl Practicality {
    /// Examines a candidate over the cycle or the motion used, as for its transmission angle; the path at its positions
    /// on the target.
    ///
    /// `None` if it lacks a position for one of the problem's points, or has a crank angle that is no number.
    pub fn of_candidate(problem: &Problem, candidate: &Candidate, build: Build) -> Option<Self> {
        let sweep = Sweep::of_candidate(problem, candidate)?;
        let felt = sensitivity_of(problem, candidate);
        let task = &problem.spec().task;
        let (kind, output) = (task.kind(), task.output.as_ref().map(|output| output.output));
        Some(Practicality { kind, output, ..Practicality::of(sweep, build, felt, true) })
    }

    /// Examines a linkage by itself over its whole motion without passing a toggle ([`Sweep::of_linkage`]), and the
    /// path along that motion, with free timing ([`Crank::Settles`]). `None` if it cannot be assembled.
    pub fn of_linkage(linkage: impl Into<CrankLinkage>, build: Build) -> Option<Self> {
        let sweep = Sweep::of_linkage(linkage)?;
        let felt = sensitivity(sweep.linkage, &along(&sweep, POSITIONS), Crank::Settles);
        Some(Practicality::of(sweep, build, felt, false))
    }

    fn of(sweep: Sweep, build: Build, sensitivity: Option<Sensitivity>, at_points: bool) -> Self {
        let (layering, distances) = (layering(&sweep, &build), pivot_distances(&sweep));
        Practicality {
            sweep,
            build,
            layering,
            distances,
            sensitivity,
            at_points,
            kind: TaskKind::Path,
            output: None,
        }
    }
}

impl Sweep {
    /// Returns the motion of a candidate: the cycle, or the motion used, as for its transmission angle. `None` if it lacks a
    /// position for one of the problem's points, or has a crank angle that is no number.
    pub fn of_candidate(problem: &Problem, candidate: &Candidate) -> Option<Self> {
        let n = problem.task().len();
        let angles = &candidate.crank_deg;
        if angles.len() != n || candidate.t1_at.len() != n || !angles.iter().all(|deg| deg.is_finite()) {
            return None;
        }
        let radians: Vec<f64> = angles.iter().map(|deg| deg.to_radians()).collect();
        let verdict = judge(problem.task(), candidate.linkage, &radians, &candidate.t1_at);
        let cycle = candidate.transmission_deg.over == TransmissionOver::Cycle;
        Some(Sweep::of_motion(&verdict.motion, cycle))
    }
}

impl At {
    /// Returns the positions of a candidate of a problem, one for each target.
    pub fn of_candidate(problem: &Problem, candidate: &Candidate) -> Vec<At> {
        let positions = candidate.crank_deg.iter().zip(&candidate.t1_at).enumerate();
        let at = |(j, (deg, assembly)): (usize, (&f64, &AssemblyMode))| At {
            crank_angle: deg.to_radians(),
            assembly: *assembly,
            is_free: problem.task().is_untimed(j),
        };
        positions.map(at).collect()
    }
}

/// Returns the sensitivity of a candidate: of its path, or in a function of its output; `None` if no position has a
/// derivative.
pub fn sensitivity_of(problem: &Problem, candidate: &Candidate) -> Option<Sensitivity> {
    let (at, crank) = (At::of_candidate(problem, candidate), crank_of(problem));
    match problem.task().body().filter(|_| problem.is_function()) {
        None => sensitivity(candidate.linkage, &at, crank),
        Some(output) => {
            let kind = if output.is_of_places() { Output::Place } else { Output::Angle };
            let is_free = output.given_frame(0.0).is_none();
            output_sensitivity(candidate.linkage, kind, &at, (crank, is_free))
        }
    }
}

/// Returns the behaviour of a problem's crank angles when a dimension is off.
fn crank_of(problem: &Problem) -> Crank {
    match problem.task().timing() {
        Timing::Free => Crank::Settles,
        Timing::Prescribed { offset: AngleOffset::Free, .. } => Crank::OffsetIsSet,
        Timing::Prescribed { offset: AngleOffset::Fixed, .. } => Crank::Stays,
        Timing::Prescribed { offset: AngleOffset::Ground, .. } => Crank::TurnsWithGround,
    }
}
