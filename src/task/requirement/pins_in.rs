//! Requirement that a region of the body holds both moving pins.

use super::pivots_in::check_region;
use super::{Definition, boxes, limit};
use crate::task::region::Region;

pub(super) const PINS_IN: Definition = Definition {
    key: "require.pins_in",
    short: "pins",
    label: "moving pins inside, in the body's frame",
    relation: "in ",
    plain: "both moving pins inside a part of the body",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.pins_in.is_some(),
    check: |require, _| check_region(require.pins_in.as_ref()),
    limits: |spec| boxes::limits(spec.require.pins_in.as_ref().and_then(Region::as_box)),
    set_limits: |spec, limits| spec.require.pins_in = limits.try_into().ok().map(Region::Box),
    rounding: limit::rounding_of_extremes,
    objection: |value, limit| {
        Some(if value.contains(',') {
            format!("moving pins span [{value}] of the body, outside of [{limit}]")
        } else {
            format!("a moving pin lies {} outside of the polygon", value.trim_start_matches(['-', '−']))
        })
    },
    ..Definition::DEFAULT
};
