//! Long searches survive: where a search stands at a boundary, and who keeps it.
//!
//! A *boundary* lies between two batches of rounds or two generations of a population. What a search does from there
//! on is a function of the problem and of its state there, whatever the number of threads: a search that begins
//! from the state ends in the same bytes as one that was never broken.
//!
//! A state says nothing of the budget it was reached under. A batch is cut by what is left of the budget only near
//! its end, and the states after such a batch are not kept (`spared`): so a search may go on from a state with a
//! larger budget, and ends as if it had been given that budget from the beginning.
//!
//! Each part of a search (least squares, then differential evolution ..) keeps the state of its own last boundary. A
//! search that goes on runs each part from there: what was over by then is over again after one batch or two.

use super::free::FreeState;
use super::plan::RoundsState;
use super::timed::TimedState;
use crate::problem::Problem;
use crate::record::Candidate;
use crate::solve::argmin_bridge::RestartsState;
use serde::{Deserialize, Serialize};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A state is kept at most this often, unless something else is said.
pub const LEAST_PAUSE: Duration = Duration::from_secs(1);
/// .. and only after this many times as long as keeping the one before took: that is half a percent of the search.
const PAUSE: u32 = 200;

/// Where a search stands: the last kept boundary of each of its parts.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SearchState {
    /// Least squares with free timing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) free: Option<FreeState>,
    /// The reduced form of prescribed timing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) timed: Option<TimedState>,
    /// Prescribed timing in the physical parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) rounds: Option<RoundsState>,
    /// A population search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) population: Option<RestartsState>,
}

/// How often states are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Not more often than [`LEAST_PAUSE`], and less often where it takes long: it costs a search less than one percent.
    Seldom,
    /// The same with another pause.
    NotWithin(Duration),
    /// At every boundary, whatever it costs.
    EveryBoundary,
}

/// Takes the states of one search to where they are kept, and gives back what an earlier search left there.
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
    /// A keeper that gives every state to `sink`, of a search that begins where `earlier` stood.
    pub fn new(earlier: SearchState, pace: Pace, sink: &'a (dyn Fn(&SearchState) + Sync)) -> Self {
        let least = match pace {
            Pace::Seldom => LEAST_PAUSE,
            Pace::NotWithin(pause) => pause,
            Pace::EveryBoundary => Duration::ZERO,
        };
        let kept = Kept { state: earlier.clone(), since: Instant::now(), least, pause: least };
        Keeper { earlier, kept: Mutex::new(kept), pace, sink }
    }

    /// Where the earlier search stood.
    pub(super) fn earlier(&self) -> &SearchState {
        &self.earlier
    }

    /// Keeps a state where it is time to, and in any case where the search is about to be stopped.
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

/// Whether a budget has let something run as if there were no end to it: an eighth of what was allowed, and enough
/// for whatever looks ahead by a few evaluations, was left.
pub(super) fn spared(used: u64, allowed: u64) -> bool {
    allowed >= 1000 && used <= allowed - allowed / 8
}

/// Whether candidates that were kept can be of this problem.
pub(super) fn of_as_many_points(problem: &Problem, found: &[Candidate], best: &Option<Candidate>) -> bool {
    let n = problem.task().len();
    found.iter().chain(best).all(|c| c.crank_deg.len() == n && c.t1_at.len() == n)
}
