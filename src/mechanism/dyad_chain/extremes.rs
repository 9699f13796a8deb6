//! Extremes of the distance |X - Y| between the ends of a dyad over a turn of the crank.
//!
//! The first dyad has them in closed form: |1 -+ p|. For further ones the best of evenly spaced phases is refined as a zero
//! of the slope <X - Y, X' - Y'> by safeguarded regula falsi (the Illinois rule of Dowell and Jarratt 1971). The vertex of a
//! parabola through three samples is not enough: one derivative in eleven was wrong by more than 1e-4.

use super::gradient::{Rates, Slopes};
use super::grid::{Grid, PHASES};
use super::position::Frames;
use super::proportions::Proportions;
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::sine::sin_cos;
use std::f64::consts::TAU;

/// Most steps of the regula falsi.
const STEPS: usize = 40;
/// Width of the bracket, in radians, at which it ends.
const CLOSE: f64 = 1e-11;

/// A least or greatest distance, and the direction of the crank there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The distance |X - Y|.
    pub distance: f64,
    /// e^{i phi} of the crank.
    pub at: Complex,
}

/// Computes the least and the greatest |X - Y| of a dyad; the dyads before it are in the grid.
#[inline(always)]
pub fn extremes(of: &Proportions, dyad: usize, grid: &Grid) -> [Extreme; 2] {
    if dyad == 0 {
        let p = of.anchors[0][0].re;
        let at = |distance, re| Extreme { distance, at: Complex::new(re, 0.0) };
        return [at((1.0 - p).abs(), 1.0), at(1.0 + p, -1.0)];
    }
    let distances = grid.distances_sq(of, dyad);
    let (mut low, mut high) = (0, 0);
    for (i, distance) in distances.iter().enumerate() {
        if *distance < distances[low] {
            low = i;
        }
        if *distance > distances[high] {
            high = i;
        }
    }
    [refined(of, dyad, low, 1.0), refined(of, dyad, high, -1.0)]
}

/// Refines the extreme next to a phase of the grid: `sign` +1 for a least distance, -1 for a greatest.
fn refined(of: &Proportions, dyad: usize, near: usize, sign: f64) -> Extreme {
    let step = TAU / PHASES as f64;
    let middle = Grid::phase(near);
    let slope = |phase: f64| sign * slope_at(of, dyad, phase).1;
    let at_middle = slope(middle);
    // The slope rises through zero at the extreme.
    let (mut a, mut b) = if at_middle < 0.0 { (middle, middle + step) } else { (middle - step, middle) };
    let (mut fa, mut fb) =
        if at_middle < 0.0 { (at_middle, slope(middle + step)) } else { (slope(middle - step), at_middle) };
    let mut best = middle;
    if fa < 0.0 && fb > 0.0 {
        let mut last = 0_i8;
        for _ in 0..STEPS {
            let x = b - fb * (b - a) / (fb - fa);
            let fx = slope(x);
            best = x;
            if fx < 0.0 {
                if x - a < CLOSE {
                    break;
                }
                (a, fa) = (x, fx);
                if last == -1 {
                    fb *= 0.5;
                }
                last = -1;
            } else if fx > 0.0 {
                if b - x < CLOSE {
                    break;
                }
                (b, fb) = (x, fx);
                if last == 1 {
                    fa *= 0.5;
                }
                last = 1;
            } else {
                break;
            }
        }
    }
    let (sin, cos) = sin_cos(best);
    Extreme { distance: slope_at(of, dyad, best).0.sqrt(), at: Complex::new(cos, sin) }
}

/// Returns |X - Y|^2 and <X - Y, X' - Y'> of a dyad at a phase.
#[inline(always)]
fn slope_at(of: &Proportions, dyad: usize, phase: f64) -> (f64, f64) {
    let (sin, cos) = sin_cos(phase);
    let e = ComplexLanes { re: cos, im: sin };
    let mut frames = Frames::<f64>::of(e);
    let mut slopes = Slopes::<f64, 1>::of(e);
    let rates = Rates::NONE;
    for before in 0..dyad {
        frames.assemble(of, before);
        slopes.differentiate(of, &rates, before, &frames, 0);
    }
    let [x, y] = frames.ends(of, dyad);
    let [dx, dy] = slopes.ends(of, dyad, 0);
    let (d, slope) = (x - y, dx - dy);
    (d.norm_sq(), d.re * slope.re + d.im * slope.im)
}
