//! The tables of a problem file with the keys that an edit has for them, and values as they are typed there.

use crate::task::TaskKind;
use std::fmt::{self, Display};

/// A table of a problem file, and its keys as an edit has them: a key of a table within the edit is written without that
/// table's name.
pub(super) type TableKeys = (&'static str, &'static [&'static str]);

/// The tables before the task and after it, in the order in which they are written.
pub(super) const HEAD: TableKeys = ("", &["name", "source", "unit"]);
pub(super) const ASKED: [TableKeys; 3] = [
    ("design", &["mechanism"]),
    (
        "require",
        &[
            "type",
            "input",
            "stroke",
            "time_ratio",
            "transmission_deg_min",
            "link_ratio_max",
            "pivots_in",
            "footprint_in",
            "transmission_over",
            "order",
            "direction",
            "circuit",
            "branch",
            "closing",
        ],
    ),
    ("solve", &["seed", "method", "objective"]),
];

/// Returns the tables of a task and its timing.
pub(super) const fn tables_of(kind: TaskKind) -> [TableKeys; 2] {
    const TIMING: &[&str] = &["timing.crank_deg", "timing.offset"];
    match kind {
        TaskKind::Path => [
            ("task.path", &["points", "closed", "raw.smooth", "raw.samples", "tolerance", "weight"]),
            ("task.path.timing", TIMING),
        ],
        TaskKind::Motion => [
            ("task.motion", &["poses", "closed", "angle_weight", "tolerance", "tolerance_deg", "weight"]),
            ("task.motion.timing", TIMING),
        ],
        TaskKind::Function => [
            (
                "task.function",
                &[
                    "of",
                    "over",
                    "input_range_deg",
                    "output_range_deg",
                    "samples",
                    "input_deg",
                    "output_deg",
                    "input_offset",
                    "output_offset",
                    "sense",
                    "tolerance_deg",
                    "weight",
                ],
            ),
            ("task.function.timing", &[]),
        ],
    }
}

/// The keys of an edit that have other names in a problem file.
pub(super) const RENAMED: [(&str, &str); 3] =
    [("tolerances", "tolerance"), ("weights", "weight"), ("types", "type")];

/// Writes a value as it is typed in problem files, points one a line.
pub(super) struct Typed<'a>(pub(super) &'a toml::Value);

impl Display for Typed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            // Long whole numbers are integers to TOML, and do not fit.
            toml::Value::Float(number) if *number != 0.0 && !(1e-6..1e15).contains(&number.abs()) => {
                write!(f, "{number:e}")
            }
            toml::Value::Float(number) => write!(f, "{number}"),
            toml::Value::Array(list) if list.iter().any(toml::Value::is_array) => {
                let lines: String = list.iter().map(|item| format!("    {},\n", Typed(item))).collect();
                write!(f, "[\n{lines}]")
            }
            toml::Value::Array(list) => {
                let items: Vec<String> = list.iter().map(|item| Typed(item).to_string()).collect();
                write!(f, "[{}]", items.join(", "))
            }
            other => write!(f, "{other}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_size_come_back() {
        for value in [0.0, -0.0, 1.5, 1e-7, -3e11, 1e12 / 3.0, 5e-324, 123_456_789.125] {
            let text = format!("x = {}", Typed(&value.into()));
            let table: toml::Table = text.parse().expect("TOML");
            let again = table["x"].as_float().or_else(|| table["x"].as_integer().map(|i| i as f64));
            assert_eq!(again, Some(value), "{text}");
        }
    }
}
