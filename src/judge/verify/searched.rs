//! Verification of a record's statements about its search. Only the search itself could find them again, so they are
//! held to limits.

use crate::judge::rank::holds_an_exact;
use crate::record::RELAXED;
use crate::record::{Reason, Record};
use crate::task::Problem;
use crate::task::spec::Method;

/// Entries of `method.used` that no search writes: of a linkage that was snapped, or followed by hand.
const SNAPPED: &str = "snap ";
const BY_HAND: &str = "following-the-hand";
const CONTINUATION: &str = "continuation";
const REDUCED: &str = "variable-projection";
const LEAST_SQUARES: &str = "least-squares";

/// Checks the methods, evaluations, the reason of the end and the counts of repeated hits.
pub(super) fn searched(problem: &Problem, record: &Record, whole: &mut dyn FnMut(&str, String, String)) {
    termination(problem, record, whole);
    let used: Vec<&str> = record.method.used.iter().map(String::as_str).collect();
    if !can_have_run(problem, record, &used) {
        let asked = record.method.asked.name();
        whole("method.used", used.join(", "), format!("none of the lists that the method {asked} runs here"));
    }
    evaluations(record, &used, whole);
    if let Some(repeats) = &record.repeats {
        whole("repeats", format!("{repeats:?}"), format!("{:?}", repeats.recomputed()));
        whole("repeats: counts that can be", "true".into(), repeats.is_possible().to_string());
    }
    let (listed, asked) = (record.candidates.len(), problem.spec().solve.candidates);
    // Snapping lists as many candidates as its own request asks for.
    let snapped = used.iter().any(|name| name.starts_with(SNAPPED));
    if listed > asked && !snapped {
        whole("candidates", format!("{listed} of them"), format!("at most the {asked} that were asked for"));
    }
}

fn termination(problem: &Problem, record: &Record, whole: &mut dyn FnMut(&str, String, String)) {
    let end = &record.termination;
    let repeatable = end.reason.is_repeatable();
    whole("termination.reproducible", end.reproducible.to_string(), repeatable.to_string());
    if end.reason == Reason::TargetReached && !holds_an_exact(problem, &record.candidates) {
        whole(
            "termination.reason",
            "target-reached".into(),
            "not that: no accepted candidate is exact".into(),
        );
    }
    if end.reason == Reason::TimeLimit && problem.spec().solve.time_limit_s.is_none() {
        whole("termination.reason", "time-limit".into(), "not that: the problem has none".into());
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
            let timed = problem.spec().task.path.timing.is_some();
            local == [LEAST_SQUARES] || timed && (local == [REDUCED] || local == [REDUCED, LEAST_SQUARES])
        }
    }
}

/// Checks that the budget holds, and that each evaluation computes at least one position.
fn evaluations(record: &Record, used: &[&str], whole: &mut dyn FnMut(&str, String, String)) {
    let spent = record.evaluations;
    if used.iter().any(|name| name.starts_with(SNAPPED)) {
        return;
    }
    let budget = record.problem.resolved.solve.evaluations;
    if spent.objective > budget {
        let most = format!("at most {budget}, the budget");
        whole("evaluations.objective", spent.objective.to_string(), most);
    }
    if spent.positions < spent.objective {
        let least = format!("at least {}, one for each evaluation", spent.objective);
        whole("evaluations.positions", spent.positions.to_string(), least);
    }
}
