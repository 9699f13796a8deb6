//! Reads `[task.path]`: the points from their source, with weights, tolerances and crank angles.

use super::lists::Lists;
use super::raw::RawPath;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{OneOrEach, numbers};
use crate::mechanism::Unit;
use crate::task::resampling::MAX_SMOOTHED;
use crate::task::spec::{RawPoints, TaskSpec};
use crate::task::{Task, TaskError, corners};

/// The values of the task's table.
pub(super) struct TaskRead {
    pub spec: TaskSpec,
    pub task: Task,
    /// The unit of a drawing's physical lengths.
    pub unit: Option<Unit>,
    pub warnings: Vec<Diagnostic>,
}

/// Returns the path with its lists, and the task that it is. A tolerance that is set on the command line takes the place
/// of the column of a points file.
pub(super) fn path_of(
    toml: &TomlText<'_>,
    path: Option<RawPath>,
    whereabouts: &Whereabouts<'_>,
    unit: Option<Unit>,
    tolerance_is_set: bool,
) -> Checked<TaskRead> {
    let Some(path) = path else {
        let help = "add a table [task.path] with points = [[x, y], ...] or file = \"points.csv\"";
        return toml.refuse_key("task", "there is no task in this file", help);
    };
    let mut target = Target::of(toml, &path, whereabouts, unit)?;
    let (crank_column, weight_column, tolerance_column) = match &mut target.source {
        Source::Csv(csv) => (csv.crank_deg.take(), csv.weight.take(), csv.tolerance.take()),
        Source::File | Source::Svg(_) => (None, None, None),
    };
    let tolerance_column = tolerance_column.filter(|_| !tolerance_is_set);
    if let Source::Csv(csv) = &mut target.source
        && (csv.angle_deg.is_some() || csv.tolerance_deg.is_some())
    {
        let message = "a path has no body: the columns angle_deg and tolerance_deg are not used";
        let help = "write [task.motion] in place of [task.path] to have the body's angles too";
        csv.warnings.push(toml.at("task.path.file", message).with_help(help));
    }
    let has_tolerances = tolerance_column.is_some() || matches!(path.tolerance, Some(OneOrEach::Each(_)));
    let beside = [
        ("crank angles", crank_column.is_some() || path.timing.is_some()),
        ("weights", weight_column.is_some() || path.weight.is_some()),
        ("tolerances", has_tolerances),
    ];
    let raw = raw_of(toml, &path, &mut target, beside)?;
    let lists = Lists { toml, target: &target, file: path.file.as_deref() };
    let words = ["tolerance", "a distance"];
    let tolerance = lists.tolerances("tolerance", words, path.tolerance.as_ref(), tolerance_column)?;
    let weight = lists.weights(path.weight.as_deref().map(numbers), weight_column)?;
    let timing = lists.timing(path.timing.as_ref(), crank_column)?;
    let points = std::mem::take(&mut target.points);
    let spec =
        TaskSpec { points, closed: target.closed, weight, tolerance, timing, raw, body: None, output: None };
    task_read(toml, target, spec)
}

/// Checks a task, and returns it with what its source says beside the targets.
pub(super) fn task_read(toml: &TomlText<'_>, target: Target, spec: TaskSpec) -> Checked<TaskRead> {
    let task = spec.to_task().map_err(|error| explain_task(toml, &target, &spec, &error))?;
    let (unit, warnings) = match target.source {
        Source::File => (None, Vec::new()),
        Source::Csv(csv) => (None, csv.warnings),
        Source::Svg(svg) => (svg.unit, svg.warnings),
    };
    Ok(TaskRead { spec, task, unit, warnings })
}

/// Smooths and resamples the points if that is asked for; returns the points as they were then.
fn raw_of(
    toml: &TomlText<'_>,
    path: &RawPath,
    target: &mut Target,
    beside: [(&str, bool); 3],
) -> Checked<Option<RawPoints>> {
    let refuse =
        |key: &str, message: String, help: &str| toml.refuse(&format!("task.path.{key}"), message, help);
    let smooth = path.smooth.map(|s| s.0);
    if let Some(deviation) = smooth {
        let (low, high) = corners(&target.points);
        let size = (high[0] - low[0]).hypot(high[1] - low[1]);
        if deviation <= 0.0 {
            let help = "write a length along the path, a few times the distance of points; or remove the key";
            return refuse("smooth", format!("smooth = {deviation} is not above 0"), help);
        }
        if deviation > size {
            let message = format!("smooth = {deviation} is more than the size of the path, {size:.4}");
            let help = "write a length along the path, a few times the distance of points";
            return refuse("smooth", message, help);
        }
        if target.points.len() > MAX_SMOOTHED {
            let message = format!("{} points; at most {MAX_SMOOTHED} are smoothed", target.points.len());
            return refuse(
                "smooth",
                message,
                "leave out points: a few hundred describe any path of a four-bar",
            );
        }
    }
    // A drawing has been sampled already.
    let samples = match target.source {
        Source::Svg(_) => None,
        Source::File | Source::Csv(_) => target.samples,
    };
    if samples.is_some()
        && let Some((what, _)) = beside.iter().find(|(_, there)| *there)
    {
        let message = format!("samples takes new points, and the {what} belong to the old ones");
        return refuse("samples", message, "remove one of the two; smooth alone keeps the points");
    }
    if smooth.is_none() && samples.is_none() {
        return Ok(None);
    }
    let raw = RawPoints { points: std::mem::take(&mut target.points), smooth, samples };
    target.points = raw.target(target.closed);
    target.resampled = samples.is_some();
    Ok(Some(raw))
}

/// Returns the diagnostic of a task's error, at the point that it is about.
fn explain_task(toml: &TomlText<'_>, target: &Target, spec: &TaskSpec, error: &TaskError) -> Box<Diagnostic> {
    Box::new(match error {
        TaskError::TooFewPoints(n) => target
            .at_all(toml, format!("a {} needs at least 2 {}s, this one has {n}", target.kind.name(), target.kind.noun()))
            .with_help(format!("add {}s, in the order in which they are to be passed", target.kind.noun())),
        TaskError::AdjacentEqual(i) => {
            let [x, y] = spec.points[*i];
            let message = format!("{}s {} and {} are equal: ({x}, {y})", target.kind.noun(), i + 1, i + 2);
            target
                .at_point(toml, i + 1, message)
                .with_help("remove one of them, or prescribe the timing: at two crank angles the point dwells there")
        }
        TaskError::NoExtent => target
            .at_all(toml, "all points are equal: a path needs an extent".into())
            .with_help("give points in at least two places"),
        TaskError::NotFinite { index, .. } | TaskError::OutOfRange { index, .. } => {
            target.at_point(toml, *index, error.to_string())
        }
        TaskError::LengthMismatch { .. } => target.at_all(toml, error.to_string()),
        TaskError::NotTimed(_) | TaskError::TooFewTimed => target
            .at_all(toml, error.to_string())
            .with_help("give at least two targets a crank angle, or leave out the timing"),
        TaskError::ConstantInput | TaskError::ConstantOutput | TaskError::NoInput => target
            .at_all(toml, error.to_string())
            .with_help("give at least two pairs whose inputs and outputs differ"),
        TaskError::ToleranceOfFreeRange => toml
            .at("task.function.output_range_deg", error.to_string())
            .with_help("fix the range, output_range_deg = 60 say, or remove the tolerance"),
        TaskError::NoAngle => target.at_all(toml, "no pose has an angle".into()).with_help(
            "give at least one pose an angle: [x, y, degrees]; for points alone write [task.path] with points = [..]",
        ),
        TaskError::AngleWeight(_) => toml
            .at("task.motion.angle_weight", error.to_string())
            .with_help("write the length that an angle error of one radian counts like; it has the size of the body"),
    })
}
