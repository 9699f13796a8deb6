//! The largest error accepted at a point, `task.path.tolerance`.

use super::{Definition, Limit, Words};
use crate::task::Problem;
use crate::task::spec::ProblemSpec;

pub(super) struct Tolerance;

impl Definition for Tolerance {
    fn key(&self) -> &'static str {
        "task.path.tolerance"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().task.path.tolerance.is_some()
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        let each = spec.task.path.tolerance.as_ref()?;
        let first = *each.first()?;
        each.iter().all(|one| *one == first).then_some(first).and_then(|limit| Limit::most(Some(limit)))
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        let points = spec.task.path.points.len();
        spec.task.path.tolerance = limits.first().map(|limit| vec![*limit; points]);
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.task.path.tolerance = None;
    }

    fn words(&self) -> Words {
        Words {
            short: "tolerance",
            label: "error at the worst point",
            relation: "at most ",
            plain: "the largest error",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("error {value}, tolerance {limit}"))
    }
}
