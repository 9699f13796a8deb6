//! Repeated hits of the best answer, and the chance that a better one was not seen.
//!
//! A *start* is one independent draw of a search: it ends in one of the basins of the objective, in each with a
//! probability of its own, its *share*. Of n starts h ended in the best basin. Nothing below is a proof: each figure
//! holds under the assumptions that are given beside it.
//!
//! ```text
//! as_likely     = 2^-h              a better basin with the same share as the best: of the starts that end in one of
//!                                   the two each is as likely, and h of h ended in the worse one
//! share_seen    = 1 - 0.05^(1/n)    n starts miss every basin of a share s with the probability (1 - s)^n
//! unseen_better = w / (m - 1)       m starts were followed to an end and came to w different basins
//! ```
//!
//! The last one is Bayes' rule for a number K of basins of which nothing is known beforehand, shares that are uniform on
//! the simplex and independent of what the basins are worth (C. G. E. Boender, A. H. G. Rinnooy Kan, Bayesian stopping
//! rules for multistart global optimization methods, Mathematical Programming 37, 1987, 59-80). There the
//! probability of K >= w basins after m starts that came to w is, for m >= w + 2,
//!
//! ```text
//! p(K) = (m-1)! (m-2)! K! (K-1)! / (w! (w-1)! (m-w-2)! (K-w)! (m+K-1)!)
//! ```
//!
//! and each of the K is the best one with the same probability, so that it is among those seen with w/K. Gauss's sum of
//! the hypergeometric series gives E(w/K) = (m-w-1)/(m-1), and `unseen_better` is one minus that.

use serde::{Deserialize, Serialize};

/// The probability with which a basin of the given share is missed.
const MISSED: f64 = 0.05;

/// How often the best answer came back from independent starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Repeats {
    /// Independent starts.
    pub starts: u64,
    /// Those that ended in the best answer, within a part in 1e6 of its objective.
    pub hits: u64,
    /// Those that came near to it, within a part in 1000.
    pub near: u64,
    /// Starts that were followed to an end, where that was counted; the others were given up as worse.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed: Option<u64>,
    /// How many different basins these came to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub basins: Option<u64>,
    /// The probability of so many hits of the best if a better basin had the same share: 2^-hits.
    pub as_likely: f64,
    /// A better basin of this share would have been seen with 95 %: 1 - 0.05^(1/starts).
    pub share_seen: f64,
    /// The probability that a better basin has not been seen, where basins were counted and are few enough beside the
    /// starts (basins + 2 at most): basins/(followed - 1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unseen_better: Option<f64>,
}

impl Repeats {
    /// Returns the figures of `starts` starts, of which `hits` came to the best and `near` near it.
    pub fn new(starts: u64, hits: u64, near: u64) -> Self {
        Repeats {
            starts,
            hits,
            near,
            followed: None,
            basins: None,
            as_likely: 0.5_f64.powf(hits as f64),
            share_seen: if starts == 0 { 1.0 } else { 1.0 - MISSED.powf(1.0 / starts as f64) },
            unseen_better: None,
        }
    }

    /// Adds that `followed` of the starts came to `basins` different basins.
    #[must_use]
    pub fn with_basins(self, followed: u64, basins: u64) -> Self {
        let few = basins > 0 && followed >= basins + 2;
        let unseen_better = few.then(|| basins as f64 / (followed - 1) as f64);
        Repeats { followed: Some(followed), basins: Some(basins), unseen_better, ..self }
    }

    /// Returns the same counts with every figure that follows from them recomputed.
    #[must_use]
    pub fn recomputed(&self) -> Self {
        let counted = Repeats::new(self.starts, self.hits, self.near);
        match (self.followed, self.basins) {
            (Some(followed), Some(basins)) => counted.with_basins(followed, basins),
            _ => counted,
        }
    }

    /// Whether the counts can be.
    pub fn is_possible(&self) -> bool {
        let followed = self.followed.unwrap_or(self.starts);
        self.hits <= self.near
            && self.near <= followed
            && followed <= self.starts
            && self.basins.is_none_or(|basins| basins <= followed)
            && self.followed.is_some() == self.basins.is_some()
    }
}
