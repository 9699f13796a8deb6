//! The best candidate that can be built, where the best by error has something against it.
//!
//! First among all that was found. Where the warning is of the linkage itself (transmission angle, link ratio,
//! change point) a second search follows, of the same problem with its limits tightened to what can be built:
//! from the answers found so far, then in rounds of fresh starts, until the best has come back [`HITS`] times,
//! nothing better has come of [`QUIET`] rounds, or as much has been spent as the caller allows.

use super::costs::marginal;
use super::multistart::{LONG_ROUNDS, LONG_STEPS, RoundOutcome, judged, polish, round};
use super::plan::{FAR, moved_back};
use super::rank::{chosen, compare};
use super::starts::Starts;
use super::warm::{start_at, start_beside};
use super::warnings::{GREATEST_LINK_RATIO, LEAST_TRANSMISSION_DEG, is_serious, warnings};
use super::{Budget, Observer, Progress};
use crate::linkage::{Complex, LinkageType};
use crate::problem::Problem;
use crate::problem::spec::ProblemSpec;
use crate::record::{Candidate, Evaluations, WarningKind};
use rayon::prelude::*;

/// The best answer of the second search has to come back from this many rounds,
pub const HITS: usize = 4;
/// or so many rounds have to bring nothing better.
pub const QUIET: usize = 24;
/// Errors that differ by less than this part are the same optimum.
const SAME_OPTIMUM: f64 = 1e-6;
/// Rounds side by side: the same number whatever the threads.
const BATCH: u64 = 8;
/// Distinct answers of the main search that the second one starts from.
const WARM: usize = 8;
/// Starts from each, with the shortest link brought to this part of itself. On the boundary between two types
/// there is no derivative where the links align, and nothing moves from there.
const SHORTER: [f64; 3] = [1.0, 0.9, 0.5];
/// Starts with a shorter link first meet this transmission angle (degrees; where more is asked, that)
/// and approach the limit from inside.
const STRICT_DEG: f64 = 30.0;
/// Steps and rounds of the multipliers that this is given.
const STRICT_STEPS: usize = 100;
const STRICT_ROUNDS: usize = 6;
/// The part of what is allowed that the warm starts get, and the part that is kept for the way off a change
/// point.
const WARM_SHARE: f64 = 0.5;
const LAST_SHARE: f64 = 0.1;
/// Degrees by which the limit of the transmission angle is raised on that way, and how often the least raise that
/// suffices is halved then.
const RAISES: [f64; 5] = [1.0, 3.0, 8.0, 18.0, 35.0];
const HALVINGS: usize = 5;
/// So many of the best go that way, until one of them need not.
const MOST_FROM: usize = 3;
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
    /// Whether a second search was called for.
    pub searched: bool,
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
    // As the main search: a far target is searched around its own centre.
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

/// The tightened problem with a transmission angle well above its limit.
fn stricter(tight: &Problem) -> Option<Problem> {
    let mut spec = tight.spec().clone();
    let asked = spec.require.transmission_deg_min?;
    spec.require.transmission_deg_min = Some(asked.max(STRICT_DEG));
    Problem::new(spec).ok()
}

/// Accepted candidates of the tightened problem, and what they cost.
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
    // Shared out evenly among the warm starts; then fresh ones, then the way off a change point.
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
            // What comes after it is worse.
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

/// From an answer that is almost a change point the nearest that is not: the Grashof margin grows with the worst
/// transmission angle, so that limit is raised until the margin suffices, and the least such limit is bisected.
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
