//! The task as data: a list of targets, written as `path`, as `motion` or as `function`.
//!
//! A target says where the coupler point is to be and, in a motion, how the body is to lie there; the crank angles are
//! given or free. Files and records call a list without body angles `path` and one with them `motion`. A `function` has no
//! points: its targets are outputs, angles of the follower or places of a slider, at given crank angles.

use crate::task::ranges::{Ranges, RangesSpec};
use crate::task::resampling::{resample, smooth};
use crate::task::{AngleOffset, Body, Link, Output, Sense, Task, TaskError, TaskKind, TaskOptions, Timing};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The task: a list of targets.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Tables", into = "Tables")]
pub struct TaskSpec {
    /// The place of the coupler point at each target; in a motion, of the body's origin; none in a function.
    pub points: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    pub closed: bool,
    /// One positive weight a target; they enter the objective only.
    pub weight: Option<Vec<f64>>,
    /// The largest error of the place accepted, one a target.
    pub tolerance: Option<Vec<f64>>,
    /// Prescribed timing; absent: free.
    pub timing: Option<TimingSpec>,
    /// The points before they were smoothed or resampled; absent where `points` are what was given.
    pub raw: Option<RawPoints>,
    /// The angles of a body, or of the follower in a function; absent: the places alone are wanted.
    pub body: Option<BodySpec>,
    /// The reference and the sense of a function's outputs; absent: the angles are those of a body on the coupler.
    pub output: Option<OutputSpec>,
}

/// The outputs of a function: what they are, their reference and sense, and the formula that gave them.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSpec {
    /// The quantity: angles, or places of a slider, which are written as degrees in the body.
    pub output: Output,
    /// Their reference: free, or the ground line.
    pub offset: AngleOffset,
    /// The sense in which they count.
    pub sense: Sense,
    /// The ranges that are free.
    pub ranges: RangesSpec,
    /// The formula of which the pairs were taken; absent: they were given.
    pub of: Option<FormulaSpec>,
}

/// A formula y = f(x) whose values are the outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulaSpec {
    /// The formula in x.
    pub formula: String,
    /// The first and the last x.
    pub over: [f64; 2],
}

/// The length that an angle error of one radian counts like in a function: squared errors are in degrees squared.
pub const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// The angles of a body at the targets of a motion, or of the follower at those of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct BodySpec {
    /// The angle of the body at each target, degrees from the x axis, counter-clockwise positive; `None`: only the place
    /// counts there.
    pub angle_deg: Vec<Option<f64>>,
    /// A length: an angle error of one radian counts like an error of the place of this length.
    pub angle_weight: f64,
    /// The largest error of the angle accepted, degrees, one a target.
    pub tolerance_deg: Option<Vec<f64>>,
}

/// Points as they were digitised, with the smoothing and resampling that made the target's points of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RawPoints {
    /// As they were given.
    pub points: Vec<[f64; 2]>,
    /// The standard deviation of the smoothing, a length along the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smooth: Option<f64>,
    /// The number of points taken evenly along the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
}

impl RawPoints {
    /// Returns the target's points: smoothed, then resampled.
    pub fn target(&self, closed: bool) -> Vec<[f64; 2]> {
        let smoothed = match self.smooth {
            Some(deviation) => smooth(&self.points, closed, deviation),
            None => self.points.clone(),
        };
        match self.samples {
            Some(count) => resample(&smoothed, closed, count),
            None => smoothed,
        }
    }
}

/// Prescribed crank angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimingSpec {
    /// One a target, degrees, counter-clockwise positive.
    pub crank_deg: Vec<f64>,
    /// Their reference direction.
    pub offset: AngleOffset,
    /// The targets whose crank angle is free after all, counted from 0, in their order: what `crank_deg` says of them lies
    /// between their neighbours and is a guess.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub free: Vec<usize>,
}

impl TimingSpec {
    /// Returns the timing of crank angles (degrees), some of them free: each of these gets a guess, evenly between its
    /// neighbours; before the first and behind the last given one on the way that closes the turn. `None` if none is given.
    pub fn partly(angles: &[Option<f64>], offset: AngleOffset) -> Option<TimingSpec> {
        let n = angles.len();
        let given: Vec<(usize, f64)> =
            angles.iter().enumerate().filter_map(|(j, a)| Some((j, (*a)?))).collect();
        let ((first, from), (last, to)) = (*given.first()?, *given.last()?);
        // One more turn lies between the last and the first again.
        let turn = if to < from { -360.0 } else { 360.0 };
        let before = |j: usize| given.iter().rev().find(|(k, _)| *k < j).copied();
        let behind = |j: usize| given.iter().find(|(k, _)| *k > j).copied();
        let guess = |j: usize| {
            let (low, a) = before(j).map_or((last as f64 - n as f64, to - turn), |(k, a)| (k as f64, a));
            let (high, b) = behind(j).map_or((first as f64 + n as f64, from + turn), |(k, b)| (k as f64, b));
            a + (b - a) * (j as f64 - low) / (high - low)
        };
        let crank_deg =
            angles.iter().enumerate().map(|(j, angle)| angle.unwrap_or_else(|| guess(j))).collect();
        let free = (0..n).filter(|j| angles[*j].is_none()).collect();
        Some(TimingSpec { crank_deg, offset, free })
    }
}

impl TaskSpec {
    /// Returns a path through these points with free timing.
    pub fn path(points: Vec<[f64; 2]>, closed: bool) -> TaskSpec {
        TaskSpec { points, closed, ..TaskSpec::default() }
    }

    /// Returns the task, checked.
    ///
    /// # Errors
    /// As [`Task::new`].
    pub fn to_task(&self) -> Result<Task, TaskError> {
        let timing = match &self.timing {
            None => Timing::Free,
            Some(t) => Timing::Prescribed {
                crank_angles: t.crank_deg.iter().map(|d| d.to_radians()).collect(),
                offset: t.offset,
            },
        };
        let radians = |degrees: &f64| degrees.to_radians();
        let options = TaskOptions {
            weights: self.weight.clone(),
            tolerances: self.tolerance.clone(),
            closed: self.closed,
            untimed: self.timing.as_ref().map_or_else(Vec::new, |timing| timing.free.clone()),
            body: self.body.as_ref().map(|body| Body {
                angles: body.angle_deg.iter().map(|angle| angle.as_ref().map(radians)).collect(),
                angle_weight: body.angle_weight,
                link: self.output.as_ref().map_or(Link::Coupler, |output| Link::Output {
                    output: output.output,
                    offset: output.offset,
                    sense: output.sense,
                    ranges: Ranges::of(&output.ranges, self.written_ranges_deg()),
                }),
                tolerances: body.tolerance_deg.as_ref().map(|list| list.iter().map(radians).collect()),
            }),
        };
        Task::new(self.points.clone(), timing, options)
    }

    /// Returns its kind.
    pub fn kind(&self) -> TaskKind {
        match (&self.body, &self.output) {
            (None, _) => TaskKind::Path,
            (Some(_), None) => TaskKind::Motion,
            (Some(_), Some(_)) => TaskKind::Function,
        }
    }

    /// Returns whether it is a motion.
    pub fn is_motion(&self) -> bool {
        self.kind() == TaskKind::Motion
    }

    /// Returns whether it is a function.
    pub fn is_function(&self) -> bool {
        self.kind() == TaskKind::Function
    }

    /// Returns whether it is a function whose outputs are places of a slider.
    pub fn is_of_places(&self) -> bool {
        self.output.as_ref().is_some_and(|output| output.output == Output::Place)
    }

    /// Returns the word for one of its targets: `point`, `pose` or `pair`.
    pub fn noun(&self) -> &'static str {
        self.kind().noun()
    }

    /// Returns the input and the output of each pair of a function, degrees, or a length of a slider's place; none of another
    /// task.
    pub fn pairs(&self) -> Vec<[f64; 2]> {
        let outputs = self.body.iter().filter(|_| self.is_function()).flat_map(|body| &body.angle_deg);
        let inputs = self.timing.iter().flat_map(|timing| &timing.crank_deg);
        inputs.zip(outputs).filter_map(|(input, output)| Some([*input, (*output)?])).collect()
    }

    /// Returns the ranges of the inputs and the outputs of a function as they are written.
    pub fn written_ranges_deg(&self) -> [f64; 2] {
        let pairs = self.pairs();
        let range = |of: fn(&[f64; 2]) -> f64| {
            let all = || pairs.iter().map(of);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        [range(|pair| pair[0]), range(|pair| pair[1])]
    }

    /// Returns the number of targets.
    pub fn len(&self) -> usize {
        match &self.body {
            Some(body) if self.is_function() => body.angle_deg.len(),
            _ => self.points.len(),
        }
    }

    /// Returns whether there are no targets.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The serialised form of a task: one table, named by its kind.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Tables {
    /// A path to trace.
    Path(PathTable),
    /// Poses that a body is to pass.
    Motion(MotionTable),
    /// Angles that the follower is to have.
    Function(FunctionTable),
}

/// A path: points with their weights, tolerances and crank angles.
#[derive(Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PathSpec")]
struct PathTable {
    /// The target points.
    points: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    closed: bool,
    /// One positive weight a point; they enter the objective only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<Vec<f64>>,
    /// The largest error accepted, one a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance: Option<Vec<f64>>,
    /// Prescribed timing; absent: free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    timing: Option<TimingSpec>,
    /// The points before they were smoothed or resampled; absent where `points` are what was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    raw: Option<RawPoints>,
}

/// A motion: poses with their weights, tolerances and crank angles.
#[derive(Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "MotionSpec")]
struct MotionTable {
    /// The poses, each [x, y, angle in degrees], or [x, y] where only the place counts.
    poses: Vec<PoseRow>,
    /// Whether the motion returns to the first pose.
    closed: bool,
    /// A length: an angle error of one radian counts like an error of the place of this length.
    angle_weight: f64,
    /// One positive weight a pose; they enter the objective only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<Vec<f64>>,
    /// The largest error of the place accepted, one a pose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance: Option<Vec<f64>>,
    /// The largest error of the angle accepted, degrees, one a pose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance_deg: Option<Vec<f64>>,
    /// Prescribed timing; absent: free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    timing: Option<TimingSpec>,
}

/// A function: output angles of the follower, or places of a slider, at input angles of the crank, with their weights and
/// tolerances.
#[derive(Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "FunctionSpec")]
struct FunctionTable {
    /// The angle of the crank at each pair, degrees, counter-clockwise positive.
    input_deg: Vec<f64>,
    /// The angle of the follower at each pair, degrees; absent of places.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    output_deg: Vec<f64>,
    /// The place of the slider at each pair; absent of angles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    output: Vec<f64>,
    /// The reference of input angles: free, or the ground line.
    input_offset: AngleOffset,
    /// The reference of outputs, likewise.
    output_offset: AngleOffset,
    /// The sense in which outputs count.
    sense: Sense,
    /// The ranges that are free.
    #[serde(flatten)]
    ranges: RangesSpec,
    /// One positive weight a pair; they enter the objective only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<Vec<f64>>,
    /// The largest error of the output accepted, degrees, one a pair.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance_deg: Option<Vec<f64>>,
    /// The largest error of a slider's place accepted, one a pair.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance: Option<Vec<f64>>,
    /// The formula of which the pairs were taken; absent: they were given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    of: Option<FormulaSpec>,
}

impl FunctionTable {
    fn into_spec(self) -> TaskSpec {
        let FunctionTable {
            input_deg,
            output_deg,
            output,
            input_offset,
            output_offset,
            sense,
            ranges,
            weight,
            tolerance_deg,
            tolerance,
            of,
        } = self;
        let (kind, outputs, tolerance_deg) = match output.is_empty() {
            true => (Output::Angle, output_deg, tolerance_deg),
            false => (Output::Place, output, tolerance),
        };
        let angle_deg = outputs.into_iter().map(Some).collect();
        TaskSpec {
            weight,
            timing: Some(TimingSpec { crank_deg: input_deg, offset: input_offset, free: Vec::new() }),
            body: Some(BodySpec { angle_deg, angle_weight: DEGREES, tolerance_deg }),
            output: Some(OutputSpec { output: kind, offset: output_offset, sense, ranges, of }),
            ..TaskSpec::default()
        }
    }

    fn of(spec: TaskSpec, output: OutputSpec) -> FunctionTable {
        let (angles, tolerance_deg) =
            spec.body.map_or((Vec::new(), None), |body| (body.angle_deg, body.tolerance_deg));
        let (input_deg, input_offset) =
            spec.timing.map_or((Vec::new(), AngleOffset::Free), |timing| (timing.crank_deg, timing.offset));
        let outputs = angles.into_iter().map(|angle| angle.unwrap_or(f64::NAN)).collect();
        let (output_deg, places, tolerance_deg, tolerance) = match output.output {
            Output::Angle => (outputs, Vec::new(), tolerance_deg, None),
            Output::Place => (Vec::new(), outputs, None, tolerance_deg),
        };
        FunctionTable {
            input_deg,
            output_deg,
            output: places,
            input_offset,
            output_offset: output.offset,
            sense: output.sense,
            ranges: output.ranges,
            weight: spec.weight,
            tolerance_deg,
            tolerance,
            of: output.of,
        }
    }
}

/// A pose as a row of two or three numbers.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum PoseRow {
    /// x, y and the angle in degrees.
    Pose([f64; 3]),
    /// x and y: only the place counts.
    Place([f64; 2]),
}

impl From<Tables> for TaskSpec {
    fn from(tables: Tables) -> TaskSpec {
        match tables {
            Tables::Path(PathTable { points, closed, weight, tolerance, timing, raw }) => {
                TaskSpec { points, closed, weight, tolerance, timing, raw, body: None, output: None }
            }
            Tables::Function(function) => function.into_spec(),
            Tables::Motion(motion) => {
                let split = |row: &PoseRow| match *row {
                    PoseRow::Pose([x, y, angle]) => ([x, y], Some(angle)),
                    PoseRow::Place(place) => (place, None),
                };
                let (points, angle_deg) = motion.poses.iter().map(split).unzip();
                let MotionTable { closed, angle_weight, weight, tolerance, tolerance_deg, timing, .. } =
                    motion;
                let body = Some(BodySpec { angle_deg, angle_weight, tolerance_deg });
                TaskSpec { points, closed, weight, tolerance, timing, raw: None, body, output: None }
            }
        }
    }
}

impl From<TaskSpec> for Tables {
    fn from(mut spec: TaskSpec) -> Tables {
        if let Some(output) = spec.output.take() {
            return Tables::Function(FunctionTable::of(spec, output));
        }
        let TaskSpec { points, closed, weight, tolerance, timing, raw, body, .. } = spec;
        match body {
            None => Tables::Path(PathTable { points, closed, weight, tolerance, timing, raw }),
            Some(BodySpec { angle_deg, angle_weight, tolerance_deg }) => {
                let row = |([x, y], angle): ([f64; 2], Option<f64>)| match angle {
                    Some(angle) => PoseRow::Pose([x, y, angle]),
                    None => PoseRow::Place([x, y]),
                };
                let poses = points.into_iter().zip(angle_deg).map(row).collect();
                Tables::Motion(MotionTable {
                    poses,
                    closed,
                    angle_weight,
                    weight,
                    tolerance,
                    tolerance_deg,
                    timing,
                })
            }
        }
    }
}

/// The task: one of its tables.
#[derive(JsonSchema)]
#[schemars(rename = "TaskSpec")]
#[expect(dead_code, reason = "its schema alone is used")]
struct Described {
    /// A path to trace.
    path: Option<PathTable>,
    /// Poses that a body is to pass.
    motion: Option<MotionTable>,
    /// Angles that the follower is to have.
    function: Option<FunctionTable>,
}

impl JsonSchema for TaskSpec {
    fn schema_name() -> Cow<'static, str> {
        Described::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Described::json_schema(generator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_written_as_ever_and_a_motion_as_poses() {
        let path = TaskSpec::path(vec![[0.0, 1.0], [2.0, 3.0]], true);
        let text = serde_json::to_string(&path).expect("JSON");
        assert_eq!(text, r#"{"path":{"points":[[0.0,1.0],[2.0,3.0]],"closed":true}}"#);
        assert_eq!(serde_json::from_str::<TaskSpec>(&text).expect("a task"), path);
        let body = BodySpec { angle_deg: vec![Some(5.0), None], angle_weight: 2.5, tolerance_deg: None };
        let motion = TaskSpec { body: Some(body), closed: false, ..path };
        let text = serde_json::to_string(&motion).expect("JSON");
        assert_eq!(
            text,
            r#"{"motion":{"poses":[[0.0,1.0,5.0],[2.0,3.0]],"closed":false,"angle_weight":2.5}}"#
        );
        assert_eq!(serde_json::from_str::<TaskSpec>(&text).expect("a task"), motion);
    }
}
