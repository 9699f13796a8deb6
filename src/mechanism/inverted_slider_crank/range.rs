//! The range of the crank of an inverted slider-crank, and its transmission angle.
//!
//! The loop closes where |V| = |B - C| >= |h|. |V| grows from |g - a| with the crank along the ground to g + a against it:
//! the crank turns fully if |g - a| >= |h|, else it reaches one arc about the direction from B to A.
//!
//! The transmission angle mu lies between the line from C to B and the normal of the coupler, along which the block bears:
//! cos mu = |h|/|V|, in [0, 90] degrees; 90 is best, 0 a toggle.

use super::InvertedSliderCrank;
use crate::mechanism::four_bar::mobility::CHANGE_POINT_TOLERANCE;
use crate::mechanism::four_bar::transmission::angle_opposite;
use crate::mechanism::slider::{SliderLinkage, SliderMobility};
use crate::mechanism::{Complex, InputArc, InputRange};
use std::f64::consts::PI;

pub(super) fn mobility(linkage: &InvertedSliderCrank) -> SliderMobility {
    let (g, a, h) = (linkage.ground(), linkage.crank(), linkage.offset().abs());
    let (margin, scale) = ((g - a).abs() - h, g.max(a).max(h));
    let input = if g + a <= h {
        InputRange::None
    } else if margin >= -CHANGE_POINT_TOLERANCE * scale {
        InputRange::Full
    } else {
        let half_width = PI - angle_opposite(h, g, a);
        InputRange::One(InputArc { middle: linkage.ground_angle() + PI, half_width })
    };
    SliderMobility::new(margin, scale, input)
}

/// Computes mu with the crank along the unit vector `crank`.
pub(super) fn transmission(linkage: &InvertedSliderCrank, crank: Complex) -> f64 {
    let v = linkage.block_pivot() - (linkage.crank_pivot() + crank * linkage.crank());
    let (s, h) = (v.norm(), linkage.offset().abs());
    ((s - h) * (s + h)).max(0.0).sqrt().atan2(h)
}

/// Returns the crank angles along the ground and against it, each twice.
pub(super) fn transmission_turns(linkage: &InvertedSliderCrank) -> [f64; 4] {
    let along = linkage.ground_angle();
    [along, along + PI, along, along + PI]
}
