//! The free numbers of a design in which the population searches move, and what is the same of every fitness of them.

use super::design_space::{DesignSpace, Shape};
use super::fitness::Reading;
use super::rows::{Motion, Requirements};
use super::torus::Positions;
use crate::mechanism::{AssemblyMode, Complex, CouplerSide, LinkageType, cross};
use crate::numbers::optimise::population::PopulationProblem;
use crate::task::{AngleOffset, Problem, Timing};
use std::f64::consts::TAU;

/// A fitness whose genes are the free numbers of a design.
pub trait DesignFitness: PopulationProblem {
    /// Returns the genes with their problem.
    fn genes(&self) -> &Genes<'_>;

    /// Returns the number of positions of the linkage that one evaluation computes.
    fn positions_per_evaluation(&self) -> u64;

    /// Returns the best reading of a design's free numbers.
    fn read(&self, genes: &[f64]) -> Reading;

    /// Returns the positions (e_j, u_j) of the targets for free timing, as in the reading of a shape, with the frame of its body
    /// in a motion; `None` if a target finds no position.
    fn positions(&self, shape: &Shape, frame: f64, reading: &Reading) -> Option<Positions>;
}

/// The free numbers of a problem's designs, on either side of the coupler point.
#[derive(Clone, Debug)]
pub struct Genes<'a> {
    problem: &'a Problem,
    pub(super) spaces: Vec<(CouplerSide, DesignSpace)>,
    pub(super) requirements: Requirements,
    bounds: Vec<(f64, f64)>,
    /// The least and the greatest prescribed angle as written, radians.
    span: (f64, f64),
}

impl<'a> Genes<'a> {
    /// Returns the free numbers of a problem's designs.
    pub(super) fn new(problem: &'a Problem) -> Self {
        let task = problem.task();
        let mut span = (0.0, 0.0);
        if let Timing::Prescribed { crank_angles, .. } = task.timing() {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            span = crank_angles.iter().fold(ends, |(l, h), &a| (l.min(a), h.max(a)));
            if task.closed() {
                span.1 = span.1.max(span.0 + TAU);
            }
        }
        let spaces: Vec<_> = problem.sides().iter().map(|&side| (side, problem.space(side))).collect();
        Genes {
            problem,
            requirements: problem.requirements(&spaces[0].1),
            bounds: spaces[0].1.free_box(),
            spaces,
            span,
        }
    }

    /// Returns the problem.
    pub fn problem(&self) -> &'a Problem {
        self.problem
    }

    /// Returns the bounds of the free numbers.
    pub fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }

    /// Returns the design space of a side of the coupler point.
    pub fn space(&self, side: CouplerSide) -> &DesignSpace {
        self.spaces.iter().find(|(s, _)| *s == side).map_or(&self.spaces[0].1, |(_, space)| space)
    }

    /// Returns the angle added to every prescribed one: `offset` if it is free.
    pub(super) fn angle_offset(&self, offset: f64, shape: &Shape) -> f64 {
        match self.problem.task().timing() {
            Timing::Prescribed { offset: AngleOffset::Free, .. } => offset,
            Timing::Prescribed { offset: AngleOffset::Ground, .. } => {
                (shape.follower_pivot - shape.crank_pivot).arg()
            }
            _ => 0.0,
        }
    }

    /// Returns the motion through the prescribed angles, which run in a direction from `offset`.
    pub(super) fn timed_motion(
        &self,
        direction: f64,
        offset: f64,
        assembly: AssemblyMode,
    ) -> Motion<'static> {
        let ends = (direction * self.span.0 + offset, direction * self.span.1 + offset);
        Motion::Stretch(ends.0.min(ends.1), ends.0.max(ends.1), assembly)
    }
}

/// Returns the arcs of the crank that are read apart: +1 and -1 for those on either side of the ground line of a Grashof
/// linkage with a rocking input, which has a circuit on each; else 0 for all.
pub(super) fn arcs(of: Option<LinkageType>) -> &'static [f64] {
    match of {
        Some(LinkageType::RockerCrank | LinkageType::DoubleRocker) => &[1.0, -1.0],
        _ => &[0.0],
    }
}

/// Returns whether a direction of the crank lies on an arc ([`arcs`]).
pub(super) fn is_on_arc(shape: &Shape, arc: f64, crank: Complex) -> bool {
    arc == 0.0 || cross(shape.follower_pivot - shape.crank_pivot, crank) * arc > 0.0
}
