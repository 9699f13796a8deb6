//! `[task.path]`: the points, where they come from, and what stands beside them.

use super::raw::RawPath;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::Diagnostic;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::OneOrEach;
use crate::mechanism::Unit;
use crate::task::resampling::MAX_SMOOTHED;
use crate::task::spec::{PathSpec, RawPoints, TimingSpec};
use crate::task::{AngleOffset, PathTask, TaskError};

/// What `[task.path]` says.
pub(super) struct PathRead {
    pub spec: PathSpec,
    pub task: PathTask,
    /// The unit of a drawing's physical lengths.
    pub unit: Option<Unit>,
    pub warnings: Vec<Diagnostic>,
}

/// The path with what stands beside its points, and the task that it is. A tolerance that is set by hand takes the
/// place of the column of a points file.
pub(super) fn path_of(
    toml: &TomlText<'_>,
    path: Option<RawPath>,
    whereabouts: &Whereabouts<'_>,
    unit: Option<Unit>,
    tolerance_is_set: bool,
) -> Result<PathRead, Box<Diagnostic>> {
    let Some(path) = path else {
        return Err(Box::new(
            toml.at_key("task", "there is no task in this file")
                .with_help("add a table [task.path] with points = [[x, y], ...] or file = \"points.csv\""),
        ));
    };
    let mut target = Target::of(toml, &path, whereabouts, unit)?;
    let columns = match &mut target.source {
        Source::Csv(csv) => (csv.crank_deg.take(), csv.weight.take(), csv.tolerance.take()),
        Source::File | Source::Svg(_) => (None, None, None),
    };
    let (csv_crank, csv_weight, csv_tolerance) = columns;
    let beside = [
        ("crank angles", csv_crank.is_some() || path.timing.is_some()),
        ("weights", csv_weight.is_some() || path.weight.is_some()),
        (
            "tolerances",
            csv_tolerance.is_some() && !tolerance_is_set
                || matches!(path.tolerance, Some(OneOrEach::Each(_))),
        ),
    ];
    let raw = raw_of(toml, &path, &mut target, beside)?;
    let n = target.points.len();
    let tolerance = match (&path.tolerance, csv_tolerance) {
        (Some(_), Some(_)) if !tolerance_is_set => {
            return Err(twice(toml, "task.path.tolerance", "tolerance", &path));
        }
        (Some(OneOrEach::One(t)), _) => {
            not_negative(toml, "task.path.tolerance", *t)?;
            Some(vec![*t; n])
        }
        (Some(OneOrEach::Each(list)), _) => {
            one_each(toml, "task.path.tolerance", list.len(), n, "tolerance")?;
            for (j, t) in list.iter().enumerate() {
                not_negative(toml, &format!("task.path.tolerance.{j}"), *t)?;
            }
            Some(list.clone())
        }
        (None, column) => column,
    };
    let weight = match (&path.weight, csv_weight) {
        (Some(_), Some(_)) => return Err(twice(toml, "task.path.weight", "weight", &path)),
        (Some(list), None) => {
            one_each(toml, "task.path.weight", list.len(), n, "weight")?;
            if let Some(j) = list.iter().position(|w| w.0 <= 0.0) {
                let message = format!("weight = {}: a weight is positive", list[j].0);
                let help = "write a number above 0; leave the point out to ignore it";
                return Err(Box::new(toml.at(&format!("task.path.weight.{j}"), message).with_help(help)));
            }
            Some(list.iter().map(|w| w.0).collect())
        }
        (None, column) => column,
    };
    let offset = path.timing.as_ref().map_or(AngleOffset::default(), |t| t.0.offset);
    let file_crank = path.timing.as_ref().and_then(|t| t.0.crank_deg.as_ref());
    let crank_deg = match (file_crank, csv_crank) {
        (Some(_), Some(_)) => return Err(twice(toml, "task.path.timing.crank_deg", "crank_deg", &path)),
        (Some(list), None) => Some(list.iter().map(|v| v.0).collect::<Vec<f64>>()),
        (None, Some(column)) => Some(column),
        (None, None) if path.timing.is_some() => {
            return Err(Box::new(toml.at_key("task.path.timing", "the crank angles are missing").with_help(
                "add crank_deg, one angle a point, or remove [task.path.timing] for free timing",
            )));
        }
        (None, None) => None,
    };
    if let Some(list) = &crank_deg {
        one_each(toml, "task.path.timing.crank_deg", list.len(), n, "crank angle")?;
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

/// Smooths and resamples the points where that is asked for; what they were then stands in the answer.
fn raw_of(
    toml: &TomlText<'_>,
    path: &RawPath,
    target: &mut Target,
    beside: [(&str, bool); 3],
) -> Result<Option<RawPoints>, Box<Diagnostic>> {
    let refuse = |key: &str, message: String, help: &str| {
        Err(Box::new(toml.at(&format!("task.path.{key}"), message).with_help(help)))
    };
    let smooth = path.smooth.map(|s| s.0);
    if let Some(deviation) = smooth {
        let size = extent(&target.points);
        if deviation <= 0.0 {
            let help = "write a length along the path, a few times the distance of points; or remove the key";
            return refuse("smooth", format!("smooth = {deviation} is not above 0"), help);
        }
        if deviation > size {
            let message = format!("smooth = {deviation} is more than the size of the path, {size:.4}");
            return refuse(
                "smooth",
                message,
                "write a length along the path, a few times the distance of points",
            );
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

/// The diagonal of the points' box.
fn extent(points: &[[f64; 2]]) -> f64 {
    let span = |axis: usize| {
        let (low, high) = points
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        high - low
    };
    span(0).hypot(span(1))
}

/// "3 points".
pub(super) fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// Refuses a list of another length than there are points.
fn one_each(
    toml: &TomlText<'_>,
    key: &str,
    values: usize,
    points: usize,
    what: &str,
) -> Result<(), Box<Diagnostic>> {
    if values == points {
        return Ok(());
    }
    let message = format!("{} and {}", counted(points, "point"), counted(values, what));
    Err(Box::new(toml.at(key, message).with_help(format!("give one {what} for each point"))))
}

/// Refuses a negative tolerance.
fn not_negative(toml: &TomlText<'_>, key: &str, tolerance: f64) -> Result<(), Box<Diagnostic>> {
    if tolerance >= 0.0 {
        return Ok(());
    }
    let message = format!("tolerance = {tolerance}: a distance cannot be negative");
    Err(Box::new(toml.at(key, message).with_help("write 0 or more")))
}

/// The same thing in the problem file and in the points file.
fn twice(toml: &TomlText<'_>, path: &str, what: &str, raw: &RawPath) -> Box<Diagnostic> {
    let file = raw.file.as_deref().unwrap_or_default();
    Box::new(
        toml.at(path, format!("{what} is given here and as a column of {file}"))
            .with_help("remove one of the two"),
    )
}

/// A task's error at the point that it is about.
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
        TaskError::NotFinite { index, .. } => target.at_point(toml, *index, error.to_string()),
        TaskError::OutOfRange { index, .. } => target.at_point(toml, *index, error.to_string()),
        TaskError::LengthMismatch { .. } => target.at_all(toml, error.to_string()),
    })
}

/// What to do about points i and i + 1.
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
