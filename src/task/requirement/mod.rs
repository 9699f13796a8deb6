//! Requirements on a linkage, one file each: key, parsing, limits with their outward side, unit and words.
//!
//! [`RequirementKind`] is the list: parser, relaxation, costs, warnings, `verify`, tables, the studio and the template
//! iterate over it. The optimiser's rows of a requirement are in [`crate::task::forms::rows`], the judge's own
//! arithmetic in `judge::requirement`; the two share none.

mod boxes;
mod branch;
mod circuit;
mod closing;
mod direction;
mod extent_max;
mod footprint_in;
mod input;
mod limit;
mod link_ratio;
mod linkage_type;
mod longest_max;
mod order;
mod peak_torque_max;
mod pins_in;
mod pivot_on;
mod pivots_in;
mod stroke;
mod tolerance;
mod tolerance_deg;
mod transmission;

pub use limit::{Limit, LimitUnit};
pub use link_ratio::DEFAULT_LINK_RATIO;
pub use longest_max::DEFAULT_LONGEST;
pub(crate) use pivot_on::RawPivotOn;
pub use transmission::TransmissionOver;

use crate::mechanism::LinkageType;
use crate::task::pivot_on::{Locus, PivotOn};
use crate::task::region::Region;
use crate::task::spec::{
    ClosingPolicy, DirectionPolicy, Limits, OnePolicy, OrderPolicy, ProblemSpec, TimingSpec,
};
use crate::task::values::{Bounds, Corners, LengthOrAny, Number, OneOrMore, OnlyTable, RegionNumbers, XY};
use crate::task::{Defect, Problem};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The requirements: the keys of `[require]`, and the tolerances of the task, in the order of a record. (The bounds of the
/// design come before the tolerances there.)
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RequirementKind {
    /// The key `require.type`.
    Type,
    /// The key `require.input`.
    Input,
    /// The key `require.transmission_deg_min`.
    Transmission,
    /// The key `require.link_ratio_max`.
    LinkRatio,
    /// The key `require.pivots_in`.
    PivotsIn,
    /// The key `require.pivot_on`.
    PivotOn,
    /// The key `require.pins_in`.
    PinsIn,
    /// The key `require.footprint_in`.
    FootprintIn,
    /// The key `require.extent_max`.
    ExtentMax,
    /// The key `require.longest_max`.
    LongestMax,
    /// The key `require.peak_torque_max`.
    PeakTorque,
    /// The key `require.stroke`.
    Stroke,
    /// The key `require.time_ratio`.
    TimeRatio,
    /// The key `require.direction`.
    Direction,
    /// The key `require.order`.
    Order,
    /// The key `require.branch`.
    Branch,
    /// The key `require.circuit`.
    Circuit,
    /// The key `require.closing`.
    Closing,
    /// The key `tolerance` of the task.
    Tolerance,
    /// The key `task.motion.tolerance_deg`.
    ToleranceDeg,
}

impl RequirementKind {
    /// Every kind, in the order in which conflicts name them and relaxations try them.
    pub const IN_CONFLICTS: [RequirementKind; 20] = [
        Self::Transmission,
        Self::PivotsIn,
        Self::PivotOn,
        Self::PinsIn,
        Self::FootprintIn,
        Self::ExtentMax,
        Self::LongestMax,
        Self::LinkRatio,
        Self::PeakTorque,
        Self::Tolerance,
        Self::ToleranceDeg,
        Self::Stroke,
        Self::TimeRatio,
        Self::Type,
        Self::Input,
        Self::Order,
        Self::Direction,
        Self::Circuit,
        Self::Branch,
        Self::Closing,
    ];

    /// The tolerances of the task: of the place and of a body's angle.
    pub const TOLERANCES: [RequirementKind; 2] = [Self::Tolerance, Self::ToleranceDeg];

    /// Returns whether it is a tolerance of the task.
    pub fn is_tolerance(self) -> bool {
        Self::TOLERANCES.contains(&self)
    }

    /// Returns whether a requirement of this name in a record is a tolerance of the task.
    pub fn names_tolerance(name: &str) -> bool {
        Self::TOLERANCES.iter().any(|kind| kind.name() == name)
    }

    /// Returns whether a requirement of this name in a record puts pivots on lines, which fixes them there.
    pub fn names_line(name: &str) -> bool {
        name == Self::PivotOn.name()
    }

    /// Returns whether a requirement of this name in a record holds a value at its limit: pivots on lines, a stroke, a time
    /// ratio.
    pub fn names_equality(name: &str) -> bool {
        Self::names_line(name) || [Self::Stroke, Self::TimeRatio].iter().any(|kind| kind.name() == name)
    }

    /// Returns its key in the file of a problem: a tolerance is one of its task's table.
    pub fn key_in(self, spec: &ProblemSpec) -> String {
        match self {
            Self::Tolerance | Self::ToleranceDeg => format!("{}.{}", spec.task.kind().table(), self.name()),
            other => other.definition().key.to_owned(),
        }
    }

    /// Returns every kind, in the order of a record.
    pub fn all() -> [RequirementKind; 20] {
        let mut kinds = Self::IN_CONFLICTS;
        kinds.sort_unstable();
        kinds
    }

    /// Returns the requirement of this kind.
    pub fn definition(self) -> &'static Definition {
        match self {
            Self::Type => &linkage_type::TYPE,
            Self::Input => &input::INPUT,
            Self::Transmission => &transmission::TRANSMISSION,
            Self::LinkRatio => &link_ratio::LINK_RATIO,
            Self::PivotsIn => &pivots_in::PIVOTS_IN,
            Self::PivotOn => &pivot_on::PIVOT_ON,
            Self::PinsIn => &pins_in::PINS_IN,
            Self::FootprintIn => &footprint_in::FOOTPRINT_IN,
            Self::ExtentMax => &extent_max::EXTENT_MAX,
            Self::LongestMax => &longest_max::LONGEST_MAX,
            Self::PeakTorque => &peak_torque_max::PEAK_TORQUE_MAX,
            Self::Stroke => &stroke::STROKE,
            Self::TimeRatio => &stroke::TIME_RATIO,
            Self::Direction => &direction::DIRECTION,
            Self::Order => &order::ORDER,
            Self::Branch => &branch::BRANCH,
            Self::Circuit => &circuit::CIRCUIT,
            Self::Closing => &closing::CLOSING,
            Self::Tolerance => &tolerance::TOLERANCE,
            Self::ToleranceDeg => &tolerance_deg::TOLERANCE_DEG,
        }
    }

    /// Returns the kind of a requirement with this name in a record.
    pub fn named(name: &str) -> Option<RequirementKind> {
        Self::IN_CONFLICTS.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the kind with this key in a problem file.
    pub fn with_key(key: &str) -> Option<RequirementKind> {
        let found = Self::IN_CONFLICTS.into_iter().find(|kind| kind.definition().key == key);
        found.or(match key {
            "task.motion.tolerance" | "task.function.tolerance" => Some(Self::Tolerance),
            "task.function.tolerance_deg" => Some(Self::ToleranceDeg),
            _ => None,
        })
    }

    /// Returns its name in a record: the key in its table.
    pub fn name(self) -> &'static str {
        let key = self.definition().key;
        key.rsplit_once('.').map_or(key, |(_, name)| name)
    }

    /// Returns its only limit in a problem; `None` if it has none or several.
    pub fn only_limit(self, spec: &ProblemSpec) -> Option<f64> {
        match (self.definition().limits)(spec)?.as_slice() {
            [only] => Some(only.value),
            _ => None,
        }
    }
}

/// A requirement: its key with everything that a table, a message or a search without it has to know of it.
pub struct Definition {
    /// The key in the problem file, with its table.
    pub key: &'static str,
    /// A word for a narrow column.
    pub short: &'static str,
    /// The head of its row in the page's table.
    pub label: &'static str,
    /// The relation of the value to the limit, with a blank: `at most `.
    pub relation: &'static str,
    /// The label of the control that asks it in the studio.
    pub plain: &'static str,
    /// The lines about it in a problem file to start from.
    pub template: &'static str,
    /// Whether a search that finds nothing acceptable looks for starts without it.
    pub is_left_out_in_turn: bool,
    /// The unit of its limits.
    pub unit: LimitUnit,
    /// Returns whether a problem asks for it.
    pub is_asked: fn(&Problem) -> bool,
    /// Checks its value in a problem file; the error is the reason why the value is refused.
    pub check: fn(&RequireSpec, Option<&TimingSpec>) -> Result<(), Refusal>,
    /// Returns its limits as numbers; `None` if the problem has none (a choice among words, a tolerance that differs
    /// from point to point).
    pub limits: fn(&ProblemSpec) -> Option<Vec<Limit>>,
    /// Puts other limits in place of its own, as many as `limits` gives; with none, drops it from the problem or
    /// loosens it as far as it goes.
    pub set_limits: fn(&mut ProblemSpec, &[f64]),
    /// Returns the choice made, if it is a choice among words, with no measure of how far it is loosened.
    pub choice: fn(&RequireSpec) -> Option<Choice>,
    /// Returns the scale of the rounding of its value (`None`: several numbers or a word) for a target of this size.
    pub rounding: fn(Option<f64>, f64) -> f64,
    /// Returns the reason why a candidate with this value misses this limit; `None` if there is no sentence for it.
    pub objection: fn(&str, &str) -> Option<String>,
}

impl Definition {
    /// A requirement that no problem asks for: each definition states how it differs.
    const DEFAULT: Definition = Definition {
        key: "",
        short: "",
        label: "",
        relation: "",
        plain: "",
        template: "",
        is_left_out_in_turn: false,
        unit: LimitUnit::Length,
        is_asked: |_| false,
        check: |_, _| Ok(()),
        limits: |_| None,
        set_limits: |_, _| {},
        choice: |_| None,
        rounding: |_, size| size,
        objection: |_, _| None,
    };
}

/// A choice among words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    /// One word.
    Word(&'static str),
    /// Several words.
    Words(Vec<&'static str>),
}

/// The reason why a value of a requirement is refused, with the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The fault.
    pub message: String,
    /// The remedy.
    pub help: &'static str,
}

impl Refusal {
    fn because(message: String, help: &'static str) -> Result<(), Refusal> {
        Err(Refusal { message, help })
    }

    fn unless_positive(key: &str, length: Option<f64>) -> Result<(), Refusal> {
        match length {
            Some(length) if length <= 0.0 => Refusal::because(
                format!("{key} = {length}: a length must be positive"),
                "write a length above 0, or remove the key for no limit",
            ),
            _ => Ok(()),
        }
    }
}

/// The rule for the range of the input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InputPolicy {
    /// The crank may rock.
    #[default]
    Any,
    /// The crank turns fully.
    FullTurn,
}

impl InputPolicy {
    /// Returns whether the crank may rock.
    pub fn is_any(&self) -> bool {
        *self == InputPolicy::Any
    }
}

/// The requirements on a linkage.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Require")]
pub(crate) struct RawRequire {
    /// The types allowed; where silent, any.
    #[serde(rename = "type")]
    pub types: Option<OneOrMore<LinkageType>>,
    /// "full-turn": the crank turns fully, whatever the kind of linkage; where silent, any.
    #[serde(default)]
    pub input: InputPolicy,
    /// The least transmission angle allowed, min(mu, 180 - mu), 0 to 90 degrees; where silent, any.
    pub transmission_deg_min: Option<Number>,
    /// The motion over which it is judged; where silent, the cycle where the crank turns fully.
    pub transmission_over: Option<TransmissionOver>,
    /// The longest over the shortest of ground, a, b, c at most; where silent, 20.
    pub link_ratio_max: Option<Number>,
    /// The box [xmin, ymin, xmax, ymax] or the polygon [[x, y], ...] that must hold both fixed pivots.
    pub pivots_in: Option<RegionNumbers>,
    /// Lines on which the fixed pivots must lie, each through two points and without ends: { A = [[x, y], [x, y]], B = .. };
    /// with one point, [[x, y]], the pivot lies there. Not of a function, whose pivots `[design]` gives.
    pub pivot_on: Option<OnlyTable<RawPivotOn>>,
    /// The box or the polygon, in the body's frame, that must hold both moving pins C and D; of a motion.
    pub pins_in: Option<RegionNumbers>,
    /// The box [xmin, ymin, xmax, ymax] that must hold every joint and P over the motion used.
    pub footprint_in: Option<Corners>,
    /// The greatest diagonal of the box of every joint and P over the motion used, wherever it lies; where silent, any.
    pub extent_max: Option<Number>,
    /// The greatest length of the longest of ground, a, b, c, d and e; "any" for no limit. Where silent, 3 sizes of a
    /// target with free timing, unless `[design]` bounds a length, extent_max is given or the pivots lie too far out; else any.
    pub longest_max: Option<LengthOrAny>,
    /// The greatest size of the torque on the crank, N m, under the loads of the problem and at their speed: over a full turn of a
    /// crank that turns fully, else between the crank angles used. Needs the table `[loads]`.
    pub peak_torque_max: Option<Number>,
    /// The distance between the ends of a slider-crank's slider: a length, or [least, greatest]. The crank turns fully.
    pub stroke: Option<Bounds>,
    /// The crank's angle for the slower way of the slider over that for the quicker one, 1 or more: a number, or [least,
    /// greatest]. The crank turns fully. With stroke, both as numbers, `[task.function]` needs no pairs: they are the ends.
    pub time_ratio: Option<Bounds>,
    /// Whether the points must be passed in order.
    #[serde(default)]
    pub order: OrderPolicy,
    /// The direction in which the crank turns.
    #[serde(default)]
    pub direction: DirectionPolicy,
    /// Whether the motion must stay on one circuit.
    #[serde(default)]
    pub circuit: OnePolicy,
    /// Whether the motion must stay on one branch.
    #[serde(default)]
    pub branch: OnePolicy,
    /// The way back to the first point of a target that ends where it begins.
    #[serde(default)]
    pub closing: ClosingPolicy,
}

/// The requirements on a linkage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequireSpec {
    /// The types allowed; empty: any.
    #[serde(rename = "type")]
    pub types: Vec<LinkageType>,
    /// Whether the crank must turn fully; absent: it need not.
    #[serde(default, skip_serializing_if = "InputPolicy::is_any")]
    pub input: InputPolicy,
    /// The least of min(mu, 180 - mu) over the motion, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmission_deg_min: Option<f64>,
    /// The motion over which it is judged; absent: the cycle where the input turns fully, else the used part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmission_over: Option<TransmissionOver>,
    /// Longest over shortest of ground, a, b, c.
    pub link_ratio_max: f64,
    /// [xmin, ymin, xmax, ymax] or a polygon [[x, y], ...] that holds both fixed pivots.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pivots_in: Option<Region>,
    /// The lines or points on which the fixed pivots lie.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pivot_on: Option<PivotOn>,
    /// [xmin, ymin, xmax, ymax] or a polygon [[x, y], ...], in the body's frame, that holds both moving pins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pins_in: Option<Region>,
    /// [xmin, ymin, xmax, ymax] that holds every joint and P over the motion used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub footprint_in: Option<[f64; 4]>,
    /// The greatest diagonal of the box of every joint and P over the motion used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent_max: Option<f64>,
    /// The greatest length of the longest of ground, a, b, c, d and e; absent: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longest_max: Option<f64>,
    /// The greatest size of the torque on the crank under the loads, N m; absent: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_torque_max: Option<f64>,
    /// The bounds of the distance between the ends of a slider-crank's slider; absent: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Limits>,
    /// The bounds of the crank's angle for the slower way of the slider over that for the quicker one; absent: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_ratio: Option<Limits>,
    /// Whether the points must be passed in order.
    pub order: OrderPolicy,
    /// The direction in which the crank turns.
    pub direction: DirectionPolicy,
    /// Whether the motion must stay on one circuit.
    pub circuit: OnePolicy,
    /// Whether the motion must stay on one branch.
    pub branch: OnePolicy,
    /// The way back to the first point of a target that ends where it begins; absent if it is the default, so that
    /// records from before there was a choice keep their digest.
    #[serde(default, skip_serializing_if = "ClosingPolicy::is_one_way")]
    pub closing: ClosingPolicy,
}

impl RequireSpec {
    /// Returns whether nothing but a crank that turns fully is accepted.
    pub fn asks_full_turn(&self) -> bool {
        self.input == InputPolicy::FullTurn || self.stroke.is_some() || self.time_ratio.is_some()
    }

    /// Returns the stroke and the time ratio, if both are asked for as numbers.
    pub fn ends(&self) -> Option<[f64; 2]> {
        let fixed = |limits: Option<Limits>| limits.filter(Limits::is_fixed).map(|limits| limits.0);
        Some([fixed(self.stroke)?, fixed(self.time_ratio)?])
    }

    /// Returns whether a defect is disallowed.
    pub fn forbids(&self, defect: &Defect) -> bool {
        match defect {
            Defect::Order { .. } => self.order == OrderPolicy::Required,
            Defect::Branch { .. } => self.branch == OnePolicy::One,
            Defect::Circuit { .. } => self.circuit == OnePolicy::One,
        }
    }
}

impl Default for RequireSpec {
    /// Returns the requirements of a problem file that is silent about them.
    fn default() -> Self {
        RawRequire::default().into()
    }
}

impl From<RawPivotOn> for PivotOn {
    fn from(raw: RawPivotOn) -> PivotOn {
        let locus = |points: Vec<XY>| Locus(points.into_iter().map(|place| place.0).collect());
        PivotOn { crank_pivot: raw.crank_pivot.map(locus), follower_pivot: raw.follower_pivot.map(locus) }
    }
}

impl From<RawRequire> for RequireSpec {
    fn from(raw: RawRequire) -> RequireSpec {
        let number = |given: Option<Number>| given.map(|number| number.0);
        let corners = |given: Option<Corners>| given.map(|corners| corners.0);
        let mut types = raw.types.map_or(Vec::new(), |types| types.0);
        types.sort_unstable();
        types.dedup();
        RequireSpec {
            types,
            input: raw.input,
            transmission_deg_min: number(raw.transmission_deg_min),
            transmission_over: raw.transmission_over,
            link_ratio_max: number(raw.link_ratio_max).unwrap_or(DEFAULT_LINK_RATIO),
            pivots_in: raw.pivots_in.map(|region| region.0),
            pivot_on: raw.pivot_on.map(|OnlyTable(raw)| raw.into()),
            pins_in: raw.pins_in.map(|region| region.0),
            footprint_in: corners(raw.footprint_in),
            extent_max: number(raw.extent_max),
            longest_max: raw.longest_max.and_then(LengthOrAny::length),
            peak_torque_max: number(raw.peak_torque_max),
            stroke: raw.stroke.map(|bounds| bounds.0),
            time_ratio: raw.time_ratio.map(|bounds| bounds.0),
            order: raw.order,
            direction: raw.direction,
            circuit: raw.circuit,
            branch: raw.branch,
            closing: raw.closing,
        }
    }
}
