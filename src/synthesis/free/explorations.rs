//! The explorations of a problem: which of its points are explored, under which requirements.

use super::stricter::{Kind, Stricter};
use crate::synthesis::coarse::Coarse;
use crate::synthesis::constants::free::{SHARES, STRICT_DEG, STRICT_SHARES, TURNING_SHARES, WHOLE_MOST};
use crate::task::Problem;

/// The points that are explored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Points {
    /// The groups' means of a dense target, or all points of a sparse one.
    First,
    /// All points of a dense target.
    Whole,
    /// One point of each group.
    Corners,
}

/// A number for each of the [`Points`].
#[derive(Clone, Copy)]
pub(in crate::synthesis) struct PerPoints {
    pub(in crate::synthesis) first: u64,
    pub(in crate::synthesis) corners: u64,
    pub(in crate::synthesis) whole: u64,
}

impl PerPoints {
    /// Returns the number for these points.
    pub(super) fn of(self, points: Points) -> u64 {
        match points {
            Points::First => self.first,
            Points::Corners => self.corners,
            Points::Whole => self.whole,
        }
    }
}

/// The points and the requirements that are explored: the problem's own requirements, or those of a stricter one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Explored {
    pub(super) points: Points,
    pub(super) stricter: Option<Kind>,
}

impl Explored {
    /// All points under the requirement of a crank that turns fully: explored only in noise, if several answers are wanted.
    pub(super) const TURNING_WHOLE: Explored =
        Explored { points: Points::Whole, stricter: Some(Kind::Turning) };

    /// Returns the share of the evaluations that the exploration is given, in parts of the sum of all; 0 if it has its turn
    /// in noise alone.
    pub(super) fn share(self) -> u64 {
        let shares = match self.stricter {
            None => SHARES,
            Some(Kind::Strict) => STRICT_SHARES,
            Some(Kind::Turning) => TURNING_SHARES,
        };
        shares.of(self.points)
    }
}

/// An exploration of a problem.
pub(super) struct Exploration<'a> {
    pub(super) explored: Explored,
    /// The problem with all points, of the requirements that are explored.
    pub(super) of: &'a Problem,
    /// The coarse problem that is explored in its place, if it is not explored with all points.
    pub(super) coarse: Option<Coarse>,
}

impl Exploration<'_> {
    /// Returns the first index of its random streams: a stricter problem that is explored draws the same as a search of that
    /// problem, and what other explorations draw is independent of it.
    pub(super) fn first_stream(&self) -> u64 {
        let require = &self.of.spec().require;
        let is_strict = require.transmission_deg_min.is_some_and(|asked| asked >= STRICT_DEG);
        let of_requirements = match (is_strict, require.types.is_empty()) {
            (true, _) => 2,
            (false, false) => 1,
            (false, true) => 0,
        };
        (of_requirements + 3 * self.explored.points as u64) << 32
    }

    /// Returns the problem that is explored.
    pub(super) fn problem(&self) -> &Problem {
        self.coarse.as_ref().map_or(self.of, |coarse| &coarse.problem)
    }
}

/// Returns the explorations of a problem of which so many answers are wanted, that of its own requirements and first points
/// before the others.
pub(super) fn explorations<'a>(
    problem: &'a Problem,
    stricter: &'a [Stricter],
    wanted: usize,
) -> Vec<Exploration<'a>> {
    let of = |points: Points, stricter: Option<Kind>, of: &'a Problem, coarse: Option<Coarse>| {
        let explored = Explored { points, stricter };
        Exploration { explored, of, coarse }
    };
    let mut all = vec![of(Points::First, None, problem, Coarse::of(problem))];
    let is_dense = all[0].coarse.is_some();
    let own = |stricter: &'a Stricter| {
        let coarse =
            if is_dense { Coarse::of(&stricter.problem) } else { Coarse::of_each_point(&stricter.problem) };
        coarse.map(|coarse| of(Points::First, Some(stricter.kind), &stricter.problem, Some(coarse)))
    };
    all.extend(stricter.iter().filter_map(own));
    if is_dense {
        // The stricter ones first: their fits are shorter.
        let problems = stricter.iter().map(|s| (Some(s.kind), &s.problem)).chain([(None, problem)]);
        for (kind, problem) in problems {
            all.extend(
                Coarse::of_corners(problem).map(|coarse| of(Points::Corners, kind, problem, Some(coarse))),
            );
            if problem.task().len() <= WHOLE_MOST {
                all.push(of(Points::Whole, kind, problem, None));
            }
        }
    }
    all.retain(|one| one.explored.share() > 0 || (wanted > 1 && one.explored == Explored::TURNING_WHOLE));
    all
}
