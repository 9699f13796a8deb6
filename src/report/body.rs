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
    pub(super) fn tolerance(self) -> RequirementKind {
        match self {
            Part::Place => RequirementKind::Tolerance,
            Part::Angle => RequirementKind::ToleranceDeg,
        }
    }
}

/// Returns the size of a part of the error at a target, a length or degrees; `None` if the record has no position there,
/// the loop is open, or the target has no angle.
pub(super) fn error(task: &TaskSpec, candidate: &Candidate, target: usize, part: Part) -> Option<f64> {
    let (angle, assembly) = (candidate.crank_deg.get(target)?, candidate.t1_at.get(target)?);
    let LoopJoints { joints, coupler } = candidate.linkage.joints_with(angle.to_radians(), *assembly)?;
    match part {
        Part::Place => {
            Some((crate::mechanism::point(*task.points.get(target)?) - joints.coupler_point).norm())
        }
        Part::Angle => {
            let wanted = (*task.body.as_ref()?.angle_deg.get(target)?)?.to_radians();
            if let Some(output) = output_deg(candidate, joints.follower_pin) {
                let sign = candidate.sense?.signs()[0];
                let wanted = candidate.scales(task)[1] * wanted;
                return Some(wrapped(sign * wanted - output.to_radians()).abs().to_degrees());
            }
            Some(wrapped(wanted - generated(coupler, candidate.frame_deg?)).abs().to_degrees())
        }
    }
}

/// Returns the angle of a body (radians) that lies at `frame_deg` from the direction C -> D of the coupler, within half a
/// turn.
pub(super) fn generated(coupler: Complex, frame_deg: f64) -> f64 {
    wrapped(coupler.arg() + frame_deg.to_radians())
}

/// Returns how far the follower of a function has turned from its angle at an output of 0, degrees counter-clockwise within
/// half a turn, where its pin is; `None` for a candidate of another task.
pub(super) fn output_deg(candidate: &Candidate, follower_pin: Complex) -> Option<f64> {
    let linkage = &candidate.linkage;
    let turned = (follower_pin - linkage.four_bar()?.follower_pivot()).arg() - linkage.ground_angle();
    Some(wrapped(turned - candidate.output_offset_deg?.to_radians()).to_degrees())
}
