//! How a target that ends where it begins is closed.

use super::{Choice, Definition, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{ClosingPolicy, ProblemSpec};

pub(super) struct Closing;

impl Definition for Closing {
    fn key(&self) -> &'static str {
        "require.closing"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.has_to_turn_on()
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.closing = ClosingPolicy::Any;
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        Some(Choice::Word(if require.closing.is_one_way() { "one-way" } else { "any" }))
    }

    fn words(&self) -> Words {
        Words {
            short: "closing",
            label: "return to the first point",
            relation: "",
            plain: "returning to the first point without reversing",
        }
    }
}
