//! The linear system of a step: normal equations with the points' own unknowns eliminated, pools of points that may
//! not pass each other, the geodesic acceleration of a step, and the step inside the bounds.

use super::block::{across_and_along, column, dot};
use super::{AHEAD, BlockLeastSquares, LmResult, MAX_TAU, Penalty, PointBlock};
use crate::damping::held;
use crate::ordered::Ordered;
use linkwright_arithmetic::lane::{F64x8, LANES, Lane};
use nalgebra::{SMatrix, SVector};
use std::array::from_fn;

pub(super) struct Normal<const N: usize> {
    pub(super) matrix: SMatrix<f64, N, N>,
    pub(super) gradient: SVector<f64, N>,
    /// The mean of |t_j|^2 over the points.
    pub(super) tangent_sq: f64,
}

/// The buffers of an inner solve, kept from step to step.
pub(super) struct Workspace<const N: usize, const R: usize> {
    pub(super) blocks: Vec<PointBlock<N, R>>,
    /// The constraints with a penalty, shift - g > 0: (shift - g, dg/dx).
    pub(super) lacking: Vec<(f64, [f64; N])>,
    /// The stiffness of each point, w_j (|t_j|^2 + nu).
    pub(super) stiffness: Vec<f64>,
    /// The steps tau_j of the points' own unknowns.
    pub(super) tau: Vec<f64>,
    pub(super) gaps: Vec<f64>,
    pub(super) order: Ordered,
    rows: Rows<N>,
}

impl<const N: usize, const R: usize> Workspace<N, R> {
    pub(super) fn new(points: usize) -> Self {
        Workspace {
            blocks: Vec::with_capacity(points),
            lacking: Vec::new(),
            stiffness: vec![0.0; points],
            tau: vec![0.0; points],
            gaps: Vec::with_capacity(points),
            order: Ordered::new(points),
            rows: Rows::default(),
        }
    }

    /// Computes each point's own step that is best for its present residual.
    fn own_steps(&mut self, nu: f64) {
        for (j, block) in self.blocks.iter().enumerate() {
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            self.stiffness[j] = block.weight * (t_sq + nu);
            self.tau[j] = if t_sq == 0.0 { 0.0 } else { -dot(&t, &block.residual) / (t_sq + nu) };
        }
    }

    /// Computes each point's own step after a shared step `dx`; pooled points end in one place.
    pub(super) fn own_steps_after(&mut self, dx: &[f64; N], nu: f64) {
        for (j, block) in self.blocks.iter().enumerate() {
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            let moved = from_fn(|axis| block.residual[axis] + change(0.0, &block.jacobian[axis], dx));
            let along = dot(&t, &moved);
            self.tau[j] = if t_sq == 0.0 { 0.0 } else { (-along / (t_sq + nu)).clamp(-MAX_TAU, MAX_TAU) };
        }
        if !self.gaps.is_empty() {
            self.order.pool(&self.gaps, &mut self.tau, &self.stiffness);
        }
    }

    /// Computes the right-hand side of the geodesic acceleration: J^T of the residuals' second derivative along a
    /// step, the points' own unknowns eliminated; `bend` receives that derivative. `ahead` holds the residuals at the
    /// part [`AHEAD`] of the step.
    pub(super) fn bending(
        &self,
        ahead: &[[f64; R]],
        dx: &[f64; N],
        nu: f64,
        bend: &mut Vec<[f64; R]>,
    ) -> SVector<f64, N> {
        let mut gradient = SVector::<f64, N>::zeros();
        bend.clear();
        for ((block, tau), r) in self.blocks.iter().zip(&self.tau).zip(ahead) {
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            let second = from_fn(|axis| {
                let slope = change(t[axis] * tau, &block.jacobian[axis], dx);
                2.0 / AHEAD * ((r[axis] - block.residual[axis]) / AHEAD - slope)
            });
            bend.push(second);
            // The part that the point's own unknown does not take up.
            let taken = if t_sq > 0.0 { dot(&t, &second) / (t_sq + nu) } else { 0.0 };
            for axis in 0..R {
                let left = block.weight * (second[axis] - t[axis] * taken);
                for (sum, by) in gradient.iter_mut().zip(&block.jacobian[axis]) {
                    *sum += left * by;
                }
            }
        }
        gradient
    }

    /// Adds half the geodesic acceleration to the points' own steps.
    pub(super) fn bend_own_steps(&mut self, half: &[f64; N], bend: &[[f64; R]], nu: f64) {
        for ((block, tau), second) in self.blocks.iter().zip(&mut self.tau).zip(bend) {
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            if t_sq == 0.0 {
                continue;
            }
            let moved = from_fn(|axis| change(0.5 * second[axis], &block.jacobian[axis], half));
            let along = dot(&t, &moved);
            *tau = (*tau - along / (t_sq + nu)).clamp(-MAX_TAU, MAX_TAU);
        }
    }

    /// Computes the reduction of the cost and the penalty that the linear model predicts.
    pub(super) fn promised(&self, dx: &[f64; N], rho: f64) -> f64 {
        let mut promised = 0.0;
        for (block, tau) in self.blocks.iter().zip(&self.tau) {
            for axis in 0..R {
                let change = change(block.tangent[axis] * tau, &block.jacobian[axis], dx);
                promised -= block.weight * change * (2.0 * block.residual[axis] + change);
            }
        }
        for (lack, gradient) in &self.lacking {
            let change: f64 = gradient.iter().zip(dx).map(|(by, d)| by * d).sum();
            promised += rho * change * (2.0 * lack - change);
        }
        promised
    }
}

/// Returns `from` plus the scalar product of a row and a step, added in the order of the unknowns.
#[inline(always)]
fn change<const N: usize>(from: f64, row: &[f64; N], dx: &[f64; N]) -> f64 {
    row.iter().zip(dx).fold(from, |sum, (by, d)| sum + by * d)
}

/// Rows of a Jacobian with their residuals, in blocks of [`LANES`] rows, column by column within a block; the last
/// block is padded with zeros.
#[derive(Default)]
pub(super) struct Rows<const N: usize> {
    jacobian: Vec<[F64x8; N]>,
    residual: Vec<F64x8>,
    count: usize,
}

impl<const N: usize> Rows<N> {
    fn clear(&mut self) {
        self.jacobian.clear();
        self.residual.clear();
        self.count = 0;
    }

    #[inline(always)]
    fn push(&mut self, row: impl Fn(usize) -> f64, residual: f64) {
        let lane = self.count % LANES;
        if lane == 0 {
            self.jacobian.push([F64x8::splat(0.0); N]);
            self.residual.push(F64x8::splat(0.0));
        }
        self.count += 1;
        if let (Some(block), Some(residuals)) = (self.jacobian.last_mut(), self.residual.last_mut()) {
            for (i, column) in block.iter_mut().enumerate() {
                column.0[lane] = row(i);
            }
            residuals.0[lane] = residual;
        }
    }

    /// Adds the rows of a point whose own unknown is eliminated: those across its tangent, and the one along it with
    /// the weight that is left.
    #[inline(always)]
    fn push_point<const R: usize>(&mut self, block: &PointBlock<N, R>, nu: f64) {
        let (t, t_sq, r, j) = (block.tangent, block.tangent_sq(), &block.residual, &block.jacobian);
        if t_sq == 0.0 {
            return self.push_all(block, r);
        }
        for (place, axis) in across_and_along(&t, t_sq).into_iter().enumerate() {
            let weight = if place + 1 < R { 1.0 } else { nu / (t_sq + nu) };
            let scale = (block.weight * weight).sqrt();
            let axis = axis.map(|component| scale * component);
            self.push(|i| column(&axis, j, i), dot(&axis, r));
        }
    }

    /// Adds all rows of a point with a residual `r`.
    #[inline(always)]
    fn push_all<const R: usize>(&mut self, block: &PointBlock<N, R>, r: &[f64; R]) {
        let scale = block.weight.sqrt();
        for (row, residual) in block.jacobian.iter().zip(r) {
            self.push(|i| scale * row[i], scale * residual);
        }
    }

    /// Computes J^T J and J^T r. Each sum runs in [`LANES`] lanes on every machine, so its rounding is the same
    /// everywhere.
    #[inline(always)]
    fn squared(&self) -> ([[f64; N]; N], [f64; N]) {
        let mut matrix = [[0.0; N]; N];
        let mut gradient = [0.0; N];
        for i in 0..N {
            for k in i..N {
                let mut sum = F64x8::splat(0.0);
                for block in &self.jacobian {
                    sum = sum + block[i] * block[k];
                }
                matrix[i][k] = sum.0.iter().sum();
                matrix[k][i] = matrix[i][k];
            }
            let mut sum = F64x8::splat(0.0);
            for (block, residual) in self.jacobian.iter().zip(&self.residual) {
                sum = sum + block[i] * *residual;
            }
            gradient[i] = sum.0.iter().sum();
        }
        (matrix, gradient)
    }
}

fn add_row<const N: usize>(
    matrix: &mut [[f64; N]; N],
    gradient: &mut [f64; N],
    weight: f64,
    row: &[f64; N],
    residual: f64,
) {
    for i in 0..N {
        let w = weight * row[i];
        gradient[i] += w * residual;
        for k in 0..N {
            matrix[i][k] += w * row[k];
        }
    }
}

/// The common unknown of a pool in the normal equations, which is eliminated: its diagonal entry, its row, and its
/// right-hand side.
struct Pool<const N: usize> {
    stiffness: f64,
    by_tau: [f64; N],
    along: f64,
}

impl<const N: usize, const R: usize> Workspace<N, R> {
    /// Adds the rows of all pooled points, r_j + t_j m_j + J_j dx + t_j tau with the step m_j to the common place and
    /// one tau for a pool.
    fn push_pools(&mut self) -> Vec<Pool<N>> {
        let mut eliminated = Vec::new();
        for members in self.order.pools() {
            let mut pool = Pool { stiffness: 0.0, by_tau: [0.0; N], along: 0.0 };
            for &(index, way) in members {
                let block = &self.blocks[index];
                let (t, j, w) = (block.tangent, &block.jacobian, block.weight);
                let r = from_fn(|axis| block.residual[axis] + t[axis] * way);
                self.rows.push_all(block, &r);
                for (i, sum) in pool.by_tau.iter_mut().enumerate() {
                    *sum += w * column(&t, j, i);
                }
                pool.along += w * dot(&t, &r);
                pool.stiffness += self.stiffness[index];
            }
            if pool.stiffness > 0.0 {
                eliminated.push(pool);
            }
        }
        eliminated
    }
}

/// Assembles the normal equations at a point; `None` if a derivative does not exist or a number is not finite.
pub(super) fn assemble<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    at: &LmResult<N, P::State>,
    penalty: &Penalty,
    nu: f64,
    work: &mut Workspace<N, R>,
) -> Option<Normal<N>> {
    work.blocks.clear();
    let complete = problem.linearise(&at.x, &at.state, &mut |block| work.blocks.push(*block));
    if !complete {
        return None;
    }
    work.gaps.clear();
    let ordered = problem.gaps(&at.x, &at.state, &mut work.gaps);
    if ordered {
        work.own_steps(nu);
        work.order.pool(&work.gaps, &mut work.tau, &work.stiffness);
    }
    let mut tangent_sum = 0.0;
    work.rows.clear();
    for (index, block) in work.blocks.iter().enumerate() {
        tangent_sum += block.tangent_sq();
        if !ordered || work.order.is_alone(index) {
            work.rows.push_point(block, nu);
        }
    }
    let eliminated = if ordered { work.push_pools() } else { Vec::new() };
    let rows = &work.rows;
    let (mut matrix, mut gradient) = problem.wide(
        #[inline(always)]
        || rows.squared(),
    );
    for pool in &eliminated {
        add_row(&mut matrix, &mut gradient, -1.0 / pool.stiffness, &pool.by_tau, pool.along);
    }
    let mut i = 0;
    work.lacking.clear();
    problem.constraints(&at.x, &at.state, &mut |value, row| {
        let lack = penalty.shift[i] - value;
        i += 1;
        if lack > 0.0 {
            let row = row().followed(&work.blocks, nu, |_| false);
            work.lacking.push((lack, row.gradient));
            add_row(&mut matrix, &mut gradient, penalty.rho, &row.gradient.map(|g| -g), lack);
        }
    });
    // Without a way out of the loop it becomes vector instructions.
    let usable = matrix.iter().flatten().chain(&gradient).fold(true, |all, v| all & v.is_finite());
    usable.then(|| Normal {
        matrix: SMatrix::from_fn(|i, k| matrix[i][k]),
        gradient: SVector::from(gradient),
        tangent_sq: tangent_sum / work.blocks.len().max(1) as f64,
    })
}

/// Computes the damped step inside the bounds: unknowns that a step would push through a bound are put onto it and
/// the rest is solved again, so that the step is the model's minimum on the face that it ends on. `None` if the
/// damped matrix is not positive definite.
pub(super) fn bounded_step<const N: usize>(
    matrix: &SMatrix<f64, N, N>,
    gradient: &SVector<f64, N>,
    x: &[f64; N],
    bounds: &[(f64, f64); N],
    damping: f64,
) -> Option<SVector<f64, N>> {
    let mut damped = *matrix;
    let diagonal_max = (0..N).map(|i| damped[(i, i)]).fold(f64::MIN_POSITIVE, f64::max);
    let mut held = held(x, bounds, &(*gradient).into());
    let mut dx = SVector::<f64, N>::zeros();
    for i in 0..N {
        held[i] |= damped[(i, i)] == 0.0;
        damped[(i, i)] += damping * damped[(i, i)].max(1e-10 * diagonal_max);
    }
    for _ in 0..=N {
        let mut matrix = damped;
        let mut by_held = SVector::<f64, N>::zeros();
        for i in (0..N).filter(|&i| held[i]) {
            by_held += damped.column(i) * dx[i];
        }
        let mut right = -(gradient + by_held);
        for i in (0..N).filter(|&i| held[i]) {
            for k in 0..N {
                matrix[(i, k)] = 0.0;
                matrix[(k, i)] = 0.0;
            }
            matrix[(i, i)] = 1.0;
            right[i] = dx[i];
        }
        dx = matrix.cholesky()?.solve(&right);
        let mut crossed = false;
        for i in 0..N {
            if held[i] {
                continue;
            }
            let (low, high) = bounds[i];
            let to = x[i] + dx[i];
            if to < low || to > high {
                dx[i] = if to < low { low - x[i] } else { high - x[i] };
                held[i] = true;
                crossed = true;
            }
        }
        if !crossed {
            break;
        }
    }
    Some(dx)
}
