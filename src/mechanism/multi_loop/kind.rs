//! A linkage of several loops as a mechanism of any kind.

use super::{Body, MultiLoop};
use crate::mechanism::MAX_MAGNITUDE;
use crate::mechanism::any::{CrankRange, Link, Mechanism, MechanismMotion, MechanismPose, Status};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use crate::mechanism::plates;
use crate::mechanism::structure::Structure;
use std::f64::consts::TAU;

impl MultiLoop {
    /// Returns a pose at which no joint but the pivots is known.
    fn unknown(&self, status: Status) -> MechanismPose {
        let joints = self.joints().iter().map(|joint| (joint.body == 0).then_some(joint.at)).collect();
        MechanismPose { status, stuck: None, joints, coupler: None, output: None, transmission: None }
    }
}

impl Mechanism for MultiLoop {
    fn kind(&self) -> &'static str {
        self.linkage_kind().name()
    }

    fn joint_names(&self) -> Vec<&str> {
        self.joints().iter().map(|joint| joint.name).collect()
    }

    fn pivots(&self) -> usize {
        self.joints().iter().filter(|joint| joint.body == 0).count()
    }

    fn traced(&self) -> usize {
        self.joints().len() - 1
    }

    fn pose_at(&self, crank_angle: f64) -> MechanismPose {
        if crank_angle.is_nan() || crank_angle.abs() >= MAX_MAGNITUDE {
            return self.unknown(Status::NotFinite);
        }
        let Some(bodies) = self.bodies(crank_angle) else { return self.unknown(Status::Open) };
        let place = |joint: &super::NamedJoint| Some(bodies.place(joint.body, joint.at));
        MechanismPose {
            status: Status::Ok,
            stuck: None,
            joints: self.joints().iter().map(place).collect(),
            coupler: None,
            output: None,
            transmission: Some(self.transmission_at(crank_angle)),
        }
    }

    fn motion_at(&self, crank_angle: f64, input: CrankMotion) -> MechanismMotion {
        let Ok(chain) = self.to_chain() else {
            let none = vec![None; self.joints().len()];
            let pose = self.unknown(Status::NotFinite);
            return MechanismMotion {
                pose,
                velocities: none.clone(),
                accelerations: none,
                coupler: None,
                output: None,
            };
        };
        let motion = chain.motion_at(crank_angle, input);
        let transmission = (motion.pose.status == Status::Ok).then(|| self.transmission_at(crank_angle));
        MechanismMotion { pose: MechanismPose { transmission, ..motion.pose }, ..motion }
    }

    fn crank_range(&self) -> CrankRange {
        let margin = self.full_turn_margin();
        CrankRange {
            turns_fully: margin > 0.0,
            arcs: Vec::new(),
            toggles: Vec::new(),
            circuits: None,
            margin: Some(margin),
        }
    }

    fn moving_links(&self) -> Vec<Link> {
        let names = self.joint_names();
        let index = |name: &str| names.iter().position(|other| *other == name);
        let link = |Body { joints, .. }: Body| Link {
            name: joints.iter().map(|(name, _)| *name).collect::<Vec<_>>().join("-"),
            length: (joints.len() > 1).then(|| (joints[1].1 - joints[0].1).norm()),
            joints: joints.iter().filter_map(|(name, _)| index(name)).collect(),
        };
        self.links().into_iter().skip(1).map(link).collect()
    }

    fn transmission_extremes(&self) -> Option<TransmissionExtremes> {
        Some(self.transmission_between([0.0, TAU]))
    }

    fn longest_to_shortest(&self) -> Option<f64> {
        Some(self.link_ratio()).filter(|ratio| ratio.is_finite())
    }
    /// Returns the bodies by the names of their plates.
    fn structure(&self) -> Structure {
        let Ok(chain) = self.to_chain() else { return Structure::default() };
        let mut structure = chain.structure();
        for (body, link) in structure.bodies.iter_mut().zip(plates::Link::OF_BODIES) {
            body.name = link.name().to_owned();
        }
        structure
    }
}
