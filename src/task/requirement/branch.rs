//! Whether the motion must stay on one branch.

use super::{Choice, Definition, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{OnePolicy, ProblemSpec};

pub(super) struct Branch;

impl Definition for Branch {
    fn key(&self) -> &'static str {
        "require.branch"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.branch == OnePolicy::One
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.branch = OnePolicy::Any;
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        let is_any = require.branch == OnePolicy::Any;
        Some(Choice::Word(if is_any { "any" } else { "one" }))
    }

    fn words(&self) -> Words {
        Words { short: "branch", label: "branch", relation: "", plain: "passing no toggle" }
    }
}
