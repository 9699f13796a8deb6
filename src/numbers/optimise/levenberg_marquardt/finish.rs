//! The last digits of a fit that is nearly exact, by Gauss-Newton steps on the Jacobian itself.
//!
//! The normal equations of [`solve`](super::solve) square the condition of the Jacobian: along directions in which the
//! residuals change by less than 1e-8 of what they change in others, their steps are rounding. Here the rows are kept:
//! those of a point across its tangent, scaled by the root of its weight, and the step is the least-norm solution of
//!
//! ```text
//! sqrt(w_j) <n, r_j + J_j dx> = 0,    n normal to t_j
//! ```
//!
//! by singular values, with columns scaled to length 1. Valleys of such fits are narrow and curved: a part p of a step is
//! bent by p^2/2 of its geodesic acceleration, the solution of the same equations with the second derivative of the rows
//! along the step in place of r_j (as in [`solve`](super::solve)), and p is halved until the cost falls.

use super::block::{across_and_along, column, dot};
use super::system::Workspace;
use super::{AHEAD, BlockLeastSquares, LmOptions, LmOutcome, LmResult, violation};
use crate::damping::{held, moved};
use nalgebra::{DMatrix, DVector, Dyn, SVD};
use std::array::from_fn;

/// The most steps, and halvings of one.
const STEPS: usize = 60;
const HALVINGS: usize = 12;
/// Singular values below this part of the largest one are taken as zero.
const RANK: f64 = 1e-14;
/// The part of the cost to which a step has to bring it; otherwise nothing more is to be gained.
const GAIN: f64 = 0.999;

/// Leads a result to its last digits, within the evaluations that the options leave; the constraints and the order of the
/// points stay as they are. For fits whose residuals vanish at their end.
pub fn finish<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    result: &mut LmResult<N, P::State>,
    options: &LmOptions,
    stop: &dyn Fn() -> bool,
) {
    let mut work = Workspace::<N, R>::new(problem.points());
    let mut state = result.state.clone();
    for _ in 0..STEPS {
        let may = result.evaluations < options.max_evaluations && !stop();
        if !may || result.cost <= options.exact_cost {
            break;
        }
        let Some(rows) = Rows::of(problem, result, &mut work) else { return };
        let Some(dx) = rows.step(&rows.residuals) else { return };
        result.evaluations += 1;
        let half_bend = half_bend(problem, result, (&rows, &dx), &mut work, &mut state);
        let mut part = 1.0;
        let mut gained = false;
        for _ in 0..HALVINGS {
            let shared = from_fn(|i| part * (dx[i] + part * half_bend[i]));
            part *= 0.5;
            if result.evaluations >= options.max_evaluations {
                break;
            }
            result.evaluations += 1;
            let x = moved(&result.x, &shared, problem.bounds());
            work.own_steps_after(&shared, 0.0);
            if !problem.retract(&result.x, &result.state, &work.tau, &x, &mut state) {
                continue;
            }
            let in_order =
                !problem.gaps(&x, &state, &mut work.gaps) || work.gaps.iter().all(|gap| *gap >= 0.0);
            work.gaps.clear();
            let Some(cost) = problem.cost(&x, &state).filter(|cost| *cost < result.cost) else { continue };
            let lack = violation(problem, &x, &state);
            if !in_order || lack > result.violation.max(options.feasibility) {
                continue;
            }
            gained = cost <= GAIN * result.cost;
            (result.x, result.cost, result.violation) = (x, cost, lack);
            std::mem::swap(&mut result.state, &mut state);
            break;
        }
        if !gained {
            break;
        }
    }
    if result.cost <= options.exact_cost && result.violation <= options.feasibility {
        result.outcome = LmOutcome::Exact;
    }
}

/// The rows across the tangents at a point, and the singular values of their columns of length 1.
struct Rows<const N: usize, const R: usize> {
    /// The point of each row and its direction there, scaled by the root of the weight.
    axes: Vec<(usize, [f64; R])>,
    residuals: DVector<f64>,
    /// The unknowns that are free, with the lengths of their columns.
    free: Vec<(usize, f64)>,
    svd: SVD<f64, Dyn, Dyn>,
}

impl<const N: usize, const R: usize> Rows<N, R> {
    /// Returns the rows at a result, whose blocks stay in `work`; `None` if a derivative does not exist.
    fn of<P: BlockLeastSquares<N, R>>(
        problem: &P,
        at: &LmResult<N, P::State>,
        work: &mut Workspace<N, R>,
    ) -> Option<Self> {
        work.blocks.clear();
        if !problem.linearise(&at.x, &at.state, &mut |block| work.blocks.push(*block)) {
            return None;
        }
        let mut axes = Vec::with_capacity(R * work.blocks.len());
        for (j, block) in work.blocks.iter().enumerate() {
            let scale = block.weight.sqrt();
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            let (basis, across) = if t_sq == 0.0 {
                (from_fn(|i| from_fn(|k| f64::from(u8::from(i == k)))), R)
            } else {
                (across_and_along(&t, t_sq), R - 1)
            };
            axes.extend(basis.into_iter().take(across).map(|axis| (j, axis.map(|part| scale * part))));
        }
        let row = |(j, axis): &(usize, [f64; R])| -> [f64; N] {
            from_fn(|i| column(axis, &work.blocks[*j].jacobian, i))
        };
        let rows: Vec<[f64; N]> = axes.iter().map(row).collect();
        let residuals = DVector::from_iterator(
            axes.len(),
            axes.iter().map(|(j, axis)| dot(axis, &work.blocks[*j].residual)),
        );
        let gradient =
            from_fn(|i| rows.iter().zip(&residuals).map(|(row, residual)| row[i] * residual).sum());
        let held = held(&at.x, problem.bounds(), &gradient);
        let length = |i: usize| rows.iter().map(|row| row[i] * row[i]).sum::<f64>().sqrt();
        let free: Vec<(usize, f64)> = (0..N)
            .filter(|i| !held[*i])
            .map(|i| (i, length(i)))
            .filter(|(_, length)| *length > 0.0)
            .collect();
        if free.is_empty() || rows.len() < free.len() {
            return None;
        }
        let matrix = DMatrix::from_fn(rows.len(), free.len(), |j, k| rows[j][free[k].0] / free[k].1);
        let is_finite = matrix.iter().chain(&residuals).all(|value| value.is_finite());
        is_finite.then(|| Rows { axes, residuals, free, svd: matrix.svd(true, true) })
    }

    /// Returns the least-norm step after which the linear model of the rows vanishes.
    fn step(&self, residuals: &DVector<f64>) -> Option<[f64; N]> {
        let solved = self.svd.solve(residuals, RANK * self.svd.singular_values.max()).ok()?;
        let mut dx = [0.0; N];
        for ((i, length), value) in self.free.iter().zip(solved.iter()) {
            dx[*i] = -value / length;
        }
        Some(dx)
    }
}

/// Returns half the geodesic acceleration of a step from a result; zero if it does not exist.
fn half_bend<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    at: &LmResult<N, P::State>,
    (rows, dx): (&Rows<N, R>, &[f64; N]),
    work: &mut Workspace<N, R>,
    state: &mut P::State,
) -> [f64; N] {
    let ahead: [f64; N] = from_fn(|i| at.x[i] + AHEAD * dx[i]);
    work.own_steps_after(dx, 0.0);
    let own: Vec<f64> = work.tau.iter().map(|tau| AHEAD * tau).collect();
    let mut residuals = Vec::with_capacity(own.len());
    let is_there = problem.retract(&at.x, &at.state, &own, &ahead, state)
        && problem.residuals(&ahead, state, &mut residuals);
    if !is_there {
        return [0.0; N];
    }
    let mut second = Vec::with_capacity(own.len());
    work.bending(&residuals, dx, 0.0, &mut second);
    let across = rows.axes.iter().map(|(j, axis)| dot(axis, &second[*j]));
    let across = DVector::from_iterator(rows.axes.len(), across);
    let bend = rows.step(&across).filter(|bend| bend.iter().all(|by| by.is_finite()));
    bend.map_or([0.0; N], |bend| bend.map(|by| 0.5 * by))
}
