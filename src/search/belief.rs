//! When the best answer of a random search is believed: a stopping rule by repeated hits.
//!
//! Batches are independent draws. The best objective is believed when it has come back, within one part in 1e6,
//! from [`HITS`] different batches, the one that found it included. Where it is approached and never reached (at
//! a toggle or a change point every end is a little better than the last) it is enough that [`FLAT_HITS`]
//! batches came within one part in a thousand. A better answer starts the count anew. If a batch finds the true
//! optimum with probability P and another with probability p, that other one is believed in its stead with a
//! probability below (p / (p + P))^HITS.

use crate::solve::exact_float;
use serde::{Deserialize, Serialize};

/// The best objective has to come from this many batches.
pub const HITS: usize = 4;
/// Or within a thousandth from this many.
pub const FLAT_HITS: usize = 16;
/// Errors that differ by less than this part are the same optimum.
const SAME: f64 = 1e-6;
/// Errors that differ by less than this part are near the same optimum.
const NEAR: f64 = 1e-3;

/// What is believed of the best objective.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Belief {
    /// Objectives up to this are exact, and equal.
    exact: f64,
    #[serde(with = "exact_float")]
    best: f64,
    hits: usize,
    near_hits: usize,
    /// Whether the present batch came to the best, or near it.
    hit: bool,
    near: bool,
}

impl Belief {
    /// Nothing found; objectives up to `exact` count as equal.
    pub fn new(exact: f64) -> Self {
        Belief { exact, best: f64::INFINITY, hits: 0, near_hits: 0, hit: false, near: false }
    }

    /// The best acceptable objective so far; infinite where there is none.
    pub fn best(&self) -> f64 {
        self.best
    }

    /// Whether an objective would be a better optimum than the best.
    pub fn would_improve(&self, objective: f64) -> bool {
        self.best.is_infinite() || (self.best > self.exact && objective < self.best * (1.0 - SAME))
    }

    /// The present batch came to an acceptable answer with this objective.
    pub fn came_to(&mut self, objective: f64) {
        if self.would_improve(objective) {
            (self.hits, self.hit) = (0, false);
            if self.best.is_infinite() || objective < self.best * (1.0 - NEAR) - self.exact {
                (self.near_hits, self.near) = (0, false);
            }
        }
        self.best = self.best.min(objective);
        self.hit |= self.within(SAME, objective);
        self.near |= self.within(NEAR, objective);
    }

    /// The present batch has an end of this objective that no one has judged: at most a return to the best.
    pub fn came_back_to(&mut self, objective: f64) {
        if self.best.is_finite() && !self.would_improve(objective) {
            self.hit |= self.within(SAME, objective);
            self.near |= self.within(NEAR, objective);
        }
    }

    fn within(&self, part: f64, objective: f64) -> bool {
        objective <= self.best + (part * self.best).max(self.exact)
    }

    /// The present batch is over.
    pub fn end_batch(&mut self) {
        self.hits += usize::from(self.hit);
        self.near_hits += usize::from(self.near);
        (self.hit, self.near) = (false, false);
    }

    /// How many batches came to the best.
    pub fn hits(&self) -> usize {
        self.hits
    }

    /// Whether the best is believed.
    pub fn is_firm(&self) -> bool {
        self.hits >= HITS || self.near_hits >= FLAT_HITS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The belief after batches that came to these objectives.
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
