//! The least-squares fit that suits a start: of a path, of a motion or of a function, with prescribed or
//! (but for functions) with free timing, and of a function with free ranges.
//!
//! The six differ in their numbers of unknowns and of rows, which are types. So what is to be done with a fit is a
//! [`FitUser`], and [`on_fit`] is the one place that tells them apart.

use super::design_space::{DESIGN, Design};
use super::start::{AS_WRITTEN, Start};
use super::timed::{FunctionFit, RangedFit, TimedMotionFit, TimedPathFit, WITH_FRAME};
use super::torus::{MotionFit, PathFit, Positions, TorusFit};
use crate::numbers::optimise::levenberg_marquardt::BlockLeastSquares;
use crate::task::Problem;
use crate::task::ranges::Scales;

/// A computation on a fit of any kind.
pub trait FitUser {
    /// The result.
    type Output;

    /// Computes with a fit at its unknowns `x`, of which the first are the design ([`design_of`]).
    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> Self::Output
    where
        F: BlockLeastSquares<N, R, State = Positions>;
}

/// Returns the design among the unknowns of a fit.
pub fn design_of<const N: usize>(x: &[f64; N]) -> Design {
    std::array::from_fn(|i| x[i])
}

/// Returns the frame of the body among the unknowns of a fit to timed poses; `None` in other fits.
pub fn own_frame<const N: usize>(x: &[f64; N]) -> Option<f64> {
    x.get(DESIGN).copied()
}

/// Returns the scales of a function's inputs and outputs among the unknowns of a fit; 1 in fits without free ranges.
pub fn own_scales<const N: usize>(x: &[f64; N]) -> Scales {
    match x.get(WITH_FRAME..) {
        Some([input, output]) => [*input, *output],
        _ => AS_WRITTEN,
    }
}

/// Selects what of the positions a fit keeps as it is at its start, where the problem requires it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// The fit keeps nothing.
    Nothing,
    /// The fit keeps the order of the positions around the curve.
    Order,
    /// The fit keeps their order and the branch on which they all are.
    OrderAndBranch,
}

impl Kept {
    /// Returns the fit that keeps this of the positions.
    fn of<'a, const R: usize>(
        self,
        fit: TorusFit<'a, R>,
        design: &Design,
        positions: &Positions,
    ) -> TorusFit<'a, R> {
        match self {
            Kept::Nothing => fit,
            Kept::Order => fit.in_order(design, positions),
            Kept::OrderAndBranch => fit.in_order(design, positions).on_its_branch(design, positions),
        }
    }
}

/// Calls `user` with the fit of a problem at a start; `None` if the start has no positions and the timing is free.
pub fn on_fit<U: FitUser>(problem: &Problem, start: &Start, kept: Kept, user: U) -> Option<U::Output> {
    let Start { design, setting, positions, scales } = start;
    let is_timed = positions.is_empty() || problem.task().is_partly_timed();
    match (is_timed, problem.task().body()) {
        (true, None) => Some(user.on(&TimedPathFit::new(problem, *setting)?, *design)),
        (true, Some(body)) if problem.is_function() && !body.ranges().are_written() => {
            let fit = RangedFit::new(problem, *setting)?;
            let x = fit.unknowns(design, *scales);
            Some(user.on(&fit, x))
        }
        (true, Some(_)) if problem.is_function() => {
            let fit = FunctionFit::new(problem, *setting)?;
            let x = fit.unknowns(design, *scales);
            Some(user.on(&fit, x))
        }
        (true, Some(_)) => {
            let fit = TimedMotionFit::new(problem, *setting)?;
            let x = fit.unknowns(design, *scales);
            Some(user.on(&fit, x))
        }
        (false, None) => {
            let fit = kept.of(PathFit::new(problem, *setting), design, positions);
            Some(user.on(&fit, *design))
        }
        (false, Some(_)) => {
            let fit = kept.of(MotionFit::new(problem, *setting), design, positions);
            Some(user.on(&fit, *design))
        }
    }
}
