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
//! by singular values, with columns scaled to length 1. A step is halved until the cost falls.

use super::block::{across_and_along, column, dot};
use super::system::Workspace;
use super::{BlockLeastSquares, LmOptions, LmOutcome, LmResult, violation};
use crate::damping::{held, moved};
use nalgebra::{DMatrix, DVector};

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
        let Some(dx) = step(problem, result, &mut work) else { return };
        let mut part = 1.0;
        let mut gained = false;
        for _ in 0..HALVINGS {
            let shared = dx.map(|d| part * d);
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

/// Returns the least-norm step of the shared unknowns that are free; `None` if a derivative does not exist.
fn step<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    at: &LmResult<N, P::State>,
    work: &mut Workspace<N, R>,
) -> Option<[f64; N]> {
    work.blocks.clear();
    if !problem.linearise(&at.x, &at.state, &mut |block| work.blocks.push(*block)) {
        return None;
    }
    let mut rows: Vec<([f64; N], f64)> = Vec::with_capacity(R * work.blocks.len());
    for block in &work.blocks {
        let scale = block.weight.sqrt();
        let (t, t_sq) = (block.tangent, block.tangent_sq());
        let axes = if t_sq == 0.0 {
            std::array::from_fn(|i| std::array::from_fn(|k| f64::from(u8::from(i == k))))
        } else {
            across_and_along(&t, t_sq)
        };
        let across = if t_sq == 0.0 { R } else { R - 1 };
        for axis in axes.into_iter().take(across) {
            let axis = axis.map(|component| scale * component);
            let row = std::array::from_fn(|i| column(&axis, &block.jacobian, i));
            rows.push((row, dot(&axis, &block.residual)));
        }
    }
    let gradient = std::array::from_fn(|i| rows.iter().map(|(row, residual)| row[i] * residual).sum());
    let held = held(&at.x, problem.bounds(), &gradient);
    let length = |i: usize| rows.iter().map(|(row, _)| row[i] * row[i]).sum::<f64>().sqrt();
    let free: Vec<(usize, f64)> =
        (0..N).filter(|i| !held[*i]).map(|i| (i, length(i))).filter(|(_, length)| *length > 0.0).collect();
    if free.is_empty() || rows.len() < free.len() {
        return None;
    }
    let matrix = DMatrix::from_fn(rows.len(), free.len(), |j, k| rows[j].0[free[k].0] / free[k].1);
    let right = DVector::from_fn(rows.len(), |j, _| -rows[j].1);
    if matrix.iter().chain(right.iter()).any(|value| !value.is_finite()) {
        return None;
    }
    let svd = matrix.svd(true, true);
    let solved = svd.solve(&right, RANK * svd.singular_values.max()).ok()?;
    let mut dx = [0.0; N];
    for ((i, length), value) in free.into_iter().zip(solved.iter()) {
        dx[i] = value / length;
    }
    Some(dx)
}
