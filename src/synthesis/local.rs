//! The local searches by least squares, chosen by the timing.

use super::constants::plan::REDUCED_SHARE;
use super::driver::{Allowance, Found};
use super::{Context, free, rounds, timed};
use crate::record::Reason;
use crate::task::Timing;

/// A local search, and its part of the patience that is left.
struct Entry {
    /// Runs the search; `None` if it does not suit the problem.
    search: fn(Context<'_>, Allowance) -> Option<Found>,
    share: f64,
}

/// The searches for prescribed timing, in their order: the reduced form, then the physical parameters.
const PRESCRIBED: &[Entry] =
    &[Entry { search: timed::search, share: REDUCED_SHARE }, Entry { search: rounds::search, share: 1.0 }];
/// The searches for free timing.
const FREE: &[Entry] = &[Entry { search: free::search, share: 1.0 }];

/// Runs the searches that suit the problem, one after the other, until one of them ends otherwise than by giving up or
/// finds something acceptable.
pub(super) fn search(context: Context<'_>, Allowance { limit, patience }: Allowance) -> Found {
    let entries = match context.problem.task().timing() {
        Timing::Prescribed { .. } => PRESCRIBED,
        Timing::Free => FREE,
    };
    let mut found = Found::nothing();
    for entry in entries {
        let used = found.evaluations.objective;
        let limit = limit.saturating_sub(used);
        let gave_up = matches!(found.reason, Reason::EvaluationLimit | Reason::Stalled);
        if !gave_up || limit == 0 || found.has_accepted() {
            break;
        }
        let patience = (patience.saturating_sub(used).min(limit) as f64 * entry.share) as u64;
        if let Some(more) = (entry.search)(context, Allowance { limit, patience }) {
            found.add(more);
        }
    }
    found
}
