//! Stopping rule of a multistart search: the best answer is accepted as the global optimum after repeated hits.
//!
//! Batches are independent draws. The best objective is *believed* (the search may stop) once [`HITS`] different
//! batches have reached it within one part in 1e6, the one that found it included. If it is approached but never
//! reached (at a toggle or a change point every end is a little better than the last), it is enough that [`FLAT_HITS`]
//! batches came within one part in a thousand. A better answer restarts the count. If a batch finds the true optimum
//! with probability P and another optimum with probability p, that other one is believed in its stead with a
//! probability below (p / (p + P))^HITS.

use crate::numbers::optimise::exact_float;
use serde::{Deserialize, Serialize};

/// Batches that have to reach the best objective.
pub const HITS: usize = 4;
/// Batches that suffice if they only come within a thousandth of it.
pub const FLAT_HITS: usize = 12;
/// Relative difference of objectives below which they are the same optimum.
pub(super) const SAME_OPTIMUM: f64 = 1e-6;
/// Relative difference of objectives below which they are nearly the same optimum.
pub(super) const NEARLY: f64 = 1e-3;
/// Rounds in the physical parameters that have to reach the best answer before it is believed.
pub(super) const ROUND_HITS: usize = 6;

/// The number of independent rounds with free timing that have to reach the best answer before it is believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FreeHits {
    /// Rounds that reach it within [`SAME_OPTIMUM`].
    pub(super) same: usize,
    /// Rounds that reach it within [`NEARLY`].
    pub(super) near: usize,
}

/// Hits for sparse targets: each point counts for much, so optima are many and rare ones worth waiting for.
pub(super) const SPARSE_HITS: FreeHits = FreeHits { same: 5, near: 20 };
/// Hits for dense targets: many points determine the linkage better, and a round costs more.
pub(super) const DENSE_HITS: FreeHits = FreeHits { same: 4, near: 12 };

/// The state of the stopping rule: the best objective and its repeated hits.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Belief {
    /// The objective up to which answers are exact, and count as equal.
    exact: f64,
    #[serde(with = "exact_float")]
    best: f64,
    hits: usize,
    near_hits: usize,
    /// Whether the present batch reached the best objective; `near`: whether it came near it.
    hit: bool,
    near: bool,
}

impl Default for Belief {
    fn default() -> Self {
        Belief::new(0.0)
    }
}

impl Belief {
    /// Creates the state before anything is found; objectives up to `exact` count as equal.
    pub fn new(exact: f64) -> Self {
        Belief { exact, best: f64::INFINITY, hits: 0, near_hits: 0, hit: false, near: false }
    }

    /// Returns the best acceptable objective so far; infinite if there is none.
    pub fn best(&self) -> f64 {
        self.best
    }

    /// Returns whether an objective would be a better optimum than the best.
    pub fn would_improve(&self, objective: f64) -> bool {
        self.best.is_infinite() || (self.best > self.exact && objective < self.best * (1.0 - SAME_OPTIMUM))
    }

    /// Records an acceptable answer of this objective in the present batch.
    pub fn came_to(&mut self, objective: f64) {
        if self.would_improve(objective) {
            (self.hits, self.hit) = (0, false);
            if self.best.is_infinite() || objective < self.best * (1.0 - NEARLY) - self.exact {
                (self.near_hits, self.near) = (0, false);
            }
        }
        self.best = self.best.min(objective);
        self.hit |= self.within(SAME_OPTIMUM, objective);
        self.near |= self.within(NEARLY, objective);
    }

    /// Records an unjudged local optimum of this objective in the present batch. It counts at most as a repeated hit of
    /// the best, never as a better answer.
    pub fn came_back_to(&mut self, objective: f64) {
        if self.best.is_finite() && !self.would_improve(objective) {
            self.hit |= self.within(SAME_OPTIMUM, objective);
            self.near |= self.within(NEARLY, objective);
        }
    }

    fn within(&self, part: f64, objective: f64) -> bool {
        objective <= self.best + (part * self.best).max(self.exact)
    }

    /// Ends the present batch and counts its hits.
    pub fn end_batch(&mut self) {
        self.hits += usize::from(self.hit);
        self.near_hits += usize::from(self.near);
        (self.hit, self.near) = (false, false);
    }

    /// Returns the number of batches that reached the best objective, and the number that came near it.
    pub fn hits(&self) -> (usize, usize) {
        (self.hits, self.near_hits)
    }

    /// Returns whether the best objective has enough repeated hits to be believed.
    pub fn is_firm(&self) -> bool {
        self.hits >= HITS || self.near_hits >= FLAT_HITS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the state after batches that reached these objectives.
    fn after(batches: &[&[f64]]) -> Belief {
        let mut belief = Belief::new(1e-20);
        for batch in batches {
            batch.iter().for_each(|objective| belief.came_to(*objective));
            belief.end_batch();
        }
        belief
    }

    #[test]
    fn the_best_is_believed_when_it_came_from_four_batches() {
        assert!(!after(&[&[1.0], &[1.0], &[1.0]]).is_firm());
        assert!(after(&[&[1.0], &[1.0], &[1.0 + 5e-7], &[1.0]]).is_firm());
        assert!(!after(&[&[1.0, 1.0, 1.0, 1.0, 1.0], &[1.0], &[2.0]]).is_firm(), "a batch counts once");
        assert!(!after(&[&[1.0], &[1.0], &[1.0], &[0.9]]).is_firm(), "a better one starts anew");
        assert!(after(&[&[1.0], &[0.9], &[3.0], &[0.9], &[0.9, 5.0], &[7.0], &[0.9]]).is_firm());
    }

    #[test]
    fn what_is_only_approached_is_believed_when_enough_batches_came_near() {
        let creeping: Vec<f64> = (0..20).map(|i| 1.0 - 1e-5 * f64::from(i)).collect();
        let batches: Vec<&[f64]> = creeping.chunks(1).collect();
        assert!(!after(&batches[..FLAT_HITS - 1]).is_firm());
        assert!(after(&batches[..FLAT_HITS]).is_firm());
        let mut better = batches;
        better.insert(10, &[0.5]);
        assert!(!after(&better).is_firm(), "one that is better by more than a thousandth starts anew");
    }

    #[test]
    fn exact_answers_are_equal_and_unjudged_ends_only_come_back() {
        assert!(after(&[&[1e-21], &[1e-30], &[0.0], &[5e-21]]).is_firm());
        let mut belief = after(&[&[1.0], &[1.0], &[1.0]]);
        belief.came_back_to(0.5);
        belief.end_batch();
        assert!(!belief.is_firm() && belief.best() == 1.0, "an end that no one judged is no answer");
        belief.came_back_to(1.0);
        belief.end_batch();
        assert!(belief.is_firm());
        let mut nothing = Belief::new(1e-20);
        nothing.came_back_to(1.0);
        nothing.end_batch();
        assert!(nothing.best().is_infinite() && nothing.would_improve(1e300));
    }
}
