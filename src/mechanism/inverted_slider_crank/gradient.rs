//! Gradient of C, D, u, P and the slider's place by the parameters of an inverted slider-crank and by the crank angle.
//!
//! The closure Im(V conj u) = h with V = B - C = (x + i h) u, differentiated:
//!
//! ```text
//! dpsi = ((u x dV) - dh)/x,   dx = h dpsi + <u, dV>,   dC = dA + e^{i phi} da + i a e^{i phi} dphi
//! du = i u dpsi       dD = dC + u dx + x du       dP = dC + u dZ + Z du
//! ```
//!
//! x/|V| is the sine of the transmission angle: at a toggle there is no gradient, and none is returned.

use super::InvertedSliderCrank;
use crate::mechanism::four_bar::gradient::TOGGLE_SINE;
use crate::mechanism::slider::{SliderColumn, SliderJoints, SliderLinkage};
use crate::mechanism::{Complex, cross, dot, turned};

/// The parameters of the columns of [`InvertedSliderCrank::gradient`].
pub const COLUMNS: [&str; 8] = ["Ax", "Ay", "Bx", "By", "a", "offset", "coupler_x", "coupler_y"];

impl InvertedSliderCrank {
    /// Computes the derivatives by Ax, Ay, Bx, By, a, offset, coupler_x, coupler_y, in this order, and by the crank angle
    /// (a radian) at a closed position; `None` if the loop is open or at a toggle.
    pub fn gradient(&self, crank_angle: f64) -> Option<([SliderColumn; 8], SliderColumn)> {
        let joints = self.position(crank_angle).joints()?;
        self.gradient_at(&joints, Complex::from_polar(1.0, crank_angle))
    }

    /// Computes the gradient as [`InvertedSliderCrank::gradient`] does, from a position and e^{i phi}.
    pub fn gradient_at(
        &self,
        joints: &SliderJoints,
        crank: Complex,
    ) -> Option<([SliderColumn; 8], SliderColumn)> {
        let SliderJoints { coupler: u, place: x, .. } = *joints;
        let (h, z) = (self.offset(), self.coupler_offset());
        let (sine, _) = self.sine(joints);
        if sine.is_nan() || sine.abs() <= TOGGLE_SINE {
            return None;
        }
        let per = 1.0 / x;
        let (zero, one, i) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0), Complex::new(0.0, 1.0));
        // A change of C, B, h and Z.
        let column = |d_c: Complex, d_b: Complex, d_h: f64, d_z: Complex| {
            let d_v = d_b - d_c;
            let turn = (cross(u, d_v) - d_h) * per;
            let (d_u, place) = (turned(u) * turn, h * turn + dot(u, d_v));
            SliderColumn {
                crank_pin: d_c,
                slider_pin: d_c + u * place + d_u * x,
                coupler: d_u,
                coupler_point: d_c + u * d_z + z * d_u,
                place,
            }
        };
        let of_pin = |d_c: Complex| column(d_c, zero, 0.0, zero);
        let shape = [
            of_pin(one),
            of_pin(i),
            column(zero, one, 0.0, zero),
            column(zero, i, 0.0, zero),
            of_pin(crank),
            column(zero, zero, 1.0, zero),
            column(zero, zero, 0.0, one),
            column(zero, zero, 0.0, i),
        ];
        Some((shape, of_pin(turned(crank) * self.crank())))
    }
}
