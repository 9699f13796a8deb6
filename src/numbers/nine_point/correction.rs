//! Newton's method at fixed displacements, eight solutions at once.

use super::equations::{UNKNOWNS, solution, steps, unknowns};
use super::target::Solution;
use super::tracker::{Segment, add, change_sq};
use linkwright_arithmetic::complex_lanes::ComplexLanes;
use linkwright_arithmetic::dispatch::vectorised;
use linkwright_arithmetic::lane::{F64x8, LANES};
use rayon::prelude::*;

/// A solution corrected by Newton's method at fixed displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corrected {
    /// The solution after the last Newton step.
    pub solution: Solution,
    /// The relative size of the last Newton step.
    pub newton_step: f64,
    /// The relative size of dz/dt along `velocity`: infinite or huge if the solution is singular.
    pub speed: f64,
    /// The smallest pivot of the elimination: near rounding if the solution is singular.
    pub pivot: f64,
    /// The largest modulus of the solution's unknowns.
    pub size: f64,
}

/// Applies `most` Newton steps, at least one, at t = 1 of the segment.
pub fn correct(ends: &[Solution], along: &Segment, most: usize) -> Vec<Corrected> {
    let correct = |chunk: &[Solution]| {
        vectorised(|| {
            let at = along.to.map(ComplexLanes::splat);
            let velocity = along.velocity().map(ComplexLanes::splat);
            let mut z = [ComplexLanes::ZERO; UNKNOWNS];
            for lane in 0..LANES {
                let from = unknowns(&chunk[lane.min(chunk.len() - 1)]);
                for (z, from) in z.iter_mut().zip(from) {
                    z.set(lane, from);
                }
            }
            let [mut change, mut speed, mut pivot] = [F64x8([f64::INFINITY; LANES]); 3];
            for _ in 0..most.max(1) {
                let ([step, tangent], smallest) = steps::<2>(&z, &at, &velocity);
                add(&mut z, &step);
                change = change_sq(&step, &z);
                speed = change_sq(&tangent, &z);
                pivot = smallest;
            }
            let corrected = |lane: usize| Corrected {
                solution: solution(&std::array::from_fn(|i| z[i].get(lane))),
                newton_step: change.0[lane].sqrt(),
                speed: speed.0[lane].sqrt(),
                pivot: pivot.0[lane].sqrt(),
                size: z.iter().map(|z| z.get(lane).norm()).fold(0.0, f64::max),
            };
            (0..chunk.len()).map(corrected).collect::<Vec<_>>()
        })
    };
    ends.par_chunks(LANES).flat_map_iter(correct).collect()
}
