//! Multistart search for the poses of a body with free timing: starts from dyads, joint Levenberg-Marquardt fits on the
//! torus with a row for the body's angle, and a stopping rule by repeated hits of the best answer.
//!
//! A round makes a linkage of every two of its dyads ([`starts`]), fits the `SHORT` most promising for a few steps and the
//! best `LONG` of them to convergence, and has the ends judged, driven from either side. Rounds run in parallel in batches
//! and are read in their order: the number of threads changes nothing but the time. The search ends when enough rounds
//! have reached the best answer (or the search has gone on for several times as long as it took to reach it) and as many
//! distinct answers as were asked for are known, or no new one has come for `quiet_batches` of them; an exact answer needs
//! no second hit. Some rounds start from known answers instead, near them or with one of their dyads ([`crossing`]); these
//! do not count as hits. Pivots that are to lie on lines have dyads of their own ([`on_lines`]). Where exact answers form a
//! family ([`super::family`]), several batches are searched and the best answers led to better transmission angles.

mod crossing;
mod on_lines;
mod starts;

use super::Context;
use super::belief::SAME_OPTIMUM;
use super::constants::motion::{
    ASTRAY, BATCH, CROSSED_EVERY, EXACT_WEIGHT, FAMILY_BATCHES, KEPT, LEADERS, LONG, NEAR, NEAR_EVERY, SHORT,
    STOPPING,
};
use super::driver::{Allowance, Found, Standing, Strategy, drive, in_parallel};
use super::family::{climb, freedom};
use super::moves::near;
use super::multistart::{LONG_FIT, RoundOutcome, SHORT_FIT, Spender, by_merit, glanced, promise};
use super::polish::promising;
use super::required::strayed;
use super::states::{RepeatedState, SearchState};
use crate::judge::assess::assess_again;
use crate::judge::rank::{exact_cost, sort};
use crate::judge::warm::start_at;
use crate::numbers::arithmetic::streams::{Stream, stream};
use crate::record::Candidate;
use crate::task::Problem;
use crate::task::forms::start::Start;
pub(super) use starts::DyadStarts;
use starts::least_sine;
pub(super) use starts::swapped;

struct Motion<'a> {
    starts: DyadStarts<'a>,
    exact: f64,
    /// The number of free parameters that are left when all targets are met.
    freedom: usize,
    at: RepeatedState,
}

/// The kind of a start of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Dyads that the poses suggest, or drawn ones; it alone counts for the stopping rule.
    Independent,
    /// Places near the best known answers.
    Near,
    /// One dyad of a known answer beside another one.
    Crossed,
}

/// Searches until the best is believed, the limit is reached, or the patience is at an end; `None` if the task is no
/// motion. Poses that have to be met exactly weigh more in the search, so that its answers are near to what the polish
/// makes of them.
pub(super) fn search(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    problem.task().body()?;
    let Some(weighted) = with_exact_ones_weighted(problem) else {
        return search_as_it_is(context, allowance);
    };
    let mut found = search_as_it_is(context.of(&weighted), allowance)?;
    found.candidates = found.candidates.iter().filter_map(|found| assess_again(problem, found)).collect();
    sort(problem, &mut found.candidates);
    Some(found)
}

/// Returns the problem with larger weights of the poses whose tolerance is zero; `None` if there are none.
fn with_exact_ones_weighted(problem: &Problem) -> Option<Problem> {
    let mut spec = problem.spec().clone();
    let tolerances = spec.task.tolerance.as_ref()?;
    if tolerances.iter().all(|tolerance| *tolerance > 0.0) {
        return None;
    }
    let weight = |tolerance: &f64| if *tolerance > 0.0 { 1.0 } else { EXACT_WEIGHT };
    let weights = tolerances.iter().map(weight).zip(problem.task().weights()).map(|(more, own)| more * own);
    spec.task.weight = Some(weights.collect());
    Problem::new(spec).ok()
}

/// Searches for the poses with the weights that they have.
fn search_as_it_is(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().motion.clone());
    let mut search = Motion {
        starts: DyadStarts::new(problem),
        exact: exact_cost(problem),
        freedom: freedom(problem),
        at: RepeatedState::of(problem, earlier),
    };
    let reason = drive(context, allowance, &mut search);
    let mut at = search.at;
    if search.freedom > 0 {
        let left = allowance.limit.saturating_sub(at.evaluations.objective);
        at.evaluations += context.cost(climb(context, &mut at.found, left));
    }
    Some(Found {
        repeats: at.repeats(),
        candidates: at.found,
        evaluations: at.evaluations,
        reason,
        used: vec![Motion::PHASE.into()],
    })
}

impl Motion<'_> {
    /// Returns what a round starts from.
    fn kind(&self, index: u64) -> Kind {
        if self.freedom > 0 || index / BATCH == 0 {
            Kind::Independent
        } else if index % NEAR_EVERY == NEAR_EVERY - 1 {
            Kind::Near
        } else if index % CROSSED_EVERY == 1 && self.starts.are_crossed() {
            Kind::Crossed
        } else {
            Kind::Independent
        }
    }

    /// Returns the best known answers, each once.
    fn leaders(&self, problem: &Problem) -> Vec<&Candidate> {
        let mut leaders: Vec<&Candidate> =
            self.at.found.iter().filter(|candidate| promising(problem, candidate)).collect();
        // Of one answer, once from either side.
        leaders.dedup_by(|one, other| {
            let (one, other) = (one.error.objective, other.error.objective);
            (one - other).abs() <= SAME_OPTIMUM * other
        });
        leaders.truncate(LEADERS);
        leaders
    }

    /// Returns starts near the best known answers.
    fn near(&self, problem: &Problem, draws: &mut Stream) -> Vec<Start> {
        let ends: Vec<Start> =
            self.leaders(problem).into_iter().filter_map(|candidate| start_at(problem, candidate)).collect();
        if ends.is_empty() {
            return Vec::new();
        }
        (0..NEAR).filter_map(|i| near(problem, &ends[i % ends.len()], draws)).collect()
    }

    /// Runs round `index` of the search with at most `allowance` evaluations.
    fn round(&self, context: Context<'_>, index: u64, allowance: u64) -> RoundOutcome {
        let problem = context.problem;
        let mut spender = Spender::new(context, allowance);
        let mut outcome = RoundOutcome::default();
        let mut draws = stream(problem.spec().solve.seed, index);
        let dyads = |draws: &mut Stream| self.starts.dyads(index == 0, draws);
        let mut screened: Vec<(f64, Start)> = Vec::new();
        let starts = match self.kind(index) {
            Kind::Independent if self.starts.are_on_lines() => self.starts.on_lines(index == 0, &mut draws),
            Kind::Independent => self.starts.pairs(&dyads(&mut draws)),
            Kind::Near => self.near(problem, &mut draws),
            Kind::Crossed => self.starts.crossed(&self.leaders(problem), &mut draws),
        };
        for mut start in starts {
            if spender.is_at_its_end() {
                break;
            }
            outcome.draws += 1;
            spender.spend(problem, 1);
            let promise = promise(problem, &mut start).map(|promise| {
                // Exact starts are compared by how they transmit.
                let is_exact = self.freedom > 0 && promise <= self.exact;
                if is_exact { -1.0 - least_sine(problem, &start) } else { promise }
            });
            screened.extend(promise.map(|promise| (promise, start)));
        }
        // A round without a start counts as one draw, so that the search comes to its end.
        outcome.draws = outcome.draws.max(1);
        by_merit(&mut screened, SHORT);
        let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(SHORT);
        for (_, start) in screened {
            fitted.extend(spender.fit(problem, start, SHORT_FIT, u64::MAX));
        }
        // Exact ends are different answers, of which the best transmitting is wanted.
        by_merit(&mut fitted, SHORT);
        let exact = fitted.iter().take_while(|(merit, _)| *merit <= self.exact).count();
        if exact == 0 {
            fitted = on_course(problem, fitted);
        } else {
            fitted.truncate(LONG.max(exact));
        }
        let judging = context.judging();
        for (_, start) in fitted {
            let Some((_, end)) = spender.fit_as_required(problem, start, LONG_FIT) else { continue };
            if !judging.may_go_on() {
                break;
            }
            let driven_otherwise = swapped(problem, &end).and_then(|end| glanced(problem, &end));
            let both = glanced(problem, &end).into_iter().chain(driven_otherwise);
            let accepted = |candidate: &Candidate| candidate.accepted;
            let both: Vec<Candidate> = both.collect();
            let any = both.iter().any(accepted);
            outcome.found.extend(both.into_iter().filter(|candidate| !any || accepted(candidate)));
        }
        outcome.evaluations = spender.cost;
        outcome
    }
}

/// Returns the `LONG` best short ends whose points lie on circuits and branches that may go together, driven from whichever
/// side they do, and of those that are better but have strayed from either side the best `ASTRAY`.
///
/// The least errors of all are often those of ends that have strayed and that the referee refuses.
fn on_course(problem: &Problem, fitted: Vec<(f64, Start)>) -> Vec<(f64, Start)> {
    let (mut kept, mut astray) = (Vec::with_capacity(LONG + ASTRAY), Vec::new());
    for (merit, start) in fitted {
        if !strayed(problem, &start) {
            kept.push((merit, start));
        } else if let Some(other) = swapped(problem, &start).filter(|other| !strayed(problem, other)) {
            kept.push((merit, other));
        } else {
            astray.push((merit, start));
        }
    }
    kept.truncate(LONG);
    let bar = kept.first().map_or(f64::INFINITY, |(merit, _)| *merit);
    astray.retain(|(merit, _)| *merit < bar);
    astray.truncate(if kept.is_empty() { LONG } else { ASTRAY });
    kept.extend(astray);
    kept
}

impl Strategy for Motion<'_> {
    type Batch = Vec<RoundOutcome>;
    const PHASE: &'static str = "least-squares";

    fn save(&self, state: &mut SearchState) {
        state.motion = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        self.at.standing(STOPPING.hits)
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let run = |i, allowance| self.round(context, self.at.batch * BATCH + i, allowance);
        in_parallel((left, BATCH), run, |round| round.evaluations.objective)
    }

    fn read(&mut self, context: Context<'_>, batch: Self::Batch) {
        let first = self.at.batch * BATCH;
        self.at.batch += 1;
        for (index, outcome) in (first..).zip(batch) {
            let independent = self.kind(index) == Kind::Independent;
            self.at.draws += outcome.draws;
            self.at.evaluations += outcome.evaluations;
            for candidate in outcome.found {
                self.at.take(context.problem, &candidate, independent);
                self.at.found.push(candidate);
            }
            if independent {
                self.at.independent += 1;
                self.at.belief.end_batch();
            }
        }
        sort(context.problem, &mut self.at.found);
        self.at.found.truncate(KEPT);
    }

    fn is_done(&mut self, context: Context<'_>) -> bool {
        if self.freedom > 0 && self.at.is_exact(context.problem) && self.at.batch < FAMILY_BATCHES {
            return false;
        }
        self.at.is_done(context, context.problem.spec().solve.candidates, &STOPPING)
    }
}
