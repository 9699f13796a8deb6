//! Velocity and acceleration at one crank angle, in natural coordinates.
//!
//! With w = D - C and r = D - B the two distance constraints (Romero, equations 5 and 6), differentiated once
//! and twice by time, are linear in D' and in D'':
//!
//! ```text
//! <w, D'> = <w, C'>                         <r, D'>  = 0
//! <w, D''> = <w, C''> - |D' - C'|^2         <r, D''> = -|D'|^2
//! <w, X> = p, <r, X> = q   gives   X = (p i r - q i w) / <w, i r>,    <w, i r> = b c sin(theta3 - theta4)
//! ```
//!
//! theta3 and theta4 are the angles of coupler and follower; theta3 - theta4 is the transmission angle up to
//! its sign, so that the one determinant vanishes at a toggle. These are the equations of C. A. De Castro,
//! written without angles:
//!
//! | De Castro | here |
//! |---|---|
//! | (8), (16): pin A of the crank | C' = i omega2 (C - A), C'' = (i alpha2 - omega2^2) (C - A) |
//! | (9)-(12), (17)-(21): pin B seen from both links | the linear systems above |
//! | (13), (14): omega3, omega4 | <i w, D' - C'>/b^2, <i r, D'>/c^2 |
//! | (15), (24): the output point | P' = C' + z (D' - C'), P'' = C'' + z (D'' - C'') |
//! | (22), (23): alpha3, alpha4 | <i w, D'' - C''>/b^2, <i r, D''>/c^2 |
//!
//! His pins A and B are C and D here; z is [`FourBar::coupler_ratio`].
//!
//! # Near a toggle
//! Velocities grow as 1/sin mu and accelerations as 1/sin^3 mu. sin^2 mu itself comes from squared lengths and
//! is known to about delta = 8 eps (b^2 + c^2 + s (|A| + |B| + a))/(b c), s = |CB|: a velocity has a relative
//! error up to delta/(2 sin^2 mu), an acceleration three times that (compared with 60 digits, at 4,000 positions
//! within 1e-4 of a toggle, the worst was 0.87 of it). If sin^2 mu is at most 8 delta, or |sin mu| at most
//! [`TOGGLE_SINE`], the answer is [`Motion::Singular`] and no number.

use super::gradient::TOGGLE_SINE;
use crate::mechanism::{AssemblyMode, Complex, FourBar, Joints, Position, dot, turned};
use serde::Serialize;
use std::f64::consts::TAU;

/// sin^2 of the transmission angle at and below which a position counts as a toggle, as a part of
/// (b^2 + c^2 + s (|A| + |B| + a))/(b c): squared lengths leave an eighth of it to rounding. Just above it a
/// velocity may be off by 1/16, an acceleration by 3/16; below it no digit is sure.
pub const TOGGLE_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Motion of the crank at one instant: angular velocity omega2 and angular acceleration alpha2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CrankMotion {
    /// omega2, rad/s, counter-clockwise positive.
    #[serde(rename = "omega2_rad_s")]
    pub speed_rad_s: f64,
    /// alpha2, rad/s^2, counter-clockwise positive.
    #[serde(rename = "alpha2_rad_s2")]
    pub acceleration_rad_s2: f64,
}

impl CrankMotion {
    /// Returns the motion of a crank at a steady speed in rad/s: alpha2 = 0.
    pub fn steady(speed_rad_s: f64) -> Self {
        CrankMotion { speed_rad_s, acceleration_rad_s2: 0.0 }
    }

    /// Returns the motion of a crank at a steady speed in turns a minute: omega2 = 2 pi rpm/60.
    pub fn steady_rpm(speed_rpm: f64) -> Self {
        CrankMotion::steady(speed_rpm * (TAU / 60.0))
    }
}

/// Position of the linkage: joints, angles of coupler and follower, and the sine that vanishes at a toggle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// C, D and P.
    pub joints: Joints,
    /// theta3 = arg(D - C), radians in (-pi, pi].
    pub coupler_angle: f64,
    /// theta4 = arg(D - B), radians in (-pi, pi].
    pub follower_angle: f64,
    /// sin(theta3 - theta4) = <w, i r>/(b c), by its size the sine of the transmission angle; its sign is
    /// opposite to t1's.
    pub sine: f64,
}

/// Angular motion of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Angular velocity omega, rad/s, counter-clockwise positive.
    pub speed_rad_s: f64,
    /// Angular acceleration alpha, rad/s^2, counter-clockwise positive.
    pub acceleration_rad_s2: f64,
}

/// Velocity and acceleration of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// Velocity, in units of length a second.
    pub velocity: Complex,
    /// Acceleration, in units of length a second squared.
    pub acceleration: Complex,
}

/// The motion of every moving part at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkageMotion {
    /// The position to which the motion belongs.
    pub posture: Posture,
    /// omega3 and alpha3 (De Castro 13 and 22).
    pub coupler: Turning,
    /// omega4 and alpha4 (De Castro 14 and 23).
    pub follower: Turning,
    /// Velocity and acceleration of C (De Castro 8 and 16).
    pub crank_pin: PointMotion,
    /// Velocity and acceleration of D (De Castro 9 and 17).
    pub follower_pin: PointMotion,
    /// Velocity and acceleration of P (De Castro 15 and 24).
    pub coupler_point: PointMotion,
}

/// Result of the velocity and acceleration analysis at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The linkage moves in a definite way.
    Definite(LinkageMotion),
    /// Coupler and follower are in line, within rounding (see the module): the position is known, but the
    /// crank's motion does not decide that of the other links.
    Singular(Posture),
    /// The loop does not close at this crank angle.
    Open,
    /// C lies on B and b = c: every direction of the follower closes the loop.
    Undetermined,
    /// The crank's speed or acceleration is no finite number, or so large that an answer overflows.
    NotFinite,
}

impl Motion {
    /// Returns the motion if it is definite.
    pub fn definite(self) -> Option<LinkageMotion> {
        match self {
            Motion::Definite(motion) => Some(motion),
            Motion::Singular(_) | Motion::Open | Motion::Undetermined | Motion::NotFinite => None,
        }
    }

    /// Returns the position if it is known, at a toggle too.
    pub fn posture(self) -> Option<Posture> {
        match self {
            Motion::Definite(motion) => Some(motion.posture),
            Motion::Singular(posture) => Some(posture),
            Motion::Open | Motion::Undetermined | Motion::NotFinite => None,
        }
    }
}

impl FourBar {
    /// Computes velocities and accelerations at the crank angle `crank_angle` (radians from the x axis), by the
    /// module's equations. No allocation; about 0.1 microseconds, half of it the sine, cosine and two arctangents.
    ///
    /// The answer is [`Motion::Singular`] at a toggle, [`Motion::Open`] if the loop is open or the crank angle is no
    /// number, and [`Motion::Open`] or [`Motion::Undetermined`] with C on B, as in [`FourBar::position`].
    ///
    /// ```
    /// # use linkwright::internals::mechanism::*;
    /// # use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
    /// // De Castro, examples 3.1 and 4.1: omega3 = 10.10 rad/s, alpha4 = 30.46 rad/s^2.
    /// let linkage = FourBar::from_vector_loop(VectorLoop {
    ///     crank_pivot: [0.0, 0.0], follower_pivot: [-350.0, 0.0], crank: 700.0, coupler: 300.0,
    ///     follower: 500.0, coupler_point: 200.0, beta_deg: 30.0, assembly: AssemblyMode::Plus })?;
    /// let motion = linkage.motion(120f64.to_radians(), CrankMotion::steady(5.0)).definite().unwrap();
    /// assert!((motion.coupler.speed_rad_s - 10.0973).abs() < 5e-5);
    /// assert!((motion.follower.acceleration_rad_s2 - 30.45945).abs() < 5e-6);
    /// # Ok::<(), LinkageError>(())
    /// ```
    pub fn motion(&self, crank_angle: f64, input: CrankMotion) -> Motion {
        self.motion_with(crank_angle, self.assembly(), input)
    }

    /// Computes the motion as [`FourBar::motion`] does, with the given assembly mode.
    pub fn motion_with(&self, crank_angle: f64, assembly: AssemblyMode, input: CrankMotion) -> Motion {
        let joints = match self.position_with(crank_angle, assembly) {
            Position::Closed(joints) => joints,
            Position::Open => return Motion::Open,
            Position::Undetermined => return Motion::Undetermined,
        };
        let posture = self.posture(joints);
        if self.is_toggle(&posture) {
            return Motion::Singular(posture);
        }
        let motion = self.motion_in(posture, input);
        if motion.is_finite() { Motion::Definite(motion) } else { Motion::NotFinite }
    }

    /// Computes the angles of a position from its joints, whatever its conditioning.
    pub fn posture(&self, joints: Joints) -> Posture {
        let w = joints.follower_pin - joints.crank_pin;
        let r = joints.follower_pin - self.follower_pivot();
        Posture {
            joints,
            coupler_angle: w.arg(),
            follower_angle: r.arg(),
            sine: dot(w, turned(r)) / (self.coupler() * self.follower()),
        }
    }

    fn is_toggle(&self, posture: &Posture) -> bool {
        let (b, c) = (self.coupler(), self.follower());
        // No hypot: coordinates are below 1e12, so that no square overflows.
        let size = |x: Complex| x.norm_sqr().sqrt();
        let s = size(self.follower_pivot() - posture.joints.crank_pin);
        let from_origin = size(self.crank_pivot()) + size(self.follower_pivot()) + self.crank();
        let rounding = TOGGLE_ROUNDING * (b * b + c * c + s * from_origin) / (b * c);
        posture.sine.abs() <= TOGGLE_SINE || posture.sine * posture.sine <= rounding
    }

    fn motion_in(&self, posture: Posture, input: CrankMotion) -> LinkageMotion {
        let CrankMotion { speed_rad_s: omega, acceleration_rad_s2: alpha } = input;
        let Joints { crank_pin, follower_pin, .. } = posture.joints;
        let (b, c, z) = (self.coupler(), self.follower(), self.coupler_ratio());
        let w = follower_pin - crank_pin;
        let r = follower_pin - self.follower_pivot();
        let arm = crank_pin - self.crank_pivot();
        let inverse = 1.0 / (b * c * posture.sine);
        // <w, X> = p and <r, X> = q.
        let solve = |p: f64, q: f64| (turned(r) * p - turned(w) * q) * inverse;

        let v_c = turned(arm) * omega; // (8)
        let v_d = solve(dot(w, v_c), 0.0); // (9) to (12)
        let v_w = v_d - v_c;
        let a_c = turned(arm) * alpha - arm * (omega * omega); // (16)
        let a_d = solve(dot(w, a_c) - v_w.norm_sqr(), -v_d.norm_sqr()); // (17) to (21)
        let a_w = a_d - a_c;
        let (per_b, per_c) = (1.0 / (b * b), 1.0 / (c * c));
        LinkageMotion {
            posture,
            coupler: Turning {
                speed_rad_s: dot(turned(w), v_w) * per_b,         // (13)
                acceleration_rad_s2: dot(turned(w), a_w) * per_b, // (22)
            },
            follower: Turning {
                speed_rad_s: dot(turned(r), v_d) * per_c,         // (14)
                acceleration_rad_s2: dot(turned(r), a_d) * per_c, // (23)
            },
            crank_pin: PointMotion { velocity: v_c, acceleration: a_c },
            follower_pin: PointMotion { velocity: v_d, acceleration: a_d },
            coupler_point: PointMotion {
                velocity: v_c + z * v_w,     // (15)
                acceleration: a_c + z * a_w, // (24)
            },
        }
    }
}

impl LinkageMotion {
    fn is_finite(&self) -> bool {
        let turns = [self.coupler, self.follower].map(|t| Complex::new(t.speed_rad_s, t.acceleration_rad_s2));
        let points = [self.crank_pin, self.follower_pin, self.coupler_point];
        let points = points.map(|p| [p.velocity, p.acceleration]);
        turns.iter().chain(points.as_flattened()).all(|x| x.is_finite())
    }
}
