//! Reads the ranges of a function: a number, bounds, or `"free"`.

use super::raw::RawFunction;
use crate::files::diagnostic::Checked;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{Bounds, Number};
use crate::task::ranges::{FREE_RANGE_DEG, GREATEST_RANGE_DEG, RangesSpec};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, IntoDeserializer, SeqAccess, Visitor};
use std::fmt;

/// A range: as written, or free within bounds, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RangeNumbers {
    /// A number of degrees.
    Given(f64),
    /// Any within bounds.
    Free([f64; 2]),
}

impl RangeNumbers {
    /// Returns the bounds, if the range is free.
    fn bounds(self) -> Option<[f64; 2]> {
        match self {
            RangeNumbers::Given(_) => None,
            RangeNumbers::Free(bounds) => Some(bounds),
        }
    }
}

impl<'de> Deserialize<'de> for RangeNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct RangeVisitor;
        /// Reads a number with the checks of every number.
        fn number<E: de::Error>(value: f64) -> Result<RangeNumbers, E> {
            Number::deserialize(value.into_deserializer()).map(|number| RangeNumbers::Given(number.0))
        }
        impl<'de> Visitor<'de> for RangeVisitor {
            type Value = RangeNumbers;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an angle in degrees, \"free\", or bounds [least, greatest]")
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<RangeNumbers, E> {
                number(value)
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<RangeNumbers, E> {
                number(value as f64)
            }
            fn visit_u64<E: de::Error>(self, value: u64) -> Result<RangeNumbers, E> {
                number(value as f64)
            }
            fn visit_str<E: de::Error>(self, word: &str) -> Result<RangeNumbers, E> {
                if word == "free" {
                    return Ok(RangeNumbers::Free(FREE_RANGE_DEG));
                }
                Err(E::invalid_value(de::Unexpected::Str(word), &self))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<RangeNumbers, A::Error> {
                let Bounds(limits) = Bounds::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(RangeNumbers::Free([limits.0, limits.1]))
            }
        }
        deserializer.deserialize_any(RangeVisitor)
    }
}

impl schemars::JsonSchema for RangeNumbers {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "RangeNumbers".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [
            {"type": "number"},
            {"const": "free"},
            {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
        ]})
    }
}

/// Returns the ranges of a function that are free, their bounds checked.
pub(super) fn free_ranges(toml: &TomlText<'_>, function: &RawFunction) -> Checked<RangesSpec> {
    let given = [
        ("input_range_deg", function.input_range_deg, "crank", GREATEST_RANGE_DEG[0]),
        ("output_range_deg", function.output_range_deg, "follower", GREATEST_RANGE_DEG[1]),
    ];
    for (name, range, link, greatest) in given {
        let Some([low, high]) = range.and_then(RangeNumbers::bounds) else { continue };
        let key = format!("task.function.{name}");
        if !(low > 0.0 && high <= greatest) {
            let message = format!(
                "{name} = [{low}, {high}]: a free range of the {link} lies between 0 and {greatest} degrees"
            );
            let help = "write [least, greatest] with a least range that is worth having, such as [30, 180]; short ranges fit any function";
            return toml.refuse(&key, message, help);
        }
        if low == high {
            let message = format!("{name} = [{low}, {high}]: the range is not free");
            return toml.refuse(&key, message, format!("write {name} = {low}"));
        }
    }
    let bounds = |range: Option<RangeNumbers>| range.and_then(RangeNumbers::bounds);
    Ok(RangesSpec {
        input_range_deg: bounds(function.input_range_deg),
        output_range_deg: bounds(function.output_range_deg),
    })
}
