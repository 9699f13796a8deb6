//! The search for free timing: starts by arc length or from the atlas, joint Levenberg-Marquardt on the torus,
//! and a stop when the best answer keeps coming back.
//!
//! A *round* takes `SCREEN` drawn starts, or matches of the atlas where the target has points enough, or starts near
//! known ends and along the differences between them; it fits the `SHORT` most promising for a few steps, the
//! best `MIDDLE` of those on, and finishes those that can still matter.
//! Dense targets are explored in groups of points ([`super::coarse`]) and finished on all of them; now and then all
//! points are explored, which shows what groups blur. The points of their ends are brought to their best places on the
//! curve (`reassign`) and fitted again for as long as that gains. Rounds run
//! side by side in batches of `BATCH` and are read in their order: the number of threads changes nothing but
//! the time. Ends are judged by the referee from the least error up until enough of them are accepted.
//!
//! *Stopping rule*: the best error has come back, within `SAME_OPTIMUM`, from as many independent rounds as
//! [`Hits`] says (rounds that start near known ends do not count), or within `NEARLY` from four or more times
//! as many where it is approached and hardly reached; and either as many distinct answers as were asked for are
//! known or `QUIET_BATCHES` batches brought no new one. Sparse targets are searched through `LEAST_BATCHES`
//! batches at least, so that rounds near known ends get their turn, dense ones through `DENSE_BATCHES`. On a dense
//! target the errors that are left say whether more can be had: noise differs from point to point, while errors of neighbours that are alike are
//! a shape that this linkage does not have and another may; then `PATIENT_BATCHES` batches are searched at
//! least. An exact answer needs no second hit.

use super::atlas::Matches;
use super::coarse::Coarse;
use super::keeper::{Keeper, spared};
use super::multistart::{fit_with, judged, promise};
use super::plan::{Local, SAME_OPTIMUM};
use super::polish::{basins_wanted, promising};
use super::rank::{count_distinct, exact_cost, exact_sum_sq, searched};
use super::reassign::{Reassigned, reassigned};
use super::starts::{Start, Starts};
use super::{Budget, HitsSoFar, Observer, Progress};
use crate::linkage::{Complex, LinkageType, dot};
use crate::problem::Problem;
use crate::problem::requirements::assembly_of;
use crate::problem::torus::TorusFit;
use crate::record::{Candidate, Evaluations, Reason};
use crate::solve::streams::{Stream, normal, stream, uniform};
use rayon::prelude::*;
use state::{Counts, Resumed};
use std::sync::atomic::{AtomicU64, Ordering};

mod state;

pub use state::FreeState;

/// Starts drawn and screened in a round.
const SCREEN: usize = 160;
/// Matches of the atlas taken in a round.
const MATCHED: usize = 48;
/// Starts near a known end taken in a round.
const JITTERED: usize = 40;
/// Starts fitted for a few steps.
const SHORT: usize = 16;
const DENSE_SHORT: usize = 10;
/// Starts fitted on. On a dense target most lead to the same end: at first one a round, and more rounds.
const MIDDLE: usize = 3;
const DENSE_MIDDLE: usize = 1;
/// Different ends that later rounds start near.
const LEADING: usize = 12;
/// Ends on the explored points whose merits differ by less than this part are one.
const DIFFERENT: f64 = 1e-3;
/// Rounds that run side by side before any is read.
const BATCH: u64 = 8;
/// From how many independent rounds the best answer has to come back before it is believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hits {
    /// Within `SAME_OPTIMUM`.
    pub same: usize,
    /// Within `NEARLY`.
    pub near: usize,
}

/// Where each point counts for much, optima are many and rare ones worth waiting for.
pub const SPARSE_HITS: Hits = Hits { same: 6, near: 24 };
/// Many points say more of the linkage, and a round of them costs more.
pub const DENSE_HITS: Hits = Hits { same: 4, near: 12 };
/// Errors that differ by less than this part are nearly the same optimum.
pub const NEARLY: f64 = 1e-3;
/// Batches at least for a sparse target.
const LEAST_BATCHES: u64 = 5;
/// Batches at least for a dense target.
const DENSE_BATCHES: u64 = 2;
/// Batches at least for a dense target whose errors are not noise.
const PATIENT_BATCHES: u64 = 60;
/// Errors of neighbouring points that are more alike than this are not noise.
const ALIKE: f64 = 0.3;
/// Of so many batches on a dense target of at most so many points the second explores it on all of them.
const WHOLE_EVERY: u64 = 8;
const WHOLE_MOST: usize = 200;
/// How often the points of an end are brought to their best places.
const REASSIGNED: usize = 6;
/// Batches without a new distinct answer that end a search for further ones.
const QUIET_BATCHES: u64 = 6;
/// Ends that are kept.
const KEPT: usize = 400;
/// An end whose merit on the explored points is beyond this many times the best one there is not finished when
/// one answer is wanted.
const WORTH_FINISHING: f64 = 4.0;

/// Steps, rounds of the multipliers and the relative reduction at which a fit stops.
#[derive(Clone, Copy, Debug)]
struct Effort {
    steps: usize,
    rounds: usize,
    relative_reduction: f64,
}

const SHORT_FIT: Effort = Effort { steps: 16, rounds: 2, relative_reduction: 1e-4 };
const MIDDLE_FIT: Effort = Effort { steps: 100, rounds: 6, relative_reduction: 1e-6 };
const LAST_FIT: Effort = Effort { steps: 300, rounds: 14, relative_reduction: 1e-12 };

/// The end of a fit.
#[derive(Clone, Debug)]
struct End {
    start: Start,
    merit: f64,
    /// `None`: not judged yet; `Some(None)`: cannot be judged.
    verdict: Option<Option<Candidate>>,
}

#[derive(Debug)]
struct Round {
    ends: Vec<End>,
    draws: u64,
    evaluations: u64,
    positions: u64,
    /// The least merit on the explored points.
    explored: f64,
    /// The ends on the explored points.
    leaders: Vec<(f64, Start)>,
    /// The merits on the explored points and on all of them of what it finished.
    finished: Vec<(f64, f64)>,
    /// The merits on all points of ends that it met again and did not finish a second time.
    met_again: Vec<f64>,
    /// It started from nothing that other rounds have found.
    independent: bool,
    /// It met an exact, accepted answer.
    exact: bool,
}

/// What all rounds share.
struct Setup<'a> {
    problem: &'a Problem,
    coarse: Option<&'a Coarse>,
    starts: &'a Starts<'a>,
    matches: Option<Matches>,
    /// One answer is wanted: the first exact one ends the search.
    single: bool,
    exact: f64,
}

/// One way of exploring, with what it knows.
struct Stage<'a> {
    setup: Setup<'a>,
    /// The least merit on the explored points.
    bar: f64,
    /// The best different ends on the explored points.
    leading: Vec<(f64, Start)>,
    /// The merits on the explored points and on all of them of what has been finished.
    finished: Vec<(f64, f64)>,
    /// Rounds so far.
    index: u64,
}

/// What earlier batches of a stage know.
struct Known<'a> {
    bar: f64,
    near_ends: &'a [Start],
    finished: &'a [(f64, f64)],
}

/// Which round it is: of the whole search, for its random stream, and of its stage.
#[derive(Clone, Copy)]
struct Place {
    stream: u64,
    index: u64,
}

/// How alike the errors of neighbouring points are: sum <r_j, r_j+1> / sum |r_j|^2, near 0 for noise, near 1 for a
/// smooth misfit.
fn likeness(problem: &Problem, candidate: &Candidate) -> f64 {
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let Some(error) = problem.task().errors(&candidate.linkage, &radians, &candidate.t1_at) else {
        return 1.0;
    };
    let whole: f64 = error.structural.iter().map(|r| r.norm_sqr()).sum();
    let alike: f64 = error.structural.windows(2).map(|w| dot(w[0], w[1])).sum();
    if whole > 0.0 { alike / whole } else { 1.0 }
}

impl Setup<'_> {
    /// The problem that is explored.
    fn explored(&self) -> &Problem {
        self.coarse.map_or(self.problem, |coarse| &coarse.problem)
    }
}

/// Counts while it fits, and stops at the round's allowance.
struct Spender<'a> {
    round: Round,
    allowance: u64,
    budget: &'a Budget<'a>,
}

impl Spender<'_> {
    fn left(&self) -> u64 {
        self.allowance.saturating_sub(self.round.evaluations)
    }

    fn fit(&mut self, problem: &Problem, start: Start, effort: Effort) -> Option<(f64, Start)> {
        let left = self.left();
        if left == 0 || self.budget.stopped() {
            return None;
        }
        let Effort { steps, rounds, relative_reduction } = effort;
        let fit = fit_with(problem, start, (steps, rounds, relative_reduction), left, self.budget);
        self.round.evaluations += fit.evaluations;
        self.round.positions += problem.task().len() as u64 * fit.evaluations;
        fit.end.map(|end| (fit.merit, end))
    }

    /// An end with its points brought to their best places on its curve and fitted again, as long as that gains.
    fn at_best_places(
        &mut self,
        problem: &Problem,
        (mut merit, mut end): (f64, Start),
        effort: Effort,
    ) -> (f64, Start) {
        for _ in 0..REASSIGNED {
            let Reassigned { better, positions } = reassigned(problem, &end);
            self.round.positions += positions;
            // As many evaluations as its positions are worth, within the allowance.
            self.round.evaluations += (positions / problem.task().len() as u64).min(self.left());
            let Some(start) = better else { break };
            match self.fit_on_one_circuit(problem, start, effort) {
                Some((again, start)) if again < merit => (merit, end) = (again, start),
                _ => break,
            }
        }
        (merit, end)
    }

    /// As `fit`, and where the points have come to lie on two circuits of a Grashof linkage, as they can by way of
    /// its change points, once more as a linkage that has but one circuit.
    fn fit_on_one_circuit(
        &mut self,
        problem: &Problem,
        start: Start,
        effort: Effort,
    ) -> Option<(f64, Start)> {
        let (merit, mut end) = self.fit(problem, start, effort)?;
        let types = problem.types();
        let allowed = types.is_empty() || types.contains(&LinkageType::TripleRocker);
        if problem.circuit_any() || !problem.branch_any() || !allowed || !on_two_circuits(problem, &end) {
            return Some((merit, end));
        }
        end.setting.aim = Some(LinkageType::TripleRocker);
        let again = self.fit(problem, end.clone(), effort);
        // Where that fails, an end that the referee will refuse.
        Some(again.unwrap_or((merit, end)))
    }
}

/// Whether the positions of a start lie on different circuits of its linkage.
fn on_two_circuits(problem: &Problem, start: &Start) -> bool {
    let Some(shape) = problem.space(start.setting.side).shape(&start.design) else { return false };
    let assembly = |[e, u]: &[Complex; 2]| assembly_of(&shape, *e, *u);
    let Some(linkage) = start.positions.first().and_then(|p| shape.linkage(assembly(p)).ok()) else {
        return false;
    };
    let mobility = linkage.mobility();
    let mut circuits = start.positions.iter().map(|p| mobility.branch(p[0].arg(), assembly(p)).circuit);
    let first = circuits.next();
    mobility.circuits() > 1 && circuits.any(|circuit| Some(circuit) != first)
}

fn by_merit(ends: &mut Vec<(f64, Start)>, keep: usize) {
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    ends.truncate(keep);
}

/// A start near a known end: every free number of the design moved by a random part of its size, the positions
/// brought back to the curves.
fn near(problem: &Problem, end: &Start, stream: &mut Stream) -> Option<Start> {
    let scale = uniform(stream, JITTER.0.ln(), JITTER.1.ln()).exp();
    let fit = TorusFit::new(problem, end.setting);
    let mut start = end.clone();
    let size = problem.task().size();
    for (i, (value, &(low, high))) in start.design.iter_mut().zip(fit.space().bounds()).enumerate() {
        let step = normal(stream, 0.0, scale);
        let unit = if fit.space().is_length(i) { value.abs() } else { size };
        *value = (*value + step * unit).max(low).min(high);
    }
    fit.settle(&start.design, &mut start.positions).then_some(start)
}

/// A start near a known end in the direction in which two others differ, in design and positions: what the ends of
/// one family have in common is kept, as in differential evolution (Storn and Price 1997).
fn along_a_difference(
    problem: &Problem,
    [end, one, other]: [&Start; 3],
    stream: &mut Stream,
) -> Option<Start> {
    let part = uniform(stream, DIFFERENCE.0, DIFFERENCE.1);
    let fit = TorusFit::new(problem, end.setting);
    let mut start = end.clone();
    for (i, (value, &(low, high))) in start.design.iter_mut().zip(fit.space().bounds()).enumerate() {
        let step = if fit.space().is_length(i) && *value > 0.0 && one.design[i] > 0.0 && other.design[i] > 0.0
        {
            *value * ((one.design[i] / other.design[i]).powf(part) - 1.0)
        } else {
            part * (one.design[i] - other.design[i])
        };
        *value = (*value + step).max(low).min(high);
    }
    for (position, (ahead, behind)) in
        start.positions.iter_mut().zip(one.positions.iter().zip(&other.positions))
    {
        for (direction, (to, from)) in position.iter_mut().zip(ahead.iter().zip(behind)) {
            *direction *= Complex::from_polar(1.0, part * (to * from.conj()).arg());
        }
    }
    fit.settle(&start.design, &mut start.positions).then_some(start)
}

/// The part of a difference that is added.
const DIFFERENCE: (f64, f64) = (-1.0, 1.0);

/// Random steps away from a known end, in parts of a length or of the target's size.
const JITTER: (f64, f64) = (0.01, 0.5);

fn round(
    setup: &Setup<'_>,
    Place { stream: of_search, index }: Place,
    allowance: u64,
    known: &Known<'_>,
    budget: &Budget<'_>,
    found: &AtomicU64,
) -> Round {
    let nothing = Round {
        ends: Vec::new(),
        draws: 0,
        evaluations: 0,
        positions: 0,
        explored: f64::INFINITY,
        leaders: Vec::new(),
        finished: Vec::new(),
        met_again: Vec::new(),
        independent: known.near_ends.is_empty() || index.is_multiple_of(2),
        exact: false,
    };
    let mut spender = Spender { round: nothing, allowance, budget };
    // A round before this one has the exact answer: this one is not read.
    let beaten = || found.load(Ordering::Relaxed) < of_search;
    if beaten() {
        return spender.round;
    }
    let explored = setup.explored();
    let dense = Coarse::is_for(setup.problem);
    let n = explored.task().len() as u64;
    let mut drawn: Vec<(f64, Start)> = Vec::with_capacity(SCREEN);
    let mut take = |spender: &mut Spender<'_>, start: Option<Start>| {
        spender.round.draws += 1;
        let Some(mut start) = start else { return };
        spender.round.evaluations += 1;
        spender.round.positions += n;
        if let Some(promise) = promise(explored, &mut start) {
            drawn.push((promise, start));
        }
    };
    // Of three independent rounds two take matches, as long as there are any.
    let turn = of_search as usize / 2;
    let first = (turn - turn / 3) * MATCHED;
    let mut draws = stream(setup.problem.spec().solve.seed, of_search);
    if !spender.round.independent {
        let end = &known.near_ends[(index / 2) as usize % known.near_ends.len()];
        for i in 0..JITTERED {
            if spender.left() == 0 {
                break;
            }
            let mut other =
                || &known.near_ends[uniform(&mut draws, 0.0, known.near_ends.len() as f64) as usize];
            let (one, other) = (other(), other());
            let start = if i % 2 == 1
                && one.setting.side == other.setting.side
                && one.setting.side == end.setting.side
            {
                along_a_difference(explored, [end, one, other], &mut draws)
            } else {
                near(explored, end, &mut draws)
            };
            take(&mut spender, start);
        }
    } else {
        let matched = index.is_multiple_of(2) && turn % 3 < 2;
        match setup.matches.as_ref().filter(|matches| matched && first < matches.len()) {
            Some(matches) => {
                for rank in first..(first + MATCHED).min(matches.len()) {
                    if spender.left() > 0 {
                        take(&mut spender, matches.start(setup.starts, rank));
                    }
                }
            }
            None => {
                for _ in 0..SCREEN {
                    if spender.left() > 0 {
                        take(&mut spender, setup.starts.draw(&mut draws));
                    }
                }
            }
        }
    }
    let first_look = setup.coarse.is_some() && index < DENSE_BATCHES * BATCH;
    let (shorts, middles) = if first_look { (DENSE_SHORT, DENSE_MIDDLE) } else { (SHORT, MIDDLE) };
    by_merit(&mut drawn, shorts);
    let spare = drawn.first().cloned();
    let mut fitted: Vec<(f64, Start)> = Vec::with_capacity(shorts);
    for (_, start) in drawn {
        fitted.extend(spender.fit(explored, start, SHORT_FIT));
    }
    by_merit(&mut fitted, middles);
    let mut middle: Vec<(f64, Start)> = Vec::with_capacity(middles);
    for (merit, start) in fitted {
        if beaten() {
            return spender.round;
        }
        // Out of budget: as it stands.
        let kept = (merit, start.clone());
        let end = spender.fit_on_one_circuit(explored, start, MIDDLE_FIT).unwrap_or(kept);
        middle.push(if dense { spender.at_best_places(explored, end, MIDDLE_FIT) } else { end });
    }
    if middle.is_empty() {
        middle.extend(spare);
    }
    by_merit(&mut middle, middles);
    spender.round.explored = middle.first().map_or(f64::INFINITY, |(merit, _)| *merit);
    spender.round.leaders = middle.clone();
    let best = spender.round.explored.min(known.bar);
    for (merit, start) in middle {
        if beaten() {
            return spender.round;
        }
        // A better one has been finished, in this round or before it.
        if setup.single && merit > WORTH_FINISHING * best + setup.exact {
            continue;
        }
        let same = |(explored, _): &&(f64, f64)| (explored - merit).abs() <= SAME_OPTIMUM * merit;
        if let Some((_, whole)) = known.finished.iter().find(same).filter(|_| dense) {
            spender.round.met_again.push(*whole);
            continue;
        }
        let explored = merit;
        let mut start = match setup.coarse {
            None => start,
            Some(coarse) => match coarse.refine(setup.problem, &start) {
                Some(start) => start,
                None => continue,
            },
        };
        let (merit, start) = match spender.fit_on_one_circuit(setup.problem, start.clone(), LAST_FIT) {
            Some(end) => end,
            // Out of budget: as it stands, by its error on all points.
            None => match promise(setup.problem, &mut start) {
                Some(merit) => (merit, start),
                None => continue,
            },
        };
        let (merit, start) = if dense {
            spender.at_best_places(setup.problem, (merit, start), LAST_FIT)
        } else {
            (merit, start)
        };
        spender.round.finished.push((explored, merit));
        let mut end = End { start, merit, verdict: None };
        if setup.single && merit <= setup.exact {
            let verdict = judged(setup.problem, &end.start);
            spender.round.exact =
                verdict.as_ref().is_some_and(|c| c.accepted && searched(setup.problem, c) <= setup.exact);
            end.verdict = Some(verdict);
        }
        spender.round.ends.push(end);
        if spender.round.exact {
            found.fetch_min(of_search, Ordering::Relaxed);
            return spender.round;
        }
    }
    spender.round
}

/// Rounds until the best is believed, until `limit` evaluations are used, or until `patience` are used without
/// an acceptable candidate.
pub(super) fn search(
    problem: &Problem,
    limit: u64,
    patience: u64,
    budget: &Budget<'_>,
    observer: &Observer<'_>,
    keeper: Option<&Keeper<'_>>,
) -> Local {
    let wanted = basins_wanted(problem);
    let coarse = Coarse::of(problem);
    let exact = exact_cost(problem);
    let whole = Starts::new(problem);
    let grouped = coarse.as_ref().map(|coarse| Starts::new(&coarse.problem));
    let matches = |starts: &Starts<'_>| (starts.arc().len() >= LEAST_MATCHED).then(|| Matches::of(starts));
    let stage = |coarse, starts| Stage {
        setup: Setup { problem, coarse, starts, matches: matches(starts), single: wanted == 1, exact },
        bar: f64::INFINITY,
        leading: Vec::new(),
        finished: Vec::new(),
        index: 0,
    };
    let mut stages = vec![stage(coarse.as_ref(), grouped.as_ref().unwrap_or(&whole))];
    let mut local = Local {
        found: Vec::new(),
        evaluations: Evaluations::default(),
        reason: Reason::EvaluationLimit,
        used: vec!["least-squares".into()],
    };
    let mut ends: Vec<End> = Vec::new();
    let mut best_merits: Vec<f64> = Vec::new();
    let mut count = Counts::default();
    let points = coarse.as_ref().map_or(problem.task().len(), |coarse| coarse.problem.task().len());
    let earlier = keeper.and_then(|keeper| keeper.earlier().free.as_ref());
    if let Some((state, begun)) = earlier.and_then(|state| Some((state, state.stages(problem, points)?))) {
        if begun > stages.len() {
            stages.push(stage(None, &whole));
        }
        Resumed { counts: count, evaluations: local.evaluations, best_merits, ends } =
            state.resume(problem, &mut stages);
    }
    let keep = |stopped, count, evaluations, merits: &[f64], stages: &[Stage<'_>], ends: &[End]| {
        if let Some(keeper) = keeper {
            keeper.keep(stopped, |at| {
                at.free = Some(FreeState::of(count, evaluations, merits, stages, ends));
            });
        }
    };
    // No round so far came near to what it was allowed.
    let mut ample = true;
    loop {
        let stop = budget.stop_reason();
        if ample {
            keep(stop.is_some(), count, local.evaluations, &best_merits, &stages, &ends);
        }
        if let Some(reason) = stop {
            local.reason = reason;
            break;
        }
        // What is left is shared out evenly, so that the budget is never exceeded whatever the rounds need.
        let left = limit.saturating_sub(local.evaluations.objective);
        let allowance = |index: u64| left / BATCH + u64::from(index % BATCH < left % BATCH);
        // What grouping blurs is looked for on all points, now and then.
        let grouped_few = coarse.is_some() && problem.task().len() <= WHOLE_MOST;
        let on_all = grouped_few && count.batch % WHOLE_EVERY == 1;
        if stages.len() == 1 && on_all {
            stages.push(stage(None, &whole));
        }
        let turn = usize::from(on_all);
        let Stage { setup, bar, leading, finished, index } = &stages[turn];
        let near_ends = leading.iter().map(|(_, start)| start.clone()).collect::<Vec<_>>();
        let so_far = Known { bar: *bar, near_ends: &near_ends, finished };
        let found = AtomicU64::new(u64::MAX);
        let first = count.batch * BATCH;
        let rounds: Vec<Round> = (0..BATCH)
            .into_par_iter()
            .map(|i| {
                let place = Place { stream: first + i, index: *index + i };
                round(setup, place, allowance(i), &so_far, budget, &found)
            })
            .collect();
        // A batch that was cut short says nothing of convergence, and must not pass for a whole one.
        let stop = budget.stop_reason();
        if stop.is_some() && ample {
            keep(true, count, local.evaluations, &best_merits, &stages, &ends);
        }
        ample &= (0..).zip(&rounds).all(|(i, round)| spared(round.evaluations, allowance(i)));
        let Stage { bar, leading, finished, index, .. } = &mut stages[turn];
        count.batch += 1;
        *index += BATCH;
        let mut finished_now = Vec::new();
        for round in rounds {
            count.draws += round.draws;
            *bar = bar.min(round.explored);
            for (merit, start) in round.leaders {
                if leading.iter().all(|(other, _): &(f64, Start)| (merit - other).abs() > DIFFERENT * other) {
                    leading.push((merit, start));
                }
            }
            local.evaluations.objective += round.evaluations;
            local.evaluations.positions += round.positions;
            if round.independent {
                let merits = round.ends.iter().map(|end| end.merit).chain(round.met_again);
                best_merits.push(merits.fold(f64::INFINITY, f64::min));
            }
            finished_now.extend(round.finished);
            ends.extend(round.ends);
            if round.exact {
                break;
            }
        }
        finished.extend(finished_now);
        by_merit(leading, LEADING);
        ends.sort_by(|one, other| one.merit.total_cmp(&other.merit));
        // Of what the referee has refused, a part is enough: it must not crowd out the accepted.
        let mut refused = 0;
        ends.retain(|end| {
            let unfit =
                end.verdict.as_ref().is_some_and(|v| v.as_ref().is_none_or(|c| !promising(problem, c)));
            refused += usize::from(unfit);
            !unfit || refused <= KEPT / 4
        });
        ends.truncate(KEPT);
        let best = judge_from_the_best(problem, &mut ends, wanted, exact);
        if let Some(reason) = stop {
            local.reason = reason;
            break;
        }
        let within = |error: f64, part: f64| {
            let limit = error + (part * error).max(exact);
            best_merits.iter().filter(|merit| **merit <= limit).count()
        };
        let hits = if coarse.is_some() { DENSE_HITS } else { SPARSE_HITS };
        observer(&Progress {
            phase: "least-squares",
            evaluations: local.evaluations.objective,
            budget: limit,
            best_sum_sq: best.as_ref().or(shown(&ends)).map(|c| c.error.sum_sq),
            accepted: best.as_ref().is_some_and(|b| b.accepted),
            hits: best
                .as_ref()
                .filter(|b| b.accepted)
                .map(|b| HitsSoFar { came: within(searched(problem, b), SAME_OPTIMUM), wanted: hits.same }),
        });
        if let Some(best) = &best {
            let error = searched(problem, best);
            let is_exact = error <= exact;
            let believed = within(error, SAME_OPTIMUM) >= hits.same || within(error, NEARLY) >= hits.near;
            let least = match &coarse {
                _ if is_exact => 0,
                None => LEAST_BATCHES,
                Some(_) if likeness(problem, best) < ALIKE => DENSE_BATCHES,
                Some(_) => PATIENT_BATCHES,
            };
            if (believed && count.batch >= least) || (is_exact && wanted == 1) {
                let now =
                    if wanted == 1 { 1 } else { count_distinct(problem, &accepted(problem, &ends), wanted) };
                count.quiet = if now > count.known { 0 } else { count.quiet + 1 };
                count.known = now;
                if now >= wanted || count.quiet >= QUIET_BATCHES {
                    let is_exact = best.error.sum_sq <= exact_sum_sq(problem);
                    local.reason = if is_exact { Reason::TargetReached } else { Reason::Converged };
                    break;
                }
            }
        }
        // Draws that cannot be assembled cost no evaluation, and must not go on for ever.
        let used = local.evaluations.objective;
        let spent = used.max(count.draws);
        if spent >= limit || (spent >= patience && best.is_none()) {
            local.reason = if used < patience { Reason::Stalled } else { Reason::EvaluationLimit };
            break;
        }
    }
    local.found = ends.into_iter().filter_map(|end| end.verdict.flatten()).collect();
    local
}

/// Targets of fewer points are not matched with the atlas.
const LEAST_MATCHED: usize = 24;

/// Judges ends from the least merit up: where one answer is wanted until the first accepted one, else all that
/// can be among the best.
fn judge_from_the_best(problem: &Problem, ends: &mut [End], wanted: usize, exact: f64) -> Option<Candidate> {
    let mut best: Option<Candidate> = None;
    let mut count = 0;
    let enough = if wanted == 1 { 1 } else { 8 * wanted };
    for end in ends.iter_mut() {
        if count >= enough {
            break;
        }
        let verdict = end.verdict.get_or_insert_with(|| judged(problem, &end.start));
        let Some(candidate) = verdict.as_ref().filter(|c| promising(problem, c)) else { continue };
        count += 1;
        let better = best
            .as_ref()
            .is_none_or(|b| searched(problem, candidate).max(exact) < searched(problem, b).max(exact));
        if better {
            best = Some(candidate.clone());
        }
    }
    best
}

fn accepted(problem: &Problem, ends: &[End]) -> Vec<Candidate> {
    ends.iter().filter_map(|end| end.verdict.clone().flatten()).filter(|c| promising(problem, c)).collect()
}

fn shown(ends: &[End]) -> Option<&Candidate> {
    ends.iter().find_map(|end| end.verdict.as_ref()?.as_ref())
}
