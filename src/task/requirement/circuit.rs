//! Requirement that the motion stays on one circuit.

use super::{Choice, Definition};
use crate::task::spec::OnePolicy;

pub(super) const CIRCUIT: Definition = Definition {
    key: "require.circuit",
    short: "circuit",
    label: "circuit",
    plain: "is not taken apart on the way",
    is_asked: |problem| problem.spec().require.circuit == OnePolicy::One,
    set_limits: |spec, _| spec.require.circuit = OnePolicy::Any,
    choice: |require| Some(Choice::Word(require.circuit.name())),
    ..Definition::DEFAULT
};
