//! Prescribed timing as a least-squares problem in the design vector. The residuals are T_j - P(x, phi_j), with phi_j =
//! offset + direction psi_j.
//!
//! The offset is an unknown ([`AngleOffset::Free`]), zero ([`AngleOffset::Fixed`]) or the direction of the
//! ground line ([`AngleOffset::Ground`], which adds its derivative (<i g, dB - dA>)/|AB|).

use super::design_space::{ChainRule, DESIGN, Design, DesignSpace, SHAPE, Shape, unit};
use super::rows::{Motion, Requirements};
use super::torus::Positions;
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::gradient::{Frame, shape_gradient};
use crate::mechanism::{Complex, point, turned, xy};
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::{AngleOffset, Problem, Setting, Timing};
use std::f64::consts::TAU;

/// Least squares over the design vector for prescribed timing.
#[derive(Clone, Debug)]
pub struct TimedFit<'a> {
    problem: &'a Problem,
    setting: Setting,
    space: DesignSpace,
    requirements: Requirements,
    /// The angles direction psi_j, in radians.
    angles: Vec<f64>,
    /// The phases e^{i direction psi_j}.
    phases: Vec<Complex>,
    offset: AngleOffset,
}

impl<'a> TimedFit<'a> {
    /// Creates the fit of a problem in a setting; `None` for free timing.
    pub fn new(problem: &'a Problem, setting: Setting) -> Option<Self> {
        let Timing::Prescribed { crank_angles, offset } = problem.task().timing() else { return None };
        let space = problem.space(setting.side);
        let requirements = problem.requirements(&space);
        Some(TimedFit {
            problem,
            setting,
            space,
            requirements,
            angles: crank_angles.iter().map(|psi| setting.direction * psi).collect(),
            phases: problem.phases(setting.direction),
            offset: *offset,
        })
    }

    /// Returns the design space.
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// Returns the requirements.
    pub fn requirements(&self) -> &Requirements {
        &self.requirements
    }

    /// Returns the angle added to every prescribed one.
    pub fn offset(&self, x: &Design, shape: &Shape) -> f64 {
        match self.offset {
            AngleOffset::Free => self.space.offset(x),
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => (shape.follower_pivot - shape.crank_pivot).arg(),
        }
    }

    /// Returns the crank angles at the points, in radians.
    pub fn crank_angles(&self, x: &Design, shape: &Shape) -> Vec<f64> {
        let offset = self.offset(x, shape);
        self.angles.iter().map(|angle| angle + offset).collect()
    }

    /// Returns the motion between the least and the greatest crank angle; the full turn for a closed target.
    pub fn motion(&self, x: &Design, shape: &Shape) -> Motion<'static> {
        let offset = self.offset(x, shape);
        let low = self.angles.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let high = if self.problem.task().closed() { high.max(low + TAU) } else { high };
        Motion::Stretch(low + offset, high + offset, self.setting.assembly)
    }

    /// Returns the derivative of the ground line's direction by B.
    fn by_ground_angle(shape: &Shape) -> Complex {
        let ground = shape.follower_pivot - shape.crank_pivot;
        turned(unit(ground)) / ground.norm().max(f64::MIN_POSITIVE)
    }

    /// Returns the derivative by the design vector from those by the shape and by the crank angle.
    fn by_design(
        &self,
        rule: &ChainRule,
        mut row: [f64; SHAPE],
        by_crank: f64,
        by_ground_angle: Complex,
    ) -> Design {
        let mut by_offset = 0.0;
        match self.offset {
            AngleOffset::Free => by_offset = by_crank,
            AngleOffset::Fixed => {}
            AngleOffset::Ground => {
                row[0] -= by_crank * by_ground_angle.re;
                row[1] -= by_crank * by_ground_angle.im;
                row[2] += by_crank * by_ground_angle.re;
                row[3] += by_crank * by_ground_angle.im;
            }
        }
        rule.by_design(&row, by_offset)
    }
}

impl BlockLeastSquares<DESIGN> for TimedFit<'_> {
    /// The points have no unknowns of their own: no positions.
    type State = Positions;

    fn points(&self) -> usize {
        self.angles.len()
    }

    fn bounds(&self) -> &[(f64, f64); DESIGN] {
        self.space.bounds()
    }

    fn cost(&self, x: &Design, _: &Positions) -> Option<f64> {
        let shape = self.space.shape(x)?;
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(x, &shape));
        let task = self.problem.task();
        computed(task.len());
        let mut cost = 0.0;
        for ((phase, target), weight) in self.phases.iter().zip(task.points()).zip(task.weights()) {
            let crank = phase * turn;
            let at = kernel.at(crank.re, crank.im);
            // At the toggle itself there is no derivative, and beyond it the loop is open.
            if at.gap.is_nan() || at.gap <= 0.0 {
                return None;
            }
            let (x, y) = (target.re - at.coupler_point[0], target.im - at.coupler_point[1]);
            cost += weight * (x * x + y * y);
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &Design, _: &Positions, each: &mut dyn FnMut(&PointBlock<DESIGN>)) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(x, &shape));
        let task = self.problem.task();
        let (rule, by_ground_angle) = (self.space.chain_rule(x, &shape), Self::by_ground_angle(&shape));
        computed(task.len());
        for ((phase, target), weight) in self.phases.iter().zip(task.points()).zip(task.weights()) {
            let crank = phase * turn;
            let at = kernel.at(crank.re, crank.im);
            let [c, d, p] = [at.crank_pin, at.follower_pin, at.coupler_point].map(point);
            let frame = Frame {
                crank,
                coupler: (d - c) / shape.coupler,
                follower: (d - shape.follower_pivot) / shape.follower,
            };
            let Some(gradient) = shape_gradient(&frame, shape.crank, shape.coupler, shape.offset) else {
                return false;
            };
            let jacobian = [|z: Complex| -z.re, |z: Complex| -z.im].map(|component| {
                let (row, by_crank) = (gradient.shape.map(component), component(gradient.crank_angle));
                self.by_design(&rule, row, by_crank, by_ground_angle)
            });
            let residual = target - p;
            each(&PointBlock { residual: xy(residual), jacobian, tangent: [0.0, 0.0], weight: *weight });
        }
        true
    }

    fn retract(&self, _: &Design, _: &Positions, _: &[f64], _: &Design, _: &mut Positions) -> bool {
        true
    }

    fn constraints(&self, x: &Design, _: &Positions, each: &mut EachConstraint<'_, DESIGN>) {
        let Some(shape) = self.space.shape(x) else { return };
        let (rule, by_ground_angle) = (self.space.chain_rule(x, &shape), Self::by_ground_angle(&shape));
        self.requirements.rows(self.setting.aim, &shape, &self.motion(x, &shape), &mut |row| {
            each(row.value, &|| ConstraintRow {
                value: row.value,
                gradient: self.by_design(&rule, row.shape, row.by_turn(), by_ground_angle),
                own: [None; MOST_OWN],
            });
        });
    }
}
