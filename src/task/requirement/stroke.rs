//! Requirements on the stroke of a slider-crank's slider and on its time ratio, over a full turn of the crank.
//!
//! The *stroke* is the distance between the slider's ends, the *time ratio* that of the crank's angles for the slower and the
//! quicker way between them, 1 or more; the crank turns at constant speed. See [`ends`](crate::task::forms::slider::ends).

use super::{Definition, LimitUnit, Refusal, RequireSpec};
use crate::task::spec::{Limits, TimingSpec};

/// The time ratio that no slider-crank reaches: as b - a >= h where the crank turns fully, alpha < pi/2.
const MOST_RATIO: f64 = 3.0;

pub(super) const STROKE: Definition = Definition {
    key: "require.stroke",
    short: "stroke",
    label: "stroke of the slider",
    relation: "",
    plain: "stroke of the slider",
    template: "",
    is_asked: |problem| problem.spec().require.stroke.is_some(),
    check: |require, _| Refusal::unless_positive("stroke", require.stroke.map(|limits| limits.0)),
    set_limits: |spec, _| spec.require.stroke = None,
    objection: |value, limit| Some(format!("stroke {value}, {limit} asked")),
    ..Definition::DEFAULT
};

pub(super) const TIME_RATIO: Definition = Definition {
    key: "require.time_ratio",
    short: "time ratio",
    label: "time ratio of the slider's ways",
    relation: "",
    plain: "time ratio of the slider's ways",
    template: "",
    unit: LimitUnit::Ratio,
    is_asked: |problem| problem.spec().require.time_ratio.is_some(),
    check: time_ratio,
    set_limits: |spec, _| spec.require.time_ratio = None,
    rounding: |_, _| 1.0,
    objection: |value, limit| Some(format!("time ratio {value}, {limit} asked")),
    ..Definition::DEFAULT
};

fn time_ratio(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    match require.time_ratio {
        Some(Limits(least, _)) if least < 1.0 => Refusal::because(
            format!("time_ratio = {least}: it is the slower way over the quicker one"),
            "write 1 or more, such as 1.2; the sense in which the crank turns says which way is the slow one",
        ),
        Some(Limits(least, _)) if least >= MOST_RATIO => Refusal::because(
            format!("time_ratio = {least}: a slider-crank whose crank turns fully stays below {MOST_RATIO}"),
            "write less than 3: the ends of the stroke are less than a right angle apart, seen from A",
        ),
        _ => Ok(()),
    }
}
