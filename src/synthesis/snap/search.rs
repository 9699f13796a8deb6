//! Search for a combination of stock lengths: a beam search over the lengths, then a local search from the best.

use super::length::Length;
use super::refit::{Fixed, refit};
use super::stock::Stock;
use crate::judge::practicality::sensitivity_of;
use crate::judge::rank::compare;
use crate::record::{Candidate, Evaluations, Reason};
use crate::synthesis::Context;
use crate::synthesis::constants::snap::{BEAM, IMPROVED, NEAR, QUICK, ROUNDS, SPARE, THOROUGH};
use crate::task::Problem;
use crate::task::spec::{DesignSpec, Limits};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A request to snap lengths to a stock.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The available lengths.
    pub stock: Stock,
    /// The hole distances that are snapped to them.
    pub lengths: Vec<Length>,
    /// The dimensions that are kept, or fixed by the user.
    pub fixed: Fixed,
    /// The number of answers wanted, at least one.
    pub wanted: usize,
}

/// The reason why nothing can be snapped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SnapError {
    /// No length is left to snap.
    #[error("every length is kept or fixed, by the command or by the problem: there is nothing to snap")]
    NothingToSnap,
    /// The problem's limits leave no stock length.
    #[error(
        "no stock length ({stock}) lies within the problem's limits for {key}, {low} to {high}: give a finer stock, or leave {key} out with --snap"
    )]
    NoStock {
        /// Key of the length.
        key: String,
        /// The stock, in words.
        stock: String,
        /// Its least value allowed.
        low: f64,
        /// Its greatest value allowed.
        high: f64,
    },
    /// No combination near the candidate is a linkage that can be assembled at every point.
    #[error(
        "no combination of stock lengths near this linkage can be assembled at every point of the target: give a finer stock, or fewer lengths with --snap"
    )]
    NoneFits,
    /// It was interrupted before there was an answer.
    #[error("interrupted before there was an answer")]
    Interrupted,
}

/// The result of snapping.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapped {
    /// The lengths that were snapped, in the order in which they were fixed.
    pub lengths: Vec<Length>,
    /// The answers, best first and ranked from 1; if one is accepted, only accepted ones.
    pub candidates: Vec<Candidate>,
    /// The plain rounding, for comparison: every length at its nearest stock size at once, and the rest fitted again.
    /// `None` if that is not a linkage, or cannot be assembled at every point.
    pub nearest: Option<Candidate>,
    /// Number of combinations fitted.
    pub fits: u64,
    /// The evaluations used.
    pub evaluations: Evaluations,
    /// The reason why it ended: [`Reason::Snapped`] if nothing near is better, else the one that stopped it.
    pub reason: Reason,
}

/// A choice of stock lengths with its fitted candidate.
#[derive(Clone)]
struct Choice {
    fixed: Fixed,
    candidate: Candidate,
}

struct Search<'a> {
    context: Context<'a>,
    fits: u64,
    evaluations: u64,
}

/// Snaps lengths of a candidate to stock sizes and fits the rest again.
///
/// The candidate is one of the problem, judged by it. If the budget stops it, the best complete choice so far is
/// returned: at least every length at its nearest stock size, if that can be assembled. Unstopped, the same input gives
/// the same answer on any number of threads.
///
/// # Errors
/// [`SnapError`].
pub fn snap(context: Context<'_>, candidate: &Candidate, request: &Request) -> Result<Snapped, SnapError> {
    let problem = context.problem;
    let design = &problem.spec().design;
    let lengths = to_snap(problem, candidate, request);
    if lengths.is_empty() {
        return Err(SnapError::NothingToSnap);
    }
    let near = |length: Length, at: &Candidate, count: usize| {
        let Limits(low, high) = length.limits(design, &candidate.linkage);
        request.stock.near(length.of(at.linkage).unwrap_or(f64::NAN), count, low, high)
    };
    let mut plain = request.fixed.clone();
    for &length in &lengths {
        let Some(&value) = near(length, candidate, 1).first() else {
            let Limits(low, high) = length.limits(design, &candidate.linkage);
            return Err(SnapError::NoStock { key: length.key(), stock: request.stock.words(), low, high });
        };
        plain = plain.with(length, value);
    }
    let mut search = Search { context, fits: 0, evaluations: 0 };
    let root = Choice { fixed: request.fixed.clone(), candidate: candidate.clone() };
    let at_once = search.fitted(vec![(plain, candidate)], THOROUGH);
    let mut beam = vec![root];
    for &length in &lengths {
        if context.stopped() {
            // Choices of only some of the lengths are not answers; every length at its nearest stock size is one.
            beam.clear();
            break;
        }
        let choices = beam
            .iter()
            .flat_map(|choice| {
                let values = near(length, &choice.candidate, NEAR);
                values.into_iter().map(|value| (choice.fixed.with(length, value), &choice.candidate))
            })
            .collect();
        let mut next = search.fitted(choices, QUICK);
        next.truncate(BEAM);
        beam = next;
    }
    let nearest = at_once.first().map(|choice| choice.candidate.clone());
    let mut tried: BTreeSet<Vec<u64>> = beam.iter().chain(&at_once).map(|c| bits(&c.fixed)).collect();
    let mut all = beam;
    all.extend(at_once);
    search.sort(&mut all);
    let mut improved: BTreeSet<Vec<u64>> = BTreeSet::new();
    for _ in 0..ROUNDS {
        let best: Vec<Choice> =
            all.iter().take(IMPROVED).filter(|c| improved.insert(bits(&c.fixed))).cloned().collect();
        if best.is_empty() || context.stopped() {
            break;
        }
        let mut choices = Vec::new();
        for choice in &best {
            for fixed in neighbours(choice, &lengths, &request.stock, design) {
                if tried.insert(bits(&fixed)) {
                    choices.push((fixed, &choice.candidate));
                }
            }
        }
        let found = search.fitted(choices, QUICK);
        all.extend(found);
        search.sort(&mut all);
    }
    // The best are fitted once more from their present parameters, with more evaluations.
    let leaders = if context.stopped() { 0 } else { request.wanted.max(1) + SPARE };
    let leaders: Vec<Choice> = all.iter().take(leaders).cloned().collect();
    let again = leaders.iter().map(|choice| (choice.fixed.clone(), &choice.candidate)).collect();
    all.extend(search.fitted(again, THOROUGH));
    search.sort(&mut all);
    let mut seen: BTreeSet<Vec<u64>> = BTreeSet::new();
    all.retain(|choice| seen.insert(bits(&choice.fixed)));
    let accepted = all.first().is_some_and(|c| c.candidate.accepted);
    let candidates: Vec<Candidate> = all
        .into_iter()
        .map(|choice| choice.candidate)
        .filter(|c| c.accepted || !accepted)
        .take(request.wanted.max(1))
        .zip(1..)
        .map(|(candidate, rank)| Candidate { rank, ..candidate })
        .collect();
    if candidates.is_empty() {
        return Err(if context.stopped() { SnapError::Interrupted } else { SnapError::NoneFits });
    }
    let reason = context.stop_reason().unwrap_or(Reason::Snapped);
    Ok(Snapped {
        lengths,
        candidates,
        nearest,
        fits: search.fits,
        evaluations: context.cost(search.evaluations),
        reason,
    })
}

/// Returns the lengths that can be snapped, the one to which the path is most sensitive first.
fn to_snap(problem: &Problem, candidate: &Candidate, request: &Request) -> Vec<Length> {
    let design = &problem.spec().design;
    let whole = |p: Option<[Limits; 2]>| p.is_some_and(|p| p.iter().all(Limits::is_fixed));
    let both_pivots = (request.fixed.crank_pivot.is_some() || whole(design.crank_pivot))
        && (request.fixed.follower_pivot.is_some() || whole(design.follower_pivot));
    let kept: Vec<&str> = request.fixed.pivots().into_iter().map(|(name, _)| name).collect();
    let free = |length: &Length| {
        length.of(candidate.linkage).is_some()
            && request.fixed.get(*length).is_none()
            && !length.limits(design, &candidate.linkage).is_fixed()
            && !(*length == Length::Ground && both_pivots)
            && !length.lies_between(&kept)
    };
    let all = Length::all(&candidate.linkage).into_iter();
    let mut lengths: Vec<Length> =
        all.filter(|length| request.lengths.contains(length)).filter(free).collect();
    if let Some(felt) = sensitivity_of(problem, candidate) {
        let of = |length: &Length| match length {
            Length::Ground => felt.ground.as_ref().map_or(0.0, |ground| ground.rms),
            // d and e, and the sides of ternary links, each count as both places along and across.
            _ => {
                let rms = |name: String| felt.dimensions.iter().find(|d| d.name == name).map(|d| d.rms);
                let joint = length.last_joint();
                let of_place = ["x", "y"].map(|axis| rms(format!("{joint}{axis}")));
                let of_several = of_place.into_iter().flatten().reduce(f64::max);
                rms(length.key()).or(of_several).unwrap_or(f64::INFINITY)
            }
        };
        lengths.sort_by(|x, y| of(y).total_cmp(&of(x)));
    }
    lengths
}

/// Returns a key of a choice, by which choices are compared.
fn bits(fixed: &Fixed) -> Vec<u64> {
    let mut lengths = fixed.lengths.clone();
    lengths.sort_by_key(|(length, _)| *length);
    lengths.into_iter().map(|(_, value)| value.to_bits()).collect()
}

/// Returns the choices with one length, or two, moved a stock size up or down.
fn neighbours(choice: &Choice, lengths: &[Length], stock: &Stock, design: &DesignSpec) -> Vec<Fixed> {
    let moves: Vec<(Length, f64)> = lengths
        .iter()
        .flat_map(|&length| {
            let at =
                choice.fixed.get(length).or_else(|| length.of(choice.candidate.linkage)).unwrap_or(f64::NAN);
            let Limits(low, high) = length.limits(design, &choice.candidate.linkage);
            let near = stock.near(at, NEAR, low, high);
            let up = near.iter().copied().filter(|v| *v > at).fold(f64::INFINITY, f64::min);
            let down = near.iter().copied().filter(|v| *v < at).fold(f64::NEG_INFINITY, f64::max);
            [up, down].into_iter().filter(|v| v.is_finite()).map(move |value| (length, value))
        })
        .collect();
    let mut neighbours: Vec<Fixed> =
        moves.iter().map(|&(length, value)| choice.fixed.with(length, value)).collect();
    for (i, &(length, value)) in moves.iter().enumerate() {
        for &(other, other_value) in &moves[i + 1..] {
            if other != length {
                neighbours.push(choice.fixed.with(length, value).with(other, other_value));
            }
        }
    }
    neighbours
}

impl Search<'_> {
    /// Fits choices and returns the results, best first, without those that cannot be fitted.
    fn fitted(&mut self, choices: Vec<(Fixed, &Candidate)>, evaluations: u64) -> Vec<Choice> {
        self.fits += choices.len() as u64;
        let fitted: Vec<(Option<Choice>, u64)> = choices
            .into_par_iter()
            .map(|(fixed, from)| {
                let (candidate, used) = refit(self.context, from, &fixed, evaluations);
                (candidate.map(|candidate| Choice { fixed, candidate }), used)
            })
            .collect();
        self.evaluations += fitted.iter().map(|(_, used)| used).sum::<u64>();
        let mut found: Vec<Choice> = fitted.into_iter().filter_map(|(choice, _)| choice).collect();
        self.sort(&mut found);
        found
    }

    /// Sorts choices, best first; equals stay in the order in which they were tried.
    fn sort(&self, choices: &mut [Choice]) {
        choices.sort_by(|one, other| compare(self.context.problem, &one.candidate, &other.candidate));
    }
}
