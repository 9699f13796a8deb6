//! Whether the points must be passed in their order.

use super::{Choice, Definition, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{OrderPolicy, ProblemSpec};

pub(super) struct Order;

impl Definition for Order {
    fn key(&self) -> &'static str {
        "require.order"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        let spec = problem.spec();
        spec.require.order == OrderPolicy::Required && spec.task.path.timing.is_none()
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.order = OrderPolicy::Any;
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        let is_any = require.order == OrderPolicy::Any;
        Some(Choice::Word(if is_any { "any" } else { "required" }))
    }

    fn words(&self) -> Words {
        Words { short: "order", label: "order of the points", relation: "", plain: "the order of the points" }
    }
}
