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
//! A target whose crank angle is free although others are prescribed has that angle phi_j as an unknown of its own, with the
//! tangent -dP/dphi; the fit has positions then, one a target, of which the timed ones are not used.
//!
//! A function has the errors of the follower's angle alone, W (s theta_j - arg v_j - beta), in the first of two rows; the
//! second is zero. Its frame is an unknown too, or the ground line's direction reversed.

use super::design_space::{ChainRule, DESIGN, Design, DesignSpace, SHAPE, Shape, unit};
use super::fits::{design_of, own_frame};
use super::rows::{Motion, Requirements};
use super::torus::{ANGLE_ROW, Positions, angle_residual};
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::gradient::{Frame, coupler_gradient, follower_gradient, shape_gradient};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{Complex, point, turned, xy};
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::{AngleOffset, Body, Problem, Setting, Timing, best_frame};
use std::f64::consts::TAU;

/// Samples between two timed targets among which the nearest point to an untimed one is looked for.
const ATTACHED: usize = 48;

/// Returns the directions of crank and coupler where the crank lies so.
fn position_at(kernel: &Kernel, crank: Complex) -> [Complex; 2] {
    let at = kernel.at(crank.re, crank.im);
    let coupler = point(at.follower_pin) - point(at.crank_pin);
    [crank, coupler / coupler.norm()]
}

/// The number of unknowns of a motion: the design and the frame of the body.
pub const WITH_FRAME: usize = DESIGN + 1;

/// Least squares over the design vector for prescribed timing, with N unknowns and R rows a target: [`DESIGN`] and 2 of a
/// path, [`WITH_FRAME`] and 3 of a motion.
#[derive(Clone, Debug)]
pub struct TimedFit<'a, const N: usize, const R: usize> {
    problem: &'a Problem,
    setting: Setting,
    space: DesignSpace,
    /// Those of the design, and of the frame none.
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

    /// Returns the unknowns at a design; the frame of a body is that of the least errors, 0 if the loop is open at a target or
    /// the frame is no unknown.
    pub fn unknowns(&self, design: &Design) -> [f64; N] {
        let mut x = [0.0; N];
        x[..DESIGN].copy_from_slice(design);
        if let Some(frame) = x.get_mut(DESIGN) {
            *frame = self.frame_of(design).unwrap_or(0.0);
        }
        x
    }

    /// Returns the frame of the body for which the weighted sum of squared angle errors is least.
    fn frame_of(&self, design: &Design) -> Option<f64> {
        let body = self.problem.task().body().filter(|body| body.given_frame(0.0).is_none())?;
        let sign = self.sign();
        let shape = self.space.shape(design)?;
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(design, &shape));
        let apart = |(phase, angle): (&Complex, &Option<f64>)| {
            let crank = phase * turn;
            let at = kernel.at(crank.re, crank.im);
            let joints = [shape.follower_pivot, point(at.crank_pin), point(at.follower_pin)];
            Some(sign * (*angle)? - body.line(joints).arg())
        };
        let apart: Vec<Option<f64>> = self.phases.iter().zip(&body.angles).map(apart).collect();
        Some(best_frame(&apart, self.problem.task().weights())).filter(|frame| frame.is_finite())
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

    /// As [`TimedFit::motion`], with the crank angles of the targets that have their own.
    fn motion_of(&self, x: &Design, shape: &Shape, state: &Positions) -> Motion<'static> {
        let timed = self.motion(x, shape);
        let Motion::Stretch(mut low, mut high, assembly) = timed else { return timed };
        for (j, guess) in self.crank_angles(x, shape).into_iter().enumerate() {
            if let Some(crank) = self.own_crank(j, state) {
                let angle = guess + wrapped(crank.arg() - guess);
                (low, high) = (low.min(angle), high.max(angle));
            }
        }
        Motion::Stretch(low, high.min(low + TAU), assembly)
    }

    /// Returns the direction of the crank at a target that has its own crank angle.
    fn own_crank(&self, j: usize, state: &Positions) -> Option<Complex> {
        let [e, _] = state.get(j).filter(|_| self.problem.task().is_untimed(j))?;
        Some(*e)
    }

    /// Returns the positions at a design, of partly timed targets: those with their own crank angle are at the point that is
    /// nearest between their neighbours; none if all targets are timed. `None` if the loop is open at a target.
    pub fn attached(&self, design: &Design) -> Option<Positions> {
        let task = self.problem.task();
        if !task.is_partly_timed() {
            return Some(Vec::new());
        }
        let shape = self.space.shape(design)?;
        let kernel = shape.kernel(self.setting.assembly);
        let angles = self.crank_angles(design, &shape);
        let n = angles.len();
        // The next timed target in a direction, in steps around the list, and its crank angle on the way there.
        let turn = if angles[n - 1] < angles[0] { -TAU } else { TAU };
        let neighbour = |j: usize, step: isize| {
            (1..=n as isize).find_map(|k| {
                let place = j as isize + step * k;
                let at = place.rem_euclid(n as isize) as usize;
                let turns = place.div_euclid(n as isize) as f64;
                (!task.is_untimed(at)).then(|| angles[at] + turn * turns)
            })
        };
        let position = |j: usize| {
            let at = |angle: f64| {
                let crank = Complex::from_polar(1.0, angle);
                let there = kernel.at(crank.re, crank.im);
                (there.gap > 0.0).then(|| (point(there.coupler_point) - task.points()[j]).norm_sqr())
            };
            if !task.is_untimed(j) {
                return at(angles[j]).map(|_| position_at(&kernel, Complex::from_polar(1.0, angles[j])));
            }
            let (from, to) = (neighbour(j, -1)?, neighbour(j, 1)?);
            let samples = (1..ATTACHED).map(|i| from + (to - from) * i as f64 / ATTACHED as f64);
            let nearest = samples.filter_map(|angle| Some((at(angle)?, angle)));
            let (_, angle) = nearest.min_by(|one, other| one.0.total_cmp(&other.0))?;
            Some(position_at(&kernel, Complex::from_polar(1.0, angle)))
        };
        (0..n).map(position).collect()
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
    ) -> [f64; N] {
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
        let mut out = [0.0; N];
        out[..DESIGN].copy_from_slice(&rule.by_design(&row, by_offset));
        out
    }

    /// Returns the body of a motion.
    fn body(&self) -> Option<&Body> {
        self.problem.task().body().filter(|_| R > ANGLE_ROW)
    }

    /// Returns the outputs of a function.
    fn output(&self) -> Option<&Body> {
        self.problem.task().body().filter(|_| self.problem.is_function())
    }

    /// Returns the sign of the angles wanted.
    fn sign(&self) -> f64 {
        if self.problem.is_function() { self.setting.direction } else { 1.0 }
    }

    /// Returns W (s theta_j - arg v - beta) of a target of a function, the angle within half a turn; `ground` is the
    /// direction of the ground line.
    fn output_residual(&self, output: &Body, j: usize, follower: Complex, beta: f64, ground: f64) -> f64 {
        let beta = output.given_frame(ground).unwrap_or(beta);
        let error = |angle: f64| wrapped(self.sign() * angle - follower.arg() - beta);
        output.angles[j].map_or(0.0, |angle| output.angle_weight * error(angle))
    }

    /// As [`BlockLeastSquares::cost`], of a function.
    fn cost_of_output(&self, output: &Body, unknowns: &[f64; N], shape: &Shape) -> Option<f64> {
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(&design_of(unknowns), shape));
        let ground = (shape.follower_pivot - shape.crank_pivot).arg();
        let mut cost = 0.0;
        for (j, (phase, weight)) in self.phases.iter().zip(self.problem.task().weights()).enumerate() {
            let crank = phase * turn;
            let at = kernel.at(crank.re, crank.im);
            if at.gap.is_nan() || at.gap <= 0.0 {
                return None;
            }
            let follower = point(at.follower_pin) - shape.follower_pivot;
            cost += weight * self.output_residual(output, j, follower, unknowns[N - 1], ground).powi(2);
        }
        cost.is_finite().then_some(cost)
    }

    /// As [`BlockLeastSquares::linearise`], of a function.
    fn linearise_output(
        &self,
        output: &Body,
        unknowns: &[f64; N],
        shape: &Shape,
        each: &mut dyn FnMut(&PointBlock<N, R>),
    ) -> bool {
        let x = &design_of(unknowns);
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(x, shape));
        let ground = (shape.follower_pivot - shape.crank_pivot).arg();
        let (rule, by_ground_angle) = (self.space.chain_rule(x, shape), Self::by_ground_angle(shape));
        let counts_from_ground = output.given_frame(0.0).is_some();
        for (j, (phase, weight)) in self.phases.iter().zip(self.problem.task().weights()).enumerate() {
            let crank = phase * turn;
            let at = kernel.at(crank.re, crank.im);
            let [c, d] = [at.crank_pin, at.follower_pin].map(point);
            let frame = Frame {
                crank,
                coupler: (d - c) / shape.coupler,
                follower: (d - shape.follower_pivot) / shape.follower,
            };
            let Some((mut by_shape, by_crank)) = follower_gradient(&frame, shape.crank, shape.follower)
            else {
                return false;
            };
            if counts_from_ground {
                // The error is s theta - (arg v - gamma), and the ground's direction gamma moves with A and B.
                let by = [-by_ground_angle.re, -by_ground_angle.im, by_ground_angle.re, by_ground_angle.im];
                by_shape.iter_mut().zip(by).for_each(|(total, by)| *total -= by);
            }
            let length = output.angle_weight;
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; N]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            block.residual[0] = self.output_residual(output, j, frame.follower, unknowns[N - 1], ground);
            block.jacobian[0] =
                self.by_design(&rule, by_shape.map(|by| -length * by), -length * by_crank, by_ground_angle);
            if !counts_from_ground {
                block.jacobian[0][N - 1] = -length;
            }
            each(&block);
        }
        true
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
        let (rule, by_ground_angle) = (self.space.chain_rule(x, &shape), Self::by_ground_angle(&shape));
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
                *row = self.by_design(&rule, by_shape, common(by_crank), by_ground_angle);
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
                    self.by_design(&rule, by_shape, common(-weight * by_crank), by_ground_angle);
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
        if state.is_empty() {
            return true;
        }
        let Some(shape) = self.space.shape(&design_of(to)) else { return false };
        let kernel = shape.kernel(self.setting.assembly);
        for (j, (position, [e, u])) in out.iter_mut().zip(state).enumerate() {
            *position = [*e, *u];
            if self.problem.task().is_untimed(j) {
                *position = position_at(&kernel, e * Complex::from_polar(1.0, tau[j]));
            }
        }
        true
    }

    fn constraints(&self, unknowns: &[f64; N], state: &Positions, each: &mut EachConstraint<'_, N>) {
        let x = &design_of(unknowns);
        let Some(shape) = self.space.shape(x) else { return };
        let (rule, by_ground_angle) = (self.space.chain_rule(x, &shape), Self::by_ground_angle(&shape));
        let frame = own_frame(unknowns);
        self.requirements.rows(
            self.setting.aim,
            &shape,
            &self.motion_of(x, &shape, state),
            frame,
            &mut |row| {
                each(row.value, &|| {
                    let mut gradient = self.by_design(&rule, row.shape, row.by_turn(), by_ground_angle);
                    if let Some(by_frame) = gradient.get_mut(DESIGN) {
                        *by_frame = row.by_frame;
                    }
                    ConstraintRow { value: row.value, gradient, own: [None; MOST_OWN] }
                });
            },
        );
    }
}
