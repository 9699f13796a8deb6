//! `[task.path]`: the points, from the file itself or a CSV, and what stands beside them.

use super::raw::RawPath;
use crate::diagnostic::Diagnostic;
use crate::points_file::{self, MAX_POINTS, PointsFile};
use crate::problem::spec::{PathSpec, TimingSpec};
use crate::task::{AngleOffset, PathTask, TaskError};
use crate::toml_text::TomlText;
use std::path::{Component, Path};

/// Points with what stands beside them, from the problem file or a CSV.
struct Target {
    points: Vec<[f64; 2]>,
    csv: Option<PointsFile>,
}

impl Target {
    /// A complaint about a point, where it is written.
    fn at_point(&self, toml: &TomlText<'_>, index: usize, message: String) -> Diagnostic {
        match &self.csv {
            Some(csv) => {
                let diagnostic = Diagnostic::new(csv.file.clone(), csv.text.clone(), message);
                match csv.rows.get(index) {
                    Some(row) => diagnostic.at(row.clone()),
                    None => diagnostic,
                }
            }
            None => toml.at(&format!("task.path.points.{index}"), message),
        }
    }

    /// A complaint about all points.
    fn at_all(&self, toml: &TomlText<'_>, message: String) -> Diagnostic {
        match &self.csv {
            Some(csv) => Diagnostic::new(csv.file.clone(), csv.text.clone(), message),
            None => toml.at("task.path.points", message),
        }
    }
}

/// The path with what stands beside its points, and the task that it is. A tolerance that is set by hand takes the
/// place of the column of a points file.
pub(super) fn path_of(
    toml: &TomlText<'_>,
    path: Option<RawPath>,
    folder: Option<&Path>,
    tolerance_is_set: bool,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(PathSpec, PathTask), Box<Diagnostic>> {
    let Some(path) = path else {
        return Err(Box::new(
            toml.at_key("task", "there is no task in this file")
                .with_help("add a table [task.path] with points = [[x, y], ...] or file = \"points.csv\""),
        ));
    };
    let mut target = target_of(toml, &path, folder)?;
    let n = target.points.len();
    let columns =
        target.csv.as_mut().map(|csv| (csv.crank_deg.take(), csv.weight.take(), csv.tolerance.take()));
    let (csv_crank, weight, csv_tolerance) = columns.unwrap_or_default();
    let tolerance = match (path.tolerance, csv_tolerance) {
        (Some(_), Some(_)) if !tolerance_is_set => {
            return Err(twice(toml, "task.path.tolerance", "tolerance", &path));
        }
        (Some(t), _) if t.0 < 0.0 => {
            let message = format!("tolerance = {}: a distance cannot be negative", t.0);
            return Err(Box::new(toml.at("task.path.tolerance", message).with_help("write 0 or more")));
        }
        (Some(t), _) => Some(vec![t.0; n]),
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
    if let Some(list) = crank_deg.as_ref().filter(|list| list.len() != n) {
        let message = format!("{} and {}", counted(n, "point"), counted(list.len(), "crank angle"));
        return Err(Box::new(
            toml.at("task.path.timing.crank_deg", message).with_help("give one crank angle for each point"),
        ));
    }
    let timing = crank_deg.map(|crank_deg| TimingSpec { crank_deg, offset });
    let points = std::mem::take(&mut target.points);
    let spec = PathSpec { points, closed: path.closed, weight, tolerance, timing };
    let task = spec.to_task().map_err(|error| explain_task(toml, &target, &spec, &error))?;
    warnings.extend(target.csv.into_iter().flat_map(|csv| csv.warnings));
    Ok((spec, task))
}

/// "3 points".
pub(super) fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// The same thing in the problem file and in the points file.
fn twice(toml: &TomlText<'_>, path: &str, what: &str, raw: &RawPath) -> Box<Diagnostic> {
    let file = raw.file.as_deref().unwrap_or_default();
    Box::new(
        toml.at(path, format!("{what} is given here and as a column of {file}"))
            .with_help("remove one of the two"),
    )
}

fn target_of(toml: &TomlText<'_>, path: &RawPath, folder: Option<&Path>) -> Result<Target, Box<Diagnostic>> {
    match (&path.points, &path.file) {
        (Some(_), Some(_)) => Err(Box::new(
            toml.at_key("task.path.file", "two sources of points: points and file")
                .with_help("keep one of the two"),
        )),
        (None, None) => Err(Box::new(
            toml.at_key("task.path", "the path has no points")
                .with_help("add points = [[x, y], ...] or file = \"points.csv\""),
        )),
        (Some(points), None) if points.len() > MAX_POINTS => Err(Box::new(
            toml.at_key(
                "task.path.points",
                format!("{} points; at most {MAX_POINTS} are read", points.len()),
            )
            .with_help("leave out points: a few hundred describe any path that a four-bar can trace"),
        )),
        (Some(points), None) => {
            Ok(Target { points: points.iter().map(|p| p.numbers()).collect(), csv: None })
        }
        (None, Some(file)) => {
            let refuse = |message: String, help: &str| {
                Err(Box::new(toml.at("task.path.file", message).with_help(help)))
            };
            let Some(folder) = folder else {
                return refuse(
                    "a points file cannot be read here: this text comes from no folder".into(),
                    "write the points as points = [[x, y], ...]",
                );
            };
            if !stays_inside(Path::new(file)) {
                return refuse(
                    "the points file lies outside the folder of the problem file".into(),
                    "copy it beside the problem file and name it without a folder",
                );
            }
            let place = folder.join(file);
            if !place.exists() {
                let beside = "it is looked for beside the problem file";
                return refuse(format!("there is no points file {}", place.display()), beside);
            }
            let mut csv = points_file::load(&place)?;
            Ok(Target { points: std::mem::take(&mut csv.points), csv: Some(csv) })
        }
    }
}

/// Whether a relative path leads nowhere above the folder that it starts from.
fn stays_inside(path: &Path) -> bool {
    let mut depth = 0_usize;
    for part in path.components() {
        match part {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir if depth > 0 => depth -= 1,
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return false,
        }
    }
    depth > 0
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
