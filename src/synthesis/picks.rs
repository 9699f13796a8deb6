//! The smallest and the best transmitting linkage whose error is nearly that of the closest candidate.
//!
//! From each of the best distinct candidates and their cognates the limit on the extent (or on the transmission angle)
//! is tightened step by step, and the linkage fitted again under it, for as long as the error stays within what is
//! allowed; then the step is bisected. Linkages that cannot reach the best one so far in one fit are given up. Short
//! searches anew beyond the best one then look for other basins.

use super::answers::complete;
use super::belief::SAME_OPTIMUM;
use super::constants::picks::{
    ANEW, ANSWERS, FOR_LOOSENED, FOR_TRANSMISSION, LEAST_STEP, SAME_DEG, SAME_PART, SEARCH, STARTS, STEP_DEG,
    STEP_PART, STEPS, WAVE,
};
use super::multistart::{LONG_FIT, MIDDLE_FIT};
use super::tightened::{Tightened, Tighter, fitted, searched_anew};
use super::{Context, SearchOutcome, offered_cognates};
use crate::judge::assess::assess;
use crate::judge::cognates::COGNATES;
use crate::judge::figures::extent;
use crate::judge::rank::{chosen, exact_objective};
use crate::record::{Axis, Candidate, Evaluations, Front, Picks};
use crate::task::Problem;
use crate::task::spec::{Method, Objective};
use rayon::prelude::*;

/// The picks of a search, and what they cost.
#[derive(Clone, Debug, Default)]
pub struct Picked {
    /// The picks; `None` if nothing was accepted.
    pub picks: Option<Picks>,
    /// The evaluations used. They are not those of the search, whose budget they leave alone.
    pub evaluations: Evaluations,
    /// The evaluations that are left.
    left: u64,
    /// Every accepted linkage that was met on the way, in the order in which they were found.
    pub met: Vec<Candidate>,
}

/// The error that a pick may have.
struct Allowed {
    /// The greatest objective; infinite where the tolerance of the problem is the limit.
    objective: f64,
    /// The weighted sum of squares at which a fit may end; 0 if the objective is another.
    enough: f64,
}

impl Allowed {
    fn of(problem: &Problem, best: &Candidate) -> Allowed {
        let within = problem.spec().solve.picks_within;
        if problem.task().has_tolerances() {
            return Allowed { objective: f64::INFINITY, enough: 0.0 };
        }
        let least = best.error.objective.max(exact_objective(problem));
        match problem.spec().solve.objective {
            Objective::SumOfSquares => {
                let objective = within * within * least;
                Allowed { objective, enough: objective * (1.0 - 1e-9) }
            }
            Objective::MaxDeviation => Allowed { objective: within * least, enough: 0.0 },
        }
    }

    fn holds(&self, candidate: &Candidate) -> bool {
        candidate.accepted && candidate.error.objective <= self.objective
    }

    /// Returns the greatest error in the terms of the record: an rms error or a largest deviation.
    fn shown(&self, problem: &Problem) -> Option<f64> {
        let weight: f64 = problem.task().weights().iter().sum();
        self.objective.is_finite().then(|| match problem.spec().solve.objective {
            Objective::SumOfSquares => (self.objective / weight).sqrt(),
            Objective::MaxDeviation => self.objective,
        })
    }
}

/// A wish that a pick fulfils best: a small extent or a large transmission angle.
#[derive(Clone, Copy)]
struct Wish(Axis);

impl Wish {
    /// Returns the figure of a candidate; large is good.
    fn merit(self, problem: &Problem, candidate: &Candidate) -> f64 {
        match self.0 {
            Axis::Extent => -extent(problem, candidate).max(f64::MIN_POSITIVE).ln(),
            _ => candidate.transmission_deg.worst,
        }
    }

    /// Returns the limits under which a linkage has at least this merit.
    fn limits(self, merit: f64) -> Tighter {
        match self.0 {
            Axis::Extent => Tighter::default().with(Axis::Extent, (-merit).exp()),
            _ => Tighter::default().with(Axis::Transmission, merit.min(90.0)),
        }
    }

    /// Returns the difference of merits up to which they are the same.
    fn same(self) -> f64 {
        if self.0 == Axis::Extent { SAME_PART } else { SAME_DEG }
    }

    /// Returns the first step, in units of the merit.
    fn step(self) -> f64 {
        if self.0 == Axis::Extent { STEP_PART } else { STEP_DEG }
    }
}

/// Finds the picks of a search, if advice is asked for and its method is one that fits linkages. The linkages met on the
/// way are fitted without their limits too: if one of them is then better than the closest candidate, it becomes a
/// candidate, so that a looser problem never has a worse answer than the tighter ones that were met.
pub fn beside(context: Context<'_>, outcome: &mut SearchOutcome) -> Picked {
    let problem = context.problem;
    let solve = &problem.spec().solve;
    let fits = matches!(solve.method, Method::Auto | Method::LeastSquares);
    if !solve.advice || !fits || context.stopped() {
        return Picked::default();
    }
    let allowance = Picks::most_evaluations(outcome.evaluations.objective);
    let mut picked = picks(context, &outcome.candidates, &outcome.others, allowance);
    let mut loosened = Vec::new();
    let known: Vec<Candidate> = picked.picks.iter().flat_map(Picks::named).map(|(_, c)| c.clone()).collect();
    let each = picked.left / known.len().max(1) as u64;
    let fits: Vec<Tightened> =
        known.par_iter().map(|from| fitted(context, problem, from, LONG_FIT, (0.0, each))).collect();
    for fit in fits {
        picked.left -= fit.evaluations.min(picked.left);
        loosened.extend(fit.candidate.filter(|c| c.accepted));
    }
    let bar = outcome.candidates.first().map_or(f64::INFINITY, |best| best.error.objective);
    let least = bar - (SAME_OPTIMUM * bar).max(exact_objective(problem));
    if loosened.iter().any(|c| c.error.objective < least) {
        outcome.choose_anew(context, Vec::new(), loosened);
        offered_cognates::offer(context, &mut outcome.candidates);
        let again = picks(context, &outcome.candidates, &outcome.others, picked.left);
        (picked.picks, picked.left) = (again.picks, again.left);
        picked.met.extend(again.met);
    }
    let spent = allowance - picked.left;
    picked.evaluations = context.cost(spent);
    if let Some(picks) = &mut picked.picks {
        picks.evaluations = spent;
    }
    outcome.reason = context.stop_reason().unwrap_or(outcome.reason);
    picked
}

/// Takes linkages of a front as picks if they are better than those found; `closest` is the closest candidate.
pub fn take_better(problem: &Problem, closest: &Candidate, picks: &mut Picks, front: &Front) {
    let allowed = Allowed::of(problem, closest);
    let wishes = [(Axis::Extent, &mut picks.smallest), (Axis::Transmission, &mut picks.best_transmission)];
    for (axis, pick) in wishes {
        let (wish, Some(pick)) = (Wish(axis), pick) else { continue };
        let mut best = wish.merit(problem, pick);
        for member in front.members.iter().filter(|member| allowed.holds(&member.candidate)) {
            let merit = wish.merit(problem, &member.candidate);
            if merit > best + wish.same() {
                best = merit;
                *pick = Candidate { rank: 0, ..member.candidate.clone() };
            }
        }
    }
}

/// Finds the picks beside ranked candidates; `others` are the other candidates found. The first of `ranked` is the
/// closest. Nothing is picked if it is not accepted.
fn picks(context: Context<'_>, ranked: &[Candidate], others: &[Candidate], allowance: u64) -> Picked {
    let problem = context.problem;
    let mut picked = Picked { left: allowance, ..Picked::default() };
    let Some(best) = ranked.first().filter(|best| best.accepted) else { return picked };
    let allowed = Allowed::of(problem, best);
    let mut known: Vec<Candidate> = ranked.iter().chain(others).filter(|c| c.accepted).cloned().collect();
    let in_time = ranked.iter().filter(|_| context.budget.leaves_time_for(COGNATES * context.points()));
    known.extend(in_time.flat_map(|candidate| cognates(problem, candidate)));
    let mut pick = |wish: Wish, reserved: u64| {
        let found = along(context, &allowed, wish, &known, &mut picked, reserved);
        // Between two questions about a stop one pick is measured.
        let measured = found.filter(|_| context.budget.leaves_time_for(context.points()));
        measured.map(|candidate| completed(problem, ranked, candidate))
    };
    let smallest = pick(Wish(Axis::Extent), allowance / FOR_TRANSMISSION);
    let best_transmission = pick(Wish(Axis::Transmission), allowance / FOR_LOOSENED);
    let within = allowed.shown(problem);
    picked.picks = Some(Picks { within, evaluations: 0, smallest, best_transmission });
    picked
}

/// Returns the accepted cognates of a candidate, judged.
fn cognates(problem: &Problem, candidate: &Candidate) -> Vec<Candidate> {
    let accepted = candidate.alternatives.iter().filter(|other| other.accepted);
    accepted.filter_map(|other| assess(problem, other.linkage, &other.crank_deg, &other.t1_at)).collect()
}

/// Returns the ranked candidate that is equal to a pick, or else the pick with all that a record says of it.
fn completed(problem: &Problem, ranked: &[Candidate], mut pick: Candidate) -> Candidate {
    let equal =
        |c: &&Candidate| (c.linkage, &c.crank_deg, &c.t1_at) == (pick.linkage, &pick.crank_deg, &pick.t1_at);
    if let Some(same) = ranked.iter().find(equal) {
        return same.clone();
    }
    complete(problem, &mut pick);
    pick
}

/// Returns the best linkage for a wish within the allowed error. `reserved` evaluations are left for what follows.
fn along(
    context: Context<'_>,
    allowed: &Allowed,
    wish: Wish,
    known: &[Candidate],
    picked: &mut Picked,
    reserved: u64,
) -> Option<Candidate> {
    let problem = context.problem;
    let within: Vec<&Candidate> = known.iter().filter(|c| allowed.holds(c)).collect();
    let merits: Vec<f64> = within.iter().map(|c| wish.merit(problem, c)).collect();
    // Of equal ones the first: cognates of one linkage have the same angles but for rounding.
    let same = wish.same();
    let first = (0..within.len()).reduce(|best, i| if merits[i] > merits[best] + same { i } else { best })?;
    let mut best = (merits[first], within[first].clone());
    let mut starts: Vec<&Candidate> = vec![within[first]];
    starts.extend(chosen(problem, known, STARTS).into_iter().map(|i| &known[i]));
    for wave in starts.chunks(WAVE) {
        if context.stopped() {
            break;
        }
        let bar = best.0;
        let each = picked.left.saturating_sub(reserved) / wave.len() as u64;
        let ends: Vec<Climb> =
            wave.par_iter().map(|start| Climb::from(context, allowed, wish, start, (bar, each))).collect();
        for end in ends {
            picked.left -= end.evaluations.min(picked.left);
            picked.met.extend(end.met.iter().cloned());
            if let Some((merit, candidate)) = end.best
                && merit > best.0 + same
            {
                best = (merit, candidate);
            }
        }
    }
    // Other basins: a short search anew beyond the best one so far, for as long as that leads on.
    for _ in 0..ANEW {
        let most = picked.left.saturating_sub(reserved);
        if most < 2 * SEARCH || context.stopped() {
            break;
        }
        let limits = wish.limits(best.0 + wish.step());
        let Some((answers, evaluations)) = searched_anew(context, &limits, SEARCH, ANSWERS) else { break };
        picked.left -= evaluations.min(picked.left);
        let before = best.0;
        for start in answers.into_iter().filter(|c| c.accepted).take(ANSWERS) {
            let most = picked.left.saturating_sub(reserved);
            let end = Climb::from(context, allowed, wish, &start, (best.0, most));
            picked.left -= end.evaluations.min(picked.left);
            picked.met.extend(end.met);
            let own = allowed.holds(&start).then(|| (wish.merit(problem, &start), start));
            for found in own.into_iter().chain(end.best) {
                if found.0 > best.0 + same {
                    best = found;
                }
            }
        }
        if best.0 <= before {
            break;
        }
    }
    // The least error at that merit.
    let merit = best.0;
    if let Some(tight) = wish.limits(merit).of(problem) {
        let Tightened { candidate, evaluations } =
            fitted(context, &tight, &best.1, LONG_FIT, (0.0, picked.left));
        picked.left -= evaluations.min(picked.left);
        if let Some(candidate) = candidate.filter(|c| {
            allowed.holds(c)
                && c.error.objective < best.1.error.objective
                && wish.merit(problem, c) >= merit - 1e-6 * wish.step()
        }) {
            best.1 = candidate;
        }
    }
    picked.met.push(best.1.clone());
    Some(best.1)
}

/// The ascent from one start.
struct Climb {
    best: Option<(f64, Candidate)>,
    met: Vec<Candidate>,
    evaluations: u64,
}

impl Climb {
    /// Tightens the limit from a start that has, or should soon have, a merit above `bar`, with at most so many
    /// evaluations.
    fn from(
        context: Context<'_>,
        allowed: &Allowed,
        wish: Wish,
        start: &Candidate,
        (bar, most): (f64, u64),
    ) -> Climb {
        let problem = context.problem;
        let mut climb = Climb { best: None, met: Vec::new(), evaluations: 0 };
        let own = wish.merit(problem, start);
        let mut from = start.clone();
        let mut at = if allowed.holds(start) { own } else { f64::NEG_INFINITY };
        let mut failed = f64::INFINITY;
        let mut step = wish.step();
        for _ in 0..STEPS {
            // A start that is behind has to reach the best one in its first step.
            let aim = if at < bar { bar + LEAST_STEP * step } else { (at + step).min(0.5 * (at + failed)) };
            let highest = if wish.0 == Axis::Transmission { 90.0 } else { f64::INFINITY };
            if climb.evaluations >= most || aim >= highest || failed - at < LEAST_STEP * wish.step() {
                break;
            }
            let Some(tight) = wish.limits(aim).of(problem) else { break };
            let Tightened { candidate, evaluations } =
                fitted(context, &tight, &from, MIDDLE_FIT, (allowed.enough, most - climb.evaluations));
            climb.evaluations += evaluations;
            let reached = candidate.filter(|c| allowed.holds(c)).map(|c| (wish.merit(problem, &c), c));
            match reached {
                Some((merit, candidate)) if merit > at => {
                    (at, from) = (merit, candidate.clone());
                    climb.best = Some((merit, candidate.clone()));
                    climb.met.push(candidate);
                    step *= 1.5;
                }
                _ if at < bar => break,
                _ => {
                    failed = aim;
                    step = 0.5 * (failed - at);
                }
            }
        }
        climb
    }
}
