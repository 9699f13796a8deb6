//! Tests of residuals of any number of rows: the elimination against the full system, fits against line searches.

use super::block::{across_and_along, dot};
use super::system::{Workspace, assemble, bounded_step};
use super::*;
use crate::test_poses::{Limit, Poses, TRUTH, truth_at};
use linkwright_arithmetic::streams::{Stream, stream, uniform};
use nalgebra::{DMatrix, DVector};
use std::array::from_fn;

const N: usize = 3;

/// Blocks that are given, with the gaps from point to point if they have to keep an order.
struct Given<const R: usize> {
    blocks: Vec<PointBlock<N, R>>,
    gaps: Vec<f64>,
}

const ANYWHERE: [(f64, f64); N] = [(f64::NEG_INFINITY, f64::INFINITY); N];

impl<const R: usize> Given<R> {
    fn drawn(draws: &mut Stream, points: usize) -> Self {
        let block = |j| {
            let mut number = || uniform(draws, -1.0, 1.0);
            let mut tangent = from_fn(|_| 2.0 * number());
            if j == 2 {
                tangent = [0.0; R];
            }
            let jacobian = from_fn(|_| from_fn(|_| number()));
            PointBlock { residual: from_fn(|_| 0.1 * number()), jacobian, tangent, weight: 1.5 + number() }
        };
        Given { blocks: (0..points).map(block).collect(), gaps: Vec::new() }
    }
}

impl<const R: usize> BlockLeastSquares<N, R> for Given<R> {
    type State = ();
    fn points(&self) -> usize {
        self.blocks.len()
    }
    fn bounds(&self) -> &[(f64, f64); N] {
        &ANYWHERE
    }
    fn cost(&self, _: &[f64; N], (): &()) -> Option<f64> {
        Some(self.blocks.iter().map(|b| b.weight * dot(&b.residual, &b.residual)).sum())
    }
    fn linearise(&self, _: &[f64; N], (): &(), each: &mut dyn FnMut(&PointBlock<N, R>)) -> bool {
        self.blocks.iter().for_each(each);
        true
    }
    fn retract(&self, _: &[f64; N], (): &(), _: &[f64], _: &[f64; N], (): &mut ()) -> bool {
        true
    }
    fn gaps(&self, _: &[f64; N], (): &(), gaps: &mut Vec<f64>) -> bool {
        gaps.extend(&self.gaps);
        !self.gaps.is_empty()
    }
    fn constraints(&self, _: &[f64; N], (): &(), _: &mut EachConstraint<'_, N>) {}
}

/// The normal equations in (dx, tau) with every own unknown: group k of the points shares the unknown N + k, to which
/// its member j comes by a step of its own first.
fn full_system<const R: usize>(
    blocks: &[PointBlock<N, R>],
    groups: &[Vec<(usize, f64)>],
    residuals: &[[f64; R]],
    nu: f64,
) -> (DMatrix<f64>, DVector<f64>) {
    let size = N + groups.len();
    let (mut matrix, mut gradient) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for (k, group) in groups.iter().enumerate() {
        for &(j, way) in group {
            let (block, w) = (&blocks[j], blocks[j].weight);
            for (axis, residual) in residuals[j].iter().enumerate() {
                let mut row = DVector::zeros(size);
                row.rows_mut(0, N).copy_from_slice(&block.jacobian[axis]);
                row[N + k] = block.tangent[axis];
                matrix += w * &row * row.transpose();
                gradient += w * (residual + block.tangent[axis] * way) * row;
            }
            matrix[(N + k, N + k)] += w * nu;
        }
    }
    (matrix, gradient)
}

/// Eliminates all unknowns but the first N.
fn eliminated(matrix: &DMatrix<f64>, gradient: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let own = matrix.nrows() - N;
    let inverse = matrix.view((N, N), (own, own)).into_owned().try_inverse().expect("it is definite");
    let back = matrix.view((0, N), (N, own)) * inverse;
    (
        matrix.view((0, 0), (N, N)) - &back * matrix.view((N, 0), (own, N)),
        gradient.rows(0, N) - back * gradient.rows(N, own),
    )
}

fn assert_eliminates<const R: usize>(gaps: bool) {
    let (nu, points) = (0.37, 9);
    let mut draws = stream(R as u64, u64::from(gaps));
    let mut problem = Given::<R>::drawn(&mut draws, points);
    if gaps {
        problem.gaps = (0..points).map(|j| if j + 1 == points { 4.0 } else { 0.02 }).collect();
    }
    let at = LmResult {
        x: [0.0; N],
        state: (),
        cost: 0.0,
        violation: 0.0,
        evaluations: 0,
        outcome: LmOutcome::NoStart,
    };
    let penalty = Penalty { rho: 1.0, shift: Vec::new() };
    let mut work = Workspace::new(points);
    let normal = assemble(&problem, &at, &penalty, nu, &mut work).expect("it is finite");
    let pools: Vec<Vec<(usize, f64)>> =
        if gaps { work.order.pools().map(<[_]>::to_vec).collect() } else { Vec::new() };
    assert_eq!(gaps, !pools.is_empty());
    let pooled = |j: &usize| pools.iter().flatten().any(|(member, _)| member == j);
    let mut groups: Vec<Vec<(usize, f64)>> =
        (0..points).filter(|j| !pooled(j)).map(|j| vec![(j, 0.0)]).collect();
    groups.extend(pools.iter().cloned());
    let residuals: Vec<[f64; R]> = problem.blocks.iter().map(|b| b.residual).collect();
    let (matrix, gradient) = full_system(&problem.blocks, &groups, &residuals, nu);
    let (left, right) = eliminated(&matrix, &gradient);
    for i in 0..N {
        assert!(
            (normal.gradient[i] - right[i]).abs() < 1e-12,
            "R = {R}: {} {}",
            normal.gradient[i],
            right[i]
        );
        for k in 0..N {
            assert!((normal.matrix[(i, k)] - left[(i, k)]).abs() < 1e-12, "R = {R}: {i} {k}");
        }
    }
    if gaps {
        return;
    }
    // The step of the full system, and the reduction that it promises without damping of the shared unknowns.
    let dx = bounded_step(&normal.matrix, &normal.gradient, &at.x, &ANYWHERE, 0.0).expect("it is definite");
    let whole = -matrix.clone().cholesky().expect("it is definite").solve(&gradient);
    work.own_steps_after(&dx.into(), nu);
    let after = |axis: usize, j: usize| {
        let block = &problem.blocks[j];
        let by_shared: f64 = (0..N).map(|i| block.jacobian[axis][i] * whole[i]).sum();
        block.residual[axis] + by_shared + block.tangent[axis] * whole[N + j]
    };
    let mut reduction = 0.0;
    for (j, block) in problem.blocks.iter().enumerate() {
        assert!((work.tau[j] - whole[N + j]).abs() < 1e-12 && work.tau[j].abs() < MAX_TAU, "R = {R}: {j}");
        let sum: f64 = (0..R).map(|axis| block.residual[axis].powi(2) - after(axis, j).powi(2)).sum();
        reduction += block.weight * sum;
    }
    assert!((work.promised(&dx.into(), 1.0) - reduction).abs() < 1e-12, "R = {R}");
    // The acceleration: the same system for a second derivative, here of residuals a known way off their lines.
    let bend: Vec<[f64; R]> = (0..points).map(|_| from_fn(|_| uniform(&mut draws, -1.0, 1.0))).collect();
    let ahead: Vec<[f64; R]> = (0..points)
        .map(|j| {
            let line = |axis| {
                let r = problem.blocks[j].residual[axis];
                r + AHEAD * (after(axis, j) - r)
            };
            from_fn(|axis| line(axis) + 0.5 * AHEAD * AHEAD * bend[j][axis])
        })
        .collect();
    let mut measured = Vec::new();
    let half = work.bending(&ahead, &dx.into(), nu, &mut measured);
    let close = |one: &[f64; R], other: &[f64; R]| one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-11);
    assert!(measured.iter().zip(&bend).all(|(one, other)| close(one, other)), "R = {R}");
    let (_, second) = full_system(&problem.blocks, &groups, &bend, nu);
    let (_, right) = eliminated(&matrix, &second);
    assert!((0..N).all(|i| (half[i] - right[i]).abs() < 1e-11), "R = {R}");
    // Bent by half its solution, each own unknown moves by half its part of the whole solution.
    let whole = -0.5 * matrix.cholesky().expect("it is definite").solve(&second);
    let before = work.tau.clone();
    work.bend_own_steps(&from_fn(|i| whole[i]), &measured, nu);
    for (j, before) in before.iter().enumerate() {
        assert!((work.tau[j] - before - whole[N + j]).abs() < 1e-11, "R = {R}: {j}");
    }
}

#[test]
fn eliminated_own_unknowns_leave_the_full_systems_equations() {
    for gaps in [false, true] {
        assert_eliminates::<1>(gaps);
        assert_eliminates::<2>(gaps);
        assert_eliminates::<3>(gaps);
        assert_eliminates::<4>(gaps);
    }
}

/// Checks that the basis of a tangent is orthonormal and ends along it.
fn assert_basis<const R: usize>(t: [f64; R]) {
    let basis = across_and_along(&t, dot(&t, &t));
    for (i, one) in basis.iter().enumerate() {
        for (k, other) in basis.iter().enumerate() {
            let wanted = if i == k { 1.0 } else { 0.0 };
            assert!((dot(one, other) - wanted).abs() < 1e-15, "{t:?}: {i} {k}");
        }
    }
    assert!((dot(&basis[R - 1], &t) - dot(&t, &t).sqrt()).abs() < 1e-15 * dot(&t, &t).sqrt() * 4.0);
}

#[test]
fn a_tangents_basis_is_orthonormal() {
    assert_basis([-3.0]);
    assert_basis([1.0, 0.0]);
    for t in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 5.0], [-3e-9, 1e-9, 2e-9]] {
        assert_basis(t);
    }
    assert_basis([0.3, -0.4, 1.2, -0.1]);
}

#[test]
fn an_inequality_follows_the_eliminated_own_unknowns() {
    let mut draws = stream(3, 0);
    let problem = Given::<3>::drawn(&mut draws, 3);
    let (t, j, nu) = (problem.blocks[1].tangent, problem.blocks[1].jacobian, 0.2);
    let mut own = [None; MOST_OWN];
    (own[0], own[1]) = (Some((1, 0.7)), Some((0, 0.4)));
    let row = ConstraintRow { value: 0.1, gradient: [1.0, 2.0, 3.0], own };
    let kept = row.followed(&problem.blocks, nu, |point| point == 0);
    for (i, (followed, fixed)) in kept.gradient.iter().zip(row.gradient).enumerate() {
        let by_tau = (0..3).map(|axis| t[axis] * j[axis][i]).sum::<f64>() / (dot(&t, &t) + nu);
        assert!((followed - (fixed - 0.7 * by_tau)).abs() < 1e-15);
    }
    assert_eq!(kept.own, [None, Some((0, 0.4)), None, None]);
    assert_eq!(row.followed(&problem.blocks, nu, |_| false).own, [None; MOST_OWN]);
}

fn options() -> LmOptions {
    LmOptions {
        max_steps: 200,
        max_rounds: 1,
        max_evaluations: 1000,
        relative_reduction: 1e-14,
        exact_cost: 0.0,
        feasibility: 1e-9,
        hopeless_cost: f64::INFINITY,
    }
}

#[test]
fn a_fit_of_poses_ends_where_line_searches_do() {
    let problem = Poses::drawn(7, 0.08);
    let (x, state) = problem.start();
    let end = solve(&problem, x, state, &options(), &|| false);
    assert_eq!(end.outcome, LmOutcome::Converged);
    let known = problem.by_line_searches(|x, j, s| problem.squares(x, j, s), |sum, cost| sum + cost);
    assert!((end.cost - known).abs() < 1e-12 * known && known > 1e-4, "{} {known}", end.cost);
    assert!(end.evaluations < 40, "{}", end.evaluations);
}

#[test]
fn poses_without_noise_are_found_exactly_with_all_unknowns_free() {
    let mut problem = Poses::drawn(9, 0.0);
    problem.bounds = [(-3.0, 3.0); 4];
    let exact = LmOptions { exact_cost: 1e-26, ..options() };
    let end = solve(&problem, [0.1, 0.2, 1.4, 0.1], problem.start().1, &exact, &|| false);
    assert_eq!(end.outcome, LmOutcome::Exact, "{end:?}");
    assert!(end.x.iter().zip(TRUTH).all(|(one, other)| (one - other).abs() < 1e-11), "{:?}", end.x);
    assert!(end.state.iter().enumerate().all(|(j, s)| (s - truth_at(j, 9)).abs() < 1e-11));
}

#[test]
fn poses_that_would_pass_each_other_share_an_own_unknown() {
    let mut problem = Poses::drawn(7, 0.02);
    problem.targets.swap(2, 3);
    let (x, state) = problem.start();
    let free = solve(&problem, x, state.clone(), &options(), &|| false);
    assert!(free.state[2] > free.state[3]);
    problem.ordered = true;
    let end = solve(&problem, x, state.clone(), &options(), &|| false);
    assert!(end.cost > free.cost && end.state.is_sorted(), "{:?}", end.state);
    assert!(end.state[3] - end.state[2] < 1e-12, "{:?}", end.state);
    // One own unknown for both is the best that is in order.
    let shared = problem.by_line_searches(
        |x, j, s| match j {
            2 => problem.squares(x, 2, s) + problem.squares(x, 3, s),
            3 => 0.0,
            _ => problem.squares(x, j, s),
        },
        |sum, cost| sum + cost,
    );
    assert!((end.cost - shared).abs() < 1e-10 * shared, "{} {shared}", end.cost);
}

#[test]
fn derivatives_of_three_rows_agree_with_differences_and_a_wrong_row_does_not() {
    let mut problem = Poses::drawn(7, 0.05);
    let (x, state) = problem.start();
    let steps = [1e-6; 4];
    let error = derivative_error(&problem, &x, &state, &steps, 1e-6).expect("all exist");
    assert!(error < 1e-9, "{error}");
    problem.sabotage = 1.01;
    let error = derivative_error(&problem, &x, &state, &steps, 1e-6).expect("all exist");
    assert!(error > 1e-3, "{error}");
}

/// Returns the end of a few steps of a fit without noise, near its exact answer.
fn near_exact(problem: &Poses) -> LmResult<4, Vec<f64>> {
    let few = LmOptions { exact_cost: 1e-8, ..options() };
    let (x, state) = problem.start();
    let end = solve(problem, x, state, &few, &|| false);
    assert!(end.cost > 1e-20 && end.cost < 1e-3, "{}", end.cost);
    end
}

/// The options of a finish: nothing but the last digits is left.
fn last_digits() -> LmOptions {
    LmOptions { exact_cost: 1e-29, ..options() }
}

#[test]
fn a_nearly_exact_fit_is_led_to_its_last_digits() {
    let mut problem = Poses::drawn(9, 0.0);
    problem.bounds = [(-3.0, 3.0); 4];
    let mut end = near_exact(&problem);
    let before = end.evaluations;
    finish(&problem, &mut end, &last_digits(), &|| false);
    assert_eq!(end.outcome, LmOutcome::Exact, "{end:?}");
    assert!(end.x.iter().zip(TRUTH).all(|(one, other)| (one - other).abs() < 1e-13), "{:?}", end.x);
    assert!(end.evaluations - before < 20, "{}", end.evaluations - before);
    // Nothing is left to spend, or the caller stops it: it stays where it is.
    let mut end = near_exact(&problem);
    let (x, spent) = (end.x, LmOptions { max_evaluations: end.evaluations, ..last_digits() });
    finish(&problem, &mut end, &spent, &|| false);
    finish(&problem, &mut end, &last_digits(), &|| true);
    assert_eq!((end.x, end.evaluations), (x, spent.max_evaluations));
}

#[test]
fn a_finish_stays_within_bounds_constraints_and_order() {
    // The exact answer lies beyond a bound.
    let mut problem = Poses::drawn(9, 0.0);
    problem.bounds[2] = (1.1 + 1e-4, 3.0);
    let mut end = near_exact(&problem);
    finish(&problem, &mut end, &last_digits(), &|| false);
    assert!(end.x[2] >= problem.bounds[2].0 && end.cost > 1e-12, "{:?} {}", end.x, end.cost);
    assert_ne!(end.outcome, LmOutcome::Exact);
    // It lies beyond a constraint: x_2 >= 1.1001.
    let mut problem = Poses::drawn(9, 0.0);
    problem.limits = vec![Limit { constant: -1.1001, gradient: [0.0, 0.0, 1.0, 0.0], own: None }];
    let start = [0.3, -0.2, 1.1002, 0.4];
    let state = problem.start().1;
    let cost = problem.cost(&start, &state).expect("it exists");
    let mut end =
        LmResult { x: start, state, cost, violation: 0.0, evaluations: 1, outcome: LmOutcome::Converged };
    finish(&problem, &mut end, &last_digits(), &|| false);
    assert!(
        end.violation <= options().feasibility && end.x[2] >= 1.1001 - options().feasibility,
        "{:?}",
        end.x
    );
    assert!(end.cost <= cost);
    // The exact answer has two points in another order than the one that is kept.
    let mut problem = Poses::drawn(7, 0.0);
    problem.targets.swap(2, 3);
    problem.ordered = true;
    let (x, mut state) = (TRUTH, problem.start().1);
    let middle = 0.5 * (state[2] + state[3]);
    (state[2], state[3]) = (middle - 1e-4, middle + 1e-4);
    let cost = problem.cost(&x, &state).expect("it exists");
    let mut end = LmResult { x, state, cost, violation: 0.0, evaluations: 1, outcome: LmOutcome::Converged };
    finish(&problem, &mut end, &last_digits(), &|| false);
    assert!(end.state.is_sorted() && end.cost <= cost && end.cost > 1e-6, "{:?}", end.state);
}
