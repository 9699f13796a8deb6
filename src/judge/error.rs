//! Structural errors: of the places and the angles at the positions of the targets, and to the whole coupler curve.

use crate::mechanism::effort::{POINTS_AT_ONCE, computed};
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, CrankLinkage};
use crate::record::{Candidate, CurveErrorRecord};
use crate::task::ranges::Reference;
use crate::task::{Body, Problem, Task};
use rayon::prelude::*;

/// The errors at the positions of the targets: T_j - P_j of the place, and of the angle in a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct StructuralError {
    /// The error vectors of the place, desired minus generated, one per target.
    pub structural: Vec<Complex>,
    /// The weighted sum of squares, sum_j w_j (|T_j - P_j|^2 + (W dtheta_j)^2) with the angle's weight W, a length; in a
    /// path the first term alone, in a function the second, in degrees squared, of the outputs as they are written where their
    /// range is free.
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
    /// The scale of the written angles: 1 unless the range of a function's outputs is free.
    pub scale: f64,
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
    /// Returns the errors of a link at its measures `lines` (radians), one a target, whose angles count from `own`; without it,
    /// from `frame` if that is given, and so that the weighted sum of squares is least. Of two senses that are allowed it is the one of the lesser weighted sum of squares.
    fn of(
        body: &Body,
        weights: &[f64],
        lines: &[f64],
        (own, frame): (Option<Reference>, Option<f64>),
    ) -> AngleError {
        let with = |sign: &f64| AngleError::with(body, (weights, *sign), lines, (own, frame));
        let sum = |error: &AngleError| {
            let each = error.structural.iter().zip(weights);
            each.map(|(e, weight)| weight * (e.unwrap_or(0.0) / error.scale).powi(2)).sum::<f64>()
        };
        let all = body.signs().iter().map(with);
        // Of equal ones the first.
        let least = all.reduce(|one, other| if sum(&other) < sum(&one) { other } else { one });
        least.unwrap_or_else(|| with(&1.0))
    }

    /// As [`AngleError::of`] in the sense of a sign.
    fn with(
        body: &Body,
        (weights, sign): (&[f64], f64),
        lines: &[f64],
        (own, frame): (Option<Reference>, Option<f64>),
    ) -> AngleError {
        let scale = own.map_or_else(|| best_scale(body, (weights, sign), lines, frame), |own| own.scale);
        let apart: Vec<Option<f64>> = body
            .angles
            .iter()
            .zip(lines)
            .map(|(angle, line)| angle.map(|angle| sign * scale * angle - line))
            .collect();
        let frame = frame
            .or(own.map(|own| own.frame_deg.to_radians()))
            .unwrap_or_else(|| body.best_frame(&apart, weights));
        let structural: Vec<Option<f64>> =
            apart.iter().map(|apart| apart.map(|a| body.apart(a - frame))).collect();
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
            scale,
            structural,
            rms: rms(sum_sq, count.max(1)),
            max,
            max_at: max_at.unwrap_or(0),
        }
    }
}

/// Returns the scale of a function's outputs for which the errors in parts of their range are least; 1 unless it is free.
fn best_scale(body: &Body, (weights, sign): (&[f64], f64), lines: &[f64], frame: Option<f64>) -> f64 {
    if !body.ranges().free()[1] {
        return body.ranges().output.0;
    }
    let outputs: Vec<f64> = body.angles.iter().map(|angle| sign * angle.unwrap_or(0.0)).collect();
    body.ranges().best_output(&outputs, lines, weights, frame)
}

/// Returns sqrt(sum_sq / n), the root of the mean square.
pub fn rms(sum_sq: f64, n: usize) -> f64 {
    (sum_sq / n as f64).sqrt()
}

impl StructuralError {
    /// Returns the scale of the written outputs of a function; 1 unless their range is free.
    pub fn scale(&self) -> f64 {
        self.angle.as_ref().map_or(1.0, |angle| angle.scale)
    }

    /// Returns max_j |T_j - P_j| / tol_j, without a unit: 1 if the tolerances are just met; without tolerances the
    /// largest error, a length. In a motion the parts |dtheta_j| / tolerance_deg_j count too; without any tolerance,
    /// the lengths W |dtheta_j|, in parts of the scale of a function's outputs.
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
                let scale = self.scale();
                let length = task.body().map_or(0.0, |body| body.angle_weight);
                match self.structural.is_empty() {
                    true => of_angles(&|_, error| length * error / scale),
                    false => places.max(of_angles(&|_, error| length * error)),
                }
            }
        }
    }
}

impl Task {
    /// Returns the errors of a linkage at the given crank angles (radians) and assemblies, one per target; `None` if the
    /// loop is open at a target. The angles of the body or of the follower count from `own`; without it, from where the errors
    /// are least.
    ///
    /// # Panics
    /// If there are fewer angles or assemblies than points.
    pub fn errors(
        &self,
        linkage: impl Into<CrankLinkage>,
        crank_angles: &[f64],
        assemblies: &[AssemblyMode],
        own: Option<Reference>,
    ) -> Option<StructuralError> {
        let linkage = linkage.into();
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
            let at = linkage.joints_with(crank_angles[j], assemblies[j])?;
            if let Some(body) = self.body() {
                lines.push(body.measured(&linkage, &at)?);
            }
            let Some(&target) = self.points().get(j) else { continue };
            let difference = target - at.joints.coupler_point;
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
            let frame = body.given_frame(linkage.ground_angle());
            let angle = AngleError::of(body, self.weights(), &lines, (own, frame));
            for (error_of_angle, weight) in angle.structural.iter().zip(self.weights()) {
                let length = body.angle_weight * error_of_angle.unwrap_or(0.0) / angle.scale;
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
    let own = candidate.own_reference(&problem.spec().task);
    problem.task().errors(candidate.linkage, &radians, &candidate.t1_at, own)
}

/// The cost of finding the nearest point of a curve, in positions: 720 samples are compared, and one or two minima
/// refined.
const NEAREST: usize = 150;

/// Returns the distances from any points to the coupler curve of the circuit that holds the given position; `None` if
/// that circuit has no point.
pub fn distances_to_curve(
    points: &[Complex],
    linkage: impl Into<CrankLinkage>,
    crank_angle: f64,
    assembly: AssemblyMode,
) -> Option<CurveErrorRecord> {
    let curve = CouplerCurve::through(&linkage.into(), crank_angle, assembly, DEFAULT_SAMPLES);
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
