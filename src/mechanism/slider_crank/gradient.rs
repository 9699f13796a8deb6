//! Gradient of C, D, u, P and the slider's place by the parameters of a slider-crank and by the crank angle.
//!
//! The closure Im((C + b u - Q) conj s) = 0 with D - Q = y s, differentiated:
//!
//! ```text
//! dpsi = -((s x (dC - dQ)) + (s x u) db - y dline)/(b <s, u>),   dC = dA + e^{i phi} da + i a e^{i phi} dphi
//! du = i u dpsi       dD = dC + u db + b du       dP = dC + u dZ + Z du       dy = <s, dD - dQ>
//! ```
//!
//! <s, u> is the sine of the transmission angle: at a toggle there is no gradient, and none is returned.

use super::SliderCrank;
use crate::mechanism::four_bar::gradient::TOGGLE_SINE;
use crate::mechanism::slider::{SliderColumn, SliderJoints, SliderLinkage};
use crate::mechanism::{Complex, cross, dot, turned};

/// The parameters of the columns of [`SliderCrank::gradient`]; line_angle in radians.
pub const COLUMNS: [&str; 9] =
    ["Ax", "Ay", "a", "b", "line_x", "line_y", "line_angle", "coupler_x", "coupler_y"];

impl SliderCrank {
    /// Computes the derivatives by Ax, Ay, a, b, Qx, Qy, line_angle (a radian), coupler_x, coupler_y, in this order, and by
    /// the crank angle (a radian) at a closed position; `None` if the loop is open or at a toggle.
    pub fn gradient(&self, crank_angle: f64) -> Option<([SliderColumn; 9], SliderColumn)> {
        let joints = self.position(crank_angle).joints()?;
        self.gradient_at(&joints, Complex::from_polar(1.0, crank_angle))
    }

    /// Computes the gradient as [`SliderCrank::gradient`] does, from a position and e^{i phi}.
    pub fn gradient_at(
        &self,
        joints: &SliderJoints,
        crank: Complex,
    ) -> Option<([SliderColumn; 9], SliderColumn)> {
        let SliderJoints { coupler: u, place: y, .. } = *joints;
        let (s, b, z) = (self.line_direction(), self.coupler(), self.coupler_offset());
        let sine = dot(s, u);
        if sine.is_nan() || sine.abs() <= TOGGLE_SINE {
            return None;
        }
        let per = 1.0 / (b * sine);
        let (zero, one, i) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0), Complex::new(0.0, 1.0));
        // A change of C, Q, b, the line's angle and Z.
        let column = |d_c: Complex, d_q: Complex, d_b: f64, d_line: f64, d_z: Complex| {
            let turn = -(cross(s, d_c - d_q) + cross(s, u) * d_b - y * d_line) * per;
            let d_u = turned(u) * turn;
            let d_d = d_c + u * d_b + d_u * b;
            SliderColumn {
                crank_pin: d_c,
                slider_pin: d_d,
                coupler: d_u,
                coupler_point: d_c + u * d_z + z * d_u,
                place: dot(s, d_d - d_q),
            }
        };
        let of_pin = |d_c: Complex| column(d_c, zero, 0.0, 0.0, zero);
        let shape = [
            of_pin(one),
            of_pin(i),
            of_pin(crank),
            column(zero, zero, 1.0, 0.0, zero),
            column(zero, one, 0.0, 0.0, zero),
            column(zero, i, 0.0, 0.0, zero),
            column(zero, zero, 0.0, 1.0, zero),
            column(zero, zero, 0.0, 0.0, one),
            column(zero, zero, 0.0, 0.0, i),
        ];
        Some((shape, of_pin(turned(crank) * self.crank())))
    }
}
