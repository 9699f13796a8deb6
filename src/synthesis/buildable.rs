//! The best buildable candidate, for a problem whose best candidate by error has warnings.
//!
//! It is first looked for among all candidates found. If the warning is of the linkage itself (transmission angle, link
//! ratio, change point), a second search follows, of the same problem with its limits tightened to those of a buildable
//! linkage: from the answers found so far, then in rounds of fresh starts, until the best has been reached `HITS`
//! times, `QUIET` rounds have brought nothing better, or the evaluations that the caller allows are used.
//!
//! Linkages with a slider are searched for anew under the tightened limits where the problem asks for them, and four-bars only
//! where it asks for these too. Of six-bars and eight-bars, whose plates may not stack, no second search follows: those beyond the limits of a buildable linkage
//! are fitted once more within them.
//!
//! A four-bar on the limit of its link ratio is nearly a linkage with a slider, the limit of longer and longer links. So
//! these are searched for too, and one that is nearer to the target is the buildable candidate.

use super::belief::SAME_OPTIMUM;
use super::constants::buildable::{
    BATCH, HALVINGS, HITS, LAST_SHARE, MOST_FROM, QUIET, RAISES, SHORTER, SLIDERS, STRICT_DEG, STRICT_FIT,
    WARM, WARM_SHARE,
};
use super::driver::{Allowance, Standing, Strategy, drive, in_parallel};
use super::fit_state::Fitted;
use super::multistart::{LONG_FIT, RoundOutcome, fit_and_judge, judged, polish, round};
use super::plan::Place;
use super::starts::Starts;
use super::states::SearchState;
use super::{Context, Progress, several_loops, sliders};
use crate::judge::assess::assess_again;
use crate::judge::costs::marginal;
use crate::judge::loosen::judged_under;
use crate::judge::rank::{chosen, compare};
use crate::judge::warm::{start_at, start_beside};
use crate::judge::warnings::{GREATEST_LINK_RATIO, LEAST_TRANSMISSION_DEG, is_serious, warnings};
use crate::mechanism::{LinkageKind, LinkageType};
use crate::record::{Candidate, Evaluations, WarningKind};
use crate::task::Problem;
use crate::task::requirement::RequirementKind;
use crate::task::spec::ProblemSpec;
use rayon::prelude::*;

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
/// none is taken if one was found. Where the first has several loops, those that were found beyond the tightened
/// limits are fitted once more within them.
pub fn buildable(
    context: Context<'_>,
    ranked: &[Candidate],
    others: &[Candidate],
    allowance: u64,
) -> Buildable {
    let problem = context.problem;
    let mut outcome = Buildable::default();
    let Some(first) = ranked.first().filter(|first| first.accepted && !first.warnings.is_empty()) else {
        return outcome;
    };
    let search = first.warnings.iter().any(is_serious);
    let mut best: Option<Candidate> = None;
    let mut offer = |candidate: &Candidate| {
        let better = || best.as_ref().is_none_or(|best| compare(problem, candidate, best).is_lt());
        if candidate.accepted && better() {
            let list = warnings(problem, candidate);
            if !list.iter().any(|warning| is_serious(warning) || !search) {
                best = Some(Candidate { warnings: list, ..candidate.clone() });
            }
        }
    };
    ranked.iter().chain(others).for_each(&mut offer);
    let several_loops = first.linkage.multi_loop().is_some();
    if search && several_loops && !context.stopped() {
        let known: Vec<&Candidate> = ranked.iter().chain(others).collect();
        let (found, evaluations) = refitted_known(context, &known, allowance);
        (outcome.searched, outcome.evaluations) = (true, evaluations);
        found.iter().for_each(&mut offer);
    }
    let search = search && !several_loops;
    outcome.searched |= search;
    let design = &problem.spec().design;
    let has_sliders = design.mechanism.iter().any(|kind| kind.has_slider());
    let searches_four_bars = design.searches(LinkageKind::FourBar);
    if search && has_sliders && !context.stopped() {
        let mut spec = problem.spec().clone();
        tighten(&mut spec);
        let share = if searches_four_bars { allowance / 2 } else { allowance };
        if let Ok(tight) = Problem::new(spec) {
            let (found, evaluations) = sliders::of_the_design(context.of(&tight), share);
            outcome.evaluations += evaluations;
            found.iter().filter_map(|c| assess_again(problem, c)).for_each(|candidate| offer(&candidate));
        }
    }
    let search = search && searches_four_bars;
    let place = Place::of(problem);
    let tight = Problem::new(tightened(problem.spec())).ok();
    if search
        && !context.stopped()
        && let Some((tight, image)) = tight.and_then(|tight| place.image(&tight)).zip(place.image(problem))
    {
        let until_stopped = ranked.iter().chain(others).take_while(|_| !context.stopped());
        let known: Vec<Candidate> = until_stopped.filter_map(|c| place.there(&image, c)).collect();
        let observer = |progress: &Progress| place.report(context, progress);
        let within = Context { observer: &observer, ..context.of(&tight) };
        let left = allowance.saturating_sub(outcome.evaluations.objective);
        let (found, evaluations) = second_search(within, &known, left);
        outcome.evaluations += evaluations;
        let until_stopped = found.iter().take_while(|_| !context.stopped());
        until_stopped.filter_map(|c| place.back(problem, c)).for_each(|candidate| offer(&candidate));
    }
    let left = allowance.saturating_sub(outcome.evaluations.objective);
    if lies_on_link_ratio(first) && left > 0 && !context.stopped() {
        let (found, evaluations) = sliders::beside_four_bars(context, left.min(SLIDERS));
        outcome.evaluations += evaluations;
        let better = |c: &&Candidate| c.accepted && c.error.objective < first.error.objective;
        found.iter().filter(better).for_each(&mut offer);
    }
    if let Some(best) = &mut best {
        let equal = |c: &&Candidate| {
            (c.linkage, &c.crank_deg, &c.t1_at) == (best.linkage, &best.crank_deg, &best.t1_at)
        };
        best.rank = ranked.iter().find(equal).map_or(0, |c| c.rank);
        if best.rank == 0 {
            // A ranked one has been measured already; another may have been judged at a glance.
            if context.stopped() {
                return outcome;
            }
            if let Some(judged) = judged_under(problem, best) {
                best.error = judged.error;
            }
            best.costs = marginal(problem, best);
        }
    }
    outcome.candidate = best;
    outcome
}

/// Fits those of the known six-bars and eight-bars that are beyond the limits of a buildable linkage once more within them,
/// with at most `allowance` evaluations; returns the ends, judged under the problem itself, and the evaluations used.
fn refitted_known(
    context: Context<'_>,
    known: &[&Candidate],
    allowance: u64,
) -> (Vec<Candidate>, Evaluations) {
    let mut spec = context.problem.spec().clone();
    tighten(&mut spec);
    let Ok(tight) = Problem::new(spec) else { return (Vec::new(), Evaluations::default()) };
    let is_beyond = |c: &&Candidate| {
        let limits = [WarningKind::TransmissionAngle, WarningKind::LinkRatio];
        warnings(context.problem, c).iter().any(|warning| limits.contains(&warning.kind))
    };
    let known: Vec<&Candidate> = known.iter().copied().filter(is_beyond).collect();
    let each = allowance / known.len().max(1) as u64;
    let fits: Vec<(Option<Candidate>, u64)> =
        known.par_iter().map(|c| several_loops::refitted(context.of(&tight), c, each)).collect();
    let used = fits.iter().map(|(_, used)| used).sum();
    let found = fits.into_iter().filter_map(|(found, _)| assess_again(context.problem, &found?)).collect();
    (found, context.cost(used))
}

/// Returns whether a candidate lies on the limit of its link ratio: links that long want to be a slider.
fn lies_on_link_ratio(candidate: &Candidate) -> bool {
    candidate.warnings.iter().any(|warning| warning.key == RequirementKind::LinkRatio.name())
}

/// Returns the problem with its limits on transmission angle and link ratio tightened to those of a buildable linkage.
/// If any type is allowed, each of the proper ones is aimed at: the search then keeps off the boundaries between them.
fn tightened(spec: &ProblemSpec) -> ProblemSpec {
    let mut spec = spec.clone();
    tighten(&mut spec);
    if spec.require.types.is_empty() {
        let proper = LinkageType::ALL.into_iter().filter(|kind| *kind != LinkageType::ChangePoint);
        spec.require.types.extend(proper);
    }
    spec
}

/// Tightens the limits on transmission angle and link ratio to those of a buildable linkage.
fn tighten(spec: &mut ProblemSpec) {
    let require = &mut spec.require;
    let least = LEAST_TRANSMISSION_DEG + ABOVE;
    require.transmission_deg_min = Some(require.transmission_deg_min.map_or(least, |deg| deg.max(least)));
    require.link_ratio_max = require.link_ratio_max.min(GREATEST_LINK_RATIO);
}

/// Returns the problem with another limit of the transmission angle.
fn with_transmission(problem: &Problem, least_deg: f64) -> Option<Problem> {
    let mut spec = problem.spec().clone();
    spec.require.transmission_deg_min = Some(least_deg);
    Problem::new(spec).ok()
}

/// The second search: accepted candidates of the tightened problem, and the evaluations used.
struct Second<'a> {
    starts: Starts<'a>,
    found: Vec<Candidate>,
    spent: Evaluations,
    hits: usize,
    quiet: usize,
    batch: u64,
    draws: u64,
}

/// Returns accepted candidates of the tightened problem, and the evaluations used.
fn second_search(context: Context<'_>, known: &[Candidate], allowance: u64) -> (Vec<Candidate>, Evaluations) {
    let tight = context.problem;
    // Evaluations: first shared evenly among the warm starts, then for fresh ones, then for the move away from a change
    // point.
    let until = allowance - (allowance as f64 * LAST_SHARE) as u64;
    let (found, spent) = from_the_known(context, known, (allowance as f64 * WARM_SHARE) as u64);
    let mut search =
        Second { starts: Starts::new(tight), found, spent, hits: 0, quiet: 0, batch: 0, draws: 0 };
    search.show(context, allowance);
    if search.spent.objective < until {
        // It ends by its own rule or the budget; the caller asks the budget for the reason.
        drive(context.silent(), Allowance { limit: until, patience: u64::MAX }, &mut search);
    }
    search.show(context, allowance);
    let Second { mut found, mut spent, .. } = search;
    let mut left = allowance.saturating_sub(spent.objective);
    let each = left / MOST_FROM as u64;
    let mut moved = Vec::new();
    for i in chosen(tight, &found, MOST_FROM) {
        if !is_near_change_point(tight, &found[i]) {
            // The candidates after it are worse.
            break;
        }
        let (candidate, evaluations) = off_the_change_point(context, &found[i], each.min(left));
        left -= evaluations.min(left);
        spent += context.cost(evaluations);
        moved.extend(candidate);
    }
    found.extend(moved);
    (found, spent)
}

/// Fits from the best known answers under the tightened limits, with at most `share` evaluations. Returns the accepted
/// candidates and the evaluations used.
fn from_the_known(context: Context<'_>, known: &[Candidate], share: u64) -> (Vec<Candidate>, Evaluations) {
    let tight = context.problem;
    let (mut found, mut spent) = (Vec::new(), Evaluations::default());
    let warm = chosen(tight, known, WARM);
    let each = share / (WARM * SHORTER.len()) as u64;
    if each <= 1 {
        return (found, spent);
    }
    let asked = tight.spec().require.transmission_deg_min;
    let strict = asked.and_then(|asked| with_transmission(tight, asked.max(STRICT_DEG)));
    let from: Vec<(usize, f64)> = warm.iter().flat_map(|&i| SHORTER.map(|part| (i, part))).collect();
    let fit = |(i, part): (usize, f64)| {
        let Some(mut start) = start_beside(tight, &known[i], part) else { return Fitted::NONE };
        let mut evaluations = 0;
        if let Some(strict) = strict.as_ref().filter(|_| part != 1.0) {
            let fit = polish(context.of(strict), start, STRICT_FIT, each / 2);
            evaluations = fit.evaluations;
            match fit.end {
                Some(end) => start = end,
                None => return fit,
            }
        }
        let fit = polish(context, start, LONG_FIT, each.saturating_sub(evaluations).max(1));
        Fitted { evaluations: evaluations + fit.evaluations, ..fit }
    };
    fit_and_judge(context, from, fit, &mut found, &mut spent);
    found.retain(|candidate| candidate.accepted);
    (found, spent)
}

impl Second<'_> {
    fn show(&self, context: Context<'_>, allowance: u64) {
        let least = self.standing().best.map(|best| best.error.sum_sq);
        (context.observer)(&Progress {
            best_sum_sq: least,
            accepted: least.is_some(),
            ..Progress::of(Self::PHASE, self.spent.objective, allowance)
        });
    }
}

impl Strategy for Second<'_> {
    type Batch = Vec<RoundOutcome>;
    const PHASE: &'static str = "buildable";

    /// It is short, and begins anew in a resumed run.
    fn save(&self, _: &mut SearchState) {}

    fn standing(&self) -> Standing<'_> {
        let compare = |one: &&Candidate, other: &&Candidate| one.error.sum_sq.total_cmp(&other.error.sum_sq);
        Standing {
            evaluations: self.spent.objective,
            draws: self.draws,
            best: self.found.iter().min_by(compare),
            nearest: None,
            hits: None,
            is_cut: false,
        }
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let first = FIRST_ROUND + self.batch * BATCH;
        let run = |i, share| round(context, &self.starts, first + i, share);
        in_parallel((left, BATCH), run, |round| round.evaluations.objective)
    }

    fn read(&mut self, _: Context<'_>, batch: Self::Batch) {
        let best =
            |found: &[Candidate]| found.iter().map(|c| c.error.objective).fold(f64::INFINITY, f64::min);
        self.batch += 1;
        for outcome in batch {
            self.spent += outcome.evaluations;
            self.draws += outcome.draws;
            let bar = best(&self.found);
            let good: Vec<Candidate> = outcome.found.into_iter().filter(|c| c.accepted).collect();
            let own = best(&good);
            self.found.extend(good);
            self.quiet += 1;
            if own < bar * (1.0 - SAME_OPTIMUM) {
                (self.hits, self.quiet) = (1, 0);
            } else if own.is_finite() && own <= bar * (1.0 + SAME_OPTIMUM) {
                self.hits += 1;
            }
        }
    }

    fn is_done(&mut self, _: Context<'_>) -> bool {
        self.hits >= HITS || self.quiet >= QUIET
    }
}

fn is_near_change_point(problem: &Problem, candidate: &Candidate) -> bool {
    warnings(problem, candidate).iter().any(|warning| warning.kind == WarningKind::ChangePoint)
}

/// Finds the nearest answer that is not almost a change point, from one that is: the Grashof margin grows with the
/// worst transmission angle, so that limit is raised until the margin suffices, and the least such limit is bisected.
fn off_the_change_point(context: Context<'_>, from: &Candidate, allowance: u64) -> (Option<Candidate>, u64) {
    let tight = context.problem;
    let Some(asked) = tight.spec().require.transmission_deg_min else { return (None, 0) };
    let mut spent = 0;
    let mut best: Option<Candidate> = None;
    let each = allowance / (RAISES.len() + HALVINGS) as u64;
    let mut at = |limit: f64, start: &Candidate| -> Option<Candidate> {
        let raised = with_transmission(tight, limit)?;
        let start = start_at(&raised, start)?;
        let fit = polish(context.of(&raised), start, LONG_FIT, each);
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
