//! Position analysis of the inverted slider-crank in closed form, and the rates of coupler and slider.
//!
//! With V = B - C:
//!
//! ```text
//! C = A + a e^{i phi}
//! x = t1 sqrt(|V|^2 - h^2)               (|V| < |h|: the loop does not close)
//! u = V (x - i h)/|V|^2                  so that V = (x + i h) u
//! D = C + x u,   P = C + Z u
//! ```
//!
//! One division and one square root a position. Sums of products are written as differences, as in
//! [`crate::mechanism::slider_crank::position`]. C on B within rounding leaves u undetermined if h is as small, and the
//! loop open otherwise. The closure Im(V conj u) = h, differentiated once and twice:
//!
//! ```text
//! psi'  = (u x V')/x                                      x'  = h psi' + <u, V'>
//! psi'' = ((u x V'') + h psi'^2 - 2 psi' x')/x            x'' = h psi'' + psi' (u x V') + <u, V''>
//! ```
//!
//! x/|V| is the sine of the transmission angle up to its sign, which vanishes at a toggle.

use super::{InvertedSliderCrank, InvertedSliderCrankParameters};
use crate::mechanism::four_bar::motion::TOGGLE_ROUNDING;
use crate::mechanism::four_bar::position::LanePosition;
use crate::mechanism::slider::motion::{PointMotion, Sliding, Turning, carried};
use crate::mechanism::slider::{
    SliderJoints, SliderKernel, SliderLanes, SliderLinkage, SliderMobility, SliderRates,
};
use crate::mechanism::{AssemblyMode, Complex, FLAT_TOLERANCE, cross, dot, point, turned};
use crate::numbers::arithmetic::lane::Lane;

/// An inverted slider-crank as the coefficients of its position equations.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    pivot: [f64; 2],
    block: [f64; 2],
    crank: f64,
    offset: f64,
    offset_sq: f64,
    /// |V|^2 (1 + [`FLAT_TOLERANCE`]) at which the loop begins to close.
    least_sq: f64,
    coupler_offset: [f64; 2],
    t1: f64,
}

impl Kernel {
    /// Computes the coefficients from A, B, a, h, Z and t1; nothing is checked.
    #[inline(always)]
    pub fn from_parts(
        pivot: [f64; 2],
        block: [f64; 2],
        [crank, offset]: [f64; 2],
        coupler_offset: [f64; 2],
        assembly: AssemblyMode,
    ) -> Self {
        let offset_sq = offset * offset;
        let largest = pivot.iter().chain(&block).chain([&crank]).fold(0.0_f64, |most, x| most.max(x.abs()));
        let least_sq = offset_sq.max(crate::mechanism::chain::coincident_sq(largest));
        Kernel { pivot, block, crank, offset, offset_sq, least_sq, coupler_offset, t1: assembly.sign() }
    }
}

impl SliderKernel for Kernel {
    #[inline(always)]
    fn place<L: Lane>(&self, cos: L, sin: L) -> SliderLanes<L> {
        let splat = |pair: [f64; 2]| pair.map(L::splat);
        let ([a_x, a_y], [b_x, b_y]) = (splat(self.pivot), splat(self.block));
        let ([z_x, z_y], crank, h) =
            (splat(self.coupler_offset), L::splat(-self.crank), L::splat(self.offset));
        let [c_x, c_y] = [a_x - crank * cos, a_y - crank * sin];
        let (v_x, v_y) = (b_x - c_x, b_y - c_y);
        let distance_sq = v_x * v_x + v_y * v_y;
        let root = (distance_sq - L::splat(self.offset_sq)).positive_part().sqrt();
        let x = L::splat(self.t1) * root;
        let per = distance_sq.recip();
        let [u_x, u_y] = [(v_x * x - (-h) * v_y) * per, (v_y * x - h * v_x) * per];
        let joints = LanePosition {
            crank_pin: [c_x, c_y],
            follower_pin: [c_x - (-x) * u_x, c_y - (-x) * u_y],
            coupler_point: [c_x - (z_y * u_y - z_x * u_x), c_y - ((-z_x) * u_y - z_y * u_x)],
            gap: distance_sq * L::splat(1.0 + FLAT_TOLERANCE) - L::splat(self.least_sq),
        };
        SliderLanes { joints, coupler: [u_x, u_y], place: x }
    }
}

impl SliderLinkage for InvertedSliderCrank {
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
        InvertedSliderCrank { parameters: InvertedSliderCrankParameters { assembly, ..self.parameters } }
    }

    #[inline]
    fn kernel(&self) -> Kernel {
        let p = &self.parameters;
        Kernel::from_parts(
            p.crank_pivot,
            p.block_pivot,
            [p.crank, p.offset],
            [p.coupler_x, p.coupler_y],
            p.assembly,
        )
    }

    /// Returns whether C lies on B within rounding and the offset is as small.
    fn is_undetermined(&self, crank_pin: Complex) -> bool {
        let Kernel { least_sq, offset_sq, .. } = self.kernel();
        (self.block_pivot() - crank_pin).norm_sqr() <= least_sq && least_sq > offset_sq
    }

    /// Returns x/|V|; |V| is known to about eps (|A| + |B| + a).
    fn sine(&self, joints: &SliderJoints) -> (f64, f64) {
        let size = self.crank_pivot().norm() + self.block_pivot().norm() + self.crank();
        let distance = (self.block_pivot() - joints.crank_pin).norm();
        (joints.place / distance, TOGGLE_ROUNDING * (1.0 + size / distance))
    }

    fn rates(&self, joints: &SliderJoints, crank_pin: &PointMotion) -> SliderRates {
        let SliderJoints { coupler: u, place: x, .. } = *joints;
        let (v, a, h, per) = (-crank_pin.velocity, -crank_pin.acceleration, self.offset(), 1.0 / x);
        let speed = cross(u, v) * per;
        let sliding_speed = h * speed + dot(u, v);
        let acceleration = (cross(u, a) + h * (speed * speed) - 2.0 * speed * sliding_speed) * per;
        let sliding_acceleration = h * acceleration + speed * cross(u, v) + dot(u, a);
        let coupler = Turning { speed_rad_s: speed, acceleration_rad_s2: acceleration };
        let fixed = carried(crank_pin, u * x, &coupler);
        let slider_pin = PointMotion {
            velocity: fixed.velocity + u * sliding_speed,
            acceleration: fixed.acceleration
                + u * sliding_acceleration
                + turned(u) * (2.0 * speed * sliding_speed),
        };
        let sliding = Sliding { speed: sliding_speed, acceleration: sliding_acceleration };
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
