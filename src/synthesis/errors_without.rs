//! The error that is left without each requirement that is active at the best candidate.

use super::constants::errors_without::{SHORT_SEARCH, SHORT_SHARE};
use super::multistart::{LONG_FIT, judged, polish};
use super::{Context, SearchOutcome, plan};
use crate::judge::costs::{marginal, weighted_rms};
use crate::judge::loosen::{Demand, judged_under};
use crate::judge::warm::start_at;
use crate::record::Candidate;
use crate::task::Problem;
use crate::task::spec::Method;

/// Attaches the costs to every candidate of a search; to those of the first also the error that is left without each
/// requirement, as far as the budget goes. `evaluations` in the outcome are those of the search itself.
///
/// The error without a requirement is looked for by a fit from the candidate and by a short search, and only if the
/// candidate comes from a search that polishes.
pub fn attach(context: Context<'_>, outcome: &mut SearchOutcome) {
    let problem = context.problem;
    for candidate in &mut outcome.candidates {
        candidate.costs = marginal(problem, candidate);
    }
    let polishes = matches!(problem.spec().solve.method, Method::Auto | Method::LeastSquares);
    let Some(best) = outcome.candidates.first_mut().filter(|c| polishes && !c.costs.is_empty()) else {
        return;
    };
    if let Some(reason) = context.stop_reason() {
        // The errors without the limits are not computed.
        outcome.reason = reason;
        return;
    }
    let demands: Vec<Option<Demand>> = best.costs.iter().map(|cost| Demand::named(&cost.name)).collect();
    let mut distinct: Vec<Demand> = Vec::new();
    for demand in demands.iter().flatten() {
        if !distinct.contains(demand) {
            distinct.push(*demand);
        }
    }
    let share = outcome.evaluations.objective / SHORT_SHARE / (distinct.len() as u64).max(1);
    for demand in distinct {
        let without = error_without(context, best, demand, share.min(SHORT_SEARCH));
        if let Some(reason) = context.stop_reason() {
            // A result cut short by the time limit cannot be repeated.
            outcome.reason = reason;
            return;
        }
        for (cost, _) in best.costs.iter_mut().zip(&demands).filter(|(_, d)| **d == Some(demand)) {
            cost.rms_without = without;
        }
    }
}

/// Returns the least error found without a demand; `None` if nothing better than with it was found.
fn error_without(context: Context<'_>, best: &Candidate, demand: Demand, evaluations: u64) -> Option<f64> {
    let problem = context.problem;
    let mut spec = demand.dropped(problem, problem.spec().clone());
    spec.solve.candidates = 1;
    spec.solve.evaluations = evaluations.max(1);
    let loose = Problem::new(spec).ok()?;
    let context = context.of(&loose).silent();
    let warm = start_at(&loose, best)
        .and_then(|start| judged(&loose, &polish(context, start, LONG_FIT, evaluations.max(1)).end?));
    let found = plan::approximate(context).map_or(Vec::new(), |outcome| outcome.candidates);
    // A better answer that meets the demand as well does not measure its cost.
    let costs_less = |c: &Candidate| {
        c.accepted
            && c.error.objective < best.error.objective
            && judged_under(problem, c).is_none_or(|judged| !judged.accepted)
    };
    let least = warm.into_iter().chain(found).filter(costs_less).map(|c| c.error.objective);
    least.min_by(f64::total_cmp).map(|objective| weighted_rms(problem, objective))
}
