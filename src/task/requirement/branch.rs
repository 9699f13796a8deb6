//! Requirement that the motion stays on one branch.

use super::{Choice, Definition};
use crate::task::spec::OnePolicy;

pub(super) const BRANCH: Definition = Definition {
    key: "require.branch",
    short: "branch",
    label: "branch",
    plain: "passes no toggle on the way",
    is_asked: |problem| problem.spec().require.branch == OnePolicy::One,
    set_limits: |spec, _| spec.require.branch = OnePolicy::Any,
    choice: |require| Some(Choice::Word(require.branch.name())),
    ..Definition::DEFAULT
};
