//! Requirement on the ratio of the longest to the shortest of ground, crank, coupler and follower.

use super::{Definition, Limit, LimitUnit, Refusal, RequireSpec};
use crate::task::spec::TimingSpec;

/// The default of `link_ratio_max`.
pub const DEFAULT_LINK_RATIO: f64 = 20.0;
/// A limit of the link ratio that practically does not bind: a slider-crank to four digits.
const NO_LINK_RATIO: f64 = 1e4;

pub(super) const LINK_RATIO: Definition = Definition {
    key: "require.link_ratio_max",
    short: "link ratio",
    label: "longest to shortest link",
    relation: "at most ",
    plain: "longest over shortest link",
    template: "# link_ratio_max = 10           # longest over shortest link; 20 where silent\n",
    unit: LimitUnit::Ratio,
    is_asked: |_| true,
    check,
    limits: |spec| Limit::most(Some(spec.require.link_ratio_max)),
    set_limits: |spec, limits| {
        let ratio = &mut spec.require.link_ratio_max;
        *ratio = limits.first().copied().unwrap_or(ratio.max(NO_LINK_RATIO));
    },
    rounding: |_, _| 1.0,
    objection: |value, limit| Some(format!("link ratio {value}, at most {limit} asked")),
    ..Definition::DEFAULT
};

fn check(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    let ratio = require.link_ratio_max;
    if ratio < 1.0 {
        return Refusal::because(
            format!("link_ratio_max = {ratio}: the longest link is at least as long as the shortest"),
            "write 1 or more, such as 10",
        );
    }
    Ok(())
}
