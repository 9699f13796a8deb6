//! The types allowed.

use super::{Choice, Definition, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::ProblemSpec;

pub(super) struct Type;

impl Definition for Type {
    fn key(&self) -> &'static str {
        "require.type"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        !problem.spec().require.types.is_empty()
    }

    fn template(&self) -> &'static str {
        "type = [\"crank-rocker\", \"double-crank\"]   # a motor on the crank can turn fully\n"
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.types.clear();
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        Some(Choice::Words(require.types.iter().map(|kind| kind.name()).collect()))
    }

    fn words(&self) -> Words {
        Words { short: "type", label: "type", relation: "", plain: "how it is driven" }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("type {value}, asked for {limit}"))
    }
}
