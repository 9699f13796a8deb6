//! What to try: starts, rounds, populations; which answers to give: distinct ones, cognates of their curves,
//! families, warnings and what can be built; what the requirements cost, and what would help where nothing is
//! acceptable.

pub mod answers;
pub mod atlas;
pub mod belief;
pub mod buildable;
pub mod coarse;
pub mod cognates;
pub mod conflicts;
pub mod continuation;
pub mod costs;
pub mod exact_linkages;
pub mod family;
mod fixture;
pub mod free;
pub mod keeper;
mod look;
pub mod loosen;
pub mod multistart;
pub mod nearest;
pub mod plan;
pub mod polish;
pub mod population;
pub mod rank;
mod reassign;
pub mod reduced;
mod relaxed;
mod repeats;
pub mod starts;
mod stopping_tests;
pub mod symmetry;
pub mod timed;
pub mod warm;
pub mod warnings;

use crate::linkage::effort::is_stopped_by_a_test;
pub use relaxed::RELAXED;

use crate::record::{Candidate, Evaluations, ExactRecord, Reason, Repeats};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// What stops a search from outside.
#[derive(Clone, Copy, Debug)]
pub struct Budget<'a> {
    /// Set by whoever wants the search to end with its best so far.
    pub cancel: &'a AtomicBool,
    /// The time limit, where one was asked for.
    pub deadline: Option<Instant>,
}

impl<'a> Budget<'a> {
    /// A budget that starts now.
    pub fn new(cancel: &'a AtomicBool, time_limit_s: Option<f64>) -> Self {
        let limit = time_limit_s.and_then(|s| Duration::try_from_secs_f64(s).ok());
        Budget { cancel, deadline: limit.and_then(|limit| Instant::now().checked_add(limit)) }
    }

    /// Whether the search should end now.
    pub fn stopped(&self) -> bool {
        self.stop_reason().is_some()
    }

    /// Why the search should end now.
    pub fn stop_reason(&self) -> Option<Reason> {
        if is_stopped_by_a_test() || self.cancel.load(Ordering::Relaxed) {
            return Some(Reason::Cancelled);
        }
        self.deadline.filter(|deadline| Instant::now() >= *deadline).map(|_| Reason::TimeLimit)
    }

    /// Whether something may still be worked out that takes as long as judging candidates with so many target points
    /// together: always until the search is stopped, and then where it takes a fraction of a second.
    pub fn leaves_time_for(&self, points: usize) -> bool {
        points <= JUDGED_AFTER_STOP || !self.stopped()
    }

    /// Counts how many candidates of `points` target points each may still be judged once the search is stopped.
    pub fn judging(&self, points: usize) -> Judging<'_> {
        Judging { budget: self, points, after_stop: AtomicUsize::new(0) }
    }
}

/// Target points of the candidates that are still judged after a stop, all of them together. Judging takes about
/// 200 positions of the linkage a target point, so that this many take a fraction of a second.
pub const JUDGED_AFTER_STOP: usize = 20_000;

/// How many candidates may still be judged: all of them until the search is stopped, and from then on as many as have
/// [`JUDGED_AFTER_STOP`] target points together, but always one, so that there is something to give.
#[derive(Debug)]
pub struct Judging<'a> {
    budget: &'a Budget<'a>,
    points: usize,
    after_stop: AtomicUsize,
}

impl Judging<'_> {
    /// Whether one more may be judged; it counts as judged then.
    pub fn may_go_on(&self) -> bool {
        if !self.budget.stopped() {
            return true;
        }
        let before = self.after_stop.fetch_add(1, Ordering::Relaxed);
        before == 0 || (before + 1).saturating_mul(self.points) <= JUDGED_AFTER_STOP
    }
}

/// Where a search stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What is being done, in a few words.
    pub phase: &'static str,
    /// Evaluations so far.
    pub evaluations: u64,
    /// The budget of evaluations.
    pub budget: u64,
    /// The best sum of squares of an acceptable candidate so far, or else of any; `None` where a search does not
    /// know it.
    pub best_sum_sq: Option<f64>,
    /// Whether that one is acceptable.
    pub accepted: bool,
    /// How often the best acceptable one has come back; `None` where a search does not count that.
    pub hits: Option<HitsSoFar>,
}

/// How often the best answer has come from independent rounds of starts, and how often it has to come to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitsSoFar {
    /// So often it came, the round that found it included.
    pub came: usize,
    /// So often it has to come.
    pub wanted: usize,
}

/// Whoever wants to know where a search stands.
pub type Observer<'a> = dyn Fn(&Progress) + Sync + 'a;

/// The end of a search.
#[derive(Clone, Debug)]
pub struct SearchOutcome {
    /// Distinct candidates, ranked.
    pub candidates: Vec<Candidate>,
    /// What else was found: the same answers again, worse ones, and ones that are not acceptable.
    pub others: Vec<Candidate>,
    /// What ran, in order.
    pub used: Vec<String>,
    /// Why it ended.
    pub reason: Reason,
    /// What it cost.
    pub evaluations: Evaluations,
    /// Every linkage through nine precision points, where they were asked for.
    pub exact: Option<ExactRecord>,
    /// How often the best answer came back, where that was counted.
    pub repeats: Option<Repeats>,
}
