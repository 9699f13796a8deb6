//! Intervals in which the parameters of a design lie.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An interval [low, high]; a fixed value has low = high.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Limits(pub f64, pub f64);

impl Limits {
    /// Returns whether it fixes a value.
    pub fn is_fixed(&self) -> bool {
        self.0 == self.1
    }

    /// Returns the nearest value inside.
    pub fn clamp(&self, value: f64) -> f64 {
        value.max(self.0).min(self.1)
    }
}
