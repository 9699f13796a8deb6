//! Local dimension of the set of exact answers: detects whether an exact answer belongs to a family.
//!
//! At an exact answer x the points' residuals are r(x) = 0, and if their derivative J by the free unknowns has rank k <
//! m, the answer moves on a manifold of dimension m - k (locally, at a regular point) on which all points stay met.
//! Prescribed timing has two rows a point; with free timing a point may slide along its own tangent, and the one row
//! normal to it counts. Fixed derived quantities (a ground of a given length between free pivots) are equations too;
//! inequality limits do not reduce the dimension.

use super::rank::is_exact;
use super::warm::start_at;
use crate::mechanism::four_bar::gradient::ground_gradient;
use crate::mechanism::unit_vector;
use crate::numbers::optimise::levenberg_marquardt::{BlockLeastSquares, PointBlock};
use crate::record::{Candidate, Family};
use crate::task::Problem;
use crate::task::forms::design_space::{DESIGN, Derived, Design, DesignSpace, SHAPE, Shape};
use crate::task::forms::fits::{FitUser, Kept, on_fit, own_frame};
use crate::task::forms::torus::Positions;
use nalgebra::{DMatrix, SMatrix};
use std::array::from_fn;

/// The part of the largest singular value below which a singular value counts as zero: an exact answer is known to
/// about 1e-12 of the linkage, which moves the singular values by as much.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// Returns the family that an exact accepted answer belongs to; `None` if it is isolated or not exact.
pub fn family(problem: &Problem, best: &Candidate) -> Option<Family> {
    if !best.accepted || !is_exact(problem, best) {
        return None;
    }
    let dimension = dimension(problem, best).filter(|dimension| *dimension > 0)?;
    let text =
        format!("a {dimension}-parameter family of exact answers: ranked by transmission angle, then size");
    Some(Family { dimension, exact: true, text })
}

/// Returns the number of free unknowns less the rank of the points' derivatives by them; `None` if these do not exist.
pub fn dimension(problem: &Problem, candidate: &Candidate) -> Option<usize> {
    let start = start_at(problem, candidate)?;
    let mut rows = on_fit(problem, &start, Kept::Nothing, Derivatives { positions: &start.positions })??;
    let space = problem.space(start.setting.side);
    let shape = space.shape(&start.design)?;
    for bound in space.derived().iter().filter(|bound| bound.limits.is_fixed()) {
        rows.push(space.chain_rule(&start.design, &shape).by_design(&gradient(bound.quantity, &shape), 0.0));
    }
    let free: Vec<usize> = (0..DESIGN).filter(|&i| space.bounds()[i].0 < space.bounds()[i].1).collect();
    Some(free.len() - rank(&space, &shape, &rows, &free))
}

/// Computes the rows of all targets' derivatives by the design, normal to their own tangents; `None` if one does not exist.
struct Derivatives<'a> {
    positions: &'a Positions,
}

impl FitUser for Derivatives<'_> {
    type Output = Option<Vec<Design>>;

    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> Self::Output
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        let mut rows: Vec<[f64; N]> = Vec::new();
        let exists = fit.linearise(&x, self.positions, &mut |block: &PointBlock<N, R>| {
            let (t, j) = (&block.tangent, &block.jacobian);
            let length = t.iter().map(|t| t * t).sum::<f64>().sqrt();
            if length == 0.0 {
                rows.extend(j);
            } else if R == 2 {
                rows.push(from_fn(|i| (t[0] * j[1][i] - t[1] * j[0][i]) / length));
            } else {
                // All rows less their part along the tangent: one more than independent ones.
                let along: [f64; N] =
                    from_fn(|i| t.iter().zip(j).map(|(t, row)| t * row[i]).sum::<f64>() / (length * length));
                rows.extend(t.iter().zip(j).map(|(t, row)| from_fn(|i| row[i] - t * along[i])));
            }
        });
        exists.then(|| without_frame(&rows))
    }
}

/// Returns the rows by the design alone. A frame of its own among the unknowns is at its best, which leaves the rows that
/// depend on it less their mean.
fn without_frame<const N: usize>(rows: &[[f64; N]]) -> Vec<Design> {
    let by_frame = |row: &[f64; N]| own_frame(row).unwrap_or(0.0);
    let sq: f64 = rows.iter().map(|row| by_frame(row).powi(2)).sum();
    let mean: Design =
        from_fn(|i| rows.iter().map(|row| row[i] * by_frame(row)).sum::<f64>() / sq.max(f64::MIN_POSITIVE));
    rows.iter().map(|row| from_fn(|i| row[i] - mean[i] * by_frame(row))).collect()
}

fn rank(space: &DesignSpace, shape: &Shape, rows: &[[f64; DESIGN]], free: &[usize]) -> usize {
    // A rotation moves the points by the linkage's size.
    let reach = shape.links().into_iter().fold(shape.offset.norm(), f64::max);
    let scale = |i: usize| if space.is_angle(i) { 1.0 / reach } else { 1.0 };
    // J = Q R: the singular values of the small R are those of J.
    let tall = DMatrix::from_fn(rows.len().max(DESIGN), DESIGN, |row, column| {
        let used = free.contains(&column);
        if used { rows.get(row).map_or(0.0, |r| r[column] * scale(column)) } else { 0.0 }
    });
    let r = tall.qr().r();
    let small = SMatrix::<f64, DESIGN, DESIGN>::from_fn(|row, column| r[(row, column)]);
    let values = small.singular_values();
    let largest = values.iter().copied().fold(0.0, f64::max);
    values.iter().filter(|value| **value > RANK_TOLERANCE * largest).count()
}

/// Returns the derivative of a quantity by (Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y).
fn gradient(quantity: Derived, shape: &Shape) -> [f64; SHAPE] {
    let mut row = [0.0; SHAPE];
    match quantity {
        Derived::Ground => {
            let along = unit_vector(shape.follower_pivot - shape.crank_pivot);
            row[..4].copy_from_slice(&[-along.re, -along.im, along.re, along.im]);
        }
        Derived::GroundAngle => {
            row[..4].copy_from_slice(&ground_gradient(shape.crank_pivot, shape.follower_pivot));
        }
        Derived::CrankSide => {
            let side = unit_vector(shape.offset);
            (row[7], row[8]) = (side.re, side.im);
        }
        Derived::FollowerSide => {
            let side = unit_vector(shape.offset - shape.coupler);
            (row[5], row[7], row[8]) = (-side.re, side.re, side.im);
        }
    }
    row
}
