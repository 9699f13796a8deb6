//! Requirement that fixed pivots lie on given lines, or at given points.

use super::{Definition, Refusal, RequireSpec};
use crate::task::spec::TimingSpec;
use crate::task::values::XY;
use schemars::JsonSchema;
use serde::Deserialize;

pub(super) const PIVOT_ON: Definition = Definition {
    key: "require.pivot_on",
    short: "pivots on lines",
    label: "fixed pivots on their lines",
    relation: "at most ",
    plain: "a fixed pivot on its line",
    template: "",
    is_left_out_in_turn: true,
    is_asked: |problem| problem.spec().require.pivot_on.is_some(),
    check,
    set_limits: |spec, _| spec.require.pivot_on = None,
    objection: |value, _| Some(format!("a fixed pivot lies {value} off its line")),
    ..Definition::DEFAULT
};

/// The line or the point of each fixed pivot.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PivotLines")]
pub(crate) struct RawPivotOn {
    /// Two points of the line of the crank's pivot, [[x, y], [x, y]]; or one point, [[x, y]], at which it is to lie.
    #[serde(rename = "A")]
    pub crank_pivot: Option<Vec<XY>>,
    /// The same of the follower's pivot.
    #[serde(rename = "B")]
    pub follower_pivot: Option<Vec<XY>>,
}

fn check(require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
    let Some(pivot_on) = &require.pivot_on else { return Ok(()) };
    let loci = pivot_on.both();
    if loci == [None; 2] {
        return Refusal::because(
            "pivot_on names no pivot".to_owned(),
            "write pivot_on = { A = [[x, y], [x, y]] }, two points of the line of A, or the same of B; or remove it",
        );
    }
    for (name, locus) in ["A", "B"].into_iter().zip(loci) {
        let Some(locus) = locus else { continue };
        if !(1..=2).contains(&locus.0.len()) {
            return Refusal::because(
                format!("pivot_on.{name} has {} points", locus.0.len()),
                "write two points of the line, [[x, y], [x, y]], or one point, [[x, y]]",
            );
        }
        let is_point = |pivot: usize| loci[pivot].filter(|locus| locus.line().is_none());
        if let (Some(one), Some(other)) = (is_point(0), is_point(1))
            && one.first() == other.first()
        {
            return Refusal::because(
                "pivot_on puts A and B at the same point".to_owned(),
                "put the pivots apart: a four-bar has a ground link of some length",
            );
        }
    }
    Ok(())
}
