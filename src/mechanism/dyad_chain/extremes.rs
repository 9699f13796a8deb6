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
/// Slopes below this share of |X - Y|^2 a radian are zero.
const FLAT: f64 = 1e-12;
/// Steps of a step in which two extremes are told apart.
const FINER: i32 = 8;
/// Local extremes are refined and compared if their parabolas differ by at most this share of the range of the squares.
const NEARLY_EQUAL: f64 = 0.02;
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
    // With the neighbours of the first and the last phase.
    let distances = grid.distances_sq(of, dyad);
    let mut around = [0.0; PHASES + 2];
    around[1..=PHASES].copy_from_slice(&distances);
    (around[0], around[PHASES + 1]) = (distances[PHASES - 1], distances[0]);
    [extreme(of, dyad, &around, 1.0), extreme(of, dyad, &around, -1.0)]
}

/// Finds the least (`sign` +1) or the greatest (-1) distance from its squares on the grid.
///
/// Two local extremes may be nearly equal: which of them is the extreme of the turn must not be left to the samples, or the
/// distance would jump as the chain changes.
#[inline(always)]
fn extreme(of: &Proportions, dyad: usize, around: &[f64; PHASES + 2], sign: f64) -> Extreme {
    let mut vertices = [0.0; PHASES];
    let [mut least, mut most, mut best] = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
    for i in 0..PHASES {
        let [before, here, after] = [sign * around[i], sign * around[i + 1], sign * around[i + 2]];
        // The vertex of the parabola through three samples.
        let slope = after - before;
        let vertex = here - slope * slope / (8.0 * (before - 2.0 * here + after));
        let is_local = here <= before && here < after;
        vertices[i] = if is_local { vertex } else { f64::INFINITY };
        least = if here < least { here } else { least };
        most = if here > most { here } else { most };
        best = if vertices[i] < best { vertices[i] } else { best };
    }
    let near = best + NEARLY_EQUAL * (most - least);
    let mut found: Option<Extreme> = None;
    for (i, vertex) in vertices.iter().enumerate() {
        if *vertex <= near {
            let other = refined(of, dyad, i, sign);
            if found.is_none_or(|found| sign * other.distance < sign * found.distance) {
                found = Some(other);
            }
        }
    }
    // A distance that does not change, or is not a number, has no local extreme.
    found.unwrap_or_else(|| refined(of, dyad, 0, sign))
}

/// Refines the extreme next to a phase of the grid: `sign` +1 for a least distance, -1 for a greatest.
fn refined(of: &Proportions, dyad: usize, near: usize, sign: f64) -> Extreme {
    let step = TAU / PHASES as f64;
    let middle = Grid::phase(near);
    let phase = zero(of, dyad, [middle, step], sign).unwrap_or_else(|| {
        // Two extremes lie within a step: the better one by finer samples.
        let fine = step / f64::from(FINER);
        let value = |phase: f64| sign * slope_at(of, dyad, phase).0;
        let phases = (-FINER..=FINER).map(|j| middle + fine * f64::from(j));
        let best = phases.min_by(|a, b| value(*a).total_cmp(&value(*b))).unwrap_or(middle);
        zero(of, dyad, [best, fine], sign).unwrap_or(best)
    });
    let (sin, cos) = sin_cos(phase);
    Extreme { distance: slope_at(of, dyad, phase).0.sqrt(), at: Complex::new(cos, sin) }
}

/// Finds the zero of the slope within a step of a phase, where it rises times `sign`; `None` if the slope has no such signs
/// there.
fn zero(of: &Proportions, dyad: usize, [middle, step]: [f64; 2], sign: f64) -> Option<f64> {
    let slope = |phase: f64| sign * slope_at(of, dyad, phase).1;
    let at_middle = slope(middle);
    let (mut a, mut b) = if at_middle < 0.0 { (middle, middle + step) } else { (middle - step, middle) };
    let (mut fa, mut fb) = if at_middle < 0.0 { (at_middle, slope(b)) } else { (slope(a), at_middle) };
    // An end may be the extreme of the other kind itself, as phases 0 and pi are where X and Y lie on coupler and follower.
    let flat = FLAT * slope_at(of, dyad, middle).0;
    let is_bracket = fa < -flat && (fb > flat || fb >= 0.0 && b == middle);
    if !is_bracket {
        return (at_middle.abs() <= flat && is_extreme(of, dyad, [middle, step], sign)).then_some(middle);
    }
    // The end that was kept last, whose value is halved if it is kept again.
    let mut kept_a = None;
    let mut x = middle;
    for _ in 0..STEPS {
        if fb <= 0.0 {
            return Some(b);
        }
        x = b - fb * (b - a) / (fb - fa);
        let fx = slope(x);
        if fx < 0.0 {
            if x - a < CLOSE {
                break;
            }
            (a, fa) = (x, fx);
            if kept_a == Some(false) {
                fb *= 0.5;
            }
            kept_a = Some(false);
        } else {
            if b - x < CLOSE {
                break;
            }
            (b, fb) = (x, fx);
            if kept_a == Some(true) {
                fa *= 0.5;
            }
            kept_a = Some(true);
        }
    }
    Some(x)
}

/// Returns whether the distance at a phase is below those a step away, times `sign`.
fn is_extreme(of: &Proportions, dyad: usize, [middle, step]: [f64; 2], sign: f64) -> bool {
    let value = |phase: f64| sign * slope_at(of, dyad, phase).0;
    value(middle) <= value(middle - step).min(value(middle + step))
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
