//! Structural errors: of the places and the angles at the positions of the targets, and to the whole coupler curve.

use crate::mechanism::effort::{POINTS_AT_ONCE, computed};
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, FourBar};
use crate::record::{Candidate, CurveErrorRecord};
use crate::task::{Body, Problem, Task, best_frame};
use rayon::prelude::*;

/// The errors at the positions of the targets: T_j - P_j of the place, and of the angle in a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct StructuralError {
    /// The error vectors of the place, desired minus generated, one per target.
    pub structural: Vec<Complex>,
    /// The weighted sum of squares, sum_j w_j (|T_j - P_j|^2 + (W dtheta_j)^2) with the angle's weight W, a length; in a
    /// path the first term alone, in a function the second, in degrees squared.
    pub objective: f64,
    /// The sum of squares, sum_j |T_j - P_j|^2; in a function of the output's errors, degrees squared.
    pub sum_sq: f64,
    /// The largest error, max_j |T_j - P_j|; in a function of the output, degrees.
    pub max: f64,
    /// The index of the first point with the largest error.
    pub max_at: usize,
    /// The errors of the body's angle in a motion, of the follower's in a function.
    pub angle: Option<AngleError>,
}

/// The errors of a link's angle at the targets: of a body's in a motion, of the follower's in a function.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleError {
    /// The angle from the direction C -> D to the body's x axis, in radians, within half a turn; in a function the angle
    /// from the direction B -> D to that of an output of zero.
    pub frame: f64,
    /// The sign in which the angles count: +1 of a body.
    pub sign: f64,
    /// The errors, desired minus generated, in radians within half a turn; `None` where only the place counts.
    pub structural: Vec<Option<f64>>,
    /// The root of the mean square, over the targets that have an angle.
    pub rms: f64,
    /// The largest error.
    pub max: f64,
    /// The index of the first target that has it.
    pub max_at: usize,
}

impl AngleError {
    /// Returns the errors of a link in directions `lines` (radians), one a target, whose angles count from `frame`; without a
    /// frame, so that the weighted sum of squares is least. Of two senses that are allowed it is the one of the lesser weighted sum of squares.
    fn of(body: &Body, weights: &[f64], lines: &[f64], frame: Option<f64>) -> AngleError {
        let with = |sign: &f64| AngleError::with(body, (weights, *sign), lines, frame);
        let sum = |error: &AngleError| {
            let each = error.structural.iter().zip(weights);
            each.map(|(error, weight)| weight * error.unwrap_or(0.0).powi(2)).sum::<f64>()
        };
        let all = body.signs().iter().map(with);
        // Of equal ones the first.
        let least = all.reduce(|one, other| if sum(&other) < sum(&one) { other } else { one });
        least.unwrap_or_else(|| with(&1.0))
    }

    /// As [`AngleError::of`] in the sense of a sign.
    fn with(body: &Body, (weights, sign): (&[f64], f64), lines: &[f64], frame: Option<f64>) -> AngleError {
        let apart: Vec<Option<f64>> = body
            .angles
            .iter()
            .zip(lines)
            .map(|(angle, line)| angle.map(|angle| sign * angle - line))
            .collect();
        let frame = frame.unwrap_or_else(|| best_frame(&apart, weights));
        let structural: Vec<Option<f64>> =
            apart.iter().map(|apart| apart.map(|a| wrapped(a - frame))).collect();
        let (mut sum_sq, mut count, mut max, mut max_at) = (0.0, 0_usize, 0.0_f64, None);
        for (j, error) in structural.iter().enumerate() {
            let Some(error) = error else { continue };
            sum_sq += error * error;
            count += 1;
            if max_at.is_none() || error.abs() > max {
                (max, max_at) = (error.abs(), Some(j));
            }
        }
        AngleError {
            frame,
            sign,
            structural,
            rms: rms(sum_sq, count.max(1)),
            max,
            max_at: max_at.unwrap_or(0),
        }
    }
}

/// Returns sqrt(sum_sq / n), the root of the mean square.
pub fn rms(sum_sq: f64, n: usize) -> f64 {
    (sum_sq / n as f64).sqrt()
}

impl StructuralError {
    /// Returns max_j |T_j - P_j| / tol_j, without a unit: 1 if the tolerances are just met; without tolerances the
    /// largest error, a length. In a motion the parts |dtheta_j| / tolerance_deg_j count too; without any tolerance,
    /// the lengths W |dtheta_j|.
    pub fn deviation(&self, task: &Task) -> f64 {
        let of_angles = |part: &dyn Fn(usize, f64) -> f64| {
            let angles = self.angle.iter().flat_map(|angle| angle.structural.iter().enumerate());
            angles.filter_map(|(j, error)| Some(part(j, (*error)?.abs()))).fold(0.0, f64::max)
        };
        let angle_tolerances = task.body().and_then(|body| body.tolerances.as_deref());
        let places = match task.tolerances() {
            Some(tolerances) => {
                let parts =
                    self.structural.iter().zip(tolerances).map(|(error, tolerance)| error.norm() / tolerance);
                parts.fold(0.0, f64::max)
            }
            None if angle_tolerances.is_some() => 0.0,
            None => self.max,
        };
        match angle_tolerances {
            Some(tolerances) => places.max(of_angles(&|j, error| error / tolerances[j])),
            None if task.tolerances().is_some() => places,
            None => {
                places.max(of_angles(&|_, error| task.body().map_or(0.0, |body| body.angle_weight) * error))
            }
        }
    }
}

impl Task {
    /// Returns the errors of a linkage at the given crank angles (radians) and assemblies, one per target; `None` if the
    /// loop is open at a target. The body of a motion lies at `frame` from C -> D (radians); without a frame it lies where
    /// the errors are least.
    ///
    /// # Panics
    /// If there are fewer angles or assemblies than points.
    pub fn errors(
        &self,
        linkage: &FourBar,
        crank_angles: &[f64],
        assemblies: &[AssemblyMode],
        frame: Option<f64>,
    ) -> Option<StructuralError> {
        computed(self.len());
        let mut error = StructuralError {
            structural: Vec::new(),
            objective: 0.0,
            sum_sq: 0.0,
            max: 0.0,
            max_at: 0,
            angle: None,
        };
        let mut lines = Vec::new();
        for j in 0..self.len() {
            let joints = linkage.position_with(crank_angles[j], assemblies[j]).joints()?;
            if let Some(body) = self.body() {
                let line = body.line([linkage.follower_pivot(), joints.crank_pin, joints.follower_pin]);
                lines.push(line.arg());
            }
            let Some(&target) = self.points().get(j) else { continue };
            let difference = target - joints.coupler_point;
            let sq = difference.norm_sqr();
            error.structural.push(difference);
            error.objective += self.weights()[j] * sq;
            error.sum_sq += sq;
            if difference.norm() > error.max {
                error.max = difference.norm();
                error.max_at = j;
            }
        }
        if let Some(body) = self.body() {
            let frame = body.given_frame(linkage.ground_angle()).or(frame);
            let angle = AngleError::of(body, self.weights(), &lines, frame);
            for (error_of_angle, weight) in angle.structural.iter().zip(self.weights()) {
                let length = body.angle_weight * error_of_angle.unwrap_or(0.0);
                error.objective += weight * length * length;
            }
            if self.is_function() {
                error.sum_sq =
                    angle.structural.iter().flatten().map(|e| (body.angle_weight * e).powi(2)).sum();
                (error.max, error.max_at) = (body.angle_weight * angle.max, angle.max_at);
            }
            error.angle = Some(angle);
        }
        Some(error)
    }
}

/// Returns the errors of a candidate at its own positions and in its own frame; `None` if the loop is open at a target.
pub fn structural_error(problem: &Problem, candidate: &Candidate) -> Option<StructuralError> {
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let frame = candidate.own_frame_deg().map(f64::to_radians);
    problem.task().errors(&candidate.linkage, &radians, &candidate.t1_at, frame)
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
    if distances.is_empty() {
        return Some(CurveErrorRecord { sum_sq: 0.0, rms: 0.0, max: 0.0 });
    }
    let sum_sq = distances.iter().map(|distance| distance * distance).sum();
    let max = distances.into_iter().fold(0.0, f64::max);
    Some(CurveErrorRecord { sum_sq, rms: rms(sum_sq, points.len()), max })
}
