//! Coarsening of dense targets: a search explores the problem with fewer points and fits the answer to all points.
//!
//! Neighbouring points are averaged in groups of (almost) equal size, which also smooths noise; a group has the total
//! weight of its points. Means blur corners: a second coarse problem has one of each group's points instead, its corner
//! if it has one. The pivots, bounds and requirements stay the problem's own.

use super::constants::coarse::{CORNER, DENSE, GROUPS};
use crate::mechanism::{Complex, cross};
use crate::task::forms::start::Start;
use crate::task::forms::torus::{PathFit, Positions};
use crate::task::{Problem, Timing};
use std::ops::Range;

/// The coarse problem of a dense one, with the groups of points.
#[derive(Clone, Debug)]
pub struct Coarse {
    /// The problem whose points are the groups' means.
    pub problem: Problem,
    groups: Vec<Range<usize>>,
    cyclic: bool,
}

/// Returns the number of points of a target, a repeated closing point not counted twice.
pub(super) fn points_of(problem: &Problem) -> usize {
    let task = problem.task();
    if task.repeats_first() { task.len() - 1 } else { task.len() }
}

/// Returns the weighted mean of a group of points.
fn mean(problem: &Problem, group: Range<usize>) -> Complex {
    let (points, weights) = (&problem.task().points()[group.clone()], &problem.task().weights()[group]);
    points.iter().zip(weights).map(|(p, w)| p * w).sum::<Complex>() / weights.iter().sum::<f64>()
}

/// Returns the point of a group that lies farthest from the chord between its neighbours if that is a corner, else the
/// middle one.
fn corner(problem: &Problem, group: Range<usize>) -> Complex {
    let (points, n) = (problem.task().points(), points_of(problem));
    let cyclic = problem.task().closed() || problem.task().repeats_first();
    let before = group.start.checked_sub(1).or(cyclic.then_some(n - 1)).unwrap_or(group.start);
    let after = if group.end < n {
        group.end
    } else if cyclic {
        0
    } else {
        n - 1
    };
    let chord = points[after] - points[before];
    let off = |i: usize| cross(chord, points[i] - points[before]).abs();
    let middle = (group.start + group.end - 1) / 2;
    let farthest = group.max_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap_or(middle);
    points[if off(farthest) > CORNER * chord.norm_sqr() { farthest } else { middle }]
}

impl Coarse {
    /// Returns whether a target has free timing and so many points that it is explored in groups.
    pub fn is_for(problem: &Problem) -> bool {
        points_of(problem) > DENSE && matches!(problem.task().timing(), Timing::Free)
    }

    /// Returns the coarse problem of the groups' means; `None` if the target has few points, is timed, or cannot be
    /// grouped.
    pub fn of(problem: &Problem) -> Option<Coarse> {
        Coarse::with(problem, mean)
    }

    /// Returns the coarse problem of one point of each group; `None` as for [`Coarse::of`].
    pub fn of_corners(problem: &Problem) -> Option<Coarse> {
        Coarse::with(problem, corner)
    }

    /// Returns a problem of as many groups as a sparse target has points: each point is one.
    pub fn of_each_point(problem: &Problem) -> Option<Coarse> {
        Coarse::grouped(problem, points_of(problem), mean)
    }

    fn with(problem: &Problem, point: fn(&Problem, Range<usize>) -> Complex) -> Option<Coarse> {
        if Coarse::is_for(problem) { Coarse::grouped(problem, GROUPS, point) } else { None }
    }

    fn grouped(
        problem: &Problem,
        count: usize,
        point: fn(&Problem, Range<usize>) -> Complex,
    ) -> Option<Coarse> {
        let task = problem.task();
        let n = points_of(problem);
        let groups: Vec<Range<usize>> = (0..count).map(|k| k * n / count..(k + 1) * n / count).collect();
        let weight = |group: &Range<usize>| task.weights()[group.clone()].iter().sum::<f64>();
        let mut spec = problem.spec().clone();
        spec.task.points = groups
            .iter()
            .map(|group| {
                let point = point(problem, group.clone());
                [point.re, point.im]
            })
            .collect();
        spec.task.weight = Some(groups.iter().map(weight).collect());
        spec.task.tolerance = None;
        let cyclic = task.closed() || task.repeats_first();
        spec.task.closed = cyclic;
        Some(Coarse { problem: problem.with(spec).ok()?, groups, cyclic })
    }

    /// Returns the start of the dense problem from one of the coarse problem: the positions are interpolated between a
    /// group's and the next group's, in equal steps of crank and coupler, and brought back to the curve.
    pub fn refine(&self, dense: &Problem, coarse: &Start) -> Option<Start> {
        let (at, count) = (&coarse.positions, self.groups.len());
        let between = |from: [Complex; 2], to: [Complex; 2], part: f64| -> [Complex; 2] {
            [0, 1].map(|i| from[i] * Complex::from_polar(1.0, part * (to[i] * from[i].conj()).arg()))
        };
        let mut positions: Positions = Vec::with_capacity(dense.task().len());
        for (k, group) in self.groups.iter().enumerate() {
            for (i, _) in group.clone().enumerate() {
                // From -1/2 to 1/2 across the group.
                let part = (i as f64 + 0.5) / group.len() as f64 - 0.5;
                let neighbour = if part < 0.0 {
                    k.checked_sub(1).or(self.cyclic.then_some(count - 1))
                } else {
                    Some(k + 1).filter(|k| *k < count).or(self.cyclic.then_some(0))
                };
                positions.push(match neighbour {
                    Some(next) => between(at[k], at[next], part.abs()),
                    // Beyond the ends the motion is extrapolated.
                    None if part < 0.0 => between(at[k], at[k + 1], part),
                    None => between(at[k], at[k - 1], -part),
                });
            }
        }
        if dense.task().repeats_first() {
            positions.push(positions[0]);
        }
        let fit = PathFit::new(dense, coarse.setting);
        fit.settle(&coarse.design, &mut positions).then_some(Start {
            design: coarse.design,
            setting: coarse.setting,
            positions,
            scales: coarse.scales,
        })
    }
}
