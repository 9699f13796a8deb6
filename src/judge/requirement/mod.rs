//! The judge's own arithmetic for each requirement: value, limit and whether it is met.
//!
//! The list is [`RequirementKind`]; no arithmetic is shared with the optimiser's rows of the same requirements.

mod boxes;
mod closing;
mod defects;
mod direction;
mod extent_max;
mod input;
mod link_ratio;
mod linkage_type;
mod longest_max;
mod peak_torque;
mod pivot_on;
mod stroke;
mod tolerance;
mod transmission;

use crate::judge::error::StructuralError;
use crate::judge::referee::Verdict;
use crate::record::{Candidate, Figure, MET_TOLERANCE, Requirement};
use crate::task::Problem;
use crate::task::requirement::RequirementKind;
use crate::task::spec::RequireSpec;

/// A candidate with all that is known of it but its requirements.
pub(super) struct Judged<'a> {
    pub problem: &'a Problem,
    pub candidate: &'a Candidate,
    pub verdict: &'a Verdict,
    /// The structural errors.
    pub error: &'a StructuralError,
}

/// A requirement's value and limit, and whether it is met.
struct Finding {
    value: Figure,
    limit: Figure,
    met: bool,
}

/// Returns whether `value` reaches at least `limit`, within the tolerance.
pub(super) fn at_least(value: f64, limit: f64) -> bool {
    value >= limit - MET_TOLERANCE * limit.abs().max(1.0)
}

/// Returns whether `value` is at most `limit`, within the tolerance.
pub(super) fn at_most(value: f64, limit: f64) -> bool {
    value <= limit + MET_TOLERANCE * limit.abs().max(1.0)
}

impl Finding {
    fn least(value: f64, limit: f64) -> Finding {
        Finding { value: Figure::Number(value), limit: Figure::Number(limit), met: at_least(value, limit) }
    }

    fn most(value: f64, limit: f64) -> Finding {
        Finding { value: Figure::Number(value), limit: Figure::Number(limit), met: at_most(value, limit) }
    }

    fn word(value: &str, limit: &str, met: bool) -> Finding {
        Finding { value: Figure::Word(value.into()), limit: Figure::Word(limit.into()), met }
    }
}

impl Judged<'_> {
    /// Returns the row of a requirement in the record; `None` if the problem does not ask for it.
    pub fn row(&self, kind: RequirementKind) -> Option<Requirement> {
        let Finding { value, limit, met } = match kind {
            RequirementKind::Type => linkage_type::judged(self),
            RequirementKind::Input => input::judged(self),
            RequirementKind::Transmission => transmission::judged(self),
            RequirementKind::LinkRatio => link_ratio::judged(self),
            RequirementKind::PivotsIn => boxes::pivots(self),
            RequirementKind::PivotOn => pivot_on::judged(self),
            RequirementKind::PinsIn => boxes::pins(self),
            RequirementKind::FootprintIn => boxes::footprint(self),
            RequirementKind::ExtentMax => extent_max::judged(self),
            RequirementKind::LongestMax => longest_max::judged(self),
            RequirementKind::PeakTorque => peak_torque::judged(self),
            RequirementKind::Stroke => stroke::length(self),
            RequirementKind::TimeRatio => stroke::time_ratio(self),
            RequirementKind::Direction => direction::judged(self),
            RequirementKind::Order => defects::order(self),
            RequirementKind::Branch => defects::branch(self),
            RequirementKind::Circuit => defects::circuit(self),
            RequirementKind::Closing => closing::judged(self),
            RequirementKind::Tolerance => tolerance::judged(self),
            RequirementKind::ToleranceDeg => tolerance::of_angles(self),
        }?;
        Some(Requirement { name: kind.name().into(), value, limit, met })
    }

    fn require(&self) -> &RequireSpec {
        &self.problem.spec().require
    }
}
