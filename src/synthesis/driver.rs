//! The loop of every search in batches.
//!
//! ```text
//! until the stopping rule is met, the budget is stopped, the evaluations are spent or the patience is at an end:
//!     save the state          unless a part of an earlier batch came near its allowance
//!     run a batch             with the evaluations left, in parallel
//!     read the batch          in the order of its parts
//!     report the progress
//! ```
//!
//! A search implements [`Strategy`] with its own state and its own batch. A batch that was cut short by a stop is read
//! for its candidates, but neither reported nor counted for convergence, and the state before it is the one saved.

use super::states::SearchState;
use super::{Context, HitsSoFar, Progress};
use crate::judge::rank::{count_distinct, is_exact};
use crate::record::{Candidate, Evaluations, Reason, Repeats};
use rayon::prelude::*;

/// The evaluations that a search may use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowance {
    /// The most evaluations.
    pub(super) limit: u64,
    /// The evaluations after which it gives up if it has no acceptable candidate.
    pub(super) patience: u64,
}

/// The results of one or several searches.
#[derive(Debug)]
pub struct Found {
    /// Judged candidates.
    pub candidates: Vec<Candidate>,
    /// The evaluations used.
    pub evaluations: Evaluations,
    /// The reason why the last search ended.
    pub reason: Reason,
    /// Names of the methods that ran, in order.
    pub used: Vec<String>,
    /// The repeated hits of the best answer of the last search, if they were counted.
    pub repeats: Option<Repeats>,
}

impl Found {
    /// Creates the results before any search.
    pub(super) fn nothing() -> Self {
        Found {
            candidates: Vec::new(),
            evaluations: Evaluations::default(),
            reason: Reason::EvaluationLimit,
            used: Vec::new(),
            repeats: None,
        }
    }

    /// Returns whether an accepted candidate is among them.
    pub(super) fn has_accepted(&self) -> bool {
        self.candidates.iter().any(|candidate| candidate.accepted)
    }

    /// Adds the name of a method that ran, once.
    pub(super) fn uses(&mut self, name: &str) {
        if !self.used.iter().any(|used| used == name) {
            self.used.push(name.into());
        }
    }

    /// Adds the results of the next search.
    pub(super) fn add(&mut self, next: Found) {
        self.candidates.extend(next.candidates);
        self.evaluations += next.evaluations;
        (self.reason, self.repeats) = (next.reason, next.repeats);
        next.used.iter().for_each(|name| self.uses(name));
    }
}

/// The evaluations and the best candidates of a search between two batches.
pub(super) struct Standing<'a> {
    /// The evaluations used so far.
    pub(super) evaluations: u64,
    /// The draws so far. Draws that cannot be assembled cost no evaluation, and must not go on for ever: they count
    /// against the limit too.
    pub(super) draws: u64,
    /// The best candidate that is acceptable, or would be after its polish.
    pub(super) best: Option<&'a Candidate>,
    /// The candidate whose error is reported while there is no best one.
    pub(super) nearest: Option<&'a Candidate>,
    /// The repeated hits of the best candidate.
    pub(super) hits: Option<HitsSoFar>,
    /// Whether the evaluations left do not suffice for another part of a batch, and there is a best candidate.
    pub(super) is_cut: bool,
}

/// A search in batches: its state between two batches, and how a batch changes it.
pub(super) trait Strategy {
    /// The results of a batch.
    type Batch;
    /// The name of its phase in the progress.
    const PHASE: &'static str;

    /// Puts its state into a checkpoint.
    fn save(&self, state: &mut SearchState);

    /// Returns what it has found so far.
    fn standing(&self) -> Standing<'_>;

    /// Runs the next batch with at most `left` evaluations. Also returns whether every part of it stayed well below its
    /// allowance ([`spared`]).
    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool);

    /// Reads the results of a batch.
    fn read(&mut self, context: Context<'_>, batch: Self::Batch);

    /// Returns whether the stopping rule is met after a batch, and counts the batch for it.
    fn is_done(&mut self, context: Context<'_>) -> bool;
}

/// Runs batches of a search from its present state until it ends, and returns the reason why it ended.
pub(super) fn drive<S: Strategy>(context: Context<'_>, allowance: Allowance, search: &mut S) -> Reason {
    let Allowance { limit, patience } = allowance;
    let keep = |stopped: bool, search: &S| {
        if let Some(keeper) = context.keeper {
            keeper.keep(stopped, |state| search.save(state));
        }
    };
    // No part of a batch so far came near its allowance of evaluations.
    let mut ample = true;
    loop {
        let stop = context.stop_reason();
        if ample {
            keep(stop.is_some(), search);
        }
        if let Some(reason) = stop {
            return reason;
        }
        let (batch, is_ample) = search.run(context, limit.saturating_sub(search.standing().evaluations));
        let stop = context.stop_reason();
        if stop.is_some() && ample {
            keep(true, search);
        }
        ample &= is_ample;
        search.read(context, batch);
        // A batch that was cut short does not count for convergence, and must not pass for a whole one.
        if let Some(reason) = stop {
            return reason;
        }
        let Standing { evaluations: used, draws, best, nearest, hits, is_cut } = search.standing();
        (context.observer)(&Progress {
            best_sum_sq: best.or(nearest).map(|c| c.error.sum_sq),
            accepted: best.is_some_and(|b| b.accepted),
            hits,
            ..Progress::of(S::PHASE, used, limit)
        });
        let (is_none, is_exact) = (best.is_none(), best.is_some_and(|best| is_exact(context.problem, best)));
        if search.is_done(context) {
            return if is_exact { Reason::TargetReached } else { Reason::Converged };
        }
        if is_cut {
            return Reason::EvaluationLimit;
        }
        let spent = used.max(draws);
        if spent >= limit || (spent >= patience && is_none) {
            return if used < patience { Reason::Stalled } else { Reason::EvaluationLimit };
        }
    }
}

/// Returns part `index` of the evaluations left, shared evenly, so that the budget is never exceeded whatever the parts
/// need.
fn share(left: u64, parts: u64, index: u64) -> u64 {
    left / parts + u64::from(index < left % parts)
}

/// Runs `parts` parts of a batch in parallel, each with its index and its share of the evaluations left, and returns
/// their results in order, and whether all of them stayed well below their shares; `spent` returns the evaluations of a
/// part.
pub(super) fn in_parallel<T: Send>(
    (left, parts): (u64, u64),
    run: impl Fn(u64, u64) -> T + Sync,
    spent: impl Fn(&T) -> u64,
) -> (Vec<T>, bool) {
    let done: Vec<T> = (0..parts).into_par_iter().map(|i| run(i, share(left, parts, i))).collect();
    let ample = (0..).zip(&done).all(|(i, part)| spared(spent(part), share(left, parts, i)));
    (done, ample)
}

/// Returns whether the budget did not limit a part of a search so far: an eighth of the evaluations allowed, and enough
/// for steps that look a few evaluations ahead, was left.
pub(super) fn spared(used: u64, allowed: u64) -> bool {
    allowed >= 1000 && used <= allowed - allowed / 8
}

/// Counts the distinct candidates known, and the batches in a row without a new one (`quiet`). Returns whether there
/// are as many as the `wanted` ones, or `most` batches have brought no further one.
pub(super) fn are_enough(
    context: Context<'_>,
    candidates: &[Candidate],
    wanted: usize,
    (known, quiet): (&mut usize, &mut u64),
    most: u64,
) -> bool {
    let distinct = if wanted == 1 { 1 } else { count_distinct(context.problem, candidates, wanted) };
    *quiet = if distinct > *known { 0 } else { *quiet + 1 };
    *known = distinct;
    distinct >= wanted || *quiet >= most
}
