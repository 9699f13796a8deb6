//! The best buildable candidate, for a problem whose best candidate by error has warnings.
//!
//! It is first looked for among all candidates found. If the warning is of the linkage itself (transmission angle, link
//! ratio, change point), a second search follows, of the same problem with its limits tightened to those of a buildable
//! linkage: from the answers found so far, then in rounds of fresh starts, until the best has been reached [`HITS`]
//! times, [`QUIET`] rounds have brought nothing better, or the evaluations that the caller allows are used.

use super::multistart::{LONG_ROUNDS, LONG_STEPS, RoundOutcome, judged, polish, round};
use super::plan::{FAR, moved_back};
use super::starts::Starts;
use super::{Budget, Observer, Progress};
use crate::judge::costs::marginal;
use crate::judge::rank::{chosen, compare};
use crate::judge::warm::{start_at, start_beside};
use crate::judge::warnings::{GREATEST_LINK_RATIO, LEAST_TRANSMISSION_DEG, is_serious, warnings};
use crate::mechanism::{Complex, LinkageType};
use crate::record::{Candidate, Evaluations, WarningKind};
use crate::task::Problem;
use crate::task::spec::ProblemSpec;
use rayon::prelude::*;

/// Rounds that have to reach the best answer of the second search.
pub const HITS: usize = 4;
/// Rounds without a better answer after which the second search ends.
pub const QUIET: usize = 24;
/// Relative difference of errors below which they are the same optimum.
const SAME_OPTIMUM: f64 = 1e-6;
/// Rounds per parallel batch: the same number for any number of threads.
const BATCH: u64 = 8;
/// Distinct answers of the main search that the second one starts from.
const WARM: usize = 8;
/// Factors of the shortest link for the starts from each answer. On the boundary between two types, where the links
/// align, there is no derivative, and a solver does not move from there.
const SHORTER: [f64; 3] = [1.0, 0.9, 0.5];
/// The transmission angle (degrees; or the problem's limit, if that is larger) that starts with a shorter link meet
/// first, so that they approach the limit from inside.
const STRICT_DEG: f64 = 30.0;
/// Solver steps and rounds of the multipliers for that first fit.
const STRICT_STEPS: usize = 100;
const STRICT_ROUNDS: usize = 6;
/// The share of the allowed evaluations for the warm starts, and the share reserved for the move away from a change
/// point.
const WARM_SHARE: f64 = 0.5;
const LAST_SHARE: f64 = 0.1;
/// Degrees by which the limit of the transmission angle is raised in that move, and the number of bisections of the
/// least raise that suffices.
const RAISES: [f64; 5] = [1.0, 3.0, 8.0, 18.0, 35.0];
const HALVINGS: usize = 5;
/// Number of the best candidates from which that move is made, until one of them needs no move.
const MOST_FROM: usize = 3;
/// Index of the first round of the second search: its random streams are apart from those of the main search.
const FIRST_ROUND: u64 = 1 << 40;
/// Margin in degrees of the transmission angle aimed at over the least: rounding must not fall below it.
const ABOVE: f64 = 1e-6;

/// The outcome of the search for a buildable candidate.
#[derive(Clone, Debug, Default)]
pub struct Buildable {
    /// The best accepted candidate without the first one's kind of warnings; with its own warnings, and with the rank
    /// of the equal one among the ranked, else 0.
    pub candidate: Option<Candidate>,
    /// Whether a second search was needed.
    pub searched: bool,
    /// The evaluations of the second search.
    pub evaluations: Evaluations,
}

/// Looks for the best accepted candidate without warnings beside `ranked`, whose first has some; `others` are the other
/// candidates found, `allowance` the evaluations that a second search may use. Does nothing if the first has no
/// warnings or is not accepted.
///
/// If the only warning is that the first lies on a limit of the problem, nothing is searched: a candidate that lies on
/// none is taken if one was found.
pub fn buildable(
    problem: &Problem,
    ranked: &[Candidate],
    others: &[Candidate],
    allowance: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
) -> Buildable {
    let mut outcome = Buildable::default();
    let Some(first) = ranked.first().filter(|first| first.accepted && !first.warnings.is_empty()) else {
        return outcome;
    };
    let search = first.warnings.iter().any(is_serious);
    outcome.searched = search;
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
    // As in the main search, a far target is moved to the origin.
    let centre = problem.task().centre();
    let away = if centre.norm() > FAR * problem.task().size() { centre } else { Complex::new(0.0, 0.0) };
    let spec = tightened(problem.spec()).shifted([-away.re, -away.im]);
    if search
        && !budget.stopped()
        && let Ok(tight) = Problem::new(spec)
    {
        let near = |c: &Candidate| Some(Candidate { linkage: c.linkage.shifted(-away).ok()?, ..c.clone() });
        let known: Vec<Candidate> = ranked.iter().chain(others).filter_map(near).collect();
        let (found, evaluations) = second_search(&tight, &known, allowance, budget, observer);
        outcome.evaluations = evaluations;
        let back = |c: &Candidate| moved_back(problem, c, away);
        found.iter().filter_map(back).for_each(|candidate| offer(&candidate));
    }
    if let Some(best) = &mut best {
        let equal = |c: &&Candidate| {
            (c.linkage, &c.crank_deg, &c.t1_at) == (best.linkage, &best.crank_deg, &best.t1_at)
        };
        best.rank = ranked.iter().find(equal).map_or(0, |c| c.rank);
        if best.rank == 0 {
            // A ranked one has them already.
            best.costs = marginal(problem, best);
        }
    }
    outcome.candidate = best;
    outcome
}

/// Returns the problem with its limits on transmission angle and link ratio tightened to those of a buildable linkage.
/// If any type is allowed, each of the proper ones is aimed at: the search then keeps off the boundaries between them.
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

/// Returns the tightened problem with a limit of the transmission angle well above its own.
fn stricter(tight: &Problem) -> Option<Problem> {
    let mut spec = tight.spec().clone();
    let asked = spec.require.transmission_deg_min?;
    spec.require.transmission_deg_min = Some(asked.max(STRICT_DEG));
    Problem::new(spec).ok()
}

/// Returns accepted candidates of the tightened problem, and the evaluations used.
fn second_search(
    tight: &Problem,
    known: &[Candidate],
    allowance: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
) -> (Vec<Candidate>, Evaluations) {
    let n = tight.task().len() as u64;
    let mut spent = Evaluations::default();
    let mut found: Vec<Candidate> = Vec::new();
    let warm = chosen(tight, known, WARM);
    // Evaluations: first shared evenly among the warm starts, then for fresh ones, then for the move away from a change
    // point.
    let warm_share = (allowance as f64 * WARM_SHARE) as u64;
    let until = allowance - (allowance as f64 * LAST_SHARE) as u64;
    let each = warm_share / (WARM * SHORTER.len()) as u64;
    let strict = stricter(tight);
    if each > 1 {
        let from: Vec<(usize, f64)> = warm.iter().flat_map(|&i| SHORTER.map(|part| (i, part))).collect();
        let fits: Vec<_> = from
            .into_par_iter()
            .map(|(i, part)| {
                let mut start = start_beside(tight, &known[i], part)?;
                let mut evaluations = 0;
                if let Some(strict) = strict.as_ref().filter(|_| part != 1.0) {
                    let fit = polish(strict, start, STRICT_STEPS, STRICT_ROUNDS, each / 2, budget);
                    evaluations = fit.evaluations;
                    match fit.end {
                        Some(end) => start = end,
                        None => return Some((None, evaluations)),
                    }
                }
                let left = each.saturating_sub(evaluations).max(1);
                let fit = polish(tight, start, LONG_STEPS, LONG_ROUNDS, left, budget);
                Some((fit.end.and_then(|end| judged(tight, &end)), evaluations + fit.evaluations))
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
    let (mut hits, mut quiet, mut batch, mut draws) = (0, 0, 0, 0);
    let show = |found: &[Candidate], evaluations: u64| {
        let least = found.iter().map(|c| c.error.sum_sq).min_by(f64::total_cmp);
        let (best_sum_sq, accepted) = (least, least.is_some());
        observer(&Progress {
            phase: "buildable",
            evaluations,
            budget: allowance,
            best_sum_sq,
            accepted,
            hits: None,
        });
    };
    show(&found, spent.objective);
    while hits < HITS && quiet < QUIET && spent.objective.max(draws) < until && !budget.stopped() {
        let left = until - spent.objective;
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
            quiet += 1;
            if own < bar * (1.0 - SAME_OPTIMUM) {
                (hits, quiet) = (1, 0);
            } else if own.is_finite() && own <= bar * (1.0 + SAME_OPTIMUM) {
                hits += 1;
            }
        }
    }
    show(&found, spent.objective);
    let mut left = allowance.saturating_sub(spent.objective);
    let each = left / MOST_FROM as u64;
    let mut moved = Vec::new();
    for i in chosen(tight, &found, MOST_FROM) {
        if !is_near_change_point(tight, &found[i]) {
            // The candidates after it are worse.
            break;
        }
        let (candidate, evaluations) = off_the_change_point(tight, &found[i], each.min(left), budget);
        left -= evaluations.min(left);
        spent.objective += evaluations;
        spent.positions += n * evaluations;
        moved.extend(candidate);
    }
    found.extend(moved);
    (found, spent)
}

fn is_near_change_point(problem: &Problem, candidate: &Candidate) -> bool {
    warnings(problem, candidate).iter().any(|warning| warning.kind == WarningKind::ChangePoint)
}

/// Finds the nearest answer that is not almost a change point, from one that is: the Grashof margin grows with the
/// worst transmission angle, so that limit is raised until the margin suffices, and the least such limit is bisected.
fn off_the_change_point(
    tight: &Problem,
    from: &Candidate,
    allowance: u64,
    budget: &Budget<'_>,
) -> (Option<Candidate>, u64) {
    let Some(asked) = tight.spec().require.transmission_deg_min else { return (None, 0) };
    let mut spent = 0;
    let mut best: Option<Candidate> = None;
    let each = allowance / (RAISES.len() + HALVINGS) as u64;
    let mut at = |limit: f64, start: &Candidate| -> Option<Candidate> {
        let mut spec = tight.spec().clone();
        spec.require.transmission_deg_min = Some(limit);
        let raised = Problem::new(spec).ok()?;
        let start = start_at(&raised, start)?;
        let fit = polish(&raised, start, LONG_STEPS, LONG_ROUNDS, each, budget);
        spent += fit.evaluations;
        let candidate = judged(&raised, &fit.end?)?;
        (candidate.accepted && !is_near_change_point(&raised, &candidate)).then_some(candidate)
    };
    if each == 0 {
        return (None, 0);
    }
    let (mut low, mut high) = (asked, asked);
    for raise in RAISES {
        if let Some(candidate) = at(asked + raise, from) {
            (high, best) = (asked + raise, Some(candidate));
            break;
        }
        low = asked + raise;
    }
    for _ in 0..HALVINGS {
        let Some(known) = &best else { break };
        let middle = 0.5 * (low + high);
        match at(middle, known) {
            Some(candidate) => (high, best) = (middle, Some(candidate)),
            None => low = middle,
        }
    }
    (best, spent)
}
