//! Refit of a candidate with some of its dimensions fixed.

use super::length::{JointName, Length};
use crate::judge::assess::{assess, assess_again};
use crate::judge::rank::compare;
use crate::judge::warm::start_at;
use crate::mechanism::dyad_chain::kinds::GROUND;
use crate::mechanism::dyad_chain::sizes::{Side, joints};
use crate::mechanism::multi_loop::LinkLength;
use crate::mechanism::{
    Complex, CrankLinkage, FourBar, InvertedSliderCrank, NaturalCoordinates, SliderCrank, point, xy,
};
use crate::record::Candidate;
use crate::synthesis::Context;
use crate::synthesis::constants::sliders::LONG_FIT;
use crate::synthesis::dyad_chains::Held;
use crate::synthesis::multistart::judged;
use crate::synthesis::polish::finish;
use crate::synthesis::several_loops::refitted_holding;
use crate::synthesis::sliders;
use crate::task::Problem;
use crate::task::spec::{DesignSpec, Limits};

/// Relative difference up to which a length counts as equal to its fixed value.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The dimensions that are fixed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fixed {
    /// Hole distances, each at most once; of a six-bar or an eight-bar those of [`Length::all`].
    pub lengths: Vec<(Length, f64)>,
    /// The crank's pivot A.
    pub crank_pivot: Option<[f64; 2]>,
    /// The follower's pivot B.
    pub follower_pivot: Option<[f64; 2]>,
    /// The fixed pivots of a six-bar or an eight-bar beside these two.
    pub further_pivots: Vec<(JointName, [f64; 2])>,
    /// The direction from A to B, degrees.
    pub ground_angle_deg: Option<f64>,
}

impl Fixed {
    /// Returns the pivots that are fixed, by name.
    pub fn pivots(&self) -> Vec<(&'static str, Complex)> {
        let named = [("A", self.crank_pivot), ("B", self.follower_pivot)];
        let first = named.into_iter().filter_map(|(name, at)| Some((name, point(at?))));
        first.chain(self.further_pivots.iter().map(|(joint, at)| (joint.name(), point(*at)))).collect()
    }

    /// Returns the value at which a length is fixed.
    pub fn get(&self, length: Length) -> Option<f64> {
        self.lengths.iter().find(|(one, _)| *one == length).map(|(_, value)| *value)
    }

    /// Returns the same with one more length, or another value of it.
    #[must_use]
    pub fn with(&self, length: Length, value: f64) -> Self {
        let mut fixed = self.clone();
        match fixed.lengths.iter_mut().find(|(one, _)| *one == length) {
            Some(place) => place.1 = value,
            None => fixed.lengths.push((length, value)),
        }
        fixed
    }

    /// Returns the problem with these dimensions as numbers; `None` if it is none. `polar`: see [`Fixed::design`].
    fn narrowed(&self, problem: &Problem, polar: bool) -> Option<Problem> {
        let mut spec = problem.spec().clone();
        spec.design = self.design(&spec.design, polar);
        Problem::new(spec).ok()
    }

    /// Returns the design table with these dimensions as numbers. `polar`: B by the ground's length and direction, so
    /// that a fixed length holds to the last digit; B's own limits are then left to the referee.
    fn design(&self, design: &DesignSpec, polar: bool) -> DesignSpec {
        let mut fixed = design.clone();
        let at = |value: f64| Limits(value, value);
        let both = |p: [f64; 2]| p.map(at);
        fixed.crank_pivot = self.crank_pivot.map(both).or(fixed.crank_pivot);
        fixed.follower_pivot = self.follower_pivot.map(both).or(fixed.follower_pivot);
        fixed.ground_angle_deg = self.ground_angle_deg.map(at).or(fixed.ground_angle_deg);
        for &(length, value) in &self.lengths {
            if let Some(limits) = length.place(&mut fixed) {
                *limits = Some(at(value));
            }
        }
        if self.get(Length::D).is_some() || self.get(Length::E).is_some() {
            // d and e are the coordinates; the problem's limits of coupler_x and coupler_y are left to the referee.
            (fixed.coupler_x, fixed.coupler_y) = (None, None);
        }
        if polar {
            fixed.follower_pivot = None;
        }
        fixed
    }
}

/// Fits a candidate again with dimensions fixed and judges it under the original problem; also returns the evaluations
/// used, about `evaluations` at most. `None` if the fit cannot start or its end is not a linkage.
pub fn refit(
    context: Context<'_>,
    candidate: &Candidate,
    fixed: &Fixed,
    evaluations: u64,
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    match candidate.linkage {
        CrankLinkage::FourBar(_) => {}
        CrankLinkage::MultiLoop(_) => return fit_several_loops(context, candidate, fixed, evaluations),
        CrankLinkage::SliderCrank(_) | CrankLinkage::InvertedSliderCrank(_) => {
            return fit_slider(context, candidate, fixed, evaluations);
        }
    }
    let design = &problem.spec().design;
    let ground = fixed.get(Length::Ground).is_some() || fixed.ground_angle_deg.is_some();
    let has_pivot = design.follower_pivot.is_some() || fixed.follower_pivot.is_some();
    // If B is fixed, A moves on a circle around it.
    let held = fixed.follower_pivot.is_some()
        || design.follower_pivot.is_some_and(|b| b.iter().all(Limits::is_fixed));
    let polar = has_pivot && ground && !held;
    let (mut found, mut used) = fit(context, candidate, fixed, (polar, evaluations));
    if found.is_none() && held && fixed.crank_pivot.is_none() {
        // Then with A fixed at its start on its circle.
        if let Some(linkage) = candidate.linkage.four_bar().and_then(|linkage| on_its_circle(linkage, fixed))
        {
            let still = Fixed { crank_pivot: Some(xy(linkage.crank_pivot())), ..fixed.clone() };
            let (there, more) = fit(context, candidate, &still, (polar, evaluations));
            (found, used) = (there, used + more);
        }
    }
    let Some(found) = found else { return (None, used) };
    let out = |r: &crate::record::Requirement| !r.met && (r.name == "design.Bx" || r.name == "design.By");
    if polar && found.requirements.iter().any(out) {
        let (within, more) = fit(context, candidate, fixed, (false, evaluations));
        used += more;
        if let Some(within) = within.filter(|within| compare(problem, within, &found).is_lt()) {
            return (Some(within), used);
        }
    }
    (Some(found), used)
}

fn fit(
    context: Context<'_>,
    candidate: &Candidate,
    fixed: &Fixed,
    (polar, evaluations): (bool, u64),
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    let Some(narrowed) = fixed.narrowed(problem, polar) else { return (None, 0) };
    // If A moves on a circle around a fixed B, the fit has to begin at the right distance: that is a condition, not a
    // coordinate of the design.
    let moved = candidate
        .linkage
        .four_bar()
        .and_then(|linkage| on_its_circle(linkage, fixed))
        .filter(|_| !polar)
        .and_then(|linkage| assess(problem, linkage, &candidate.crank_deg, &candidate.t1_at));
    let Some(start) = start_at(&narrowed, moved.as_ref().unwrap_or(candidate)) else { return (None, 0) };
    let fitted = finish(context.of(&narrowed), &start, evaluations);
    let found = fitted.end.and_then(|end| judged(&narrowed, &end)).and_then(|found| {
        let linkage = to_the_digit(found.linkage.four_bar()?, fixed)?;
        assess(problem, linkage, &found.crank_deg, &found.t1_at)
    });
    (found, fitted.evaluations)
}

/// As [`refit`] of a six-bar or an eight-bar.
fn fit_several_loops(
    context: Context<'_>,
    candidate: &Candidate,
    fixed: &Fixed,
    evaluations: u64,
) -> (Option<Candidate>, u64) {
    let Some(linkage) = candidate.linkage.multi_loop() else { return (None, 0) };
    let kind = linkage.chain_kind();
    // The joints of a body stand in one order in the linkage and in its chain.
    let joint = |body: usize, place: usize| joints(kind, body)[place];
    let mut held = Vec::new();
    for &(length, value) in &fixed.lengths {
        let Some(LinkLength { body, places, .. }) = length.of_several(linkage) else { return (None, 0) };
        held.push(Held::Length(Side { body, joints: places.map(|place| joint(body, place)) }, value));
    }
    let ground = linkage.named_pivots();
    for (name, at) in fixed.pivots() {
        let Some(place) = ground.iter().position(|(own, _)| *own == name) else { return (None, 0) };
        held.push(Held::Pivot(joint(GROUND, place), at));
    }
    held.extend(fixed.ground_angle_deg.map(|deg| Held::Direction(deg.to_radians())));
    let (end, used) = refitted_holding(context, candidate, &held, evaluations);
    let found = end.and_then(|found| {
        let linkage = several_loops_to_the_digit(&found.linkage, fixed)?;
        assess_again(context.problem, &Candidate { linkage, ..found })
    });
    (found, used)
}

/// Returns a linkage of several loops with its fixed dimensions at exactly their values. `None` if they are off by more than the rounding
/// of a fit.
fn several_loops_to_the_digit(linkage: &CrankLinkage, fixed: &Fixed) -> Option<CrankLinkage> {
    if !are_near(linkage, fixed) {
        return None;
    }
    let of = linkage.multi_loop()?;
    let lengths: Option<Vec<_>> =
        fixed.lengths.iter().map(|(length, value)| Some((length.of_several(of)?, *value))).collect();
    let made = of.holding(&lengths?, &fixed.pivots(), fixed.ground_angle_deg.map(f64::to_radians))?;
    Some(CrankLinkage::MultiLoop(made))
}

/// As [`refit`] of a linkage with a slider.
fn fit_slider(
    context: Context<'_>,
    candidate: &Candidate,
    fixed: &Fixed,
    evaluations: u64,
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    let Some(narrowed) = fixed.narrowed(problem, false) else { return (None, 0) };
    let (end, used) = sliders::refit(context.of(&narrowed), candidate, (LONG_FIT, evaluations, 0.0));
    let found = end.and_then(|found| {
        let linkage = slider_to_the_digit(&found.linkage, fixed)?;
        assess_again(problem, &Candidate { linkage, ..found })
    });
    (found, used)
}

/// Returns a linkage with a slider with its fixed pivots and lengths at exactly their fixed values: the ground by moving B along
/// it (A if B is fixed), d and e by moving P. `None` if they are off by more than the rounding of a fit.
fn slider_to_the_digit(linkage: &CrankLinkage, fixed: &Fixed) -> Option<CrankLinkage> {
    if !are_near(linkage, fixed) {
        return None;
    }
    let z = linkage.coupler_offset();
    let offset = |coupler: Option<f64>| match (fixed.get(Length::D), fixed.get(Length::E), coupler) {
        // The triangle of b, d and e, P on its side of C-D.
        (Some(d), Some(e), Some(b)) => {
            let along = (d * d - e * e + b * b) / (2.0 * b);
            let across = ((d - along) * (d + along)).max(0.0).sqrt();
            Complex::new(along, across.copysign(z.im))
        }
        (Some(d), _, _) => z * (d / z.norm()),
        (None, Some(e), Some(b)) => b + (z - b) * (e / (z - b).norm()),
        _ => z,
    };
    let (crank, assembly) = (fixed.get(Length::A).unwrap_or(linkage.crank()), linkage.assembly());
    let pivot = fixed.crank_pivot.map_or(linkage.crank_pivot(), point);
    match linkage {
        CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => None,
        CrankLinkage::SliderCrank(l) => {
            let coupler = fixed.get(Length::B).unwrap_or(l.coupler());
            let line = (l.line_point(), l.line_direction().arg());
            let offset = offset(Some(coupler));
            let made = SliderCrank::from_parts(pivot, [crank, coupler], line, offset, assembly).ok()?;
            Some(CrankLinkage::SliderCrank(made))
        }
        CrankLinkage::InvertedSliderCrank(l) => {
            let mut pivots = [pivot, fixed.follower_pivot.map_or(l.block_pivot(), point)];
            let along = pivots[1] - pivots[0];
            let (ground, angle) = (fixed.get(Length::Ground), fixed.ground_angle_deg);
            let both = fixed.crank_pivot.is_some() && fixed.follower_pivot.is_some();
            if (ground.is_some() || angle.is_some()) && !both {
                let along = Complex::from_polar(
                    ground.unwrap_or(along.norm()),
                    angle.map_or(along.arg(), f64::to_radians),
                );
                if fixed.follower_pivot.is_some() {
                    pivots[0] = pivots[1] - along;
                } else {
                    pivots[1] = pivots[0] + along;
                }
            }
            let made =
                InvertedSliderCrank::from_parts(pivots, crank, l.offset(), offset(None), assembly).ok()?;
            Some(CrankLinkage::InvertedSliderCrank(made))
        }
    }
}

/// Returns whether the fixed lengths of a linkage are at their values up to the rounding of a fit.
fn are_near(linkage: &CrankLinkage, fixed: &Fixed) -> bool {
    /// The feasibility tolerance of a fit.
    const HAIR: f64 = 1e-6;
    let near = |(length, value): &(Length, f64)| {
        length.of(*linkage).is_some_and(|own| (own - value).abs() <= HAIR * linkage.longest().max(*value))
    };
    fixed.lengths.iter().all(near)
}

/// Returns the linkage with A moved along the ground line to the distance of a fixed ground; `None` if the ground is
/// not fixed.
fn on_its_circle(linkage: &FourBar, fixed: &Fixed) -> Option<FourBar> {
    let ground = fixed.get(Length::Ground)?;
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let moved = b - (b - a) * (ground / linkage.ground());
    FourBar::new(NaturalCoordinates { crank_pivot: xy(moved), ..linkage.natural_coordinates() }).ok()
}

/// Returns the linkage with its fixed lengths at exactly their fixed values, which a fit meets only approximately: the
/// ground by moving B (A if B is fixed) along it. `None` if they are off by more than the rounding of a fit.
fn to_the_digit(linkage: &FourBar, fixed: &Fixed) -> Option<FourBar> {
    if !are_near(&CrankLinkage::FourBar(*linkage), fixed) {
        return None;
    }
    let mut n: NaturalCoordinates = linkage.natural_coordinates();
    for &(length, value) in &fixed.lengths {
        match length {
            Length::A => n.crank = value,
            Length::B => n.coupler = value,
            Length::C => n.follower = value,
            Length::D => n.crank_side = value,
            Length::E => n.follower_side = value,
            Length::Of(..) => return None,
            Length::Ground => {
                let (a, b) = (point(n.crank_pivot), point(n.follower_pivot));
                let long = (b - a).norm();
                if (long - value).abs() > ROUNDING * value {
                    let along = (b - a) * (value / long);
                    if fixed.follower_pivot.is_some() {
                        n.crank_pivot = xy(b - along);
                    } else {
                        n.follower_pivot = xy(a + along);
                    }
                }
            }
        }
    }
    FourBar::new(n).ok()
}
