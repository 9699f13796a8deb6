//! The best candidate that can be built, where the best by error has something against it.
//!
//! First among all that was found. Where the warning is of the linkage itself (transmission angle, link ratio,
//! change point) a second search follows, of the same problem with its limits tightened to what can be built:
//! from the answers found so far, then in rounds of fresh starts, until the best has come back [`HITS`] times
//! or as much has been spent as the caller allows.

use super::Budget;
use super::multistart::{LONG_ROUNDS, LONG_STEPS, RoundOutcome, judged, polish, round};
use super::rank::{chosen, compare};
use super::starts::Starts;
use super::warm::start_at;
use super::warnings::{GREATEST_LINK_RATIO, LEAST_TRANSMISSION_DEG, is_serious, warnings};
use crate::assess::assess;
use crate::linkage::LinkageType;
use crate::problem::Problem;
use crate::problem::spec::ProblemSpec;
use crate::record::{Candidate, Evaluations};
use rayon::prelude::*;

/// The best answer of the second search has to come back from this many rounds.
pub const HITS: usize = 4;
/// .. of at least this many batches.
const LEAST_BATCHES: u64 = 2;
/// Errors that differ by less than this part are the same optimum.
const SAME_OPTIMUM: f64 = 1e-6;
/// Rounds side by side: the same number whatever the threads.
const BATCH: u64 = 8;
/// Distinct answers of the main search that the second one starts from.
const WARM: usize = 12;
/// Starts from each: as it is, and with the shortest link brought to this part of itself. On the boundary
/// between two types there is no derivative where the links align, and nothing moves from there.
const SHORTER: [f64; 2] = [1.0, 0.9];
/// Rounds of the second search draw from streams that the main search does not reach.
const FIRST_ROUND: u64 = 1 << 40;
/// The transmission angle aimed at above the least, degrees: rounding must not fall below it.
const ABOVE: f64 = 1e-6;

/// The outcome of looking for something to build.
#[derive(Clone, Debug, Default)]
pub struct Buildable {
    /// The best accepted candidate without what the first one is warned of; with its own warnings, its rank
    /// that of the equal one among the ranked, else 0.
    pub candidate: Option<Candidate>,
    /// What the second search cost.
    pub evaluations: Evaluations,
}

/// Looks for the best accepted candidate without warnings beside `ranked`, whose first has some; `others` is
/// what else was found, `allowance` the evaluations that a second search may use. Without warnings of the
/// first, or where the first is not accepted, it does nothing.
///
/// On a limit of the problem nothing is searched: a candidate that lies on none is taken where one was found.
pub fn buildable(
    problem: &Problem,
    ranked: &[Candidate],
    others: &[Candidate],
    allowance: u64,
    budget: &Budget<'_>,
) -> Buildable {
    let mut outcome = Buildable::default();
    let Some(first) = ranked.first().filter(|first| first.accepted && !first.warnings.is_empty()) else {
        return outcome;
    };
    let search = first.warnings.iter().any(is_serious);
    let mut best: Option<Candidate> = None;
    let mut offer = |candidate: &Candidate| {
        if !candidate.accepted {
            return;
        }
        let better = best.as_ref().is_none_or(|best| compare(problem, candidate, best).is_lt());
        if better {
            let list = warnings(problem, candidate);
            if !list.iter().any(|warning| is_serious(warning) || !search) {
                best = Some(Candidate { warnings: list, ..candidate.clone() });
            }
        }
    };
    ranked.iter().for_each(&mut offer);
    others.iter().for_each(&mut offer);
    if search && let Ok(tight) = Problem::new(tightened(problem.spec())) {
        let second = second_search(&tight, ranked, others, allowance, budget);
        outcome.evaluations = second.1;
        for found in second.0 {
            if let Some(candidate) = assess(problem, &found.linkage, &found.crank_deg, &found.t1_at) {
                offer(&candidate);
            }
        }
    }
    if let Some(best) = &mut best {
        let equal = |c: &&Candidate| {
            (c.linkage, &c.crank_deg, &c.t1_at) == (best.linkage, &best.crank_deg, &best.t1_at)
        };
        best.rank = ranked.iter().find(equal).map_or(0, |c| c.rank);
    }
    outcome.candidate = best;
    outcome
}

/// The problem with its limits on transmission angle and link ratio brought to what can be built. Where any type
/// will do, each of the proper ones is aimed at: the search then keeps off the boundaries between them.
fn tightened(spec: &ProblemSpec) -> ProblemSpec {
    let mut spec = spec.clone();
    let require = &mut spec.require;
    let least = LEAST_TRANSMISSION_DEG + ABOVE;
    require.transmission_deg_min = Some(require.transmission_deg_min.map_or(least, |deg| deg.max(least)));
    require.link_ratio_max = require.link_ratio_max.min(GREATEST_LINK_RATIO);
    if require.types.is_empty() {
        require.types = vec![
            LinkageType::CrankRocker,
            LinkageType::RockerCrank,
            LinkageType::DoubleCrank,
            LinkageType::DoubleRocker,
            LinkageType::TripleRocker,
        ];
    }
    spec
}

/// Accepted candidates of the tightened problem, and what they cost.
fn second_search(
    tight: &Problem,
    ranked: &[Candidate],
    others: &[Candidate],
    allowance: u64,
    budget: &Budget<'_>,
) -> (Vec<Candidate>, Evaluations) {
    let n = tight.task().len() as u64;
    let mut spent = Evaluations::default();
    let mut found: Vec<Candidate> = Vec::new();
    let known: Vec<Candidate> = ranked.iter().chain(others).cloned().collect();
    let warm = chosen(tight, &known, WARM);
    // Half of what is allowed, shared out evenly; fresh starts get the rest.
    let each = allowance / 2 / (WARM * SHORTER.len()) as u64;
    if each > 0 {
        let from: Vec<(usize, f64)> = warm.iter().flat_map(|&i| SHORTER.map(|part| (i, part))).collect();
        let fits: Vec<_> = from
            .into_par_iter()
            .map(|(i, part)| {
                let start = start_at(tight, &known[i], part)?;
                let fit = polish(tight, start, LONG_STEPS, LONG_ROUNDS, each, budget);
                Some((fit.end.and_then(|end| judged(tight, &end)), fit.evaluations))
            })
            .collect();
        for (candidate, evaluations) in fits.into_iter().flatten() {
            spent.objective += evaluations;
            spent.positions += n * evaluations;
            found.extend(candidate.filter(|c| c.accepted));
        }
    }
    let starts = Starts::new(tight);
    let best = |found: &[Candidate]| found.iter().map(|c| c.error.objective).fold(f64::INFINITY, f64::min);
    let (mut hits, mut batch, mut draws) = (0, 0, 0);
    while (hits < HITS || batch < LEAST_BATCHES)
        && spent.objective.max(draws) < allowance
        && !budget.stopped()
    {
        let left = allowance - spent.objective;
        let share = |index: u64| left / BATCH + u64::from(index % BATCH < left % BATCH);
        let rounds: Vec<RoundOutcome> = (batch * BATCH..(batch + 1) * BATCH)
            .into_par_iter()
            .map(|index| round(tight, &starts, FIRST_ROUND + index, share(index), budget))
            .collect();
        batch += 1;
        for outcome in rounds {
            spent.objective += outcome.evaluations;
            spent.positions += outcome.positions;
            draws += outcome.draws;
            let bar = best(&found);
            let good: Vec<Candidate> = outcome.found.into_iter().filter(|c| c.accepted).collect();
            let own = best(&good);
            found.extend(good);
            if own < bar * (1.0 - SAME_OPTIMUM) {
                hits = 1;
            } else if own.is_finite() && own <= bar * (1.0 + SAME_OPTIMUM) {
                hits += 1;
            }
        }
    }
    (found, spent)
}
