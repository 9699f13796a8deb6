//! Verification of a record's statements about its search. Only the search itself could find them again, so they are
//! held to limits.

use super::Comparison;
use crate::judge::rank::holds_an_exact;
use crate::record::{Picks, RELAXED, Reason, Record};
use crate::task::Problem;
use crate::task::spec::Method;

/// Entries of `method.used` that no search writes: of a linkage that was snapped, or followed by hand.
const SNAPPED: &str = "snap ";
const BY_HAND: &str = "following-the-hand";
const CONTINUATION: &str = "continuation";
const REDUCED: &str = "variable-projection";
const LEAST_SQUARES: &str = "least-squares";

impl Comparison<'_> {
    /// Checks the methods, evaluations, the reason of the end and the counts of repeated hits.
    pub(super) fn search(&mut self, record: &Record) {
        self.termination(record);
        let used: Vec<&str> = record.method.used.iter().map(String::as_str).collect();
        if !can_have_run(self.problem, record, &used) {
            let asked = record.method.asked.name();
            let found = format!("none of the lists that the method {asked} runs here");
            self.differ("method.used", used.join(", "), found);
        }
        // Snapping lists as many candidates, and spends as many evaluations, as its own request asks for.
        let snapped = used.iter().any(|name| name.starts_with(SNAPPED));
        if !snapped {
            self.evaluations(record);
        }
        if let Some(repeats) = &record.repeats {
            self.alike("repeats", repeats, &repeats.recomputed());
            self.same("repeats: counts that can be", true, repeats.is_possible());
        }
        let (listed, asked) = (record.candidates.len(), self.problem.spec().solve.candidates);
        if listed > asked && !snapped {
            let found = format!("at most the {asked} that were asked for");
            self.differ("candidates", format!("{listed} of them"), found);
        }
    }

    fn termination(&mut self, record: &Record) {
        let end = &record.termination;
        self.same("termination.reproducible", end.reproducible, end.reason.is_repeatable());
        if end.reason == Reason::TargetReached && !holds_an_exact(self.problem, &record.candidates) {
            let found = "not that: no accepted candidate is exact";
            self.differ("termination.reason", "target-reached", found);
        }
        if end.reason == Reason::TimeLimit && self.problem.spec().solve.time_limit_s.is_none() {
            self.differ("termination.reason", "time-limit", "not that: the problem has none");
        }
    }

    /// Checks that the budget holds, beside which the picks and the front have budgets of their own, and that each
    /// evaluation computes at least one position.
    fn evaluations(&mut self, record: &Record) {
        let spent = record.evaluations;
        let budget = record.problem.resolved.solve.evaluations;
        let for_picks = record.picks.as_ref().map_or(0, |picks| picks.evaluations);
        let most = Picks::most_evaluations(budget);
        if for_picks > most {
            let found = format!("at most {most} beside a budget of {budget}");
            self.differ("picks.evaluations", for_picks, found);
        }
        let for_front = record.front.as_ref().map_or(0, |front| front.evaluations);
        if spent.objective > budget.saturating_add(for_picks).saturating_add(for_front) {
            let most = match for_picks.saturating_add(for_front) {
                0 => format!("at most {budget}, the budget"),
                beside => format!("at most {budget}, the budget, and {beside} for picks and front"),
            };
            self.differ("evaluations.objective", spent.objective, most);
        }
        if spent.positions < spent.objective {
            let least = format!("at least {}, one for each evaluation", spent.objective);
            self.differ("evaluations.positions", spent.positions, least);
        }
    }
}

/// Returns whether a method can have run these, in this order.
fn can_have_run(problem: &Problem, record: &Record, used: &[&str]) -> bool {
    if let [only] = used
        && (only.starts_with(SNAPPED) || *only == BY_HAND)
    {
        return true;
    }
    let (local, exact) = match used {
        [CONTINUATION, rest @ ..] => (rest, true),
        all => (all, false),
    };
    if exact != record.exact.is_some() {
        return false;
    }
    let genetic = Method::Genetic.name();
    let evolution = Method::DifferentialEvolution.name();
    match (record.method.asked, local) {
        (Method::Auto | Method::Continuation, []) => exact,
        (Method::Genetic, local) => local == [genetic],
        (Method::DifferentialEvolution, local) => local == [evolution],
        (method, local) => {
            let combines = method != Method::LeastSquares;
            // Differential evolution and searches without a requirement follow in either order, each at most once.
            let mut local = local;
            let mut later = Vec::new();
            while let [rest @ .., last] = local
                && combines
                && (*last == evolution || *last == RELAXED)
                && !later.contains(last)
            {
                later.push(*last);
                local = rest;
            }
            let timed = problem.spec().task.timing.is_some();
            local == [LEAST_SQUARES] || timed && (local == [REDUCED] || local == [REDUCED, LEAST_SQUARES])
        }
    }
}
