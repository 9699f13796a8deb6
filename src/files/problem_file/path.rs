//! Reads `[task.path]`: the points from their source, with weights, tolerances and crank angles.

use super::raw::RawPath;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::{Checked, Diagnostic, counted};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{OneOrEach, OnlyTable, numbers};
use crate::mechanism::Unit;
use crate::task::resampling::MAX_SMOOTHED;
use crate::task::spec::{PathSpec, RawPoints, TimingSpec};
use crate::task::{AngleOffset, PathTask, TaskError, corners};

/// The values of `[task.path]`.
pub(super) struct PathRead {
    pub spec: PathSpec,
    pub task: PathTask,
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
) -> Checked<PathRead> {
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
    let has_tolerances = tolerance_column.is_some() || matches!(path.tolerance, Some(OneOrEach::Each(_)));
    let beside = [
        ("crank angles", crank_column.is_some() || path.timing.is_some()),
        ("weights", weight_column.is_some() || path.weight.is_some()),
        ("tolerances", has_tolerances),
    ];
    let raw = raw_of(toml, &path, &mut target, beside)?;
    let n = target.points.len();
    // A list is given in the problem file or as a column of the points file.
    let list_of = |key: &str, what: &str, here: Option<Vec<f64>>, column: Option<Vec<f64>>| {
        let place = format!("task.path.{key}");
        match (here, column) {
            (Some(_), Some(_)) => {
                let (name, file) =
                    (key.trim_start_matches("timing."), path.file.as_deref().unwrap_or_default());
                let message = format!("{name} is given here and as a column of {file}");
                toml.refuse(&place, message, "remove one of the two")
            }
            (Some(list), _) if list.len() != n => {
                let message = format!("{} and {}", counted(n, "point"), counted(list.len(), what));
                toml.refuse(&place, message, format!("give one {what} for each point"))
            }
            (here, column) => Ok(here.or(column)),
        }
    };
    let here = path.tolerance.as_ref().map(|tolerance| match tolerance {
        OneOrEach::One(tolerance) => vec![*tolerance; n],
        OneOrEach::Each(list) => list.clone(),
    });
    let tolerance = list_of("tolerance", "tolerance", here, tolerance_column)?;
    if let Some((j, t)) = tolerance.iter().flatten().enumerate().find(|(_, t)| **t < 0.0) {
        let message = format!("tolerance = {t}: a distance cannot be negative");
        return toml.refuse(&format!("task.path.tolerance.{j}"), message, "write 0 or more");
    }
    let weight = list_of("weight", "weight", path.weight.as_deref().map(numbers), weight_column)?;
    if let Some((j, w)) = weight.iter().flatten().enumerate().find(|(_, w)| **w <= 0.0) {
        let message = format!("weight = {w}: a weight is positive");
        let help = "write a number above 0; leave the point out to ignore it";
        return toml.refuse(&format!("task.path.weight.{j}"), message, help);
    }
    let (here, offset) = match &path.timing {
        Some(OnlyTable(timing)) => (timing.crank_deg.as_deref().map(numbers), timing.offset),
        None => (None, AngleOffset::default()),
    };
    let crank_deg = list_of("timing.crank_deg", "crank angle", here, crank_column)?;
    if crank_deg.is_none() && path.timing.is_some() {
        let help = "add crank_deg, one angle a point, or remove [task.path.timing] for free timing";
        return toml.refuse_key("task.path.timing", "the crank angles are missing", help);
    }
    let timing = crank_deg.map(|crank_deg| TimingSpec { crank_deg, offset });
    let points = std::mem::take(&mut target.points);
    let spec = PathSpec { points, closed: target.closed, weight, tolerance, timing, raw };
    let task = spec.to_task().map_err(|error| explain_task(toml, &target, &spec, &error))?;
    let (unit, warnings) = match target.source {
        Source::File => (None, Vec::new()),
        Source::Csv(csv) => (None, csv.warnings),
        Source::Svg(svg) => (svg.unit, svg.warnings),
    };
    Ok(PathRead { spec, task, unit, warnings })
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
fn explain_task(toml: &TomlText<'_>, target: &Target, spec: &PathSpec, error: &TaskError) -> Box<Diagnostic> {
    Box::new(match error {
        TaskError::TooFewPoints(n) => target
            .at_all(toml, format!("a path needs at least 2 points, this one has {n}"))
            .with_help("add points, in the order in which they are to be passed"),
        TaskError::AdjacentEqual(i) => {
            let [x, y] = spec.points[*i];
            let message = format!("points {} and {} are equal: ({x}, {y})", i + 1, i + 2);
            target.at_point(toml, i + 1, message).with_help(equal_neighbours_remedy(spec, *i))
        }
        TaskError::NoExtent => target
            .at_all(toml, "all points are equal: a path needs an extent".into())
            .with_help("give points in at least two places"),
        TaskError::NotFinite { index, .. } | TaskError::OutOfRange { index, .. } => {
            target.at_point(toml, *index, error.to_string())
        }
        TaskError::LengthMismatch { .. } => target.at_all(toml, error.to_string()),
    })
}

/// Returns the remedy for equal points i and i + 1.
fn equal_neighbours_remedy(spec: &PathSpec, i: usize) -> String {
    match &spec.timing {
        None => "remove one of them, or prescribe the timing with the same crank angle at both".to_owned(),
        Some(t) => format!(
            "remove one of them; equal neighbours need equal crank angles, these have {} and {} degrees",
            t.crank_deg[i],
            t.crank_deg[i + 1]
        ),
    }
}
