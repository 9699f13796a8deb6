//! Positions of a dyad chain at evenly spaced phases of its crank.

use super::position::Frames;
use super::proportions::Proportions;
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::lane::{F64x8, LANES};
use std::f64::consts::TAU;

/// Number of phases in the turn at which the extremes of |X - Y| are first looked for.
pub const PHASES: usize = 64;
const BLOCKS: usize = PHASES / LANES;

/// The frames of a chain at [`PHASES`] phases, eight together.
#[derive(Clone, Debug)]
pub struct Grid {
    cranks: [ComplexLanes; BLOCKS],
    frames: Vec<Frames<F64x8>>,
}

impl Default for Grid {
    fn default() -> Self {
        let mut cranks = [ComplexLanes::ZERO; BLOCKS];
        for (block, e) in cranks.iter_mut().enumerate() {
            for lane in 0..LANES {
                e.set(lane, Complex::from_polar(1.0, Grid::phase(LANES * block + lane)));
            }
        }
        Grid { cranks, frames: vec![Frames::of(ComplexLanes::ZERO); BLOCKS] }
    }
}

impl Grid {
    /// Returns a phase of the grid, radians.
    #[inline(always)]
    pub fn phase(index: usize) -> f64 {
        TAU * index as f64 / PHASES as f64
    }

    /// Returns the direction of the crank at a phase.
    #[inline(always)]
    pub fn crank(&self, index: usize) -> Complex {
        self.cranks[index / LANES].get(index % LANES)
    }

    /// Puts the crank in its place, before any dyad.
    #[inline(always)]
    pub fn start(&mut self) {
        for (frames, e) in self.frames.iter_mut().zip(&self.cranks) {
            *frames = Frames::of(*e);
        }
    }

    /// Computes the links of a dyad.
    #[inline(always)]
    pub fn assemble(&mut self, of: &Proportions, dyad: usize) {
        for frames in &mut self.frames {
            frames.assemble(of, dyad);
        }
    }

    /// Returns |X - Y|^2 of a dyad at every phase.
    #[inline(always)]
    pub fn distances_sq(&self, of: &Proportions, dyad: usize) -> [f64; PHASES] {
        let mut out = [0.0; PHASES];
        for (block, frames) in self.frames.iter().enumerate() {
            let [x, y] = frames.ends(of, dyad);
            (y - x).norm_sq().store(&mut out, LANES * block);
        }
        out
    }

    /// Returns T + S o + Z v of a body at every phase, x and y.
    #[inline(always)]
    pub fn points(&self, body: usize, [t, s, z]: [Complex; 3]) -> [[f64; PHASES]; 2] {
        let mut out = [[0.0; PHASES]; 2];
        let [t, s, z] = [t, s, z].map(ComplexLanes::splat);
        for (block, frames) in self.frames.iter().enumerate() {
            let p = t + s * frames.origin[body] + z * frames.along[body];
            p.re.store(&mut out[0], LANES * block);
            p.im.store(&mut out[1], LANES * block);
        }
        out
    }
}
