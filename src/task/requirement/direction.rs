//! Requirement on the direction in which the crank turns along the points.

use super::{Choice, Definition, Refusal, RequireSpec};
use crate::task::AngleOffset;
use crate::task::spec::{DirectionPolicy, TimingSpec};

pub(super) const DIRECTION: Definition = Definition {
    key: "require.direction",
    short: "direction",
    label: "direction",
    plain: "the crank turns",
    template: "# direction = \"ccw\"             # or \"cw\": which way the crank turns\n",
    is_asked: |problem| problem.spec().require.direction != DirectionPolicy::Any,
    check,
    set_limits: |spec, _| spec.require.direction = DirectionPolicy::Any,
    choice: |require| {
        Some(Choice::Word(match require.direction {
            DirectionPolicy::Any => "any",
            DirectionPolicy::Ccw => "ccw",
            DirectionPolicy::Cw => "cw",
        }))
    },
    objection: |value, limit| Some(format!("turns {value}, {limit} asked")),
    ..Definition::DEFAULT
};

fn check(require: &RequireSpec, timing: Option<&TimingSpec>) -> Result<(), Refusal> {
    let offset = match timing.map(|timing| timing.offset) {
        _ if require.direction == DirectionPolicy::Any => return Ok(()),
        None | Some(AngleOffset::Free) => return Ok(()),
        Some(AngleOffset::Fixed) => "fixed",
        Some(AngleOffset::Ground) => "ground",
    };
    Refusal::because(
        format!(
            "the direction is already told by crank_deg, which is meant as written with offset = \"{offset}\""
        ),
        "remove direction; to turn the other way, change the signs of crank_deg",
    )
}
