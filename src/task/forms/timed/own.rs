//! The crank angles of targets whose crank angle is free although others are prescribed.
//!
//! Such a target has its angle phi_j as an unknown of its own, with the tangent -dP/dphi; the fit has positions then, one a
//! target, of which the timed ones are not used.

use super::TimedFit;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{Complex, point};
use crate::task::forms::design_space::{Design, Shape};
use crate::task::forms::fits::design_of;
use crate::task::forms::rows::Motion;
use crate::task::forms::torus::Positions;
use std::f64::consts::TAU;

/// Samples between two timed targets among which the nearest point to an untimed one is looked for.
pub const ATTACHED: usize = 48;

/// Returns the directions of crank and coupler where the crank lies so.
fn position_at(kernel: &Kernel, crank: Complex) -> [Complex; 2] {
    let at = kernel.at(crank.re, crank.im);
    let coupler = point(at.follower_pin) - point(at.crank_pin);
    [crank, coupler / coupler.norm()]
}

impl<const N: usize, const R: usize> TimedFit<'_, N, R> {
    /// As [`TimedFit::motion`], with the crank angles of the targets that have their own.
    pub(super) fn motion_of(
        &self,
        x: &Design,
        shape: &Shape,
        scale: f64,
        state: &Positions,
    ) -> Motion<'static> {
        let timed = self.motion(x, shape, scale);
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
    pub(super) fn own_crank(&self, j: usize, state: &Positions) -> Option<Complex> {
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
        let position = |j: usize| {
            let at = |angle: f64| {
                let crank = Complex::from_polar(1.0, angle);
                let there = kernel.at(crank.re, crank.im);
                (there.gap > 0.0).then(|| (point(there.coupler_point) - task.points()[j]).norm_sqr())
            };
            if !task.is_untimed(j) {
                return at(angles[j]).map(|_| position_at(&kernel, Complex::from_polar(1.0, angles[j])));
            }
            let [from, to] = task.between_timed(&angles, TAU, j)?;
            let samples = (1..ATTACHED).map(|i| from + (to - from) * i as f64 / ATTACHED as f64);
            let nearest = samples.filter_map(|angle| Some((at(angle)?, angle)));
            let (_, angle) = nearest.min_by(|one, other| one.0.total_cmp(&other.0))?;
            Some(position_at(&kernel, Complex::from_polar(1.0, angle)))
        };
        (0..angles.len()).map(position).collect()
    }

    /// As `BlockLeastSquares::retract`, of targets of which some have their own crank angle.
    pub(super) fn retracted(
        &self,
        state: &Positions,
        tau: &[f64],
        to: &[f64; N],
        out: &mut Positions,
    ) -> bool {
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
}
