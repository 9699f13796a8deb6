//! Requirement on the largest error at a point, `task.path.tolerance`.

use super::{Definition, Limit};
use crate::task::spec::ProblemSpec;

pub(super) const TOLERANCE: Definition = Definition {
    key: "task.path.tolerance",
    short: "tolerance",
    label: "error at the worst point",
    relation: "at most ",
    plain: "largest error at a point",
    is_asked: |problem| problem.spec().task.tolerance.is_some(),
    limits,
    set_limits: |spec, limits| {
        let path = &mut spec.task;
        path.tolerance = limits.first().map(|limit| vec![*limit; path.points.len()]);
    },
    objection: |value, limit| Some(format!("error {value}, tolerance {limit}")),
    ..Definition::DEFAULT
};

/// Returns the tolerance that every point has.
fn limits(spec: &ProblemSpec) -> Option<Vec<Limit>> {
    let each = spec.task.tolerance.as_ref()?;
    let first = *each.first()?;
    Limit::most(each.iter().all(|one| *one == first).then_some(first))
}
