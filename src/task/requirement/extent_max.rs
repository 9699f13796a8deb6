//! The greatest extent: the diagonal of the box of every joint and P over the motion used.

use super::{Definition, Limit, Refusal, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};

pub(super) struct ExtentMax;

impl Definition for ExtentMax {
    fn key(&self) -> &'static str {
        "require.extent_max"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.extent_max.is_some()
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        Refusal::unless_positive("extent_max", require.extent_max)
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        Limit::most(spec.require.extent_max)
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.extent_max = limits.first().copied();
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.extent_max = None;
    }

    fn is_left_out_in_turn(&self) -> bool {
        true
    }

    /// Extremes of a motion are found by search, to the square root of the rounding.
    fn rounding(&self, _: Option<f64>, size: f64) -> f64 {
        1e4 * size
    }

    fn template(&self) -> &'static str {
        "# extent_max = 400              # the diagonal of the space that all of it needs as it moves, wherever that is\n"
    }

    fn words(&self) -> Words {
        Words {
            short: "extent",
            label: "diagonal of the motion's box",
            relation: "at most ",
            plain: "the extent of the whole linkage",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("the motion has an extent of {value}, at most {limit} asked"))
    }
}
