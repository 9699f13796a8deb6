//! The body of a motion and the angles of a function in a tab's edit, as keys of a problem file.

use super::asked::same;
use super::messages::is_default;
use crate::task::spec::{FormulaSpec, TaskSpec};
use crate::task::{AngleOffset, Sense, corners};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// The body of a motion. Angles in degrees from the x axis, counter-clockwise positive.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyAsk {
    /// The angle of the body at each point; null where only the place counts.
    pub angle_deg: Vec<Option<f64>>,
    /// A length: an angle error of one radian counts like an error of the place of this length; absent: the size of the
    /// points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_weight: Option<f64>,
    /// The largest error of the angle accepted at any point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance_deg: Option<f64>,
    /// The largest error of the angle accepted at each point, in place of `tolerance_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerances_deg: Option<Vec<f64>>,
    /// The outline of the body in its own frame: lines that are drawn with it, not read.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outline: Vec<Vec<[f64; 2]>>,
}

/// The angles of a function.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FunctionAsk {
    /// The reference of input angles: free, or the ground line.
    #[serde(default, skip_serializing_if = "is_default")]
    pub input_offset: AngleOffset,
    /// The reference of output angles, likewise.
    #[serde(default, skip_serializing_if = "is_default")]
    pub output_offset: AngleOffset,
    /// The sense in which output angles count.
    #[serde(default, skip_serializing_if = "is_default")]
    pub sense: Sense,
    /// The largest error of the output accepted at any pair, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance_deg: Option<f64>,
    /// The largest error of the output accepted at each pair, degrees, in place of `tolerance_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerances_deg: Option<Vec<f64>>,
    /// The formula that gave the pairs; not read if it no longer gives them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<FormulaSpec>,
}

/// Returns a list of numbers as a value of TOML.
fn numbers(list: impl IntoIterator<Item = f64>) -> Value {
    Value::Array(list.into_iter().map(Value::Float).collect())
}

/// Returns the tolerances of angles as a value of TOML.
fn tolerances(one: Option<f64>, each: Option<&Vec<f64>>) -> Option<(String, Value)> {
    let value = each.map(|list| numbers(list.iter().copied())).or(one.map(Value::Float))?;
    Some(("tolerance_deg".into(), value))
}

/// Returns the diagonal of the points' box.
fn size(points: &[[f64; 2]]) -> f64 {
    let (low, high) = corners(points);
    (high[0] - low[0]).hypot(high[1] - low[1])
}

impl BodyAsk {
    /// Returns the keys of `[task.motion]` for a body at these points.
    pub(super) fn keys(&self, points: &[[f64; 2]]) -> Table {
        let pose = |([x, y], angle): (&[f64; 2], &Option<f64>)| numbers([*x, *y].into_iter().chain(*angle));
        let poses = Value::Array(points.iter().zip(&self.angle_deg).map(pose).collect());
        let mut keys = Table::from_iter([("poses".to_owned(), poses)]);
        keys.extend(self.angle_weight.map(|weight| ("angle_weight".to_owned(), Value::Float(weight))));
        keys.extend(tolerances(self.tolerance_deg, self.tolerances_deg.as_ref()));
        keys
    }

    /// Returns the body of a motion; `None` of another task.
    pub(super) fn of(task: &TaskSpec) -> Option<BodyAsk> {
        let body = task.body.as_ref().filter(|_| task.is_motion())?;
        let tolerance_deg = same(body.tolerance_deg.as_deref());
        Some(BodyAsk {
            angle_deg: body.angle_deg.clone(),
            angle_weight: Some(body.angle_weight).filter(|weight| *weight != size(&task.points)),
            tolerance_deg,
            tolerances_deg: body.tolerance_deg.clone().filter(|_| tolerance_deg.is_none()),
            outline: Vec::new(),
        })
    }
}

/// The digits to which a range of angles is written.
const DIGITS: i32 = 11;

/// Returns a number without the rounding errors of its last digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS as usize).parse().unwrap_or(value)
}

impl FunctionAsk {
    /// Returns the keys of `[task.function]` that are the same for pairs and for a formula.
    fn common(&self) -> Table {
        let mut keys = Table::new();
        let mut word = |key: &str, value: Result<Value, toml::ser::Error>| {
            keys.extend(value.ok().map(|value| (key.to_owned(), value)));
        };
        word("input_offset", Value::try_from(self.input_offset));
        word("output_offset", Value::try_from(self.output_offset));
        word("sense", Value::try_from(self.sense));
        keys.extend(tolerances(self.tolerance_deg, self.tolerances_deg.as_ref()));
        keys
    }

    /// Returns the keys of `[task.function]` for these pairs.
    pub(super) fn keys(&self, pairs: &[[f64; 2]]) -> Table {
        let mut keys = self.common();
        for (axis, key) in ["input_deg", "output_deg"].into_iter().enumerate() {
            keys.insert(key.into(), numbers(pairs.iter().map(|pair| pair[axis])));
        }
        keys
    }

    /// Returns the keys of `[task.function]` for its formula over ranges that the pairs may have, one for each sign of the
    /// output's range; `None` without a formula.
    pub(super) fn by_formula(&self, pairs: &[[f64; 2]]) -> Option<Vec<Table>> {
        let formula = self.of.as_ref()?;
        let (low, high) = corners(pairs);
        let input = rounded(pairs.last()?[0]);
        let samples = i64::try_from(pairs.len()).ok()?;
        let with = |output: f64| {
            let mut keys = self.common();
            keys.insert("of".into(), Value::String(formula.formula.clone()));
            keys.insert("over".into(), numbers(formula.over));
            keys.insert("input_range_deg".into(), Value::Float(input));
            keys.insert("output_range_deg".into(), Value::Float(output));
            keys.insert("samples".into(), Value::Integer(samples));
            keys
        };
        let output = rounded(high[1] - low[1]);
        Some(vec![with(output), with(-output)])
    }

    /// Returns the angles of a function; `None` of another task.
    pub(super) fn of(task: &TaskSpec) -> Option<FunctionAsk> {
        let (output, body) = (task.output.as_ref()?, task.body.as_ref()?);
        let tolerance_deg = same(body.tolerance_deg.as_deref());
        Some(FunctionAsk {
            input_offset: task.timing.as_ref().map_or(AngleOffset::Free, |timing| timing.offset),
            output_offset: output.offset,
            sense: output.sense,
            tolerance_deg,
            tolerances_deg: body.tolerance_deg.clone().filter(|_| tolerance_deg.is_none()),
            of: output.of.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::messages::Ask;
    use super::*;
    use crate::files::problem_file::parse;

    #[test]
    fn poses_and_places_become_a_motion_and_come_back() {
        let ask: Ask = serde_json::from_str(
            r#"{"points":[[0,0],[3,4],[6,4]],"body":{"angle_deg":[10,null,-20.5],"tolerance_deg":1,"outline":[[[0,0],[1,2]]]}}"#,
        )
        .expect("an edit");
        let (problem, text) = ask.problem_with_text().expect("a problem");
        assert!(text.contains("[task.motion]") && text.contains("[0, 0, 10],\n    [3, 4],\n"), "{text}");
        let body = problem.spec.task.body.as_ref().expect("a body");
        assert_eq!(body.angle_weight, 6f64.hypot(4.0));
        assert_eq!((body.angle_deg[1], body.tolerance_deg.as_deref()), (None, Some([1.0; 3].as_slice())));
        let again = Ask::of(&problem).expect("it fits").body.expect("a body");
        let given = ask.body.clone().expect("a body");
        assert_eq!(again, BodyAsk { outline: Vec::new(), ..given });
        let mut short = ask;
        short.body.as_mut().expect("a body").angle_deg.pop();
        assert!(short.problem().expect_err("two angles").to_string().contains("3 poses have 2 angles"));
        short.function = Some(FunctionAsk::default());
        assert!(short.problem().expect_err("two kinds").to_string().contains("not both"));
    }

    #[test]
    fn a_formula_is_written_as_long_as_it_gives_the_pairs() {
        for (of, output) in [("log10(x)", 90.0), ("1/x", -47.3)] {
            let text = format!(
                "format = 1\n[task.function]\nof = \"{of}\"\nover = [1, 2]\ninput_range_deg = 61.7\n\
                 output_range_deg = {output}\nsamples = 13\nsense = \"same\"\ntolerance_deg = 0.5\n"
            );
            let problem = parse("f", &text, None, &[]).expect("a problem");
            let mut ask = Ask::of(&problem).expect("it fits");
            assert_eq!(ask.points.len(), 13);
            let (again, text) = ask.problem_with_text().expect("a problem");
            assert!(text.contains(of) && again.spec == problem.spec, "{text}");
            ask.points[3][1] += 0.25;
            let (moved, text) = ask.problem_with_text().expect("a problem");
            assert!(text.contains("input_deg") && !text.contains(of), "{text}");
            assert_eq!(moved.spec.task.pairs(), ask.points);
        }
    }
}
