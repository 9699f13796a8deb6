//! The greatest length of the longest rigid link: of ground, crank, coupler, follower, |CP| and |DP|.

use super::{Definition, Limit, Refusal, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};

pub(super) struct LongestMax;

impl Definition for LongestMax {
    fn key(&self) -> &'static str {
        "require.longest_max"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.longest_max.is_some()
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        Refusal::unless_positive("longest_max", require.longest_max)
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        Limit::most(spec.require.longest_max)
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.longest_max = limits.first().copied();
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.longest_max = None;
    }

    fn template(&self) -> &'static str {
        "# longest_max = 200             # no distance between two joints of one link is longer, P and pivots included\n"
    }

    fn words(&self) -> Words {
        Words {
            short: "longest link",
            label: "longest link, P included",
            relation: "at most ",
            plain: "the longest link",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("longest link {value}, at most {limit} asked"))
    }
}
