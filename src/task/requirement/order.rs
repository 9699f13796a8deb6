//! Requirement that the points are passed in their order.

use super::{Choice, Definition};
use crate::task::Problem;
use crate::task::spec::OrderPolicy;

pub(super) const ORDER: Definition = Definition {
    key: "require.order",
    short: "order",
    label: "order of the points",
    plain: "passes the points in their order",
    is_asked: |problem: &Problem| problem.order_required() && problem.spec().task.timing.is_none(),
    set_limits: |spec, _| spec.require.order = OrderPolicy::Any,
    choice: |require| Some(Choice::Word(if require.order == OrderPolicy::Any { "any" } else { "required" })),
    ..Definition::DEFAULT
};
