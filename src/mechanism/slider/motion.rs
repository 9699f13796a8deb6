//! Velocity and acceleration of the joints, the coupler and the slider of a linkage with a slider.
//!
//! With psi the coupler's angle, u' = i psi' u and
//!
//! ```text
//! C' = i omega (C - A)                C'' = (i alpha - omega^2)(C - A)
//! P' = C' + i psi' Z u                P'' = C'' + (i psi'' - psi'^2) Z u
//! D' = C' + (x' + i psi' x) u         D'' = C'' + (x'' - psi'^2 x + i (psi'' x + 2 psi' x')) u
//! ```
//!
//! with x the distance of D from C along the coupler: b, which is constant, of a slider-crank, and the slider's place of an
//! inverted one. psi', psi'', x' and x'' come from the closure of the kind ([`SliderLinkage::rates`]).

use super::{SliderJoints, SliderLinkage, SliderPosition};
use crate::mechanism::four_bar::gradient::TOGGLE_SINE;
pub use crate::mechanism::four_bar::motion::{CrankMotion, PointMotion, Turning};
use crate::mechanism::{Complex, turned};

/// Velocity and acceleration of the slider along its guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// The first derivative of the slider's place, in units of length a second.
    pub speed: f64,
    /// The second derivative, in units of length a second squared.
    pub acceleration: f64,
}

/// Rates of the coupler and of the slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderRates {
    /// psi' and psi''.
    pub coupler: Turning,
    /// The derivatives of the slider's place.
    pub sliding: Sliding,
    /// Velocity and acceleration of D.
    pub slider_pin: PointMotion,
}

/// The motion of every moving part at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingMotion {
    /// The position to which the motion belongs.
    pub joints: SliderJoints,
    /// Velocity and acceleration of C.
    pub crank_pin: PointMotion,
    /// Rates of the coupler, of the slider and of D.
    pub rates: SliderRates,
    /// Velocity and acceleration of P.
    pub coupler_point: PointMotion,
}

/// Result of the velocity and acceleration analysis at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderMotion {
    /// The linkage moves in a definite way.
    Definite(SlidingMotion),
    /// A toggle: the position is known, but the crank's motion does not decide that of coupler and slider.
    Singular(SliderJoints),
    /// The loop does not close at this crank angle.
    Open,
    /// C lies on B and the coupler's line passes through both: every direction closes the loop.
    Undetermined,
    /// The crank's speed or acceleration is no finite number, or so large that an answer overflows.
    NotFinite,
}

impl SliderMotion {
    /// Returns the motion if it is definite.
    pub fn definite(self) -> Option<SlidingMotion> {
        match self {
            SliderMotion::Definite(motion) => Some(motion),
            SliderMotion::Singular(_)
            | SliderMotion::Open
            | SliderMotion::Undetermined
            | SliderMotion::NotFinite => None,
        }
    }

    /// Returns the position if it is known, at a toggle too.
    pub fn joints(self) -> Option<SliderJoints> {
        match self {
            SliderMotion::Definite(motion) => Some(motion.joints),
            SliderMotion::Singular(joints) => Some(joints),
            SliderMotion::Open | SliderMotion::Undetermined | SliderMotion::NotFinite => None,
        }
    }
}

/// Computes velocities and accelerations at the crank angle `crank_angle` (radians from the x axis), by the module's
/// equations, with the speed (rad/s) and the acceleration (rad/s^2) of the crank.
///
/// The answer is [`SliderMotion::Singular`] where the sine of the transmission angle is at most [`TOGGLE_SINE`] or lost in
/// rounding.
pub fn motion<S: SliderLinkage>(linkage: &S, crank_angle: f64, input: CrankMotion) -> SliderMotion {
    let joints = match linkage.position(crank_angle) {
        SliderPosition::Closed(joints) => joints,
        SliderPosition::Open => return SliderMotion::Open,
        SliderPosition::Undetermined => return SliderMotion::Undetermined,
    };
    let (sine, rounding) = linkage.sine(&joints);
    if sine.is_nan() || sine.abs() <= TOGGLE_SINE || sine * sine <= rounding {
        return SliderMotion::Singular(joints);
    }
    let CrankMotion { speed_rad_s: omega, acceleration_rad_s2: alpha } = input;
    let arm = joints.crank_pin - linkage.crank_pivot();
    let crank_pin = PointMotion {
        velocity: turned(arm) * omega,
        acceleration: turned(arm) * alpha - arm * (omega * omega),
    };
    let rates = linkage.rates(&joints, &crank_pin);
    let coupler_point = carried(&crank_pin, joints.coupler * linkage.coupler_offset(), &rates.coupler);
    let motion = SlidingMotion { joints, crank_pin, rates, coupler_point };
    if motion.is_finite() { SliderMotion::Definite(motion) } else { SliderMotion::NotFinite }
}

/// Computes the motion of a point at `arm` from C on the turning coupler.
pub(in crate::mechanism) fn carried(from: &PointMotion, arm: Complex, turning: &Turning) -> PointMotion {
    let Turning { speed_rad_s: omega, acceleration_rad_s2: alpha } = *turning;
    PointMotion {
        velocity: from.velocity + turned(arm) * omega,
        acceleration: from.acceleration + turned(arm) * alpha - arm * (omega * omega),
    }
}

impl SlidingMotion {
    fn is_finite(&self) -> bool {
        let SliderRates { coupler, sliding, slider_pin } = self.rates;
        let rates = [
            Complex::new(coupler.speed_rad_s, coupler.acceleration_rad_s2),
            Complex::new(sliding.speed, sliding.acceleration),
        ];
        let points = [self.crank_pin, slider_pin, self.coupler_point].map(|p| [p.velocity, p.acceleration]);
        rates.iter().chain(points.as_flattened()).all(|x| x.is_finite())
    }
}
