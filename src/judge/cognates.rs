//! Cognates of the candidates: the other linkages of the same curve, judged under the problem. Four-bars have two (Roberts), a
//! slider-crank has one ([`crate::mechanism::slider_crank`]).
//!
//! With free timing both cognates meet every point with the candidate's error. With prescribed timing only one whose
//! crank turns in step with the candidate's does. With z = (P - C)/(D - C) that is the cognate at B, driven at G = A +
//! z (B - A): its crank is (1 - z)(C - A), so that phi' = phi + arg(1 - z) for the whole motion. By the reference of
//! the crank angles:
//!
//! - offset free: the increments are the same, it keeps the timing;
//! - offset ground: its ground line is B - G = (1 - z)(B - A), turned by the same angle: it keeps the timing;
//! - offset fixed: it keeps the timing only if 1 - z is real and positive (P on the line C-D, on the side of C).
//!
//! Its coupler turns in step with the candidate's follower and its follower with the candidate's coupler, so that its
//! transmission angle is the candidate's too; it can only be better in size and place. The crank of a slider-crank's cognate turns
//! in step with the candidate's coupler, so that it is one of free timing alone.

use super::rank::{exact_sum_sq, severity, size};
use super::unwrapped::unwrapped;
use crate::judge::assess::assess_on_curve;
use crate::mechanism::four_bar::cognate::{Cognate, OriginalLink};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, CrankLinkage, SliderCrank, SliderLinkage};
use crate::record::{Alternative, Candidate};
use crate::task::Problem;
use crate::task::{AngleOffset, Timing};

/// Relative difference of sums of squares below which they are the same error.
pub const SAME_ERROR: f64 = 1e-6;
/// Number of cognates of a linkage beside itself.
pub(crate) const COGNATES: usize = 2;
/// The phase (radians) below which it counts as zero.
const NO_PHASE: f64 = 1e-13;

/// Tolerance for the coupler points of cognates, in parts of the larger linkage and the target's size.
const SAME_POINT: f64 = 1e-7;

/// Returns the index of the first point at which the coupler points of two linkages, at their crank angles (degrees)
/// and assemblies, differ by more than `SAME_POINT` of the target's `size` or their longest link; `None` if they agree
/// everywhere.
pub fn first_apart(size: f64, one: At<'_>, other: At<'_>) -> Option<usize> {
    let span = one.0.longest_link().max(other.0.longest_link()).max(size);
    let point = |(linkage, crank_deg, t1_at): At<'_>, i: usize| {
        let at = linkage.joints_with(crank_deg.get(i)?.to_radians(), *t1_at.get(i)?)?;
        Some(at.joints.coupler_point)
    };
    (0..one.1.len().min(other.1.len())).find(|&i| {
        !point(one, i).zip(point(other, i)).is_some_and(|(p, q)| (p - q).norm() <= SAME_POINT * span)
    })
}

/// Bound of the rounding error of a coupler point, in parts of the largest number that it is computed from, if no
/// toggle is near: two roots, two divisions and a dozen sums and products.
const ROUNDED: f64 = 32.0 * f64::EPSILON;

/// Returns whether the sum of squares of a linkage is that of the candidate whose curve it draws: within
/// [`SAME_ERROR`], within the bound for exact answers, or within rounding. The margins are multiplied by `times`: a
/// check of results that were computed elsewhere doubles them.
///
/// Each error vector is the difference of a point and a coupler point, off by at most r, `ROUNDED` of the largest
/// coordinate or length of the two linkages and the points; so that |sqrt(s_1) - sqrt(s_2)| <= 2 r sqrt(n).
pub fn has_error_of(
    problem: &Problem,
    candidate: &Candidate,
    form: (&CrankLinkage, f64),
    times: f64,
) -> bool {
    let (linkage, sum_sq) = form;
    let task = problem.task();
    let of_points = task.points().iter().fold(0.0, |reach: f64, p| reach.max(p.norm()));
    let reach = [linkage, &candidate.linkage].into_iter().map(magnitude).fold(of_points, f64::max);
    let rounded = 2.0 * ROUNDED * reach * (task.len() as f64).sqrt();
    let own = candidate.error.sum_sq;
    let same = own * (1.0 + times * SAME_ERROR);
    sum_sq <= same.max(times * exact_sum_sq(problem)).max((own.sqrt() + times * rounded).powi(2))
}

/// Returns the largest number that a coupler point of a linkage is computed from.
fn magnitude(linkage: &CrankLinkage) -> f64 {
    let pivots = linkage.pivots().map(|pivot| pivot.norm()).fold(0.0, f64::max);
    pivots.max(linkage.longest_link()).max(linkage.crank_side())
}

/// A linkage with its crank angle (degrees) and assembly at each point.
pub type At<'a> = (&'a CrankLinkage, &'a [f64], &'a [AssemblyMode]);

/// The order of linkages of the same curve and error, on a grid above rounding; less is better.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Merit {
    refused: bool,
    severity: usize,
    unmet: usize,
    lack_of_transmission: i64,
    size: i64,
}

impl Merit {
    pub(crate) fn of(candidate: &Candidate) -> Merit {
        // Near a change point the angle is rounded to the root of the lengths' rounding.
        let (degrees, logarithm) = (1e5, 1e9);
        Merit {
            refused: !candidate.accepted,
            severity: severity(candidate),
            unmet: candidate.requirements.iter().filter(|r| !r.met).count(),
            lack_of_transmission: -(candidate.transmission_deg.worst * degrees).round() as i64,
            size: (size(candidate).ln() * logarithm).round() as i64,
        }
    }
}

pub(crate) fn alternative(form: &Candidate) -> Alternative {
    Alternative {
        linkage: form.linkage,
        crank_deg: form.crank_deg.clone(),
        t1_at: form.t1_at.to_vec(),
        linkage_type: form.linkage_type,
        accepted: form.accepted,
        sum_sq: form.error.sum_sq,
        transmission_worst_deg: form.transmission_deg.worst,
        link_ratio: form.link_ratio,
        not_met: not_met(form),
    }
}

/// Returns the names of the requirements that a candidate does not meet.
pub fn not_met(candidate: &Candidate) -> Vec<String> {
    candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.clone()).collect()
}

/// Returns the cognates of a candidate that meet the points as it does, of a four-bar [at A, at B], each judged under the problem;
/// they share the distances to the whole curve, since the curve is the same. A motion has none: the couplers of cognates
/// turn differently.
pub fn cognates(problem: &Problem, candidate: &Candidate) -> Vec<Candidate> {
    if problem.task().body().is_some() || problem.task().is_partly_timed() {
        return Vec::new();
    }
    let Some((angle, t1)) = candidate.crank_deg.first().zip(candidate.t1_at.first()) else {
        return Vec::new();
    };
    if let Some(linkage) = candidate.linkage.slider_crank() {
        return of_slider_crank(problem, candidate, linkage).into_iter().collect();
    }
    let Some(linkage) = candidate.linkage.four_bar() else { return Vec::new() };
    let found = linkage.with_assembly(*t1).cognates_at(angle.to_radians());
    let judged = |cognate: Cognate| {
        let (angles, t1_at) = positions(candidate, &cognate)?;
        let linkage = cognate.linkage.with_assembly(*t1_at.first()?);
        let (crank_deg, t1_at) = match problem.task().timing() {
            Timing::Free => unwrapped(problem, linkage, angles, t1_at),
            Timing::Prescribed { offset, .. } => {
                (in_step(problem, candidate, &cognate, (*offset, linkage.ground_angle()))?, t1_at)
            }
        };
        let to_curve = Some(candidate.error.to_curve);
        assess_on_curve(problem, linkage, (&crank_deg, &t1_at), None, to_curve)
            .filter(|form| has_error_of(problem, candidate, (&form.linkage, form.error.sum_sq), 1.0))
    };
    found.into_iter().flatten().filter_map(judged).collect()
}

/// Returns the cognate of a slider-crank of free timing, judged under the problem; `None` if it has none that meets the points as
/// it does.
fn of_slider_crank(problem: &Problem, candidate: &Candidate, linkage: &SliderCrank) -> Option<Candidate> {
    if !matches!(problem.task().timing(), Timing::Free) {
        return None;
    }
    let at = |(deg, t1): (&f64, &AssemblyMode)| {
        let angle = deg.to_radians();
        let cognate = linkage.cognate(angle).ok()?;
        let coupler = candidate.linkage.joints_with(angle, *t1)?.coupler;
        Some((cognate, (coupler * linkage.coupler_offset()).arg()))
    };
    let found: Vec<(SliderCrank, f64)> =
        candidate.crank_deg.iter().zip(&candidate.t1_at).map(at).collect::<Option<_>>()?;
    let t1_at = found.iter().map(|(cognate, _)| cognate.assembly()).collect();
    let (cognate, angles) = (found.first()?.0, found.iter().map(|(_, angle)| *angle).collect());
    let (crank_deg, t1_at) = unwrapped(problem, cognate, angles, t1_at);
    let to_curve = Some(candidate.error.to_curve);
    assess_on_curve(problem, cognate, (&crank_deg, &t1_at), None, to_curve)
        .filter(|form| has_error_of(problem, candidate, (&form.linkage, form.error.sum_sq), 1.0))
}

/// Returns the cognate's crank angles, radians, and assemblies at the candidate's positions.
fn positions(candidate: &Candidate, cognate: &Cognate) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let at = |(deg, t1): (&f64, &AssemblyMode)| cognate.position_of(deg.to_radians(), *t1);
    candidate.crank_deg.iter().zip(&candidate.t1_at).map(at).collect()
}

/// Returns the prescribed crank angles, degrees, of a cognate that is driven in step with the crank; `None` for others.
fn in_step(
    problem: &Problem,
    candidate: &Candidate,
    cognate: &Cognate,
    (offset, ground_angle): (AngleOffset, f64),
) -> Option<Vec<f64>> {
    if cognate.crank.with != OriginalLink::Crank {
        return None;
    }
    let written = &problem.spec().task.timing.as_ref()?.crank_deg;
    let direction = direction(written, &candidate.crank_deg);
    let base = match offset {
        AngleOffset::Fixed if cognate.crank.phase.abs() > NO_PHASE => return None,
        AngleOffset::Fixed => 0.0,
        AngleOffset::Ground => ground_angle.to_degrees(),
        AngleOffset::Free => {
            let own = candidate.crank_deg.first()? - direction * written.first()?;
            wrapped(own.to_radians() + cognate.crank.phase).to_degrees()
        }
    };
    Some(written.iter().map(|deg| base + direction * deg).collect())
}

/// Returns +1 if the crank runs through the prescribed angles as they are written, -1 if it runs the other way.
pub(super) fn direction(written: &[f64], crank_deg: &[f64]) -> f64 {
    let first = written.first().copied().unwrap_or(0.0);
    let away = |i: &usize| (written[*i] - first).abs();
    let farthest = (0..written.len().min(crank_deg.len())).max_by(|i, j| away(i).total_cmp(&away(j)));
    match farthest {
        Some(i) if (crank_deg[i] - crank_deg[0]) * (written[i] - first) < 0.0 => -1.0,
        _ => 1.0,
    }
}
