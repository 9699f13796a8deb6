//! Which problems have exact answers: paths of nine precision points with free timing.
//!
//! Nine points are as many as a four-bar's coupler curve can be made to pass through: nine numbers are a linkage,
//! each point with a crank angle of its own takes one of them. Fewer points leave a family, more have no exact
//! answer in general, and with the timing prescribed five points are all that can be met.

use super::Problem;
use crate::linkage::Complex;
use crate::task::Timing;

/// As many points as a coupler curve can be made to pass through.
pub const PRECISION_POINTS: usize = 9;

/// Points nearer to each other than this part of the target's size are one point.
const COINCIDENT: f64 = 1e-9;

/// Why a problem has no exact answers to list.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Not nine points.
    #[error("method = \"continuation\" finds linkages through exactly 9 points, this path has {points}")]
    Points {
        /// How many there are.
        points: usize,
    },
    /// The crank angles are given.
    #[error(
        "crank angles cannot be prescribed with method = \"continuation\": nine points take all the freedom"
    )]
    Timed,
    /// Two points in one place.
    #[error(
        "points {first} and {second} are one point, and method = \"continuation\" needs 9 different ones"
    )]
    Coincident {
        /// One, counted from 0.
        first: usize,
        /// The other.
        second: usize,
    },
}

impl Refusal {
    /// What to do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Refusal::Points { points } if *points < PRECISION_POINTS => {
                "give 9 points, or write method = \"auto\": fewer points leave a whole family of exact linkages"
            }
            Refusal::Points { .. } => {
                "give 9 points, or write method = \"auto\": more points can only be approached"
            }
            Refusal::Timed => "remove the crank angles, or write method = \"auto\" and keep them",
            Refusal::Coincident { .. } => "move one of the two, or write method = \"auto\"",
        }
    }
}

/// The nine points of a problem that has exact answers.
///
/// # Errors
/// [`Refusal`]: why it has none.
pub fn precision_points(problem: &Problem) -> Result<[Complex; PRECISION_POINTS], Refusal> {
    let task = problem.task();
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
