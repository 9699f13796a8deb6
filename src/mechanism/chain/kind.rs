//! The chain as a mechanism of any kind.

use super::motion::Motion;
use super::{Chain, ChainInput, Outcome, PointId, Pose};
use crate::mechanism::any::{CrankRange, Link, Mechanism, MechanismMotion, MechanismPose, Status};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::structure::Structure;

/// Number of crank angles from which the range of the crank is found.
pub const CYCLE_SAMPLES: usize = 720;

impl Chain {
    fn described(&self, outcome: Outcome, pose: &Pose) -> MechanismPose {
        let status = match outcome {
            Outcome::Closed => Status::Ok,
            Outcome::Open { .. } => Status::Open,
            Outcome::Singular { .. } => Status::Singular,
            Outcome::InputNotUsable => Status::NotFinite,
        };
        MechanismPose {
            status,
            stuck: outcome.stage().and_then(|stage| self.joint_of(stage)).map(PointId::index),
            joints: (0..self.names.len()).map(|i| pose.point(PointId(i))).collect(),
            coupler: None,
            output: None,
            transmission: None,
        }
    }
}

impl Mechanism for Chain {
    fn kind(&self) -> &'static str {
        "chain"
    }

    fn joint_names(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }

    fn pivots(&self) -> usize {
        self.pivots.len()
    }

    fn traced(&self) -> usize {
        self.trace
    }

    fn pose_at(&self, crank_angle: f64) -> MechanismPose {
        let mut pose = self.pose();
        let outcome = self.position(crank_angle, &mut pose);
        self.described(outcome, &pose)
    }

    fn motion_at(&self, crank_angle: f64, input: CrankMotion) -> MechanismMotion {
        let mut motion: Motion = self.motion();
        let outcome = self.move_at(crank_angle, input.speed_rad_s, input.acceleration_rad_s2, &mut motion);
        let points = || (0..self.names.len()).map(PointId);
        MechanismMotion {
            pose: self.described(outcome, motion.pose()),
            velocities: points().map(|id| motion.velocity(id)).collect(),
            accelerations: points().map(|id| motion.acceleration(id)).collect(),
            coupler: None,
            output: None,
        }
    }

    /// Finds the range from [`CYCLE_SAMPLES`] samples.
    fn crank_range(&self) -> CrankRange {
        let input = self.input(CYCLE_SAMPLES);
        let turns_fully = input.is_full();
        let arcs = match input {
            ChainInput::Full | ChainInput::Never => Vec::new(),
            ChainInput::Arcs(arcs) => arcs.iter().map(|arc| [arc.from, arc.to]).collect(),
        };
        CrankRange { turns_fully, arcs, toggles: Vec::new(), circuits: None, margin: None }
    }

    fn moving_links(&self) -> Vec<Link> {
        let link = |joints: &Vec<PointId>| {
            let names: Vec<&str> = joints.iter().map(|id| self.names[id.0].as_str()).collect();
            Link { name: names.join("-"), joints: joints.iter().map(|id| id.0).collect(), length: None }
        };
        let mut links: Vec<Link> = self.links.iter().skip(1).map(link).collect();
        if let Some(crank) = links.first_mut() {
            crank.length = Some(self.crank);
        }
        links
    }
    fn structure(&self) -> Structure {
        self.parts()
    }
}
