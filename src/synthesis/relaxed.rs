//! Search with one requirement left out, whose results are then fitted under all requirements.
//!
//! A search under all requirements follows their active limits from its first step, and can end on one of them although
//! a design that keeps all of them lies near an optimum of the problem without it. If a search has ended with nothing
//! acceptable, each requirement on the motion or on the pivots is left out in turn, the relaxed problem is searched,
//! and the ends are fitted under all requirements. The referee judges the designs by the problem itself, not by the
//! relaxed ones.

use super::constants::relaxed::{FIT_SHARE, FITTED, JUDGED, LEAST_SEARCH};
use super::driver::Allowance;
use super::multistart::{by_merit, fit_and_judge, promise};
use super::polish::finish;
use super::{Context, local};
use crate::judge::assess::assess_again;
use crate::judge::loosen::Demand;
use crate::judge::warm::start_at;
use crate::record::{Candidate, Evaluations};
use crate::task::forms::start::Start;
use rayon::prelude::*;

/// Judges the first `JUDGED` ends of a relaxed problem by the problem itself. If none of them is acceptable, fits the
/// most promising `most` of them under all of its requirements, with at most `each` evaluations a fit.
///
/// Returns the judged candidates, and the evaluations of the fits.
pub(super) fn led_in(
    context: Context<'_>,
    ends: &[Candidate],
    (most, each): (usize, u64),
) -> (Vec<Candidate>, Evaluations) {
    let problem = context.problem;
    let ends = &ends[..ends.len().min(JUDGED)];
    let goes_on = |_: &&Candidate| !context.stopped();
    let judged = ends.par_iter().filter(goes_on).filter_map(|end| assess_again(problem, end));
    let mut found: Vec<Candidate> = judged.collect();
    let mut spent = Evaluations::default();
    if most == 0 || found.iter().any(|candidate| candidate.accepted) {
        return (found, spent);
    }
    let mut starts: Vec<(f64, Start)> = ends
        .par_iter()
        .filter(goes_on)
        .filter_map(|end| {
            let mut start = start_at(problem, end)?;
            Some((promise(problem, &mut start)?, start))
        })
        .collect();
    by_merit(&mut starts, usize::MAX);
    starts.dedup_by(|one, other| one.0 == other.0);
    let starts = starts.into_iter().take(most).map(|(_, start)| start).collect();
    fit_and_judge(context, starts, |start| finish(context, &start, each), &mut found, &mut spent);
    (found, spent)
}

/// Searches the problem without each of the requirements that are left out in turn, with at most `limit` evaluations in
/// all, and fits the ends under all requirements; it ends with the first acceptable design.
///
/// Returns the candidates judged by the problem itself, and the evaluations.
pub(super) fn search(context: Context<'_>, limit: u64) -> (Vec<Candidate>, Evaluations) {
    let problem = context.problem;
    let mut evaluations = Evaluations::default();
    let mut found = Vec::new();
    let in_turn = |demand: &Demand| match demand {
        Demand::Require(kind) => kind.definition().is_left_out_in_turn,
        Demand::Design(_) => false,
    };
    let asked: Vec<Demand> = Demand::of(problem).into_iter().filter(in_turn).collect();
    for (turn, demand) in (0..).zip(&asked) {
        let share = limit.saturating_sub(evaluations.objective) / (asked.len() as u64 - turn);
        let for_fits = share / FIT_SHARE;
        let limit = share - for_fits;
        if limit < LEAST_SEARCH || context.stopped() {
            break;
        }
        let Ok(relaxed) = problem.with(demand.dropped(problem, problem.spec().clone())) else { continue };
        let within = Context { keeper: None, ..context.of(&relaxed) };
        let ends = local::search(within, Allowance { limit, patience: limit });
        evaluations += ends.evaluations;
        let (led, spent) = led_in(context, &ends.candidates, (FITTED, for_fits / FITTED as u64));
        evaluations += spent;
        found.extend(led);
        if found.iter().any(|candidate: &Candidate| candidate.accepted) {
            break;
        }
    }
    (found, evaluations)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::problem_file;
    use crate::synthesis::Budget;
    use crate::task::Problem;
    use std::sync::atomic::AtomicBool;

    /// Returns a straight guide in a small box, with a tolerance and these lines under `[require]`.
    fn guide(require: &str) -> Problem {
        let text = format!(
            "format = 1\n[task.path]\npoints = [[0, 0], [200, 0]]\nsamples = 21\ntolerance = 0.2\n[require]\n\
             footprint_in = [-50, -150, 250, 150]\ntransmission_over = \"used\"\n{require}\n[solve]\nevaluations = 2000\n"
        );
        let file = problem_file::parse("guide.toml", &text, None, &[]).expect("a problem");
        Problem::new(file.spec).expect("a problem")
    }

    #[test]
    fn ends_of_a_relaxed_problem_are_led_to_an_acceptable_design() {
        let never = AtomicBool::new(false);
        let budget = Budget::new(&never, None);
        let (asked, relaxed) = (guide("transmission_deg_min = 55"), guide(""));
        let allowance = Allowance { limit: 6000, patience: 6000 };
        let ends = local::search(Context::new(&relaxed, &budget), allowance).candidates;
        // Ends that meet the transmission angle already are left out: the fits have to do it.
        let beyond = |end: &Candidate| {
            assess_again(&asked, end)
                .is_some_and(|c| c.requirements.iter().any(|r| r.name == "transmission_deg_min" && !r.met))
        };
        let ends: Vec<Candidate> = ends.into_iter().filter(beyond).collect();
        assert!(ends.len() >= 3, "{} ends", ends.len());
        let context = Context::new(&asked, &budget);
        let (found, Evaluations { objective: spent, .. }) = led_in(context, &ends, (FITTED, 400));
        assert!(spent > 0 && spent <= 400 * FITTED as u64, "{spent} evaluations");
        let accepted: Vec<&Candidate> = found.iter().filter(|c| c.accepted).collect();
        assert!(!accepted.is_empty());
        // A design that is acceptable as it is needs no fit.
        let (again, spent) = led_in(context, &[accepted[0].clone()], (FITTED, 400));
        assert!(again[0].accepted && spent.objective == 0);
    }
}
