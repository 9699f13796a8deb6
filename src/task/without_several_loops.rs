//! Reasons why six-bars and eight-bars are not searched for in a problem.

use super::requirement::RequireSpec;
use super::spec::{Method, Objective, OrderPolicy, SolveSpec, TaskSpec};

/// The reason why six-bars and eight-bars are not searched for: they draw paths of free or prescribed timing, by least squares alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WithoutSeveralLoops {
    /// A motion or a function.
    #[error("is searched for to draw a path, not for poses or a function")]
    NoPath,
    /// Some crank angles are given, others are free.
    #[error("is searched for with all crank angles given or with none")]
    PartlyTimed,
    /// A target is to be met exactly.
    #[error("is not searched for with exact targets")]
    ExactTarget,
    /// Points have different weights.
    #[error("is searched for with points of equal weight alone")]
    Weights,
    /// The method is another one.
    #[error("is searched for by least squares alone, not by method = \"{}\"", .0.name())]
    Method(Method),
    /// The largest deviation is minimised.
    #[error("is fitted by least squares alone, not by the largest deviation")]
    Deviation,
    /// Any order of the points will do.
    #[error("is searched for with the points in their order alone")]
    AnyOrder,
    /// Pivots on given lines.
    #[error("is not searched for with pivot_on")]
    PivotOn,
}

impl WithoutSeveralLoops {
    /// Returns the first reason in a problem; `None` if they can be searched for.
    pub fn of(task: &TaskSpec, solve: &SolveSpec, require: &RequireSpec) -> Option<WithoutSeveralLoops> {
        if task.body.is_some() || task.output.is_some() {
            Some(WithoutSeveralLoops::NoPath)
        } else if task.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
            Some(WithoutSeveralLoops::PartlyTimed)
        } else if task.tolerance.iter().flatten().any(|tolerance| *tolerance == 0.0) {
            Some(WithoutSeveralLoops::ExactTarget)
        } else if task.weight.iter().flatten().any(|weight| *weight != 1.0) {
            Some(WithoutSeveralLoops::Weights)
        } else if !matches!(solve.method, Method::Auto | Method::LeastSquares) {
            Some(WithoutSeveralLoops::Method(solve.method))
        } else if solve.objective == Objective::MaxDeviation {
            Some(WithoutSeveralLoops::Deviation)
        } else if require.order == OrderPolicy::Any {
            Some(WithoutSeveralLoops::AnyOrder)
        } else if require.pivot_on.is_some() {
            Some(WithoutSeveralLoops::PivotOn)
        } else {
            None
        }
    }
}
