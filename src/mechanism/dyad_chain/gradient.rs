//! Derivatives of the frames of a dyad chain by the phase of the crank and by the parameters of its shape.
//!
//! With f1 = F - X, f2 = F - Y and det = f1 x f2, for any parameter or the phase,
//!
//! ```text
//! r1 = l1 l1' + <f1, X'>,  r2 = l2 l2' + <f2, Y'>,  F' = ((r1 f2y - r2 f1y), (f1x r2 - f2x r1)) / det
//! X' = o' + xi v' (+ xi' v),                        M' = <X - Y, X' - Y'> / M   at the extreme's phase
//! ```
//!
//! (derived here: both distances of F differentiated; the last by the envelope theorem). det is zero on a dead centre: it is
//! bounded below by 1e-7 l1 l2.

use super::kinds::{CRANK, GROUND, MAX_BODIES, MAX_DYADS};
use super::position::Frames;
use super::proportions::{
    MAX_PARAMETERS, Proportions, Shape, first_parameter, length_parameters, parameters_of,
};
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::lane::Lane;

/// The least |det| over l1 l2.
const LEAST_SINE: f64 = 1e-7;
/// Greatest number of derivatives: the phase, then the parameters.
pub const MAX_SLOPES: usize = 1 + MAX_PARAMETERS;

/// Derivatives of the lengths and of the extremes of a chain by its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Rates {
    /// l1' and l2' of each dyad.
    pub lengths: [[[f64; MAX_PARAMETERS]; 2]; MAX_DYADS],
    /// m' and M' of each dyad.
    pub extremes: [[[f64; MAX_PARAMETERS]; 2]; MAX_DYADS],
}

impl Rates {
    /// All zero.
    pub const NONE: Rates = Rates {
        lengths: [[[0.0; MAX_PARAMETERS]; 2]; MAX_DYADS],
        extremes: [[[0.0; MAX_PARAMETERS]; 2]; MAX_DYADS],
    };

    /// Computes the rates of a shape with the given proportions.
    #[inline(always)]
    pub fn of(shape: &Shape, of: &Proportions) -> Rates {
        let mut rates = Rates::NONE;
        for dyad in 0..of.kind.dyads() {
            for (end, extreme) in of.extremes[dyad].iter().enumerate() {
                if dyad == 0 {
                    let p = of.anchors[0][0].re;
                    rates.extremes[0][end][0] = if end == 1 || p > 1.0 { p } else { -p };
                    continue;
                }
                let e = ComplexLanes { re: extreme.at.re, im: extreme.at.im };
                let mut frames = Frames::<f64>::of(e);
                let mut slopes = Slopes::<f64, MAX_SLOPES>::of(e);
                for before in 0..dyad {
                    frames.assemble(of, before);
                    slopes.differentiate(of, &rates, before, &frames, parameters_of(before + 1));
                }
                let [x, y] = frames.ends(of, dyad);
                let d = x - y;
                let along = |of: ComplexLanes<f64>| (d.re * of.re + d.im * of.im) / extreme.distance;
                let own = first_parameter(dyad);
                for k in 0..own {
                    let [dx, dy] = slopes.ends(of, dyad, k + 1);
                    rates.extremes[dyad][end][k] = along(dx - dy);
                }
                let [bx, by] = of.kind.anchors(dyad).map(|body| frames.along[body]);
                let turned = |z: ComplexLanes<f64>| ComplexLanes { re: -z.im, im: z.re };
                rates.extremes[dyad][end][own] = along(bx);
                rates.extremes[dyad][end][own + 1] = along(turned(bx));
                rates.extremes[dyad][end][own + 2] = -along(by);
                rates.extremes[dyad][end][own + 3] = -along(turned(by));
            }
            let [alpha, beta] = length_parameters(dyad);
            let [least, greatest] = of.extremes[dyad].map(|extreme| extreme.distance);
            let [grown, share] = [shape.parameters[alpha].exp(), shape.parameters[beta].tanh()];
            for k in 0..parameters_of(dyad + 1) {
                let mut sum = rates.extremes[dyad][1][k] * (1.0 + grown);
                let mut difference = rates.extremes[dyad][0][k] * share;
                if k == alpha {
                    sum += greatest * grown;
                } else if k == beta {
                    difference += least * (1.0 - share * share);
                }
                rates.lengths[dyad][0][k] = 0.5 * (sum + difference);
                rates.lengths[dyad][1][k] = 0.5 * (sum - difference);
            }
        }
        rates
    }
}

/// Derivatives of the frames (o, v) of all bodies by the phase (index 0) and by the parameters (from index 1).
#[derive(Clone, Debug)]
pub struct Slopes<L: Lane, const N: usize> {
    /// The derivatives of the origins.
    pub origin: [[ComplexLanes<L>; N]; MAX_BODIES],
    /// The derivatives of the directions.
    pub along: [[ComplexLanes<L>; N]; MAX_BODIES],
}

impl<L: Lane, const N: usize> Slopes<L, N> {
    /// Creates the derivatives of ground and crank at the direction e of the crank.
    #[inline(always)]
    pub fn of(e: ComplexLanes<L>) -> Self {
        let zero = L::splat(0.0);
        let nothing = ComplexLanes { re: zero, im: zero };
        let mut out = Slopes { origin: [[nothing; N]; MAX_BODIES], along: [[nothing; N]; MAX_BODIES] };
        out.turn(e);
        out
    }

    /// Puts the crank in its place.
    #[inline(always)]
    pub fn turn(&mut self, e: ComplexLanes<L>) {
        self.along[CRANK][0] = ComplexLanes { re: -e.im, im: e.re };
    }

    /// Returns X' and Y' of a dyad by derivative `k`, its own parameters held.
    #[inline(always)]
    pub fn ends(&self, of: &Proportions, dyad: usize, k: usize) -> [ComplexLanes<L>; 2] {
        let [x, y] = of.kind.anchors(dyad);
        let [xi, eta] = of.anchors[dyad].map(ComplexLanes::splat);
        [self.origin[x][k] + self.along[x][k] * xi, self.origin[y][k] + self.along[y][k] * eta]
    }

    /// Computes the derivatives of the links of a dyad by the phase and by the first `count` parameters; those of the dyads
    /// before it are known.
    #[inline(always)]
    pub fn differentiate(
        &mut self,
        of: &Proportions,
        rates: &Rates,
        dyad: usize,
        frames: &Frames<L>,
        count: usize,
    ) {
        let (first, second) = (2 + 2 * dyad, 3 + 2 * dyad);
        let [l1, l2] = of.lengths[dyad];
        let (f1, f2) = (frames.along[first], frames.along[second]);
        let sign = of.signs[dyad];
        let least = L::splat(LEAST_SINE * l1 * l2);
        let size = frames.det[dyad] * L::splat(sign);
        let inverse = size.at_least(least, size, least).recip() * L::splat(sign);
        let [x_on, y_on] = of.kind.anchors(dyad);
        let [xi, eta] = of.anchors[dyad].map(ComplexLanes::splat);
        let zero = L::splat(0.0);
        let nothing = ComplexLanes { re: zero, im: zero };
        let own = first_parameter(dyad);
        // Only the phase moves the crank, and nothing moves the ground.
        let reach = |body: usize| match body {
            GROUND => 0,
            CRANK => 1,
            link => 1 + parameters_of((link - 2) / 2 + 1),
        };
        let (reach_x, reach_y) = (reach(x_on), reach(y_on));
        for k in 0..=count {
            let mut x = nothing;
            let mut y = nothing;
            if k < reach_x {
                x = self.origin[x_on][k] + self.along[x_on][k] * xi;
            }
            if k < reach_y {
                y = self.origin[y_on][k] + self.along[y_on][k] * eta;
            }
            let mut r1 = zero;
            let mut r2 = zero;
            if k > 0 {
                if dyad == 0 {
                    if k == 1 {
                        x = frames.along[CRANK] * xi;
                    }
                } else if k > own {
                    let turned = |z: ComplexLanes<L>| ComplexLanes { re: -z.im, im: z.re };
                    match k - own {
                        1 => x = frames.along[x_on],
                        2 => x = turned(frames.along[x_on]),
                        3 => y = frames.along[y_on],
                        4 => y = turned(frames.along[y_on]),
                        _ => {}
                    }
                }
                r1 = L::splat(l1 * rates.lengths[dyad][0][k - 1]);
                r2 = L::splat(l2 * rates.lengths[dyad][1][k - 1]);
            }
            r1 = r1 + f1.re * x.re + f1.im * x.im;
            r2 = r2 + f2.re * y.re + f2.im * y.im;
            let joint = ComplexLanes {
                re: (r1 * f2.im - r2 * f1.im) * inverse,
                im: (f1.re * r2 - f2.re * r1) * inverse,
            };
            (self.origin[first][k], self.along[first][k]) = (x, joint - x);
            (self.origin[second][k], self.along[second][k]) = (y, joint - y);
        }
    }
}
