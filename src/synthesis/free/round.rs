//! One round of the search for free timing: starts, short fits, longer fits of the best, and the treatment of their
//! ends.

use super::noise::Scatter;
use super::parts::Reading;
use super::stricter::has_many_points;
use crate::judge::rank::searched;
use crate::numbers::arithmetic::streams::{stream, uniform};
use crate::record::{Candidate, Evaluations};
use crate::synthesis::Context;
use crate::synthesis::atlas::Matches;
use crate::synthesis::belief::SAME_OPTIMUM;
use crate::synthesis::coarse::Coarse;
use crate::synthesis::constants::free::{
    ALIKE_ENDS, BATCH, DENSE_BATCHES, DENSE_MIDDLE, DENSE_SHORT, DENSE_WORTH_DIGITS, DENSE_WORTH_FINISHING,
    FEW_HOP_EVERY, FEW_SCREEN, FINISHED_IN_NOISE, HOP_EVERY, IN_NOISE, JITTERED, MATCHED, MIDDLE, MIDDLE_FIT,
    REASSIGNED, SCREEN, SEVERAL_WORTH_FINISHING, SHAPE_MIDDLE, SHORT, SHORT_FIT, WORTH_DIGITS,
    WORTH_FINISHING,
};
use crate::synthesis::moves::{along_a_difference, near};
use crate::synthesis::multistart::{Effort, LONG_FIT, Spender, by_merit, promise};
use crate::synthesis::reassign::{Reassigned, reassigned};
use crate::synthesis::starts::Starts;
use crate::synthesis::states::{End, StageState};
use crate::task::Problem;
use crate::task::forms::start::Start;

/// The data that all rounds share.
pub(super) struct Setup<'a> {
    pub(super) problem: &'a Problem,
    pub(super) coarse: Option<&'a Coarse>,
    /// The stricter problem with all points, if a stricter one is explored.
    pub(super) stricter: Option<&'a Problem>,
    pub(super) starts: &'a Starts<'a>,
    /// The first index of the random streams of its rounds.
    pub(super) first_stream: u64,
    pub(super) matches: Option<Matches>,
    /// Whether one answer is wanted: the first exact one then ends the search.
    pub(super) single: bool,
    pub(super) exact: f64,
    /// The error up to which the last digits of every end are looked for.
    pub(super) nearly_exact: f64,
}

impl Setup<'_> {
    /// Returns the problem that is explored: the coarse one if there is one, else that with all points.
    fn explored(&self) -> &Problem {
        self.coarse.map_or(self.stricter.unwrap_or(self.problem), |coarse| &coarse.problem)
    }

    /// Returns whether the target is dense.
    pub(super) fn is_dense(&self) -> bool {
        Coarse::is_for(self.problem)
    }

    /// Returns the number of starts that a round draws and screens.
    fn screen(&self) -> usize {
        if has_many_points(self.problem) { SCREEN } else { FEW_SCREEN }
    }

    /// Returns the number of rounds of which the last starts near known ends.
    fn hop_every(&self) -> u64 {
        if has_many_points(self.problem) { HOP_EVERY } else { FEW_HOP_EVERY }
    }

    /// Returns whether a round of a stage starts near known ends, if there are any.
    fn hops(&self, round: u64) -> bool {
        round % self.hop_every() == self.hop_every() - 1
    }

    /// Returns whether an end with this merit on the explored points can still matter beside the best one there.
    fn is_worth_finishing(&self, merit: f64, best: f64) -> bool {
        let factor = match (self.single, self.is_dense()) {
            (true, true) => DENSE_WORTH_FINISHING,
            (true, false) => WORTH_FINISHING,
            (false, _) => SEVERAL_WORTH_FINISHING,
        };
        merit <= factor * best + self.exact
    }

    /// Returns whether the last digits of an end with this merit can matter beside the best one.
    fn is_worth_its_digits(&self, merit: f64, best: f64) -> bool {
        let factor = if self.is_dense() { DENSE_WORTH_DIGITS } else { WORTH_DIGITS };
        merit <= (factor * best).max(self.nearly_exact)
    }
}

/// The data that all rounds of a batch share.
pub(super) struct Common<'a> {
    pub(super) context: Context<'a>,
    pub(super) setup: &'a Setup<'a>,
    /// The index of its first round in its stage.
    pub(super) first_of_stage: u64,
    /// The best different ends of the batches before, near which rounds start.
    pub(super) near_ends: Vec<Start>,
    /// The error of the best answer of the batches before on all points, infinite if there is none.
    pub(super) best: f64,
    /// Whether the errors of the best answer are noise.
    pub(super) in_noise: bool,
    /// The scatter of the points about the groups' means that other stages have shown.
    pub(super) scatter: Option<Scatter>,
}

impl Common<'_> {
    /// Returns the scatter of the points about the groups' means, if groups are explored, one answer is wanted, and it is
    /// noise.
    pub(super) fn scatter(&self, stage: &StageState) -> Option<Scatter> {
        if !self.in_noise || !self.setup.single || self.setup.coarse.is_none() {
            return None;
        }
        let shown = Scatter::of(self.setup.problem, stage).into_iter().chain(self.scatter);
        shown.min_by(|one, other| one.best.total_cmp(&other.best))
    }

    /// Returns whether ends are finished after their batch, each of them once. On a sparse target of few points, or one whose
    /// best error is nearly exact, they are finished in their rounds: the first exact answer ends a batch.
    pub(super) fn finishes_apart(&self) -> bool {
        let setup = self.setup;
        let is_far = self.best.is_finite() && self.best > setup.nearly_exact;
        setup.is_dense() || (is_far && has_many_points(setup.problem))
    }

    /// Returns whether an answer of a dense target is known whose errors are not noise.
    fn misses_a_shape(&self) -> bool {
        self.setup.is_dense() && self.best.is_finite() && !self.in_noise
    }

    /// Returns whether a round of the batch is independent: it uses no results of others.
    fn is_independent(&self, round: u64) -> bool {
        self.near_ends.is_empty() || !self.setup.hops(self.first_of_stage + round)
    }
}

#[derive(Debug)]
pub(super) struct Round {
    pub(super) draws: u64,
    pub(super) cost: Evaluations,
    /// The ends on the explored points with their merits there, best first.
    pub(super) leaders: Vec<(f64, Start)>,
    /// The ends that the round finished itself.
    pub(super) finished: Vec<Finished>,
    /// Whether it is independent: it used no results of other rounds.
    pub(super) independent: bool,
}

impl Round {
    /// Returns the least merit on the explored points.
    pub(super) fn explored(&self) -> f64 {
        self.leaders.first().map_or(f64::INFINITY, |(merit, _)| *merit)
    }

    /// Returns whether it found an exact, accepted answer.
    pub(super) fn is_exact(&self) -> bool {
        self.finished.iter().any(|done| done.exact)
    }
}

/// An end on the explored points, fitted to all of them.
#[derive(Clone, Debug)]
pub(super) struct Finished {
    /// Its merit on the explored points.
    pub(super) explored: f64,
    pub(super) end: End,
    /// Whether it is an exact, accepted answer.
    pub(super) exact: bool,
}

impl Spender<'_> {
    /// Reassigns the points of an end to their best places on its curve and fits it again, as long as that gains.
    fn at_best_places(
        &mut self,
        problem: &Problem,
        (mut merit, mut end): (f64, Start),
        effort: Effort,
    ) -> (f64, Start) {
        for _ in 0..REASSIGNED {
            let Reassigned { better, positions } = reassigned(problem, &end);
            self.cost.positions += positions;
            // Counted as evaluations of as many positions, within the allowance.
            self.cost.objective += (positions / problem.task().len() as u64).min(self.left());
            let Some(start) = better else { break };
            match self.fit_as_required(problem, start, effort) {
                Some((again, start)) if again < merit => (merit, end) = (again, start),
                _ => break,
            }
        }
        (merit, end)
    }
}

/// Returns the starts of a round of the batch with their promise ([`promise`]) on the explored points, and the number
/// drawn.
fn drawn(common: &Common<'_>, round: u64, spender: &mut Spender<'_>) -> (Vec<(f64, Start)>, u64) {
    let Common { setup, near_ends, first_of_stage, .. } = common;
    let index = first_of_stage + round;
    let explored = setup.explored();
    let mut drawn: Vec<(f64, Start)> = Vec::with_capacity(setup.screen());
    let mut count = 0;
    let mut take = |spender: &mut Spender<'_>, start: Option<Start>| {
        count += 1;
        let Some(mut start) = start else { return };
        spender.spend(explored, 1);
        drawn.extend(promise(explored, &mut start).map(|promise| (promise, start)));
    };
    // An exploration draws the same whatever else is explored: a stricter one as a search of the stricter problem would.
    let turn = (index - index / setup.hop_every()) as usize;
    // Of three independent rounds two take matches, as long as there are any.
    let first = (turn - turn / 3) * MATCHED;
    let mut draws = stream(setup.problem.spec().solve.seed, setup.first_stream + index);
    if !common.is_independent(round) {
        let end = &near_ends[(index / setup.hop_every()) as usize % near_ends.len()];
        for i in 0..JITTERED {
            if spender.left() == 0 {
                break;
            }
            let mut other = || &near_ends[uniform(&mut draws, 0.0, near_ends.len() as f64) as usize];
            let (one, other) = (other(), other());
            let start = if i % 2 == 1
                && one.setting.side == other.setting.side
                && one.setting.side == end.setting.side
            {
                along_a_difference(explored, [end, one, other], &mut draws)
            } else {
                near(explored, end, &mut draws)
            };
            take(spender, start);
        }
    } else {
        let matched = !setup.hops(index) && turn % 3 < 2;
        match setup.matches.as_ref().filter(|matches| matched && first < matches.len()) {
            Some(matches) => {
                for rank in first..(first + MATCHED).min(matches.len()) {
                    if spender.left() > 0 {
                        take(spender, matches.start(setup.starts, rank));
                    }
                }
            }
            None => {
                for _ in 0..setup.screen() {
                    if spender.left() > 0 {
                        take(spender, setup.starts.draw(&mut draws));
                    }
                }
            }
        }
    }
    (drawn, count)
}

/// Keeps so many starts of a round: those that promise most, or some of all ranks, evenly. Those that promise most of the
/// starts near a known end are the nearest to it, and lead back to it.
fn screen<T>(drawn: &mut Vec<(f64, T)>, keep: usize, of_all_ranks: bool) {
    let count = drawn.len();
    by_merit(drawn, count);
    if of_all_ranks && count > keep {
        for rank in 0..keep {
            drawn.swap(rank, rank * count / keep);
        }
    }
    drawn.truncate(keep);
}

/// Keeps so many ends of short fits: the best, and if a `turn` is given in place of the last of them one of the others, each
/// in its turn. On a target whose shape is missed the merit after a few steps tells little about the merit at the end.
fn continued<T>(fitted: &mut Vec<(f64, T)>, keep: usize, turn: Option<usize>) {
    let count = fitted.len();
    by_merit(fitted, count);
    if let Some(turn) = turn.filter(|_| keep > 1 && count > keep) {
        let last = keep - 1;
        fitted.swap(last, last + turn % (count - last));
    }
    fitted.truncate(keep);
}

/// Runs round `index` of a batch: its ends on the explored points, and on a sparse target the finished ends. `bar` is
/// the least merit there before it.
pub(super) fn round(common: &Common<'_>, index: u64, bar: f64, allowance: u64, reading: &Reading) -> Round {
    let &Common { context, setup, .. } = common;
    let mut round = Round {
        draws: 0,
        cost: Evaluations::default(),
        leaders: Vec::new(),
        finished: Vec::new(),
        independent: common.is_independent(index),
    };
    let mut spender = Spender::beside(context, allowance, common.best);
    let unread = || reading.is_unread(index);
    if unread() {
        return round;
    }
    let (explored, dense) = (setup.explored(), setup.is_dense());
    let (mut drawn, draws) = drawn(common, index, &mut spender);
    round.draws = draws;
    let first_look = dense && setup.coarse.is_some() && common.first_of_stage + index < DENSE_BATCHES * BATCH;
    let (shorts, middles) = match first_look {
        true if common.misses_a_shape() => (DENSE_SHORT, SHAPE_MIDDLE),
        true => (DENSE_SHORT, DENSE_MIDDLE),
        false => (SHORT, MIDDLE),
    };
    screen(&mut drawn, shorts, dense && !round.independent);
    let spare = drawn.first().cloned();
    let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(shorts);
    for (_, start) in drawn {
        fitted.extend(spender.fit_its_worth(explored, start, SHORT_FIT));
    }
    let turn = (common.first_of_stage + index) as usize / if round.independent { 1 } else { 2 };
    continued(&mut fitted, middles, common.misses_a_shape().then_some(turn));
    let mut middle: Vec<(f64, Start)> = Vec::with_capacity(middles);
    for (merit, start) in fitted {
        if unread() {
            round.cost = spender.cost;
            return round;
        }
        // Out of budget: taken as it is.
        let kept = (merit, start.clone());
        let end = spender.fit_as_required(explored, start, MIDDLE_FIT).unwrap_or(kept);
        middle.push(if dense { spender.at_best_places(explored, end, MIDDLE_FIT) } else { end });
    }
    if middle.is_empty() {
        middle.extend(spare);
    }
    by_merit(&mut middle, middles);
    round.leaders = middle;
    if !common.finishes_apart() {
        let best = round.explored().min(bar).min(common.best);
        for (merit, start) in &round.leaders {
            if unread() {
                break;
            }
            // A better one has been finished, in this round or before it.
            if setup.is_worth_finishing(*merit, best) {
                round.finished.extend(finish(setup, (*merit, start), best, true, &mut spender));
                if round.is_exact() {
                    break;
                }
            }
        }
    }
    round.cost = spender.cost;
    reading.ended(index, round.cost.objective, round.is_exact());
    round
}

/// Fits an end on the explored points to all points: under the stricter requirements that were explored, if there are
/// any, and on from there without them. The first of these ends may be accepted where the second is not. Those that can
/// matter beside the best error known are led to their last digits if `digits` are wanted: fits along a limit take most of
/// their evaluations for these. Empty if its positions cannot be refined to all points.
fn finish(
    setup: &Setup<'_>,
    (explored, start): (f64, &Start),
    best: f64,
    digits: bool,
    spender: &mut Spender<'_>,
) -> Vec<Finished> {
    let start = match setup.coarse {
        None => Some(start.clone()),
        Some(coarse) => coarse.refine(setup.problem, start),
    };
    let Some(start) = start else { return Vec::new() };
    let mut further = |problem: &Problem, mut start: Start, effort: Effort| {
        let Some(end) = spender.fit_as_required(problem, start.clone(), effort) else {
            // Out of budget: taken as it is, with its error on all points.
            return promise(setup.problem, &mut start).map(|merit| (merit, start));
        };
        Some(if setup.is_dense() { spender.at_best_places(problem, end, effort) } else { end })
    };
    let mut all = Vec::with_capacity(2);
    // The rounds of a sparse target have fitted it to all points, if not to the last digits.
    let (mut end, mut is_fitted) = ((explored, start), !setup.is_dense());
    for problem in setup.stricter.into_iter().chain([setup.problem]) {
        if !is_fitted {
            let Some(fitted) = further(problem, end.1, MIDDLE_FIT) else { break };
            end = fitted;
        }
        if digits && setup.is_worth_its_digits(end.0, best) {
            let Some(fitted) = further(problem, end.1, LONG_FIT) else { break };
            end = fitted;
        }
        is_fitted = false;
        all.push(judged_if_exact(setup, explored, end.clone()));
    }
    all
}

/// Returns an end on all points; it is judged at once if it is exact and one answer is wanted.
fn judged_if_exact(setup: &Setup<'_>, explored: f64, (merit, start): (f64, Start)) -> Finished {
    let mut end = End { start, merit, judged: false, verdict: None };
    if setup.single && merit <= setup.exact {
        end.judge(setup.problem);
    }
    let is_exact = |c: &Candidate| c.accepted && searched(setup.problem, c) <= setup.exact;
    let exact = end.verdict.as_ref().is_some_and(is_exact);
    Finished { explored, end, exact }
}

/// An end on the explored points that is still to be fitted to all points.
pub(super) struct Unfinished<'a> {
    /// The index of the first round that came to it.
    pub(super) round: usize,
    /// Its merit on the explored points.
    pub(super) merit: f64,
    pub(super) start: &'a Start,
}

/// Returns the ends of rounds on the explored points that can still matter and have not been finished in earlier batches
/// of the stage, each once, best first; in noise a few of those that can be expected to be the best.
pub(super) fn unfinished<'a>(
    common: &Common<'_>,
    rounds: &'a [Round],
    stage: &StageState,
) -> Vec<Unfinished<'a>> {
    let &Common { setup, best: known, .. } = common;
    // Beside an error that is nearly exact the error that the groups' means make is not small.
    let is_far = known > setup.nearly_exact;
    let known = if is_far { known } else { f64::INFINITY };
    let best = rounds.iter().map(Round::explored).fold(stage.bar, f64::min).min(known);
    let same = if known.is_finite() { ALIKE_ENDS } else { SAME_OPTIMUM };
    let is_met = |one: f64, other: f64| apart(one, other) <= same;
    let mut out: Vec<Unfinished<'_>> = Vec::new();
    for (round, (merit, start)) in
        rounds.iter().enumerate().flat_map(|(i, round)| round.leaders.iter().map(move |end| (i, end)))
    {
        let met = stage.finished.iter().any(|(explored, _)| is_met(explored.0, *merit))
            || out.iter().any(|other| is_met(other.merit, *merit));
        if !met && setup.is_worth_finishing(*merit, best) {
            out.push(Unfinished { round, merit: *merit, start });
        }
    }
    out.sort_by(|one, other| one.merit.total_cmp(&other.merit));
    if let Some(scatter) = common.scatter(stage) {
        out.retain(|end| scatter.expected(end.merit) <= (1.0 + IN_NOISE) * scatter.best);
        out.truncate(FINISHED_IN_NOISE);
    }
    out
}

/// Returns the relative distance of a merit on the explored points from another one.
pub(super) fn apart(one: f64, other: f64) -> f64 {
    if one == other { 0.0 } else { (one - other).abs() / other }
}

/// Finishes end `index` of them within its allowance, unless one before it was exact; `in_noise` without the last digits.
pub(super) fn finished(
    &Common { context, setup, best, .. }: &Common<'_>,
    (index, end): (u64, &Unfinished<'_>),
    (allowance, in_noise): (u64, bool),
    reading: &Reading,
) -> (Vec<Finished>, Evaluations) {
    let mut spender = Spender::beside(context, allowance, best);
    if reading.is_unread(index) {
        return (Vec::new(), spender.cost);
    }
    let done = finish(setup, (end.merit, end.start), best, !in_noise, &mut spender);
    reading.ended(index, spender.cost.objective, done.iter().any(|done| done.exact));
    (done, spender.cost)
}

/// Leads the best of the ends that were finished in noise to its last digits, if it is the best of all.
pub(super) fn lead_to_digits(
    &Common { context, setup, best, .. }: &Common<'_>,
    scatter: Scatter,
    done: &mut [Finished],
    allowance: u64,
) -> Evaluations {
    let mut spender = Spender::beside(context, allowance, best);
    let least = done.iter_mut().min_by(|one, other| one.end.merit.total_cmp(&other.end.merit));
    if let Some(Finished { end, .. }) = least.filter(|least| least.end.merit < scatter.best)
        && let Some(fitted) = spender.fit_as_required(setup.problem, end.start.clone(), LONG_FIT)
    {
        let (merit, start) = spender.at_best_places(setup.problem, fitted, LONG_FIT);
        if merit < end.merit {
            *end = End { start, merit, judged: false, verdict: None };
        }
    }
    spender.cost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_near_a_known_end_are_kept_of_all_ranks() {
        let kept = |count: u8, keep, of_all_ranks| {
            let mut drawn: Vec<(f64, u8)> = (0..count).rev().map(|rank| (f64::from(rank), rank)).collect();
            screen(&mut drawn, keep, of_all_ranks);
            drawn.into_iter().map(|(_, rank)| rank).collect::<Vec<_>>()
        };
        assert_eq!(kept(12, 4, false), [0, 1, 2, 3]);
        assert_eq!(kept(12, 4, true), [0, 3, 6, 9]);
        assert_eq!(kept(7, 5, true), [0, 1, 2, 4, 5]);
        assert_eq!(kept(3, 4, true), [0, 1, 2]);
        assert_eq!(kept(0, 4, true), [0_u8; 0]);
    }

    #[test]
    fn a_fit_that_promises_less_is_continued_in_its_turn() {
        let kept = |keep, turn| {
            let mut fitted: Vec<(f64, u8)> = [(3.0, 3), (1.0, 1), (4.0, 4), (2.0, 2)].to_vec();
            continued(&mut fitted, keep, turn);
            fitted.into_iter().map(|(_, name)| name).collect::<Vec<_>>()
        };
        assert_eq!(kept(2, None), [1, 2]);
        assert_eq!((0..4).map(|turn| kept(2, Some(turn))[1]).collect::<Vec<_>>(), [2, 3, 4, 2]);
        assert_eq!(kept(3, Some(1)), [1, 2, 4]);
        assert_eq!(kept(1, Some(2)), [1], "the best is never given up");
        assert_eq!(kept(6, Some(2)), [1, 2, 3, 4]);
    }
}
