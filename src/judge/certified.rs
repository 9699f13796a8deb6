//! Certificates of single exact linkages through points and poses, and the tolerances by which a linkage passes for one.

use super::rank::exact_sum_sq;
use crate::judge::mechanisms::{Real, SecondLink, solution_of};
use crate::mechanism::{Complex, CrankLinkage, dot};
use crate::numbers::nine_point::Target;
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

/// Returns whether two linkages are the same up to rounding, whichever way the line of a slider points.
pub fn same(one: &CrankLinkage, other: &CrankLinkage) -> bool {
    let far = one.pivots().map(|pivot| pivot.norm()).fold(0.0, f64::max);
    let longest = one.longest_link().max(one.crank_side());
    let reach = SAME * longest + ROUNDED * far;
    let own = lengths(one, longest);
    let near =
        |other: &CrankLinkage| own.iter().zip(lengths(other, longest)).all(|(x, y)| (x - y).abs() <= reach);
    one.kind() == other.kind() && (near(other) || other.reversed().is_some_and(|other| near(&other)))
}

/// Returns the lengths and coordinates that determine a linkage; a direction counts as the vector of length `longest`.
fn lengths(linkage: &CrankLinkage, longest: f64) -> Vec<f64> {
    match linkage {
        CrankLinkage::FourBar(l) => {
            let (a, b, offset) = (l.crank_pivot(), l.follower_pivot(), l.coupler_offset());
            vec![a.re, a.im, b.re, b.im, l.crank(), l.coupler(), l.follower(), offset.re, offset.im]
        }
        CrankLinkage::SliderCrank(l) => {
            // The line's point is any of it: that nearest to the crank's pivot has no choice.
            let (a, s, offset) = (linkage.crank_pivot(), l.line_direction(), linkage.coupler_offset());
            let (foot, along) = (a - s * Complex::I * l.pivot_height(), s * longest);
            let places = [a, foot, along, offset].into_iter().flat_map(|z| [z.re, z.im]);
            places.chain([linkage.crank(), l.coupler()]).collect()
        }
        _ => linkage.numbers(),
    }
}

/// Returns the points and poses of a problem that has exact answers.
pub fn target(problem: &Problem) -> Option<Precise> {
    precise(problem).ok()
}

/// Returns the certificate that an exact linkage exists near a candidate; `None` if certification fails.
///
/// Its radius bounds the distance of the exact marks ([`SecondLink::marks`]) from those of the candidate, pivots and pins and,
/// where there is a slider, the point of its line at one size of the target from the mark on it: the distance from the candidate
/// to the refined solution, plus the refined solution's own error bound ([`certify`]), plus the rounding in computing that
/// distance.
///
/// The direction of a line is i v/|v|, up to its sense, with v = y - b of two unknowns, each within the error bound r of the
/// refined one: v within 2 r, so that the direction is within 4 r/|v|, as |v/|v| - w/|w|| <= 2 |v - w|/|v|. At the distance L
/// along the line that makes r (1 + 4 L/|v|).
pub fn certified(problem: &Problem, of: &Precise, candidate: &Candidate) -> Option<Certified> {
    let Precise { target, places } = of;
    let linkage = &candidate.linkage;
    let angles: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let given = solution_of(of, linkage, &angles, &candidate.t1_at)?;
    let proof = certify(target, &given).ok().filter(Certificate::is_real)?;
    let first = places.iter().position(|place| *place == 0)?;
    let at = linkage.joints_with(*angles.get(first)?, *candidate.t1_at.get(first)?)?;
    let second = <dyn SecondLink>::of(target.displacements.kind.closure);
    let recorded = second.marks(linkage, &at);
    let (bound, reach) = (proof.radius * target.scale, problem.task().size());
    let radius = |real: &Real| {
        let refined = second.marks_of(real);
        let of_points = recorded.points.iter().zip(&refined.points);
        let of_points = of_points.map(|(own, refined)| apart(target, *own, *refined, Complex::new(0.0, 0.0)));
        let of_points = of_points.fold(0.0, f64::max) + bound;
        let Some((own, exact)) = recorded.line.zip(refined.line) else { return of_points };
        let along = exact.along / exact.along.norm().copysign(dot(exact.along, own.along));
        let end = own.through + own.along / own.along.norm() * reach;
        let turned = 4.0 * reach / (real.normal().norm() * target.scale);
        of_points.max(apart(target, end, exact.through, along * reach) + bound * (1.0 + turned))
    };
    // The first link of a solution with a given pivot may be the follower.
    let real = Real::refined(&proof.refined);
    let either = [real, real.swapped()];
    let radius = either.iter().take(second.cranks()).map(radius).fold(f64::INFINITY, f64::min);
    // Outward: the sums above are rounded as well.
    let radius = radius * (1.0 + ROUNDINGS * f64::EPSILON);
    // That there is no other one is proved as far as `alone_within`.
    (radius <= proof.alone_within * target.scale).then_some(Certified { radius })
}

/// Returns a bound of the distance of a recorded mark from `beyond` added to the mark of a refined solution, rounding included.
fn apart(target: &Target, recorded: Complex, refined: Complex, beyond: Complex) -> f64 {
    let exact = target.points[0] + refined * target.scale + beyond;
    let rounded = recorded.norm() + target.points[0].norm() + (refined * target.scale).norm() + beyond.norm();
    (recorded - exact).norm() + ROUNDINGS * f64::EPSILON * rounded
}

/// Bound of the number of roundings in a sum of four points and its length.
const ROUNDINGS: f64 = 16.0;
