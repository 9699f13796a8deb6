//! Problem files: TOML is read, and a [`ProblemSpec`] with every default filled in is returned.
//!
//! Reads a file, a text with `--set` overrides, or a bare file of points, all with the same diagnostics. The values under
//! `[expect]` are read and checked and are never part of the specification.

mod certify;
mod closing;
mod design;
mod expect;
mod function;
mod lists;
mod loads;
mod motion;
mod overrides;
mod path;
mod ranges;
mod raw;
mod sweeping;
mod target;

pub use expect::{Expect, ExpectedCensus, Published};
pub(crate) use raw::RawProblem;
pub(crate) use sweeping::{Template, check_value};

use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::input_text;
use crate::files::linkage_file::{check_format, checked_name};
use crate::files::name;
use crate::files::points_file;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{Bounds, Count, OnlyTable};
use crate::mechanism::Unit;
use crate::numbers::optimise::population::PopulationError;
use crate::record::ProblemRecord;
use crate::task::forms::precision;
use crate::task::forms::precision::precise;
use crate::task::forms::reduced;
use crate::task::requirement::{RawRequire, RequirementKind};
use crate::task::spec::{
    DesignSpec, Limits, MAX_CANDIDATES, MAX_EVALUATIONS, MAX_POPULATION, MOST_PICKS_WITHIN, Method,
    Objective, ProblemSpec, RequireSpec, SolveSpec, TaskSpec, TimingSpec,
};
use crate::task::{Problem, TaskKind};
use raw::{RawSolve, RawTask};
use std::path::Path;
use target::Whereabouts;

/// The version of the problem file format that this program reads.
pub const FORMAT: u64 = 1;

/// A problem as stated in its file, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemFile {
    /// The name; the file stem if the file states none.
    pub name: String,
    /// The source of the problem, in words.
    pub source: Option<String>,
    /// The unit that labels lengths.
    pub unit: Option<Unit>,
    /// The specification of the problem and of its search, with every default filled in.
    pub spec: ProblemSpec,
    /// The known facts about the answer; for tests and the suite, never for a search.
    pub expect: Option<Expect>,
    /// Warnings about values that are ignored or cannot succeed.
    pub warnings: Vec<Diagnostic>,
}

impl ProblemFile {
    /// Returns the problem of a record.
    pub fn of(record: ProblemRecord) -> ProblemFile {
        let ProblemRecord { name, source, unit, resolved: spec, .. } = record;
        ProblemFile { name, source, unit, spec, expect: None, warnings: Vec::new() }
    }
}

/// Reads the problem of a file; `overrides` are dotted keys with values in TOML or bare words.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<ProblemFile, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text, Some(folder_of(path)), overrides)
}

/// Reads the problem of a file, or of a bare CSV of points or SVG drawing, according to the name's ending.
///
/// # Errors
/// As [`load`] and [`from_points_file`].
pub fn load_any(path: &Path, overrides: &[(String, String)]) -> Result<ProblemFile, Box<Diagnostic>> {
    if is_bare_target(path) { from_points_file(path, overrides) } else { load(path, overrides) }
}

/// Returns whether a file is a target by itself: a CSV or an SVG.
pub fn is_bare_target(path: &Path) -> bool {
    is_drawing(path) || path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"))
}

/// Returns whether a file is an SVG drawing, by the ending of its name.
pub fn is_drawing(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg"))
}

/// Reads the problem of a text. `file_name` is shown in diagnostics and gives the default name; `folder` is searched
/// for a points file or a drawing, and without it `file = "..."` is refused.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn parse(
    file_name: &str,
    text: &str,
    folder: Option<&Path>,
    overrides: &[(String, String)],
) -> Result<ProblemFile, Box<Diagnostic>> {
    // A path that is typed may lead anywhere; a path in a file may not.
    let files = ["task.path.file", "task.path.svg", "task.motion.file", "task.function.file"];
    let anywhere = files.iter().any(|key| is_set(overrides, key));
    parse_at(file_name, text, &Whereabouts { folder, anywhere, beside: &[] }, overrides)
}

/// Reads the problem of a text that a program's user wrote, as [`parse`] does; files that it names are looked for from
/// `folder`, and may be anywhere.
///
/// # Errors
/// As [`parse`].
pub fn parse_own(
    file_name: &str,
    text: &str,
    folder: &Path,
    overrides: &[(String, String)],
) -> Result<ProblemFile, Box<Diagnostic>> {
    parse_at(file_name, text, &Whereabouts { folder: Some(folder), anywhere: true, beside: &[] }, overrides)
}

/// Reads the problem of a text as [`parse`] does, with points files and drawings that are not on the disk: each with the
/// name under which the problem asks for it.
///
/// # Errors
/// As [`parse`].
pub fn parse_beside(
    file_name: &str,
    text: &str,
    beside: &[(&str, &str)],
    overrides: &[(String, String)],
) -> Result<ProblemFile, Box<Diagnostic>> {
    parse_at(file_name, text, &Whereabouts { folder: None, anywhere: false, beside }, overrides)
}

/// Returns whether a key is among the overrides.
fn is_set(overrides: &[(String, String)], key: &str) -> bool {
    overrides.iter().any(|(set, _)| set == key)
}

fn parse_at(
    file_name: &str,
    text: &str,
    whereabouts: &Whereabouts<'_>,
    overrides: &[(String, String)],
) -> Checked<ProblemFile> {
    let plain = TomlText { file: file_name, text: input_text::without_mark(text) };
    if plain.text.trim().is_empty() {
        let help = "`linkwright new NAME` writes a problem file to start from";
        return plain.refuse_file("the file is empty", help);
    }
    let (file, text) = overrides::apply(&plain, overrides)?;
    let toml = TomlText { file: &file, text: &text };
    let mut raw: RawProblem = toml.read()?;
    check_format(&toml, raw.format, FORMAT)?;
    let name = match raw.name.take() {
        None => name::from_file(file_name, "problem"),
        given => checked_name(&toml, given, "problem")?,
    };
    let path::TaskRead { spec: path, task, unit, mut warnings } =
        task_of(&toml, raw.task.take(), (whereabouts, ends_of(&raw.require.0)), raw.unit, overrides)?;
    let mut design = design::spec_of(&raw.design.0, path.is_of_places());
    design::check(&toml, &design)?;
    if path.is_function() {
        design::of_function(&toml, &design)?;
    }
    let longest_is_silent = raw.require.0.longest_max.is_none();
    let mut require = require_of(&toml, raw.require.0, path.timing.as_ref())?;
    if longest_is_silent {
        require.longest_max = require.default_longest(&design, &task);
    }
    warnings.extend(design::against_requirements(&toml, &design, &require)?);
    let asked = raw.solve.0.certify;
    let mut solve = solve_of(&toml, raw.solve.0)?;
    let (certify, in_vain) = certify::of(&toml, asked, raw.certify.map(|table| table.0), &path)?;
    solve.certify = certify;
    warnings.extend(in_vain);
    method_of(&toml, &path, solve.method)?;
    design::of_kinds(&toml, &raw.design.0, (&path, &solve, &require))?;
    pins_of(&toml, &path, &require)?;
    lines_of(&toml, (&path, &design), &require, solve.method)?;
    if solve.objective == Objective::MaxDeviation {
        warnings.extend(deviation_of(&toml, &path)?);
    }
    let expect = raw.expect.map(|OnlyTable(expect)| expect);
    if let Some(expect) = &expect {
        expect::check(&toml, expect, &path)?;
    }
    design.resolve(&task);
    design::against_lines(&toml, &design, &require)?;
    let unit = raw.unit.or(unit);
    let loads = loads::of(&toml, raw.loads.map(|OnlyTable(loads)| loads), unit, (&path, &design, &require))?;
    let spec = ProblemSpec { task: path, design, require, solve, loads };
    continuation_of(&toml, &spec)?;
    warnings.extend(variables_of(&toml, &spec)?);
    warnings.extend(closing::against(&toml, &spec));
    Ok(ProblemFile { name, source: raw.source, unit, spec, expect, warnings })
}

/// Reads the only task of the table `[task]`.
fn task_of(
    toml: &TomlText<'_>,
    task: Option<OnlyTable<RawTask>>,
    (whereabouts, ends): (&Whereabouts<'_>, Option<[f64; 2]>),
    unit: Option<Unit>,
    overrides: &[(String, String)],
) -> Checked<path::TaskRead> {
    let Some(OnlyTable(RawTask { path, motion, function })) = task else {
        return path::path_of(toml, None, whereabouts, unit, false);
    };
    let tables = [("path", path.is_some()), ("motion", motion.is_some()), ("function", function.is_some())];
    let mut given = tables.iter().filter(|(_, there)| *there).map(|(name, _)| *name);
    if let (Some(first), Some(second)) = (given.next(), given.next()) {
        let message = format!("two tasks: [task.{first}] and [task.{second}]");
        let help = "a problem has one task: keep one of the two";
        return toml.refuse_key(&format!("task.{second}"), message, help);
    }
    let is_set = |key: &str| is_set(overrides, key);
    match (motion, function) {
        (Some(OnlyTable(motion)), _) => motion::motion_of(toml, &motion, whereabouts, is_set),
        (None, Some(OnlyTable(function))) => {
            function::function_of(toml, &function, (whereabouts, ends), is_set)
        }
        (None, None) => {
            let tolerance_is_set = is_set("task.path.tolerance");
            path::path_of(toml, path.map(|table| table.0), whereabouts, unit, tolerance_is_set)
        }
    }
}

/// Returns the stroke and the time ratio that are asked for, if both are numbers that make sense.
fn ends_of(require: &RawRequire) -> Option<[f64; 2]> {
    let fixed = |bounds: Option<Bounds>| bounds.map(|bounds| bounds.0).filter(Limits::is_fixed).map(|l| l.0);
    let [stroke, ratio] = [fixed(require.stroke)?, fixed(require.time_ratio)?];
    (stroke > 0.0 && ratio >= 1.0).then_some([stroke, ratio])
}

/// Reads a bare file of points, poses or pairs, or a bare drawing, as a problem with every default; its name is the file's.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn from_points_file(path: &Path, overrides: &[(String, String)]) -> Result<ProblemFile, Box<Diagnostic>> {
    let shown = path.display().to_string();
    let Some(file) = path.file_name().and_then(|f| f.to_str()) else {
        let diagnostic = Diagnostic::new(shown, "", "the name of this file is not text");
        return Err(Box::new(diagnostic.with_help("rename the file")));
    };
    // Keys of a path that are set on the command line ask for a path through the places.
    let asks_for_path = overrides.iter().any(|(key, _)| key.starts_with("task.path."));
    let text = text_about(file, if asks_for_path { TaskKind::Path } else { kind_of_bare(path) });
    let whereabouts = Whereabouts { folder: Some(folder_of(path)), anywhere: true, beside: &[] };
    parse_at(&shown, &text, &whereabouts, overrides)
}

/// Returns whether a bare target holds poses: a CSV with the column angle_deg.
pub fn holds_poses(path: &Path) -> bool {
    !is_drawing(path) && points_file::holds_poses(path)
}

/// Returns whether a bare target holds pairs of a function: a CSV with the column input_deg.
pub fn holds_pairs(path: &Path) -> bool {
    !is_drawing(path) && points_file::holds_pairs(path)
}

/// Returns the kind of task that a bare target is: a function of pairs, a motion of poses, else a path.
fn kind_of_bare(path: &Path) -> TaskKind {
    if holds_pairs(path) {
        TaskKind::Function
    } else if holds_poses(path) {
        TaskKind::Motion
    } else {
        TaskKind::Path
    }
}

/// Returns the text of a problem file whose target is a points file, a file of poses or pairs or a drawing and that states
/// nothing else.
fn text_about(target: &str, kind: TaskKind) -> String {
    let key = if is_drawing(Path::new(target)) { "svg" } else { "file" };
    let value = toml::Value::String(target.to_owned());
    format!("format = {FORMAT}\n[{}]\n{key} = {value}\n", kind.table())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn require_of(toml: &TomlText<'_>, raw: RawRequire, timing: Option<&TimingSpec>) -> Checked<RequireSpec> {
    let require = RequireSpec::from(raw);
    for kind in RequirementKind::all() {
        let definition = kind.definition();
        if let Err(refusal) = (definition.check)(&require, timing) {
            return toml.refuse(definition.key, refusal.message, refusal.help);
        }
    }
    Ok(require)
}

fn solve_of(toml: &TomlText<'_>, raw: RawSolve) -> Checked<SolveSpec> {
    let default = SolveSpec::default();
    let within = |key: &str, given: Option<Count>, default: u64, least: u64, most: u64| match given {
        None => Ok(default),
        Some(Count(value)) if (least..=most).contains(&value) => Ok(value),
        Some(Count(value)) => toml.refuse(
            &format!("solve.{key}"),
            format!("{key} = {value} is not between {least} and {most}"),
            format!("write a whole number from {least} to {most}; the default is {default}"),
        ),
    };
    let seed = within("seed", raw.seed, default.seed, 0, i64::MAX as u64)?;
    let candidates =
        within("candidates", raw.candidates, default.candidates as u64, 1, MAX_CANDIDATES as u64)? as usize;
    let evaluations = within("evaluations", raw.evaluations, default.evaluations, 1, MAX_EVALUATIONS)?;
    if let Some(t) = raw.time_limit_s
        && t.0 <= 0.0
    {
        let message = format!("time_limit_s = {}: a time limit must be positive", t.0);
        let help = "write seconds above 0, or remove the key for no limit";
        return toml.refuse("solve.time_limit_s", message, help);
    }
    let picks_within = raw.picks_within.map_or(default.picks_within, |within| within.0);
    if !(1.0..=MOST_PICKS_WITHIN).contains(&picks_within) {
        let message =
            format!("picks_within = {picks_within}: a factor of the least error, 1 to {MOST_PICKS_WITHIN}");
        return toml.refuse(
            "solve.picks_within",
            message,
            "write 1.5 for picks with half as much error again",
        );
    }
    let (OnlyTable(genetic), OnlyTable(differential_evolution)) = (raw.genetic, raw.differential_evolution);
    let parameters = [
        ("genetic", genetic.check(), genetic.population),
        ("differential-evolution", differential_evolution.check(), differential_evolution.population),
    ];
    for (table, check, population) in parameters {
        let path = |key: &str| format!("solve.{table}.{key}");
        match check {
            Ok(()) if population <= MAX_POPULATION => {}
            Ok(()) => {
                let message = format!("population = {population} is above {MAX_POPULATION}");
                return toml.refuse(&path("population"), message, "a few hundred are usual");
            }
            Err(PopulationError::Parameter { name, value, requirement }) => {
                let message = format!("{name} = {value} is out of range");
                return toml.refuse(&path(name), message, format!("write {requirement}"));
            }
            Err(other) => return Err(Box::new(toml.at(&format!("solve.{table}"), other.to_string()))),
        }
    }
    Ok(SolveSpec {
        method: raw.method,
        objective: raw.objective,
        variables: raw.variables,
        seed,
        candidates,
        evaluations,
        time_limit_s: raw.time_limit_s.map(|t| t.0),
        advice: raw.advice.unwrap_or(default.advice),
        picks_within,
        certify: None,
        genetic,
        differential_evolution,
    })
}

/// Checks that there is a body, where its pins are to lie in a part of it.
fn pins_of(toml: &TomlText<'_>, task: &TaskSpec, require: &RequireSpec) -> Checked<()> {
    if require.pins_in.is_none() || task.is_motion() {
        return Ok(());
    }
    let kind = task.kind().name();
    let help = "remove it, or give the body's poses in [task.motion]; pivots_in is for the fixed pivots";
    toml.refuse("require.pins_in", format!("pins_in is a part of a body, and a {kind} has no body"), help)
}

/// Checks that pivots may be asked to lie on lines: not those of a function, and by a method that can hold them there.
fn lines_of(
    toml: &TomlText<'_>,
    (task, design): (&TaskSpec, &DesignSpec),
    require: &RequireSpec,
    method: Method,
) -> Checked<()> {
    let Some(pivot_on) = &require.pivot_on else { return Ok(()) };
    if task.is_function() {
        let help = "remove it, and give the pivots in [design]: A = [0, 0], B = [100, 0]";
        return toml.refuse("require.pivot_on", "pivot_on is not for functions", help);
    }
    // Then B follows from A and the ground line, and is no coordinate.
    let polar =
        design.follower_pivot.is_none() && (design.ground.is_some() || design.ground_angle_deg.is_some());
    let is_population = matches!(method, Method::Genetic | Method::DifferentialEvolution);
    if polar && is_population && pivot_on.follower_pivot.is_some() {
        let message =
            format!("method = \"{}\" cannot hold B on a line where [design] gives the ground", method.name());
        let help = "write method = \"auto\" or \"least-squares\", or give B its bounds in [design]";
        return toml.refuse("solve.method", message, help);
    }
    Ok(())
}

/// Checks that a method suits the task.
fn method_of(toml: &TomlText<'_>, task: &TaskSpec, method: Method) -> Checked<()> {
    match method {
        Method::Genetic | Method::DifferentialEvolution
            if task.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) =>
        {
            toml.refuse(
                "solve.method",
                format!(
                    "method = \"{}\" does not support free crank angles among prescribed ones",
                    method.name()
                ),
                "write method = \"auto\" or \"least-squares\", or give every target a crank angle",
            )
        }
        Method::Genetic | Method::DifferentialEvolution
            if task.output.as_ref().is_some_and(|output| output.ranges.is_free()) =>
        {
            toml.refuse(
                "solve.method",
                format!("method = \"{}\" does not support free ranges", method.name()),
                "write method = \"auto\" or \"least-squares\", or fix the ranges",
            )
        }
        _ => Ok(()),
    }
}

/// Checks the points for the objective of the largest deviation: tolerances must be above zero; weights give a warning.
fn deviation_of(toml: &TomlText<'_>, path: &TaskSpec) -> Checked<Option<Diagnostic>> {
    if let Some(j) = path.tolerance.iter().flatten().position(|t| *t == 0.0) {
        let message = format!("deviations are measured by the tolerances, and that of point {j} is 0");
        return toml.refuse("solve.objective", message, "give every point a tolerance above 0, or none");
    }
    let message = "weights do not enter the largest deviation";
    let help = "give tolerances: a point with half the tolerance counts twice";
    Ok(path.weight.is_some().then(|| toml.at("solve.objective", message).with_help(help)))
}

/// Checks that continuation has precision points, or poses and points, through which finitely many linkages of one kind pass.
fn continuation_of(toml: &TomlText<'_>, spec: &ProblemSpec) -> Checked<()> {
    if spec.solve.method != Method::Continuation {
        return Ok(());
    }
    // Faults of the task itself have been reported before.
    let Some(Err(refusal)) = Problem::new(spec.clone()).ok().map(|problem| precise(&problem)) else {
        return Ok(());
    };
    let key = match refusal {
        precision::Refusal::Coincident { second, .. } if spec.task.body.is_none() => {
            format!("task.path.points.{second}")
        }
        precision::Refusal::Kinds => "design.mechanism".to_owned(),
        _ => "solve.method".to_owned(),
    };
    toml.refuse(&key, refusal.to_string(), refusal.remedy())
}

/// Checks that reduced variables have a reduced form; returns a warning if the method does not use them.
fn variables_of(toml: &TomlText<'_>, spec: &ProblemSpec) -> Checked<Option<Diagnostic>> {
    if spec.solve.variables.is_nine() {
        return Ok(None);
    }
    if !spec.solve.moves_reduced() {
        let method = spec.solve.method.name();
        let message = format!("variables = \"reduced\" is not read by method = \"{method}\"");
        let help = "it is for genetic and differential-evolution; remove it, or choose one of them";
        return Ok(Some(toml.at("solve.variables", message).with_help(help)));
    }
    if spec.task.body.is_some() {
        let noun = if spec.task.is_function() { "functions" } else { "poses" };
        let help = "write variables = \"nine\", or method = \"auto\"";
        return toml.refuse(
            "solve.variables",
            format!("variables = \"reduced\" is for paths, not for {noun}"),
            help,
        );
    }
    // Faults of the task itself have been reported before.
    match Problem::new(spec.clone()).ok().and_then(|problem| reduced::refusal(&problem)) {
        None => Ok(None),
        Some(refusal) => toml.refuse("solve.variables", refusal.to_string(), refusal.remedy()),
    }
}
