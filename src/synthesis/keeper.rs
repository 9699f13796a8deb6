//! Checkpoints of long searches: the state of a search at a batch boundary, and the keeper that saves it.
//!
//! A *boundary* lies between two batches of rounds or two generations of a population. The continuation of a search
//! from there is a function of the problem and of its state there, whatever the number of threads: a search resumed
//! from the state ends in the same bytes as one that was never interrupted.
//!
//! A state does not depend on the budget under which it was reached. The remaining budget shortens a batch only near
//! the end, and the states after such a batch are not saved ([`super::driver`]). So a search may be resumed with a larger
//! budget, and ends as if it had been given that budget from the beginning.
//!
//! Each part of a search (least squares, then differential evolution ..) has the state of its own last boundary. A
//! resumed search runs each part from there: a part that had ended before ends again after one batch or two.

pub use super::states::SearchState;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The shortest time between two saved states, by default.
pub const LEAST_PAUSE: Duration = Duration::from_secs(1);
/// The time between two saved states in units of the time that saving the last one took: that is half a percent of the
/// search.
const PAUSE: u32 = 200;

/// The frequency at which states are saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Not more often than [`LEAST_PAUSE`], and less often if saving takes long: it costs a search less than one
    /// percent.
    Seldom,
    /// As `Seldom`, with another shortest pause.
    NotWithin(Duration),
    /// At every boundary, whatever it costs.
    EveryBoundary,
}

/// Saves the states of one search through a sink, and returns the state of an earlier search that is resumed.
pub struct Keeper<'a> {
    earlier: SearchState,
    kept: Mutex<Kept>,
    pace: Pace,
    sink: &'a (dyn Fn(&SearchState) + Sync),
}

struct Kept {
    state: SearchState,
    since: Instant,
    least: Duration,
    pause: Duration,
}

impl<'a> Keeper<'a> {
    /// Creates a keeper that gives every saved state to `sink`, of a search that resumes from `earlier`.
    pub fn new(earlier: SearchState, pace: Pace, sink: &'a (dyn Fn(&SearchState) + Sync)) -> Self {
        let least = match pace {
            Pace::Seldom => LEAST_PAUSE,
            Pace::NotWithin(pause) => pause,
            Pace::EveryBoundary => Duration::ZERO,
        };
        let kept = Kept { state: earlier.clone(), since: Instant::now(), least, pause: least };
        Keeper { earlier, kept: Mutex::new(kept), pace, sink }
    }

    /// Returns the state of the earlier search.
    pub(super) fn earlier(&self) -> &SearchState {
        &self.earlier
    }

    /// Saves a state if enough time has passed, and always if the search is about to be stopped.
    pub(super) fn keep(&self, stopped: bool, put: impl FnOnce(&mut SearchState)) {
        let mut kept: MutexGuard<'_, Kept> = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = Instant::now();
        let due = begun.saturating_duration_since(kept.since) >= kept.pause;
        if !(due || stopped || self.pace == Pace::EveryBoundary) {
            return;
        }
        put(&mut kept.state);
        (self.sink)(&kept.state);
        kept.since = Instant::now();
        kept.pause = kept.least.max(begun.elapsed() * PAUSE);
    }
}
