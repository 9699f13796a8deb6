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

/// Saves the states of one search through a sink, and returns the state of an earlier search that is resumed.
pub struct Keeper<'a> {
    earlier: SearchState,
    kept: Mutex<Kept>,
    least: Duration,
    sink: &'a (dyn Fn(&SearchState) + Sync),
}

struct Kept {
    state: SearchState,
    since: Instant,
    pause: Duration,
}

impl<'a> Keeper<'a> {
    /// Creates a keeper that gives every saved state to `sink`, of a search that resumes from `earlier`. States are not
    /// saved more often than after the pause `least`, and less often if saving takes long: it costs a search less than
    /// one percent. If `least` is zero they are saved at every boundary, whatever it costs.
    pub fn new(earlier: SearchState, least: Duration, sink: &'a (dyn Fn(&SearchState) + Sync)) -> Self {
        let kept = Kept { state: earlier.clone(), since: Instant::now(), pause: least };
        Keeper { earlier, kept: Mutex::new(kept), least, sink }
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
        if !(due || stopped || self.least.is_zero()) {
            return;
        }
        put(&mut kept.state);
        (self.sink)(&kept.state);
        kept.since = Instant::now();
        kept.pause = self.least.max(begun.elapsed() * PAUSE);
    }
}
