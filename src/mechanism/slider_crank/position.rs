//! Position analysis of the slider-crank in closed form, and the rates of coupler and slider.
//!
//! ```text
//! C = A + a e^{i phi}
//! h = Im((C - Q) conj s)/b               (C to the left of the line; |h| > 1: the loop does not close)
//! u = s (t1 sqrt(1 - h^2) - i h)
//! D = Q + y s,   y = Re((C - Q) conj s) + b t1 sqrt(1 - h^2)
//! P = C + Z u = C + (Z s) (t1 sqrt(1 - h^2) - i h)
//! ```
//!
//! One square root and no division a position. Sums of products are written as differences, x + y as y - (-x): the digits are
//! the same, and the compiler then keeps the lanes apart instead of exchanging the terms in some of them. The closure Im((C + b u - Q) conj s) = 0, differentiated once and twice:
//!
//! ```text
//! psi'  = -(s x C')/(b <s, u>)                           y'  = <s, D'>
//! psi'' = (b psi'^2 (s x u) - (s x C''))/(b <s, u>)      y'' = <s, D''>
//! ```
//!
//! <s, u> = t1 sqrt(1 - h^2) is the sine of the transmission angle up to its sign, which vanishes at a toggle.

use super::{SliderCrank, SliderCrankParameters};
use crate::mechanism::four_bar::motion::TOGGLE_ROUNDING;
use crate::mechanism::four_bar::position::LanePosition;
use crate::mechanism::slider::motion::{PointMotion, Sliding, Turning, carried};
use crate::mechanism::slider::{
    SliderJoints, SliderKernel, SliderLanes, SliderLinkage, SliderMobility, SliderRates,
};
use crate::mechanism::{AssemblyMode, Complex, FLAT_TOLERANCE, cross, dot, point};
use crate::numbers::arithmetic::lane::Lane;

/// A slider-crank as the coefficients of its position equations.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    pivot: [f64; 2],
    crank: f64,
    coupler: f64,
    line_point: [f64; 2],
    direction: [f64; 2],
    /// s/b.
    direction_per_coupler: [f64; 2],
    /// Z s.
    offset: [f64; 2],
    t1: f64,
}

impl Kernel {
    /// Computes the coefficients from A, (a, b), Q, s, Z and t1; nothing is checked.
    #[inline(always)]
    pub fn from_parts(
        pivot: [f64; 2],
        [crank, coupler]: [f64; 2],
        line_point: [f64; 2],
        direction: [f64; 2],
        offset: [f64; 2],
        assembly: AssemblyMode,
    ) -> Self {
        let [[s_x, s_y], [z_x, z_y]] = [direction, offset];
        let per = 1.0 / coupler;
        Kernel {
            pivot,
            crank,
            coupler,
            line_point,
            direction,
            direction_per_coupler: [s_x * per, s_y * per],
            offset: [z_x * s_x - z_y * s_y, z_x * s_y + z_y * s_x],
            t1: assembly.sign(),
        }
    }
}

impl SliderKernel for Kernel {
    #[inline(always)]
    fn place<L: Lane>(&self, cos: L, sin: L) -> SliderLanes<L> {
        let splat = |pair: [f64; 2]| pair.map(L::splat);
        let ([a_x, a_y], [q_x, q_y]) = (splat(self.pivot), splat(self.line_point));
        let ([s_x, s_y], [m_x, m_y]) = (splat(self.direction), splat(self.direction_per_coupler));
        let ([w_x, w_y], crank, one) = (splat(self.offset), L::splat(-self.crank), L::splat(1.0));
        let [along_x, along_y] = splat(self.offset.map(|w| self.t1 * w));
        let [c_x, c_y] = [a_x - crank * cos, a_y - crank * sin];
        let (v_x, v_y) = (c_x - q_x, c_y - q_y);
        let h = m_x * v_y - m_y * v_x;
        // 1 - h^2, factored for the sake of its digits near a toggle.
        let root_sq = (one - h) * (one - (-h));
        let sine = root_sq.positive_part().sqrt();
        let root = L::splat(self.t1) * sine;
        let [u_x, u_y] = [s_x * root - (-s_y) * h, s_y * root - s_x * h];
        let place = (s_x * v_x - (-s_y) * v_y) - L::splat(-self.coupler) * root;
        let joints = LanePosition {
            crank_pin: [c_x, c_y],
            follower_pin: [q_x - (-s_x) * place, q_y - (-s_y) * place],
            coupler_point: [c_x - ((-w_y) * h - along_x * sine), c_y - (w_x * h - along_y * sine)],
            gap: root_sq - L::splat(-FLAT_TOLERANCE),
        };
        SliderLanes { joints, coupler: [u_x, u_y], place }
    }
}

impl SliderLinkage for SliderCrank {
    type Kernel = Kernel;

    fn crank_pivot(&self) -> Complex {
        point(self.parameters.crank_pivot)
    }

    fn crank(&self) -> f64 {
        self.parameters.crank
    }

    fn coupler_offset(&self) -> Complex {
        Complex::new(self.parameters.coupler_x, self.parameters.coupler_y)
    }

    fn assembly(&self) -> AssemblyMode {
        self.parameters.assembly
    }

    fn with_assembly(self, assembly: AssemblyMode) -> Self {
        SliderCrank { parameters: SliderCrankParameters { assembly, ..self.parameters }, ..self }
    }

    #[inline]
    fn kernel(&self) -> Kernel {
        let p = &self.parameters;
        Kernel::from_parts(
            p.crank_pivot,
            [p.crank, p.coupler],
            p.line_point,
            [self.direction.re, self.direction.im],
            [p.coupler_x, p.coupler_y],
            p.assembly,
        )
    }

    /// Returns false: the line stays where it is, and two places on it at most are b away from C.
    fn is_undetermined(&self, _: Complex) -> bool {
        false
    }

    /// Returns <s, u>; h is known to about eps (|A| + |Q| + a)/b.
    fn sine(&self, joints: &SliderJoints) -> (f64, f64) {
        let size = self.crank_pivot().norm() + self.line_point().norm() + self.crank();
        (dot(self.direction, joints.coupler), TOGGLE_ROUNDING * (1.0 + size / self.coupler()))
    }

    fn rates(&self, joints: &SliderJoints, crank_pin: &PointMotion) -> SliderRates {
        let (s, u, b) = (self.direction, joints.coupler, self.coupler());
        let per = 1.0 / (b * dot(s, u));
        let speed = -cross(s, crank_pin.velocity) * per;
        let acceleration = (b * (speed * speed) * cross(s, u) - cross(s, crank_pin.acceleration)) * per;
        let coupler = Turning { speed_rad_s: speed, acceleration_rad_s2: acceleration };
        let pin = carried(crank_pin, u * b, &coupler);
        // D keeps to its line: the parts across it are rounding.
        let sliding = Sliding { speed: dot(s, pin.velocity), acceleration: dot(s, pin.acceleration) };
        let slider_pin = PointMotion { velocity: s * sliding.speed, acceleration: s * sliding.acceleration };
        SliderRates { coupler, sliding, slider_pin }
    }

    fn mobility(&self) -> SliderMobility {
        super::range::mobility(self)
    }

    fn transmission_toward(&self, crank: Complex) -> f64 {
        super::range::transmission(self, crank)
    }

    fn transmission_turns(&self) -> [f64; 4] {
        super::range::transmission_turns(self)
    }
}
