//! Gradient of the coupler point by the linkage's parameters and by the crank angle.
//!
//! With unit vectors u along C -> D and v along B -> D, the two distance constraints give
//!
//! ```text
//! dtheta3 = (dc - <v, u> db - <v, dC - dB>) / (b <v, i u>),   dC = dA + e^{i phi} da + i a e^{i phi} dphi
//! dP = dC + u dz + i u Z dtheta3,                              Z = coupler offset in the coupler's frame
//! ```
//!
//! <v, i u> is the sine of the transmission angle: at a toggle there is no gradient, and none is returned.

use crate::mechanism::{AssemblyMode, Complex, FourBar, dot, turned, unit_vector};

/// |sin(transmission angle)| at and below which a position counts as a toggle: double precision leaves no
/// correct digit in a gradient there.
pub const TOGGLE_SINE: f64 = 1e-12;

/// Gradient of P: dP by each parameter of the shape (coupler point in the coupler's frame) and by the crank angle.
///
/// Columns of `shape`: Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeGradient {
    /// dP/d(Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y).
    pub shape: [Complex; 9],
    /// dP/dphi, per radian.
    pub crank_angle: Complex,
}

/// Unit vectors along the moving links at one closed position, from which gradients are built.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// e^{i phi}, the unit vector from A to C.
    pub crank: Complex,
    /// u, the unit vector from C to D.
    pub coupler: Complex,
    /// v, the unit vector from B to D.
    pub follower: Complex,
}

/// Computes the gradient in a frame; `None` at a toggle.
///
/// `crank` = a, `coupler` = b, `offset` = Z.
#[inline]
pub fn shape_gradient(frame: &Frame, crank: f64, coupler: f64, offset: Complex) -> Option<ShapeGradient> {
    let Frame { crank: e, coupler: u, follower: v } = *frame;
    let sine = dot(v, turned(u));
    if sine.abs() <= TOGGLE_SINE {
        return None;
    }
    let swing = turned(u) * offset; // dP/dtheta3 with C held
    let per = 1.0 / (coupler * sine);
    let crank_pin = |d_c: Complex| d_c - swing * (dot(v, d_c) * per);
    let one = Complex::new(1.0, 0.0);
    let i = Complex::new(0.0, 1.0);
    Some(ShapeGradient {
        shape: [
            crank_pin(one),
            crank_pin(i),
            swing * (v.re * per),
            swing * (v.im * per),
            crank_pin(e),
            swing * (-dot(v, u) * per),
            swing * per,
            u,
            turned(u),
        ],
        crank_angle: crank_pin(turned(e) * crank),
    })
}

/// Computes the gradient of the coupler's direction, dtheta3 by the columns of [`ShapeGradient::shape`] and by the crank
/// angle; `None` at a toggle.
///
/// `crank` = a, `coupler` = b.
#[inline]
pub fn coupler_gradient(frame: &Frame, crank: f64, coupler: f64) -> Option<([f64; 9], f64)> {
    let Frame { crank: e, coupler: u, follower: v } = *frame;
    let sine = dot(v, turned(u));
    if sine.abs() <= TOGGLE_SINE {
        return None;
    }
    let per = 1.0 / (coupler * sine);
    let shape =
        [-v.re, -v.im, v.re, v.im, -dot(v, e), -dot(v, u), 1.0, 0.0, 0.0].map(|numerator| numerator * per);
    Some((shape, -dot(v, turned(e)) * crank * per))
}

/// Computes the gradient of the follower's direction, dtheta4 by the columns of [`ShapeGradient::shape`] and by the crank
/// angle; `None` at a toggle.
///
/// ```text
/// dtheta4 = (a <u, i e> dphi + <u, e> da + db - <u, v> dc - <u, dB - dA>) / (c <u, i v>)
/// ```
///
/// `crank` = a, `follower` = c.
#[inline]
pub fn follower_gradient(frame: &Frame, crank: f64, follower: f64) -> Option<([f64; 9], f64)> {
    let Frame { crank: e, coupler: u, follower: v } = *frame;
    let sine = dot(u, turned(v));
    if sine.abs() <= TOGGLE_SINE {
        return None;
    }
    let per = 1.0 / (follower * sine);
    let shape =
        [u.re, u.im, -u.re, -u.im, dot(u, e), 1.0, -dot(u, v), 0.0, 0.0].map(|numerator| numerator * per);
    Some((shape, dot(u, turned(e)) * crank * per))
}

/// Computes the gradient of the direction of the ground line A -> B by Ax, Ay, Bx and By: the columns of <i g, dB - dA> / |AB|,
/// with the unit vector g along the line.
#[inline]
pub fn ground_gradient(crank_pivot: Complex, follower_pivot: Complex) -> [f64; 4] {
    let ground = follower_pivot - crank_pivot;
    let across = turned(unit_vector(ground)) / ground.norm().max(f64::MIN_POSITIVE);
    [-across.re, -across.im, across.re, across.im]
}

/// Computes dP/dphi alone, the last part of [`shape_gradient`]; `None` at a toggle.
#[inline]
pub fn by_crank_angle(frame: &Frame, crank: f64, coupler: f64, offset: Complex) -> Option<Complex> {
    let Frame { crank: e, coupler: u, follower: v } = *frame;
    let sine = dot(v, turned(u));
    let pin = turned(e) * crank;
    (sine.abs() > TOGGLE_SINE).then(|| pin - turned(u) * offset * (dot(v, pin) / (coupler * sine)))
}

impl FourBar {
    /// Computes the unit vectors along crank, coupler and follower at a closed position; `None` if the loop is open.
    pub fn frame(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Frame> {
        let joints = self.position_with(crank_angle, assembly).joints()?;
        Some(Frame {
            crank: Complex::from_polar(1.0, crank_angle),
            coupler: (joints.follower_pin - joints.crank_pin) / self.coupler(),
            follower: (joints.follower_pin - self.follower_pivot()) / self.follower(),
        })
    }

    /// Computes the joints from a frame that [`FourBar::frame`] gave: C, D and P.
    pub fn joints_of(&self, frame: &Frame) -> [Complex; 3] {
        let crank_pin = self.crank_pivot() + frame.crank * self.crank();
        let at = |along: Complex| crank_pin + frame.coupler * along;
        [crank_pin, at(Complex::new(self.coupler(), 0.0)), at(self.coupler_offset())]
    }

    /// Computes dP by the nine natural coordinates (Ax, Ay, Bx, By, a, b, c, d, e) and by the crank angle.
    ///
    /// It follows from the shape's gradient with coupler_x = (d^2 + b^2 - e^2)/(2b) and coupler_y = t2 sqrt(d^2 -
    /// coupler_x^2). `None` if the loop is open, at a toggle, and if P lies on the line C-D (there coupler_y has no
    /// derivative by b, d and e).
    pub fn gradient(&self, crank_angle: f64) -> Option<([Complex; 9], Complex)> {
        let frame = self.frame(crank_angle, self.assembly())?;
        let offset = self.coupler_offset();
        let (b, d, e) = (self.coupler(), self.crank_side(), self.follower_side());
        if offset.im.abs() <= TOGGLE_SINE * (d + b) {
            return None;
        }
        let ShapeGradient { mut shape, crank_angle } = shape_gradient(&frame, self.crank(), b, offset)?;
        let [by_x, by_y] = [shape[7], shape[8]];
        // d(coupler_y) = (d dd - coupler_x d(coupler_x)) / coupler_y
        let column = |along: f64, d_d: f64| by_x * along + by_y * ((d * d_d - offset.re * along) / offset.im);
        let by_b = column((b * b - d * d + e * e) / (2.0 * b * b), 0.0);
        shape[5] += by_b;
        shape[7] = column(d / b, 1.0);
        shape[8] = column(-e / b, 0.0);
        Some((shape, crank_angle))
    }
}
