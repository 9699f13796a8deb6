//! The box that holds every joint and P over the motion used.

use super::{Definition, Limit, Refusal, RequireSpec, Words, boxes};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};

pub(super) struct FootprintIn;

impl Definition for FootprintIn {
    fn key(&self) -> &'static str {
        "require.footprint_in"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.footprint_in.is_some()
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        boxes::check(require.footprint_in)
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        boxes::limits(spec.require.footprint_in)
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.footprint_in = limits.try_into().ok();
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.footprint_in = None;
    }

    fn is_left_out_in_turn(&self) -> bool {
        true
    }

    fn rounding(&self, _: Option<f64>, size: f64) -> f64 {
        boxes::rounding(size)
    }

    fn template(&self) -> &'static str {
        "# footprint_in = [-150, -150, 300, 300]   # where there is room for all of it as it moves\n"
    }

    fn words(&self) -> Words {
        Words {
            short: "footprint",
            label: "motion inside",
            relation: "in ",
            plain: "the space for the whole linkage",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("the motion spans [{value}], outside of [{limit}]"))
    }
}
