//! Starts of function generation: linkages whose linear equation error is least, and drawn ones.
//!
//! With the ground link 1 and the angles phi_j = phi_0 + dphi_j, psi_j = psi_0 + s dpsi_j from the ground line, Freudenstein's
//! equation
//!
//! ```text
//! K1 cos psi_j - K2 cos phi_j + K3 = cos(phi_j - psi_j),    K1 = 1/p,  K2 = 1/r,  K3 = (p^2 + r^2 + 1 - q^2) / (2 p r)
//! ```
//!
//! is linear in K at given offsets. Its least-squares solution over a grid of both offsets gives linkages near every good
//! one, if each equation is weighted by the inverse of its derivative by psi_j, which makes an equation error an error of
//! the output: a first solution gives the derivative, a second one the linkage. A negative p or r is the positive length at
//! an offset that is half a turn greater. Where ranges are free, the grid has a few scales of inputs and outputs too, and a
//! drawn start has drawn ones. (Freudenstein 1955, An analytical approach to the design of four-link mechanisms.)

use crate::mechanism::{AssemblyMode, Complex, CouplerSide, Dyad, Pose};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::dyads::through_five;
use crate::task::forms::design_space::{DesignSpace, Shape};
use crate::task::forms::rows::nearest_type;
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::ranges::{Ranges, Scales};
use crate::task::spec::Limits;
use crate::task::{AngleOffset, Link, Problem, Setting, Timing};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// Steps of half a turn of the grid of offsets.
const GRID: usize = 24;
/// The same where ranges are free, and the steps of each free range, evenly in its logarithm.
const RANGED_GRID: usize = 12;
const RANGE_STEPS: usize = 4;
/// The most pairs that enter the linear solutions, evenly chosen.
const MOST_PAIRS: usize = 48;
/// One drawn start in so many has random lengths; the others have random offsets.
const RANDOM_EVERY: usize = 3;
/// Distance of pin and pivot from the origin, in lengths of the ground, below which a dyad is the ground itself.
const IN_THE_ORIGIN: f64 = 1e-6;
/// One drawn start with random offsets in so many passes through random pairs exactly.
const EXACT_EVERY: usize = 2;

/// A generator of starts for a function.
#[derive(Clone, Debug)]
pub(super) struct FunctionStarts<'a> {
    problem: &'a Problem,
    space: DesignSpace,
    /// The written inputs and outputs of the pairs that enter the linear solutions, radians.
    angles: Vec<[f64; 2]>,
    /// The same as directions e^{i h dphi_j} and e^{i k dpsi_j}, in the middle of the ranges.
    pairs: Vec<[Complex; 2]>,
    ranges: Ranges,
    /// The shape in the middle of the design space, whose pivots starts have.
    middle: Shape,
    /// Whether the offsets of inputs and outputs are free.
    free: [bool; 2],
}

impl<'a> FunctionStarts<'a> {
    /// Creates the generator of a problem; `None` if it is no function.
    pub(super) fn new(problem: &'a Problem) -> Option<Self> {
        let task = problem.task();
        let body = task.body().filter(|_| task.is_function())?;
        let Timing::Prescribed { crank_angles, .. } = task.timing() else { return None };
        let n = crank_angles.len();
        let every = n.div_ceil(MOST_PAIRS);
        let of = |j: usize| Some([crank_angles[j], body.angles[j]?]);
        // The last pair too.
        let last = ((n - 1) % every != 0).then_some(n - 1);
        let angles: Vec<[f64; 2]> = (0..n).step_by(every).chain(last).filter_map(of).collect();
        let space = problem.space(problem.sides()[0]);
        let middle = space.bounds().map(|(low, high)| if low.is_finite() { 0.5 * (low + high) } else { 0.0 });
        let middle = space.shape(&middle)?;
        let Link::Output { offset, .. } = body.link else { return None };
        let output_is_free = offset == AngleOffset::Free;
        Some(FunctionStarts {
            problem,
            space,
            pairs: turned(&angles, body.ranges().middle()),
            angles,
            ranges: body.ranges(),
            middle,
            free: [problem.offset_is_free(), output_is_free],
        })
    }

    /// Returns the starts at the least equation errors over the grid of offsets, the least first.
    pub(super) fn of_grid(&self) -> Vec<Start> {
        let grid = if self.ranges.are_written() { GRID } else { RANGED_GRID };
        let step = PI / grid as f64;
        let steps = self.free.map(|free| if free { grid } else { 1 });
        let mut minima: Vec<(f64, Start)> = Vec::new();
        let all = self.scales_of_grid().into_iter().map(|scales| (scales, turned(&self.angles, scales)));
        let signs = self.problem.directions();
        let all = all.flat_map(|at| signs.iter().map(move |sign| (*sign, at.clone())));
        for (sign, (scales, pairs)) in all {
            let at = |i: usize, j: usize| {
                self.solution((&pairs, scales), sign, [i as f64 * step, j as f64 * step], None)
            };
            let cells: Vec<Option<Solution>> =
                (0..steps[0] * steps[1]).map(|k| at(k / steps[1], k % steps[1])).collect();
            let error = |i: usize, j: usize| {
                cells[i % steps[0] * steps[1] + j % steps[1]].map_or(f64::INFINITY, |cell| cell.error)
            };
            for (k, cell) in cells.iter().enumerate() {
                let Some(cell) = cell else { continue };
                let (i, j) = (k / steps[1] + steps[0], k % steps[1] + steps[1]);
                let around = [(1, 0), (1, 1), (1, 2), (0, 1), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)];
                let is_least = around.iter().all(|(di, dj)| error(i + di - 1, j + dj - 1) >= cell.error);
                if is_least && let Some(start) = self.start(&pairs, sign, cell) {
                    minima.push((cell.error, start));
                }
            }
        }
        minima.extend(self.of_five_pairs().into_iter().map(|start| (0.0, start)));
        minima.sort_by(|one, other| one.0.total_cmp(&other.0));
        minima.into_iter().map(|(_, start)| start).collect()
    }

    /// Returns every linkage through five pairs whose offsets are both free; none of other problems.
    ///
    /// The input link as it is seen from the output link takes the poses P_j = -conj(f_j), Q_j = e_j conj(f_j), e_j and f_j the
    /// directions of input and output. One of its four dyads is the ground, with pin and pivot in the origin; every other one is
    /// a coupler: p e^{i phi_0} its pin, r e^{i psi_0} its pivot, q its length.
    fn of_five_pairs(&self) -> Vec<Start> {
        let (Some(pairs), [true, true], true) =
            (self.pairs.first_chunk::<5>(), self.free, self.ranges.are_written() && self.pairs.len() == 5)
        else {
            return Vec::new();
        };
        let mut starts = Vec::new();
        for &sign in self.problem.directions() {
            let poses = pairs.map(|[e, f]| {
                let back = if sign < 0.0 { f } else { f.conj() };
                Pose { position: -back, direction: e * back }
            });
            for dyad in through_five(&poses) {
                let Dyad::RR { pin, pivot, length } = dyad else { continue };
                if pin.norm().max(pivot.norm()) < IN_THE_ORIGIN {
                    continue;
                }
                let lengths = [pin.norm(), length, pivot.norm()];
                let offsets = [pin.arg(), pivot.arg()];
                let solution = Solution { lengths, offsets, scales: AS_WRITTEN, error: 0.0 };
                starts.extend(self.start(&self.pairs, sign, &solution));
            }
        }
        starts
    }

    /// Returns the scales of inputs and outputs of the grid: the middles of even steps of the free ranges.
    fn scales_of_grid(&self) -> Vec<Scales> {
        let of = |(low, high): (f64, f64)| -> Vec<f64> {
            if low == high {
                return vec![low];
            }
            let part = |i: usize| (i as f64 + 0.5) / RANGE_STEPS as f64;
            (0..RANGE_STEPS).map(|i| low * (high / low).powf(part(i))).collect()
        };
        let [inputs, outputs] = self.ranges.bounds().map(of);
        inputs.iter().flat_map(|input| outputs.iter().map(|output| [*input, *output])).collect()
    }

    /// Draws a start; `None` if nothing can be made of the draw.
    pub(super) fn draw(&self, draws: &mut Stream) -> Option<Start> {
        let signs = self.problem.directions();
        let sign = signs[below(draws, signs.len())];
        let offsets = self.free.map(|free| if free { uniform(draws, 0.0, TAU) } else { 0.0 });
        let written = self.ranges.are_written();
        let scales = self.ranges.bounds().map(|(low, high)| match low < high {
            true => uniform(draws, low.ln(), high.ln()).exp(),
            false => low,
        });
        let of_scales = if written { Vec::new() } else { turned(&self.angles, scales) };
        let pairs = if written { &self.pairs } else { &of_scales };
        if below(draws, RANDOM_EVERY) > 0 {
            let n = self.pairs.len();
            let through = (below(draws, EXACT_EVERY) == 0).then(|| {
                let number = below(draws, usize::MAX >> 1);
                [number % n, (number / n) % n, (number / n / n) % n]
            });
            return self.start(pairs, sign, &self.solution((pairs, scales), sign, offsets, through)?);
        }
        let ground = self.ground().norm();
        let limits = self.space.link_limits();
        let mut length = |limits: Limits| {
            let low = limits.0.max(1e-3 * ground);
            (uniform(draws, low.ln(), limits.1.min(1e3 * ground).max(low).ln())).exp() / ground
        };
        let [crank, coupler, follower] = [length(limits[1]), length(limits[2]), length(limits[3])];
        self.start(
            pairs,
            sign,
            &Solution { lengths: [crank, coupler, follower], offsets, scales, error: 0.0 },
        )
    }

    /// Returns the linear solution at offsets, of all pairs at their scales or exactly through three of them; `None` if it is no
    /// linkage.
    fn solution(
        &self,
        (pairs, scales): (&[[Complex; 2]], Scales),
        sign: f64,
        offsets: [f64; 2],
        through: Option<[usize; 3]>,
    ) -> Option<Solution> {
        let turns = offsets.map(|offset| Complex::from_polar(1.0, offset));
        let all = || turned_pairs(pairs, sign, turns);
        let k = match through {
            Some(chosen) => solved(chosen.iter().filter_map(|j| all().nth(*j)).map(|pair| (pair, 1.0)))?,
            None => {
                let first = solved(all().map(|pair| (pair, 1.0)))?;
                let weighted = all().map(|pair| {
                    let slope = slope(&first, pair);
                    (pair, 1.0 / (slope * slope).max(LEAST_SLOPE))
                });
                solved(weighted)?
            }
        };
        let [p, r] = [1.0 / k[0], 1.0 / k[1]];
        let q_sq = p * p + r * r + 1.0 - 2.0 * p * r * k[2];
        if !(q_sq > 0.0 && q_sq.is_finite() && p.is_finite() && r.is_finite()) {
            return None;
        }
        let error: f64 = all()
            .map(|pair| {
                let slope = slope(&k, pair);
                let [e, f] = pair;
                let equation = k[0] * f.re - k[1] * e.re + k[2] - (e * f.conj()).re;
                (equation * equation) / (slope * slope).max(LEAST_SLOPE)
            })
            .sum();
        let mut turned = offsets;
        for ((offset, length), free) in turned.iter_mut().zip([p, r]).zip(self.free) {
            if length < 0.0 {
                if !free {
                    return None;
                }
                *offset += PI;
            }
        }
        let error = error / (scales[1] * scales[1]);
        Some(Solution { lengths: [p.abs(), q_sq.sqrt(), r.abs()], offsets: turned, scales, error })
    }

    /// Returns the vector from A to B.
    fn ground(&self) -> Complex {
        self.middle.follower_pivot - self.middle.crank_pivot
    }

    /// Returns the start at a solution, in the assembly whose follower lies nearer at the middle pair.
    fn start(&self, pairs: &[[Complex; 2]], sign: f64, solution: &Solution) -> Option<Start> {
        let Solution { lengths: [p, q, r], offsets, scales, .. } = *solution;
        let turns = offsets.map(|offset| Complex::from_polar(1.0, offset));
        let [e, f] = turned_pairs(pairs, sign, turns).nth(pairs.len() / 2)?;
        // D lies left of the line from C to B if t1 = 1; its place for the follower's angle that is wanted tells.
        let (c, d) = (e * p, Complex::new(1.0, 0.0) + f * r);
        let left = ((Complex::new(1.0, 0.0) - c).conj() * (d - c)).im;
        let assembly = if left < 0.0 { AssemblyMode::Minus } else { AssemblyMode::Plus };
        let ground = self.ground().norm();
        let [crank, coupler, follower] = [p, q, r].map(|length| length * ground);
        let shape = Shape { crank, coupler, follower, offset: Complex::new(coupler, 0.0), ..self.middle };
        let types = self.problem.types();
        let aim = if types.is_empty() { None } else { nearest_type(shape.links(), types) };
        let setting = Setting { aim, assembly, direction: sign, side: CouplerSide::Plus };
        let offset = if self.free[0] { offsets[0] + self.ground().arg() } else { 0.0 };
        Some(Start { design: self.space.design(&shape, offset), setting, positions: Vec::new(), scales })
    }
}

/// The least square of a derivative by the output that a weight is made of: at a toggle there is none.
const LEAST_SLOPE: f64 = 1e-4;

/// The lengths of crank, coupler and follower over the ground, and the offsets of both angles.
#[derive(Clone, Copy, Debug)]
struct Solution {
    lengths: [f64; 3],
    offsets: [f64; 2],
    scales: Scales,
    /// The sum of squared errors of the output, to first order, in parts of its scale.
    error: f64,
}

/// Returns the directions of inputs and outputs (radians) at scales.
fn turned(angles: &[[f64; 2]], [h, k]: Scales) -> Vec<[Complex; 2]> {
    let direction = |angle: f64| Complex::from_polar(1.0, angle);
    angles.iter().map(|[input, output]| [direction(h * input), direction(k * output)]).collect()
}

/// Returns pairs as directions of crank and follower from the ground line.
fn turned_pairs(
    pairs: &[[Complex; 2]],
    sign: f64,
    [crank, follower]: [Complex; 2],
) -> impl Iterator<Item = [Complex; 2]> {
    pairs.iter().map(move |[e, f]| [e * crank, if sign < 0.0 { f.conj() } else { *f } * follower])
}

/// Returns the derivative of Freudenstein's equation by the output angle.
fn slope(k: &Vector3<f64>, [e, f]: [Complex; 2]) -> f64 {
    -k[0] * f.im - (e * f.conj()).im
}

/// Returns the weighted least-squares solution (K1, K2, K3) of Freudenstein's equation; `None` if the equations do not
/// determine it.
fn solved(pairs: impl Iterator<Item = ([Complex; 2], f64)>) -> Option<Vector3<f64>> {
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for ([e, f], weight) in pairs {
        let row = Vector3::new(f.re, -e.re, 1.0);
        matrix += row * row.transpose() * weight;
        right += row * ((e * f.conj()).re * weight);
    }
    matrix.cholesky().map(|factors| factors.solve(&right)).filter(|k| k.iter().all(|x| x.is_finite()))
}
