//! The range of the crank of a slider-crank, and its transmission angle.
//!
//! With theta = phi - line_angle and h0 = Im((A - Q) conj s), C lies h0 + a sin theta to the left of the line, and the loop
//! closes where that is at most b in magnitude: at every crank angle if a + |h0| <= b, else where
//! (-b - h0)/a <= sin theta <= (b - h0)/a, in one arc or in two.
//!
//! The transmission angle mu lies between the coupler and the normal of the line, the direction in which the slider does not
//! yield: cos mu = |h0 + a sin theta|/b, in [0, 90] degrees; 90 is best, 0 a toggle.

use super::SliderCrank;
use crate::mechanism::four_bar::mobility::CHANGE_POINT_TOLERANCE;
use crate::mechanism::slider::{SliderLinkage, SliderMobility};
use crate::mechanism::{Complex, InputArc, InputRange, cross};
use std::f64::consts::{FRAC_PI_2, PI};

/// Returns asin(x/a), exact near the ends; the nearer end beyond them.
fn arc_sine(x: f64, a: f64) -> f64 {
    x.atan2(((a - x) * (a + x)).max(0.0).sqrt())
}

pub(super) fn mobility(linkage: &SliderCrank) -> SliderMobility {
    let (a, b, h0) = (linkage.crank(), linkage.coupler(), linkage.pivot_height());
    let (margin, scale) = (b - a - h0.abs(), a.max(b).max(h0.abs()));
    let slack = CHANGE_POINT_TOLERANCE * scale;
    let line = linkage.line_angle();
    // C would come too far to the left of the line, or to its right.
    let (left, right) = ((a + h0) - b > slack, (a - h0) - b > slack);
    let [low, high] = [arc_sine(-b - h0, a), arc_sine(b - h0, a)];
    let input = if h0.abs() - a >= b {
        InputRange::None
    } else {
        match (left, right) {
            (false, false) => InputRange::Full,
            (true, false) => {
                InputRange::One(InputArc { middle: line - FRAC_PI_2, half_width: FRAC_PI_2 + high })
            }
            (false, true) => {
                InputRange::One(InputArc { middle: line + FRAC_PI_2, half_width: FRAC_PI_2 - low })
            }
            (true, true) => {
                let (middle, half_width) = (0.5 * (low + high), 0.5 * (high - low));
                InputRange::Two([
                    InputArc { middle: line + middle, half_width },
                    InputArc { middle: line + PI - middle, half_width },
                ])
            }
        }
    };
    SliderMobility::new(margin, scale, input)
}

/// Computes mu with the crank along the unit vector `crank`.
pub(super) fn transmission(linkage: &SliderCrank, crank: Complex) -> f64 {
    let height = linkage.pivot_height() + linkage.crank() * cross(linkage.direction, crank);
    let (h, b) = (height.abs(), linkage.coupler());
    ((b - h) * (b + h)).max(0.0).sqrt().atan2(h)
}

/// Returns the crank angles at which C is farthest from the line, and at which it lies on it.
pub(super) fn transmission_turns(linkage: &SliderCrank) -> [f64; 4] {
    let line = linkage.line_angle();
    let on = arc_sine(-linkage.pivot_height(), linkage.crank());
    [line + FRAC_PI_2, line - FRAC_PI_2, line + on, line + PI - on]
}
