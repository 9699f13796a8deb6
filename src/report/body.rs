//! The body of a motion, or the follower of a function, at the positions of a candidate: its angles there, and their
//! errors.

use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, LoopJoints};
use crate::record::Candidate;
use crate::task::requirement::RequirementKind;
use crate::task::spec::TaskSpec;

/// A part of the error at a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The distance of the place.
    Place,
    /// The error of the body's angle, or of the follower's.
    Angle,
}

impl Part {
    /// Both parts.
    pub(super) const ALL: [Part; 2] = [Part::Place, Part::Angle];

    /// Returns the requirement that limits it.
    pub(super) fn tolerance(self, task: &TaskSpec) -> RequirementKind {
        match self {
            Part::Angle if !task.is_of_places() => RequirementKind::ToleranceDeg,
            Part::Place if task.is_of_places() => RequirementKind::ToleranceDeg,
            Part::Place | Part::Angle => RequirementKind::Tolerance,
        }
    }
}

/// Returns the size of a part of the error at a target, a length or degrees; `None` if the record has no position there,
/// the loop is open, or the target has no angle.
pub(super) fn error(task: &TaskSpec, candidate: &Candidate, target: usize, part: Part) -> Option<f64> {
    let (angle, assembly) = (candidate.crank_deg.get(target)?, candidate.t1_at.get(target)?);
    let at = candidate.linkage.joints_with(angle.to_radians(), *assembly)?;
    match part {
        Part::Place => {
            Some((crate::mechanism::point(*task.points.get(target)?) - at.joints.coupler_point).norm())
        }
        Part::Angle => {
            let wanted = (*task.body.as_ref()?.angle_deg.get(target)?)?;
            if let Some(output) = output(candidate, &at) {
                let sign = candidate.sense?.signs()[0];
                let wanted = candidate.scales(task)[1] * wanted;
                return Some(apart(candidate, sign * wanted - output).abs());
            }
            Some(
                wrapped(wanted.to_radians() - generated(at.coupler, candidate.frame_deg?)).abs().to_degrees(),
            )
        }
    }
}

/// Returns the angle of a body (radians) that lies at `frame_deg` from the direction C -> D of the coupler, within half a
/// turn.
pub(super) fn generated(coupler: Complex, frame_deg: f64) -> f64 {
    wrapped(coupler.arg() + frame_deg.to_radians())
}

/// Returns how far the output link of a function has moved from an output of 0 at a position: the follower or the block,
/// degrees counter-clockwise within half a turn, or a slider along its line, a length. `None` for a candidate of another task.
pub(super) fn output(candidate: &Candidate, at: &LoopJoints) -> Option<f64> {
    let linkage = &candidate.linkage;
    if let Some(offset) = candidate.output_offset {
        return Some(linkage.slider_place(at)? - candidate.sense?.signs()[0] * offset);
    }
    let turned = linkage.output_angle(at)? - linkage.ground_angle();
    Some(wrapped(turned - candidate.output_offset_deg?.to_radians()).to_degrees())
}

/// Returns a difference of two outputs of a candidate: of angles (degrees) within half a turn, of places as it is.
pub(super) fn apart(candidate: &Candidate, difference: f64) -> f64 {
    match candidate.output_offset {
        Some(_) => difference,
        None => wrapped(difference.to_radians()).to_degrees(),
    }
}
