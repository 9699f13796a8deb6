//! Requirement that a box holds both fixed pivots.

use super::{Definition, boxes, limit};

pub(super) const PIVOTS_IN: Definition = Definition {
    key: "require.pivots_in",
    short: "pivots",
    label: "fixed pivots inside",
    relation: "in ",
    plain: "both fixed pivots inside a box",
    template: "# pivots_in = [-100, -100, 250, 250]      # xmin, ymin, xmax, ymax: where there is room for the two pivots\n",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.pivots_in.is_some(),
    check: |require, _| boxes::check(require.pivots_in),
    limits: |spec| boxes::limits(spec.require.pivots_in),
    set_limits: |spec, limits| spec.require.pivots_in = limits.try_into().ok(),
    rounding: limit::rounding_of_extremes,
    objection: |value, limit| Some(format!("fixed pivots span [{value}], outside of [{limit}]")),
    ..Definition::DEFAULT
};
