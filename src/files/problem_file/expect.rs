//! The table `[expect]`: what is known of a problem's answer, for tests and the suite.

use crate::files::diagnostic::{Checked, counted};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::plain;
use crate::mechanism::AssemblyMode;
use crate::task::spec::TaskSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The known facts about a problem's answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// The least sum of squared errors that is known.
    #[serde(deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub best_known_sum_sq: Option<f64>,
    /// The sum that a run has to reach to count as a hit; where silent, best_known_sum_sq.
    #[serde(deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub goal_sum_sq: Option<f64>,
    /// The least objective that is known of a motion: squared errors of the places plus angle_weight^2 times squared errors
    /// of the angles in radians.
    #[serde(deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub objective: Option<f64>,
    /// The rms error of the body's angle in that answer, degrees.
    #[serde(deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
    /// The largest error of the body's angle in that answer, degrees.
    #[serde(deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub max_deg: Option<f64>,
    /// The number of linkages through nine points, through poses and points, or through eight points of a linkage with a slider.
    #[serde(deserialize_with = "plain::table", skip_serializing_if = "Option::is_none")]
    pub exact: Option<ExpectedCensus>,
    /// Answers that were published.
    #[serde(deserialize_with = "plain::tables", skip_serializing_if = "Vec::is_empty")]
    pub published: Vec<Published>,
}

/// The number of linkages through nine points, up to cognates, through poses and points, or through eight points of a linkage with a
/// slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExpectedCensus {
    /// Isolated solutions, real and complex.
    #[serde(deserialize_with = "plain::count", skip_serializing_if = "Option::is_none")]
    pub classes: Option<usize>,
    /// Real linkages.
    #[serde(deserialize_with = "plain::count", skip_serializing_if = "Option::is_none")]
    pub real: Option<usize>,
    /// Of these, on one circuit.
    #[serde(deserialize_with = "plain::count", skip_serializing_if = "Option::is_none")]
    pub one_circuit: Option<usize>,
    /// Of these, in the order of the points.
    #[serde(deserialize_with = "plain::count", skip_serializing_if = "Option::is_none")]
    pub in_order: Option<usize>,
    /// Of these, on one branch.
    #[serde(deserialize_with = "plain::count", skip_serializing_if = "Option::is_none")]
    pub free_of_defects: Option<usize>,
}

/// An answer that was published.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// Author and year.
    pub source: String,
    /// r1 ground, r2 crank, r3 coupler, r4 follower, rcx, rcy, x0, y0, theta0 (radians).
    #[serde(default, deserialize_with = "plain::numbers", skip_serializing_if = "Vec::is_empty")]
    pub vector: Vec<f64>,
    /// The side on which it closes: 1: D lies left of the line from C to B; -1: right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<i64>")]
    pub t1: Option<AssemblyMode>,
    /// The crank angles that were published, degrees from the ground line.
    #[serde(default, deserialize_with = "plain::list", skip_serializing_if = "Option::is_none")]
    pub crank_deg: Option<Vec<f64>>,
    /// The error that was printed.
    #[serde(default, deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub printed_sum_sq: Option<f64>,
    /// The error that the vector has when this project evaluates it.
    #[serde(default, deserialize_with = "plain::number", skip_serializing_if = "Option::is_none")]
    pub recomputed_sum_sq: Option<f64>,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// The number of values of a published vector.
const PUBLISHED_VECTOR: usize = 9;

impl Expect {
    /// Returns the least figure that is known of what a search minimises: a motion's objective, a path's sum of squares.
    pub fn best_known(&self) -> Option<f64> {
        self.objective.or(self.best_known_sum_sq)
    }
}

/// Checks the table of a problem with this task.
pub(super) fn check(toml: &TomlText<'_>, expect: &Expect, task: &TaskSpec) -> Checked<()> {
    let points = task.len();
    let of_paths = [("best_known_sum_sq", expect.best_known_sum_sq), ("goal_sum_sq", expect.goal_sum_sq)];
    let of_motions =
        [("objective", expect.objective), ("rms_deg", expect.rms_deg), ("max_deg", expect.max_deg)];
    let (others, kind, help) = match task.body {
        None => (&of_motions[..], "a motion", "for a path write best_known_sum_sq"),
        Some(_) => (&of_paths[..], "a path", "for a motion or a function write objective, rms_deg, max_deg"),
    };
    if let Some((key, _)) = others.iter().find(|(_, value)| value.is_some()) {
        let message = format!("{key} is a figure of {kind}");
        return toml.refuse_key(&format!("expect.{key}"), message, help);
    }
    let not_negative = |path: &str, value: Option<f64>, what: &str| match value {
        Some(v) if v < 0.0 => {
            toml.refuse(path, format!("{v} is negative: {what} is 0 or more"), "write 0 or more")
        }
        _ => Ok(()),
    };
    for (key, value) in of_paths {
        not_negative(&format!("expect.{key}"), value, "a sum of squares")?;
    }
    for ((key, value), what) in of_motions.into_iter().zip(["a sum of squares", "an error", "an error"]) {
        not_negative(&format!("expect.{key}"), value, what)?;
    }
    for (i, entry) in expect.published.iter().enumerate() {
        let path = |key: &str| format!("expect.published.{i}.{key}");
        let numbers = entry.vector.len();
        if numbers != 0 && task.body.is_some() {
            let help = "leave it out, and say in the note what was published";
            return toml.refuse(&path("vector"), "a published vector is an answer of a path", help);
        }
        if numbers != 0 && numbers != PUBLISHED_VECTOR {
            let message = format!("a published vector has {PUBLISHED_VECTOR} numbers, this one {numbers}");
            let help = "[ground, crank, coupler, follower, rcx, rcy, x0, y0, theta0]; or leave it empty";
            return toml.refuse(&path("vector"), message, help);
        }
        if let Some(list) = entry.crank_deg.as_ref().filter(|list| list.len() != points) {
            let message = format!("{} and {}", counted(points, "point"), counted(list.len(), "crank angle"));
            return toml.refuse(&path("crank_deg"), message, "give one crank angle for each point");
        }
        not_negative(&path("printed_sum_sq"), entry.printed_sum_sq, "a sum of squares")?;
        not_negative(&path("recomputed_sum_sq"), entry.recomputed_sum_sq, "a sum of squares")?;
    }
    Ok(())
}
