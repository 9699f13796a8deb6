//! The regions of the pivots and of the body's pins, and the lines on which pivots are to lie.
//!
//! With the coupler point P the body's origin and beta the angle from the coupler's direction to its x axis
//!
//! ```text
//! C: m = -Z e^{-i beta}       D: m = (b - Z) e^{-i beta}, of a slider-crank
//! ```

use super::limits::{Bar, MARGIN};
use super::shape::{Closure, SHAPE, SliderShape};
use crate::mechanism::{Complex, dot, turned};
use crate::task::region::{Region, inside};
use crate::task::spec::RequireSpec;

/// The regions, in units of the target's size around its centre.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Regions {
    /// The polygon of the fixed pivots; a box is among the bounds of the unknowns.
    pivots: Option<Vec<[f64; 2]>>,
    /// The region of the moving pins, in the frame of the body.
    pins: Option<Region>,
    /// The unit normals of the lines of each pivot, with a place on them.
    lines: [Vec<[Complex; 2]>; 2],
}

impl Regions {
    pub(super) fn of(require: &RequireSpec, centre: Complex, size: f64) -> Regions {
        let scaled = |region: &Region, from: Complex| {
            let mut scaled = region.clone();
            for (i, number) in scaled.points_mut().enumerate() {
                *number = (*number - [from.re, from.im][i % 2]) / size;
            }
            scaled
        };
        let polygon = |region: &Region| match scaled(region, centre) {
            Region::Polygon(corners) => Some(corners),
            Region::Box(_) => None,
        };
        let loci = require.pivot_on.as_ref().map_or([None, None], |on| on.both());
        Regions {
            pivots: require.pivots_in.as_ref().and_then(polygon),
            pins: require.pins_in.as_ref().map(|region| scaled(region, Complex::new(0.0, 0.0))),
            lines: loci.map(|locus| {
                let line = |locus: &crate::task::pivot_on::Locus| {
                    let place = (locus.first() - centre) / size;
                    locus.normals().into_iter().map(|normal| [normal, place]).collect()
                };
                locus.map_or_else(Vec::new, line)
            }),
        }
    }

    /// Passes the inequalities to `each`, always in the same number and order.
    pub(super) fn each(&self, shape: &SliderShape, frame: f64, each: &mut dyn FnMut(Bar)) {
        let second = match shape.closure {
            Closure::Line { .. } => None,
            Closure::Block { pivot, .. } => Some((3, pivot)),
        };
        let pivots = [Some((0, shape.crank_pivot)), second];
        for ((first, pivot), lines) in pivots.into_iter().zip(&self.lines).filter_map(|(p, l)| Some((p?, l)))
        {
            let mut still = |value: f64, grows: Complex| {
                let mut by_shape = [0.0; SHAPE];
                (by_shape[first], by_shape[first + 1]) = (grows.re, grows.im);
                each(Bar::still(value, by_shape));
            };
            if let Some(polygon) = &self.pivots {
                let (depth, grows) = inside(polygon, pivot);
                still(depth - MARGIN, grows);
            }
            for [normal, place] in lines {
                for way in [*normal, -normal] {
                    still(MARGIN - dot(way, pivot - place), -way);
                }
            }
        }
        if let Some(region) = &self.pins {
            pins(shape, frame, region, each);
        }
    }
}

/// Passes the inequalities of the moving pins.
fn pins(shape: &SliderShape, frame: f64, region: &Region, each: &mut dyn FnMut(Bar)) {
    let back = Complex::from_polar(1.0, -frame);
    let second = match shape.closure {
        Closure::Line { coupler, .. } => Some(((coupler - shape.offset) * back, 1.0)),
        Closure::Block { .. } => None,
    };
    // Each pin with its derivative by b.
    for (pin, by_b) in [Some((-shape.offset * back, 0.0)), second].into_iter().flatten() {
        let mut bar = |value: f64, grows: Complex| {
            let mut by_shape = [0.0; SHAPE];
            by_shape[3] = by_b * dot(grows, back);
            (by_shape[6], by_shape[7]) = (-dot(grows, back), -dot(grows, turned(back)));
            let by_frame = -dot(grows, turned(pin));
            each(Bar { by_frame, ..Bar::still(value - MARGIN, by_shape) });
        };
        match region {
            Region::Box([left, bottom, right, top]) => {
                let (x, y) = (Complex::new(1.0, 0.0), Complex::new(0.0, 1.0));
                for (grows, limit) in [(x, *left), (-x, -right), (y, *bottom), (-y, -top)] {
                    bar(dot(grows, pin) - limit, grows);
                }
            }
            Region::Polygon(polygon) => {
                let (depth, grows) = inside(polygon, pin);
                bar(depth, grows);
            }
        }
    }
}
