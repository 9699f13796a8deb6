//! Requirement on the longest rigid link: of ground, crank, coupler, follower, |CP| and |DP|.

use super::{Definition, Limit, Refusal};

pub(super) const LONGEST_MAX: Definition = Definition {
    key: "require.longest_max",
    short: "longest link",
    label: "longest link, P included",
    relation: "at most ",
    plain: "the longest link",
    template: "# longest_max = 200             # no distance between two joints of one link is longer, P and pivots included\n",
    is_asked: |problem| problem.spec().require.longest_max.is_some(),
    check: |require, _| Refusal::unless_positive("longest_max", require.longest_max),
    limits: |spec| Limit::most(spec.require.longest_max),
    set_limits: |spec, limits| spec.require.longest_max = limits.first().copied(),
    objection: |value, limit| Some(format!("longest link {value}, at most {limit} asked")),
    ..Definition::DEFAULT
};
