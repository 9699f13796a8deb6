//! Limits of requirements as numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The unit of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LimitUnit {
    /// The file's unit of length.
    Length,
    /// A degree.
    Degree,
    /// One more of longest over shortest.
    Ratio,
    /// A newton metre.
    Torque,
}

impl LimitUnit {
    /// Returns a size of which values in this unit are small parts, for a target of the given size.
    pub fn whole(self, size: f64) -> f64 {
        match self {
            LimitUnit::Length => size,
            LimitUnit::Degree => 180.0,
            LimitUnit::Ratio | LimitUnit::Torque => 1.0,
        }
    }
}

/// A limit, and the side on which it is loosened: +1 above it, -1 below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The value of the limit.
    pub value: f64,
    /// The direction in which it is loosened, +1 or -1.
    pub outward: f64,
}

impl Limit {
    /// Returns the only limit of a requirement, a greatest value.
    pub(super) fn most(value: Option<f64>) -> Option<Vec<Limit>> {
        Some(vec![Limit { value: value?, outward: 1.0 }])
    }

    /// Returns the only limit of a requirement, a least value.
    pub(super) fn least(value: Option<f64>) -> Option<Vec<Limit>> {
        Some(vec![Limit { value: value?, outward: -1.0 }])
    }
}

/// Returns the scale of the rounding of extremes of a motion: they are found by search, to the square root of the
/// rounding.
pub(super) fn rounding_of_extremes(_: Option<f64>, size: f64) -> f64 {
    1e4 * size
}
