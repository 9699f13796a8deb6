//! Difference of two candidates, to tell distinct answers apart: by their joints at the first point, cognates included,
//! and by their coupler curves.

use crate::mechanism::{Complex, CouplerCurve, CrankLinkage, nearest_share};
use crate::record::Candidate;
use std::borrow::Cow;
use std::cell::OnceCell;

/// Distance of the joints of linkages, in parts of their span, below which they are one answer.
pub const NEAR: f64 = 0.05;
/// The most target points at which two candidates are compared.
const COMPARED: usize = 64;
/// Samples of a coupler curve; one in `PROBE_EVERY` of them is compared with the other curve.
const OUTLINE: usize = 240;
const PROBE_EVERY: usize = 5;

/// The joints A, B, C, D and the coupler point P.
type Joints = [Complex; 5];

/// A candidate with the geometry by which it is compared, computed on demand.
pub(super) struct Look<'a> {
    candidate: Cow<'a, Candidate>,
    /// The joints at the first point of the candidate and of its two cognates, each also with its sides exchanged.
    forms: OnceCell<Option<Vec<Joints>>>,
    at_points: OnceCell<Vec<Complex>>,
    outline: OnceCell<Vec<Complex>>,
}

impl<'a> Look<'a> {
    pub(super) fn of(candidate: Cow<'a, Candidate>) -> Look<'a> {
        let (forms, at_points, outline) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Look { candidate, forms, at_points, outline }
    }

    /// Returns the joints of the candidate and its cognates, by the table of [`crate::mechanism::four_bar::cognate`].
    fn forms(&self) -> Option<&[Joints]> {
        let made = || {
            let linkage = &self.candidate.linkage;
            let (angle, t1) = self.candidate.crank_deg.first().zip(self.candidate.t1_at.first())?;
            let joints = linkage.joints_with(angle.to_radians(), *t1)?.joints;
            let (c, d, p) = (joints.crank_pin, joints.follower_pin, joints.coupler_point);
            let a = linkage.crank_pivot();
            let linkage = match linkage {
                CrankLinkage::FourBar(linkage) => linkage,
                CrankLinkage::SliderCrank(linkage) => {
                    let along = linkage.line_direction() * linkage.coupler();
                    return Some(vec![[a, d + along, c, d, p], [a, d - along, c, d, p]]);
                }
                CrankLinkage::InvertedSliderCrank(linkage) => {
                    return Some(vec![[a, linkage.block_pivot(), c, d, p]]);
                }
                CrankLinkage::MultiLoop(linkage) => {
                    return Some(vec![[a, linkage.follower_pivot(), c, d, p]]);
                }
            };
            let b = linkage.follower_pivot();
            let z = linkage.coupler_ratio();
            let g = linkage.cognate_pivot();
            let rest = 1.0 - z;
            let (w2, w3, w4) = (c - a, d - c, d - b);
            Some(vec![
                [a, b, c, d, p],
                [b, a, d, c, p],
                [a, g, a + z * w3, g + z * w4, p],
                [g, a, g + z * w4, a + z * w3, p],
                [b, g, b - rest * w3, g + rest * w2, p],
                [g, b, g + rest * w2, b - rest * w3, p],
            ])
        };
        self.forms.get_or_init(made).as_deref()
    }

    /// Returns the difference of this candidate from another and its cognates: the largest distance of a joint from its
    /// counterpart over the larger span. Infinite if one of them has no joints to compare.
    pub(super) fn difference(&self, other: &Look<'_>) -> f64 {
        let (Some(own), Some(theirs)) = (self.forms(), other.forms()) else { return f64::INFINITY };
        let own = &own[0];
        let apart = |form: &Joints| {
            let moved = own.iter().zip(form).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
            moved / span(own).max(span(form)).max(f64::MIN_POSITIVE)
        };
        theirs.iter().map(apart).fold(f64::INFINITY, f64::min)
    }

    fn at_points(&self) -> &[Complex] {
        self.at_points.get_or_init(|| {
            let candidate = &self.candidate;
            let every = candidate.crank_deg.len().div_ceil(COMPARED).max(1);
            candidate
                .crank_deg
                .iter()
                .zip(&candidate.t1_at)
                .step_by(every)
                .filter_map(|(deg, t1)| candidate.linkage.joints_with(deg.to_radians(), *t1))
                .map(|at| at.joints.coupler_point)
                .collect()
        })
    }

    fn outline(&self) -> &[Complex] {
        self.outline.get_or_init(|| {
            let start = self.candidate.crank_deg.first().zip(self.candidate.t1_at.first());
            start.map_or(Vec::new(), |(deg, t1)| {
                let linkage = &self.candidate.linkage;
                CouplerCurve::through(linkage, deg.to_radians(), *t1, OUTLINE).points().collect()
            })
        })
    }

    /// Returns whether the coupler points at the target's points, and the whole curves, lie within `reach` of each
    /// other.
    pub(super) fn draws_the_curve_of(&self, other: &Look<'_>, reach: f64) -> bool {
        let (own, theirs) = (self.at_points(), other.at_points());
        own.len() == theirs.len()
            && own.iter().zip(theirs).all(|(p, q)| (p - q).norm() <= reach)
            && lies_on(self.outline(), other.outline(), reach)
            && lies_on(other.outline(), self.outline(), reach)
    }
}

/// Returns the largest distance between two joints.
fn span(joints: &Joints) -> f64 {
    let from = |i: usize| joints[..i].iter().map(move |q| (joints[i] - q).norm());
    (1..joints.len()).flat_map(from).fold(0.0, f64::max)
}

/// Returns whether a curve lies within `reach` of a closed polygon. The sides of the polygon are looked at from the one that
/// the last point was near, since the next point is most often near the same or the next.
fn lies_on(curve: &[Complex], polygon: &[Complex], reach: f64) -> bool {
    let count = polygon.len();
    let mut side = 0;
    curve.iter().step_by(PROBE_EVERY).all(|p| {
        let near = |i: &usize| {
            let (from, to) = (polygon[*i], polygon[(i + 1) % count]);
            let share = nearest_share(*p, [from, to]);
            (p - from - (to - from) * share).norm_sqr() <= reach * reach
        };
        let found = (side..count).chain(0..side).find(near);
        side = found.unwrap_or(side);
        found.is_some()
    })
}
