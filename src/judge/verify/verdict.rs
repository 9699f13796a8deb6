//! Verdicts on requirements, compared exactly except for those whose figure lies within rounding of the limit.

use crate::judge::assess::MET_TOLERANCE;
use crate::record::{Candidate, Figure, Requirement};
use crate::task::Problem;
use crate::task::requirement::RequirementKind;

/// Returns the scale of the rounding of a requirement's figure: the margin is [`super::ABSOLUTE`] of it.
pub(super) fn scale(requirement: &Requirement, size: f64) -> f64 {
    let value = if let Figure::Number(value) = requirement.value { Some(value) } else { None };
    match (RequirementKind::named(&requirement.name), requirement.name.as_str()) {
        (Some(kind), _) => (kind.definition().rounding)(value, size),
        (None, "design.ground_angle_deg" | "design.line_deg") => 180.0,
        // d, e and the coupler's offset follow from each other by square roots of small differences.
        (None, "design.coupler_x" | "design.coupler_y" | "design.d" | "design.e") => 1e4 * size,
        (None, _) => size,
    }
}

/// Returns whether a requirement's figure lies so near to the limit that rounding decides the verdict: a figure may
/// miss its limit by [`MET_TOLERANCE`] of max(1, |limit|), on either side.
pub(super) fn is_doubtful(requirement: &Requirement, size: f64) -> bool {
    let absolute = super::ABSOLUTE * scale(requirement, size);
    let near = |value: f64, limit: f64| {
        let turns = MET_TOLERANCE * limit.abs().max(1.0);
        let margin = super::RELATIVE * value.abs() + absolute;
        ((value - limit).abs() - turns).abs() <= margin
    };
    // One value is compared with every limit, several each with its own.
    let values = requirement.value.numbers().iter().cycle();
    values.zip(requirement.limit.numbers()).any(|(value, limit)| near(*value, *limit))
}

/// Returns the requirements that are not met, and whether the linkage is accepted. For a doubtful requirement the
/// recorded verdict counts: `not_met` returns whether a name is recorded as not met.
pub(super) fn verdict(
    problem: &Problem,
    found: &Candidate,
    not_met: &dyn Fn(&str) -> bool,
) -> (Vec<String>, bool) {
    let size = problem.task().size();
    let fails = |r: &&Requirement| if is_doubtful(r, size) { not_met(&r.name) } else { !r.met };
    let names: Vec<String> = found.requirements.iter().filter(fails).map(|r| r.name.clone()).collect();
    let forbidden = found.defects.iter().any(|defect| problem.spec().require.forbids(defect));
    let accepted = names.is_empty() && !forbidden;
    (names, accepted)
}
