//! A candidate fitted again with some of its dimensions fixed.

use crate::assess::assess;
use crate::linkage::{FourBar, NaturalCoordinates, point, xy};
use crate::problem::Problem;
use crate::problem::spec::{DesignSpec, Limits};
use crate::record::Candidate;
use crate::search::Budget;
use crate::search::multistart::judged;
use crate::search::polish::finish;
use crate::search::rank::compare;
use crate::search::warm::start_at;

/// A length is what it was fixed at when it is off by no more than this part of itself.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A hole distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Length {
    /// |AB|.
    Ground,
    /// |AC|.
    A,
    /// |CD|.
    B,
    /// |BD|.
    C,
    /// |CP|.
    D,
    /// |DP|.
    E,
}

impl Length {
    /// All of them.
    pub const ALL: [Length; 6] = [Length::Ground, Length::A, Length::B, Length::C, Length::D, Length::E];

    /// Its key in files.
    pub fn key(self) -> &'static str {
        match self {
            Length::Ground => "ground",
            Length::A => "a",
            Length::B => "b",
            Length::C => "c",
            Length::D => "d",
            Length::E => "e",
        }
    }

    /// The length with a key.
    pub fn named(key: &str) -> Option<Length> {
        Length::ALL.into_iter().find(|length| length.key() == key)
    }

    /// What it is in a linkage.
    pub fn of(self, linkage: &FourBar) -> f64 {
        match self {
            Length::Ground => linkage.ground(),
            Length::A => linkage.crank(),
            Length::B => linkage.coupler(),
            Length::C => linkage.follower(),
            Length::D => linkage.crank_side(),
            Length::E => linkage.follower_side(),
        }
    }

    /// The problem's limits for it; none that bind: from 0 upward without end.
    pub fn limits(self, design: &DesignSpec) -> Limits {
        let limits = match self {
            Length::Ground => design.ground,
            Length::A => design.a,
            Length::B => design.b,
            Length::C => design.c,
            Length::D => design.d,
            Length::E => design.e,
        };
        limits.unwrap_or(Limits(0.0, f64::INFINITY))
    }
}

/// The dimensions that are fixed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fixed {
    /// Hole distances, each at most once.
    pub lengths: Vec<(Length, f64)>,
    /// The crank's pivot.
    pub crank_pivot: Option<[f64; 2]>,
    /// The follower's pivot.
    pub follower_pivot: Option<[f64; 2]>,
    /// The direction from A to B, degrees.
    pub ground_angle_deg: Option<f64>,
}

impl Fixed {
    /// What a length is fixed at.
    pub fn get(&self, length: Length) -> Option<f64> {
        self.lengths.iter().find(|(one, _)| *one == length).map(|(_, value)| *value)
    }

    /// The same with one more length, or another value of it.
    #[must_use]
    pub fn with(&self, length: Length, value: f64) -> Self {
        let mut fixed = self.clone();
        match fixed.lengths.iter_mut().find(|(one, _)| *one == length) {
            Some(place) => place.1 = value,
            None => fixed.lengths.push((length, value)),
        }
        fixed
    }

    /// The design table with these dimensions as numbers. `polar`: B by the ground's length and direction, so that a
    /// fixed length holds to the last digit; B's own limits are then left to the referee.
    fn design(&self, design: &DesignSpec, polar: bool) -> DesignSpec {
        let mut fixed = design.clone();
        let at = |value: f64| Limits(value, value);
        let both = |p: [f64; 2]| p.map(at);
        if let Some(p) = self.crank_pivot {
            fixed.crank_pivot = Some(both(p));
        }
        if let Some(p) = self.follower_pivot {
            fixed.follower_pivot = Some(both(p));
        }
        if let Some(angle) = self.ground_angle_deg {
            fixed.ground_angle_deg = Some(at(angle));
        }
        for &(length, value) in &self.lengths {
            let place = match length {
                Length::Ground => &mut fixed.ground,
                Length::A => &mut fixed.a,
                Length::B => &mut fixed.b,
                Length::C => &mut fixed.c,
                Length::D => &mut fixed.d,
                Length::E => &mut fixed.e,
            };
            *place = Some(at(value));
        }
        if self.get(Length::D).is_some() || self.get(Length::E).is_some() {
            // d and e are the coordinates; what the problem says of coupler_x and coupler_y is left to the referee.
            (fixed.coupler_x, fixed.coupler_y) = (None, None);
        }
        if polar {
            fixed.follower_pivot = None;
        }
        fixed
    }
}

/// A candidate fitted again with dimensions fixed, judged under the problem as it is; and the evaluations that it
/// took, about `evaluations` at most. `None` where the fit cannot begin or end in a linkage.
pub fn refit(
    problem: &Problem,
    candidate: &Candidate,
    fixed: &Fixed,
    evaluations: u64,
    budget: &Budget<'_>,
) -> (Option<Candidate>, u64) {
    let design = &problem.spec().design;
    let ground = fixed.get(Length::Ground).is_some() || fixed.ground_angle_deg.is_some();
    let has_pivot = design.follower_pivot.is_some() || fixed.follower_pivot.is_some();
    // Where B is fixed, A goes round it.
    let held = fixed.follower_pivot.is_some()
        || design.follower_pivot.is_some_and(|b| b.iter().all(Limits::is_fixed));
    let polar = has_pivot && ground && !held;
    let (mut found, mut used) = fit(problem, candidate, fixed, (polar, evaluations), budget);
    if found.is_none() && held && fixed.crank_pivot.is_none() {
        // Then with A where it begins on its circle.
        if let Some(linkage) = on_its_circle(&candidate.linkage, fixed) {
            let still = Fixed { crank_pivot: Some(xy(linkage.crank_pivot())), ..fixed.clone() };
            let (there, more) = fit(problem, candidate, &still, (polar, evaluations), budget);
            (found, used) = (there, used + more);
        }
    }
    let Some(found) = found else { return (None, used) };
    let out = |r: &crate::record::Requirement| !r.met && (r.name == "design.Bx" || r.name == "design.By");
    if polar && found.requirements.iter().any(out) {
        let (within, more) = fit(problem, candidate, fixed, (false, evaluations), budget);
        used += more;
        if let Some(within) = within.filter(|within| compare(problem, within, &found).is_lt()) {
            return (Some(within), used);
        }
    }
    (Some(found), used)
}

fn fit(
    problem: &Problem,
    candidate: &Candidate,
    fixed: &Fixed,
    (polar, evaluations): (bool, u64),
    budget: &Budget<'_>,
) -> (Option<Candidate>, u64) {
    let mut spec = problem.spec().clone();
    spec.design = fixed.design(&spec.design, polar);
    let Ok(narrowed) = Problem::new(spec) else { return (None, 0) };
    // Where A goes round a B that is held, the fit has to begin at the right distance: it is a condition, no number
    // of the design.
    let moved = (!polar)
        .then(|| on_its_circle(&candidate.linkage, fixed))
        .flatten()
        .and_then(|linkage| assess(problem, &linkage, &candidate.crank_deg, &candidate.t1_at));
    let Some(start) = start_at(&narrowed, moved.as_ref().unwrap_or(candidate)) else { return (None, 0) };
    let fitted = finish(&narrowed, &start, evaluations, budget);
    let found = fitted.end.and_then(|end| judged(&narrowed, &end)).and_then(|found| {
        let linkage = to_the_digit(&found.linkage, fixed)?;
        assess(problem, &linkage, &found.crank_deg, &found.t1_at)
    });
    (found, fitted.evaluations)
}

/// The linkage with A moved along the ground line to where a fixed ground puts it; `None` where it is not fixed.
fn on_its_circle(linkage: &FourBar, fixed: &Fixed) -> Option<FourBar> {
    let ground = fixed.get(Length::Ground)?;
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let moved = b - (b - a) * (ground / linkage.ground());
    FourBar::new(NaturalCoordinates { crank_pivot: xy(moved), ..linkage.natural_coordinates() }).ok()
}

/// The linkage with its fixed lengths at exactly what they were fixed at, where a fit has left them a hair away: the
/// ground by moving B (A where B is fixed) along it. `None` where they are off by more than rounding of a fit.
fn to_the_digit(linkage: &FourBar, fixed: &Fixed) -> Option<FourBar> {
    /// The feasibility of a fit.
    const HAIR: f64 = 1e-6;
    let near = |(length, value): &(Length, f64)| {
        (length.of(linkage) - value).abs() <= HAIR * linkage.longest_link().max(*value)
    };
    if !fixed.lengths.iter().all(near) {
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
