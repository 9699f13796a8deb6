//! Proportions of a dyad chain in the frame A = 0, B = 1, resolved from parameters of which every value turns fully.
//!
//! With M and m the greatest and the least |X - Y| of a dyad over a turn of the crank,
//!
//! ```text
//! l1 + l2 = M (1 + e^alpha),   l1 - l2 = m tanh beta
//! ```
//!
//! closes the dyad at every phase and never on a dead centre (derived here). For the first dyad this is Grashof's rule with
//! a turning input: M = 1 + p, m = |1 - p|. Parameters: ln p, alpha, beta of the first dyad; xi, eta (two numbers each),
//! alpha, beta of each further one.

use super::extremes::{Extreme, extremes};
use super::grid::Grid;
use super::kinds::{DyadChainKind, MAX_DYADS};
use crate::mechanism::AssemblyMode;
use crate::numbers::arithmetic::{Complex, least_and_greatest};

/// Greatest number of parameters of a shape.
pub const MAX_PARAMETERS: usize = 3 + 6 * (MAX_DYADS - 1);
/// Bounds of the parameters, far beyond any linkage that can be built, so that no number overflows.
const FARTHEST: f64 = 30.0;

/// A shape: the kind of a chain, its assembly, and its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The kind of chain.
    pub kind: DyadChainKind,
    /// Plus: F lies left of the line from X to Y.
    pub assembly: [AssemblyMode; MAX_DYADS],
    /// ln p, alpha, beta; then xi, eta, alpha, beta of each further dyad.
    pub parameters: [f64; MAX_PARAMETERS],
}

/// Returns the number of parameters of the first dyads of a chain.
#[inline(always)]
pub fn parameters_of(dyads: usize) -> usize {
    if dyads == 0 { 0 } else { 6 * dyads - 3 }
}

/// Returns the index of the first parameter of a dyad.
#[inline(always)]
pub fn first_parameter(dyad: usize) -> usize {
    parameters_of(dyad)
}

/// The indices of alpha and beta of a dyad.
#[inline(always)]
pub fn length_parameters(dyad: usize) -> [usize; 2] {
    let end = parameters_of(dyad + 1);
    [end - 2, end - 1]
}

/// The proportions of a chain: places of the ends of each dyad on their bodies, lengths, signs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proportions {
    /// The kind of chain.
    pub kind: DyadChainKind,
    /// xi and eta of each dyad; p and 1 of the first.
    pub anchors: [[Complex; 2]; MAX_DYADS],
    /// |XF| and |YF|.
    pub lengths: [[f64; 2]; MAX_DYADS],
    /// +1: F lies left of the line from X to Y.
    pub signs: [f64; MAX_DYADS],
    /// The least and the greatest |X - Y| over a turn.
    pub extremes: [[Extreme; 2]; MAX_DYADS],
}

impl Shape {
    /// Returns the number of parameters in use.
    #[inline(always)]
    pub fn count(&self) -> usize {
        parameters_of(self.kind.dyads())
    }

    /// Returns the mirrored shape: its curve over phases -phi is the mirror image of this one's over phi.
    #[must_use]
    pub fn mirrored(&self) -> Shape {
        let mut out = *self;
        out.assembly = self.assembly.map(AssemblyMode::opposite);
        for dyad in 1..self.kind.dyads() {
            let at = first_parameter(dyad);
            out.parameters[at + 1] = -out.parameters[at + 1];
            out.parameters[at + 3] = -out.parameters[at + 3];
        }
        out
    }

    /// Returns the places of the ends of the dyads on their bodies.
    #[inline(always)]
    pub fn anchors(&self) -> [[Complex; 2]; MAX_DYADS] {
        let mut anchors = [[Complex::new(0.0, 0.0); 2]; MAX_DYADS];
        let p = self.parameters[0].clamp(-FARTHEST, FARTHEST).exp();
        anchors[0] = [Complex::new(p, 0.0), Complex::new(1.0, 0.0)];
        for (dyad, anchors) in anchors.iter_mut().enumerate().take(self.kind.dyads()).skip(1) {
            let at = first_parameter(dyad);
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.parameters[at + i]);
            *anchors = [Complex::new(a, b), Complex::new(c, d)];
        }
        anchors
    }

    /// Returns the least and the greatest |X - Y| of a dyad at the phases of the grid, where its own lengths do not matter.
    #[inline(always)]
    pub fn sampled_extremes(&self, dyad: usize, grid: &mut Grid) -> [f64; 2] {
        let before = Shape { kind: self.kind.first(dyad), ..*self }.resolve(grid);
        let of = Proportions { kind: self.kind, anchors: self.anchors(), ..before };
        least_and_greatest(grid.distances_sq(&of, dyad).into_iter()).map(f64::sqrt)
    }

    /// Resolves the parameters; the positions of the chain at evenly spaced phases are left in `grid`.
    #[inline(always)]
    pub fn resolve(&self, grid: &mut Grid) -> Proportions {
        let nothing = Extreme { distance: 0.0, at: Complex::new(1.0, 0.0) };
        let mut out = Proportions {
            kind: self.kind,
            anchors: self.anchors(),
            lengths: [[0.0; 2]; MAX_DYADS],
            signs: self.assembly.map(AssemblyMode::sign),
            extremes: [[nothing; 2]; MAX_DYADS],
        };
        grid.start();
        for dyad in 0..self.kind.dyads() {
            let [least, greatest] = extremes(&out, dyad, grid);
            out.extremes[dyad] = [least, greatest];
            let [alpha, beta] = length_parameters(dyad).map(|i| self.parameters[i]);
            let sum = greatest.distance * (1.0 + alpha.clamp(-FARTHEST, FARTHEST).exp());
            let difference = least.distance * beta.tanh();
            out.lengths[dyad] = [0.5 * (sum + difference), 0.5 * (sum - difference)];
            grid.assemble(&out, dyad);
        }
        out
    }
}
