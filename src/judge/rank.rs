//! Ranking of candidates and choice of the distinct ones.
//!
//! Candidates are ranked by acceptance, then (if tolerances are missed) by how far, then error (errors of exact answers
//! are equal), then (if refused) by how grave the defects are and how many requirements are unmet, then worst
//! transmission angle, then size. Two candidates are one answer if
//!
//! - they are nearly the same linkage: at the first point their joints A, B, C, D and P lie within [`NEAR`] of
//!   the larger linkage's span of each other, or those of a cognate (Roberts) or of the linkage seen from its
//!   other side do; or
//! - they are of one kind and draw the same curve: their coupler points at the target points, and their whole curves, lie
//!   within [`SAME_CURVE`] of the target's size of each other; or
//! - the target is symmetric, and its symmetry maps the one to the other (only in the list that is reported; a search
//!   goes on for as long as it did without this rule).
//!
//! Of many exact answers (a family of them) the best is taken, and of the others, in their order, those that look
//! different: first at least half a span apart from all that are taken, then, if that gives too few, a quarter, and so
//! on down to [`NEAR`].

use super::look::Look;
pub use super::look::NEAR;
use super::symmetry::Symmetries;
use crate::judge::error::structural_error;
use crate::mechanism::LinkageKind;
use crate::record::{Candidate, Figure, Requirement};
use crate::task::Defect;
use crate::task::Problem;
use crate::task::requirement::RequirementKind;
use crate::task::spec::Objective;
use std::borrow::Cow;
use std::cmp::{Ordering, Reverse};

/// Distance of curves, in parts of the target's size, below which they are one answer.
pub const SAME_CURVE: f64 = 1e-2;
/// Distances between members of a family of exact answers, in spans: the largest that gives enough of them is used.
const APART: [f64; 4] = [0.5, 0.25, 0.12, NEAR];
pub use crate::record::EXACT_MEAN_SQ as EXACT;

/// Returns the mean square, in squares of the target's size, below which a fit is exact: at least that of points that lie
/// as far from where they were as a grid allows.
fn exact_mean_sq(problem: &Problem) -> f64 {
    EXACT.max(0.5 * problem.grid().powi(2))
}

/// Returns the sum of squares below which a fit is exact.
pub fn exact_sum_sq(problem: &Problem) -> f64 {
    exact_mean_sq(problem) * problem.task().len() as f64 * problem.task().error_size().powi(2)
}

/// Returns whether a candidate meets all targets exactly, in a motion the body's angles too.
pub fn is_exact(problem: &Problem, candidate: &Candidate) -> bool {
    candidate.error.sum_sq <= exact_sum_sq(problem)
        && (problem.task().body().is_none() || searched(problem, candidate) <= exact_cost(problem))
}

/// Returns whether an accepted candidate of a list is exact: the target is reached.
pub fn holds_an_exact(problem: &Problem, candidates: &[Candidate]) -> bool {
    candidates.iter().any(|c| c.accepted && is_exact(problem, c))
}

/// Returns the weighted sum of squares below which a fit is exact.
pub fn exact_cost(problem: &Problem) -> f64 {
    exact_mean_sq(problem)
        * problem.task().weights().iter().sum::<f64>()
        * problem.task().error_size().powi(2)
}

/// Returns the rms error below which a linkage is exact.
pub fn exact_error(problem: &Problem) -> f64 {
    exact_mean_sq(problem).sqrt() * problem.task().error_size()
}

/// Returns the objective below which a fit is exact: a weighted sum of squares; or a largest deviation, which is a
/// length, or if tolerances are given that length in parts of the least of them.
pub fn exact_objective(problem: &Problem) -> f64 {
    match problem.spec().solve.objective {
        Objective::SumOfSquares => exact_cost(problem),
        Objective::MaxDeviation => {
            let least =
                problem.task().tolerances().map_or(1.0, |t| t.iter().copied().fold(f64::INFINITY, f64::min));
            exact_mean_sq(problem).sqrt() * problem.task().error_size() / least
        }
    }
}

/// Returns the cost that searches by least squares minimise: the weighted sum of squares, whatever the objective is.
pub fn searched(problem: &Problem, candidate: &Candidate) -> f64 {
    if problem.spec().solve.objective == Objective::SumOfSquares {
        return candidate.error.objective;
    }
    let error = if problem.is_function() {
        // At the offset of the least squares, whichever is least in the largest error.
        let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
        problem.task().errors(candidate.linkage, &radians, &candidate.t1_at, None)
    } else {
        structural_error(problem, candidate)
    };
    error.map_or(f64::INFINITY, |error| error.objective)
}

/// The ranking key of a candidate; less is better, in the order of the fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    refused: bool,
    /// Whether requirements other than the tolerances are missed, and the largest error in parts of the tolerance.
    missed: (bool, i64),
    error: i64,
    severity: usize,
    unmet: usize,
    worst: Reverse<i64>,
    size: i64,
}

impl Key {
    fn of(candidate: &Candidate, floor: f64) -> Key {
        let unmet = |c: &Candidate| 1 + c.requirements.iter().filter(|r| !r.met).count();
        let (others, part) = missed(candidate);
        Key {
            refused: !candidate.accepted,
            missed: (others, in_order(part)),
            error: in_order(candidate.error.objective.max(floor)),
            severity: severity(candidate),
            unmet: if candidate.accepted { 0 } else { unmet(candidate) },
            worst: Reverse(in_order(candidate.transmission_deg.worst)),
            size: in_order(size(candidate)),
        }
    }
}

/// Returns an integer for a number: integers of this kind are in the order that [`f64::total_cmp`] gives the numbers.
fn in_order(x: f64) -> i64 {
    let bits = x.to_bits().cast_signed();
    // The magnitudes of negative numbers count down.
    if bits < 0 { bits ^ i64::MAX } else { bits }
}

/// Returns the severity of a refused candidate's defects: a toggle can be pushed through, an order be put up with;
/// between two circuits the linkage has to be taken apart. 0 if it is accepted.
pub(super) fn severity(candidate: &Candidate) -> usize {
    let of = |defect: &Defect| match defect {
        Defect::Branch { .. } => 1,
        Defect::Order { .. } => 2,
        Defect::Circuit { .. } => 4,
    };
    if candidate.accepted { 0 } else { candidate.defects.iter().map(of).sum() }
}

/// Returns the key by which, of candidates that meet all other requirements, the nearest to the tolerances comes first.
fn missed(candidate: &Candidate) -> (bool, f64) {
    let is_tolerance = |row: &&Requirement| RequirementKind::names_tolerance(&row.name);
    if candidate.accepted || !candidate.requirements.iter().any(|row| is_tolerance(&row)) {
        return (false, 0.0);
    }
    let others = candidate.requirements.iter().any(|row| !row.met && !is_tolerance(&row));
    let part = |row: &Requirement| match (&row.value, &row.limit) {
        (Figure::Number(value), Figure::Number(limit)) if !row.met => value / limit,
        _ => 0.0,
    };
    (others, candidate.requirements.iter().filter(is_tolerance).map(part).fold(0.0, f64::max))
}

/// Returns the longest of the links and the coupler's side.
pub(super) fn size(candidate: &Candidate) -> f64 {
    candidate.linkage.longest_link().max(candidate.linkage.crank_side())
}

/// Compares two candidates, better first. For many candidates: [`sort`].
pub fn compare(problem: &Problem, one: &Candidate, other: &Candidate) -> Ordering {
    let floor = exact_objective(problem);
    Key::of(one, floor).cmp(&Key::of(other, floor))
}

/// Sorts candidates, better first; equals keep their order.
pub fn sort(problem: &Problem, candidates: &mut [Candidate]) {
    let floor = exact_objective(problem);
    candidates.sort_by_cached_key(|candidate| Key::of(candidate, floor));
}

/// Returns the indices of the best distinct candidates, at most `wanted`, better first.
///
/// If at least one is accepted, only accepted ones are given. If one answer is wanted, no curve is computed and nothing
/// compared but the ranks.
pub fn chosen(problem: &Problem, found: &[Candidate], wanted: usize) -> Vec<usize> {
    chosen_but_for(problem, &Symmetries::default(), found, wanted)
}

/// As [`chosen`]; images under a symmetry of the target count as the same answer too.
fn chosen_but_for(
    problem: &Problem,
    symmetries: &Symmetries,
    found: &[Candidate],
    wanted: usize,
) -> Vec<usize> {
    let floor = exact_objective(problem);
    let keys: Vec<Key> = found.iter().map(|candidate| Key::of(candidate, floor)).collect();
    // Equals that differ in their last digits are ordered by these, not by the order in which they were found.
    let numbers = |i: usize| {
        (found[i].linkage.kind(), found[i].linkage.numbers().into_iter().map(in_order).collect::<Vec<i64>>())
    };
    let by_key = |&i: &usize, &j: &usize| {
        keys[i].cmp(&keys[j]).then_with(|| numbers(i).cmp(&numbers(j))).then(i.cmp(&j))
    };
    if wanted <= 1 {
        return (0..found.len()).min_by(by_key).into_iter().take(wanted).collect();
    }
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(by_key);
    let accepted = order.iter().take_while(|&&i| !keys[i].refused).count();
    if accepted > 0 {
        order.truncate(accepted);
    }
    let looks: Vec<Look<'_>> = found.iter().map(|c| Look::of(Cow::Borrowed(c))).collect();
    let reach = SAME_CURVE * problem.task().size();
    let mut taken: Vec<usize> = Vec::new();
    let kind = |i: usize| found[i].linkage.kind();
    let mut images: Vec<(LinkageKind, Look<'_>)> = Vec::new();
    // A candidate that is one answer with a taken one stays so: a taken one is never given back.
    let mut dropped = vec![false; found.len()];
    let mut take = |among: &[usize], apart: f64| {
        for &i in among {
            if taken.len() == wanted {
                return;
            }
            if dropped[i] || taken.contains(&i) {
                continue;
            }
            let least = taken.iter().map(|&k| looks[i].difference(&looks[k])).fold(f64::INFINITY, f64::min);
            dropped[i] = least < NEAR;
            if least < apart {
                continue;
            }
            let own = &looks[i];
            // A slider is another machine than a four-bar, whatever it draws. The curve of a function's follower says nothing
            // about the function.
            let draws =
                |of: LinkageKind, other: &Look<'_>| of == kind(i) && own.draws_the_curve_of(other, reach);
            dropped[i] = !problem.is_function() && taken.iter().any(|&k| draws(kind(k), &looks[k]))
                || images.iter().any(|(of, image)| own.difference(image) < NEAR || draws(*of, image));
            if !dropped[i] {
                taken.push(i);
                let of = kind(i);
                images.extend(symmetries.images(problem, &found[i]).map(|c| (of, Look::of(Cow::Owned(c)))));
            }
        }
    };
    let exact = order.iter().take_while(|&&i| !keys[i].refused && keys[i].error <= in_order(floor)).count();
    if exact > 1 {
        for apart in APART {
            take(&order[..exact], apart);
        }
    }
    take(&order, NEAR);
    taken.sort_by(by_key);
    taken
}

/// Returns the number of distinct candidates, counted up to `wanted`.
pub fn count_distinct(problem: &Problem, found: &[Candidate], wanted: usize) -> usize {
    chosen(problem, found, wanted).len()
}

/// Returns the indices of the candidates that [`distinct`] gives.
pub fn distinct_places(problem: &Problem, found: &[Candidate], wanted: usize) -> Vec<usize> {
    chosen_but_for(problem, &Symmetries::of(problem), found, wanted)
}

/// Returns the best distinct candidates, at most `wanted`, ranked from 1, and all others in their order. Of mirror
/// images that a symmetric target allows one is given.
pub fn divided(problem: &Problem, found: Vec<Candidate>, wanted: usize) -> (Vec<Candidate>, Vec<Candidate>) {
    let places = distinct_places(problem, &found, wanted);
    let mut found: Vec<Option<Candidate>> = found.into_iter().map(Some).collect();
    let ranked = (1..).zip(places);
    let best = ranked.filter_map(|(rank, place)| Some(Candidate { rank, ..found[place].take()? })).collect();
    (best, found.into_iter().flatten().collect())
}

/// Returns the best distinct candidates, at most `wanted`, ranked from 1.
///
/// If at least one is accepted, only accepted ones are given.
pub fn distinct(problem: &Problem, found: Vec<Candidate>, wanted: usize) -> Vec<Candidate> {
    divided(problem, found, wanted).0
}
