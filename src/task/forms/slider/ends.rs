//! The stroke and the time ratio of a slider-crank as inequalities of a fit.
//!
//! The slider's ends are where crank and coupler lie on one line. With h the distance of A from the line, p = sqrt((b + a)^2 -
//! h^2) and r = sqrt((b - a)^2 - h^2) those of the ends from A's foot, the stroke S and the angle alpha between the crank's
//! directions there, less half a turn, are
//!
//! ```text
//! S = p - r,   alpha = |asin(h/(b - a)) - asin(h/(b + a))|,   time ratio = (pi + alpha)/(pi - alpha)
//!
//! dS      = [(b + a)/p + (b - a)/r] da + [(b + a)/p - (b - a)/r] db + [h/r - h/p] dh
//! dalpha  = h [1/((b - a) r) + 1/((b + a) p)] da - h [1/((b - a) r) - 1/((b + a) p)] db + [1/r - 1/p] dh      (h >= 0)
//! ```

//!
//! *The best transmitting one.* With sigma = alpha/2 and t = delta + sigma, delta the angle at the far end between the line and
//! the crank's direction there, the law of sines gives
//!
//! ```text
//! a = S cos t/(2 cos sigma),   b = S sin t/(2 sin sigma),   h = S (sin^2 t - sin^2 sigma)/sin alpha
//! cos mu = (a + h)/b = [sin sigma cos t + sin^2 t - sin^2 sigma]/(cos sigma sin t)
//! ```
//!
//! and the derivative by t vanishes for x = cos t where (x - sin sigma)(x^2 + x sin sigma - 1) = 0. The first root has mu = 0;
//! the other, x = (sqrt(sin^2 sigma + 4) - sin sigma)/2, is the best. Derived here; textbooks give charts or a cubic for the
//! same optimum (VDI 2126).

use super::limits::Bar;
use super::shape::{Closure, SHAPE, SliderShape};
use crate::mechanism::{cross, dot};
use std::f64::consts::PI;

/// The least distance of an end from A's foot, in the coupler's length, from which derivatives are taken.
const LEAST: f64 = 1e-6;

/// Returns the angle alpha of a time ratio.
pub(crate) fn angle_of(ratio: f64) -> f64 {
    PI * (ratio - 1.0) / (ratio + 1.0)
}

/// Returns crank, coupler and offset of the slider-crank with a stroke and a time ratio whose least transmission angle over the
/// turn is the greatest; `None` for a time ratio of 1, for which a longer coupler is always better.
pub fn best_transmitting([stroke, ratio]: [f64; 2]) -> Option<[f64; 3]> {
    let alpha = angle_of(ratio);
    let (sin, cos) = (0.5 * alpha).sin_cos();
    let x = 0.5 * ((sin * sin + 4.0).sqrt() - sin);
    let sin_sq = (1.0 - x) * (1.0 + x);
    let lengths = [
        0.5 * stroke * x / cos,
        0.5 * stroke * sin_sq.sqrt() / sin,
        stroke * (sin_sq - sin * sin) / alpha.sin(),
    ];
    lengths.iter().all(|length| length.is_finite() && *length > 0.0).then_some(lengths)
}

/// Passes the inequalities of the bounds of the stroke and of the time ratio, as many for every slider-crank.
pub(super) fn each(
    shape: &SliderShape,
    stroke: Option<[f64; 2]>,
    time_ratio: Option<[f64; 2]>,
    each: &mut dyn FnMut(Bar),
) {
    let Closure::Line { coupler: b, height, direction: s } = shape.closure else { return };
    let (a, pivot) = (shape.crank, shape.crank_pivot);
    let signed = cross(s, pivot) - height;
    let (side, h) = (if signed < 0.0 { -1.0 } else { 1.0 }, signed.abs());
    let least = LEAST * b;
    let [far, near] = [b + a, (b - a).max(least)];
    let [p, r] = [far, near].map(|reach| (reach * reach - h * h).max(least * least).sqrt());
    // The derivatives by a, b and h in the unknowns of the shape.
    let by_shape = |by_a: f64, by_b: f64, by_h: f64| -> [f64; SHAPE] {
        let by_h = side * by_h;
        [-s.im * by_h, s.re * by_h, by_a, by_b, -by_h, -dot(pivot, s) * by_h, 0.0, 0.0]
    };
    let mut bounded = |value: f64, by: [f64; SHAPE], [low, high]: [f64; 2]| {
        each(Bar::still(value - low, by));
        each(Bar::still(high - value, by.map(|by| -by)));
    };
    if let Some(bounds) = stroke {
        bounded(p - r, by_shape(far / p + near / r, far / p - near / r, h / r - h / p), bounds);
    }
    if let Some([low, high]) = time_ratio {
        let alpha = (h / near).min(1.0).asin() - (h / far).min(1.0).asin();
        let [of_near, of_far] = [1.0 / (near * r), 1.0 / (far * p)];
        let by = by_shape(h * (of_near + of_far), h * (of_far - of_near), 1.0 / r - 1.0 / p);
        bounded(alpha, by, [angle_of(low), angle_of(high)]);
    }
}
