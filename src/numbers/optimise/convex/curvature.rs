//! The curvature that the linear models leave out, learnt from step to step by the symmetric rank-one formula.

use super::model::Step;
use super::{At, ConvexOptions};
use nalgebra::{SMatrix, SVector, SymmetricEigen};

/// The part of the Hessian of the Lagrangian that the linear models leave out, in units of the first half widths of
/// the trust box.
#[derive(Clone, Debug)]
pub(super) struct Curvature<const N: usize> {
    pub matrix: SMatrix<f64, N, N>,
}

/// The least denominator of a rank-one correction, relative to its factors; with a smaller one it is left out.
const LEAST_DENOMINATOR: f64 = 1e-6;

impl<const N: usize> Curvature<N> {
    pub fn none() -> Self {
        Curvature { matrix: SMatrix::zeros() }
    }

    /// Applies the symmetric rank-one correction from a step that was evaluated, whether it was accepted or not:
    /// B s = sum_j (J_j' - J_j)^T z_j - sum_i mu_i (dg_i' - dg_i).
    pub fn learn<const R: usize, S>(
        &mut self,
        options: &ConvexOptions<N>,
        from: &At<N, R, S>,
        to: &At<N, R, S>,
        step: &Step<N, R>,
    ) {
        let scale = &options.trust;
        let moved = SVector::<f64, N>::from_fn(|i, _| (to.x[i] - from.x[i]) / scale[i]);
        let mut change = [0.0; N];
        for ((old, new), force) in from.blocks.iter().zip(&to.blocks).zip(&step.forces) {
            for (axis, z) in force.iter().enumerate().filter(|(_, z)| **z != 0.0) {
                for (out, (n, o)) in change.iter_mut().zip(new.jacobian[axis].iter().zip(&old.jacobian[axis]))
                {
                    *out += z * (n - o);
                }
            }
        }
        for ((old, new), mu) in from.rows.iter().zip(&to.rows).zip(&step.multipliers.rows) {
            if *mu != 0.0 {
                for (out, (n, o)) in change.iter_mut().zip(new.gradient.iter().zip(&old.gradient)) {
                    *out -= mu * (n - o);
                }
            }
        }
        let change = SVector::<f64, N>::from_fn(|i, _| change[i] * scale[i]);
        let error = change - self.matrix * moved;
        let denominator = error.dot(&moved);
        if denominator.abs() > LEAST_DENOMINATOR * error.norm() * moved.norm() {
            let corrected = self.matrix + error * error.transpose() / denominator;
            if corrected.iter().all(|v| v.is_finite()) {
                self.matrix = corrected;
            }
        }
    }
}

/// Returns the positive semidefinite part of a symmetric matrix; zero if it has none.
pub(super) fn positive_part<const N: usize>(matrix: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let symmetric = nalgebra::DMatrix::from_fn(N, N, |i, k| 0.5 * (matrix[(i, k)] + matrix[(k, i)]));
    if !symmetric.iter().all(|v| v.is_finite()) {
        return SMatrix::zeros();
    }
    let eigen = SymmetricEigen::new(symmetric);
    let mut out = SMatrix::<f64, N, N>::zeros();
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > 0.0 {
            for i in 0..N {
                for k in 0..N {
                    out[(i, k)] += value * vector[i] * vector[k];
                }
            }
        }
    }
    out
}
