//! Reads the targets of a task from the file itself, or from a CSV or a drawing beside it.

use super::ranges::RangeNumbers;
use super::raw::{RawFunction, RawMotion, RawPath};
use crate::files::diagnostic::{Checked, Diagnostic, counted, quoted};
use crate::files::points_file;
use crate::files::points_file::{MAX_POINTS, PointsFile};
use crate::files::svg_file;
use crate::files::svg_file::{SvgOptions, SvgTarget};
use crate::files::toml_text::TomlText;
use crate::mechanism::Unit;
use crate::task::TaskKind;
use std::path::{Component, Path, PathBuf};

/// The places of the files that a problem file names.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whereabouts<'a> {
    /// The folder of the problem file, where it has one.
    pub folder: Option<&'a Path>,
    /// Whether the file was named on the command line, so that it may lie anywhere.
    pub anywhere: bool,
    /// Points files and drawings that are not on the disk, by the names under which a problem asks for them.
    pub beside: &'a [(&'a str, &'a str)],
}

/// The source of the points.
pub(super) enum Source {
    /// The problem file.
    File,
    /// A CSV.
    Csv(PointsFile),
    /// A drawing.
    Svg(SvgTarget),
}

/// Targets with their source.
pub(super) struct Target {
    /// The kind of their task.
    pub kind: TaskKind,
    /// The places; of a function, the input and the output of each pair, degrees.
    pub points: Vec<[f64; 2]>,
    pub source: Source,
    pub closed: bool,
    /// The number of samples asked for.
    pub samples: Option<usize>,
    /// Whether the points are no longer those of the source.
    pub resampled: bool,
    /// Whether the outputs of a function are places of a slider.
    pub of_places: bool,
}

impl Target {
    /// Reads the points of a path from its source.
    pub fn of(
        toml: &TomlText<'_>,
        path: &RawPath,
        whereabouts: &Whereabouts<'_>,
        unit: Option<Unit>,
    ) -> Checked<Target> {
        let refuse =
            |key: &str, message: String, help: &str| toml.refuse(&format!("task.path.{key}"), message, help);
        let given =
            [("points", path.points.is_some()), ("file", path.file.is_some()), ("svg", path.svg.is_some())];
        let mut given = given.iter().filter(|(_, there)| *there).map(|(key, _)| *key);
        if let (Some(first), Some(second)) = (given.next(), given.next()) {
            let message = format!("two sources of points: {first} and {second}");
            return toml.refuse_key(&format!("task.path.{second}"), message, "keep one of the two");
        }
        if path.svg_id.is_some() && path.svg.is_none() {
            let help = "name the drawing too: svg = \"drawing.svg\"; or remove svg_id";
            return refuse("svg_id", "svg_id names a shape, but there is no drawing".into(), help);
        }
        let samples = match path.samples {
            None => None,
            Some(count) if (2..=MAX_POINTS as u64).contains(&count.0) => Some(count.0 as usize),
            Some(count) => {
                let message = format!("samples = {} is not between 2 and {MAX_POINTS}", count.0);
                return refuse("samples", message, "60 points describe most paths");
            }
        };
        let mut closed = path.closed.unwrap_or(false);
        let (points, source) = if let Some(points) = &path.points {
            if points.len() > MAX_POINTS {
                let message = format!("{} points; at most {MAX_POINTS} are read", points.len());
                let help = "leave out points: a few hundred describe any path that a four-bar can trace";
                return toml.refuse_key("task.path.points", message, help);
            }
            (points.iter().map(|p| p.0).collect(), Source::File)
        } else if let Some(file) = &path.file {
            if Path::new(file).extension().is_some_and(|of| of.eq_ignore_ascii_case("svg")) {
                let message = format!("{file} is a drawing, and file names a table of points");
                return refuse("file", message, &format!("write svg = \"{file}\""));
            }
            let mut csv = match whereabouts.text_of(file) {
                Some(text) => points_file::parse(file, text)?,
                None => points_file::load(&whereabouts.find(toml, "task.path.file", file)?)?,
            };
            (std::mem::take(&mut csv.points), Source::Csv(csv))
        } else if let Some(file) = &path.svg {
            let options = SvgOptions {
                id: path.svg_id.as_deref(),
                samples: samples.unwrap_or(svg_file::DEFAULT_SAMPLES),
                closed: path.closed,
                unit,
            };
            let mut svg = match whereabouts.text_of(file) {
                Some(text) => svg_file::parse(file, text, &options)?,
                None => svg_file::load(&whereabouts.find(toml, "task.path.svg", file)?, &options)?,
            };
            closed = svg.closed;
            (std::mem::take(&mut svg.points), Source::Svg(svg))
        } else {
            let help = "add points = [[x, y], ...] or file = \"points.csv\" or svg = \"drawing.svg\"";
            return toml.refuse_key("task.path", "the path has no points", help);
        };
        let kind = TaskKind::Path;
        Ok(Target { kind, points, source, closed, samples, resampled: false, of_places: false })
    }

    /// Reads the poses of a motion from its source; the second value holds their angles, `None` where only the place
    /// counts.
    pub fn of_motion(
        toml: &TomlText<'_>,
        motion: &RawMotion,
        whereabouts: &Whereabouts<'_>,
    ) -> Checked<(Target, Vec<Option<f64>>)> {
        let (points, angles, source) = match (&motion.poses, &motion.file) {
            (Some(_), Some(_)) => {
                let message = "two sources of poses: poses and file";
                return toml.refuse_key("task.motion.file", message, "keep one of the two");
            }
            (Some(poses), None) => {
                if poses.len() > MAX_POINTS {
                    let message = format!("{} poses; at most {MAX_POINTS} are read", poses.len());
                    return toml.refuse_key(
                        "task.motion.poses",
                        message,
                        "leave out poses: a few hundred suffice",
                    );
                }
                let (points, angles) = poses.iter().map(|pose| (pose.place, pose.angle_deg)).unzip();
                (points, angles, Source::File)
            }
            (None, Some(file)) => {
                let mut csv = match whereabouts.text_of(file) {
                    Some(text) => points_file::parse(file, text)?,
                    None => points_file::load(&whereabouts.find(toml, "task.motion.file", file)?)?,
                };
                let Some(angles) = csv.angle_deg.take() else {
                    let message = format!("{} has no column angle_deg", quoted(file));
                    let help = "add a column angle_deg; an empty cell asks for the place alone";
                    return toml.refuse("task.motion.file", message, help);
                };
                (std::mem::take(&mut csv.points), angles, Source::Csv(csv))
            }
            (None, None) => {
                let help = "add poses = [[x, y, angle in degrees], ...] or file = \"poses.csv\"";
                return toml.refuse_key("task.motion", "the motion has no poses", help);
            }
        };
        let closed = motion.closed.unwrap_or(false);
        let kind = TaskKind::Motion;
        Ok((
            Target { kind, points, source, closed, samples: None, resampled: false, of_places: false },
            angles,
        ))
    }

    /// Reads the pairs of a function from its source; without one they are the `ends` of a stroke: its length, and the time
    /// ratio.
    pub fn of_function(
        toml: &TomlText<'_>,
        function: &RawFunction,
        whereabouts: &Whereabouts<'_>,
        ends: Option<[f64; 2]>,
    ) -> Checked<Target> {
        let refuse = |key: &str, message: String, help: &str| {
            toml.refuse_key(&format!("task.function.{key}"), message, help)
        };
        let given = [
            ("input_deg", function.input_deg.is_some() || super::function::outputs(function).is_some()),
            ("file", function.file.is_some()),
            ("of", function.of.is_some()),
        ];
        let mut sources = given.iter().filter(|(_, there)| *there).map(|(key, _)| *key);
        let (source, second) = (sources.next(), sources.next());
        if let (Some(first), Some(second)) = (source, second) {
            let message = format!("two sources of pairs: {first} and {second}");
            return refuse(second, message, "keep one of the two");
        }
        let of_formula = [
            ("over", function.over.is_some()),
            ("input_range_deg", matches!(function.input_range_deg, Some(RangeNumbers::Given(_)))),
            ("output_range_deg", matches!(function.output_range_deg, Some(RangeNumbers::Given(_)))),
            ("output_range", function.output_range.is_some()),
            ("samples", function.samples.is_some()),
        ];
        if let Some((key, _)) = of_formula.iter().find(|(_, there)| *there && function.of.is_none()) {
            let message = format!("{key} belongs to a formula, and there is none");
            let help = match key.ends_with("range_deg") {
                true => {
                    "remove it, write it \"free\" for pairs in proportion, or write of = \"a formula in x\""
                }
                false => "remove it, or write of = \"a formula in x\"",
            };
            return refuse(key, message, help);
        }
        let is_stroke = source.is_none() && ends.is_some();
        let (points, source) = match source {
            Some("input_deg") => (Self::pairs_here(toml, function)?, Source::File),
            Some("file") => {
                let file = function.file.as_deref().unwrap_or_default();
                let mut csv = match whereabouts.text_of(file) {
                    Some(text) => points_file::parse_pairs(file, text)?,
                    None => points_file::load_pairs(&whereabouts.find(toml, "task.function.file", file)?)?,
                };
                (std::mem::take(&mut csv.points), Source::Csv(csv))
            }
            Some(_) => (super::function::of_formula(toml, function)?, Source::File),
            // The slower way between the ends of the stroke.
            None if ends.is_some() => {
                let [stroke, ratio] = ends.unwrap_or_default();
                (vec![[0.0, 0.0], [360.0 * ratio / (1.0 + ratio), stroke]], Source::File)
            }
            None => {
                let help = "add input_deg = [..] and output_deg = [..] (or output = [..]), or file = \"table.csv\", or of = \"log10(x)\"";
                return toml.refuse_key("task.function", "the function has no pairs", help);
            }
        };
        let kind = TaskKind::Function;
        let of_places = match &source {
            Source::Csv(csv) => csv.of_places,
            _ => function.output.is_some() || function.output_range.is_some() || is_stroke,
        };
        Ok(Target { kind, points, source, closed: false, samples: None, resampled: false, of_places })
    }

    /// Returns the pairs that the problem file itself gives.
    fn pairs_here(toml: &TomlText<'_>, function: &RawFunction) -> Checked<Vec<[f64; 2]>> {
        let outputs = super::function::outputs(function);
        let (Some(inputs), Some((key, outputs))) = (&function.input_deg, outputs) else {
            let missing = if function.input_deg.is_none() { "input_deg" } else { "output_deg" };
            let message = format!("the function has no {missing}");
            let help = "give one angle of the crank (input_deg) and one of the follower (output_deg), or a place of a slider \
                        (output), a pair";
            return toml.refuse_key("task.function", message, help);
        };
        if inputs.len() != outputs.len() {
            let [inputs, outputs] =
                [(inputs.len(), "input"), (outputs.len(), "output")].map(|(n, what)| counted(n, what));
            let message = format!("{inputs} and {outputs}");
            let key = format!("task.function.{key}");
            return toml.refuse(&key, message, "give one output for each input");
        }
        if inputs.len() > MAX_POINTS {
            let message = format!("{} pairs; at most {MAX_POINTS} are read", inputs.len());
            let help = "leave out pairs: a few hundred suffice";
            return toml.refuse_key("task.function.input_deg", message, help);
        }
        Ok(inputs.iter().zip(outputs).map(|(input, output)| [input.0, output.0]).collect())
    }

    /// Returns a diagnostic about a point, at its place.
    pub fn at_point(&self, toml: &TomlText<'_>, index: usize, message: String) -> Diagnostic {
        match &self.source {
            _ if self.resampled => self.at_all(toml, message),
            Source::Csv(csv) => {
                Diagnostic::new(csv.file.clone(), csv.text.clone(), message).at(csv.rows.get(index).cloned())
            }
            Source::File => toml.at(&format!("{}.{index}", self.kind.list_key()), message),
            Source::Svg(_) => self.at_all(toml, message),
        }
    }

    /// Returns a diagnostic about all points.
    pub fn at_all(&self, toml: &TomlText<'_>, message: String) -> Diagnostic {
        match &self.source {
            Source::Csv(csv) => Diagnostic::new(csv.file.clone(), csv.text.clone(), message),
            Source::Svg(svg) => Diagnostic::new(svg.file.clone(), "", message),
            Source::File => toml.at(self.kind.list_key(), message),
        }
    }
}

impl Whereabouts<'_> {
    /// Returns the text of a file that is not on the disk.
    fn text_of(&self, file: &str) -> Option<&str> {
        self.beside.iter().find(|(name, _)| *name == file).map(|(_, text)| *text)
    }

    /// Returns the file that a key names: inside the problem file's folder, links followed, or anywhere where it
    /// was named on the command line.
    pub fn find(&self, toml: &TomlText<'_>, key: &str, file: &str) -> Checked<PathBuf> {
        let what = if key.ends_with(".svg") { "drawing" } else { "points file" };
        let refuse = |message: String, help: &str| toml.refuse(key, message, help);
        let Some(folder) = self.folder else {
            return refuse(
                format!("a {what} cannot be read here: this text comes from no folder"),
                if key.starts_with("task.motion") {
                    "write the poses as poses = [[x, y, angle in degrees], ...]"
                } else if key.starts_with("task.function") {
                    "write the pairs as input_deg = [..] and output_deg = [..]"
                } else {
                    "write the points as points = [[x, y], ...]"
                },
            );
        };
        let place = folder.join(file);
        if self.anywhere {
            return Ok(place);
        }
        let outside = |how: &str| {
            refuse(
                format!("the {what} lies outside the folder of the problem file{how}"),
                "copy it beside the problem file and name it without a folder",
            )
        };
        if !stays_inside(Path::new(file)) {
            return outside("");
        }
        if !place.exists() {
            let beside = "it is looked for beside the problem file";
            return refuse(format!("there is no {what} {}", place.display()), beside);
        }
        // An empty path is the folder we are in.
        let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        match (here.canonicalize(), place.canonicalize()) {
            (Ok(here), Ok(real)) if real.starts_with(&here) => Ok(place),
            (Ok(_), Ok(_)) => outside(": it is a link"),
            _ => refuse(format!("{} cannot be found", quoted(file)), "check the folders above it"),
        }
    }
}

/// Returns whether a relative path leads nowhere above the folder that it starts from.
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
