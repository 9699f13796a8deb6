//! The four-bar as a mechanism of any kind.

use super::motion::{CrankMotion, Motion, Posture};
use super::transmission::TransmissionExtremes;
use crate::mechanism::any::{
    CrankRange, Link, Mechanism, MechanismMotion, MechanismPose, Output, OutputRate, Status,
};
use crate::mechanism::structure::{Body, Group, OutputBody, Pair, Structure};
use crate::mechanism::{Complex, FourBar, Position};

const NAMES: [&str; 5] = ["A", "B", "C", "D", "P"];
/// Index of D.
const FOLLOWER_PIN: usize = 3;

impl FourBar {
    fn described(&self, status: Status, crank_angle: f64, posture: Option<&Posture>) -> MechanismPose {
        let crank_pin = match posture {
            Some(posture) => Some(posture.joints.crank_pin),
            None => Some(self.crank_pivot() + Complex::from_polar(self.crank(), crank_angle)),
        };
        MechanismPose {
            status,
            stuck: (status != Status::Ok).then_some(FOLLOWER_PIN),
            joints: vec![
                Some(self.crank_pivot()),
                Some(self.follower_pivot()),
                crank_pin.filter(|c| c.is_finite()),
                posture.map(|p| p.joints.follower_pin),
                posture.map(|p| p.joints.coupler_point),
            ],
            coupler: posture.map(|p| (p.joints.follower_pin - p.joints.crank_pin) / self.coupler()),
            output: posture.map(|p| Output::Follower(p.follower_angle)),
            transmission: posture.map(|_| self.angle_at_follower_pin(crank_angle)),
        }
    }
}

impl Motion {
    /// Returns the status of the motion.
    pub fn status(&self) -> Status {
        match self {
            Motion::Definite(_) => Status::Ok,
            Motion::Singular(_) => Status::Singular,
            Motion::Open => Status::Open,
            Motion::Undetermined => Status::Undetermined,
            Motion::NotFinite => Status::NotFinite,
        }
    }
}

impl Mechanism for FourBar {
    fn kind(&self) -> &'static str {
        "four-bar"
    }

    fn joint_names(&self) -> Vec<&str> {
        NAMES.to_vec()
    }

    fn pivots(&self) -> usize {
        2
    }

    fn traced(&self) -> usize {
        NAMES.len() - 1
    }

    fn pose_at(&self, crank_angle: f64) -> MechanismPose {
        match self.position(crank_angle) {
            Position::Closed(joints) => self.described(Status::Ok, crank_angle, Some(&self.posture(joints))),
            Position::Open => self.described(Status::Open, crank_angle, None),
            Position::Undetermined => self.described(Status::Undetermined, crank_angle, None),
        }
    }

    fn motion_at(&self, crank_angle: f64, input: CrankMotion) -> MechanismMotion {
        let found = self.motion(crank_angle, input);
        let pose = self.described(found.status(), crank_angle, found.posture().as_ref());
        let moved = found.definite();
        let points = moved.map(|m| [m.crank_pin, m.follower_pin, m.coupler_point]);
        let of = |part: fn(&super::motion::PointMotion) -> Complex| {
            let still = Some(Complex::new(0.0, 0.0));
            let moving = (0..3).map(|i| points.as_ref().map(|points| part(&points[i])));
            [still, still].into_iter().chain(moving).collect()
        };
        MechanismMotion {
            pose,
            velocities: of(|p| p.velocity),
            accelerations: of(|p| p.acceleration),
            coupler: moved.map(|m| m.coupler),
            output: moved.map(|m| OutputRate::Follower(m.follower)),
        }
    }

    fn crank_range(&self) -> CrankRange {
        let mobility = self.mobility();
        CrankRange {
            turns_fully: mobility.input_turns_fully(),
            arcs: mobility.input.arcs().iter().map(|arc| arc.ends()).collect(),
            toggles: mobility.toggles().iter().map(|toggle| toggle.crank_angle).collect(),
            circuits: Some([mobility.circuits(), mobility.branches_per_circuit()]),
            margin: Some(mobility.grashof_margin),
        }
    }

    fn moving_links(&self) -> Vec<Link> {
        let link = |name: &str, joints: &[usize], length: f64| Link {
            name: name.to_owned(),
            joints: joints.to_vec(),
            length: Some(length),
        };
        vec![
            link("crank", &[0, 2], self.crank()),
            link("coupler", &[2, 3, 4], self.coupler()),
            link("follower", &[1, 3], self.follower()),
        ]
    }

    fn transmission_extremes(&self) -> Option<TransmissionExtremes> {
        self.linkage_type().map(|_| self.transmission_over_cycle())
    }

    fn longest_to_shortest(&self) -> Option<f64> {
        Some(self.link_ratio()).filter(|ratio| ratio.is_finite())
    }
    fn structure(&self) -> Structure {
        let x = |along: f64| Complex::new(along, 0.0);
        let p = self.coupler_ratio() * self.coupler();
        Structure {
            bodies: vec![
                Body::ground([(0, self.crank_pivot()), (1, self.follower_pivot())]),
                Body::link("crank", &[(0, x(0.0)), (2, x(self.crank()))]),
                Body::link("coupler", &[(2, x(0.0)), (3, x(self.coupler())), (4, p)]),
                Body::link("follower", &[(1, x(0.0)), (3, x(self.follower()))]),
            ],
            crank_pivot: 0,
            groups: vec![Group {
                bodies: [2, 3],
                pairs: [Pair::pin(2, [1, 2]), Pair::pin(1, [0, 3]), Pair::pin(3, [2, 3])],
            }],
            output: Some(OutputBody::Turns(3)),
        }
    }
}
