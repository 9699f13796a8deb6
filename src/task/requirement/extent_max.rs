//! Requirement on the extent: the diagonal of the box of every joint and P over the motion used.

use super::{Definition, Limit, Refusal, limit};

pub(super) const EXTENT_MAX: Definition = Definition {
    key: "require.extent_max",
    short: "extent",
    label: "diagonal of the motion's box",
    relation: "at most ",
    plain: "whole linkage in motion",
    template: "# extent_max = 400              # the diagonal of the space that all of it needs as it moves, wherever that is\n",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.extent_max.is_some(),
    check: |require, _| Refusal::unless_positive("extent_max", require.extent_max),
    limits: |spec| Limit::most(spec.require.extent_max),
    set_limits: |spec, limits| spec.require.extent_max = limits.first().copied(),
    rounding: limit::rounding_of_extremes,
    objection: |value, limit| Some(format!("the motion has an extent of {value}, at most {limit} asked")),
    ..Definition::DEFAULT
};
