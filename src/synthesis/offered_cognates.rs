//! The offer of cognates beside the candidates of a search.

use super::Context;
use crate::judge::assess::assess_again;
use crate::judge::cognates::{At, COGNATES, Merit, alternative, cognates, first_apart, has_error_of};
use crate::judge::rank::sort;
use crate::record::Candidate;
use rayon::prelude::*;

/// Adds to each candidate its cognates as alternatives; if a cognate is the better linkage (accepted, or of a better
/// worst transmission angle, or smaller) the two change places. Ranks are given anew.
///
/// Once the budget has stopped, candidates that would take long to judge stay without alternatives.
pub fn offer(context: Context<'_>, candidates: &mut Vec<Candidate>) {
    let problem = context.problem;
    let points = COGNATES * context.points() * candidates.len();
    candidates.par_iter_mut().filter(|_| context.budget.leaves_time_for(points)).for_each(|candidate| {
        let mut forms = cognates(problem, candidate);
        forms.insert(0, candidate.clone());
        // Equal ones keep their order: the candidate that was found comes first.
        forms.sort_by_cached_key(Merit::of);
        let first = forms.remove(0);
        if first.linkage != candidate.linkage {
            // The cognate takes the place, with its own figures.
            match assess_again(problem, &first) {
                Some(judged) => *candidate = judged,
                None => return,
            }
        }
        // Near a change point far from the origin a cognate's own rounding can move its curve: such a cognate is not
        // offered. Besides, after the two have changed places their errors need not be equal.
        let size = problem.task().size();
        forms.retain(|form| {
            let one: At<'_> = (&candidate.linkage, &candidate.crank_deg, &candidate.t1_at);
            let other: At<'_> = (&form.linkage, &form.crank_deg, &form.t1_at);
            first_apart(size, one, other).is_none()
                && has_error_of(problem, candidate, (&form.linkage, form.error.sum_sq), 1.0)
        });
        candidate.alternatives = forms.iter().map(alternative).collect();
    });
    if candidates.iter().any(|candidate| candidate.accepted) {
        candidates.retain(|candidate| candidate.accepted);
    }
    sort(problem, candidates);
    for (rank, candidate) in (1..).zip(candidates.iter_mut()) {
        candidate.rank = rank;
    }
}
