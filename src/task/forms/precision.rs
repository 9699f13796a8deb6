//! Exact problems: paths of nine precision points with free timing.
//!
//! Nine is the largest number of points that a four-bar's coupler curve can be made to pass through: a linkage has nine
//! parameters, and each point with a crank angle of its own takes one of them. Fewer points leave a family, more have
//! no exact answer in general, and with prescribed timing only five points can be met.

use crate::mechanism::Complex;
use crate::task::{Problem, Timing};

/// The largest number of points that a coupler curve can be made to pass through.
pub const PRECISION_POINTS: usize = 9;

/// Distance, in parts of the target's size, below which points are one point.
const COINCIDENT: f64 = 1e-9;

/// The reason why a problem has no exact answers to list.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The path does not have nine points.
    #[error("method = \"continuation\" finds linkages through exactly 9 points, this path has {points}")]
    Points {
        /// Number of points.
        points: usize,
    },
    /// The targets are poses.
    #[error("method = \"continuation\" finds linkages through exactly 9 points, and this task has poses")]
    Motion,
    /// The crank angles are given.
    #[error(
        "crank angles cannot be prescribed with method = \"continuation\": nine points take all the freedom"
    )]
    Timed,
    /// Two points coincide.
    #[error(
        "points {first} and {second} are one point, and method = \"continuation\" needs 9 different ones"
    )]
    Coincident {
        /// Index of the one, counted from 0.
        first: usize,
        /// Index of the other, counted from 0.
        second: usize,
    },
}

impl Refusal {
    /// Returns the remedy to suggest.
    pub fn remedy(&self) -> &'static str {
        match self {
            Refusal::Points { points } if *points < PRECISION_POINTS => {
                "give 9 points, or write method = \"auto\": fewer points leave a whole family of exact linkages"
            }
            Refusal::Points { .. } => {
                "give 9 points, or write method = \"auto\": more points can only be approached"
            }
            Refusal::Motion => "write method = \"auto\"; five poses are met exactly without it",
            Refusal::Timed => "remove the crank angles, or write method = \"auto\" and keep them",
            Refusal::Coincident { .. } => "move one of the two, or write method = \"auto\"",
        }
    }
}

/// Returns the nine points of a problem that has exact answers.
///
/// # Errors
/// [`Refusal`]: the reason why it has none.
pub fn precision_points(problem: &Problem) -> Result<[Complex; PRECISION_POINTS], Refusal> {
    let task = problem.task();
    if task.body().is_some() {
        return Err(Refusal::Motion);
    }
    if !matches!(task.timing(), Timing::Free) {
        return Err(Refusal::Timed);
    }
    let refusal = Refusal::Points { points: task.len() };
    let points: [Complex; PRECISION_POINTS] = task.points().try_into().map_err(|_| refusal)?;
    for second in 1..PRECISION_POINTS {
        for first in 0..second {
            if (points[second] - points[first]).norm() <= COINCIDENT * task.size() {
                return Err(Refusal::Coincident { first, second });
            }
        }
    }
    Ok(points)
}
