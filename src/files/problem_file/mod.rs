//! Problem files: TOML is read, and a [`ProblemSpec`] with every default filled in is returned.
//!
//! Reads a file, a text with `--set` overrides, or a bare file of points, all with the same diagnostics. The values under
//! `[expect]` are read and checked and are never part of the specification.

mod certify;
mod closing;
mod design;
mod overrides;
mod path;
mod raw;
mod target;

pub(crate) use raw::RawProblem;

use crate::files::diagnostic::Diagnostic;
use crate::files::input_text;
use crate::files::linkage_file::{check_format, checked_name};
use crate::files::name;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{Count, OnlyTable};
use crate::mechanism::AssemblyMode;
use crate::mechanism::Unit;
use crate::numbers::optimise::population::PopulationError;
use crate::task::Problem;
use crate::task::forms::precision;
use crate::task::forms::precision::precision_points;
use crate::task::forms::reduced;
use crate::task::requirement::{RawRequire, RequirementKind};
use crate::task::spec::{
    MAX_CANDIDATES, MAX_EVALUATIONS, MAX_POPULATION, Method, Objective, PathSpec, ProblemSpec, RequireSpec,
    SolveSpec, TimingSpec,
};
use raw::{RawExpect, RawSolve};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
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

/// What is known of a problem's answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// The least sum of squared errors that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub best_known_sum_sq: Option<f64>,
    /// What a run has to reach to count as a hit; absent: the best known sum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal_sum_sq: Option<f64>,
    /// How many linkages there are through nine points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact: Option<ExpectedCensus>,
    /// Answers that were published.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub published: Vec<Published>,
}

/// How many classes of exact linkages a problem has; what is not known is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedCensus {
    /// Isolated solutions up to cognates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub classes: Option<usize>,
    /// Those that are real linkages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub real: Option<usize>,
    /// Of these, on one circuit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_circuit: Option<usize>,
    /// Of these, in the order of the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_order: Option<usize>,
    /// Of these, on one branch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_of_defects: Option<usize>,
}

/// A published answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// Author and year.
    pub source: String,
    /// r1 ground, r2 crank, r3 coupler, r4 follower, rcx, rcy, x0, y0, theta0 (radians); or empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vector: Vec<f64>,
    /// Which way it closes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<i64>")]
    pub t1: Option<AssemblyMode>,
    /// The crank angles that were published, degrees from the ground line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crank_deg: Option<Vec<f64>>,
    /// The error that was printed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub printed_sum_sq: Option<f64>,
    /// The error that the vector has when this project evaluates it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recomputed_sum_sq: Option<f64>,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
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
    let anywhere = ["file", "svg"].iter().any(|key| is_set(overrides, &format!("task.path.{key}")));
    parse_at(file_name, text, &Whereabouts { folder, anywhere, beside: &[] }, overrides)
}

/// Reads the problem of a text as [`parse`] does, with points files that are not on the disk: each with the name under
/// which the problem asks for it.
///
/// # Errors
/// As [`parse`].
pub fn parse_beside(
    file_name: &str,
    text: &str,
    beside: &[(&str, &str)],
) -> Result<ProblemFile, Box<Diagnostic>> {
    parse_at(file_name, text, &Whereabouts { folder: None, anywhere: false, beside }, &[])
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
) -> Result<ProblemFile, Box<Diagnostic>> {
    let plain = TomlText { file: file_name, text: input_text::without_mark(text) };
    if plain.text.trim().is_empty() {
        let help = "`linkwright new NAME` writes a problem file to start from";
        return Err(Box::new(plain.about_file("the file is empty").with_help(help)));
    }
    let (file, text) = overrides::apply(&plain, overrides)?;
    let toml = TomlText { file: &file, text: &text };
    let mut raw: RawProblem = toml.read()?;
    check_format(&toml, raw.format, FORMAT)?;
    let name = match raw.name.take() {
        None => name::from_file(file_name, "problem"),
        given => checked_name(&toml, given, "problem")?,
    };
    let tolerance_is_set = is_set(overrides, "task.path.tolerance");
    let path = raw.task.take().and_then(|t| t.0.path).map(|p| p.0);
    let path::PathRead { spec: path, task, unit, mut warnings } =
        path::path_of(&toml, path, whereabouts, raw.unit, tolerance_is_set)?;
    let design = design::spec_of(&raw.design.0);
    design::check(&toml, &design)?;
    let require = require_of(&toml, raw.require.0, path.timing.as_ref())?;
    warnings.extend(design::against_requirements(&toml, &design, &require)?);
    let asked = raw.solve.0.certify;
    let mut solve = solve_of(&toml, raw.solve.0)?;
    let certificate = certify::of(&toml, asked, raw.certify.map(|table| table.0), &path)?;
    solve.certify = certificate.spec;
    warnings.extend(certificate.warning);
    if solve.objective == Objective::MaxDeviation {
        warnings.extend(deviation_of(&toml, &path)?);
    }
    let expect = raw.expect.map(|e| expect_of(&toml, e.0, path.points.len())).transpose()?;
    let spec = ProblemSpec::resolved(path, &task, design, require, solve);
    continuation_of(&toml, &spec)?;
    warnings.extend(variables_of(&toml, &spec)?);
    warnings.extend(closing::against(&toml, &spec));
    let unit = raw.unit.or(unit);
    Ok(ProblemFile { name, source: raw.source, unit, spec, expect, warnings })
}

/// Reads a bare file of points, or a bare drawing, as a problem with every default; its name is the file's.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn from_points_file(path: &Path, overrides: &[(String, String)]) -> Result<ProblemFile, Box<Diagnostic>> {
    let shown = path.display().to_string();
    let Some(file) = path.file_name().and_then(|f| f.to_str()) else {
        return Err(Box::new(
            Diagnostic::new(shown, "", "the name of this file is not text").with_help("rename the file"),
        ));
    };
    let key = if is_drawing(path) { "svg" } else { "file" };
    let value = toml::Value::String(file.to_owned());
    let text = format!("format = {FORMAT}\n[task.path]\n{key} = {value}\n");
    let whereabouts = Whereabouts { folder: Some(folder_of(path)), anywhere: true, beside: &[] };
    parse_at(&shown, &text, &whereabouts, overrides)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn require_of(
    toml: &TomlText<'_>,
    raw: RawRequire,
    timing: Option<&TimingSpec>,
) -> Result<RequireSpec, Box<Diagnostic>> {
    let require = RequireSpec::from(raw);
    for kind in RequirementKind::all() {
        let definition = kind.definition();
        if let Err(refusal) = (definition.check)(&require, timing) {
            return Err(Box::new(toml.at(definition.key, refusal.message).with_help(refusal.help)));
        }
    }
    Ok(require)
}

fn solve_of(toml: &TomlText<'_>, raw: RawSolve) -> Result<SolveSpec, Box<Diagnostic>> {
    let default = SolveSpec::default();
    let within = |key: &str, given: Option<Count>, default: u64, least: u64, most: u64| match given {
        None => Ok(default),
        Some(Count(value)) if (least..=most).contains(&value) => Ok(value),
        Some(Count(value)) => Err(Box::new(
            toml.at(&format!("solve.{key}"), format!("{key} = {value} is not between {least} and {most}"))
                .with_help(format!("write a whole number from {least} to {most}; the default is {default}")),
        )),
    };
    let seed = within("seed", raw.seed, default.seed, 0, i64::MAX as u64)?;
    let candidates =
        within("candidates", raw.candidates, default.candidates as u64, 1, MAX_CANDIDATES as u64)? as usize;
    let evaluations = within("evaluations", raw.evaluations, default.evaluations, 1, MAX_EVALUATIONS)?;
    if let Some(t) = raw.time_limit_s
        && t.0 <= 0.0
    {
        let message = format!("time_limit_s = {}: a time limit must be positive", t.0);
        return Err(Box::new(
            toml.at("solve.time_limit_s", message)
                .with_help("write seconds above 0, or remove the key for no limit"),
        ));
    }
    let parameters = [
        ("genetic", raw.genetic.0.check(), raw.genetic.0.population),
        (
            "differential-evolution",
            raw.differential_evolution.0.check(),
            raw.differential_evolution.0.population,
        ),
    ];
    for (table, check, population) in parameters {
        let refuse = |key: &str, message: String| toml.at(&format!("solve.{table}.{key}"), message);
        match check {
            Ok(()) => {}
            Err(PopulationError::Parameter { name, value, requirement }) => {
                let diagnostic = refuse(name, format!("{name} = {value} is out of range"));
                return Err(Box::new(diagnostic.with_help(format!("write {requirement}"))));
            }
            Err(other) => return Err(Box::new(toml.at(&format!("solve.{table}"), other.to_string()))),
        }
        if population > MAX_POPULATION {
            let diagnostic =
                refuse("population", format!("population = {population} is above {MAX_POPULATION}"));
            return Err(Box::new(diagnostic.with_help("a few hundred are usual")));
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
        certify: None,
        genetic: raw.genetic.0,
        differential_evolution: raw.differential_evolution.0,
    })
}

/// Checks the points for the objective of the largest deviation: tolerances must be above zero; weights give a warning.
fn deviation_of(toml: &TomlText<'_>, path: &PathSpec) -> Result<Option<Diagnostic>, Box<Diagnostic>> {
    if let Some(j) = path.tolerance.iter().flatten().position(|t| *t == 0.0) {
        let message = format!("deviations are measured by the tolerances, and that of point {j} is 0");
        return Err(Box::new(
            toml.at("solve.objective", message).with_help("give every point a tolerance above 0, or none"),
        ));
    }
    let message = "weights do not enter the largest deviation";
    Ok(path.weight.is_some().then(|| {
        toml.at("solve.objective", message)
            .with_help("give tolerances: a point with half the tolerance counts twice")
    }))
}

/// Checks that continuation has nine precision points.
fn continuation_of(toml: &TomlText<'_>, spec: &ProblemSpec) -> Result<(), Box<Diagnostic>> {
    if spec.solve.method != Method::Continuation {
        return Ok(());
    }
    // Faults of the task itself have been reported before.
    let refusal = Problem::new(spec.clone()).ok().and_then(|problem| precision_points(&problem).err());
    refusal.map_or(Ok(()), |refusal| {
        let key = match refusal {
            precision::Refusal::Points { .. } | precision::Refusal::Timed => "solve.method".to_owned(),
            precision::Refusal::Coincident { second, .. } => format!("task.path.points.{second}"),
        };
        Err(Box::new(toml.at(&key, refusal.to_string()).with_help(refusal.remedy())))
    })
}

/// Checks that reduced variables have a reduced form; returns a warning if the method does not use them.
fn variables_of(toml: &TomlText<'_>, spec: &ProblemSpec) -> Result<Option<Diagnostic>, Box<Diagnostic>> {
    if spec.solve.variables.is_nine() {
        return Ok(None);
    }
    if !spec.solve.moves_reduced() {
        let message =
            format!("variables = \"reduced\" is not read by method = \"{}\"", spec.solve.method.name());
        return Ok(Some(
            toml.at("solve.variables", message)
                .with_help("it is for genetic and differential-evolution; remove it, or choose one of them"),
        ));
    }
    // Faults of the task itself have been reported before.
    match Problem::new(spec.clone()).ok().and_then(|problem| reduced::refusal(&problem)) {
        None => Ok(None),
        Some(refusal) => {
            Err(Box::new(toml.at("solve.variables", refusal.to_string()).with_help(refusal.remedy())))
        }
    }
}

/// The number of values of a published vector.
const PUBLISHED_VECTOR: usize = 9;

fn expect_of(toml: &TomlText<'_>, raw: RawExpect, points: usize) -> Result<Expect, Box<Diagnostic>> {
    let not_negative = |path: String, value: Option<f64>| match value {
        Some(v) if v < 0.0 => Err(Box::new(
            toml.at(&path, format!("{v} is negative: a sum of squares is 0 or more"))
                .with_help("write 0 or more"),
        )),
        other => Ok(other),
    };
    let best = not_negative("expect.best_known_sum_sq".into(), raw.best_known_sum_sq.map(|n| n.0))?;
    let goal = not_negative("expect.goal_sum_sq".into(), raw.goal_sum_sq.map(|n| n.0))?;
    let mut published = Vec::with_capacity(raw.published.len());
    for (i, OnlyTable(p)) in raw.published.into_iter().enumerate() {
        let path = |key: &str| format!("expect.published.{i}.{key}");
        if !p.vector.is_empty() && p.vector.len() != PUBLISHED_VECTOR {
            let message =
                format!("a published vector has {PUBLISHED_VECTOR} numbers, this one {}", p.vector.len());
            return Err(Box::new(toml.at(&path("vector"), message).with_help(
                "[ground, crank, coupler, follower, rcx, rcy, x0, y0, theta0]; or leave it empty",
            )));
        }
        if let Some(list) = p.crank_deg.as_ref().filter(|list| list.len() != points) {
            let (points, angles) = (path::counted(points, "point"), path::counted(list.len(), "crank angle"));
            let message = format!("{points} and {angles}");
            return Err(Box::new(
                toml.at(&path("crank_deg"), message).with_help("give one crank angle for each point"),
            ));
        }
        published.push(Published {
            source: p.source,
            vector: p.vector.iter().map(|n| n.0).collect(),
            t1: p.t1,
            crank_deg: p.crank_deg.map(|list| list.iter().map(|n| n.0).collect()),
            printed_sum_sq: not_negative(path("printed_sum_sq"), p.printed_sum_sq.map(|n| n.0))?,
            recomputed_sum_sq: not_negative(path("recomputed_sum_sq"), p.recomputed_sum_sq.map(|n| n.0))?,
            note: p.note,
        });
    }
    let exact = raw.exact.map(|OnlyTable(e)| {
        let count = |given: Option<Count>| given.map(|Count(n)| n as usize);
        ExpectedCensus {
            classes: count(e.classes),
            real: count(e.real),
            one_circuit: count(e.one_circuit),
            in_order: count(e.in_order),
            free_of_defects: count(e.free_of_defects),
        }
    });
    Ok(Expect { best_known_sum_sq: best, goal_sum_sq: goal, exact, published })
}
