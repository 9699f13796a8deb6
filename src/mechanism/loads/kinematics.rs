//! Derivatives of all places by the crank angle: with the crank at unit speed and without acceleration, velocities are z' =
//! dz/dphi, and accelerations z'' = d^2 z/dphi^2.
//!
//! ```text
//! v = z' phi_dot        a = z'' phi_dot^2 + z' phi_ddot
//! ```
//!
//! A body with two joints p and q has the direction u = (q - p)/|q - p| and turns by omega' = (q - p) x (q' - p')/|q - p|^2,
//! omega'' = (q - p) x (q'' - p'')/|q - p|^2.

use crate::mechanism::any::Status;
use crate::mechanism::chain::{self, Outcome, PointId};
use crate::mechanism::four_bar::motion::{CrankMotion, LinkageMotion, Motion, PointMotion};
use crate::mechanism::structure::{Body, Frame, Line, Structure};
use crate::mechanism::{Chain, Complex, Linkage, MAX_MAGNITUDE, cross, turned};

/// The crank at unit speed, by which all derivatives are taken.
const UNIT_SPEED: CrankMotion = CrankMotion { speed_rad_s: 1.0, acceleration_rad_s2: 0.0 };

/// A place with its first and second derivative by the crank angle, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moving {
    pub(super) at: Complex,
    pub(super) first: Complex,
    pub(super) second: Complex,
}

impl Moving {
    /// A point that does not move.
    pub(super) fn still(at: Complex) -> Self {
        Moving { at, first: Complex::new(0.0, 0.0), second: Complex::new(0.0, 0.0) }
    }

    /// Returns the acceleration of the point with the crank's motion.
    pub(super) fn acceleration(&self, input: CrankMotion) -> Complex {
        self.second * (input.speed_rad_s * input.speed_rad_s) + self.first * input.acceleration_rad_s2
    }
}

/// A body at one position: its origin, its unit direction, and the derivatives of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BodyState {
    pub(super) origin: Moving,
    pub(super) direction: Complex,
    pub(super) first: f64,
    pub(super) second: f64,
}

impl BodyState {
    /// Returns a point of the body by its place along and across it.
    pub(super) fn point(&self, place: Complex) -> Moving {
        let arm = self.direction * place;
        Moving {
            at: self.origin.at + arm,
            first: self.origin.first + turned(arm) * self.first,
            second: self.origin.second + turned(arm) * self.second - arm * (self.first * self.first),
        }
    }

    /// Returns the angular acceleration with the crank's motion.
    pub(super) fn acceleration(&self, input: CrankMotion) -> f64 {
        self.second * input.speed_rad_s * input.speed_rad_s + self.first * input.acceleration_rad_s2
    }
}

/// The source of positions.
#[derive(Clone, Debug)]
pub(super) enum Source {
    /// A linkage of one loop.
    Loop(Linkage),
    /// A chain, also of a linkage of several loops: its buffers are used again.
    Chain(Box<Chain>),
}

/// Joints and bodies at one position.
#[derive(Clone, Debug)]
pub(super) struct Kinematics {
    pub(super) joints: Vec<Moving>,
    pub(super) bodies: Vec<BodyState>,
    motion: Option<chain::Motion>,
}

impl Source {
    /// Returns the source of positions of a linkage; `None` beyond the limits of a chain.
    pub(super) fn of(linkage: &Linkage) -> Option<Self> {
        match linkage {
            Linkage::FourBar(_) | Linkage::SliderCrank(_) | Linkage::InvertedSliderCrank(_) => {
                Some(Source::Loop(linkage.clone()))
            }
            Linkage::MultiLoop(linkage) => Some(Source::Chain(Box::new(linkage.to_chain().ok()?))),
            Linkage::Chain(chain) => Some(Source::Chain(chain.clone())),
        }
    }
}

impl Kinematics {
    /// Allocates the buffers.
    pub(super) fn new(source: &Source, structure: &Structure, joints: usize) -> Self {
        let zero = Moving::still(Complex::new(0.0, 0.0));
        let body = BodyState { origin: zero, direction: Complex::new(1.0, 0.0), first: 0.0, second: 0.0 };
        let motion = match source {
            Source::Chain(chain) => Some(chain.motion()),
            Source::Loop(_) => None,
        };
        Kinematics { joints: vec![zero; joints], bodies: vec![body; structure.bodies.len()], motion }
    }

    /// Computes joints and bodies at a crank angle, `scale` metres to the linkage's unit; the status if they are not definite.
    pub(super) fn place(
        &mut self,
        source: &Source,
        structure: &Structure,
        scale: f64,
        crank_angle: f64,
    ) -> Result<(), Status> {
        let mut coupler = None;
        match source {
            // As below, without allocation.
            Source::Loop(Linkage::FourBar(linkage)) => {
                let motion = linkage.motion(crank_angle, UNIT_SPEED);
                let Motion::Definite(LinkageMotion {
                    posture, crank_pin, follower_pin, coupler_point, ..
                }) = motion
                else {
                    return Err(motion.status());
                };
                let places = posture.joints;
                let moving = |at: Complex, point: &PointMotion| Moving {
                    at: at * scale,
                    first: point.velocity * scale,
                    second: point.acceleration * scale,
                };
                let joints = [
                    Moving::still(linkage.crank_pivot() * scale),
                    Moving::still(linkage.follower_pivot() * scale),
                    moving(places.crank_pin, &crank_pin),
                    moving(places.follower_pin, &follower_pin),
                    moving(places.coupler_point, &coupler_point),
                ];
                self.joints.copy_from_slice(&joints);
            }
            Source::Loop(linkage) => {
                let motion = linkage.mechanism().motion_at(crank_angle, UNIT_SPEED);
                if motion.pose.status != Status::Ok {
                    return Err(motion.pose.status);
                }
                for (i, joint) in self.joints.iter_mut().enumerate() {
                    let parts = (motion.pose.joints[i], motion.velocities[i], motion.accelerations[i]);
                    let (Some(at), Some(first), Some(second)) = parts else { return Err(Status::NotFinite) };
                    *joint = Moving { at: at * scale, first: first * scale, second: second * scale };
                }
                coupler = motion.pose.coupler.zip(motion.coupler);
            }
            Source::Chain(chain) => {
                let motion = self.motion.get_or_insert_with(|| chain.motion());
                match chain.move_at(crank_angle, 1.0, 0.0, motion) {
                    Outcome::Closed => {}
                    Outcome::Open { .. } => return Err(Status::Open),
                    Outcome::Singular { .. } => return Err(Status::Singular),
                    Outcome::InputNotUsable => return Err(Status::NotFinite),
                }
                for (i, joint) in self.joints.iter_mut().enumerate() {
                    let id = PointId(i);
                    let parts = (motion.point(id), motion.velocity(id), motion.acceleration(id));
                    let (Some(at), Some(first), Some(second)) = parts else { return Err(Status::NotFinite) };
                    *joint = Moving { at: at * scale, first: first * scale, second: second * scale };
                }
            }
        }
        for (i, body) in structure.bodies.iter().enumerate() {
            let state = match body.frame {
                Frame::Coupler(from) => {
                    let (direction, turning) = coupler.ok_or(Status::NotFinite)?;
                    let (first, second) = (turning.speed_rad_s, turning.acceleration_rad_s2);
                    BodyState { origin: self.joints[from], direction, first, second }
                }
                _ => self.state(structure.crank_pivot, body),
            };
            self.bodies[i] = state;
        }
        self.is_usable().then_some(()).ok_or(Status::NotFinite)
    }

    /// Returns the state of a body whose frame follows from the joints and from earlier bodies. The ground's origin is the crank's
    /// pivot, about which its moments count.
    fn state(&self, crank_pivot: usize, body: &Body) -> BodyState {
        let still =
            |origin: Moving, direction: Complex| BodyState { origin, direction, first: 0.0, second: 0.0 };
        match body.frame {
            Frame::Ground | Frame::Coupler(_) => still(self.joints[crank_pivot], Complex::new(1.0, 0.0)),
            Frame::Joints([from, to]) => {
                let (p, q) = (self.joints[from], self.joints[to]);
                let along = q.at - p.at;
                let per_sq = 1.0 / along.norm_sqr();
                BodyState {
                    origin: p,
                    direction: along * per_sq.sqrt(),
                    first: cross(along, q.first - p.first) * per_sq,
                    second: cross(along, q.second - p.second) * per_sq,
                }
            }
            Frame::Block { at, line: Line::Fixed(direction) } => still(self.joints[at], direction),
            Frame::Block { at, line: Line::OnBody { body, turn } } => {
                let carrier = &self.bodies[body];
                BodyState { origin: self.joints[at], direction: carrier.direction * turn, ..*carrier }
            }
        }
    }

    fn is_usable(&self) -> bool {
        let small = |z: Complex| z.re.abs() <= MAX_MAGNITUDE && z.im.abs() <= MAX_MAGNITUDE;
        self.bodies.iter().all(|body| small(body.direction) && small(Complex::new(body.first, body.second)))
    }
}
