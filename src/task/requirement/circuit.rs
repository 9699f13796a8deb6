//! Whether the motion must stay on one circuit.

use super::{Choice, Definition, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{OnePolicy, ProblemSpec};

pub(super) struct Circuit;

impl Definition for Circuit {
    fn key(&self) -> &'static str {
        "require.circuit"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.circuit == OnePolicy::One
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.circuit = OnePolicy::Any;
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        let is_any = require.circuit == OnePolicy::Any;
        Some(Choice::Word(if is_any { "any" } else { "one" }))
    }

    fn words(&self) -> Words {
        Words { short: "circuit", label: "circuit", relation: "", plain: "staying on one circuit" }
    }
}
