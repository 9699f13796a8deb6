//! The subject of an export: a linkage with the known facts about its target.

use crate::files::linkage_file::{Carried, LinkageFile};
use crate::files::name;
use crate::judge::practicality::Sweep;
use crate::mechanism::plates::{Shop, Stretch};
use crate::mechanism::{AssemblyMode, CrankLinkage, Unit};
use crate::record::{Candidate, Record};
use crate::report::scene::positions_at;
use crate::report::text::clean;
use crate::report::words::standing;
use crate::task::Problem;

/// A linkage to export.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The name of its problem or file: foreign text.
    pub name: String,
    /// A short description of the linkage: `candidate 2 of 5`.
    pub standing: String,
    /// The unit of its lengths.
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: CrankLinkage,
    /// The target points; empty without a run.
    pub target: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    pub closed: bool,
    /// The crank angle (radians) and assembly at each target point.
    pub positions: Vec<(f64, AssemblyMode)>,
    /// The motion for which the slot of a slider is made, and in which plates must not cross; not needed of a four-bar without shop
    /// data.
    pub motion: Vec<Stretch>,
    /// In a motion: the angle from C -> D to the body's x axis, degrees.
    pub frame_deg: Option<f64>,
    /// The body or the function that moves with its links; `None` in a path.
    pub carried: Option<Carried>,
    /// In a motion: the angle of the body at each target, degrees; `None` where only the place counts.
    pub body_deg: Vec<Option<f64>>,
    /// The sizes of single holes, pins and plates; lengths without a unit are in that of the linkage.
    pub shop: Option<Shop>,
}

impl Subject {
    /// Returns the subject of a candidate of a record.
    pub fn of_candidate(record: &Record, candidate: &Candidate) -> Self {
        let path = &record.problem.resolved.task;
        let mut positions = positions_at(&candidate.crank_deg, &candidate.t1_at);
        positions.retain(|(angle, _)| angle.is_finite());
        Subject {
            name: record.problem.name.clone(),
            standing: standing(record, candidate),
            unit: record.problem.unit,
            linkage: candidate.linkage,
            target: path.points.clone(),
            closed: path.closed,
            positions,
            motion: if candidate.linkage.four_bar().is_some() {
                Vec::new()
            } else {
                motion_of(record, candidate)
            },
            frame_deg: candidate.frame_deg,
            carried: Carried::of(candidate),
            body_deg: path
                .body
                .as_ref()
                .filter(|_| !path.is_function())
                .map_or(Vec::new(), |body| body.angle_deg.clone()),
            shop: None,
        }
    }

    /// Returns the subject of a candidate of a record that is built with shop data.
    pub fn of_candidate_for_shop(record: &Record, candidate: &Candidate, shop: Option<Shop>) -> Self {
        let subject = Subject::of_candidate(record, candidate);
        match shop {
            Some(_) => Subject { motion: motion_of(record, candidate), shop, ..subject },
            None => subject,
        }
    }

    /// Returns the subject of a linkage without a run.
    pub fn of_linkage<L: Into<CrankLinkage> + Copy>(file: &LinkageFile<L>) -> Self {
        let linkage = file.linkage.into();
        Subject {
            name: file.name.clone(),
            standing: "a linkage file".to_owned(),
            unit: file.unit,
            linkage,
            target: Vec::new(),
            closed: false,
            positions: Vec::new(),
            motion: Sweep::of_linkage(linkage).map_or(Vec::new(), |sweep| sweep.stretches),
            frame_deg: None,
            carried: None,
            body_deg: Vec::new(),
            shop: None,
        }
    }

    /// Returns the name on one line, without characters that act on a terminal; never empty.
    pub fn title(&self) -> String {
        let name = clean(&self.name);
        if name.is_empty() { "unnamed".to_owned() } else { name }
    }

    /// Returns the name in a form that is legal in a linkage file.
    pub fn legal_name(&self) -> String {
        name::legal(&self.name, "linkage")
    }
}

/// Returns the motion of a candidate, as it is examined for building.
fn motion_of(record: &Record, candidate: &Candidate) -> Vec<Stretch> {
    let problem = Problem::new(record.problem.resolved.clone()).ok();
    let sweep = problem.and_then(|problem| Sweep::of_candidate(&problem, candidate));
    sweep.map_or(Vec::new(), |sweep| sweep.stretches)
}
