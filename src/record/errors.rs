//! The errors of a candidate: at its points, of its angles, and of its whole curve.

use serde::{Deserialize, Serialize};

/// The errors of a candidate, in the file's unit: of places; in a function of the output, in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ErrorRecord {
    /// The objective, which was minimised: the weighted sum of squared distances; or the largest distance, in parts of its
    /// point's tolerance where tolerances are given.
    pub objective: f64,
    /// The unweighted sum of squared distances at the points, or of the output's errors.
    pub sum_sq: f64,
    /// sqrt(sum_sq / n).
    pub rms: f64,
    /// The largest distance at a point, or error of the output.
    pub max: f64,
    /// The number of the point at which it is, from 0.
    pub max_at: usize,
    /// rms over the diagonal of the target's bounding box; in a function, that of the outputs over their range.
    pub rms_over_size: f64,
    /// Distances to the whole coupler curve of the circuit, whatever the timing.
    pub to_curve: CurveErrorRecord,
    /// In a motion: the errors of the body's angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<AngleErrorRecord>,
    /// In a function: the errors of the follower's angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<AngleErrorRecord>,
    /// The distances of the points as they were given to that same curve, where the target was smoothed or resampled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_raw: Option<CurveErrorRecord>,
    /// In a path: the distance of path and coupler curve from each other, over equal arcs of both, whatever the timing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub two_sided: Option<TwoSidedRecord>,
}

impl ErrorRecord {
    /// Returns the errors of the link whose angles are wanted: the body's in a motion, the follower's in a function.
    pub fn of_link(&self) -> Option<&AngleErrorRecord> {
        self.angle.as_ref().or(self.output.as_ref())
    }
}

/// The two-sided distance of a path and the part of the coupler curve that draws it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TwoSidedRecord {
    /// The mean distance of the path from the curve, plus that of the curve from the path (the Chamfer sum).
    pub mean: f64,
    /// That over the root of the mean square of the points' distances from their centroid.
    pub mean_over_radius: f64,
    /// The largest distance of a point of either from the other.
    pub worst: f64,
}

/// The errors of a body's angle over the poses that give one, or of the follower's over the pairs of a function.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct AngleErrorRecord {
    /// The root of the mean square, degrees.
    pub rms_deg: f64,
    /// The largest, degrees.
    pub max_deg: f64,
    /// The number of the point at which it is, from 0.
    pub max_at: usize,
}

/// Distances to the whole coupler curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CurveErrorRecord {
    /// The sum of squares.
    pub sum_sq: f64,
    /// sqrt(sum_sq / n).
    pub rms: f64,
    /// The largest.
    pub max: f64,
}
