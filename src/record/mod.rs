//! The record of a run: what was asked, done and found.
//!
//! A record holds no time, host or path; the same binary writes the same bytes for the same problem and
//! seed, whatever the number of threads.
//!
//! | module | holds |
//! |---|---|
//! | [`assemblies`] | the assembly at each target point |
//! | [`certificate`] | what is proved about a result: no linkage of the covered kind can have a lower sum of squares |
//! | [`digest`] | the digest of the data that determine a search |
//! | [`errors`] | the errors of a candidate |
//! | [`exact`] | exact synthesis: every linkage through nine points, counted, and the real ones listed |
//! | [`extras`] | additions to a candidate's figures: warnings, the same curve by other linkages, families of answers |
//! | [`front`] | the front of a problem and the picks beside its closest candidate |
//! | [`kinds`] | the best linkage of each kind that was searched for |
//! | [`limits`] | what a record may hold: nothing that no run writes, so that a reader's work and memory are bounded by its file |
//! | [`pick`] | the linkages that a record offers beside its ranked candidates, each with the name that files and commands use |
//! | [`repeats`] | repeated hits of the best answer, and the chance that a better one was not seen |
//! | [`statistics`] | statistics of many runs: medians, hits, the best run |
//! | [`suite`] | the figures of a suite: problems with a known answer, many seeds each |
//! | [`sweep`] | sweeps: many problems that are one problem with different values of some keys |

use crate::mechanism::{CrankLinkage, LinkageType, Unit};
use crate::task::ranges::{Reference, Scales};
pub use crate::task::requirement::LimitUnit;
use crate::task::spec::{Method, ProblemSpec, TaskSpec, TransmissionOver};
use crate::task::{Defect, Sense};
use digest::NotWritten;
use serde::{Deserialize, Serialize};

mod assemblies;
mod certificate;
pub mod digest;
mod errors;
mod exact;
mod extras;
mod front;
mod kinds;
mod limits;
mod pick;
mod repeats;
pub mod statistics;
pub mod suite;
pub mod sweep;

pub use assemblies::Assemblies;
pub use certificate::{Certificate, CertificatePart, Difference};
pub use errors::{AngleErrorRecord, CurveErrorRecord, ErrorRecord, TwoSidedRecord};
pub use exact::{
    Census, Certified, Completeness, ExactForm, ExactLinkage, ExactRecord, GENERIC_CLASSES, generic_classes,
};
pub use extras::{Alternative, Family, ON_BOUND_TEXT, Warning, WarningKind};
pub use front::{Axis, EQUAL_FIGURES, Figures, Front, LEAST_AXES, MOST_AXES, MOST_MEMBERS, Member, Picks};
pub use kinds::BestOfKind;
pub use limits::BeyondLimits;
pub use pick::Pick;
pub use repeats::Repeats;

/// A requirement is met within this part of max(1, |limit|), and figures this near to each other are equal to a reader.
pub const MET_TOLERANCE: f64 = 1e-7;

/// A fit whose mean squared error is below this part of size^2 is exact: rounding is all that is left.
pub const EXACT_MEAN_SQ: f64 = 1e-24;

/// The format that this program writes and reads.
pub const FORMAT: u32 = 1;

/// A run: problem, method, termination, candidates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Record {
    /// [`FORMAT`].
    pub format: u32,
    /// What wrote it.
    pub tool: Tool,
    /// What was asked.
    pub problem: ProblemRecord,
    /// The seed of every draw.
    pub seed: u64,
    /// How it was searched.
    pub method: MethodRecord,
    /// Why the search ended.
    pub termination: Termination,
    /// The evaluations that the run cost.
    pub evaluations: Evaluations,
    /// Said where the answers are members of a whole family of exact answers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// Where the first candidate has warnings: the best one found without that. Its rank is the one that it has
    /// among the candidates, 0 where it is none of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub buildable: Option<Candidate>,
    /// An acceptable six-bar or eight-bar, where four-bars alone are searched for and none is acceptable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other_kind: Option<Candidate>,
    /// The best linkage of each kind, the simplest first, where several kinds are searched for and one has several loops.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub of_kinds: Vec<BestOfKind>,
    /// Linkages nearly as good as the closest that are smaller, or transmit better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picks: Option<Picks>,
    /// The trade-off between the axes that `front` was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<Front>,
    /// Nine precision points: every linkage through them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact: Option<ExactRecord>,
    /// The answers, best first.
    pub candidates: Vec<Candidate>,
    /// Where nothing is acceptable: requirements that cannot be met together, as far as was searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conflict: Option<Conflict>,
    /// Where nothing is acceptable: the least changes that were found to help, nearest first. Each was tried
    /// with the settings of this run and ended with an accepted candidate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub relaxations: Vec<Relaxation>,
    /// What is proved about the best candidate, where `certify` was run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// Why there is none, where the problem asks for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_certificate: Option<String>,
    /// How often the best answer came back from independent starts, where the search counted that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeats: Option<Repeats>,
}

impl Record {
    /// Returns the record of a run of this program that ended with these candidates; everything else is absent.
    pub fn new(
        problem: ProblemRecord,
        used: Vec<String>,
        reason: Reason,
        evaluations: Evaluations,
        candidates: Vec<Candidate>,
    ) -> Record {
        let solve = &problem.resolved.solve;
        Record {
            format: FORMAT,
            tool: Tool::this(),
            seed: solve.seed,
            method: MethodRecord { asked: solve.method, used },
            problem,
            termination: Termination { reason, reproducible: reason.is_repeatable() },
            evaluations,
            family: None,
            buildable: None,
            other_kind: None,
            of_kinds: Vec::new(),
            picks: None,
            front: None,
            exact: None,
            candidates,
            conflict: None,
            relaxations: Vec::new(),
            certificate: None,
            no_certificate: None,
            repeats: None,
        }
    }
}

/// Name and version of the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Tool {
    /// linkwright.
    pub name: String,
    /// The version.
    pub version: String,
}

impl Tool {
    /// Returns name and version of this program.
    pub fn this() -> Tool {
        Tool { name: env!("CARGO_PKG_NAME").into(), version: env!("CARGO_PKG_VERSION").into() }
    }
}

/// The problem as it was run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ProblemRecord {
    /// Its name.
    pub name: String,
    /// Where it comes from, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The label of lengths: mm, cm, m or in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// SHA-256 of what decides the search: task, design, require, objective, method and its parameters, seed.
    pub digest: String,
    /// Every key with its default filled in.
    pub resolved: ProblemSpec,
}

impl ProblemRecord {
    /// Returns a problem with the digest of its specification.
    ///
    /// # Errors
    /// As [`digest`](digest::digest).
    pub fn new(
        name: String,
        source: Option<String>,
        unit: Option<Unit>,
        resolved: ProblemSpec,
    ) -> Result<ProblemRecord, NotWritten> {
        Ok(ProblemRecord { name, source, unit, digest: digest::digest(&resolved)?, resolved })
    }
}

/// The method asked for and the methods that ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MethodRecord {
    /// As in the problem file.
    pub asked: Method,
    /// What ran, in order.
    pub used: Vec<String>,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// The best answer was found again and again from different starts, or the error of a dense target kept its level for
    /// several times as many starts as it took to reach it.
    Converged,
    /// The target was met: exact answers, as many as were asked for.
    TargetReached,
    /// The search ran out of ideas before its budget.
    Stalled,
    /// The budget of evaluations was used up.
    EvaluationLimit,
    /// The time limit bit.
    TimeLimit,
    /// It was cancelled.
    Cancelled,
    /// Nothing was searched for: `snap` brought lengths of an answer to stock sizes and fitted the rest.
    Snapped,
    /// Nothing was searched for: the linkage was fitted under the hand, in the studio.
    ByHand,
}

impl Reason {
    /// Whether the same problem and seed give the same record again: not after a clock, a cancellation or a hand.
    pub fn is_repeatable(self) -> bool {
        match self {
            Reason::Converged
            | Reason::TargetReached
            | Reason::Stalled
            | Reason::EvaluationLimit
            | Reason::Snapped => true,
            Reason::TimeLimit | Reason::Cancelled | Reason::ByHand => false,
        }
    }
}

/// Why the search ended and whether the run can be repeated to the digit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Termination {
    /// Why.
    pub reason: Reason,
    /// Whether the same problem and seed give the same record ([`Reason::is_repeatable`]).
    pub reproducible: bool,
}

/// What a search cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Evaluations {
    /// How often the objective was computed.
    pub objective: u64,
    /// How many positions of the linkage were computed for that.
    pub positions: u64,
}

/// Returns the type of a four-bar, of other kinds the kind.
pub fn type_name(linkage_type: Option<LinkageType>, linkage: &CrankLinkage) -> &'static str {
    linkage_type.map_or(linkage.kind().name(), LinkageType::name)
}

/// One answer with every figure and verdict, all recomputed by the referee.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Candidate {
    /// 1 is the best.
    pub rank: usize,
    /// The linkage.
    pub linkage: CrankLinkage,
    /// The crank angle at each target point, degrees from the x axis, unwrapped.
    pub crank_deg: Vec<f64>,
    /// The assembly at each target point; of a six-bar the signs of its dyads.
    pub t1_at: Assemblies,
    /// In a motion: the angle from the direction C -> D to the body's x axis, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame_deg: Option<f64>,
    /// In a function: the crank's angle from the ground line A -> B, or a slider-crank's line, at an input of zero, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_offset_deg: Option<f64>,
    /// In a function: the follower's angle from the ground line A -> B at an output of zero, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_offset_deg: Option<f64>,
    /// In a function of a slider's places: the place at an output of zero, in the sense of the outputs; of a slider-crank from
    /// the foot of the perpendicular from A on the line, of an inverted one from C along the coupler.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_offset: Option<f64>,
    /// In a function with a free input range: the angle that the crank turns through, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_range_deg: Option<f64>,
    /// In a function with a free output range: the angle that the follower turns through as its outputs go from the least to
    /// the greatest, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_range_deg: Option<f64>,
    /// In a function: the sense in which output angles count; of a slider's places `same` along its line (of a block along the
    /// coupler from C) and `opposite` against it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sense: Option<Sense>,
    /// How far the coupler point is from the target.
    pub error: ErrorRecord,
    /// The type of a four-bar; absent of other kinds.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// Of a four-bar p + q - s - l; of other kinds the length that is at least zero where the crank turns fully.
    pub grashof_margin: f64,
    /// The transmission angle's extremes.
    pub transmission_deg: TransmissionRecord,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// The torque of largest size on the crank under the loads of the problem, N m: over a full turn of a crank that turns fully,
    /// else between the crank angles used; absent without loads, and of a motion that passes a toggle.
    #[serde(rename = "peak_torque_N_m", default, skip_serializing_if = "Option::is_none")]
    pub peak_torque: Option<f64>,
    /// Every defect found, whether it is allowed or not.
    pub defects: Vec<Defect>,
    /// Why it may be a poor one to build although its error is good.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// Other linkages of the same curve (its cognates), the better first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Alternative>,
    /// Whether the target is symmetric and the linkage's mirror image, which is another one, is accepted too and as good:
    /// it is not listed.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirror_serves: bool,
    /// Each requirement with its value and limit.
    pub requirements: Vec<Requirement>,
    /// Every requirement met, no defect that is disallowed, within the tolerance if one was asked.
    pub accepted: bool,
    /// The proof that an exact linkage stands there, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certified: Option<Certified>,
    /// What the limits that it stands on cost.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<Cost>,
}

impl Candidate {
    /// Returns the type of a four-bar, of other kinds the kind.
    pub fn type_name(&self) -> &'static str {
        type_name(self.linkage_type, &self.linkage)
    }

    /// Returns the angle from which the angles of its link count, degrees: in a motion `frame_deg`, from the direction C -> D
    /// to the body's x axis; in a function from the follower's direction to that of an output of zero.
    pub fn own_frame_deg(&self) -> Option<f64> {
        let of_output = || Some(-(self.output_offset_deg? + self.linkage.ground_angle().to_degrees()));
        // A place is written as the angle of as many degrees.
        self.frame_deg.or_else(of_output).or_else(|| Some(-self.output_offset? * self.sense?.signs()[0]))
    }

    /// Returns the scales of the inputs and the outputs of a function as its task writes them: 1 unless their range is free.
    pub fn scales(&self, task: &TaskSpec) -> Scales {
        if self.input_range_deg.is_none() && self.output_range_deg.is_none() {
            return [1.0; 2];
        }
        let [input, output] = task.written_ranges_deg();
        [
            self.input_range_deg.map_or(1.0, |range| range / input),
            self.output_range_deg.map_or(1.0, |range| range / output),
        ]
    }

    /// Returns the angle from which the angles of its link count, with the scale of a function's outputs.
    pub fn own_reference(&self, task: &TaskSpec) -> Option<Reference> {
        Some(Reference { frame_deg: self.own_frame_deg()?, scale: self.scales(task)[1] })
    }
}

/// The word of a requirement's value for a motion that returns to its first point by reversing.
pub const TO_AND_FRO: &str = "to-and-fro";

impl Candidate {
    /// Whether the motion returns to the first point of a closed path by reversing, and the problem allows that.
    pub fn goes_to_and_fro(&self) -> bool {
        let is_word = |figure: &Figure| *figure == Figure::Word(TO_AND_FRO.to_owned());
        self.requirements.iter().any(|r| r.name == "closing" && is_word(&r.value))
    }
}

/// The transmission angle's extremes, degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TransmissionRecord {
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
    /// min(mu, 180 - mu) at its worst.
    pub worst: f64,
    /// Over which motion.
    pub over: TransmissionOver,
}

/// A value or a limit of a requirement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum Figure {
    /// A number.
    Number(f64),
    /// Several, such as a box.
    Numbers(Vec<f64>),
    /// A word, such as a type.
    Word(String),
    /// Several words.
    Words(Vec<String>),
}

/// Returns a list as it is typed: `[1, 2]`.
fn list(items: impl IntoIterator<Item: ToString>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| item.to_string()).collect();
    format!("[{}]", items.join(", "))
}

impl Figure {
    /// Returns the number or numbers; none for words.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Figure::Number(number) => std::slice::from_ref(number),
            Figure::Numbers(numbers) => numbers,
            Figure::Word(_) | Figure::Words(_) => &[],
        }
    }
}

impl std::fmt::Display for Figure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Figure::Number(number) => write!(f, "{number}"),
            Figure::Numbers(numbers) => f.write_str(&list(numbers)),
            Figure::Word(word) => f.write_str(word),
            Figure::Words(words) => f.write_str(&list(words)),
        }
    }
}

/// A requirement of a candidate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Requirement {
    /// The key in the problem file.
    pub name: String,
    /// What the candidate has.
    pub value: Figure,
    /// What was asked.
    pub limit: Figure,
    /// Whether it is met.
    pub met: bool,
}

/// What a limit costs that a candidate stands on.
///
/// Errors here are sqrt(objective / sum of weights), which is the rms error where no point has a weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Cost {
    /// The requirement: its key in `[require]`, or `design.` with the parameter.
    pub name: String,
    /// Which of its sides: xmin, ymin, xmax, ymax of a box, min or max of bounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<String>,
    /// Where that side stands; 0 for the Grashof margin of a type.
    pub limit: f64,
    /// The change of the rms error for one unit more of room (a box side or an upper bound moved out, a lower
    /// bound or a least angle lowered), as a rate at the limit: never positive. Absent where it cannot be told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms_per_unit: Option<f64>,
    /// What one unit is.
    pub unit_of_limit: LimitUnit,
    /// The least rms error that was found without the requirement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms_without: Option<f64>,
}

/// Requirements that cannot be met together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Conflict {
    /// Their keys in the problem file. Without any one of them the others could be met; a single one cannot be
    /// met by itself.
    pub among: Vec<String>,
}

/// A change of the problem after which something acceptable is found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Relaxation {
    /// The keys to set.
    pub set: Vec<Change>,
    /// The best sum of squares then.
    pub sum_sq: f64,
    /// Its rms error.
    pub rms: f64,
}

/// A key of the problem file with another value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Change {
    /// The key, as in `--set KEY=VALUE`.
    pub key: String,
    /// What it is in the problem.
    pub from: TypedValue,
    /// What to set it to.
    pub to: TypedValue,
}

/// A value of a problem file's key. It is displayed as it is typed in `--set KEY=VALUE`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum TypedValue {
    /// A number.
    Number(f64),
    /// Several, such as a box or bounds.
    Numbers(Vec<f64>),
    /// The bounds of a point.
    Pairs(Vec<[f64; 2]>),
    /// A word.
    Word(String),
    /// Several words, such as types.
    Words(Vec<String>),
}

impl std::fmt::Display for TypedValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            TypedValue::Number(number) => write!(f, "{number}"),
            TypedValue::Numbers(values) => f.write_str(&list(values)),
            TypedValue::Pairs(pairs) => f.write_str(&list(pairs.iter().map(list))),
            TypedValue::Word(word) => f.write_str(word),
            TypedValue::Words(words) => f.write_str(&list(words.iter().map(|w| format!("\"{w}\"")))),
        }
    }
}

/// The name of this search in a record.
pub const RELAXED: &str = "relaxed-requirements";
