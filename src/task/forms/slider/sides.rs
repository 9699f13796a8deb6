//! Limits of distances between two joints and of the ground's direction, which are no unknowns of a fit.
//!
//! ```text
//! d = |CP| = |Z|      e = |DP| = |Z - b| (slider-crank)      ground = |AB|, its direction arg(B - A) (inverted)
//! ```

use super::limits::{Bar, MARGIN};
use super::shape::{Closure, SHAPE, SliderShape};
use crate::mechanism::{Complex, turned};
use crate::task::spec::{DesignSpec, Limits};
use std::f64::consts::TAU;

/// The limits, lengths in units of the target's size and the direction in radians.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Sides {
    crank_side: Option<[f64; 2]>,
    slider_side: Option<[f64; 2]>,
    ground: Option<[f64; 2]>,
    ground_angle: Option<[f64; 2]>,
}

impl Sides {
    pub(super) fn of(design: &DesignSpec, size: f64) -> Sides {
        let length = |limits: Option<Limits>| limits.map(|Limits(low, high)| [low / size, high / size]);
        Sides {
            crank_side: length(design.d),
            slider_side: length(design.e),
            ground: length(design.ground),
            ground_angle: design
                .ground_angle_deg
                .map(|Limits(low, high)| [low.to_radians(), high.to_radians()]),
        }
    }

    /// Passes the inequalities to `each`, always in the same number and order for a kind.
    pub(super) fn each(&self, shape: &SliderShape, each: &mut dyn FnMut(Bar)) {
        let (length, by) = distance(shape.offset);
        between(self.crank_side, length, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, by.re, by.im], each);
        match shape.closure {
            Closure::Line { coupler, .. } => {
                let (length, by) = distance(shape.offset - coupler);
                let by_shape = [0.0, 0.0, 0.0, -by.re, 0.0, 0.0, by.re, by.im];
                between(self.slider_side, length, by_shape, each);
            }
            Closure::Block { pivot, .. } => {
                let ground = pivot - shape.crank_pivot;
                let (length, by) = distance(ground);
                between(self.ground, length, [-by.re, -by.im, 0.0, by.re, by.im, 0.0, 0.0, 0.0], each);
                let Some([low, high]) = self.ground_angle else { return };
                // The angle nearest to the middle of its limits.
                let angle = ground.arg();
                let angle = angle + TAU * ((0.5 * (low + high) - angle) / TAU).round();
                let by = turned(ground) / ground.norm_sqr().max(f64::MIN_POSITIVE);
                let by_shape = [-by.re, -by.im, 0.0, by.re, by.im, 0.0, 0.0, 0.0];
                between(self.ground_angle, angle, by_shape, each);
            }
        }
    }
}

/// Returns the length of a vector with its derivatives by the two components.
fn distance(z: Complex) -> (f64, Complex) {
    let length = z.norm();
    (length, z / length.max(f64::MIN_POSITIVE))
}

/// Passes the two inequalities of a value between limits; equal limits are met up to the margin.
fn between(limits: Option<[f64; 2]>, value: f64, by_shape: [f64; SHAPE], each: &mut dyn FnMut(Bar)) {
    let Some([low, high]) = limits else { return };
    let margin = if low < high { MARGIN } else { -MARGIN };
    each(Bar::still(value - low - margin, by_shape));
    each(Bar::still(high - value - margin, by_shape.map(|by| -by)));
}
