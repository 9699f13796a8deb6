//! Requirement that a box holds every joint and P over the motion used.

use super::{Definition, boxes, limit};

pub(super) const FOOTPRINT_IN: Definition = Definition {
    key: "require.footprint_in",
    short: "footprint",
    label: "motion inside",
    relation: "in ",
    plain: "everything inside a box",
    template: "# footprint_in = [-150, -150, 300, 300]   # where there is room for all of it as it moves\n",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.footprint_in.is_some(),
    check: |require, _| boxes::check(require.footprint_in),
    limits: |spec| boxes::limits(spec.require.footprint_in),
    set_limits: |spec, limits| spec.require.footprint_in = limits.try_into().ok(),
    rounding: limit::rounding_of_extremes,
    objection: |value, limit| Some(format!("the motion spans [{value}], outside of [{limit}]")),
    ..Definition::DEFAULT
};
