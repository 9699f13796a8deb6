//! Requirement on the input: a crank that turns fully.

use super::{Choice, Definition, InputPolicy};

pub(super) const INPUT: Definition = Definition {
    key: "require.input",
    short: "input",
    label: "input",
    plain: "the crank turns fully",
    template: "# input = \"full-turn\"          # the crank turns fully, whatever the kind of linkage\n",
    is_asked: |problem| problem.spec().require.input == InputPolicy::FullTurn,
    set_limits: |spec, _| spec.require.input = InputPolicy::Any,
    choice: |require| {
        Some(Choice::Word(match require.input {
            InputPolicy::Any => "any",
            InputPolicy::FullTurn => "full-turn",
        }))
    },
    objection: |value, limit| Some(format!("the crank has {value}, {limit} asked")),
    ..Definition::DEFAULT
};
