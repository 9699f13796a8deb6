//! Position of the bodies of a dyad chain, dyad by dyad, in the frame A = 0, B = 1.
//!
//! A point of a body is o + xi v with a constant xi: ground (0, 1), crank (0, e), links (X, F - X) and (Y, F - Y). Of a
//! dyad with the lengths l1 = |XF| and l2 = |YF|
//!
//! ```text
//! d = Y - X,  s2 = |d|^2,  u = (1 + (l1^2 - l2^2)/s2)/2,  k = l1^2/s2 - u^2,  F = X + d (u + i t sqrt k)
//! ```
//!
//! (Romero 2016, equations 12 to 15.) One division and one root a dyad; written once for one phase and for eight.

use super::kinds::{CRANK, GROUND, MAX_BODIES, MAX_DYADS};
use super::proportions::Proportions;
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::lane::Lane;

/// The frames (o, v) of all bodies at one phase, or at eight.
#[derive(Clone, Copy, Debug)]
pub struct Frames<L: Lane> {
    /// The origins.
    pub origin: [ComplexLanes<L>; MAX_BODIES],
    /// The directions.
    pub along: [ComplexLanes<L>; MAX_BODIES],
    /// (F - X) x (F - Y) of each dyad.
    pub det: [L; MAX_DYADS],
}

impl<L: Lane> Frames<L> {
    /// Creates the frames of ground and crank at the direction e of the crank; those of links are zero.
    #[inline(always)]
    pub fn of(e: ComplexLanes<L>) -> Self {
        let zero = L::splat(0.0);
        let nothing = ComplexLanes { re: zero, im: zero };
        let (origin, mut along) = ([nothing; MAX_BODIES], [nothing; MAX_BODIES]);
        along[GROUND] = ComplexLanes { re: L::splat(1.0), im: zero };
        along[CRANK] = e;
        Frames { origin, along, det: [zero; MAX_DYADS] }
    }

    /// Returns the point of a body at a constant place.
    #[inline(always)]
    pub fn point(&self, body: usize, place: Complex) -> ComplexLanes<L> {
        self.origin[body] + self.along[body] * ComplexLanes::splat(place)
    }

    /// Returns the ends X and Y of a dyad.
    #[inline(always)]
    pub fn ends(&self, of: &Proportions, dyad: usize) -> [ComplexLanes<L>; 2] {
        let [x, y] = of.kind.anchors(dyad);
        [self.point(x, of.anchors[dyad][0]), self.point(y, of.anchors[dyad][1])]
    }

    /// Computes the links of a dyad; those before it are known. A dyad that is too short is drawn straight.
    #[inline(always)]
    pub fn assemble(&mut self, of: &Proportions, dyad: usize) {
        let [x, y] = self.ends(of, dyad);
        let [l1, l2] = of.lengths[dyad];
        let d = y - x;
        let s2 = d.norm_sq();
        let inverse = s2.recip();
        let half = L::splat(0.5);
        let u = half + half * L::splat((l1 - l2) * (l1 + l2)) * inverse;
        let k = L::splat(l1 * l1) * inverse - u * u;
        let h = L::splat(of.signs[dyad]) * k.positive_part().sqrt();
        let link = ComplexLanes { re: d.re * u - d.im * h, im: d.im * u + d.re * h };
        let (first, second) = (2 + 2 * dyad, 3 + 2 * dyad);
        (self.origin[first], self.along[first]) = (x, link);
        (self.origin[second], self.along[second]) = (y, link - d);
        self.det[dyad] = s2 * h;
    }

    /// Computes all links.
    #[inline(always)]
    pub fn assemble_all(&mut self, of: &Proportions) {
        for dyad in 0..of.kind.dyads() {
            self.assemble(of, dyad);
        }
    }
}
