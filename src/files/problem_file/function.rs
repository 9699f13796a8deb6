//! Reads `[task.function]`: the pairs from their source or of a formula, with weights and tolerances.

use super::lists::Lists;
use super::path::{TaskRead, task_read};
use super::ranges::{RangeNumbers, free_ranges};
use super::raw::RawFunction;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::{Checked, quoted};
use crate::files::points_file::MAX_POINTS;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{Number, numbers};
use crate::task::ranges::{RangesSpec, WRITTEN_RANGE_DEG};
use crate::task::spec::{BodySpec, DEGREES, FormulaSpec, OutputSpec, TaskSpec, TimingSpec};
use crate::task::{AngleOffset, Output, Sense};
use exmex::prelude::*;

/// The number of pairs taken of a formula where the file is silent.
const SAMPLES: u64 = 61;
/// The most characters of a formula.
const LONGEST_FORMULA: usize = 1000;
/// The largest angle that may be written, degrees: a hundred turns.
const MOST_DEG: f64 = 36_000.0;

/// Returns the function with its lists, and the task that it is; without pairs they are the ends of a stroke with its time
/// ratio. A tolerance that is set on the command line takes the place
/// of the column of a file of pairs.
pub(super) fn function_of(
    toml: &TomlText<'_>,
    function: &RawFunction,
    (whereabouts, ends): (&Whereabouts<'_>, Option<[f64; 2]>),
    is_set: impl Fn(&str) -> bool,
) -> Checked<TaskRead> {
    for (key, offset) in [("input_offset", function.input_offset), ("output_offset", function.output_offset)]
    {
        if offset == AngleOffset::Fixed {
            let message = format!("{key} = \"fixed\": angles of a function do not count from the x axis");
            let help = "write \"free\", or \"ground\" to count from the line A to B";
            return toml.refuse(&format!("task.function.{key}"), message, help);
        }
    }
    let ranges = free_ranges(toml, function)?;
    if let (Some(_), Some(_)) = (&function.output_deg, &function.output) {
        let message = "the outputs are given as angles (output_deg) and as places (output)";
        return toml.refuse("task.function.output", message, "keep one of the two");
    }
    let mut target = Target::of_function(toml, function, whereabouts, ends)?;
    if target.of_places {
        of_places(toml, function, ranges)?
    } else {
        of_angles(toml, function)?
    }
    for (j, pair) in target.points.iter().enumerate() {
        if let Some(angle) =
            pair.iter().take(if target.of_places { 1 } else { 2 }).find(|angle| angle.abs() > MOST_DEG)
        {
            let message = format!("pair {}: {angle} degrees is more than a hundred turns", j + 1);
            let help = "write the angles in degrees, as far as crank and follower turn";
            let is_input = pair[0].abs() > MOST_DEG && function.input_deg.is_some();
            let at = if is_input {
                toml.at(&format!("task.function.input_deg.{j}"), message)
            } else {
                target.at_point(toml, j, message)
            };
            return Err(Box::new(at.with_help(help)));
        }
    }
    let (key, words, given) = match target.of_places {
        true => ("tolerance", ["tolerance of the output", "an error"], &function.tolerance),
        false => ("tolerance_deg", ["tolerance of the output", "an angle's error"], &function.tolerance_deg),
    };
    let mut columns = [None, None];
    if let Source::Csv(csv) = &mut target.source {
        let tolerance = if csv.of_places { &mut csv.tolerance } else { &mut csv.tolerance_deg };
        columns = [&mut csv.weight, tolerance].map(Option::take);
    }
    let [weight, tolerance] = columns;
    let tolerance = tolerance.filter(|_| !is_set(&format!("task.function.{key}")));
    let lists = Lists { toml, target: &target, file: function.file.as_deref() };
    let tolerance_deg = lists.tolerances(key, words, given.as_ref(), tolerance)?;
    let weight = lists.weights(function.weight.as_deref().map(numbers), weight)?;
    let output = if target.of_places { Output::Place } else { Output::Angle };
    let (crank_deg, angle_deg) =
        std::mem::take(&mut target.points).into_iter().map(|[input, output]| (input, Some(output))).unzip();
    let of =
        function.of.clone().zip(function.over).map(|(formula, over)| FormulaSpec { formula, over: over.0 });
    let spec = TaskSpec {
        weight,
        timing: Some(TimingSpec { crank_deg, offset: function.input_offset, free: Vec::new() }),
        body: Some(BodySpec { angle_deg, angle_weight: DEGREES, tolerance_deg }),
        output: Some(OutputSpec {
            output,
            offset: function.output_offset,
            sense: function.sense,
            ranges,
            of,
        }),
        ..TaskSpec::default()
    };
    task_read(toml, target, spec)
}

/// Returns the key and the numbers of the outputs that a problem file gives itself.
pub(super) fn outputs(function: &RawFunction) -> Option<(&'static str, &Vec<Number>)> {
    let of_angles = function.output_deg.as_ref().map(|outputs| ("output_deg", outputs));
    of_angles.or(function.output.as_ref().map(|outputs| ("output", outputs)))
}

/// Refuses keys that are about angles where the outputs are places of a slider.
fn of_places(toml: &TomlText<'_>, function: &RawFunction, ranges: RangesSpec) -> Checked<()> {
    let refuse = |key: &str, message: String, help: &str| {
        toml.refuse_key(&format!("task.function.{key}"), message, help)
    };
    if function.sense != Sense::Any {
        let message = "sense is about the follower's turning, and the outputs are places of a slider";
        return refuse("sense", message.into(), "remove it: the signs of the outputs say which way it moves");
    }
    if function.tolerance_deg.is_some() {
        let message = "the outputs are places of a slider, whose errors are lengths";
        return refuse("tolerance_deg", message.into(), "write tolerance");
    }
    if ranges.output_range_deg.is_some() || function.output_range_deg.is_some() {
        let message = "output_range_deg is about angles, and the outputs are places of a slider";
        let help = "write output_range, a length: a free one would be met by a linkage of any size";
        return refuse("output_range_deg", message.into(), help);
    }
    Ok(())
}

/// Refuses keys that are about places of a slider where the outputs are angles.
fn of_angles(toml: &TomlText<'_>, function: &RawFunction) -> Checked<()> {
    if function.tolerance.is_none() {
        return Ok(());
    }
    let message = "the outputs are angles, whose errors are in degrees";
    toml.refuse_key("task.function.tolerance", message, "write tolerance_deg")
}

/// Returns the pairs of a formula y = f(x), evenly in x: the input turns in proportion to x, the output to y.
pub(super) fn of_formula(toml: &TomlText<'_>, function: &RawFunction) -> Checked<Vec<[f64; 2]>> {
    let key = |key: &str| format!("task.function.{key}");
    let refuse = |at: &str, message: String, help: &str| toml.refuse(&key(at), message, help);
    let formula = function.of.as_deref().unwrap_or_default();
    let Some(over) = function.over.map(|over| over.0) else {
        let help = "add over = [first x, last x]";
        return refuse("of", "the formula has no range".into(), help);
    };
    if over[0] == over[1] {
        let message = format!("over = [{0}, {0}]: the range is empty", over[0]);
        return refuse("over", message, "write the first and the last x of the formula");
    }
    let range = |name: &str, given: Option<RangeNumbers>, link: &str| match given {
        None => {
            let help = format!("add {name} = how far the {link} turns, degrees, or {name} = \"free\"");
            toml.refuse_key("task.function", format!("{name} is missing"), help)
        }
        Some(RangeNumbers::Given(range)) if range == 0.0 || range.abs() > MOST_DEG => {
            let message = format!("{name} = {range}: the {link} turns by no such angle");
            toml.refuse(&key(name), message, "write degrees, such as 60 or 90")
        }
        Some(RangeNumbers::Given(range)) => Ok(range),
        // Only the proportions of the pairs count.
        Some(RangeNumbers::Free(_)) => Ok(WRITTEN_RANGE_DEG),
    };
    let input = range("input_range_deg", function.input_range_deg, "crank")?;
    let output = match function.output_range {
        None => range("output_range_deg", function.output_range_deg, "follower")?,
        Some(Number(0.0)) => {
            let help = "write how far the slider moves, a length";
            return refuse("output_range", "output_range = 0: the slider would stand still".into(), help);
        }
        Some(Number(length)) => length,
    };
    let samples = function.samples.as_ref().map_or(SAMPLES, |count| count.0);
    if !(2..=MAX_POINTS as u64).contains(&samples) {
        let message = format!("samples = {samples} is not between 2 and {MAX_POINTS}");
        return refuse("samples", message, "61 are usual");
    }
    let help =
        "write a formula in x such as x^1.5, log10(x) or sin(x*PI/180); angles of sin and cos are in radians";
    if formula.chars().count() > LONGEST_FORMULA {
        let message = format!("the formula is longer than {LONGEST_FORMULA} characters");
        return refuse("of", message, help);
    }
    let read = match exmex::parse::<f64>(formula) {
        Ok(read) => read,
        Err(_) => return refuse("of", format!("{} cannot be read as a formula", quoted(formula)), help),
    };
    if let Some(other) = read.var_names().iter().find(|name| *name != "x") {
        let message = format!("{} has the unknown name {}", quoted(formula), quoted(other));
        return refuse("of", message, help);
    }
    if read.var_names().is_empty() {
        let message = format!("{} is constant: it has no x", quoted(formula));
        return refuse("of", message, help);
    }
    let last = (samples - 1) as f64;
    let mut values = Vec::with_capacity(samples as usize);
    for k in 0..samples {
        let x = over[0] + (over[1] - over[0]) * k as f64 / last;
        match read.eval(&[x]) {
            Ok(y) if y.is_finite() => values.push(y),
            Ok(y) => {
                let message = format!("{} is {y} at x = {x}", quoted(formula));
                return refuse("of", message, "choose a range (over) in which the formula has finite values");
            }
            Err(_) => {
                return refuse("of", format!("{} has no value at x = {x}", quoted(formula)), help);
            }
        }
    }
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(*y), high.max(*y)));
    let height = high - low;
    if !(height > 0.0 && height.is_finite()) {
        let message = format!("{} is {low} all over its range", quoted(formula));
        return refuse("of", message, "a follower that stands still needs no linkage");
    }
    let first = values[0];
    let pair = |(k, y): (usize, &f64)| [input * k as f64 / last, output * ((y - first) / height)];
    Ok(values.iter().enumerate().map(pair).collect())
}
