//! Requirement on the way back to the first point of a target that ends where it begins.

use super::{Choice, Definition};
use crate::task::Problem;
use crate::task::spec::ClosingPolicy;

pub(super) const CLOSING: Definition = Definition {
    key: "require.closing",
    short: "closing",
    label: "return to the first point",
    plain: "comes back to the start of a closed path without reversing",
    is_asked: Problem::has_to_turn_on,
    set_limits: |spec, _| spec.require.closing = ClosingPolicy::Any,
    choice: |require| Some(Choice::Word(if require.closing.is_one_way() { "one-way" } else { "any" })),
    ..Definition::DEFAULT
};
