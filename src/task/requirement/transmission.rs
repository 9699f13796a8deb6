//! Requirement on the transmission angle: the least min(mu, 180 - mu) over the motion.

use super::{Definition, Limit, LimitUnit, Refusal, RequireSpec};
use crate::task::spec::TimingSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The motion over which the transmission angle is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TransmissionOver {
    /// The full turn of the crank.
    Cycle,
    /// The crank angles between the target points.
    Used,
}

pub(super) const TRANSMISSION: Definition = Definition {
    key: "require.transmission_deg_min",
    short: "transmission",
    label: "worst transmission angle, °",
    relation: "at least ",
    plain: "least transmission angle",
    template: "transmission_deg_min = 30       # how well the coupler pushes the follower: 90 is best, below 30 it may jam\n",
    is_left_out_in_turn: true,
    unit: LimitUnit::Degree,
    is_asked: |problem| problem.spec().require.transmission_deg_min.is_some(),
    check,
    limits: |spec| Limit::least(spec.require.transmission_deg_min),
    set_limits: |spec, limits| spec.require.transmission_deg_min = limits.first().copied(),
    rounding: |value, size| {
        value.map_or(size, |value| 180.0 / value.min(180.0 - value).max(1e-5).to_radians().sin())
    },
    objection: |value, limit| Some(format!("worst transmission angle {value}°, at least {limit}° asked")),
    ..Definition::DEFAULT
};

fn check(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    match require.transmission_deg_min {
        Some(least) if !(0.0..=90.0).contains(&least) => Refusal::because(
            format!("transmission_deg_min = {least} is not between 0 and 90 degrees"),
            "the angle meant is min(mu, 180 - mu): 90 is best, 30 to 40 is usual",
        ),
        _ => Ok(()),
    }
}
