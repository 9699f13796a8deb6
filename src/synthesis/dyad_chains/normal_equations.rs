//! Normal equations of a fit: products of columns, hinges as rows, and their solution by elimination.

use crate::mechanism::dyad_chain::MAX_PARAMETERS;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};

/// Greatest number of unknowns (parameters, then T, S, Z), and of columns with the residual.
pub(super) const MAX_UNKNOWNS: usize = MAX_PARAMETERS + 6;
pub(super) const MAX_COLUMNS: usize = MAX_UNKNOWNS + 1;

/// Products of columns; the last column in use is the residual.
pub(super) type Matrix = [[f64; MAX_COLUMNS]; MAX_COLUMNS];

/// Computes the products of all pairs of columns, each of `length` numbers.
#[inline(always)]
pub(super) fn gram(rows: &[f64], length: usize, columns: usize, out: &mut Matrix) {
    let column = |i: usize| &rows[i * length..(i + 1) * length];
    // Two by two, so that each number that is loaded is used twice.
    for i in (0..columns).step_by(2) {
        let i2 = (i + 1).min(columns - 1);
        let (a0, a1) = (column(i), column(i2));
        for j in (0..=i).step_by(2) {
            let j2 = (j + 1).min(columns - 1);
            let (b0, b1) = (column(j), column(j2));
            let mut sums = [F64x8::splat(0.0); 4];
            for at in (0..length).step_by(LANES) {
                let (x0, x1) = (F64x8::load(a0, at), F64x8::load(a1, at));
                let (y0, y1) = (F64x8::load(b0, at), F64x8::load(b1, at));
                sums[0] = sums[0] + x0 * y0;
                sums[1] = sums[1] + x0 * y1;
                sums[2] = sums[2] + x1 * y0;
                sums[3] = sums[3] + x1 * y1;
            }
            for ((row, column), sum) in [(i, j), (i, j2), (i2, j), (i2, j2)].into_iter().zip(sums) {
                let sum = sum.sum();
                out[row][column] = sum;
                out[column][row] = sum;
            }
        }
    }
}

/// Adds the products of other columns.
#[inline(always)]
pub(super) fn add(out: &mut Matrix, other: &Matrix, columns: usize) {
    for (row, other) in out.iter_mut().zip(other).take(columns) {
        for (a, b) in row.iter_mut().zip(other).take(columns) {
            *a += b;
        }
    }
}

/// Adds `weight` times the square of a row.
#[inline(always)]
pub(super) fn add_square(out: &mut Matrix, row: &[f64; MAX_COLUMNS], columns: usize, weight: f64) {
    for (i, out) in out.iter_mut().enumerate().take(columns) {
        let factor = weight * row[i];
        for (out, entry) in out.iter_mut().zip(row).take(columns) {
            *out += factor * entry;
        }
    }
}

/// Solves A x = -b, where b is the column after the unknowns; returns whether A is positive definite.
#[inline(always)]
pub(super) fn solve(matrix: &mut Matrix, unknowns: usize, x: &mut [f64; MAX_COLUMNS]) -> bool {
    let mut right = [0.0; MAX_COLUMNS];
    for (right, row) in right.iter_mut().zip(matrix.iter()).take(unknowns) {
        *right = -row[unknowns];
    }
    for k in 0..unknowns {
        let top = matrix[k];
        let is_positive = top[k] > 0.0;
        if !is_positive {
            return false;
        }
        let inverse = 1.0 / top[k];
        for i in k + 1..unknowns {
            let factor = matrix[i][k] * inverse;
            for j in k + 1..unknowns {
                matrix[i][j] -= factor * top[j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..unknowns).rev() {
        let mut sum = right[k];
        for j in k + 1..unknowns {
            sum -= matrix[k][j] * x[j];
        }
        x[k] = sum / matrix[k][k];
    }
    true
}
