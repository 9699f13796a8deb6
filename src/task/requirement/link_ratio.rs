//! The greatest ratio of the longest to the shortest of ground, crank, coupler and follower.

use super::{Definition, Limit, LimitUnit, Refusal, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};

/// The default of `link_ratio_max`.
pub const DEFAULT_LINK_RATIO: f64 = 20.0;
/// A limit of the link ratio that practically does not bind: a slider-crank to four digits.
const NO_LINK_RATIO: f64 = 1e4;

pub(super) struct LinkRatio;

impl Definition for LinkRatio {
    fn key(&self) -> &'static str {
        "require.link_ratio_max"
    }

    fn is_asked(&self, _: &Problem) -> bool {
        true
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        let ratio = require.link_ratio_max;
        if ratio < 1.0 {
            return Refusal::because(
                format!("link_ratio_max = {ratio}: the longest link is at least as long as the shortest"),
                "write 1 or more, such as 10",
            );
        }
        Ok(())
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        Limit::most(Some(spec.require.link_ratio_max))
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.link_ratio_max = limits.first().copied().unwrap_or(NO_LINK_RATIO);
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.link_ratio_max = spec.require.link_ratio_max.max(NO_LINK_RATIO);
    }

    fn unit(&self) -> LimitUnit {
        LimitUnit::Ratio
    }

    fn rounding(&self, _: Option<f64>, _: f64) -> f64 {
        1.0
    }

    fn template(&self) -> &'static str {
        "# link_ratio_max = 10           # longest over shortest link; 20 where silent\n"
    }

    fn words(&self) -> Words {
        Words {
            short: "link ratio",
            label: "longest to shortest link",
            relation: "at most ",
            plain: "the longest over shortest link",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("link ratio {value}, at most {limit} asked"))
    }
}
