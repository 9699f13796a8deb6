//! Requirement on the largest error at a point, `task.path.tolerance`, or of a slider's place, `task.function.tolerance`.

use super::{Definition, Limit};
use crate::task::Output;
use crate::task::spec::ProblemSpec;

pub(super) const TOLERANCE: Definition = Definition {
    key: "task.path.tolerance",
    short: "tolerance",
    label: "error at the worst point",
    relation: "at most ",
    plain: "largest error at a point",
    is_asked: |problem| tolerances(problem.spec()).is_some(),
    limits,
    set_limits: |spec, limits| {
        let task = &mut spec.task;
        let given = limits.first().map(|limit| vec![*limit; task.len()]);
        match &mut task.body {
            Some(outputs) if task.output.as_ref().is_some_and(|output| output.output == Output::Place) => {
                outputs.tolerance_deg = given;
            }
            _ => task.tolerance = given,
        }
    },
    objection: |value, limit| Some(format!("error {value}, tolerance {limit}")),
    ..Definition::DEFAULT
};

/// Returns the tolerances of the points, or of a slider's places.
fn tolerances(spec: &ProblemSpec) -> Option<&Vec<f64>> {
    let outputs = spec.task.body.as_ref().filter(|_| spec.task.is_of_places());
    outputs.map_or(spec.task.tolerance.as_ref(), |outputs| outputs.tolerance_deg.as_ref())
}

/// Returns the tolerance that every point has.
fn limits(spec: &ProblemSpec) -> Option<Vec<Limit>> {
    let each = tolerances(spec)?;
    let first = *each.first()?;
    Limit::most(each.iter().all(|one| *one == first).then_some(first))
}
