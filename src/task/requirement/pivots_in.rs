//! The box that holds both fixed pivots.

use super::{Definition, Limit, Refusal, RequireSpec, Words, boxes};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};

pub(super) struct PivotsIn;

impl Definition for PivotsIn {
    fn key(&self) -> &'static str {
        "require.pivots_in"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.pivots_in.is_some()
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        boxes::check(require.pivots_in)
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        boxes::limits(spec.require.pivots_in)
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.pivots_in = limits.try_into().ok();
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.pivots_in = None;
    }

    fn is_left_out_in_turn(&self) -> bool {
        true
    }

    fn rounding(&self, _: Option<f64>, size: f64) -> f64 {
        boxes::rounding(size)
    }

    fn template(&self) -> &'static str {
        "# pivots_in = [-100, -100, 250, 250]      # xmin, ymin, xmax, ymax: where there is room for the two pivots\n"
    }

    fn words(&self) -> Words {
        Words { short: "pivots", label: "fixed pivots inside", relation: "in ", plain: "the pivot box" }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("fixed pivots span [{value}], outside of [{limit}]"))
    }
}
