//! Requirement on the torque of the crank under the loads of the problem: its largest size over the motion.

use super::{Definition, Limit, LimitUnit, Refusal, RequireSpec};
use crate::task::spec::TimingSpec;

pub(super) const PEAK_TORQUE_MAX: Definition = Definition {
    key: "require.peak_torque_max",
    short: "peak torque",
    label: "peak torque on the crank, N m",
    relation: "at most ",
    plain: "greatest torque on the crank",
    template: "",
    unit: LimitUnit::Torque,
    is_asked: |problem| problem.spec().require.peak_torque_max.is_some(),
    check,
    limits: |spec| Limit::most(spec.require.peak_torque_max),
    set_limits: |spec, limits| spec.require.peak_torque_max = limits.first().copied(),
    rounding: |value, _| 1e4 * value.map_or(1.0, f64::abs),
    objection: |value, limit| Some(format!("peak torque {value} N m, at most {limit} N m asked")),
    ..Definition::DEFAULT
};

fn check(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    match require.peak_torque_max {
        Some(most) if most <= 0.0 => Refusal::because(
            format!("peak_torque_max = {most}: a torque at most 0 turns nothing"),
            "write a torque above 0 in N m, or remove the key for no limit",
        ),
        _ => Ok(()),
    }
}
