//! Admissibility of a problem for the search in reduced variables.
//!
//! In reduced variables pivots, size and coupler point follow from linear least squares. Values that the design fixes
//! have to be held by that fit ([`Projection`], [`super::linear_fit`]): a whole pivot, the ground's direction, with
//! prescribed timing also its length or one of the links. Any other fixed value would differ in almost every draw, and
//! such a problem is refused. Intervals are allowed: lying outside them is a violation.

use super::linear_fit::KnownPivots;
use super::projection::Projection;
use crate::task::spec::Limits;
use crate::task::{Problem, Timing};

/// The reason why a problem has no reduced form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The design fixes a key that the linear fit cannot hold.
    #[error("reduced variables cannot hold {key} at a fixed value: it comes out of a linear fit")]
    Fixed {
        /// The key of `[design]`.
        key: &'static str,
    },
    /// Fewer equations than linear unknowns.
    #[error("{points} points are too few for reduced variables: the linear fit has more unknowns")]
    TooFewPoints {
        /// Number of points.
        points: usize,
    },
}

impl Refusal {
    /// Returns the remedy to suggest.
    pub fn remedy(&self) -> &'static str {
        match self {
            Refusal::Fixed { .. } => "write variables = \"nine\", or give the key as [min, max]",
            Refusal::TooFewPoints { .. } => "write variables = \"nine\", or give more points",
        }
    }
}

/// Returns the reason why the problem cannot be searched in reduced variables; `None` if it can.
pub fn refusal(problem: &Problem) -> Option<Refusal> {
    let design = &problem.spec().design;
    let fixed = |limits: Option<Limits>| limits.is_some_and(|l| l.is_fixed());
    let known = KnownPivots::of(problem);
    let pivots =
        [("A", design.crank_pivot, known.crank_pivot), ("B", design.follower_pivot, known.follower_pivot)];
    for (key, limits, held) in pivots {
        if held.is_none() && limits.is_some_and(|xy| xy.iter().any(Limits::is_fixed)) {
            return Some(Refusal::Fixed { key });
        }
    }
    let coupler =
        [("coupler_x", design.coupler_x), ("coupler_y", design.coupler_y), ("d", design.d), ("e", design.e)];
    if let Some((key, _)) = coupler.into_iter().find(|(_, limits)| fixed(*limits)) {
        return Some(Refusal::Fixed { key });
    }
    let timed = matches!(problem.task().timing(), Timing::Prescribed { .. });
    let both_pivots = known.crank_pivot.is_some() && known.follower_pivot.is_some();
    let ground_held = both_pivots || (known.ground.is_some() && (timed || known.ground_angle.is_some()));
    if known.ground.is_some()
        && (!ground_held || (problem.offset_is_free() && known.ground_angle.is_none() && !both_pivots))
    {
        return Some(Refusal::Fixed { key: "ground" });
    }
    // One length among the links sets the size if the ground does not; the rest follows from the ratios.
    let links = [("a", design.a), ("b", design.b), ("c", design.c)];
    let spare = if ground_held { links.len() } else { usize::from(timed) };
    if let Some((key, _)) = links.into_iter().filter(|(_, limits)| fixed(*limits)).nth(spare) {
        return Some(Refusal::Fixed { key });
    }
    let no_form = |&direction: &f64| Projection::new(problem, direction).is_none();
    (timed && problem.directions().iter().any(no_form))
        .then(|| Refusal::TooFewPoints { points: problem.task().len() })
}

/// Returns the length of the ground if the linear fit holds it.
pub fn known_ground(problem: &Problem) -> Option<f64> {
    let known = KnownPivots::of(problem);
    match (known.crank_pivot, known.follower_pivot) {
        (Some(a), Some(b)) => Some((b - a).norm()),
        _ => known.ground,
    }
}
