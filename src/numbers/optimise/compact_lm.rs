//! Bounded Levenberg-Marquardt for a handful of unknowns: fixed-size arrays, no allocation.
//!
//! minimise  |r(x)|^2   subject to  lo <= x <= hi,   x in R^N with N small
//!
//! A problem gives its cost at a point and then, at that same point, J^T J and J^T r. How it computes them
//! (eliminating linear unknowns, over thousands of rows) is left to the problem. A step solves
//! (J^T J + lambda D) dx = -J^T r with D the diagonal of J^T J and Nielsen's damping lambda ([`super::damping`]). An
//! unknown that is at a bound and would cross it is held there.

use super::damping::{Damping, clamped, held, moved};

/// The normal equations: J^T J and J^T r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal<const N: usize> {
    /// J^T J, symmetric.
    pub matrix: [[f64; N]; N],
    /// J^T r: half the gradient of the cost.
    pub gradient: [f64; N],
}

/// A least-squares problem in a few unknowns.
pub trait CompactLeastSquares<const N: usize> {
    /// Computes the cost |r(x)|^2; `None` if it does not exist.
    fn cost(&mut self, x: &[f64; N]) -> Option<f64>;

    /// Computes J^T J and J^T r at the point of the last call of `cost`.
    fn normal(&mut self) -> Normal<N>;
}

/// The stopping criteria of [`solve`].
#[derive(Clone, Copy, Debug)]
pub struct CompactOptions {
    /// The largest number of evaluations of the cost; at least one is made.
    pub max_evaluations: u32,
    /// The relative reduction for convergence: two accepted steps in a row each reduce the cost by less than this
    /// part, or the model predicts for a step less than 1e-3 of it.
    pub relative_reduction: f64,
    /// The cost at which a solve has converged.
    pub exact_cost: f64,
    /// The cost that has to be reached within [`CompactOptions::patience`] evaluations; otherwise the solve is given
    /// up.
    pub hopeless_cost: f64,
    /// The number of evaluations from which `hopeless_cost` is checked.
    pub patience: u32,
}

/// The reason for which a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompactOutcome {
    /// Convergence: steps hardly reduce the cost, or it is at most `exact_cost`.
    Converged,
    /// The evaluations are used up.
    EvaluationLimit,
    /// The cost was above `hopeless_cost` after `patience` evaluations.
    Hopeless,
    /// No step is accepted although the predicted reductions are not negligible: the damping has reached its limit.
    Stalled,
    /// The caller's `stop` ended the solve.
    Stopped,
    /// The cost does not exist at the start.
    NoStart,
}

/// The result of a solve.
#[derive(Clone, Copy, Debug)]
pub struct CompactResult<const N: usize> {
    /// The best point.
    pub x: [f64; N],
    /// The cost at `x`; infinite if the start has none.
    pub cost: f64,
    /// The number of evaluations of the cost.
    pub evaluations: u32,
    /// The reason for which it ended.
    pub outcome: CompactOutcome,
}

/// The largest damping; beyond it a step is below rounding.
const LAST_DAMPING: f64 = 1e12;
/// The number of steps in a row with hardly any reduction after which a solve counts as converged.
const QUIET_STEPS: u32 = 2;

/// Minimises the cost by Levenberg-Marquardt from a start, which is clamped to its bounds. Equal bounds fix an
/// unknown. `stop` is called before each evaluation of the cost but the first.
pub fn solve<const N: usize, P: CompactLeastSquares<N>>(
    problem: &mut P,
    start: [f64; N],
    bounds: &[(f64, f64); N],
    options: &CompactOptions,
    stop: &dyn Fn() -> bool,
) -> CompactResult<N> {
    let x = clamped(start, bounds);
    let mut result =
        CompactResult { x, cost: f64::INFINITY, evaluations: 1, outcome: CompactOutcome::NoStart };
    if let Some(cost) = problem.cost(&x) {
        result.cost = cost;
        result.outcome = iterate(problem, &mut result, bounds, options, stop);
    }
    result
}

fn iterate<const N: usize, P: CompactLeastSquares<N>>(
    problem: &mut P,
    result: &mut CompactResult<N>,
    bounds: &[(f64, f64); N],
    options: &CompactOptions,
    stop: &dyn Fn() -> bool,
) -> CompactOutcome {
    let (mut damping, mut quiet) = (Damping::up_to(LAST_DAMPING), 0);
    let mut normal = problem.normal();
    loop {
        if result.cost <= options.exact_cost {
            return CompactOutcome::Converged;
        }
        if result.evaluations >= options.max_evaluations {
            return CompactOutcome::EvaluationLimit;
        }
        if result.evaluations >= options.patience && result.cost > options.hopeless_cost {
            return CompactOutcome::Hopeless;
        }
        if stop() {
            return CompactOutcome::Stopped;
        }
        let Some((trial, promised)) = step(&normal, &result.x, bounds, damping.value) else {
            if damping.raise() {
                return CompactOutcome::Stalled;
            }
            continue;
        };
        if promised <= 1e-3 * options.relative_reduction * result.cost {
            return CompactOutcome::Converged;
        }
        result.evaluations += 1;
        match problem.cost(&trial) {
            Some(cost) if cost < result.cost => {
                let reduction = result.cost - cost;
                (result.x, result.cost) = (trial, cost);
                damping.accept(reduction / promised);
                quiet = if reduction <= options.relative_reduction * cost { quiet + 1 } else { 0 };
                if quiet >= QUIET_STEPS {
                    return CompactOutcome::Converged;
                }
                normal = problem.normal();
            }
            _ if damping.raise() => return CompactOutcome::Stalled,
            _ => {}
        }
    }
}

/// Computes the end of the damped step, inside the bounds, and the reduction of the cost that the linear model
/// predicts for it; `None` if the damped matrix is not positive definite.
fn step<const N: usize>(
    normal: &Normal<N>,
    x: &[f64; N],
    bounds: &[(f64, f64); N],
    damping: f64,
) -> Option<([f64; N], f64)> {
    let largest = (0..N).map(|i| normal.matrix[i][i]).fold(f64::MIN_POSITIVE, f64::max);
    let held = held(x, bounds, &normal.gradient);
    let mut matrix = normal.matrix;
    let mut dx = normal.gradient.map(|g| -g);
    for i in 0..N {
        if held[i] {
            matrix[i] = [0.0; N];
            matrix.iter_mut().for_each(|row| row[i] = 0.0);
            matrix[i][i] = 1.0;
            dx[i] = 0.0;
        } else {
            matrix[i][i] += damping * matrix[i][i].max(1e-12 * largest);
        }
    }
    solve_positive(&mut matrix, &mut dx)?;
    let to = moved(x, &dx, bounds);
    let dx: [f64; N] = std::array::from_fn(|i| to[i] - x[i]);
    // |r|^2 - |r + J dx|^2
    let mut promised = 0.0;
    for i in 0..N {
        let product: f64 = (0..N).map(|k| normal.matrix[i][k] * dx[k]).sum();
        promised -= dx[i] * (2.0 * normal.gradient[i] + product);
    }
    promised.is_finite().then_some((to, promised))
}

/// Solves a symmetric positive definite system in place by Cholesky factorisation; `None` if it is not positive
/// definite.
#[expect(clippy::needless_range_loop, reason = "two rows of the matrix at once")]
pub fn solve_positive<const N: usize>(matrix: &mut [[f64; N]; N], right: &mut [f64; N]) -> Option<()> {
    for i in 0..N {
        for k in 0..=i {
            let mut sum = matrix[i][k];
            for m in 0..k {
                sum -= matrix[i][m] * matrix[k][m];
            }
            if i == k {
                if sum.is_nan() || sum <= 0.0 {
                    return None;
                }
                matrix[i][i] = sum.sqrt();
            } else {
                matrix[i][k] = sum / matrix[k][k];
            }
        }
    }
    for i in 0..N {
        for k in 0..i {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            right[i] -= matrix[k][i] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley: r = (10 (y - x^2), 1 - x).
    struct Valley([f64; 2]);

    impl CompactLeastSquares<2> for Valley {
        fn cost(&mut self, x: &[f64; 2]) -> Option<f64> {
            self.0 = *x;
            let r = [10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]];
            // Undefined left of -1.5, as a linkage that does not close.
            (x[0] > -1.5).then_some(r[0] * r[0] + r[1] * r[1])
        }

        fn normal(&mut self) -> Normal<2> {
            let [x, y] = self.0;
            let r = [10.0 * (y - x * x), 1.0 - x];
            let j = [[-20.0 * x, 10.0], [-1.0, 0.0]];
            let mut normal = Normal { matrix: [[0.0; 2]; 2], gradient: [0.0; 2] };
            for i in 0..2 {
                normal.gradient[i] = j[0][i] * r[0] + j[1][i] * r[1];
                for k in 0..2 {
                    normal.matrix[i][k] = j[0][i] * j[0][k] + j[1][i] * j[1][k];
                }
            }
            normal
        }
    }

    const OPTIONS: CompactOptions = CompactOptions {
        max_evaluations: 200,
        relative_reduction: 1e-14,
        exact_cost: 0.0,
        hopeless_cost: f64::INFINITY,
        patience: 0,
    };
    const WIDE: [(f64, f64); 2] = [(-10.0, 10.0); 2];

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        let end = solve(&mut Valley([0.0; 2]), [-1.2, 1.0], &WIDE, &OPTIONS, &|| false);
        assert_eq!(end.outcome, CompactOutcome::Converged);
        assert!((end.x[0] - 1.0).abs() < 1e-9 && (end.x[1] - 1.0).abs() < 1e-9, "{end:?}");
        assert!(end.evaluations < 60, "{}", end.evaluations);
    }

    #[test]
    fn a_bound_that_binds_is_kept_and_the_rest_is_minimised_on_it() {
        let end =
            solve(&mut Valley([0.0; 2]), [-1.2, 1.0], &[(-2.0, 0.5), (-10.0, 10.0)], &OPTIONS, &|| false);
        assert_eq!(end.x[0], 0.5);
        assert!((end.x[1] - 0.25).abs() < 1e-9 && (end.cost - 0.25).abs() < 1e-9, "{end:?}");
        let fixed =
            solve(&mut Valley([0.0; 2]), [0.0, 7.0], &[(2.0, 2.0), (-10.0, 10.0)], &OPTIONS, &|| false);
        assert_eq!(fixed.x[0], 2.0, "equal bounds fix an unknown, whatever the start says");
        assert!((fixed.x[1] - 4.0).abs() < 1e-9);
    }

    #[test]
    fn a_stop_ends_a_solve_with_its_best_so_far() {
        let asked = std::cell::Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) >= 3;
        let start = [-1.2, 1.0];
        let before = Valley([0.0; 2]).cost(&start).expect("a cost");
        let end = solve(&mut Valley([0.0; 2]), start, &WIDE, &OPTIONS, &stop);
        assert_eq!(end.outcome, CompactOutcome::Stopped);
        assert!(end.evaluations <= 4 && end.cost < before, "{end:?}");
    }

    /// A cost whose derivative points the wrong way: every step makes it worse.
    struct Misled;

    impl CompactLeastSquares<1> for Misled {
        fn cost(&mut self, x: &[f64; 1]) -> Option<f64> {
            Some(1.0 + x[0] * x[0])
        }

        fn normal(&mut self) -> Normal<1> {
            Normal { matrix: [[1.0]], gradient: [-1.0] }
        }
    }

    #[test]
    fn a_solve_that_no_step_leads_on_from_has_stalled_and_not_converged() {
        let options = CompactOptions { relative_reduction: 0.0, ..OPTIONS };
        let end = solve(&mut Misled, [0.0], &[(-1.0, 1.0)], &options, &|| false);
        assert_eq!(end.outcome, CompactOutcome::Stalled, "{end:?}");
    }

    #[test]
    fn limits_end_a_solve_and_say_so() {
        let short = CompactOptions { max_evaluations: 5, ..OPTIONS };
        let end = solve(&mut Valley([0.0; 2]), [-1.2, 1.0], &WIDE, &short, &|| false);
        assert_eq!((end.outcome, end.evaluations), (CompactOutcome::EvaluationLimit, 5));
        let strict = CompactOptions { hopeless_cost: 1e-9, patience: 4, ..OPTIONS };
        let end = solve(&mut Valley([0.0; 2]), [-1.2, 1.0], &WIDE, &strict, &|| false);
        assert_eq!((end.outcome, end.evaluations), (CompactOutcome::Hopeless, 4));
        let end = solve(&mut Valley([0.0; 2]), [-1.6, 1.0], &WIDE, &OPTIONS, &|| false);
        assert_eq!(end.outcome, CompactOutcome::NoStart);
        assert!(end.cost.is_infinite());
    }
}
