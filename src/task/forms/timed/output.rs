//! The errors of the follower's angle in a function.
//!
//! They are W (s k theta_j - arg v_j - beta) / k, in the first of two rows; the second is zero. The frame beta is an unknown as
//! in a motion, or the ground line's direction reversed. The scale k of the outputs and the scale h of the inputs, at which
//! the crank is at h psi_j, are 1, or unknowns too if their range is free; the derivative by k is (W s theta_j - row) / k.

use super::TimedFit;
use crate::mechanism::four_bar::gradient::{Frame, follower_gradient};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, point};
use crate::numbers::optimise::levenberg_marquardt::PointBlock;
use crate::task::Body;
use crate::task::forms::design_space::{DESIGN, Shape};
use crate::task::forms::fits::{design_of, own_scales};
use crate::task::forms::timed::WITH_FRAME;

impl<const N: usize, const R: usize> TimedFit<'_, N, R> {
    /// Returns the outputs of a function.
    pub(super) fn output(&self) -> Option<&Body> {
        self.problem.task().body().filter(|_| self.problem.is_function())
    }

    /// Returns W (s k theta_j - arg v - beta) / k of a target of a function, the angle within half a turn; `ground` is the
    /// direction of the ground line.
    fn output_residual(
        &self,
        output: &Body,
        j: usize,
        follower: Complex,
        (beta, k): (f64, f64),
        ground: f64,
    ) -> f64 {
        let beta = output.given_frame(ground).unwrap_or(beta);
        let error = |angle: f64| wrapped(self.sign() * k * angle - follower.arg() - beta) / k;
        output.angles[j].map_or(0.0, |angle| output.angle_weight * error(angle))
    }

    /// As `BlockLeastSquares::cost`, of a function.
    pub(super) fn cost_of_output(&self, output: &Body, unknowns: &[f64; N], shape: &Shape) -> Option<f64> {
        let kernel = shape.kernel(self.setting.assembly);
        let turn = Complex::from_polar(1.0, self.offset(&design_of(unknowns), shape));
        let ground = (shape.follower_pivot - shape.crank_pivot).arg();
        let mut cost = 0.0;
        let [h, k] = own_scales(unknowns);
        for (j, weight) in self.problem.task().weights().iter().enumerate() {
            let crank = self.phase(j, h) * turn;
            let at = kernel.at(crank.re, crank.im);
            if at.gap.is_nan() || at.gap <= 0.0 {
                return None;
            }
            let follower = point(at.follower_pin) - shape.follower_pivot;
            cost += weight * self.output_residual(output, j, follower, (unknowns[DESIGN], k), ground).powi(2);
        }
        cost.is_finite().then_some(cost)
    }

    /// As `BlockLeastSquares::linearise`, of a function.
    pub(super) fn linearise_output(
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
        let (rule, by_ground) = (self.space.chain_rule(x, shape), super::by_ground(shape));
        let counts_from_ground = output.given_frame(0.0).is_some();
        let [h, k] = own_scales(unknowns);
        for (j, weight) in self.problem.task().weights().iter().enumerate() {
            let crank = self.phase(j, h) * turn;
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
                by_shape.iter_mut().zip(by_ground).for_each(|(total, by)| *total -= by);
            }
            let length = output.angle_weight / k;
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; N]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            block.residual[0] =
                self.output_residual(output, j, frame.follower, (unknowns[DESIGN], k), ground);
            block.jacobian[0] =
                self.by_design(&rule, by_shape.map(|by| -length * by), -length * by_crank, by_ground);
            if !counts_from_ground {
                block.jacobian[0][DESIGN] = -length;
            }
            if let Some([by_h, by_k]) = block.jacobian[0].get_mut(WITH_FRAME..) {
                *by_h = -length * by_crank * self.angles[j];
                let wanted = output.angle_weight * self.sign() * output.angles[j].unwrap_or(0.0);
                *by_k = (wanted - block.residual[0]) / k;
            }
            each(&block);
        }
        true
    }
}
