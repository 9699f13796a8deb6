//! Which answers are really different, and which is the best.
//!
//! Two linkages count as one answer when they draw the same curve through the target (Roberts' cognates
//! included): their coupler points at the target points and 48 points of their curves lie within a small part
//! of the target's size of each other. Ranked by acceptance, then (where tolerances are missed) by how far,
//! then error (errors of exact answers are equal), then worst transmission angle, then size.

use crate::linkage::{Complex, CouplerCurve};
use crate::problem::Problem;
use crate::problem::spec::Objective;
use crate::record::{Candidate, Figure};
use std::cmp::Ordering;

/// Curves nearer to each other than this part of the target's size are one answer.
pub const SAME_CURVE: f64 = 1e-2;
/// A fit whose mean squared error is below this part of size^2 is exact: rounding is all that is left.
pub const EXACT: f64 = 1e-24;

/// The sum of squares below which a fit is exact.
pub fn exact_sum_sq(problem: &Problem) -> f64 {
    EXACT * problem.task().len() as f64 * problem.task().size().powi(2)
}

/// The weighted sum of squares below which a fit is exact.
pub fn exact_cost(problem: &Problem) -> f64 {
    EXACT * problem.task().weights().iter().sum::<f64>() * problem.task().size().powi(2)
}

/// The objective below which a fit is exact: a weighted sum of squares; a largest deviation, which is a length,
/// or where tolerances are given that length in parts of the least of them.
pub fn exact_objective(problem: &Problem) -> f64 {
    match problem.spec().solve.objective {
        Objective::SumOfSquares => exact_cost(problem),
        Objective::MaxDeviation => {
            let least =
                problem.task().tolerances().map_or(1.0, |t| t.iter().copied().fold(f64::INFINITY, f64::min));
            EXACT.sqrt() * problem.task().size() / least
        }
    }
}

/// What searches by least squares lessen: the weighted sum of squares, whatever the objective is.
pub fn searched(problem: &Problem, candidate: &Candidate) -> f64 {
    if problem.spec().solve.objective == Objective::SumOfSquares {
        return candidate.error.objective;
    }
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let error = problem.task().errors(&candidate.linkage, &radians, &candidate.t1_at);
    error.map_or(f64::INFINITY, |error| error.objective)
}

/// Better first.
pub fn compare(problem: &Problem, one: &Candidate, other: &Candidate) -> Ordering {
    let floor = exact_objective(problem);
    let error = |c: &Candidate| c.error.objective.max(floor);
    let unmet = |c: &Candidate| {
        if c.accepted { 0 } else { 1 + c.requirements.iter().filter(|r| !r.met).count() }
    };
    // Where tolerances are asked and missed, the nearest to them comes first: of those that keep to all else.
    let missed = |c: &Candidate| {
        let row = c.requirements.iter().find(|r| !c.accepted && r.name == "tolerance");
        row.map_or((false, 0.0), |row| {
            let otherwise = c.requirements.iter().all(|r| r.met || r.name == "tolerance");
            let part = match (&row.value, &row.limit) {
                (Figure::Number(value), Figure::Number(limit)) if !row.met => value / limit,
                _ => 0.0,
            };
            (!otherwise, part)
        })
    };
    let size = |c: &Candidate| c.linkage.longest_link().max(c.linkage.crank_side());
    let accepted = |c: &Candidate| u8::from(!c.accepted);
    accepted(one)
        .cmp(&accepted(other))
        .then_with(|| missed(one).0.cmp(&missed(other).0))
        .then_with(|| missed(one).1.total_cmp(&missed(other).1))
        .then_with(|| error(one).total_cmp(&error(other)))
        .then_with(|| unmet(one).cmp(&unmet(other)))
        .then_with(|| other.transmission_deg.worst.total_cmp(&one.transmission_deg.worst))
        .then_with(|| size(one).total_cmp(&size(other)))
}

/// Linkages whose numbers agree within this part of the target's size are the same; their curves need not be
/// compared.
const SAME_NUMBERS: f64 = 1e-6;

/// A candidate's curve for comparisons.
struct Trace {
    numbers: [f64; 9],
    at_points: Vec<Complex>,
    curve: CouplerCurve,
    probes: Vec<Complex>,
}

impl Trace {
    fn of(candidate: &Candidate) -> Trace {
        let (angles, assemblies) = (&candidate.crank_deg, &candidate.t1_at);
        let at_points = angles
            .iter()
            .zip(assemblies)
            .filter_map(|(deg, t1)| candidate.linkage.position_with(deg.to_radians(), *t1).joints())
            .map(|joints| joints.coupler_point)
            .collect();
        let through = |samples| {
            CouplerCurve::through(&candidate.linkage, angles[0].to_radians(), assemblies[0], samples)
        };
        let n = candidate.linkage.natural_coordinates();
        let offset = candidate.linkage.coupler_offset();
        let ([ax, ay], [bx, by]) = (n.crank_pivot, n.follower_pivot);
        let numbers = [ax, ay, bx, by, n.crank, n.coupler, n.follower, offset.re, offset.im];
        Trace { numbers, at_points, curve: through(240), probes: through(48).points().collect() }
    }

    fn is_same(&self, other: &Trace, reach: f64) -> bool {
        let near = |p: &Complex, q: &Complex| (p - q).norm() <= reach;
        let drawn_alike = self.at_points.len() == other.at_points.len()
            && self.at_points.iter().zip(&other.at_points).all(|(p, q)| near(p, q));
        let close = SAME_NUMBERS / SAME_CURVE * reach;
        let same_numbers = self.numbers.iter().zip(&other.numbers).all(|(x, y)| (x - y).abs() <= close);
        drawn_alike
            && (same_numbers
                || self.probes.iter().all(|p| other.curve.nearest(*p).is_some_and(|n| n.distance <= reach)))
    }
}
/// The best distinct candidates, at most `wanted`, ranked from 1.
///
/// Where at least one is accepted only accepted ones are given.
pub fn distinct(problem: &Problem, mut found: Vec<Candidate>, wanted: usize) -> Vec<Candidate> {
    found.sort_by(|one, other| compare(problem, one, other));
    if found.first().is_some_and(|best| best.accepted) {
        found.retain(|candidate| candidate.accepted);
    }
    let reach = SAME_CURVE * problem.task().size();
    let mut kept: Vec<(Candidate, Trace)> = Vec::new();
    for candidate in found {
        if kept.len() == wanted {
            break;
        }
        let trace = Trace::of(&candidate);
        if kept.iter().all(|(_, other)| !trace.is_same(other, reach)) {
            kept.push((candidate, trace));
        }
    }
    let rank = |(i, (candidate, _)): (usize, (Candidate, Trace))| Candidate { rank: i + 1, ..candidate };
    kept.into_iter().enumerate().map(rank).collect()
}
