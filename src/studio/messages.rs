//! What a tab and the studio say to each other, as JSON; the schemas are made from these types.

use crate::linkage::{LinkageType, NaturalCoordinates};
use crate::problem::spec::ProblemSpec;
use crate::problem_file::{self, ProblemFile};
use crate::record::{Candidate, Unit};
use crate::report::html::Drive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// The most points of a target in the studio.
pub const MOST_POINTS: usize = 1000;

/// A target and what its linkage must satisfy, as it stands in a tab. All lengths are in `unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ask {
    /// Counts the tab's edits; the answer names the edit that it answers.
    #[serde(default)]
    pub version: u64,
    /// The problem's name, as in problem files.
    #[serde(default = "unnamed")]
    pub name: String,
    /// The label of lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// The target points in their order: 3 to 1000.
    pub points: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    #[serde(default)]
    pub closed: bool,
    /// The largest error accepted at any point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The types allowed; empty: any.
    #[serde(default)]
    pub types: Vec<LinkageType>,
    /// The least transmission angle, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmission_deg_min: Option<f64>,
    /// Longest over shortest link at most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link_ratio_max: Option<f64>,
    /// The box that must hold both fixed pivots: xmin, ymin, xmax, ymax.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pivots_in: Option<[f64; 4]>,
    /// Where every draw comes from.
    #[serde(default = "one")]
    pub seed: u64,
    /// The hand is still moving: the search waits until it rests.
    #[serde(default, skip_serializing_if = "is_false")]
    pub moving: bool,
    /// The target has nothing to do with the one before: nothing is to follow it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub fresh: bool,
}

fn unnamed() -> String {
    "drawing".into()
}

fn one() -> u64 {
    1
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_false(value: &bool) -> bool {
    !value
}

/// A problem that asks for more than the studio's page can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "this problem asks for more than the studio can show (timing, weights, single tolerances, bounds of lengths, \
     another method or objective): run it with `linkwright synth`"
)]
pub struct TooMuch;

impl Ask {
    /// The text of the problem file that asks the same.
    pub fn problem_text(&self) -> String {
        let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
        let mut text =
            format!("# Drawn in linkwright's studio.\nformat = 1\nname = {}\n", quoted(&self.name));
        // Writing to a String cannot fail.
        let _ = self.write_rest(&mut text);
        text
    }

    fn write_rest(&self, text: &mut String) -> std::fmt::Result {
        if let Some(unit) = self.unit {
            writeln!(text, "unit = \"{}\"", unit.label())?;
        }
        writeln!(text, "\n[task.path]\npoints = [")?;
        for [x, y] in &self.points {
            writeln!(text, "    [{x}, {y}],")?;
        }
        writeln!(text, "]\nclosed = {}", self.closed)?;
        if let Some(tolerance) = self.tolerance {
            writeln!(text, "tolerance = {tolerance}")?;
        }
        writeln!(text, "\n[require]")?;
        if !self.types.is_empty() {
            let names: Vec<_> = self.types.iter().map(|t| format!("\"{}\"", t.name())).collect();
            writeln!(text, "type = [{}]", names.join(", "))?;
        }
        if let Some(angle) = self.transmission_deg_min {
            writeln!(text, "transmission_deg_min = {angle}")?;
        }
        if let Some(ratio) = self.link_ratio_max {
            writeln!(text, "link_ratio_max = {ratio}")?;
        }
        if let Some([left, bottom, right, top]) = self.pivots_in {
            writeln!(text, "pivots_in = [{left}, {bottom}, {right}, {top}]")?;
        }
        writeln!(text, "\n[solve]\nseed = {}", self.seed)
    }

    /// The problem that is asked, read as every problem file is.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn problem(&self) -> Result<ProblemFile, String> {
        let n = self.points.len();
        if !(3..=MOST_POINTS).contains(&n) {
            return Err(format!("a target has 3 to {MOST_POINTS} points here, and this one has {n}"));
        }
        if self.seed > i64::MAX as u64 {
            return Err(format!("the seed is at most {}", i64::MAX));
        }
        problem_file::parse("drawing", &self.problem_text(), None, &[]).map_err(|e| e.message.clone())
    }

    /// What to ask for a problem.
    ///
    /// # Errors
    /// [`TooMuch`] where the problem has what an `Ask` cannot say.
    pub fn of(problem: &ProblemFile) -> Result<Ask, TooMuch> {
        let spec = &problem.spec;
        let path = &spec.task.path;
        let tolerance = path.tolerance.as_ref().and_then(|all| all.first().copied());
        let ask = Ask {
            version: 0,
            name: problem.name.clone(),
            unit: problem.unit,
            points: path.points.clone(),
            closed: path.closed,
            tolerance,
            types: spec.require.types.clone(),
            transmission_deg_min: spec.require.transmission_deg_min,
            link_ratio_max: Some(spec.require.link_ratio_max),
            pivots_in: spec.require.pivots_in,
            seed: spec.solve.seed,
            moving: false,
            fresh: false,
        };
        let same = |again: &ProblemSpec| {
            again.task.path.points == path.points
                && again.task.path.tolerance == path.tolerance
                && again.task.path.weight == path.weight
                && again.task.path.timing == path.timing
                && again.design == spec.design
                && again.require == spec.require
                && again.solve.method == spec.solve.method
                && again.solve.objective == spec.solve.objective
        };
        match ask.problem() {
            Ok(again) if same(&again.spec) => Ok(ask),
            _ => Err(TooMuch),
        }
    }
}

/// What the studio is doing for a tab.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Doing {
    /// The answers follow the hand; the search waits for it to rest.
    Following,
    /// The search is running.
    Searching,
    /// The search has ended.
    Done,
    /// The edit makes no problem, for the reason said.
    Refused,
}

/// The answer to an edit. Later answers to the same edit replace earlier ones; answers that were not sent before the
/// next came are dropped.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Answer {
    /// The edit's version.
    pub version: u64,
    /// What is being done.
    pub doing: Doing,
    /// The same in words: what is done, how sure it is, and what stands in the way.
    pub said: String,
    /// How far the search is, 0 to 1 of its budget; most end before it is used up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub progress: Option<f64>,
    /// The linkages, better first.
    pub candidates: Vec<Shown>,
}

/// A linkage with its figures, ready to be played.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Shown {
    /// Its rank, from 1.
    pub rank: usize,
    /// The linkage, as in linkage files.
    pub linkage: NaturalCoordinates,
    /// How it is driven over its motion.
    pub drive: Drive,
    /// The crank angle at each target point, degrees.
    pub crank_deg: Vec<f64>,
    /// The assembly (1 or -1) at each point.
    pub t1_at: Vec<i64>,
    /// The number of the worst point, from 0.
    pub worst: usize,
    /// The root of the mean squared error.
    pub rms: f64,
    /// The largest error.
    pub max: f64,
    /// Its type.
    #[serde(rename = "type")]
    pub linkage_type: LinkageType,
    /// The worst transmission angle, degrees from 0 to 90.
    pub transmission_deg: f64,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// Whether every requirement is met and no defect is there that is not allowed.
    pub accepted: bool,
    /// The requirements that are not met, by their keys, and the defects.
    pub unmet: Vec<String>,
}

impl From<&Candidate> for Shown {
    fn from(candidate: &Candidate) -> Shown {
        let missed = candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.clone());
        Shown {
            rank: candidate.rank,
            linkage: candidate.linkage.natural_coordinates(),
            drive: Drive::new(&candidate.linkage, &candidate.crank_deg, &candidate.t1_at),
            crank_deg: candidate.crank_deg.clone(),
            t1_at: candidate.t1_at.iter().map(|t1| i64::from(*t1)).collect(),
            worst: candidate.error.max_at,
            rms: candidate.error.rms,
            max: candidate.error.max,
            linkage_type: candidate.linkage_type,
            transmission_deg: candidate.transmission_deg.worst,
            link_ratio: candidate.link_ratio,
            accepted: candidate.accepted,
            unmet: missed.collect(),
        }
    }
}

/// A linkage to be written as a file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkageAsk {
    /// Its name.
    #[serde(default = "unnamed")]
    pub name: String,
    /// The label of lengths.
    #[serde(default)]
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: NaturalCoordinates,
}

/// The schemas of all messages, each under the name of its type.
pub fn schemas() -> serde_json::Value {
    serde_json::json!({
        "Ask": schemars::schema_for!(Ask).to_value(),
        "Answer": schemars::schema_for!(Answer).to_value(),
        "LinkageAsk": schemars::schema_for!(LinkageAsk).to_value(),
    })
}
