//! The archive of a front: linkages that none dominates.

use crate::judge::trade_off::{Scales, Wishes, are_equal, dominates, hypervolume};
use crate::record::{Candidate, Figures};
use crate::synthesis::constants::front::{MOST_KEPT, NEAREST};
use crate::synthesis::tightened::Tighter;
use serde::{Deserialize, Serialize};

/// A linkage with the limits under which it was fitted.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The linkage, judged by the problem itself.
    pub(super) candidate: Candidate,
    /// The limits.
    pub(super) limits: Tighter,
}

/// Linkages that none dominates, in the order in which they came.
pub(super) struct Archive {
    wishes: Wishes,
    entries: Vec<(Entry, Figures)>,
}

impl Archive {
    pub(super) fn new(wishes: Wishes) -> Self {
        Archive { wishes, entries: Vec::new() }
    }

    pub(super) fn members(&self) -> &[(Entry, Figures)] {
        &self.entries
    }

    /// Takes linkages that none in the archive dominates or equals, and drops those that they dominate.
    pub(super) fn extend(&mut self, entries: impl IntoIterator<Item = (Entry, Figures)>) {
        for (entry, figures) in entries {
            let wishes = &self.wishes;
            let beaten =
                |other: &Figures| dominates(wishes, other, &figures) || are_equal(wishes, other, &figures);
            if self.entries.iter().any(|(_, other)| beaten(other)) {
                continue;
            }
            self.entries.retain(|(_, other)| !dominates(wishes, &figures, other));
            self.entries.push((entry, figures));
        }
        if self.entries.len() > MOST_KEPT {
            self.thin();
        }
    }

    /// Keeps those that add most to the volume.
    fn thin(&mut self) {
        let figures: Vec<Figures> = self.entries.iter().map(|(_, figures)| *figures).collect();
        let mut kept = crate::judge::trade_off::members(&self.wishes.axes, &figures, MOST_KEPT / 2);
        kept.sort_unstable();
        let mut place = 0;
        self.entries.retain(|_| {
            place += 1;
            kept.binary_search(&(place - 1)).is_ok()
        });
    }

    /// Returns the volume that the linkages dominate, on axes scaled over them.
    pub(super) fn volume(&self) -> f64 {
        let figures: Vec<Figures> = self.entries.iter().map(|(_, figures)| *figures).collect();
        let scales = Scales::of(&self.wishes.axes, &figures);
        let places: Vec<Vec<f64>> = figures.iter().map(|figures| scales.scaled(figures)).collect();
        hypervolume(&places)
    }

    /// Returns linkages from which limits can be reached: the given ones, and of those that keep the limits the one of
    /// least error.
    pub(super) fn near(&self, limits: &Tighter, given: &[usize]) -> Vec<Candidate> {
        let mut places: Vec<usize> = given.iter().copied().filter(|&i| i < self.entries.len()).collect();
        let inside = (0..self.entries.len()).filter(|&i| limits.holds(&self.entries[i].1));
        let best = inside.min_by(|&i, &j| self.entries[i].1.rms.total_cmp(&self.entries[j].1.rms));
        places.extend(best.filter(|best| !given.contains(best)));
        places.truncate(NEAREST);
        places.into_iter().map(|i| self.entries[i].0.candidate.clone()).collect()
    }
}
