//! The plan of a search: the phases of each method, in their order.
//!
//! `least-squares` and `auto` begin with the local searches ([`local`]), each with its own rule of repeated hits. For
//! objectives and tolerances beyond least squares the answers are polished afterwards ([`super::polish`]). If still
//! nothing is acceptable, `auto` searches without one of the requirements in turn (`relaxed`), then by differential
//! evolution for a feasible design, and polishes the results. The population searches alone run without a polish.

use super::constants::plan::{FAR_OTHERS, GLIMPSE, GLIMPSE_SHARE, LOCAL_SHARE, POLISH_SHARE, RELAXED_SHARE};
use super::constants::sliders::{FIRST as SLIDERS_FIRST, GLIMPSE as SLIDERS_GLIMPSE};
use super::driver::{Allowance, Found};
use super::family::{freedom, one_is_enough};
use super::frame::{Frame, in_frame};
use super::multistart::{LONG_FIT, fit_and_judge, polish};
use super::polish::{improve, reserve};
use super::population::{self, Population};
use super::sliders::Sliders;
use super::{Context, Progress, SearchOutcome, continuation, local, relaxed, several_loops};
use crate::judge::assess::{assess, assess_again};
use crate::judge::rank::{divided, exact_cost, searched};
use crate::mechanism::{Complex, LinkageKind};
use crate::numbers::optimise::population::PopulationError;
use crate::record::{Candidate, Evaluations, RELAXED, Reason};
use crate::task::forms::start::Start;
use crate::task::spec::{Method, Objective};
use crate::task::{AngleOffset, Problem};

/// Distance of a target from the origin, in sizes of the target, beyond which it is searched around its own centre: at
/// 1e6 sizes differences of coordinates have lost six digits.
const FAR: f64 = 100.0;

/// Searches as the problem's `[solve]` table says: if there are nine precision points, `continuation` and `auto` first
/// solve for all linkages through them, and `auto` approximates if these do not give enough answers. Of linkages with a slider
/// `continuation` alone does, through eight points.
///
/// # Errors
/// [`PopulationError`] if a population search cannot be set up.
pub fn search(context: Context<'_>) -> Result<SearchOutcome, PopulationError> {
    let spec = context.problem.spec();
    if !spec.design.is_of_four_bars() && spec.solve.method != Method::Continuation {
        return approximate(context);
    }
    let Some(exact) = continuation::solve(context) else { return approximate(context) };
    if exact.suffices(context.problem) || context.stopped() {
        return Ok(exact.alone(context));
    }
    Ok(exact.beside(context, approximate(context)?))
}

/// As [`search`] without exact answers: used many times over to find conflicts and costs.
///
/// Problems of free timing are searched in their canonical frame ([`super::frame`]), others in the caller's, far targets
/// around their own centre.
///
/// # Errors
/// As [`search`].
pub fn approximate(context: Context<'_>) -> Result<SearchOutcome, PopulationError> {
    let design = &context.problem.spec().design;
    let several: Vec<LinkageKind> =
        design.mechanism.iter().copied().filter(|kind| kind.dyads().is_some()).collect();
    if several.is_empty() {
        return one_loop(context);
    }
    let simple: Vec<LinkageKind> =
        design.mechanism.iter().copied().filter(|kind| kind.dyads().is_none()).collect();
    simple_first(context, simple, &several)
}

/// Searches for linkages of one loop, then for six-bars and eight-bars, each kind with an equal share of the evaluations that are
/// left. Where a tolerance is asked for, a kind is searched for only if none before it has an accepted answer.
fn simple_first(
    context: Context<'_>,
    simple: Vec<LinkageKind>,
    several: &[LinkageKind],
) -> Result<SearchOutcome, PopulationError> {
    let problem = context.problem;
    let limit = problem.spec().solve.evaluations;
    let mut found = Found::nothing();
    if !simple.is_empty() {
        let mut spec = problem.spec().clone();
        spec.design.mechanism = simple;
        spec.solve.evaluations = (limit / (1 + several.len() as u64)).max(1);
        if let Ok(within) = problem.with(spec) {
            let one = one_loop(context.of(&within))?;
            found = Found {
                candidates: one.candidates.into_iter().chain(one.others).collect(),
                evaluations: one.evaluations,
                reason: one.reason,
                used: one.used,
                repeats: one.repeats,
            };
        }
    }
    for (i, kind) in several.iter().enumerate() {
        let left = limit.saturating_sub(found.evaluations.objective) / (several.len() - i) as u64;
        let is_enough = problem.spec().task.tolerance.is_some() && found.has_accepted();
        if is_enough || is_exact(problem, &found.candidates) || context.stopped() || left == 0 {
            break;
        }
        let best = |found: &Found| {
            let accepted = found.candidates.iter().filter(|c| c.accepted);
            accepted.map(|c| searched(problem, c)).min_by(f64::total_cmp).unwrap_or(f64::INFINITY)
        };
        let before = (best(&found), found.repeats, found.reason);
        found.add(several_loops::search_for(context, *kind, left));
        // The repeats are those of the best answer.
        if before.0 < f64::INFINITY && best(&found) >= before.0 {
            (found.repeats, found.reason) = (before.1, before.2);
        }
    }
    Ok(ranked(context, found))
}

/// Searches for linkages of one loop.
fn one_loop(context: Context<'_>) -> Result<SearchOutcome, PopulationError> {
    let design = &context.problem.spec().design;
    if design.is_of_four_bars() {
        return four_bars(context);
    }
    let limit = context.problem.spec().solve.evaluations;
    let Some(mut sliders) = Sliders::of(context, &design.mechanism) else { return four_bars(context) };
    if !design.searches(LinkageKind::FourBar) {
        let allowance = Allowance { limit, patience: limit };
        return Ok(ranked(context, sliders.search(context, allowance)));
    }
    let (exact, spent) = glimpse(context, &mut sliders)?;
    if let Some(exact) = exact {
        return Ok(exact);
    }
    // Half of the budget at most, so that the others have their turn where no four-bar is acceptable.
    let mut found = four_bars_within(context, (limit / 2).max(1))?;
    found.evaluations += spent;
    Ok(beside(context, found, sliders))
}

/// Looks for an exact answer of any kind with little effort for each, where one is enough: first a few rounds of sliders, then
/// four-bars, then more sliders. `None` if there is none. Also
/// returns the evaluations of its search for four-bars, which the one that follows repeats.
fn glimpse(
    context: Context<'_>,
    sliders: &mut Sliders<'_>,
) -> Result<(Option<SearchOutcome>, Evaluations), PopulationError> {
    let solve = &context.problem.spec().solve;
    if !one_is_enough(context.problem, freedom(context.problem))
        || solve.evaluations < GLIMPSE_SHARE * GLIMPSE
    {
        return Ok((None, Evaluations::default()));
    }
    let of_sliders = |sliders: &mut Sliders<'_>, batches: u64, spent: Evaluations| {
        let found = sliders.glimpse(context, solve.evaluations / GLIMPSE_SHARE, batches);
        found.map(|mut found| {
            found.evaluations += spent;
            ranked(context, found)
        })
    };
    if let Some(exact) = of_sliders(sliders, SLIDERS_FIRST, Evaluations::default()) {
        return Ok((Some(exact), Evaluations::default()));
    }
    // Its checkpoints would be taken for those of the whole search.
    let four_bars = four_bars_within(Context { keeper: None, ..context }, GLIMPSE)?;
    let spent = four_bars.evaluations;
    if is_exact(context.problem, &four_bars.candidates) {
        return Ok((Some(four_bars), spent));
    }
    Ok((of_sliders(sliders, SLIDERS_GLIMPSE, spent), spent))
}

/// Returns whether one of the candidates is accepted and exact.
fn is_exact(problem: &Problem, candidates: &[Candidate]) -> bool {
    candidates.iter().any(|c| c.accepted && searched(problem, c) <= exact_cost(problem))
}

/// Searches for four-bars with at most so many evaluations.
fn four_bars_within(context: Context<'_>, evaluations: u64) -> Result<SearchOutcome, PopulationError> {
    let mut spec = context.problem.spec().clone();
    spec.solve.evaluations = evaluations;
    match context.problem.with(spec) {
        Ok(within) => four_bars(context.of(&within)),
        Err(_) => four_bars(context),
    }
}

/// Searches for linkages with a slider with the evaluations that a search for four-bars has left, and ranks all together.
fn beside(context: Context<'_>, four_bars: SearchOutcome, sliders: Sliders<'_>) -> SearchOutcome {
    let problem = context.problem;
    let limit = problem.spec().solve.evaluations.saturating_sub(four_bars.evaluations.objective);
    let mut found = Found {
        candidates: four_bars.candidates.into_iter().chain(four_bars.others).collect(),
        evaluations: four_bars.evaluations,
        reason: four_bars.reason,
        used: four_bars.used,
        repeats: four_bars.repeats,
    };
    let best = |found: &Found| {
        let accepted = found.candidates.iter().filter(|c| c.accepted);
        accepted.map(|c| searched(problem, c)).min_by(f64::total_cmp).unwrap_or(f64::INFINITY)
    };
    let before = (best(&found), found.repeats, found.reason);
    let is_enough = one_is_enough(problem, freedom(problem)) && is_exact(problem, &found.candidates);
    let next = if is_enough || context.stopped() || limit == 0 {
        sliders.found(context.problem)
    } else {
        sliders.search(context, Allowance { limit, patience: limit })
    };
    found.add(next);
    // The repeats are those of the best answer.
    if best(&found) >= before.0 {
        (found.repeats, found.reason) = (before.1, before.2);
    }
    ranked(context, found)
}

/// Returns the outcome of a search with its candidates ranked and divided into those that are listed and the others.
fn ranked(context: Context<'_>, found: Found) -> SearchOutcome {
    let problem = context.problem;
    let Found { candidates, evaluations, reason, used, repeats } = found;
    let reason = context.stop_reason().unwrap_or(reason);
    let (candidates, others) = divided(problem, candidates, problem.spec().solve.candidates);
    let mut outcome = SearchOutcome { candidates, others, used, reason, evaluations, exact: None, repeats };
    outcome.choose_anew(context, Vec::new(), Vec::new());
    outcome
}

/// Searches for four-bars.
fn four_bars(context: Context<'_>) -> Result<SearchOutcome, PopulationError> {
    let problem = context.problem;
    let place = Place::of(problem);
    let near = match place {
        Place::Frame(frame) => return in_frame(context, &frame, search_here),
        Place::AsItIs => None,
        Place::Around(_) => place.image(problem),
    };
    let Some(near) = near else { return search_here(context).map(|outcome| outcome.measured(context)) };
    let mut outcome = search_here(context.of(&near))?;
    let back = |candidate: &Candidate| place.back(problem, candidate);
    // Also the next best: a linkage that only just closes there may be open here.
    let found = outcome.candidates.iter().chain(outcome.others.iter().take(FAR_OTHERS)).filter_map(back);
    let found = found.collect();
    (outcome.candidates, outcome.others) = divided(problem, found, problem.spec().solve.candidates);
    Ok(outcome)
}

/// The place in which a problem is searched.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// Its canonical frame, if the timing is free and the numbers stay within their range there.
    Frame(Frame),
    /// The caller's frame.
    AsItIs,
    /// Around the target's centre, of a far target.
    Around(Complex),
}

impl Place {
    /// Returns the place of a problem.
    pub(super) fn of(problem: &Problem) -> Place {
        let centre = problem.task().centre();
        if problem.spec().task.timing.is_none() {
            let frame = Frame::of(problem);
            if frame.exact(problem).is_some() { Place::Frame(frame) } else { Place::AsItIs }
        } else if centre.norm() > FAR * problem.task().size() {
            Place::Around(centre)
        } else {
            Place::AsItIs
        }
    }

    /// Returns the image there of a problem of this target, its numbers not rounded to a grid; `None` if it has none.
    pub(super) fn image(&self, problem: &Problem) -> Option<Problem> {
        match self {
            Place::Frame(frame) => frame.exact(problem),
            Place::AsItIs => Some(problem.clone()),
            Place::Around(centre) => Problem::new(problem.spec().shifted([-centre.re, -centre.im])).ok(),
        }
    }

    /// Returns the image there of a candidate; `image` is the image of its problem.
    pub(super) fn there(&self, image: &Problem, candidate: &Candidate) -> Option<Candidate> {
        match self {
            Place::Frame(frame) => frame.there(image, candidate),
            Place::AsItIs => Some(candidate.clone()),
            Place::Around(centre) => {
                Some(Candidate { linkage: candidate.linkage.shifted(-centre).ok()?, ..candidate.clone() })
            }
        }
    }

    /// Returns a candidate that was found there, back at the target and judged by `problem`; `None` if it does not close
    /// there.
    pub(super) fn back(&self, problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
        match self {
            Place::Frame(frame) => frame.back(problem, candidate),
            Place::AsItIs => moved_back(problem, candidate, Complex::new(0.0, 0.0)),
            Place::Around(centre) => moved_back(problem, candidate, *centre),
        }
    }

    /// Reports the progress of a search there, in the caller's units.
    pub(super) fn report(&self, context: Context<'_>, progress: &Progress) {
        match self {
            Place::Frame(frame) => frame.report(context, progress),
            _ => (context.observer)(progress),
        }
    }
}

/// Returns a candidate moved by a vector and judged there; `None` if it does not close there. Its pivots are rounded in the
/// move: angles that are counted from the ground line then count from the moved line.
fn moved_back(problem: &Problem, candidate: &Candidate, by: Complex) -> Option<Candidate> {
    let linkage = candidate.linkage.shifted(by).ok()?;
    let timing = problem.spec().task.timing.as_ref();
    match timing.filter(|timing| timing.offset == AngleOffset::Ground) {
        None => assess_again(problem, &Candidate { linkage, ..candidate.clone() }),
        Some(timing) => {
            let base = linkage.ground_angle().to_degrees();
            let crank_deg: Vec<f64> = timing.crank_deg.iter().map(|deg| base + deg).collect();
            assess(problem, linkage, &crank_deg, &candidate.t1_at)
        }
    }
}

fn search_here(context: Context<'_>) -> Result<SearchOutcome, PopulationError> {
    let problem = context.problem;
    let solve = &problem.spec().solve;
    let mut run = Run { context, limit: solve.evaluations, found: Found::nothing() };
    match solve.method {
        Method::Genetic => run.population_alone(Population::Genetic)?,
        Method::DifferentialEvolution => run.population_alone(Population::DifferentialEvolution)?,
        Method::LeastSquares => run.local(1.0),
        // Exact answers are not approximated; if the points have none, `continuation` searches as `auto`.
        Method::Auto | Method::Continuation => {
            run.local(LOCAL_SHARE);
            if run.gave_up() {
                run.relaxed();
                let populations_suit = problem.task().body().is_none() && !problem.task().is_partly_timed();
                if !run.found.has_accepted() && populations_suit {
                    run.feasible()?;
                }
            }
        }
    }
    let Found { candidates, evaluations, reason, used, repeats } = run.found;
    let (candidates, others) = divided(problem, candidates, problem.spec().solve.candidates);
    // The largest deviation is polished afterwards: its basins are others.
    let repeats = repeats.filter(|_| problem.spec().solve.objective == Objective::SumOfSquares);
    Ok(SearchOutcome { candidates, others, used, reason, evaluations, exact: None, repeats })
}

/// A plan in progress.
struct Run<'a> {
    context: Context<'a>,
    /// The budget of evaluations.
    limit: u64,
    found: Found,
}

impl Run<'_> {
    /// Returns whether the local searches ended with evaluations left and nothing acceptable. Converged without an
    /// accepted answer means a tolerance that no polish could meet.
    fn gave_up(&self) -> bool {
        let found = &self.found;
        matches!(found.reason, Reason::EvaluationLimit | Reason::Stalled | Reason::Converged)
            && found.evaluations.objective < self.limit
            && !found.has_accepted()
    }

    fn left(&self) -> u64 {
        self.limit.saturating_sub(self.found.evaluations.objective)
    }

    /// Runs the local searches; without an acceptable candidate they give up after this part of the budget.
    fn local(&mut self, share: f64) {
        let limit = self.limit - reserve(self.context.problem, self.limit);
        let patience = (self.limit as f64 * share) as u64;
        self.found = local::search(self.context, Allowance { limit, patience });
        self.finish();
    }

    /// Runs searches without one of the requirements in turn.
    fn relaxed(&mut self) {
        let (led, cost) = relaxed::search(self.context, self.left() / RELAXED_SHARE);
        if cost.objective > 0 {
            self.found.uses(RELAXED);
            self.found.evaluations += cost;
            self.found.candidates.extend(led);
            self.found.repeats = None;
            self.finish();
        }
    }

    /// Runs differential evolution for a feasible design, and polishes the best of its end.
    fn feasible(&mut self) -> Result<(), PopulationError> {
        let (context, left) = (self.context, self.left().max(1));
        let for_polish = left / POLISH_SHARE;
        let evaluations = left - for_polish - reserve(context.problem, left);
        let end = self.population(Population::DifferentialEvolution, evaluations)?;
        let each = for_polish / end.len().max(1) as u64;
        if each > 0 {
            let Found { candidates, evaluations, .. } = &mut self.found;
            let fit = |start| polish(context, start, LONG_FIT, each);
            fit_and_judge(context, end, fit, candidates, evaluations);
        }
        self.finish();
        Ok(())
    }

    /// Runs a population search without a polish.
    fn population_alone(&mut self, which: Population) -> Result<(), PopulationError> {
        self.population(which, self.limit)?;
        self.found.reason = self.context.stop_reason().unwrap_or(self.found.reason);
        Ok(())
    }

    /// Runs a population search and returns the starts for a polish.
    fn population(&mut self, which: Population, evaluations: u64) -> Result<Vec<Start>, PopulationError> {
        let (found, starts) = population::search(self.context, which, evaluations)?;
        self.found.add(found);
        Ok(starts)
    }

    /// Runs the polish that the objective and the tolerances ask for.
    fn finish(&mut self) {
        let Found { candidates, evaluations, .. } = &mut self.found;
        improve::<Start>(self.context, candidates, evaluations, self.limit);
        self.found.reason = self.context.stop_reason().unwrap_or(self.found.reason);
    }
}
