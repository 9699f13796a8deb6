//! Families of exact answers: fewer equations than free parameters, so that among all linkages that meet the targets the
//! best transmitting one is wanted.
//!
//! A pose gives three equations and a place two, and each target takes one of them for its own crank angle; a pair of a
//! function gives one. Exact answers that the rounds have found are led along their family: the least transmission angle
//! asked for is raised step by step and the linkage fitted again, for as long as it stays exact; then the step is halved.

use crate::judge::rank::{chosen, exact_cost, searched, sort};
use crate::mechanism::LinkageKind;
use crate::record::{Axis, Candidate};
use crate::synthesis::Context;
use crate::synthesis::constants::motion::{CLIMB_DEG, CLIMB_LEAST_DEG, CLIMBED};
use crate::synthesis::multistart::MIDDLE_FIT;
use crate::synthesis::tightened::{Tighter, fitted};
use crate::task::pivot_on::PivotOn;
use crate::task::{Problem, Timing};
use rayon::prelude::*;

/// Returns the number of free parameters that are left when all targets are met; 0 if there are equations enough.
pub(super) fn freedom(problem: &Problem) -> usize {
    let task = problem.task();
    let space = problem.space(problem.sides()[0]);
    let free = space.bounds().iter().filter(|(low, high)| low < high).count();
    // A slanted line takes one parameter of its pivot.
    let lines = problem.spec().require.pivot_on.iter().flat_map(PivotOn::both).flatten();
    let free = free.saturating_sub(lines.filter(|locus| locus.is_slanted()).count());
    if let Some(output) = task.body().filter(|_| task.is_function()) {
        let of_ranges = output.ranges().free().into_iter().filter(|is_free| *is_free).count();
        let unknowns = free + usize::from(output.given_frame(0.0).is_none()) + of_ranges;
        return unknowns.saturating_sub(task.len());
    }
    free.saturating_sub(equations(problem))
}

/// As [`freedom`] of a linkage with a slider, whose unknowns have these bounds.
pub(super) fn freedom_within(problem: &Problem, kind: LinkageKind, bounds: &[(f64, f64)]) -> usize {
    let free = bounds.iter().filter(|(low, high)| low < high).count();
    if let Some(outputs) = problem.task().body().filter(|_| problem.is_function()) {
        let pairs = problem.task().len();
        let of_ranges = outputs.ranges().free().into_iter().filter(|is_free| *is_free).count();
        let free = free + of_ranges;
        if kind != LinkageKind::InvertedSliderCrank || !outputs.is_of_places() {
            return free.saturating_sub(pairs);
        }
        // The place of the block depends on a g and g^2 + a^2 - h^2 alone.
        let offsets = [problem.offset_is_free(), outputs.given_frame(0.0).is_none()];
        let of_place = 2 + of_ranges + offsets.into_iter().filter(|is_free| *is_free).count();
        return free.saturating_sub(pairs.min(of_place));
    }
    free.saturating_sub(equations(problem))
}

/// Returns the number of equations of a path or a motion: two of a place, of which a free crank angle takes one, and one of
/// an angle of the body.
fn equations(problem: &Problem) -> usize {
    let task = problem.task();
    let is_free = |j: usize| matches!(task.timing(), Timing::Free) || task.is_untimed(j);
    let of_places: usize = (0..task.len()).map(|j| if is_free(j) { 1 } else { 2 }).sum();
    let angles = task.body().map_or(&[][..], |body| &body.angles);
    of_places + angles.iter().flatten().count()
}

/// Returns whether one exact answer ends a search: where one is asked for, unless it is one of a family, of which the best
/// transmitting one is wanted.
pub(super) fn one_is_enough(problem: &Problem, freedom: usize) -> bool {
    problem.spec().solve.candidates <= 1 && freedom == 0
}

/// Leads the best exact candidates to better transmission angles, with at most `left` evaluations; returns the evaluations
/// used.
pub(super) fn climb(context: Context<'_>, found: &mut Vec<Candidate>, left: u64) -> u64 {
    let problem = context.problem;
    let exact = exact_cost(problem);
    let is_exact = |candidate: &Candidate| candidate.accepted && searched(problem, candidate) <= exact;
    let known: Vec<Candidate> = found.iter().filter(|candidate| is_exact(candidate)).cloned().collect();
    let starts: Vec<&Candidate> = chosen(problem, &known, CLIMBED).into_iter().map(|i| &known[i]).collect();
    let each = left / starts.len().max(1) as u64;
    let ends: Vec<(Vec<Candidate>, u64)> = starts
        .into_par_iter()
        .map(|start| {
            let (mut met, mut used, mut step) = (Vec::new(), 0, CLIMB_DEG);
            let mut at = start.clone();
            while step >= CLIMB_LEAST_DEG && used < each && !context.stopped() {
                let worst = at.transmission_deg.worst;
                let limits = Tighter::default().with(Axis::Transmission, (worst + step).min(90.0));
                let Some(tight) = limits.of(problem) else { break };
                let fit = fitted(context, &tight, &at, MIDDLE_FIT, (exact, each - used));
                used += fit.evaluations.max(1);
                match fit
                    .candidate
                    .filter(|end| is_exact(end) && end.transmission_deg.worst > worst + 0.5 * step)
                {
                    Some(better) => {
                        met.push(better.clone());
                        at = better;
                    }
                    None => step *= 0.5,
                }
            }
            (met, used)
        })
        .collect();
    let mut used = 0;
    for (met, evaluations) in ends {
        used += evaluations;
        // The last of them is the best.
        found.extend(met.into_iter().last());
    }
    sort(problem, found);
    used
}
