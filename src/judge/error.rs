//! Structural errors: at the positions of the points, and to the whole coupler curve.

use crate::mechanism::effort::{POINTS_AT_ONCE, computed};
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, FourBar};
use crate::record::CurveErrorRecord;
use crate::task::Task;
use rayon::prelude::*;

/// The errors T_j - P_j at the positions of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct PathError {
    /// The error vectors, desired minus generated, one per point.
    pub structural: Vec<Complex>,
    /// The weighted sum of squares, sum_j w_j |T_j - P_j|^2.
    pub objective: f64,
    /// The sum of squares, sum_j |T_j - P_j|^2.
    pub sum_sq: f64,
    /// The largest error, max_j |T_j - P_j|.
    pub max: f64,
    /// The index of the first point with the largest error.
    pub max_at: usize,
}

/// Returns sqrt(sum_sq / n), the root of the mean square.
pub fn rms(sum_sq: f64, n: usize) -> f64 {
    (sum_sq / n as f64).sqrt()
}

impl PathError {
    /// Returns max_j |T_j - P_j| / tol_j, without a unit: 1 if the tolerances are just met; without tolerances the
    /// largest error, a length.
    pub fn deviation(&self, tolerances: Option<&[f64]>) -> f64 {
        let Some(tolerances) = tolerances else { return self.max };
        let parts = self.structural.iter().zip(tolerances).map(|(error, tolerance)| error.norm() / tolerance);
        parts.fold(0.0, f64::max)
    }
}

impl Task {
    /// Returns the errors of a linkage at the given crank angles (radians) and assemblies, one per point; `None` if the
    /// loop is open at a point.
    ///
    /// # Panics
    /// If there are fewer angles or assemblies than points.
    pub fn errors(
        &self,
        linkage: &FourBar,
        crank_angles: &[f64],
        assemblies: &[AssemblyMode],
    ) -> Option<PathError> {
        computed(self.len());
        let mut error =
            PathError { structural: Vec::new(), objective: 0.0, sum_sq: 0.0, max: 0.0, max_at: 0 };
        for (j, &target) in self.points().iter().enumerate() {
            let generated = linkage.position_with(crank_angles[j], assemblies[j]).joints()?.coupler_point;
            let difference = target - generated;
            let sq = difference.norm_sqr();
            error.structural.push(difference);
            error.objective += self.weights()[j] * sq;
            error.sum_sq += sq;
            if difference.norm() > error.max {
                error.max = difference.norm();
                error.max_at = j;
            }
        }
        Some(error)
    }
}

/// The cost of finding the nearest point of a curve, in positions: 720 samples are compared, and one or two minima
/// refined.
const NEAREST: usize = 150;

/// Returns the distances from any points to the coupler curve of the circuit that holds the given position; `None` if
/// that circuit has no point.
pub fn distances_to_curve(
    points: &[Complex],
    linkage: &FourBar,
    crank_angle: f64,
    assembly: AssemblyMode,
) -> Option<CurveErrorRecord> {
    let curve = CouplerCurve::through(linkage, crank_angle, assembly, DEFAULT_SAMPLES);
    computed(NEAREST * points.len());
    // In parallel, and summed in the order of the points: the number of threads changes no digit.
    let distances: Option<Vec<f64>> = points
        .par_iter()
        .with_min_len(POINTS_AT_ONCE)
        .map(|&point| Some(curve.nearest(point)?.distance))
        .collect();
    let distances = distances?;
    let sum_sq = distances.iter().map(|distance| distance * distance).sum();
    let max = distances.into_iter().fold(0.0, f64::max);
    Some(CurveErrorRecord { sum_sq, rms: rms(sum_sq, points.len()), max })
}
