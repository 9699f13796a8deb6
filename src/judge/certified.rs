//! Certificates of single exact linkages through points and poses, and the tolerances by which a linkage passes for one.

use super::rank::exact_sum_sq;
use crate::judge::mechanisms::solution_of;
use crate::mechanism::CrankLinkage;
use crate::numbers::nine_point::Solution;
use crate::numbers::nine_point::certificate::{Certificate, certify};
use crate::record::{Candidate, Certified};
use crate::task::Problem;
use crate::task::forms::precision::{Precise, precise};

/// Returns the sum of squares up to which a candidate passes for one of the exact linkages, and a certificate is tried.
pub fn nearly_exact(problem: &Problem) -> f64 {
    1e6 * exact_sum_sq(problem)
}

/// Tolerance for the same linkage, in parts of its longest link.
const SAME: f64 = 1e-7;

/// Tolerance for the same linkage, in parts of its coordinates: far from the origin, a linkage computed from another's
/// numbers agrees with it to a thousand roundings.
const ROUNDED: f64 = 1e3 * f64::EPSILON;

/// Returns whether two linkages are the same up to rounding.
pub fn same(one: &CrankLinkage, other: &CrankLinkage) -> bool {
    let numbers = |l: &CrankLinkage| match l {
        CrankLinkage::FourBar(l) => {
            let (a, b, offset) = (l.crank_pivot(), l.follower_pivot(), l.coupler_offset());
            vec![a.re, a.im, b.re, b.im, l.crank(), l.coupler(), l.follower(), offset.re, offset.im]
        }
        _ => l.numbers(),
    };
    let far = one.pivots().map(|pivot| pivot.norm()).fold(0.0, f64::max);
    let reach = SAME * one.longest_link().max(one.crank_side()) + ROUNDED * far;
    let near = numbers(one).iter().zip(numbers(other)).all(|(x, y)| (x - y).abs() <= reach);
    one.kind() == other.kind() && near
}

/// Returns the points and poses of a problem that has exact answers.
pub fn target(problem: &Problem) -> Option<Precise> {
    precise(problem).ok()
}

/// Returns the certificate that an exact linkage exists near a candidate; `None` if certification fails.
///
/// Its radius bounds the distance of the exact pivots and pins from those of the candidate: the distance from the
/// candidate to the refined solution, plus the refined solution's own error bound ([`certify`]), plus the rounding in
/// computing that distance.
pub fn certified(of: &Precise, candidate: &Candidate) -> Option<Certified> {
    let Precise { target, places } = of;
    let linkage = candidate.linkage.four_bar()?;
    let angles: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let given = solution_of(of, linkage, &angles, &candidate.t1_at)?;
    let proof = certify(target, &given).ok().filter(Certificate::is_real)?;
    let first = places.iter().position(|place| *place == 0)?;
    let joints = linkage.position_with(*angles.get(first)?, *candidate.t1_at.get(first)?).joints()?;
    let recorded = [linkage.crank_pivot(), linkage.follower_pivot(), joints.crank_pin, joints.follower_pin];
    let apart = |solution: Solution| {
        let refined = solution.grounds.into_iter().chain(solution.pins);
        let apart = recorded.into_iter().zip(refined).map(|(recorded, refined)| {
            let exact = target.points[0] + refined * target.scale;
            let rounded = recorded.norm() + target.points[0].norm() + (refined * target.scale).norm();
            (recorded - exact).norm() + ROUNDINGS * f64::EPSILON * rounded
        });
        apart.fold(0.0, f64::max)
    };
    // The first link of a solution with a given pivot may be the follower.
    let apart = apart(proof.refined).min(apart(proof.refined.swapped()));
    // Outward: the sums below are rounded as well.
    let radius = (apart + proof.radius * target.scale) * (1.0 + ROUNDINGS * f64::EPSILON);
    radius.is_finite().then_some(Certified { radius })
}

/// Bound of the number of roundings in a sum of three points and its length.
const ROUNDINGS: f64 = 16.0;
