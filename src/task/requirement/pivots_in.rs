//! Requirement that a box or a polygon holds both fixed pivots.

use super::{Definition, Refusal, RequireSpec, boxes, limit};
use crate::task::region::{MOST_CORNERS, Region};
use crate::task::spec::TimingSpec;

pub(super) const PIVOTS_IN: Definition = Definition {
    key: "require.pivots_in",
    short: "pivots",
    label: "fixed pivots inside",
    relation: "in ",
    plain: "both fixed pivots inside a box",
    template: "# pivots_in = [-100, -100, 250, 250]      # xmin, ymin, xmax, ymax: where there is room for the two pivots;\n\
               #                               # or a polygon [[x, y], ...]\n",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.pivots_in.is_some(),
    check,
    limits: |spec| boxes::limits(spec.require.pivots_in.as_ref().and_then(Region::as_box)),
    set_limits: |spec, limits| spec.require.pivots_in = limits.try_into().ok().map(Region::Box),
    rounding: limit::rounding_of_extremes,
    objection: |value, limit| {
        Some(if value.contains(',') {
            format!("fixed pivots span [{value}], outside of [{limit}]")
        } else {
            format!("a fixed pivot lies {} outside of the polygon", value.trim_start_matches(['-', '−']))
        })
    },
    ..Definition::DEFAULT
};

fn check(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    check_region(require.pivots_in.as_ref())
}

/// Checks the corners of a region.
pub(super) fn check_region(region: Option<&Region>) -> Result<(), Refusal> {
    match region {
        Some(Region::Polygon(corners)) if !(3..=MOST_CORNERS).contains(&corners.len()) => Refusal::because(
            format!("the polygon has {} corners, 3 to {MOST_CORNERS} are read", corners.len()),
            "write [[x, y], [x, y], [x, y], ...], or a box [xmin, ymin, xmax, ymax]",
        ),
        Some(Region::Polygon(corners)) if area(corners) == 0.0 => Refusal::because(
            "the corners of the polygon lie on one line".to_owned(),
            "give corners that enclose some room",
        ),
        region => boxes::check(region.and_then(Region::as_box)),
    }
}

/// Returns the area of a polygon, positive if it runs counter-clockwise.
fn area(corners: &[[f64; 2]]) -> f64 {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    corners.iter().enumerate().map(|(k, p)| 0.5 * (p[0] * next(k)[1] - p[1] * next(k)[0])).sum()
}
