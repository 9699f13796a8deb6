//! Rows of the region of the moving pins, in the frame of the body.
//!
//! With the coupler point P the body's origin and beta the angle from C -> D to its x axis
//!
//! ```text
//! C: m = -Z e^{-i beta}       D: m = (b - Z) e^{-i beta}       dm = (db - dZ) e^{-i beta} - i m dbeta
//! ```

use super::{At, Row, RowKind, Side};
use crate::mechanism::{Complex, dot, turned};
use crate::task::forms::design_space::SHAPE;
use crate::task::region::{Region, inside};
use crate::task::requirement::RequirementKind;

pub(super) fn rows(at: &At<'_>, frame: f64, each: &mut dyn FnMut(&Row)) {
    let Some(region) = &at.require.pins_in else { return };
    let back = Complex::from_polar(1.0, -frame);
    // The pin with its derivative by b.
    let pins = [(-at.shape.offset * back, 0.0), ((at.shape.coupler - at.shape.offset) * back, 1.0)];
    let row = |pin: Complex, by_b: f64, side: Option<Side>, value: f64, grows: Complex| {
        let mut shape = [0.0; SHAPE];
        shape[5] = by_b * dot(grows, back);
        (shape[7], shape[8]) = (-dot(grows, back), -dot(grows, turned(back)));
        let kind = RowKind::of(RequirementKind::PinsIn, side);
        Row { by_frame: -dot(grows, turned(pin)), ..Row::still(kind, value - at.margin(), shape) }
    };
    for (pin, by_b) in pins {
        match region {
            Region::Box(corners) => {
                for side in Side::ALL {
                    let limit = corners[side.index()];
                    let along =
                        if side.axis() == 0 { Complex::new(1.0, 0.0) } else { Complex::new(0.0, 1.0) };
                    let grows = along * side.sign();
                    let value = dot(grows, pin) - side.sign() * limit;
                    each(&row(pin, by_b, Some(side), value, grows));
                }
            }
            Region::Polygon(polygon) => {
                let (depth, grows) = inside(polygon, pin);
                each(&row(pin, by_b, None, depth, grows));
            }
        }
    }
}
