//! Sweep files: TOML with a problem and the keys of it that vary.
//!
//! ```toml
//! format = 1
//! problem = "arm.toml"
//!
//! [vary]
//! require.transmission_deg_min = { from = 20, to = 50, steps = 7 }
//! solve.seed = [1, 2, 3]
//! ```

use crate::files::diagnostic::{Checked, quoted};
use crate::files::input_text;
use crate::files::linkage_file::{check_format, checked_name};
use crate::files::name;
use crate::files::problem_file::{Template, check_value};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::Count;
use crate::record::sweep::{MAX_JOBS, Plan, Range, Values, Varied};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The version of the sweep file format that this program reads.
pub const FORMAT: u64 = 1;
/// The most values of a list.
const MAX_LIST: usize = 100_000;

/// A linkwright sweep file.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SweepFile")]
pub(crate) struct RawSweep {
    /// The format of the file: 1.
    #[schemars(required)]
    pub format: Option<Count>,
    /// 1 to 64 letters, digits, blanks and `- _ .`, not starting with a dot; where silent, the name of the file.
    pub name: Option<String>,
    /// The problem file (or points or drawing), named from this file's folder.
    #[schemars(required)]
    pub problem: Option<String>,
    /// The keys of the problem that vary, each with its values; a job for each combination, the last key fastest.
    #[schemars(required, with = "BTreeMap<String, RawVaried>")]
    pub vary: Option<toml::Value>,
}

/// The values of a key, or the keys of a table of the problem.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Varied")]
#[expect(dead_code, reason = "the schema alone is made from it")]
enum RawVaried {
    /// Each of these values.
    List(Vec<serde_json::Value>),
    /// Evenly spaced numbers, both ends included; whole ones where the key is whole.
    Range(Range),
    /// The keys of a table, such as `[vary.solve]`.
    Table(BTreeMap<String, RawVaried>),
}

/// A sweep as its file states it, checked.
#[derive(Clone, Debug)]
pub struct SweepFile {
    /// The name; the file stem if the file states none.
    pub name: String,
    /// The place of the problem.
    pub problem: PathBuf,
    /// The problem.
    pub(crate) template: Template,
    /// The varied keys in the order of the file.
    pub vary: Vec<Varied>,
    /// The number of jobs.
    pub jobs: u64,
    /// The text of the file, for diagnostics.
    pub text: String,
}

/// Returns whether a file has the table that only a sweep file has. An unreadable file is none.
pub fn is_sweep(path: &Path) -> bool {
    // A pipe can be read only once.
    let text = if path.is_file() { input_text::read(path).unwrap_or_default() } else { String::new() };
    text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("vary") && !table.contains_key("task"))
}

/// Reads a sweep file and the problem that it names.
///
/// # Errors
/// A [`Diagnostic`](crate::files::diagnostic::Diagnostic) that points at the fault, in either file.
pub fn load(path: &Path) -> Checked<SweepFile> {
    let text = input_text::read(path)?;
    let shown = path.display().to_string();
    let toml = TomlText { file: &shown, text: &text };
    if text.trim().is_empty() {
        let help = "write format = 1, problem = \"my-path.toml\" and a table [vary] with keys of the problem";
        return toml.refuse_file("the file is empty", help);
    }
    let raw: RawSweep = toml.read()?;
    check_format(&toml, raw.format, FORMAT)?;
    let name = match raw.name {
        None => name::from_file(&shown, "sweep"),
        given => checked_name(&toml, given, "sweep")?,
    };
    let Some(problem) = raw.problem else {
        let help = "add problem = \"my-path.toml\", named from the folder of this file";
        return toml.refuse_file("the sweep names no problem", help);
    };
    let problem = path.parent().unwrap_or(Path::new("")).join(problem);
    if !problem.exists() {
        let message = format!("there is no problem file {}", problem.display());
        return toml.refuse("problem", message, "it is looked for from the folder of this file");
    }
    let mut template = Template::load(&problem)?;
    let Some(table) = raw.vary else {
        let help = "add a table [vary], for example with solve.seed = [1, 2, 3]";
        return toml.refuse_file("nothing varies in this sweep", help);
    };
    let vary = varied(&toml, &table)?;
    if vary.is_empty() {
        let help = "add a key of the problem with its values, for example solve.seed = [1, 2, 3]";
        return toml.refuse_key("vary", "nothing varies in this sweep", help);
    }
    for (varied, place) in &vary {
        check(&toml, &mut template, &problem, varied, place)?;
    }
    let vary: Vec<Varied> = vary.into_iter().map(|(varied, _)| varied).collect();
    let Some(jobs) = Plan::product(&vary) else {
        let counts: Vec<String> = vary.iter().map(|varied| varied.values.count().to_string()).collect();
        let message = format!("{} are more than {MAX_JOBS} jobs", counts.join(" x "));
        return toml.refuse_key("vary", message, "vary fewer keys, or with fewer values");
    };
    Ok(SweepFile { name, problem, template, vary, jobs, text })
}

/// Returns the varied keys in the order in which they are written, each with its path in the text.
fn varied(toml: &TomlText<'_>, table: &toml::Value) -> Checked<Vec<(Varied, Vec<String>)>> {
    let mut found: Vec<(usize, Varied, Vec<String>)> = Vec::new();
    let mut open = vec![(vec!["vary".to_owned()], table)];
    while let Some((path, value)) = open.pop() {
        let values = match value {
            toml::Value::Table(table) if path.len() == 1 || !is_range(table) => {
                if table.is_empty() && path.len() > 1 {
                    let message = format!("{} has no values", path[1..].join("."));
                    return Err(Box::new(toml.at_path(&path, message).with_help(FORMS)));
                }
                open.extend(
                    table
                        .iter()
                        .map(|(key, inner)| ([path.as_slice(), std::slice::from_ref(key)].concat(), inner)),
                );
                continue;
            }
            toml::Value::Table(table) => Values::Range(range(toml, &path, table)?),
            toml::Value::Array(list) => list_of(toml, &path, list)?,
            _ if path.len() == 1 => {
                return toml.refuse(
                    "vary",
                    "[vary] is a table",
                    "write [vary] with a key on each line below it",
                );
            }
            _ => {
                let message = format!("{} has one value, so that it does not vary", path[1..].join("."));
                return Err(Box::new(toml.at_path(&path, message).with_help(FORMS)));
            }
        };
        let start = toml.span_of(&path).map_or(usize::MAX, |(key, _)| key.start);
        found.push((start, Varied { key: path[1..].join("."), values }, path));
    }
    found.sort_by_key(|(start, ..)| *start);
    if let Some(i) =
        (1..found.len()).find(|&i| found[..i].iter().any(|(_, earlier, _)| earlier.key == found[i].1.key))
    {
        let (_, Varied { key, .. }, path) = &found[i];
        let diagnostic = toml.at_path(path, format!("{key} varies twice"));
        return Err(Box::new(diagnostic.with_help("put all its values into one list")));
    }
    Ok(found.into_iter().map(|(_, varied, path)| (varied, path)).collect())
}

/// The two forms of values.
const FORMS: &str = "write a list such as [1, 2, 3], or { from = 20, to = 50, steps = 7 }";

/// The remedy for a range with a value that the key does not take.
const RANGE_REMEDY: &str = "choose the ends and the steps so that the key takes every value, or write a list";

/// Returns whether a table is a range and not a table of the problem.
fn is_range(table: &toml::Table) -> bool {
    ["from", "to", "steps"].iter().any(|key| table.contains_key(*key))
}

fn range(toml: &TomlText<'_>, path: &[String], table: &toml::Table) -> Checked<Range> {
    let refuse = |message: String| Err(Box::new(toml.at_path(path, message).with_help(FORMS)));
    if let Some(stranger) = table.keys().find(|key| !["from", "to", "steps"].contains(&key.as_str())) {
        return refuse(format!("unknown key {} in a range", quoted(stranger)));
    }
    let number = |key: &str| match table.get(key) {
        Some(toml::Value::Integer(number)) => Ok(*number as f64),
        Some(toml::Value::Float(number)) if number.is_finite() => Ok(*number),
        Some(_) => Err(format!("{key} is no number")),
        None => Err(format!("the range has no {key}")),
    };
    let read = || Ok((number("from")?, number("to")?, number("steps")?));
    let (from, to, steps): (f64, f64, f64) = match read() {
        Ok(read) => read,
        Err(message) => return refuse(message),
    };
    if !(2.0..=MAX_JOBS as f64).contains(&steps) || steps.fract() != 0.0 {
        return refuse(format!("steps = {steps} is not a whole number from 2 to {MAX_JOBS}"));
    }
    if from == to {
        return refuse(format!("the range goes from {from} to {to}: all its values are equal"));
    }
    Ok(Range { from, to, steps: steps as u64 })
}

fn list_of(toml: &TomlText<'_>, path: &[String], list: &[toml::Value]) -> Checked<Values> {
    if list.is_empty() || list.len() > MAX_LIST {
        let message = match list.len() {
            0 => "the list of values is empty".to_owned(),
            many => format!("the list has {many} values, at most {MAX_LIST} are read"),
        };
        return Err(Box::new(toml.at_path(path, message).with_help(FORMS)));
    }
    let mut values = Vec::with_capacity(list.len());
    for (i, value) in list.iter().enumerate() {
        let place = [path, &[i.to_string()]].concat();
        let Some(data) = data_of(value) else {
            let message = format!("{value} is no value of a problem file");
            return Err(Box::new(
                toml.at_path(&place, message)
                    .with_help("write finite numbers, texts in quotes, true or false, or lists of these"),
            ));
        };
        values.push(data);
    }
    Ok(Values::List(values))
}

/// Returns a value as data; `None` for what no problem file has: dates, and numbers that are not finite.
fn data_of(value: &toml::Value) -> Option<serde_json::Value> {
    use serde_json::Value;
    Some(match value {
        toml::Value::String(text) => Value::from(text.as_str()),
        toml::Value::Integer(number) => Value::from(*number),
        toml::Value::Float(number) if number.is_finite() => Value::from(*number),
        toml::Value::Boolean(truth) => Value::from(*truth),
        toml::Value::Array(list) => Value::Array(list.iter().map(data_of).collect::<Option<_>>()?),
        toml::Value::Table(table) => {
            let pairs = table.iter().map(|(key, value)| Some((key.clone(), data_of(value)?)));
            Value::Object(pairs.collect::<Option<_>>()?)
        }
        toml::Value::Float(_) | toml::Value::Datetime(_) => return None,
    })
}

/// Returns a value of a plan as it is typed in a TOML file: texts in quotes.
pub fn typed(value: &serde_json::Value) -> String {
    toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string())
}

/// Checks a key with its values against the problem, and reads the files that they name.
fn check(
    toml: &TomlText<'_>,
    template: &mut Template,
    problem: &Path,
    varied: &Varied,
    path: &[String],
) -> Checked<()> {
    let Varied { key, values } = varied;
    let at = |index: Option<u64>| {
        let item = index.map(|i| i.to_string());
        [path, item.as_slice()].concat()
    };
    let tried = match values {
        Values::List(list) => (0..list.len() as u64).map(|i| (i, at(Some(i)))).collect(),
        // A range fails at its ends, or where it is not whole for a whole key.
        Values::Range(range) => {
            let broken = (0..range.steps.min(1000)).find(|&i| range.at(i).fract() != 0.0);
            [Some(0), Some(range.steps - 1), broken]
                .into_iter()
                .flatten()
                .map(|i| (i, at(None)))
                .collect::<Vec<_>>()
        }
    };
    for (index, place) in tried {
        let value = values.at(index);
        if let Err((message, help)) = check_value(&template.problem, key, &typed(&value)) {
            let of_key = message.starts_with("unknown ") || message.contains("clock");
            let message = match values {
                Values::Range(_) if !of_key => {
                    format!("value {} of this range is {value}: {message}", index + 1)
                }
                _ => message,
            };
            let diagnostic =
                if of_key { toml.at_key_path(path, message) } else { toml.at_path(&place, message) };
            let of_range = matches!(values, Values::Range(_)) && !of_key;
            let help = help.or_else(|| of_range.then(|| RANGE_REMEDY.to_owned()));
            return Err(Box::new(match help {
                Some(help) => diagnostic.with_help(help),
                None => diagnostic,
            }));
        }
        if let ("task.path.file" | "task.path.svg" | "task.motion.file" | "task.function.file", Some(file)) =
            (key.as_str(), value.as_str())
        {
            template.add_named(problem, key, file).map_err(|d| {
                let help = d.help.unwrap_or_else(|| "it is looked for beside the problem file".into());
                Box::new(toml.at_path(&place, d.message).with_help(help))
            })?;
        }
    }
    Ok(())
}
