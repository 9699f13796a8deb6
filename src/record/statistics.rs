//! Statistics of many runs: medians, hits, the best run.
//!
//! Answers of a path are compared by their sum of squares, those of a motion by their objective ([`MotionErrors`]), with
//! a tolerance of [`WITHIN`]. Below the problem's exactness floor every figure counts as zero: there, only rounding is
//! left.

use super::{Reason, TwoSidedRecord};
use serde::Serialize;

/// The relative tolerance within which a figure reaches another: published optima have seven digits and more.
pub const WITHIN: f64 = 1e-6;

/// The errors of an answer of a motion, beside the sum of squared distances of its places; or of a function, whose errors
/// are all of the output: in degrees, or lengths of a slider's place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MotionErrors {
    /// The figure that answers of a motion are compared by: sum_j w_j (|T_j - P_j|^2 + (W dtheta_j)^2) with the weights
    /// w_j of the poses, the angle's weight W (a length) and the angle errors dtheta_j in radians.
    pub objective: f64,
    /// The root of the mean squared distance of the places.
    pub rms: f64,
    /// The root of the mean squared error of the body's angle, over the poses that give one, or of the output, degrees; `None`
    /// where the output is a place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
}

/// The results of one run: one problem, one method, one seed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// The seed.
    pub seed: u64,
    /// Whether the first candidate is accepted; `false` without a candidate.
    pub accepted: bool,
    /// The sum of squares of the first candidate at the crank angles; `None` without a candidate.
    pub sum_sq: Option<f64>,
    /// The sum of squared distances of the points to that candidate's whole curve.
    pub to_curve_sum_sq: Option<f64>,
    /// In a path: the distance of it and that candidate's curve from each other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub two_sided: Option<TwoSidedRecord>,
    /// In a motion: the other errors of that candidate.
    #[serde(flatten)]
    pub motion: Option<MotionErrors>,
    /// The number of evaluations of the objective.
    pub evaluations: u64,
    /// The time from the checked problem to the ranked candidates with their figures, in seconds.
    pub search_s: f64,
    /// The reason why the search ended.
    pub reason: Reason,
}

impl Run {
    /// Returns the figure that answers are compared by: a motion's objective, a path's sum of squares; `None` without a
    /// candidate.
    pub fn figure(&self) -> Option<f64> {
        self.motion.map(|motion| motion.objective).or(self.sum_sq)
    }
}

/// The figures with which the runs of a problem are compared: sums of squares of a path, objectives of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// The figure that counts as a hit.
    pub goal: f64,
    /// The least figure that is known.
    pub best_known: f64,
    /// The figure below which a fit is exact.
    pub exact: f64,
}

impl Bar {
    /// Returns whether figure <= goal (1 + [`WITHIN`]) + exact.
    pub fn is_reached_by(&self, figure: f64) -> bool {
        figure <= self.goal * (1.0 + WITHIN) + self.exact
    }

    /// Returns whether figure <= best known (1 + [`WITHIN`]) + exact.
    pub fn best_known_is_reached_by(&self, figure: f64) -> bool {
        figure <= self.best_known * (1.0 + WITHIN) + self.exact
    }

    /// Returns whether figure < best known (1 - [`WITHIN`]) - exact: smaller than anything known, and not by rounding.
    pub fn is_beaten_by(&self, figure: f64) -> bool {
        figure < self.best_known * (1.0 - WITHIN) - self.exact
    }
}

/// The summary of the runs of one method on one problem. Sums and objectives are of accepted candidates only.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The number of runs whose first candidate is accepted.
    pub accepted: usize,
    /// The accepted run with the least sum of squares, or in a motion the least objective; the first of equal ones.
    pub best: Option<Best>,
    /// The median sum of squares of the accepted runs.
    pub median_sum_sq: Option<f64>,
    /// In a motion: the median objective of the accepted runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub median_objective: Option<f64>,
    /// The number of accepted runs that reach the goal.
    pub hits: usize,
    /// The number of accepted runs that reach the best known sum, or in a motion the best known objective.
    pub hits_of_best_known: usize,
    /// The median time of a search over all runs, in seconds.
    pub median_search_s: Option<f64>,
    /// The longest time of a search, in seconds.
    pub worst_search_s: Option<f64>,
    /// The median number of evaluations of the objective, over all runs.
    pub median_evaluations: Option<u64>,
}

/// The run with the best accepted answer of several runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Best {
    /// The seed.
    pub seed: u64,
    /// The sum of squares at the crank angles.
    pub sum_sq: f64,
    /// The sum of squared distances of the points to the whole curve.
    pub to_curve_sum_sq: Option<f64>,
    /// In a path: the distance of it and the curve from each other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub two_sided: Option<TwoSidedRecord>,
    /// In a motion: its other errors.
    #[serde(flatten)]
    pub motion: Option<MotionErrors>,
}

impl Best {
    /// Returns the figure that answers are compared by: a motion's objective, a path's sum of squares.
    pub fn figure(&self) -> f64 {
        self.motion.map_or(self.sum_sq, |motion| motion.objective)
    }
}

impl Summary {
    /// Returns the summary of these runs.
    pub fn of(runs: &[Run], bar: &Bar) -> Self {
        let accepted = || runs.iter().filter(|run| run.accepted);
        let sums: Vec<f64> = accepted().filter_map(|run| run.sum_sq).collect();
        let times: Vec<f64> = runs.iter().map(|run| run.search_s).collect();
        let evaluations: Vec<u64> = runs.iter().map(|run| run.evaluations).collect();
        let objectives: Vec<f64> = accepted().filter_map(|run| Some(run.motion?.objective)).collect();
        let figures: Vec<f64> = accepted().filter_map(Run::figure).collect();
        let reached = |by: fn(&Bar, f64) -> bool| figures.iter().filter(|figure| by(bar, **figure)).count();
        let of = |run: &Run| {
            let Run { seed, sum_sq, to_curve_sum_sq, two_sided, motion, .. } = *run;
            Some(Best { seed, sum_sq: sum_sq?, to_curve_sum_sq, two_sided, motion })
        };
        Summary {
            accepted: accepted().count(),
            best: accepted().filter_map(of).min_by(|one, other| one.figure().total_cmp(&other.figure())),
            median_sum_sq: median(&sums),
            median_objective: median(&objectives),
            hits: reached(Bar::is_reached_by),
            hits_of_best_known: reached(Bar::best_known_is_reached_by),
            median_search_s: median(&times),
            worst_search_s: times.into_iter().max_by(f64::total_cmp),
            median_evaluations: median_whole(&evaluations),
        }
    }
}

/// Returns the median: the middle value, or the mean of the two middle values of an even number. `None` without values.
///
/// ```
/// use linkwright::internals::record::statistics::median;
/// assert_eq!(median(&[9.0, 1.0, 2.0]), Some(2.0));
/// assert_eq!(median(&[9.0, 1.0, 2.0, 4.0]), Some(3.0));
/// assert_eq!(median(&[]), None);
/// ```
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = middle(&sorted)?;
    Some(0.5 * low + 0.5 * high)
}

/// Returns the median of whole numbers, as [`median`] does, rounded down.
pub fn median_whole(values: &[u64]) -> Option<u64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    let (low, high) = middle(&sorted)?;
    Some(low + (high - low) / 2)
}

/// Returns the two middle values of a sorted list; the same value twice if their number is odd.
fn middle<T: Copy>(sorted: &[T]) -> Option<(T, T)> {
    let n = sorted.len();
    Some((*sorted.get(n.checked_sub(1)? / 2)?, *sorted.get(n / 2)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Reason;

    const BAR: Bar = Bar { goal: 3.0, best_known: 2.0, exact: 1e-20 };

    fn run(seed: u64, accepted: bool, sum_sq: f64) -> Run {
        Run {
            seed,
            accepted,
            sum_sq: Some(sum_sq),
            to_curve_sum_sq: Some(0.5 * sum_sq),
            two_sided: None,
            motion: None,
            evaluations: 100 * seed,
            search_s: 0.25 * seed as f64,
            reason: Reason::Converged,
        }
    }

    #[test]
    fn only_accepted_runs_have_sums_and_hits_and_every_run_has_a_time() {
        let runs = [
            run(1, true, 2.5),
            run(2, false, 1.0),
            run(3, true, 2.0),
            run(4, true, 7.0),
            run(5, true, 2.0),
            Run { sum_sq: None, to_curve_sum_sq: None, ..run(6, false, 0.0) },
        ];
        let summary = Summary::of(&runs, &BAR);
        assert_eq!((summary.accepted, summary.hits, summary.hits_of_best_known), (4, 3, 2));
        let best = summary.best.expect("four are accepted");
        assert_eq!(
            (best.seed, best.sum_sq, best.to_curve_sum_sq),
            (3, 2.0, Some(1.0)),
            "the first of equals"
        );
        assert_eq!(summary.median_sum_sq, Some(2.25));
        assert_eq!((summary.median_search_s, summary.worst_search_s), (Some(0.875), Some(1.5)));
        assert_eq!(summary.median_evaluations, Some(350));
    }

    #[test]
    fn runs_of_a_motion_are_compared_by_their_objective() {
        let of = |seed: u64, sum_sq: f64, objective: f64| Run {
            motion: Some(MotionErrors { objective, rms: 0.5, rms_deg: Some(0.25) }),
            ..run(seed, true, sum_sq)
        };
        let summary = Summary::of(&[of(1, 0.1, 4.0), of(2, 0.3, 2.0), of(3, 0.2, 3.0)], &BAR);
        let best = summary.best.expect("all are accepted");
        assert_eq!((best.seed, best.figure(), best.sum_sq), (2, 2.0, 0.3), "not the least sum");
        assert_eq!((summary.median_sum_sq, summary.median_objective), (Some(0.2), Some(3.0)));
        assert_eq!((summary.hits, summary.hits_of_best_known), (2, 1));
    }

    #[test]
    fn the_errors_of_a_motion_stand_among_the_keys_of_a_run_and_a_path_has_none_of_them() {
        let keys = |run: &Run| {
            let value = serde_json::to_value(run).expect("JSON");
            let keys = value.as_object().expect("a table").keys().cloned();
            keys.filter(|key| ["objective", "rms", "rms_deg", "motion"].contains(&key.as_str())).count()
        };
        let path = run(1, true, 2.0);
        let motion = Some(MotionErrors { objective: 4.0, rms: 0.5, rms_deg: Some(0.25) });
        assert_eq!((keys(&path), keys(&Run { motion, ..path })), (0, 3));
    }

    #[test]
    fn nothing_accepted_has_no_median_and_no_best() {
        let summary = Summary::of(&[run(1, false, 0.0)], &BAR);
        assert_eq!((summary.best, summary.median_sum_sq, summary.hits), (None, None, 0));
        assert_eq!(Summary::of(&[], &BAR).worst_search_s, None);
    }

    #[test]
    fn a_hit_is_within_a_millionth_and_a_new_best_is_beyond_it() {
        assert!(BAR.is_reached_by(3.0 * (1.0 + 0.9e-6)) && !BAR.is_reached_by(3.0 * (1.0 + 1.1e-6)));
        assert!(BAR.best_known_is_reached_by(2.0) && !BAR.best_known_is_reached_by(2.0 * (1.0 + 1.1e-6)));
        assert!(BAR.is_beaten_by(2.0 * (1.0 - 1.1e-6)) && !BAR.is_beaten_by(2.0 * (1.0 - 0.9e-6)));
    }

    #[test]
    fn an_exact_answer_is_hit_by_rounding_alone_and_never_beaten() {
        let bar = Bar { goal: 0.0, best_known: 0.0, exact: 1e-20 };
        assert!(bar.is_reached_by(9e-21) && !bar.is_reached_by(2e-20));
        assert!(!bar.is_beaten_by(0.0));
    }

    #[test]
    fn the_median_of_whole_numbers_does_not_overflow() {
        assert_eq!(median_whole(&[u64::MAX, u64::MAX - 2]), Some(u64::MAX - 1));
        assert_eq!(median_whole(&[7]), Some(7));
        assert_eq!(median_whole(&[]), None);
    }
}
