//! Prescribed timing as a least-squares problem in the design vector. The residuals are T_j - P(x, phi_j), with phi_j =
//! offset + direction psi_j.
//!
//! The offset is an unknown ([`AngleOffset::Free`]), zero ([`AngleOffset::Fixed`]) or the direction of the
//! ground line ([`AngleOffset::Ground`], which adds its derivative (<i g, dB - dA>)/|AB|).
//!
//! In a motion a target has a third row, the error of the body's angle times the length W that a radian counts like, W
//! (theta_j - arg u_j - beta). The frame beta, the angle from the coupler's direction to the body's x axis, is an unknown
//! behind those of the design. The row is zero for a target without an angle.
//!
//! | module | holds |
//! |---|---|
//! | `output` | the errors of the follower's angle in a function, with its free ranges |
//! | `own` | the crank angles of targets that have their own |

mod output;
mod own;

pub use own::ATTACHED;

use super::design_space::{ChainRule, DESIGN, Design, DesignSpace, SHAPE, Shape};
use super::fits::{design_of, own_frame, own_scales};
use super::rows::{Motion, Place, Requirements, Row};
use super::torus::{ANGLE_ROW, Positions, angle_residual};
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::gradient::{Frame, coupler_gradient, ground_gradient, shape_gradient};
use crate::mechanism::{Complex, point, xy};
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::ranges::Scales;
use crate::task::{AngleOffset, Body, Problem, Setting, Timing};
use std::f64::consts::TAU;

/// Computes the gradient of the ground line's direction by Ax, Ay, Bx and By.
fn by_ground(shape: &Shape) -> [f64; 4] {
    ground_gradient(shape.crank_pivot, shape.follower_pivot)
}

/// The number of unknowns of a motion: the design and the frame of the body.
pub const WITH_FRAME: usize = DESIGN + 1;

/// The number of unknowns of a function with free ranges: the design, the frame and the scales of inputs and outputs.
pub const WITH_SCALES: usize = WITH_FRAME + 2;

/// Least squares over the design vector for prescribed timing, with N unknowns and R rows a target: [`DESIGN`] and 2 of a
/// path, [`WITH_FRAME`] and 3 of a motion.
#[derive(Clone, Debug)]
pub struct TimedFit<'a, const N: usize, const R: usize> {
    problem: &'a Problem,
    setting: Setting,
    space: DesignSpace,
    /// Those of the design and the scales, and of the frame none.
    bounds: [(f64, f64); N],
    requirements: Requirements,
    /// The angles direction psi_j, in radians.
    angles: Vec<f64>,
    /// The phases e^{i direction psi_j}.
    phases: Vec<Complex>,
    offset: AngleOffset,
}

/// The fit of a path.
pub type TimedPathFit<'a> = TimedFit<'a, DESIGN, 2>;
/// The fit of a motion.
pub type TimedMotionFit<'a> = TimedFit<'a, WITH_FRAME, 3>;
/// The fit of a function.
pub type FunctionFit<'a> = TimedFit<'a, WITH_FRAME, 2>;
/// The fit of a function with free ranges.
pub type RangedFit<'a> = TimedFit<'a, WITH_SCALES, 2>;

impl<'a, const N: usize, const R: usize> TimedFit<'a, N, R> {
    /// Creates the fit of a problem in a setting; `None` for free timing.
    pub fn new(problem: &'a Problem, setting: Setting) -> Option<Self> {
        let Timing::Prescribed { crank_angles, offset } = problem.task().timing() else { return None };
        let space = problem.space(setting.side);
        let requirements = problem.requirements(&space);
        let mut bounds = [(f64::NEG_INFINITY, f64::INFINITY); N];
        bounds[..DESIGN].copy_from_slice(space.bounds());
        if let Some(frame) = bounds.get_mut(DESIGN)
            && problem.task().body().and_then(|body| body.given_frame(0.0)).is_some()
        {
            *frame = (0.0, 0.0);
        }
        for (bounds, scale) in bounds.iter_mut().skip(WITH_FRAME).zip(problem.task().ranges().bounds()) {
            *bounds = scale;
        }
        let run = problem.run(setting.direction);
        Some(TimedFit {
            problem,
            setting,
            space,
            bounds,
            requirements,
            angles: crank_angles.iter().map(|psi| run * psi).collect(),
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

    /// Returns the unknowns at a design and scales of a function's ranges; the frame of a body is that of the least errors, 0 if the loop is open at a target or
    /// the frame is no unknown.
    pub fn unknowns(&self, design: &Design, scales: Scales) -> [f64; N] {
        let mut x = [0.0; N];
        x[..DESIGN].copy_from_slice(design);
        if let Some(frame) = x.get_mut(DESIGN) {
            *frame = self.frame_of(design, scales).unwrap_or(0.0);
        }
        for (place, scale) in x.iter_mut().skip(WITH_FRAME).zip(self.problem.task().ranges().nearest(scales))
        {
            *place = scale;
        }
        x
    }

    /// Returns the frame of the body for which the weighted sum of squared angle errors is least.
    fn frame_of(&self, design: &Design, scales: Scales) -> Option<f64> {
        let body = self.problem.task().body().filter(|body| body.given_frame(0.0).is_none())?;
        let sign = self.sign();
        let shape = self.space.shape(design)?;
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(design, &shape));
        let apart = |(j, angle): (usize, &Option<f64>)| {
            let crank = self.phase(j, scales[0]) * turn;
            let at = kernel.at(crank.re, crank.im);
            let joints = [shape.follower_pivot, point(at.crank_pin), point(at.follower_pin)];
            Some(sign * scales[1] * (*angle)? - body.line(joints).arg())
        };
        let apart: Vec<Option<f64>> = body.angles.iter().enumerate().map(apart).collect();
        Some(body.best_frame(&apart, self.problem.task().weights())).filter(|frame| frame.is_finite())
    }

    /// Returns the angle added to every prescribed one.
    pub fn offset(&self, x: &Design, shape: &Shape) -> f64 {
        match self.offset {
            AngleOffset::Free => self.space.offset(x),
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => (shape.follower_pivot - shape.crank_pivot).arg(),
        }
    }

    /// Returns e^{i direction h psi_j} at a scale h of the inputs.
    fn phase(&self, j: usize, scale: f64) -> Complex {
        if N > WITH_FRAME { Complex::from_polar(1.0, scale * self.angles[j]) } else { self.phases[j] }
    }

    /// Returns the crank angles at the points, in radians.
    pub fn crank_angles(&self, x: &Design, shape: &Shape) -> Vec<f64> {
        let offset = self.offset(x, shape);
        self.angles.iter().map(|angle| angle + offset).collect()
    }

    /// Returns the least and the greatest of the angles direction psi_j.
    fn span(&self) -> [f64; 2] {
        let angles = || self.angles.iter().copied();
        [angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Returns the motion between the least and the greatest crank angle, at a scale of the inputs; the full turn for a closed
    /// target.
    pub fn motion(&self, x: &Design, shape: &Shape, scale: f64) -> Motion<'static> {
        let offset = self.offset(x, shape);
        let [low, high] = self.span().map(|angle| scale * angle);
        let high = if self.problem.task().closed() { high.max(low + TAU) } else { high };
        Motion::Stretch(low + offset, high + offset, self.setting.assembly)
    }

    /// Returns the derivative by the design vector from those by the shape and by the crank angle.
    fn by_design(
        &self,
        rule: &ChainRule,
        mut row: [f64; SHAPE],
        by_crank: f64,
        by_ground: [f64; 4],
    ) -> [f64; N] {
        let mut by_offset = 0.0;
        match self.offset {
            AngleOffset::Free => by_offset = by_crank,
            AngleOffset::Fixed => {}
            AngleOffset::Ground => {
                row.iter_mut().zip(by_ground).for_each(|(total, by)| *total += by_crank * by);
            }
        }
        let mut out = [0.0; N];
        out[..DESIGN].copy_from_slice(&rule.by_design(&row, by_offset));
        out
    }

    /// Returns the derivative of a row of a requirement by the scale of the inputs.
    fn by_scale(&self, row: &Row) -> f64 {
        let [low, high] = self.span();
        let at = |place: Place| match place {
            Place::First => low,
            Place::Last => high,
            Place::Anywhere | Place::Position(_) => 0.0,
        };
        row.turns.iter().map(|turn| turn.by * at(turn.place)).sum()
    }

    /// Returns the body of a motion.
    fn body(&self) -> Option<&Body> {
        self.problem.task().body().filter(|_| R > ANGLE_ROW)
    }

    /// Returns the sign of the angles wanted.
    fn sign(&self) -> f64 {
        if self.problem.is_function() { self.setting.direction } else { 1.0 }
    }
}

impl<const N: usize, const R: usize> BlockLeastSquares<N, R> for TimedFit<'_, N, R> {
    /// The positions of partly timed targets; none if all are timed.
    type State = Positions;

    fn points(&self) -> usize {
        self.angles.len()
    }

    fn bounds(&self) -> &[(f64, f64); N] {
        &self.bounds
    }

    fn cost(&self, unknowns: &[f64; N], state: &Positions) -> Option<f64> {
        let x = &design_of(unknowns);
        let shape = self.space.shape(x)?;
        let (task, body) = (self.problem.task(), self.body());
        computed(task.len());
        if let Some(output) = self.output() {
            return self.cost_of_output(output, unknowns, &shape);
        }
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(x, &shape));
        let mut cost = 0.0;
        let targets = self.phases.iter().zip(task.points()).zip(task.weights());
        for (j, ((phase, target), weight)) in targets.enumerate() {
            let crank = self.own_crank(j, state).unwrap_or(phase * turn);
            let at = kernel.at(crank.re, crank.im);
            // At the toggle itself there is no derivative, and beyond it the loop is open.
            if at.gap.is_nan() || at.gap <= 0.0 {
                return None;
            }
            let (x, y) = (target.re - at.coupler_point[0], target.im - at.coupler_point[1]);
            cost += weight * (x * x + y * y);
            if let Some(body) = body {
                let coupler = point(at.follower_pin) - point(at.crank_pin);
                cost += weight * angle_residual(body, j, coupler, unknowns[N - 1]).powi(2);
            }
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(
        &self,
        unknowns: &[f64; N],
        state: &Positions,
        each: &mut dyn FnMut(&PointBlock<N, R>),
    ) -> bool {
        let x = &design_of(unknowns);
        let Some(shape) = self.space.shape(x) else { return false };
        let (task, body) = (self.problem.task(), self.body());
        computed(task.len());
        if let Some(output) = self.output() {
            return self.linearise_output(output, unknowns, &shape, each);
        }
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(x, &shape));
        let (rule, by_ground) = (self.space.chain_rule(x, &shape), by_ground(&shape));
        let targets = self.phases.iter().zip(task.points()).zip(task.weights());
        for (j, ((phase, target), weight)) in targets.enumerate() {
            let own = self.own_crank(j, state);
            let crank = own.unwrap_or(phase * turn);
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
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; N]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            block.residual[..ANGLE_ROW].copy_from_slice(&xy(target - p));
            let components = [|z: Complex| -z.re, |z: Complex| -z.im];
            let common = |by_crank: f64| if own.is_some() { 0.0 } else { by_crank };
            let rows = block.jacobian.iter_mut().zip(&mut block.tangent);
            for ((row, tangent), component) in rows.zip(components) {
                let (by_shape, by_crank) = (gradient.shape.map(component), component(gradient.crank_angle));
                *row = self.by_design(&rule, by_shape, common(by_crank), by_ground);
                *tangent = if own.is_some() { by_crank } else { 0.0 };
            }
            if let Some(body) = body.filter(|body| body.angles[j].is_some()) {
                let Some((by_shape, by_crank)) = coupler_gradient(&frame, shape.crank, shape.coupler) else {
                    return false;
                };
                let weight = body.angle_weight;
                let by_shape = by_shape.map(|by| -weight * by);
                block.residual[ANGLE_ROW] = angle_residual(body, j, frame.coupler, unknowns[N - 1]);
                block.jacobian[ANGLE_ROW] =
                    self.by_design(&rule, by_shape, common(-weight * by_crank), by_ground);
                block.jacobian[ANGLE_ROW][N - 1] = -weight;
                block.tangent[ANGLE_ROW] = if own.is_some() { -weight * by_crank } else { 0.0 };
            }
            each(&block);
        }
        true
    }

    fn retract(
        &self,
        _: &[f64; N],
        state: &Positions,
        tau: &[f64],
        to: &[f64; N],
        out: &mut Positions,
    ) -> bool {
        state.is_empty() || self.retracted(state, tau, to, out)
    }

    fn constraints(&self, unknowns: &[f64; N], state: &Positions, each: &mut EachConstraint<'_, N>) {
        let x = &design_of(unknowns);
        let Some(shape) = self.space.shape(x) else { return };
        let (rule, by_ground) = (self.space.chain_rule(x, &shape), by_ground(&shape));
        let frame = own_frame(unknowns);
        self.requirements.rows(
            self.setting.aim,
            &shape,
            &self.motion_of(x, &shape, own_scales(unknowns)[0], state),
            frame,
            &mut |row| {
                each(row.value, &|| {
                    let mut gradient = self.by_design(&rule, row.shape, row.by_turn(), by_ground);
                    if let Some(by_frame) = gradient.get_mut(DESIGN) {
                        *by_frame = row.by_frame;
                    }
                    if let Some(by_scale) = gradient.get_mut(WITH_FRAME) {
                        *by_scale = self.by_scale(row);
                    }
                    ConstraintRow { value: row.value, gradient, own: [None; MOST_OWN] }
                });
            },
        );
    }
}
