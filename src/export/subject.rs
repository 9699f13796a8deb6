//! What is exported: a linkage with what is known of its target.

use crate::linkage::{AssemblyMode, FourBar};
use crate::linkage_file::LinkageFile;
use crate::name;
use crate::record::{Candidate, Record, Unit};
use crate::report::text::clean;

/// A linkage to export.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The name of its problem or file: foreign text.
    pub name: String,
    /// What it is, in words: `candidate 2 of 5`.
    pub standing: String,
    /// What its lengths are in.
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: FourBar,
    /// The target points; empty without a run.
    pub target: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    pub closed: bool,
    /// Crank angle (radians) and assembly at each target point.
    pub positions: Vec<(f64, AssemblyMode)>,
}

impl Subject {
    /// A candidate of a record.
    pub fn of_candidate(record: &Record, candidate: &Candidate) -> Self {
        let path = &record.problem.resolved.task.path;
        let angles = candidate.crank_deg.iter().map(|angle| angle.to_radians());
        Subject {
            name: record.problem.name.clone(),
            standing: match candidate.rank {
                0 => "the buildable candidate".to_owned(),
                rank => format!("candidate {rank} of {}", record.candidates.len()),
            },
            unit: record.problem.unit,
            linkage: candidate.linkage,
            target: path.points.clone(),
            closed: path.closed,
            positions: angles.zip(candidate.t1_at.iter().copied()).filter(|(a, _)| a.is_finite()).collect(),
        }
    }

    /// A linkage without a run.
    pub fn of_linkage(file: &LinkageFile) -> Self {
        Subject {
            name: file.name.clone(),
            standing: "a linkage file".to_owned(),
            unit: file.unit,
            linkage: file.linkage,
            target: Vec::new(),
            closed: false,
            positions: Vec::new(),
        }
    }

    /// The name on one line, without anything that commands a terminal; never empty.
    pub fn title(&self) -> String {
        let name = clean(&self.name);
        if name.is_empty() { "unnamed".to_owned() } else { name }
    }

    /// The name as a linkage file may have it.
    pub fn legal_name(&self) -> String {
        name::legal(&self.name, "linkage")
    }
}
