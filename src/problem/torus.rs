//! Free timing as least squares: each point carries its own position of the linkage.
//!
//! A position is a pair of unit vectors (e_j, u_j), crank and coupler, on the curve |Y_j| = c with
//! Y_j = A + a e_j + b u_j - B. There is no assembly sign in it and nothing singular at a toggle, so every
//! type and both branches are alike. With c_phi = <Y, i a e>, c_w = <Y, i b u>, n2 = c_phi^2 + c_w^2:
//!
//! ```text
//! P   = A + a e + Z u
//! t   = (i a e c_w - i u Z c_phi) / sqrt(n2)                      dP along the position's own curve
//! dP/dx_k = direct_k + (i a e c_phi + i u Z c_w)/n2 h_k           the least-norm return to the curve
//! h   = c dc - <Y, dA - dB + e da + u db>
//! ```
//!
//! The tangents are eliminated point by point in [`crate::solve::levenberg_marquardt`].

use super::design_space::{DESIGN, Design, DesignSpace, SHAPE, Shape};
use super::requirements::{Motion, Requirements, assembly_of};
use super::{Problem, Setting};
use crate::linkage::mobility::linkage_type;
use crate::linkage::{Complex, LinkageType, dot, turned, xy};
use crate::solve::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, PointBlock};

use std::f64::consts::TAU;

/// The positions of all points: (e_j, u_j).
pub type Positions = Vec<[Complex; 2]>;

/// Newton steps that bring a position back to its curve; each squares the miss.
const RETURN_STEPS: usize = 12;
/// A position is on its curve when its miss is below this part of the largest link squared.
const ON_CURVE: f64 = 1e-14;

/// Least squares over the design vector and the points' positions.
#[derive(Clone, Debug)]
pub struct TorusFit<'a> {
    problem: &'a Problem,
    setting: Setting,
    space: DesignSpace,
    requirements: Requirements,
}

impl<'a> TorusFit<'a> {
    /// The fit of a problem in a setting.
    pub fn new(problem: &'a Problem, setting: Setting) -> Self {
        let space = problem.space(setting.side);
        let requirements = problem.requirements(&space);
        TorusFit { problem, setting, space, requirements }
    }

    /// The fit of the positions alone: the design stays at `x`.
    pub fn at(problem: &'a Problem, setting: Setting, x: &Design) -> Self {
        let mut fit = TorusFit::new(problem, setting);
        fit.space.fix(x);
        fit
    }

    /// The design space.
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// The requirements.
    pub fn requirements(&self) -> &Requirements {
        &self.requirements
    }

    /// The motion through the positions: a stretch of crank angle where the input turns fully.
    pub fn motion<'p>(&self, shape: &Shape, positions: &'p Positions) -> Motion<'p> {
        let turns = linkage_type(shape.links()).is_some_and(LinkageType::input_turns_fully);
        let Some([e, u]) = positions.first().filter(|_| turns) else { return Motion::Positions(positions) };
        let assembly = assembly_of(shape, *e, *u);
        let task = self.problem.task();
        if task.closed() || task.repeats_first() {
            return Motion::Stretch(e.arg(), e.arg() + TAU, assembly);
        }
        let total = |direction: f64| -> f64 {
            let step = |w: &[[Complex; 2]]| (direction * (w[1][0] * w[0][0].conj()).arg()).rem_euclid(TAU);
            positions.windows(2).map(step).sum()
        };
        let (forward, backward) = (total(1.0), total(-1.0));
        if forward.min(backward) >= TAU {
            return Motion::Stretch(e.arg(), e.arg() + TAU, assembly);
        }
        if forward <= backward {
            Motion::Stretch(e.arg(), e.arg() + forward, assembly)
        } else {
            Motion::Stretch(e.arg() - backward, e.arg(), assembly)
        }
    }

    /// Brings positions to the curves of a design; `false` where one cannot get there.
    pub fn settle(&self, x: &Design, positions: &mut Positions) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        positions.iter_mut().all(|p| settle(&shape, p))
    }
}

/// The curve's frame at a position: Y, c_phi, c_w.
fn frame(shape: &Shape, [e, u]: [Complex; 2]) -> (Complex, f64, f64) {
    let y = shape.crank_pivot + e * shape.crank + u * shape.coupler - shape.follower_pivot;
    (y, dot(y, turned(e)) * shape.crank, dot(y, turned(u)) * shape.coupler)
}

/// A unit vector turned by a small angle, kept at unit length.
fn turn(z: Complex, angle: f64) -> Complex {
    let turned = z * Complex::new(1.0, angle);
    turned / turned.norm()
}

fn settle(shape: &Shape, position: &mut [Complex; 2]) -> bool {
    let largest = shape.crank.max(shape.coupler).max(shape.follower);
    for _ in 0..RETURN_STEPS {
        let (y, by_e, by_u) = frame(shape, *position);
        let miss = 0.5 * (y.norm_sqr() - shape.follower * shape.follower);
        if miss.abs() <= ON_CURVE * largest * largest {
            return true;
        }
        let n2 = by_e * by_e + by_u * by_u;
        if n2 == 0.0 {
            return false;
        }
        let step = (-miss / n2).clamp(-1.0 / n2.sqrt(), 1.0 / n2.sqrt());
        position[0] = turn(position[0], step * by_e);
        position[1] = turn(position[1], step * by_u);
    }
    let (y, ..) = frame(shape, *position);
    (y.norm_sqr() - shape.follower * shape.follower).abs() <= 16.0 * ON_CURVE * largest * largest
}

impl BlockLeastSquares<DESIGN> for TorusFit<'_> {
    type State = Positions;

    fn points(&self) -> usize {
        self.problem.task().len()
    }

    fn bounds(&self) -> &[(f64, f64); DESIGN] {
        self.space.bounds()
    }

    fn cost(&self, x: &Design, state: &Positions) -> Option<f64> {
        let shape = self.space.shape(x)?;
        let task = self.problem.task();
        let mut cost = 0.0;
        for (([e, u], target), weight) in state.iter().zip(task.points()).zip(task.weights()) {
            let p = shape.crank_pivot + e * shape.crank + u * shape.offset;
            cost += weight * (target - p).norm_sqr();
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &Design, state: &Positions, each: &mut dyn FnMut(&PointBlock<DESIGN>)) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        let task = self.problem.task();
        for ((position, target), weight) in state.iter().zip(task.points()).zip(task.weights()) {
            let [e, u] = *position;
            let (y, by_e, by_u) = frame(&shape, *position);
            let n2 = by_e * by_e + by_u * by_u;
            if n2 == 0.0 {
                return false;
            }
            let (crank_turn, coupler_turn) = (turned(e) * shape.crank, turned(u) * shape.offset);
            let tangent = (crank_turn * by_u - coupler_turn * by_e) / n2.sqrt();
            let back = (crank_turn * by_e + coupler_turn * by_u) / n2;
            let one = Complex::new(1.0, 0.0);
            let i = Complex::new(0.0, 1.0);
            let columns: [Complex; SHAPE] = [
                one - back * y.re,
                i - back * y.im,
                back * y.re,
                back * y.im,
                e - back * dot(y, e),
                -back * dot(y, u),
                back * shape.follower,
                u,
                turned(u),
            ];
            let mut jacobian = [[0.0; DESIGN]; 2];
            for (axis, out) in jacobian.iter_mut().enumerate() {
                let row = columns.map(|z| -if axis == 0 { z.re } else { z.im });
                *out = self.space.pull_back(x, &shape, &row, 0.0);
            }
            let p = shape.crank_pivot + e * shape.crank + u * shape.offset;
            each(&PointBlock { residual: xy(target - p), jacobian, tangent: xy(-tangent), weight: *weight });
        }
        true
    }

    fn retract(
        &self,
        from: &Design,
        state: &Positions,
        tau: &[f64],
        to: &Design,
        out: &mut Positions,
    ) -> bool {
        let (Some(old), Some(new)) = (self.space.shape(from), self.space.shape(to)) else { return false };
        for ((position, &tau), out) in state.iter().zip(tau).zip(out.iter_mut()) {
            let (_, by_e, by_u) = frame(&old, *position);
            let length = (by_e * by_e + by_u * by_u).sqrt();
            if length == 0.0 {
                return false;
            }
            *out = [turn(position[0], tau * by_u / length), turn(position[1], -tau * by_e / length)];
            if !settle(&new, out) {
                return false;
            }
        }
        true
    }

    fn constraints(&self, x: &Design, state: &Positions, each: &mut dyn FnMut(&ConstraintRow<DESIGN>)) {
        let Some(shape) = self.space.shape(x) else { return };
        self.requirements.rows(self.setting.aim, &shape, &self.motion(&shape, state), &mut |row| {
            each(&ConstraintRow {
                value: row.value,
                gradient: self.space.pull_back(x, &shape, &row.shape, 0.0),
            });
        });
    }
}
