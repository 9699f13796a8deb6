//! Requirement on the largest error of a body's angle, `task.motion.tolerance_deg`.

use super::{Definition, Limit, LimitUnit};
use crate::task::spec::{BodySpec, ProblemSpec};

pub(super) const TOLERANCE_DEG: Definition = Definition {
    key: "task.motion.tolerance_deg",
    short: "angle",
    label: "angle error at the worst pose",
    relation: "at most ",
    plain: "largest angle error at a pose",
    unit: LimitUnit::Degree,
    is_asked: |problem| body(problem.spec()).is_some_and(|body| body.tolerance_deg.is_some()),
    limits,
    set_limits: |spec, limits| {
        if let Some(body) = &mut spec.task.body {
            body.tolerance_deg = limits.first().map(|limit| vec![*limit; body.angle_deg.len()]);
        }
    },
    rounding: |_, _| 1.0,
    objection: |value, limit| Some(format!("angle error {value} degrees, tolerance {limit} degrees")),
    ..Definition::DEFAULT
};

/// Returns the angles wanted; none of a function of places.
fn body(spec: &ProblemSpec) -> Option<&BodySpec> {
    spec.task.body.as_ref().filter(|_| !spec.task.is_of_places())
}

/// Returns the tolerance that every pose has.
fn limits(spec: &ProblemSpec) -> Option<Vec<Limit>> {
    let each = body(spec)?.tolerance_deg.as_ref()?;
    let first = *each.first()?;
    Limit::most(each.iter().all(|one| *one == first).then_some(first))
}
