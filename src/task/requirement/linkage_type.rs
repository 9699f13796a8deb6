//! Requirement on the type of the linkage.

use super::{Choice, Definition};

pub(super) const TYPE: Definition = Definition {
    key: "require.type",
    short: "type",
    label: "type",
    plain: "driven by",
    template: "type = [\"crank-rocker\", \"double-crank\"]   # a motor on the crank can turn fully\n",
    is_asked: |problem| !problem.spec().require.types.is_empty(),
    set_limits: |spec, _| spec.require.types.clear(),
    choice: |require| Some(Choice::Words(require.types.iter().map(|kind| kind.name()).collect())),
    objection: |value, limit| Some(format!("type {value}, asked for {limit}")),
    ..Definition::DEFAULT
};
