//! Non-negative least squares of a few columns: min |sum_i m_i g_i - q| with every m_i >= 0.
//!
//! The active-set method of C. L. Lawson and R. J. Hanson (1974), *Solving Least Squares Problems*, chapter 23: in
//! each round the column with the largest inner product with the residual joins the passive set; if the least-squares
//! solution over the passive set has a negative multiplier, the step towards it ends at the first multiplier that
//! becomes zero. A dozen columns of a dozen numbers take microseconds; it is not meant for larger problems.

use nalgebra::{DMatrix, DVector};

/// The solution of a non-negative least-squares problem, from [`nonnegative_least_squares`].
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// The multiplier of each column, not negative.
    pub values: Vec<f64>,
    /// The norm of the residual, |sum_i m_i g_i - q|.
    pub residual: f64,
    /// The largest change of a multiplier that a unit of residual can have caused: 1 over the least singular value of
    /// the columns with a positive multiplier (infinite if they depend on each other), 0 if there is no such column.
    pub sensitivity: f64,
}

/// The least singular value, relative to the greatest, with which columns count as linearly independent.
const DEPENDENT: f64 = 1e-9;

/// Computes the non-negative multipliers of `columns` (all as long as `right`) whose combination comes nearest to
/// `right`.
///
/// Columns should be of like size: scale them to length 1.
///
/// ```
/// use linkwright_optimise::nonnegative::nonnegative_least_squares;
/// let found = nonnegative_least_squares(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[2.0, -3.0]);
/// assert_eq!((found.values, found.residual), (vec![2.0, 0.0], 3.0));
/// ```
///
/// # Panics
/// When a column is shorter than `right`.
pub fn nonnegative_least_squares(columns: &[Vec<f64>], right: &[f64]) -> Multipliers {
    let count = columns.len();
    let matrix = DMatrix::from_fn(right.len(), count, |i, k| columns[k][i]);
    let right = DVector::from_row_slice(right);
    let mut values = DVector::<f64>::zeros(count);
    let mut passive: Vec<usize> = Vec::new();
    let slack = 1e-12 * right.norm();
    // Each column joins once or twice; the limit ends a cycle that rounding may cause.
    for _ in 0..4 * count {
        let promise = matrix.tr_mul(&(&right - &matrix * &values));
        let best = (0..count)
            .filter(|k| !passive.contains(k) && promise[*k] > slack)
            .max_by(|&i, &k| promise[i].total_cmp(&promise[k]).then(k.cmp(&i)));
        let Some(best) = best else { break };
        passive.push(best);
        while !passive.is_empty() {
            let solved = least_squares(&matrix, &passive, &right);
            if solved.iter().all(|v| *v > 0.0) {
                values.fill(0.0);
                for (&k, v) in passive.iter().zip(solved.iter()) {
                    values[k] = *v;
                }
                break;
            }
            // A step towards the solution as far as all multipliers stay non-negative; those that become zero leave
            // the passive set.
            let share = passive
                .iter()
                .zip(solved.iter())
                .filter(|(_, v)| **v <= 0.0)
                .map(|(&k, v)| values[k] / (values[k] - v).max(f64::MIN_POSITIVE))
                .fold(1.0, f64::min);
            for (&k, v) in passive.iter().zip(solved.iter()) {
                values[k] += share * (v - values[k]);
            }
            let before = passive.len();
            passive.retain(|&k| values[k] > 0.0 && values[k] > f64::EPSILON * right.norm());
            if passive.len() == before {
                passive.pop();
            }
            for k in (0..count).filter(|k| !passive.contains(k)) {
                values[k] = 0.0;
            }
        }
        if !passive.contains(&best) {
            break;
        }
    }
    let residual = (&right - &matrix * &values).norm();
    let sensitivity = if passive.is_empty() {
        0.0
    } else {
        let singular = matrix.select_columns(passive.iter()).singular_values();
        let (least, greatest) = (singular.min(), singular.max());
        let dependent = passive.len() > right.len() || least <= DEPENDENT * greatest;
        if dependent { f64::INFINITY } else { 1.0 / least }
    };
    Multipliers { values: values.iter().copied().collect(), residual, sensitivity }
}

fn least_squares(matrix: &DMatrix<f64>, passive: &[usize], right: &DVector<f64>) -> DVector<f64> {
    let chosen = matrix.select_columns(passive.iter());
    let svd = chosen.svd(true, true);
    let floor = DEPENDENT * svd.singular_values.max();
    svd.solve(right, floor).unwrap_or_else(|_| DVector::zeros(passive.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_arithmetic::streams::{stream, uniform};

    /// Checks the Karush-Kuhn-Tucker conditions, which are sufficient because the problem is convex.
    fn is_solution(columns: &[Vec<f64>], right: &[f64], found: &Multipliers) -> bool {
        let mut rest = right.to_vec();
        for (column, m) in columns.iter().zip(&found.values) {
            for (r, c) in rest.iter_mut().zip(column) {
                *r -= m * c;
            }
        }
        columns.iter().zip(&found.values).all(|(column, m)| {
            let along: f64 = column.iter().zip(&rest).map(|(c, r)| c * r).sum();
            *m >= 0.0 && along <= 1e-9 && (*m == 0.0 || along.abs() <= 1e-9)
        })
    }

    #[test]
    fn random_problems_end_where_the_conditions_hold() {
        let mut draws = stream(5, 0);
        for round in 0..400 {
            let (n, count) = (1 + round % 10, round % 13);
            let mut vector = || (0..n).map(|_| uniform(&mut draws, -1.0, 1.0)).collect::<Vec<f64>>();
            let columns: Vec<Vec<f64>> = (0..count).map(|_| vector()).collect();
            let right = vector();
            let found = nonnegative_least_squares(&columns, &right);
            assert!(is_solution(&columns, &right, &found), "round {round}: {found:?}");
        }
    }

    #[test]
    fn equal_columns_are_told_apart_by_nothing() {
        let columns = [vec![1.0, 0.0], vec![1.0, 0.0], vec![0.0, 1.0]];
        let found = nonnegative_least_squares(&columns, &[1.0, 1.0]);
        assert!(found.residual < 1e-12 && is_solution(&columns, &[1.0, 1.0], &found));
    }
}
