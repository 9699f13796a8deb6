//! Requests to the search for dyad chains: the path, the limits, the budget.

use super::checkpoint::DyadChainState;
use crate::mechanism::{Complex, DyadChainKind};
use crate::task::AngleOffset;

/// The limits that an answer has to meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadChainLimits {
    /// Least transmission angle of every dyad over the whole turn, radians in [0, pi/2).
    pub transmission_min: f64,
    /// Greatest distance between two joints of one body, P and pivots included; infinite for no limit, which answers of
    /// enormous size then make use of.
    pub longest_max: f64,
    /// Greatest ratio of two distances between joints of one body, P left out.
    pub link_ratio_max: f64,
    /// Lower left and upper right corners of the boxes of A, of B, and of all further fixed pivots.
    pub pivots_in: [Option<[Complex; 2]>; 3],
    /// Lower left and upper right corner of a box that holds all joints and P, over the turn of a closed path, over the
    /// part of it between the first and the last point of an open one.
    pub footprint_in: Option<[Complex; 2]>,
    /// Greatest diagonal of the box of all joints and P over that motion; infinite for no limit.
    pub extent_max: f64,
}

/// Crank angles at which a path is to be drawn: `offset + run angles[j]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadChainTiming<'a> {
    /// The angle at each point, radians, not wrapped.
    pub angles: &'a [f64],
    /// From where they count.
    pub offset: AngleOffset,
    /// The senses in which their increments may be run, of +1 and -1.
    pub runs: &'a [f64],
}

impl DyadChainTiming<'_> {
    /// Returns in which sense angles follow those that are prescribed: +1 if they rise where these rise, -1 if they fall there.
    pub fn run(&self, angles: &[f64]) -> f64 {
        run(angles, self.angles)
    }

    /// Returns the sense of the prescribed angles themselves: -1 if they fall in the whole.
    pub(super) fn sense(&self) -> f64 {
        if self.angles.last() < self.angles.first() { -1.0 } else { 1.0 }
    }
}

/// Returns +1 if two lists of angles turn the same way, -1 if they turn against each other.
pub fn run(one: &[f64], other: &[f64]) -> f64 {
    let from = |list: &[f64]| list.first().copied().unwrap_or_default();
    let together: f64 = one.iter().zip(other).map(|(a, b)| (a - from(one)) * (b - from(other))).sum();
    if together < 0.0 { -1.0 } else { 1.0 }
}

/// A path to draw, by a chain whose crank turns fully.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The points in order. A closed path does not repeat its first point.
    pub points: &'a [Complex],
    /// Whether the path goes on from the last point to the first.
    pub closed: bool,
    /// The crank angles at the points, one for each; `None` with free timing.
    pub timing: Option<DyadChainTiming<'a>>,
    /// The kinds of chains to search, e.g. [`DyadChainKind::SIX_BARS`].
    pub kinds: &'a [DyadChainKind],
    /// Whether the crank has to turn counter-clockwise as P passes the points in their order; with prescribed timing the runs say it.
    pub counter_clockwise: bool,
    /// The limits.
    pub limits: DyadChainLimits,
    /// The seed of all random streams.
    pub seed: u64,
    /// Evaluations that the search may use: trial steps of fits, and draws and assignments by what they cost. Where they do not
    /// suffice for the start of one island (some 23,000), that is cut down, to a hundredth at least.
    pub evaluations: u64,
    /// The rms distance at which the search ends; zero for an exact answer only.
    pub enough: f64,
    /// Islands that have to reach the best answer before the search ends; `None` for all that the budget allows.
    pub repeats: Option<usize>,
    /// The most answers that are wanted.
    pub answers: usize,
}

impl Request<'_> {
    /// Returns whether every number can be used.
    pub(super) fn is_usable(&self) -> bool {
        let DyadChainLimits { transmission_min, longest_max, link_ratio_max, pivots_in, .. } = self.limits;
        let boxed = pivots_in
            .iter()
            .chain([&self.limits.footprint_in])
            .flatten()
            .all(|[low, high]| low.re < high.re && low.im < high.im);
        let timed = |timing: &DyadChainTiming<'_>| {
            timing.angles.len() == self.points.len() && timing.angles.iter().all(|angle| angle.is_finite())
        };
        !self.kinds.is_empty()
            && self.timing.as_ref().is_none_or(timed)
            && (0.0..1.5).contains(&transmission_min)
            && longest_max > 0.0
            && link_ratio_max > 1.0
            && self.limits.extent_max > 0.0
            && boxed
    }
}

/// The progress of a search after a round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadChainProgress {
    /// Evaluations so far.
    pub evaluations: u64,
    /// Islands that have ended.
    pub islands: usize,
    /// The best rms distance so far, hinges of the limits included; infinite before the first answer.
    pub best_rms: f64,
}

/// The caller's side of a search that is running.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Whether to stop: asked between rounds and between the stages of an island's start.
    pub stopped: &'a (dyn Fn() -> bool + Sync),
    /// Told after each round.
    pub observer: &'a (dyn Fn(&DyadChainProgress) + Sync),
    /// Given the state after each island, from which a search can be resumed.
    pub keeper: &'a (dyn Fn(&DyadChainState) + Sync),
}

impl Watch<'_> {
    /// Returns the watch of a caller who neither stops a search nor looks at it.
    pub fn silent() -> Self {
        Watch { stopped: &|| false, observer: &|_| {}, keeper: &|_| {} }
    }
}
