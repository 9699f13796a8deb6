//! The local searches by least squares, chosen by the task.

use super::constants::plan::REDUCED_SHARE;
use super::driver::{Allowance, Found};
use super::{Context, free, motion, rounds, variable_projection};
use crate::record::Reason;
use crate::task::Timing;

/// A local search: `None` if it does not suit the problem.
type Search = fn(Context<'_>, Allowance) -> Option<Found>;

/// Runs the searches that suit the problem, one after the other, until one of them ends otherwise than by giving up or
/// finds something acceptable.
pub(super) fn search(context: Context<'_>, Allowance { limit, patience }: Allowance) -> Found {
    // Each with its part of the patience that is left.
    let task = context.problem.task();
    let searches: &[(Search, f64)] = match task.timing() {
        Timing::Prescribed { .. } if task.is_function() || task.is_partly_timed() => &[(rounds::search, 1.0)],
        Timing::Prescribed { .. } => &[(variable_projection::search, REDUCED_SHARE), (rounds::search, 1.0)],
        Timing::Free if task.body().is_some() => &[(motion::search, 1.0)],
        Timing::Free => &[(free::search, 1.0)],
    };
    let mut found = Found::nothing();
    for (search, share) in searches {
        let used = found.evaluations.objective;
        let limit = limit.saturating_sub(used);
        let gave_up = matches!(found.reason, Reason::EvaluationLimit | Reason::Stalled);
        if !gave_up || limit == 0 || found.has_accepted() {
            break;
        }
        let patience = (patience.saturating_sub(used).min(limit) as f64 * share) as u64;
        if let Some(more) = search(context, Allowance { limit, patience }) {
            found.add(more);
        }
    }
    found
}
