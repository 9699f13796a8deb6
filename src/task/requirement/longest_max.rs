//! Requirement on the longest rigid link: of ground, crank, coupler, follower, |CP| and |DP|.

use super::{Definition, Limit, Refusal, RequireSpec};
use crate::mechanism::{Complex, MAX_MAGNITUDE};
use crate::task::spec::{DesignSpec, Limits, ProblemSpec};
use crate::task::{Task, Timing};

/// The default of `longest_max` where it has one, in sizes of the target.
pub const DEFAULT_LONGEST: f64 = 3.0;

pub(super) const LONGEST_MAX: Definition = Definition {
    key: "require.longest_max",
    short: "longest link",
    label: "longest link, P included",
    relation: "at most ",
    plain: "longest link",
    template: "# longest_max = 200             # no distance between two joints of one link is longer, P and pivots included;\n\
               #                               # where silent 3 sizes of the path, unless it has crank angles or something\n\
               #                               # above bounds lengths; \"any\" for no limit\n",
    is_asked: |problem| problem.spec().require.longest_max.is_some(),
    check: |require, _| {
        Refusal::unless_positive("longest_max", require.longest_max)
            .map_err(|refusal| Refusal { help: "write a length above 0, or \"any\" for no limit", ..refusal })
    },
    limits: |spec| Limit::most(spec.require.longest_max),
    set_limits: |spec, limits| spec.require.longest_max = limits.first().copied(),
    objection: |value, limit| Some(format!("longest link {value}, at most {limit} asked")),
    ..Definition::DEFAULT
};

impl RequireSpec {
    /// Returns `longest_max` of a problem that is silent about it: 3 sizes of a path with free timing. There is none
    /// if `design`, the bounds as they are given, bounds a length, and none beside `extent_max`; nor is there one that
    /// the places given for the pivots would make impossible.
    pub(crate) fn default_longest(&self, design: &DesignSpec, task: &Task) -> Option<f64> {
        let longest = longest_of(task.size());
        let applies = matches!(task.timing(), Timing::Free)
            && task.body().is_none()
            && self.extent_max.is_none()
            && !design.bounds_a_length()
            && are_in_reach(design, self.pivots_in, task, longest);
        applies.then_some(longest)
    }
}

impl ProblemSpec {
    /// Returns whether `longest_max` has the value of its default, whoever set it.
    pub(crate) fn has_default_longest(&self) -> bool {
        let path = &self.task;
        let default = || path.to_task().ok().map(|task| longest_of(task.size()));
        self.require.longest_max.is_some()
            && path.timing.is_none()
            && path.body.is_none()
            && self.require.longest_max == default()
    }
}

/// Returns the default of `longest_max` for a target of this size.
fn longest_of(size: f64) -> f64 {
    (DEFAULT_LONGEST * size).min(MAX_MAGNITUDE)
}

/// Returns whether links of this length can span the pivots, and two of them lead from each pivot to every point.
fn are_in_reach(design: &DesignSpec, pivots_in: Option<[f64; 4]>, task: &Task, longest: f64) -> bool {
    let (a, b) = (design.crank_pivot, design.follower_pivot);
    let spanned = a.zip(b).is_none_or(|(a, b)| distance(a, b) <= longest);
    let plate = pivots_in.map(|[x0, y0, x1, y1]| [Limits(x0, x1), Limits(y0, y1)]);
    let reached = |from: [Limits; 2]| {
        let at = |point: &Complex| [Limits(point.re, point.re), Limits(point.im, point.im)];
        task.points().iter().all(|point| distance(from, at(point)) <= 2.0 * longest)
    };
    spanned && [a, b, plate].into_iter().flatten().all(reached)
}

/// Returns the least distance of two boxes.
fn distance(from: [Limits; 2], to: [Limits; 2]) -> f64 {
    let [x, y] = [0, 1].map(|i| (to[i].0 - from[i].1).max(from[i].0 - to[i].1).max(0.0));
    x.hypot(y)
}
