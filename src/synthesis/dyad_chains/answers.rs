//! Answers of a search: distinct ends of fits, the best first, and their figures.

use super::constants::{EXACT, SAME};
use super::fit::State;
use super::request::{DyadChainLimits, Request};
use super::target::{Target, Variant};
use crate::mechanism::{
    Complex, DyadChain, DyadChainKind, MultiLoop, bounding_box, least_and_greatest, nearest_share,
};
use std::f64::consts::TAU;

/// Phases of a turn at which the curve's distance from the target is measured.
const MEASURED: usize = 1000;

/// An end of a fit to all points.
#[derive(Clone, Debug)]
pub(super) struct End {
    pub(super) state: State,
    pub(super) variant: Variant,
    /// Fits that ended here.
    pub(super) hits: u64,
}

impl End {
    pub(super) fn kind(&self) -> DyadChainKind {
        self.state.chain.shape.kind
    }

    /// Returns whether two ends are of one kind, with nearly the same value.
    pub(super) fn is_same(&self, other: &End) -> bool {
        let [a, b] = [self.state.value, other.state.value];
        self.kind() == other.kind() && ((a - b).abs() <= SAME * a.max(b) || a.max(b) < EXACT)
    }
}

/// Distinct ends, the best first.
#[derive(Clone, Debug)]
pub(super) struct Pool {
    pub(super) ends: Vec<End>,
    most: usize,
}

impl Pool {
    /// Creates a pool of at most `most` ends.
    pub(super) fn new(most: usize) -> Self {
        Pool { ends: Vec::with_capacity(most + 1), most }
    }

    /// Returns the least value; infinite if there is none.
    pub(super) fn best(&self) -> f64 {
        self.ends.first().map_or(f64::INFINITY, |end| end.state.value)
    }

    /// Adds an end, or counts it as a repeat and keeps the better one.
    pub(super) fn add(&mut self, end: End) {
        if !end.state.value.is_finite() {
            return;
        }
        let Some(i) = self.ends.iter().position(|other| other.is_same(&end)) else {
            return self.insert(end);
        };
        let hits = self.ends[i].hits + end.hits;
        if end.state.value < self.ends[i].state.value {
            self.ends.remove(i);
            self.insert(End { hits, ..end });
        } else {
            self.ends[i].hits = hits;
        }
    }

    fn insert(&mut self, end: End) {
        let at = self.ends.partition_point(|other| other.state.value <= end.state.value);
        self.ends.insert(at, end);
        self.ends.truncate(self.most);
    }
}

/// A chain that was found, in the coordinates of the target.
#[derive(Clone, Debug, PartialEq)]
pub struct DyadChainAnswer {
    /// The chain.
    pub chain: DyadChain,
    /// The phase of the crank at each target point, radians from the line A-B; with free timing they
    /// never fall, or never rise, and lie within one turn.
    pub phases: Vec<f64>,
    /// The root mean square of the points' distances from P at these phases.
    pub rms: f64,
    /// The largest of these distances.
    pub max: f64,
    /// The largest distance of the curve from the target's polygon, at 1000 phases: of the whole curve for a closed target,
    /// of the part between the first and the last point for an open one.
    pub excursion: f64,
    /// Least transmission angle of all dyads over the turn, radians.
    pub transmission: f64,
    /// Largest distance between two joints of one body, P and pivots included.
    pub longest: f64,
    /// Ratio of the largest to the least distance between two joints of one body, P left out.
    pub link_ratio: f64,
    /// Whether all limits are met.
    pub accepted: bool,
    /// Fits of the search that ended in it.
    pub hits: u64,
}

impl DyadChainAnswer {
    /// Measures an end in the coordinates of the target.
    pub(super) fn of(end: &End, target: &Target, request: &Request<'_>) -> Self {
        let (chain, phases) = target.restored(&end.state.chain, &end.state.phases, end.variant);
        let of = chain.proportions();
        let distances =
            || phases.iter().zip(request.points).map(|(phase, t)| (chain.point(&of, *phase) - t).norm());
        let sum_sq: f64 = distances().map(|d| d * d).sum();
        let DyadChainLimits {
            transmission_min,
            longest_max,
            link_ratio_max,
            pivots_in,
            footprint_in,
            extent_max,
        } = request.limits;
        let (transmission, longest, link_ratio) =
            (of.least_transmission(), chain.longest(), chain.link_ratio());
        let is_inside = chain.pivots().into_iter().enumerate().all(|(i, p)| {
            pivots_in[i.min(2)].is_none_or(|[low, high]| {
                (low.re..=high.re).contains(&p.re) && (low.im..=high.im).contains(&p.im)
            })
        });
        DyadChainAnswer {
            rms: (sum_sq / phases.len() as f64).sqrt(),
            max: distances().fold(0.0, f64::max),
            excursion: excursion(&chain, &phases, request),
            transmission,
            longest,
            link_ratio,
            accepted: transmission >= transmission_min
                && longest <= longest_max
                && link_ratio <= link_ratio_max
                && is_inside
                && reaches_within(&chain, &phases, request.closed, (footprint_in, extent_max)),
            hits: end.hits,
            chain,
            phases,
        }
    }
}

/// Returns whether the motion stays in a box and within an extent, by dense samples.
fn reaches_within(
    chain: &DyadChain,
    phases: &[f64],
    closed: bool,
    (footprint_in, extent_max): (Option<[Complex; 2]>, f64),
) -> bool {
    if footprint_in.is_none() && extent_max.is_infinite() {
        return true;
    }
    let Ok(linkage) = MultiLoop::of_dyad_chain(chain) else { return false };
    let [first, last] = least_and_greatest(phases.iter().copied());
    let span = if closed { TAU } else { last - first };
    let at = |i: usize| chain.ground_angle() + first + span * i as f64 / MEASURED as f64;
    let bodies = (0..=MEASURED).filter_map(|i| linkage.bodies(at(i)));
    let moving: Vec<Complex> =
        bodies.flat_map(|bodies| linkage.moving(&bodies).collect::<Vec<Complex>>()).collect();
    let [low, high] = bounding_box(moving.into_iter().chain(linkage.pivots()));
    let inside = footprint_in.is_none_or(|[from, to]| {
        low.re >= from.re && low.im >= from.im && high.re <= to.re && high.im <= to.im
    });
    inside && (high - low).norm() <= extent_max
}

/// Returns the largest distance of the curve from the target's polygon.
fn excursion(chain: &DyadChain, phases: &[f64], request: &Request<'_>) -> f64 {
    let [first, last] = least_and_greatest(phases.iter().copied());
    let points = request.points;
    let of = chain.proportions();
    let edges = if request.closed { points.len() } else { points.len() - 1 };
    let span = if request.closed { TAU } else { last - first };
    let nearest = |phase: f64| {
        let p = chain.point(&of, phase);
        let distance_sq = |i: usize| {
            let edge = [points[i], points[(i + 1) % points.len()]];
            (p - edge[0] - (edge[1] - edge[0]) * nearest_share(p, edge)).norm_sqr()
        };
        (0..edges).map(distance_sq).fold(f64::INFINITY, f64::min)
    };
    let phase = |i: usize| first + span * i as f64 / MEASURED as f64;
    (0..=MEASURED).map(|i| nearest(phase(i))).fold(0.0, f64::max).sqrt()
}

/// The outcome of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DyadChainOutcome {
    /// Distinct answers: the accepted ones, the least rms first, then the others. Two answers of one kind differ in their
    /// errors; cognates, which draw the same curve, are of different kinds.
    pub answers: Vec<DyadChainAnswer>,
    /// The best answer of each kind that has one, ordered likewise.
    pub best_of_kinds: Vec<DyadChainAnswer>,
    /// Evaluations used.
    pub evaluations: u64,
    /// Chains that were drawn for starts.
    pub draws: u64,
    /// Fits to all points.
    pub ends: u64,
    /// The rms distance to which each island came, hinges of the limits included, in the order of the islands.
    pub islands: Vec<f64>,
}

/// Orders answers: accepted ones first, the least rms first.
pub(super) fn rank(answers: &mut [DyadChainAnswer]) {
    answers.sort_by(|a, b| b.accepted.cmp(&a.accepted).then(a.rms.total_cmp(&b.rms)));
}
