//! Tells whether errors are noise, and how large a part of them is the same for all linkages.

use crate::judge::error::structural_error;
use crate::mechanism::dot;
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Candidate;
use crate::synthesis::constants::free::{ALIKE, NOISE_LEAST, NOISE_SCATTER};
use crate::synthesis::polish::promising;
use crate::synthesis::required::cost_of;
use crate::synthesis::states::{End, StageState};
use crate::task::Problem;

/// Returns whether the errors of the best acceptable end are noise.
pub(super) fn is_noise(problem: &Problem, ends: &[End]) -> bool {
    let best = ends.iter().filter_map(|end| end.verdict.as_ref()).find(|c| promising(problem, c));
    best.is_some_and(|best| likeness(problem, best) < ALIKE)
}

/// Returns the correlation of the errors of neighbouring points: sum <r_j, r_j+1> / sum |r_j|^2, near 0 for noise, near
/// 1 for a smooth misfit.
fn likeness(problem: &Problem, candidate: &Candidate) -> f64 {
    let Some(error) = structural_error(problem, candidate) else { return 1.0 };
    let whole: f64 = error.structural.iter().map(|r| r.norm_sqr()).sum();
    let alike: f64 = error.structural.windows(2).map(|w| dot(w[0], w[1])).sum();
    if whole > 0.0 { alike / whole } else { 1.0 }
}

/// The part of the sum of squares that the points of each group scatter about their mean. If it is a large part, they are
/// noise, and nearly the same for all linkages that come near the groups' means.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scatter {
    scatter: f64,
    /// The least merit on all points.
    pub(super) best: f64,
}

impl Scatter {
    /// Returns it as the best finished end of a stage shows it; `None` if it is a small part of the merit there, or that
    /// merit is small itself.
    pub(super) fn of(problem: &Problem, stage: &StageState) -> Option<Scatter> {
        let pairs = stage.finished.iter().map(|&(Exact(explored), Exact(whole))| (explored, whole));
        let (explored, best) = pairs.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let scatter = best - explored;
        let is_noise = scatter > NOISE_SCATTER * best && best > cost_of(problem, NOISE_LEAST);
        is_noise.then_some(Scatter { scatter, best })
    }

    /// Returns the merit on all points that an end with this merit on the groups' means can be expected to have, at
    /// least the best known.
    pub(super) fn expected(self, explored: f64) -> f64 {
        (explored + self.scatter).max(self.best)
    }
}
