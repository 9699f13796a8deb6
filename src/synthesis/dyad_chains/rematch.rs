//! Assigns all points anew to phases of a chain, in order, by dynamic programming.
//!
//! With c_ik = |P(phi_k) - T_i|^2 on evenly spaced phases, f_i(k) = c_ik + min over k' <= k of f_{i-1}(k') (derived here;
//! the recursion of Bellman 1957). A closed target starts at the point that has the nearest phase, and ends within a turn.

use super::target::Points;
use crate::mechanism::dyad_chain::kinds::CRANK;
use crate::mechanism::dyad_chain::{DyadChain, Frames, Grid};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES};
use std::f64::consts::TAU;

/// Number of phases that points are assigned to.
const PHASES: usize = 256;
/// A closed target may start at one of this many points.
const STARTS: usize = 16;

/// Buffers of the assignment.
#[derive(Debug)]
pub(super) struct Rematch {
    cranks: Vec<ComplexLanes>,
    curve: [Vec<f64>; 2],
    frames: Frames<F64x8>,
    grid: Grid,
    best: Vec<f64>,
    from: Vec<u16>,
}

impl Default for Rematch {
    fn default() -> Self {
        let crank = |block: usize| {
            let mut e = ComplexLanes::ZERO;
            for lane in 0..LANES {
                e.set(lane, Complex::from_polar(1.0, TAU * (LANES * block + lane) as f64 / PHASES as f64));
            }
            e
        };
        Rematch {
            cranks: (0..PHASES / LANES).map(crank).collect(),
            curve: [vec![0.0; 2 * PHASES], vec![0.0; 2 * PHASES]],
            frames: Frames::of(ComplexLanes::ZERO),
            grid: Grid::default(),
            best: vec![0.0; PHASES + 1],
            from: Vec::new(),
        }
    }
}

impl Rematch {
    /// Replaces the phases by those of the best assignment.
    pub(super) fn assign(&mut self, points: &Points, chain: &DyadChain, phases: &mut [f64]) {
        vectorised(
            #[inline(always)]
            || self.trace(chain),
        );
        let n = points.count;
        let (first, start) = if points.closed { self.nearest(points) } else { (0, opposite(phases)) };
        let width = if points.closed { PHASES + 1 } else { PHASES };
        self.from.resize(n * (PHASES + 1), 0);
        // Twice around, so that a turn from any phase on is one range.
        let (x, y) = (&self.curve[0][start..], &self.curve[1][start..]);
        for i in 0..n {
            let target = points.point((first + i) % n);
            let from = &mut self.from[i * (PHASES + 1)..(i + 1) * (PHASES + 1)];
            let mut least = f64::INFINITY;
            let mut place = 0_u16;
            for k in 0..width {
                let (dx, dy) = (x[k] - target.re, y[k] - target.im);
                let cost = dx * dx + dy * dy;
                if i == 0 {
                    let only = points.closed && k > 0;
                    self.best[k] = if only { f64::INFINITY } else { cost };
                    continue;
                }
                if self.best[k] < least {
                    (least, place) = (self.best[k], k as u16);
                }
                from[k] = place;
                self.best[k] = least + cost;
            }
        }
        let mut k = 0;
        for other in 0..width {
            if self.best[other] < self.best[k] {
                k = other;
            }
        }
        for i in (0..n).rev() {
            let point = (first + i) % n;
            phases[point] = TAU * (start + k) as f64 / PHASES as f64;
            k = usize::from(self.from[i * (PHASES + 1) + k]);
        }
        // The points before the first one come at the end of the turn: a turn back, so that phases rise from point 0 on.
        phases[..first].iter_mut().for_each(|phase| *phase -= TAU);
    }

    #[inline(always)]
    fn trace(&mut self, chain: &DyadChain) {
        let of = chain.shape.resolve(&mut self.grid);
        let [t, s, z] = chain.placement.numbers().map(ComplexLanes::splat);
        let body = chain.shape.kind.traced();
        for (block, e) in self.cranks.iter().enumerate() {
            self.frames.along[CRANK] = *e;
            self.frames.assemble_all(&of);
            let p = t + s * self.frames.origin[body] + z * self.frames.along[body];
            for at in [LANES * block, PHASES + LANES * block] {
                p.re.store(&mut self.curve[0], at);
                p.im.store(&mut self.curve[1], at);
            }
        }
    }

    /// Returns the point, of a few, that is nearest to a phase, and that phase.
    fn nearest(&self, points: &Points) -> (usize, usize) {
        let mut best = (0, 0, f64::INFINITY);
        let step = (points.count / STARTS).max(1);
        for i in (0..points.count).step_by(step) {
            let target = points.point(i);
            for k in 0..PHASES {
                let (x, y) = (self.curve[0][k] - target.re, self.curve[1][k] - target.im);
                let distance = x * x + y * y;
                if distance < best.2 {
                    best = (i, k, distance);
                }
            }
        }
        (best.0, best.1)
    }
}

/// Returns the index of the phase halfway around from the middle of phases.
fn opposite(phases: &[f64]) -> usize {
    let (Some(first), Some(last)) = (phases.first(), phases.last()) else { return 0 };
    let turns = (0.5 * (first + last) / TAU + 0.5).rem_euclid(1.0);
    // NaN becomes 0.
    ((turns * PHASES as f64) as usize).min(PHASES - 1)
}

#[cfg(test)]
mod tests {
    use super::super::target::Target;
    use super::*;
    use crate::mechanism::AssemblyMode;
    use crate::mechanism::dyad_chain::{DyadChainKind, MAX_PARAMETERS, Placement, Shape};

    #[test]
    fn points_of_a_curve_are_assigned_to_their_phases() {
        let mut parameters = [0.0; MAX_PARAMETERS];
        parameters[..9].copy_from_slice(&[-0.9, -0.5, 0.2, 0.6, 0.5, 1.4, -0.6, -0.4, 0.1]);
        let shape = Shape { kind: DyadChainKind::SIX_BARS[0], assembly: [AssemblyMode::Plus; 3], parameters };
        let placement = Placement {
            origin: Complex::new(0.2, 0.1),
            ground: Complex::new(1.0, 0.0),
            pointer: Complex::new(0.4, 0.8),
        };
        let chain = DyadChain { shape, placement };
        // From the 120th of 256 phases on, every fourth; as an open target over three quarters of a turn,
        // through phase zero.
        let curve = chain.curve(PHASES);
        let points: Vec<Complex> = (0..64).map(|i| curve[(120 + 4 * i) % PHASES]).collect();
        for closed in [true, false] {
            let points = if closed { points.clone() } else { points[..50].to_vec() };
            let target = Target::of((&points, closed), None, 100, 64).expect("a target");
            // The chain in the coordinates of the normalised target.
            let [t, s, z] = chain.placement.numbers();
            let placement = Placement {
                origin: (t - target.centre) / target.radius,
                ground: s / target.radius,
                pointer: z / target.radius,
            };
            // Phases so far that are nearly right in the mean.
            let mut phases = vec![TAU * (120 + 2 * points.len()) as f64 / PHASES as f64 + 0.3; points.len()];
            Rematch::default().assign(&target.all[0], &DyadChain { shape, placement }, &mut phases);
            for (i, phase) in phases.iter().enumerate() {
                let wanted = TAU * (120 + 4 * i) as f64 / PHASES as f64;
                let turns = (phase - wanted) / TAU;
                assert!((turns - turns.round()).abs() < 1e-9, "{closed} {i}: {phase} {wanted}");
                assert!(i == 0 || *phase >= phases[i - 1]);
            }
        }
    }
}
