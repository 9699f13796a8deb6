//! Dyad chains: a crank that turns fully, and dyads that hang on it one after the other: four-bars (one dyad), six-bars
//! (two), eight-bars (three).
//!
//! In the frame A = 0, B = 1 a chain is a [`Shape`]; the similarity z -> T + S z takes it to its place, and the traced point
//! is P = T + S o + Z v with the frame (o, v) of its link, so that Z/S is its place on the link. All three enter P linearly.
//!
//! | module | holds |
//! |---|---|
//! | [`conversion`] | the chain as a general [`Chain`](super::chain::Chain) |
//! | [`extremes`] | least and greatest distance between the ends of a dyad over a turn |
//! | [`gradient`] | derivatives by the phase and by the parameters |
//! | [`grid`] | positions at evenly spaced phases |
//! | [`kinds`] | the kinds of chains: which bodies carry the dyads and P |
//! | [`position`] | positions of all bodies, at one phase or at eight |
//! | [`proportions`] | parameters, of which every value turns fully, and what they stand for |
//! | [`sizes`] | distances between the joints of one body |
//! | [`transmission`] | transmission angles |

pub mod conversion;
pub mod extremes;
pub mod gradient;
pub mod grid;
pub mod kinds;
pub mod position;
pub mod proportions;
pub mod sizes;
pub mod transmission;

pub use gradient::{MAX_SLOPES, Rates, Slopes};
pub use grid::Grid;
pub use kinds::{DyadChainKind, MAX_DYADS};
pub use position::Frames;
pub use proportions::{MAX_PARAMETERS, Proportions, Shape};

use crate::mechanism::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::sine::sin_cos;
use std::f64::consts::TAU;

/// The linear part of a chain: P = T + S o + Z v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// T, the fixed pivot A.
    pub origin: Complex,
    /// S, the vector from A to B.
    pub ground: Complex,
    /// Z; Z/S is the place of P on its link.
    pub pointer: Complex,
}

impl Placement {
    /// Returns T, S and Z.
    #[inline(always)]
    pub fn numbers(&self) -> [Complex; 3] {
        [self.origin, self.ground, self.pointer]
    }
}

/// A dyad chain in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadChain {
    /// Kind, assembly and parameters.
    pub shape: Shape,
    /// The similarity that takes it to its place, and the place of P on its link.
    pub placement: Placement,
}

impl DyadChain {
    /// Returns the proportions of the chain.
    pub fn proportions(&self) -> Proportions {
        self.shape.resolve(&mut Grid::default())
    }

    /// Returns the mirror image by the x axis: its point at the crank phase -phi is the conjugate of this one's at phi.
    #[must_use]
    pub fn mirrored(&self) -> DyadChain {
        let [origin, ground, pointer] = self.placement.numbers().map(|z| z.conj());
        DyadChain { shape: self.shape.mirrored(), placement: Placement { origin, ground, pointer } }
    }

    /// Computes P at a phase, the angle of the crank from the line A-B.
    ///
    /// The proportions are those of [`DyadChain::proportions`].
    pub fn point(&self, of: &Proportions, phase: f64) -> Complex {
        let (sin, cos) = sin_cos(phase);
        let mut frames = Frames::<f64>::of(ComplexLanes { re: cos, im: sin });
        frames.assemble_all(of);
        let body = of.kind.traced();
        let number = |z: ComplexLanes<f64>| Complex::new(z.re, z.im);
        let [t, s, z] = self.placement.numbers();
        t + s * number(frames.origin[body]) + z * number(frames.along[body])
    }

    /// Returns the fixed pivots: A, B, and the ends of further dyads on the ground.
    pub fn pivots(&self) -> Vec<Complex> {
        let [origin, ground, _] = self.placement.numbers();
        let anchors = self.shape.anchors();
        let kind = self.shape.kind;
        let mut pivots = vec![origin, origin + ground];
        for (dyad, places) in anchors.into_iter().enumerate().take(kind.dyads()).skip(1) {
            for (body, place) in kind.anchors(dyad).into_iter().zip(places) {
                if body == kinds::GROUND {
                    pivots.push(origin + ground * place);
                }
            }
        }
        pivots
    }

    /// Computes P at `count` evenly spaced phases.
    pub fn curve(&self, count: usize) -> Vec<Complex> {
        let of = self.proportions();
        (0..count).map(|i| self.point(&of, TAU * i as f64 / count as f64)).collect()
    }

    /// Returns the least transmission angle of all dyads over the turn, radians in [0, pi/2].
    pub fn least_transmission(&self) -> f64 {
        self.proportions().least_transmission()
    }
}
