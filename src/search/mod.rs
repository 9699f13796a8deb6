//! Search strategies: multistart rounds, populations and continuation; the choice of the answers (distinct ones,
//! cognates, families, warnings, buildable ones); what the requirements cost; and the relaxations that help if nothing
//! is acceptable.

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

/// The limits that stop a search from outside.
#[derive(Clone, Copy, Debug)]
pub struct Budget<'a> {
    /// The cancellation flag; setting it ends the search with its best answer so far.
    pub cancel: &'a AtomicBool,
    /// The time limit, if one was asked for.
    pub deadline: Option<Instant>,
}

impl<'a> Budget<'a> {
    /// Creates a budget whose time limit counts from now.
    pub fn new(cancel: &'a AtomicBool, time_limit_s: Option<f64>) -> Self {
        let limit = time_limit_s.and_then(|s| Duration::try_from_secs_f64(s).ok());
        Budget { cancel, deadline: limit.and_then(|limit| Instant::now().checked_add(limit)) }
    }

    /// Returns whether the search should end now.
    pub fn stopped(&self) -> bool {
        self.stop_reason().is_some()
    }

    /// Returns the reason why the search should end now, if there is one.
    pub fn stop_reason(&self) -> Option<Reason> {
        if is_stopped_by_a_test() || self.cancel.load(Ordering::Relaxed) {
            return Some(Reason::Cancelled);
        }
        self.deadline.filter(|deadline| Instant::now() >= *deadline).map(|_| Reason::TimeLimit)
    }

    /// Returns whether there is time to judge candidates of so many target points in total: always until the search is
    /// stopped, and after that only if it takes a fraction of a second.
    pub fn leaves_time_for(&self, points: usize) -> bool {
        points <= JUDGED_AFTER_STOP || !self.stopped()
    }

    /// Counts how many candidates of `points` target points each may still be judged once the search is stopped.
    pub fn judging(&self, points: usize) -> Judging<'_> {
        Judging { budget: self, points, after_stop: AtomicUsize::new(0) }
    }
}

/// The number of target points, summed over the candidates, that are still judged after a stop. Judging takes about 200
/// positions of the linkage per target point, so that this many take a fraction of a second.
pub const JUDGED_AFTER_STOP: usize = 20_000;

/// A counter of the candidates that may still be judged: all of them until the search is stopped, and from then on as
/// many as have [`JUDGED_AFTER_STOP`] target points together, but always one, so that there is an answer.
#[derive(Debug)]
pub struct Judging<'a> {
    budget: &'a Budget<'a>,
    points: usize,
    after_stop: AtomicUsize,
}

impl Judging<'_> {
    /// Returns whether one more candidate may be judged, and counts it as judged.
    pub fn may_go_on(&self) -> bool {
        if !self.budget.stopped() {
            return true;
        }
        let before = self.after_stop.fetch_add(1, Ordering::Relaxed);
        before == 0 || (before + 1).saturating_mul(self.points) <= JUDGED_AFTER_STOP
    }
}

/// The progress of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// The current phase, in a few words.
    pub phase: &'static str,
    /// Evaluations so far.
    pub evaluations: u64,
    /// The budget of evaluations.
    pub budget: u64,
    /// The best sum of squares of an acceptable candidate so far, or else of any candidate; `None` if the search does
    /// not track it.
    pub best_sum_sq: Option<f64>,
    /// Whether the candidate with `best_sum_sq` is acceptable.
    pub accepted: bool,
    /// The repeated hits of the best acceptable candidate; `None` if the search does not count them.
    pub hits: Option<HitsSoFar>,
}

/// The number of independent rounds of starts that reached the best answer, and the number that the stopping rule
/// wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitsSoFar {
    /// Rounds that reached the best answer, the round that found it included.
    pub came: usize,
    /// Rounds that have to reach it before the search stops.
    pub wanted: usize,
}

/// A callback that receives the progress of a search.
pub type Observer<'a> = dyn Fn(&Progress) + Sync + 'a;

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct SearchOutcome {
    /// Distinct candidates, ranked.
    pub candidates: Vec<Candidate>,
    /// The other candidates found: repeats of the same answers, worse ones, and unacceptable ones.
    pub others: Vec<Candidate>,
    /// Names of the methods that ran, in order.
    pub used: Vec<String>,
    /// The reason why the search ended.
    pub reason: Reason,
    /// The evaluations used.
    pub evaluations: Evaluations,
    /// All linkages through nine precision points, if they were asked for.
    pub exact: Option<ExactRecord>,
    /// The repeated hits of the best answer, if they were counted.
    pub repeats: Option<Repeats>,
}
