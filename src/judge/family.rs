//! Local dimension of the set of exact answers: detects whether an exact answer belongs to a family.
//!
//! At an exact answer x the points' residuals are r(x) = 0, and if their derivative J by the free unknowns has rank k <
//! m, the answer moves on a manifold of dimension m - k (locally, at a regular point) on which all points stay met.
//! Prescribed timing has two rows a point; with free timing a point may slide along its own tangent, and the one row
//! normal to it counts. Fixed derived quantities (a ground of a given length between free pivots) are equations too;
//! inequality limits do not reduce the dimension.

use super::rank::exact_sum_sq;
use super::warm::start_at;
use crate::mechanism::{Complex, turned};
use crate::numbers::optimise::levenberg_marquardt::{BlockLeastSquares, PointBlock};
use crate::record::{Candidate, Family};
use crate::task::Problem;
use crate::task::forms::design_space::{DESIGN, Derived, DesignSpace, SHAPE, Shape, unit};
use crate::task::forms::timed::{TimedMotionFit, TimedPathFit, WITH_FRAME};
use crate::task::forms::torus::{MotionFit, PathFit, Positions};
use nalgebra::{DMatrix, SMatrix};

/// The part of the largest singular value below which a singular value counts as zero: an exact answer is known to
/// about 1e-12 of the linkage, which moves the singular values by as much.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// Returns the family that an exact accepted answer belongs to; `None` if it is isolated or not exact.
pub fn family(problem: &Problem, best: &Candidate) -> Option<Family> {
    if !best.accepted || best.error.sum_sq > exact_sum_sq(problem) {
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
    let mut rows: Vec<[f64; DESIGN]> = Vec::new();
    if start.positions.is_empty() {
        let (setting, positions) = (start.setting, &start.positions);
        match problem.task().body() {
            None => linearised(&TimedPathFit::new(problem, setting)?, &start.design, positions, &mut rows)?,
            Some(_) => {
                let fit = TimedMotionFit::new(problem, setting)?;
                centred(&fit, &fit.unknowns(&start.design), positions, &mut rows)?;
            }
        }
    } else {
        let (design, positions) = (&start.design, &start.positions);
        match problem.task().body() {
            None => linearised(&PathFit::new(problem, start.setting), design, positions, &mut rows)?,
            Some(_) => linearised(&MotionFit::new(problem, start.setting), design, positions, &mut rows)?,
        }
    }
    let space = problem.space(start.setting.side);
    let shape = space.shape(&start.design)?;
    for bound in space.derived().iter().filter(|bound| bound.limits.is_fixed()) {
        rows.push(space.chain_rule(&start.design, &shape).by_design(&gradient(bound.quantity, &shape), 0.0));
    }
    let free: Vec<usize> = (0..DESIGN).filter(|&i| space.bounds()[i].0 < space.bounds()[i].1).collect();
    Some(free.len() - rank(&space, &shape, &rows, &free))
}

/// Adds the rows of all targets' derivatives with prescribed timing; the frame of the body is eliminated, which leaves the
/// angles' rows less their mean.
fn centred(
    fit: &TimedMotionFit<'_>,
    x: &[f64; WITH_FRAME],
    positions: &Positions,
    rows: &mut Vec<[f64; DESIGN]>,
) -> Option<()> {
    let mut angles: Vec<[f64; DESIGN]> = Vec::new();
    let exists = fit.linearise(x, positions, &mut |block: &PointBlock<WITH_FRAME, 3>| {
        let [of_x, of_y, of_angle] = &block.jacobian;
        rows.extend([of_x, of_y].map(TimedMotionFit::design));
        if of_angle[DESIGN] != 0.0 {
            angles.push(TimedMotionFit::design(of_angle));
        }
    });
    let n = angles.len() as f64;
    let mean: [f64; DESIGN] = std::array::from_fn(|i| angles.iter().map(|row| row[i]).sum::<f64>() / n);
    rows.extend(angles.iter().map(|row| std::array::from_fn(|i| row[i] - mean[i])));
    exists.then_some(())
}

/// Adds the rows of all points' derivatives, normal to their own tangents; `None` if one does not exist.
fn linearised<const R: usize, P: BlockLeastSquares<DESIGN, R>>(
    fit: &P,
    x: &[f64; DESIGN],
    state: &P::State,
    rows: &mut Vec<[f64; DESIGN]>,
) -> Option<()> {
    let exists = fit.linearise(x, state, &mut |block: &PointBlock<DESIGN, R>| {
        let (t, j) = (&block.tangent, &block.jacobian);
        let length = t.iter().map(|t| t * t).sum::<f64>().sqrt();
        if length == 0.0 {
            rows.extend(j);
        } else if R == 2 {
            rows.push(std::array::from_fn(|i| (t[0] * j[1][i] - t[1] * j[0][i]) / length));
        } else {
            // All rows less their part along the tangent: one more than independent ones.
            let along: [f64; DESIGN] = std::array::from_fn(|i| {
                t.iter().zip(j).map(|(t, row)| t * row[i]).sum::<f64>() / (length * length)
            });
            rows.extend(t.iter().zip(j).map(|(t, row)| std::array::from_fn(|i| row[i] - t * along[i])));
        }
    });
    exists.then_some(())
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
    let ground = shape.follower_pivot - shape.crank_pivot;
    let along = unit(ground);
    let mut pivots = |by: Complex| row[..4].copy_from_slice(&[-by.re, -by.im, by.re, by.im]);
    match quantity {
        Derived::Ground => pivots(along),
        Derived::GroundAngle => pivots(turned(along) / ground.norm().max(f64::MIN_POSITIVE)),
        Derived::CrankSide => {
            let side = unit(shape.offset);
            (row[7], row[8]) = (side.re, side.im);
        }
        Derived::FollowerSide => {
            let side = unit(shape.offset - shape.coupler);
            (row[5], row[7], row[8]) = (-side.re, side.re, side.im);
        }
    }
    row
}
