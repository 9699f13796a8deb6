//! The messages between a tab and the studio, as JSON; the schemas are made from these types.

use super::pin_map::PinMap;
use super::targets::{BodyAsk, FunctionAsk};
use crate::files::problem_file::Expect;
use crate::mechanism::{CrankLinkage, LinkageKeys, LinkageKind, LinkageType, Unit};
use crate::record::{AngleErrorRecord, Candidate, ExactLinkage, ExactRecord, ProblemRecord, Relaxation};
use crate::report::exact;
use crate::report::html::{Drive, Track};
use crate::task::Sense;
use crate::task::requirement::InputPolicy;
use crate::task::spec::{
    ClosingPolicy, DirectionPolicy, Limits, Method, Objective, OnePolicy, OrderPolicy, RawPoints, TaskSpec,
    TimingSpec, TransmissionOver,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// An edit: a target and the requirements of its linkage, as a tab has them. All lengths are in `unit`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// The target points in their order: 3 to 1000; in a motion the places of the body's origin, in a function the pairs
    /// [input, output] in degrees: 2 to 1000.
    pub points: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    #[serde(default)]
    pub closed: bool,
    /// In a motion: the angles of the body at the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<BodyAsk>,
    /// In a function: what its angles are measured from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<FunctionAsk>,
    /// The largest error accepted at any point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The largest error accepted at each point, in place of `tolerance`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerances: Option<Vec<f64>>,
    /// One positive weight a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// The crank angle at each point; absent: free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timing: Option<TimingSpec>,
    /// The digitised points that `points` were smoothed or resampled from; not read if they no longer are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw: Option<RawPoints>,
    /// The kinds of linkages that are searched for; empty: four-bars.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mechanism: Vec<LinkageKind>,
    /// The types allowed of four-bars; empty: any.
    #[serde(default)]
    pub types: Vec<LinkageType>,
    /// The range of the input.
    #[serde(default, skip_serializing_if = "is_default")]
    pub input: InputPolicy,
    /// The least and the greatest distance between the ends of a slider-crank's slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Limits>,
    /// The least and the greatest ratio of the crank's angles for the slower and the quicker way of a slider-crank's slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_ratio: Option<Limits>,
    /// The least transmission angle, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmission_deg_min: Option<f64>,
    /// Longest over shortest link at most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link_ratio_max: Option<f64>,
    /// The box that must hold both fixed pivots: xmin, ymin, xmax, ymax.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pivots_in: Option<[f64; 4]>,
    /// The box that must hold every joint and the coupler point over the motion used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub footprint_in: Option<[f64; 4]>,
    /// Over which motion the transmission angle is judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmission_over: Option<TransmissionOver>,
    /// Whether the points must be passed in order.
    #[serde(default, skip_serializing_if = "is_default")]
    pub order: OrderPolicy,
    /// The way in which the crank turns.
    #[serde(default, skip_serializing_if = "is_default")]
    pub direction: DirectionPolicy,
    /// Whether the motion must stay on one circuit.
    #[serde(default, skip_serializing_if = "is_default")]
    pub circuit: OnePolicy,
    /// Whether the motion must stay on one branch.
    #[serde(default, skip_serializing_if = "is_default")]
    pub branch: OnePolicy,
    /// The way in which a target that ends where it begins is closed.
    #[serde(default, skip_serializing_if = "is_default")]
    pub closing: ClosingPolicy,
    /// The method of the search; `continuation`: all linkages through exactly nine points.
    #[serde(default, skip_serializing_if = "is_default")]
    pub method: Method,
    /// The quantity that is minimised.
    #[serde(default, skip_serializing_if = "is_default")]
    pub objective: Objective,
    /// Other keys of the problem file under `design`, `require` and `solve`, each with its value as it is typed there.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub kept: BTreeMap<String, String>,
    /// The source of the problem, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The known answer; not read if the problem is another by now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<Known>,
    /// The seed of every draw.
    #[serde(default = "one")]
    pub seed: u64,
    /// The hand is still moving: the search waits until it rests.
    #[serde(default, skip_serializing_if = "is_default")]
    pub moving: bool,
    /// The number of a linkage that stays among the answers while it can follow the hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<u64>,
    /// A linkage to begin with: it is fitted from where it is, and stays among the answers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<LinkageKeys>,
    /// The target has nothing to do with the one before: nothing is to follow it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fresh: bool,
    /// In a motion: the answers are to hold the map of the places of a pin.
    #[serde(default, skip_serializing_if = "is_default")]
    pub map: bool,
}

/// The known answer of a problem, as under `[expect]` in its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// A hash of the problem that it belongs to: of its target, bounds, requirements and objective.
    pub of: String,
    /// The figures.
    pub answer: Expect,
}

fn unnamed() -> String {
    "drawing".into()
}

fn one() -> u64 {
    1
}

pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The activity of the studio for a tab.
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

/// How sure it is that a search has missed nothing better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Sure {
    /// As far as sampling can be, or proved.
    Sure,
    /// Fairly.
    Fairly,
    /// Not.
    Not,
}

/// The answer to an edit. Later answers to the same edit replace earlier ones; answers that were not sent before the
/// next came are dropped.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Answer {
    /// The edit's version.
    pub version: u64,
    /// The activity.
    pub doing: Doing,
    /// The same in words: what is done, how sure it is, and what prevents better answers.
    pub said: String,
    /// Of a search that has ended with an acceptable answer: how sure it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sure: Option<Sure>,
    /// The part of the search's budget that is used, 0 to 1; most searches end before it is used up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub progress: Option<f64>,
    /// The linkages, better first; in exact mode all real ones through the nine points.
    pub candidates: Vec<Shown>,
    /// In exact mode: the numbers of linkages through the nine points, by kind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nine: Option<Counted>,
    /// If nothing is acceptable: the changes that help, nearest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub relaxations: Vec<Relaxation>,
    /// The map of the places of a pin, where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<PinMap>,
}

/// The linkages through nine points, counted.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Counted {
    /// Solutions up to cognates, complex ones included.
    pub classes: usize,
    /// Those that are linkages.
    pub real: usize,
    /// Of these, those that pass all points on one circuit.
    pub one_circuit: usize,
    /// Of these, in order.
    pub in_order: usize,
    /// Of these, on one branch.
    pub free_of_defects: usize,
    /// The same and more in words.
    pub said: Vec<String>,
}

impl Counted {
    pub(super) fn of(exact: &ExactRecord) -> Counted {
        let census = &exact.census;
        Counted {
            classes: census.classes,
            real: census.real,
            one_circuit: census.one_circuit,
            in_order: census.in_order,
            free_of_defects: census.free_of_defects,
            said: super::status::census(exact),
        }
    }
}

/// A linkage with its figures, ready to be played.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Shown {
    /// Its rank, from 1.
    pub rank: usize,
    /// Its number: it keeps it while it follows the hand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub number: Option<u64>,
    /// The linkage, as in records.
    pub linkage: CrankLinkage,
    /// The motion of a linkage of several loops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub track: Option<Track>,
    /// Its drive over its motion.
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
    /// In a motion: the angle from the direction C -> D to the body's x axis, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_deg: Option<f64>,
    /// In a function: the follower's angle from the line A -> B at an output of 0, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_offset_deg: Option<f64>,
    /// In a function: the sense in which its outputs count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sense: Option<Sense>,
    /// The errors of the body's angle in a motion, of the output in a function.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<AngleErrorRecord>,
    /// Its type; of a linkage with a slider its kind.
    #[serde(rename = "type")]
    pub type_name: &'static str,
    /// The worst transmission angle, degrees from 0 to 90.
    pub transmission_deg: f64,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// Whether every requirement is met and no defect is there that is not allowed.
    pub accepted: bool,
    /// The requirements that are not met, by their keys, and the defects.
    pub unmet: Vec<String>,
    /// Through nine points: the abilities of the best of the curve's six mechanisms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ability: Option<String>,
    /// Through nine points: the proved distance within which there is one exact linkage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certified_within: Option<f64>,
}

impl Shown {
    /// Returns a candidate that follows the hand under a number.
    pub(super) fn numbered((number, candidate): (&u64, &Candidate)) -> Shown {
        Shown { number: Some(*number), ..Shown::of(candidate) }
    }

    /// Returns a real linkage through nine points that is judged.
    pub(super) fn exact(judged: &Candidate, rank: usize, linkage: &ExactLinkage) -> Shown {
        Shown {
            rank,
            ability: Some(exact::ability(linkage).into()),
            certified_within: linkage.certified.map(|certified| certified.radius),
            ..Shown::of(judged)
        }
    }

    /// Returns a candidate ready to be played.
    pub(super) fn of(candidate: &Candidate) -> Shown {
        let missed = candidate.requirements.iter().filter(|r| !r.met).map(|r| r.name.clone());
        Shown {
            rank: candidate.rank,
            number: None,
            linkage: candidate.linkage,
            track: candidate.linkage.multi_loop().map(Track::of),
            drive: Drive::new(candidate.linkage, &candidate.crank_deg, &candidate.t1_at),
            crank_deg: candidate.crank_deg.clone(),
            t1_at: candidate.t1_at.iter().map(|t1| i64::from(*t1)).collect(),
            worst: candidate.error.max_at,
            rms: candidate.error.rms,
            max: candidate.error.max,
            frame_deg: candidate.frame_deg,
            output_offset_deg: candidate.output_offset_deg,
            sense: candidate.sense,
            angle: candidate.error.of_link().copied(),
            type_name: candidate.type_name(),
            transmission_deg: candidate.transmission_deg.worst,
            link_ratio: candidate.link_ratio,
            accepted: candidate.accepted,
            unmet: missed.collect(),
            ability: None,
            certified_within: candidate.certified.map(|certified| certified.radius),
        }
    }
}

/// The target of a problem, with its name.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Target {
    /// The problem's name.
    pub name: String,
    /// The label of lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// The target points.
    pub points: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    pub closed: bool,
}

impl From<&ProblemRecord> for Target {
    fn from(ProblemRecord { name, unit, resolved, .. }: &ProblemRecord) -> Target {
        let TaskSpec { points, closed, .. } = &resolved.task;
        Target { name: name.clone(), unit: *unit, points: points.clone(), closed: *closed }
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
    pub linkage: LinkageKeys,
}

/// The kind of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A points file: a header row with x,y and optionally `crank_deg`, `weight`, `tolerance`, of poses also `angle_deg`
    /// and `tolerance_deg`; or with input_deg,output_deg and optionally `weight`, `tolerance_deg`.
    Csv,
    /// A drawing.
    Svg,
    /// A problem file.
    Problem,
    /// A report (`report.html`), or its data (JSON): `first`, `mechanisms`, `problem`.
    Report,
}

/// A text to be read.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Text {
    /// Its kind.
    pub kind: Kind,
    /// Its name in messages, and that of a problem without a name.
    #[serde(default)]
    pub name: String,
    /// The text itself.
    pub text: String,
    /// The id of a drawing's shape; absent: the first.
    #[serde(default)]
    pub svg_id: Option<String>,
    /// The number of points taken along a drawing; absent: 60.
    #[serde(default)]
    pub samples: Option<usize>,
    /// The unit into which a drawing's physical lengths are converted; absent: mm.
    #[serde(default)]
    pub unit: Option<Unit>,
}

/// A text that was read.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Reading {
    /// The edit that asks for it. If it is not whole, the text held only the points with their columns, `closed` and
    /// `unit`.
    pub ask: Ask,
    /// Whether it is a whole problem, with its requirements.
    pub whole: bool,
    /// Warnings about values that are ignored or cannot succeed.
    pub warnings: Vec<String>,
}

/// The schemas of all messages, each under the name of its type.
pub fn schemas() -> serde_json::Value {
    serde_json::json!({
        "Ask": schemars::schema_for!(Ask).to_value(),
        "Answer": schemars::schema_for!(Answer).to_value(),
        "LinkageAsk": schemars::schema_for!(LinkageAsk).to_value(),
        "Text": schemars::schema_for!(Text).to_value(),
        "Reading": schemars::schema_for!(Reading).to_value(),
    })
}
