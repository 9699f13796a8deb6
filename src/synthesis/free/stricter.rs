//! Stricter problems than the one to solve. Their answers are answers of the problem too, and starts without their
//! requirements seldom lead to some of them.

use crate::synthesis::coarse::points_of;
use crate::synthesis::constants::free::{STRICT_DEG, STRICT_LEAST};
use crate::synthesis::required::ONE_BRANCH;
use crate::task::Problem;
use crate::task::spec::OnePolicy;

/// A stricter problem, as it is explored.
pub(super) struct Stricter {
    pub(super) kind: Kind,
    /// The problem with all points.
    pub(super) problem: Problem,
}

/// A requirement that is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A transmission angle of [`STRICT_DEG`] at least.
    Strict,
    /// A crank that turns fully.
    Turning,
}

/// Returns whether a target has points enough for stricter problems to be explored.
pub(super) fn has_many_points(problem: &Problem) -> bool {
    points_of(problem) >= STRICT_LEAST
}

/// Returns the stricter problems that are not asked for already; none if the motion may pass toggles, which no linkage
/// of them does, or if the target has few points.
pub(super) fn stricter(problem: &Problem) -> Vec<Stricter> {
    let require = &problem.spec().require;
    if require.branch == OnePolicy::Any || !has_many_points(problem) {
        return Vec::new();
    }
    let has_angle = require.transmission_deg_min.is_some_and(|asked| asked >= STRICT_DEG);
    let has_types = !require.types.is_empty();
    let of = |kind: Kind| {
        let mut spec = problem.spec().clone();
        match kind {
            Kind::Strict => spec.require.transmission_deg_min = Some(STRICT_DEG),
            Kind::Turning => spec.require.types = ONE_BRANCH.to_vec(),
        }
        Some(Stricter { kind, problem: problem.with(spec).ok()? })
    };
    let is_new = |kind: &Kind| match kind {
        Kind::Strict => !has_angle,
        Kind::Turning => !has_types,
    };
    [Kind::Strict, Kind::Turning].into_iter().filter(is_new).filter_map(of).collect()
}
