//! The check of a problem's derivatives by central differences.

use super::{BlockLeastSquares, ConstraintRow, PointBlock};

/// The blocks and constraint rows of a problem at a point.
type Linearised<const N: usize, const R: usize> = (Vec<PointBlock<N, R>>, Vec<ConstraintRow<N>>);

/// Collects the blocks and constraint rows of a problem at a point; `None` if a derivative does not exist.
fn linearised<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
) -> Option<Linearised<N, R>> {
    let (mut blocks, mut rows) = (Vec::new(), Vec::new());
    let complete = problem.linearise(x, state, &mut |block| blocks.push(*block));
    problem.constraints(x, state, &mut |_, row| rows.push(row()));
    complete.then_some((blocks, rows))
}

/// Compares the derivatives of a problem with central differences: returns the largest |analytic - difference| /
/// (1 + |analytic|) over all residuals and constraints (by x and along the tangents).
///
/// `steps` gives the difference's step for each shared unknown, 0 leaves it out; `along` is the step of the points'
/// own unknowns. `None` if a neighbouring point cannot be evaluated. Correct derivatives leave only the error of the
/// differences: the square of the step times the third derivative, and rounding over the step.
pub fn derivative_error<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
    steps: &[f64; N],
    along: f64,
) -> Option<f64> {
    let (blocks, rows) = linearised(problem, x, state)?;
    let at = |to: &[f64; N], along: f64| {
        let (tau, mut moved) = (vec![along; problem.points()], state.clone());
        problem.retract(x, state, &tau, to, &mut moved).then(|| linearised(problem, to, &moved))?
    };
    let mut worst: f64 = 0.0;
    // Compares the derivatives in one direction with the change from a step backwards to one forwards.
    let mut compare = |neighbours: [Option<Linearised<N, R>>; 2],
                       step: f64,
                       of_block: &dyn Fn(&PointBlock<N, R>) -> [f64; R],
                       of_row: &dyn Fn(&ConstraintRow<N>) -> f64| {
        let [Some((ahead, rows_ahead)), Some((behind, rows_behind))] = neighbours else { return None };
        let mut note = |analytic: f64, change: f64| {
            worst = worst.max((analytic - change / (2.0 * step)).abs() / (1.0 + analytic.abs()));
        };
        for (block, (u, d)) in blocks.iter().zip(ahead.iter().zip(&behind)) {
            (0..R).for_each(|axis| note(of_block(block)[axis], u.residual[axis] - d.residual[axis]));
        }
        for (row, (u, d)) in rows.iter().zip(rows_ahead.iter().zip(&rows_behind)) {
            note(of_row(row), u.value - d.value);
        }
        Some(())
    };
    for i in (0..N).filter(|&i| steps[i] != 0.0) {
        let neighbours = [steps[i], -steps[i]].map(|step| {
            let mut to = *x;
            to[i] += step;
            at(&to, 0.0)
        });
        compare(neighbours, steps[i], &|block| block.jacobian.map(|row| row[i]), &|row| row.gradient[i])?;
    }
    if blocks.iter().any(|block| block.tangent != [0.0; R]) {
        let own = |row: &ConstraintRow<N>| row.own.iter().flatten().fold(0.0, |sum, (_, by)| sum + by);
        compare([at(x, along), at(x, -along)], along, &|block| block.tangent, &own)?;
    }
    Some(worst)
}
