//! Reasons why linkages with a slider are not searched for in a problem.

use super::spec::{Method, Objective, SolveSpec, TaskSpec};

/// The reason why linkages with a slider are not searched for: their fits are by least squares alone, with every crank angle
/// free or every one given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WithoutSliders {
    /// A range of a function is free.
    #[error("is not searched for with a free range of a function")]
    FreeRange,
    /// A target is to be met exactly.
    #[error("is not searched for with exact targets")]
    ExactTarget,
    /// Some crank angles are free, others given.
    #[error("is not searched for with free crank angles among prescribed ones")]
    PartlyTimed,
    /// The method is another one.
    #[error("is searched for by least squares alone, not by method = \"{}\"", .0.name())]
    Method(Method),
    /// The largest deviation is minimised.
    #[error("is fitted by least squares alone, not by the largest deviation")]
    Deviation,
}

impl WithoutSliders {
    /// Returns the first reason in a problem; `None` if they can be searched for.
    pub fn of(task: &TaskSpec, solve: &SolveSpec) -> Option<WithoutSliders> {
        if task.output.as_ref().is_some_and(|output| output.ranges.is_free()) {
            Some(WithoutSliders::FreeRange)
        } else if task.tolerance.iter().flatten().any(|tolerance| *tolerance == 0.0) {
            Some(WithoutSliders::ExactTarget)
        } else if task.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
            Some(WithoutSliders::PartlyTimed)
        } else if !matches!(solve.method, Method::Auto | Method::LeastSquares) {
            Some(WithoutSliders::Method(solve.method))
        } else if solve.objective == Objective::MaxDeviation {
            Some(WithoutSliders::Deviation)
        } else {
            None
        }
    }
}
