//! Homotopy path tracking of solutions while the displacements move along a straight line: predictor, corrector, step
//! control.
//!
//! ```text
//! F(z(t), delta(t)) = 0,    delta(t) = (1 - t) from + t to,    0 <= t <= 1,    the twins alike
//! ```
//!
//! One step: the polynomial through the last three (z, dz/dt), degree five, is continued to t + h; two full Newton
//! steps e_1, e_2 correct it; dz/dt comes out of the elimination of the second. The step is accepted when e_1 is
//! small and e_2 much smaller still. The next h follows from e_1 ~ h^6. Eight paths are tracked side by side, each
//! with its own t and h; a lane whose path has ended takes the next one. The result of a path depends on that path
//! alone.

use super::equations::{DisplacementLanes, UNKNOWNS, Unknowns, solution, steps, unknowns};
use super::target::{Displacements, STEPS, Solution};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::complex_lanes::{ComplexLanes, ORDER};
use linkwright_arithmetic::dispatch::vectorised;
use linkwright_arithmetic::lane::{F64x8, LANES, Lane};
use std::ops::Add;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The parameters of the step control: the acceptance and length of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// The largest first Newton step of an accepted step, relative to the unknowns.
    pub accept: f64,
    /// The largest ratio of the second Newton step to the first.
    pub contraction: f64,
    /// The first Newton step that the step control aims at.
    pub aim: f64,
    /// The length of the first step, in t.
    pub first_step: f64,
    /// The length of the longest step, in t.
    pub longest_step: f64,
    /// The shortest step, relative to the rest of the path: a path whose step falls below it, or below 1e-13, has met
    /// a singularity.
    pub shortest_step: f64,
    /// The number of steps, accepted or not, after which a path is given up.
    pub most_steps: u32,
}

impl Default for Parameters {
    fn default() -> Self {
        Parameters {
            accept: 1e-2,
            contraction: 0.1,
            aim: 1e-3,
            first_step: 0.01,
            longest_step: 0.1,
            shortest_step: 1e-7,
            most_steps: 600,
        }
    }
}

impl Parameters {
    /// Returns tighter parameters for paths that were lost, or came too near one another, at the tolerances before:
    /// `round` = 1, 2, ..
    pub fn tightened(&self, round: u32) -> Parameters {
        let factor = 0.05_f64.powi(round as i32);
        Parameters {
            accept: self.accept * factor,
            aim: self.aim * factor,
            first_step: self.first_step * 0.3_f64.powi(round as i32),
            longest_step: self.longest_step * 0.5_f64.powi(round as i32),
            shortest_step: self.shortest_step * 0.1_f64.powi(round as i32),
            most_steps: self.most_steps * (1 << round),
            ..*self
        }
    }
}

/// A straight line in the space of displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The displacements at t = 0.
    pub from: Displacements,
    /// The displacements at t = 1.
    pub to: Displacements,
}

impl Segment {
    /// Returns the derivative of the displacements by t.
    pub(super) fn velocity(&self) -> Displacements {
        self.to.zip(&self.from, |to, from| to - from)
    }

    /// Returns the displacements at a complex t.
    pub(super) fn at(&self, t: Complex) -> Displacements {
        self.from.zip(&self.to, |from, to| from * (-t + 1.0) + to * t)
    }
}

/// The reason for which a path ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// The path arrived at t = 1.
    Arrived,
    /// Its steps became too short at `t`.
    Stalled {
        /// The t that the path reached.
        t: f64,
    },
    /// Too many steps; it got as far as `t`.
    OutOfSteps {
        /// The t that the path reached.
        t: f64,
    },
    /// The caller cancelled the tracking.
    Cancelled,
}

/// The end of one path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// The reason for which it ended.
    pub ending: Ending,
    /// The solution at its end.
    pub solution: Solution,
    /// The number of steps, accepted or not.
    pub steps: u32,
}

/// The number of nodes that the predictor remembers.
pub const NODES: usize = 3;

/// The predictor's data of eight paths, the newest node first.
struct State {
    values: [Unknowns; NODES],
    tangents: [Unknowns; NODES],
    /// The values of t at the nodes.
    t: [[f64; NODES]; LANES],
    /// The number of nodes.
    nodes: [usize; LANES],
    /// The length of the next step, in t.
    h: [f64; LANES],
    steps: [u32; LANES],
    /// The index of the path in each lane.
    path: [Option<usize>; LANES],
}

/// Computes the weights of values and tangents that continue the Hermite polynomial through `nodes` to t.
#[inline(always)]
pub fn continuation(t: f64, nodes: &[f64]) -> ([f64; NODES], [f64; NODES]) {
    let (mut of_value, mut of_tangent) = ([0.0; NODES], [0.0; NODES]);
    for (i, &node) in nodes.iter().enumerate() {
        let (mut lagrange, mut slope) = (1.0, 0.0);
        for (k, &other) in nodes.iter().enumerate() {
            if k != i {
                let gap = 1.0 / (node - other);
                lagrange *= (t - other) * gap;
                slope += gap;
            }
        }
        let square = lagrange * lagrange;
        of_value[i] = (1.0 - 2.0 * slope * (t - node)) * square;
        of_tangent[i] = (t - node) * square;
    }
    (of_value, of_tangent)
}

/// Computes the relative change, lane by lane, squared: the sum of |dz_i|^2 / (|z_i|^2 + FLOOR), with T_j in place of
/// tau_j. It is not finite if a step is not.
#[inline(always)]
pub(super) fn change_sq(step: &Unknowns, of: &Unknowns) -> F64x8 {
    let one = ComplexLanes::splat(Complex::ONE);
    let mut sum = F64x8([0.0; LANES]);
    for (i, (step, z)) in step.iter().zip(of).enumerate() {
        let z = if i < ORDER { *z } else { *z + one };
        sum = sum + step.norm_sq() * (z.norm_sq() + F64x8([FLOOR; LANES])).recip();
    }
    sum
}

/// The square of the size below which the change of an unknown is not measured relative to it.
const FLOOR: f64 = 1e-4;

impl State {
    fn new() -> Self {
        let zero = [ComplexLanes::ZERO; UNKNOWNS];
        State {
            values: [zero; NODES],
            tangents: [zero; NODES],
            t: [[0.0; NODES]; LANES],
            nodes: [0; LANES],
            h: [0.0; LANES],
            steps: [0; LANES],
            path: [None; LANES],
        }
    }

    /// Puts a path into a lane. Until its first step, of length zero, it has no tangent.
    fn start(&mut self, lane: usize, path: usize, at: &Solution) {
        for (value, z) in self.values[0].iter_mut().zip(unknowns(at)) {
            value.set(lane, z);
        }
        for tangent in &mut self.tangents[0] {
            tangent.set(lane, Complex::default());
        }
        self.t[lane] = [0.0; NODES];
        (self.nodes[lane], self.h[lane], self.steps[lane]) = (0, 0.0, 0);
        self.path[lane] = Some(path);
    }

    /// Predicts the point of the next step; returns it with its t.
    #[expect(clippy::needless_range_loop, reason = "indices follow the equations and the lanes")]
    #[inline(always)]
    fn predicted(&self) -> (Unknowns, [f64; LANES]) {
        let mut weights = [[F64x8([0.0; LANES]); NODES]; 2];
        let mut to = [0.0; LANES];
        for lane in 0..LANES {
            to[lane] = self.t[lane][0] + self.h[lane];
            let (values, tangents) = continuation(to[lane], &self.t[lane][..self.nodes[lane].max(1)]);
            for node in 0..NODES {
                weights[0][node].0[lane] = values[node];
                weights[1][node].0[lane] = tangents[node];
            }
        }
        let mut z = [ComplexLanes::ZERO; UNKNOWNS];
        for (i, z) in z.iter_mut().enumerate() {
            for node in 0..NODES {
                *z = *z
                    + self.values[node][i].scale(weights[0][node])
                    + self.tangents[node][i].scale(weights[1][node]);
            }
        }
        (z, to)
    }

    /// Stores the new node in the lanes where `keep` is one.
    #[inline(always)]
    fn remember(&mut self, keep: F64x8, z: &Unknowns, tangent: &Unknowns) {
        let half = F64x8([0.5; LANES]);
        for i in 0..UNKNOWNS {
            for (nodes, new) in [(&mut self.values, z[i]), (&mut self.tangents, tangent[i])] {
                nodes[2][i] = ComplexLanes::where_at_least(keep, half, nodes[1][i], nodes[2][i]);
                nodes[1][i] = ComplexLanes::where_at_least(keep, half, nodes[0][i], nodes[1][i]);
                nodes[0][i] = ComplexLanes::where_at_least(keep, half, new, nodes[0][i]);
            }
        }
    }

    fn solution(&self, lane: usize) -> Solution {
        solution(&std::array::from_fn(|i| self.values[0][i].get(lane)))
    }

    /// Accepts or rejects a lane's step and chooses the next; returns whether it was accepted, and the ending if the
    /// path ended.
    fn judge(&mut self, lane: usize, to: f64, e: [f64; 2], with: &Parameters) -> (bool, Option<Ending>) {
        let t = &mut self.t[lane];
        self.steps[lane] += 1;
        let first = self.nodes[lane] == 0;
        let good = e[0] <= with.accept && (first || e[1] <= with.contraction * e[0] || e[1] <= ROUNDING);
        if good {
            if !first {
                *t = [to, t[0], t[1]];
            }
            self.nodes[lane] = (self.nodes[lane] + 1).min(NODES);
            if to >= 1.0 {
                return (true, Some(Ending::Arrived));
            }
        }
        let order = 2 * self.nodes[lane].max(1);
        let wanted = (with.aim / e[0].max(1e-12)).powf(1.0 / order as f64);
        self.h[lane] = if first {
            if good { with.first_step } else { 0.0 }
        } else if good {
            (self.h[lane] * wanted.clamp(0.4, 2.5)).min(with.longest_step)
        } else {
            self.h[lane] * if wanted.is_finite() { wanted.clamp(0.2, 0.6) } else { 0.3 }
        };
        let left = 1.0 - self.t[lane][0];
        let h = self.h[lane];
        if self.steps[lane] >= with.most_steps {
            return (good, Some(Ending::OutOfSteps { t: self.t[lane][0] }));
        }
        if h < with.shortest_step * left || h < 1e-13 {
            return (good, Some(Ending::Stalled { t: self.t[lane][0] }));
        }
        if h >= left {
            self.h[lane] = left;
        } else if 2.0 * h > left {
            self.h[lane] = 0.5 * left;
        }
        (good, None)
    }
}

/// The size below which a second Newton step need not be smaller than the first: near infinity rounding keeps both at
/// this level.
const ROUNDING: f64 = 1e-6;

/// Computes the displacements at each lane's t.
#[inline(always)]
fn displaced(from: &DisplacementLanes, velocity: &DisplacementLanes, t: F64x8) -> DisplacementLanes {
    let mut at = *from;
    for j in 0..STEPS {
        at.delta[j] = from.delta[j] + velocity.delta[j].scale(t);
        at.starred[j] = from.starred[j] + velocity.starred[j].scale(t);
    }
    at
}

/// Tracks every start along the segment on the threads of the current pool; returns the ends in the order of the
/// starts.
///
/// Deterministic: a path's digits do not depend on threads or lanes. Once `cancel` is set, the remaining paths end as
/// [`Ending::Cancelled`].
pub fn track(starts: &[Solution], along: &Segment, with: &Parameters, cancel: &AtomicBool) -> Vec<Tracked> {
    let next = AtomicUsize::new(0);
    let workers = rayon::current_num_threads().min(starts.len().div_ceil(LANES)).max(1);
    let work = || vectorised(|| worker(starts, along, with, &next, cancel));
    let parts: Vec<Vec<(usize, Tracked)>> = if workers == 1 {
        vec![work()]
    } else {
        use rayon::prelude::*;
        (0..workers).into_par_iter().map(|_| work()).collect()
    };
    let lost = |solution: &Solution| Tracked { ending: Ending::Cancelled, solution: *solution, steps: 0 };
    let mut all: Vec<Tracked> = starts.iter().map(lost).collect();
    for (path, tracked) in parts.into_iter().flatten() {
        all[path] = tracked;
    }
    all
}

/// Tracks paths in the eight lanes of one thread until none is left.
#[expect(clippy::needless_range_loop, reason = "indices follow the equations and the lanes")]
#[inline(always)]
fn worker(
    starts: &[Solution],
    along: &Segment,
    with: &Parameters,
    next: &AtomicUsize,
    cancel: &AtomicBool,
) -> Vec<(usize, Tracked)> {
    let mut done = Vec::new();
    let mut state = Box::new(State::new());
    let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&path| path < starts.len());
    let refill = |state: &mut State, lane: usize| match take() {
        Some(path) => state.start(lane, path, &starts[path]),
        None => state.path[lane] = None,
    };
    for lane in 0..LANES {
        refill(&mut state, lane);
    }
    let from = along.from.map(ComplexLanes::splat);
    let velocity = along.velocity().map(ComplexLanes::splat);
    while state.path.iter().any(Option::is_some) && !cancel.load(Ordering::Relaxed) {
        let (mut z, to) = state.predicted();
        let at = displaced(&from, &velocity, F64x8(to));
        let ([first], _) = steps::<1>(&z, &at, &velocity);
        let e_1 = change_sq(&first, &z);
        add(&mut z, &first);
        let ([second, tangent], _) = steps::<2>(&z, &at, &velocity);
        let e_2 = change_sq(&second, &z);
        add(&mut z, &second);
        let mut keep = F64x8([0.0; LANES]);
        let mut endings = [None; LANES];
        for lane in 0..LANES {
            if state.path[lane].is_some() {
                let (good, ending) =
                    state.judge(lane, to[lane], [e_1.0[lane].sqrt(), e_2.0[lane].sqrt()], with);
                keep.0[lane] = if good { 1.0 } else { 0.0 };
                endings[lane] = ending;
            }
        }
        state.remember(keep, &z, &tangent);
        for lane in 0..LANES {
            if let (Some(path), Some(ending)) = (state.path[lane], endings[lane]) {
                let solution = state.solution(lane);
                done.push((path, Tracked { ending, solution, steps: state.steps[lane] }));
                refill(&mut state, lane);
            }
        }
    }
    done
}

#[inline(always)]
pub(super) fn add<Z: Copy + Add<Output = Z>>(z: &mut [Z; UNKNOWNS], step: &[Z; UNKNOWNS]) {
    for (z, step) in z.iter_mut().zip(step) {
        *z = *z + *step;
    }
}

const _: () = assert!(ORDER == STEPS);
