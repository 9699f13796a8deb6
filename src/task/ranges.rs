//! Free ranges of a function: the angles that its crank and its follower turn through are unknowns too.
//!
//! The pairs of a function are given as angles (dphi_j, dpsi_j). With free ranges only their proportions count: the crank is
//! at phi_0 + h dphi_j and the follower at psi_0 + s k dpsi_j, where the *scales* h and k are unknown within bounds. With
//! both offsets and the three ratios of the links these are seven parameters, so that seven pairs can be met exactly.
//!
//! An error in degrees shrinks with the range of the outputs, and a follower that hardly turns would have none. So the
//! objective measures errors in parts of the range, as degrees of the outputs as they are written: with psi_j the follower's
//! angle on the way from psi_0
//!
//! ```text
//! e_j = dpsi_j - s (psi_j - psi_0) / k       sum_j w_j e_j^2       (the true error of the output is k e_j)
//! ```
//!
//! Over a short stretch of its motion any linkage gives nearly a parabola, and so nearly any function; the lower bounds of
//! the ranges keep answers of that kind out.
//!
//! At given positions the best k is linear: e_j = dpsi_j - u s y_j - c with u = 1/k, y_j the follower's angles on one turn.

use crate::mechanism::four_bar::mobility::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The bounds of a range that is `"free"`, degrees: linkages turn well through such angles, and a shorter range is a guess
/// at a point of the function.
pub const FREE_RANGE_DEG: [f64; 2] = [30.0, 180.0];

/// The range of the angles of pairs whose range is free where none is written, degrees.
pub const WRITTEN_RANGE_DEG: f64 = 90.0;

/// The greatest range of inputs and of outputs that may be free, degrees. Two outputs that are at most half a turn apart
/// need no count of turns.
pub const GREATEST_RANGE_DEG: [f64; 2] = [360.0, 180.0];

/// The bounds of the ranges of a function that are free, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RangesSpec {
    /// The bounds of the angle that the crank turns through; absent: as the inputs are written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_range_deg: Option<[f64; 2]>,
    /// The bounds of the angle that the follower turns through; absent: as the outputs are written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_range_deg: Option<[f64; 2]>,
}

impl RangesSpec {
    /// Returns the bounds of inputs and outputs.
    pub fn bounds_deg(&self) -> [Option<[f64; 2]>; 2] {
        [self.input_range_deg, self.output_range_deg]
    }

    /// Returns whether a range is free.
    pub fn is_free(&self) -> bool {
        self.bounds_deg().iter().any(Option::is_some)
    }
}

/// The scales of the written inputs and outputs: h and k.
pub type Scales = [f64; 2];

/// The bounds of the scales of a function: 1 alone where a range is as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// The bounds of h.
    pub input: (f64, f64),
    /// The bounds of k.
    pub output: (f64, f64),
}

impl Default for Ranges {
    /// Returns the bounds of ranges as they are written.
    fn default() -> Self {
        Ranges { input: (1.0, 1.0), output: (1.0, 1.0) }
    }
}

impl Ranges {
    /// Returns the bounds for pairs of these written ranges, degrees.
    pub fn of(spec: &RangesSpec, written_deg: [f64; 2]) -> Ranges {
        let scales = |bounds: Option<[f64; 2]>, written: f64| match bounds {
            Some([low, high]) => (low / written, high / written),
            None => (1.0, 1.0),
        };
        let [input, output] = spec.bounds_deg();
        Ranges { input: scales(input, written_deg[0]), output: scales(output, written_deg[1]) }
    }

    /// Returns the bounds of h and k.
    pub fn bounds(&self) -> [(f64, f64); 2] {
        [self.input, self.output]
    }

    /// Returns whether each of the scales is free.
    pub fn free(&self) -> [bool; 2] {
        self.bounds().map(|(low, high)| low < high)
    }

    /// Returns whether both ranges are as they are written.
    pub fn are_written(&self) -> bool {
        *self == Ranges::default()
    }

    /// Returns the scales of the middle of the bounds.
    pub fn middle(&self) -> Scales {
        self.bounds().map(|(low, high)| (low * high).sqrt())
    }

    /// Returns the scales within the bounds that are nearest.
    pub fn nearest(&self, scales: Scales) -> Scales {
        let within = |scale: f64, (low, high): (f64, f64)| scale.max(low).min(high);
        [within(scales[0], self.input), within(scales[1], self.output)]
    }

    /// Returns the scale k of the outputs for which the weighted sum of squared errors in parts of the range is least, at
    /// the written outputs s dpsi_j (radians) and the follower's directions (radians); `frame` is the angle from such a
    /// direction to that of an output of zero, if it is given.
    pub fn best_output(&self, outputs: &[f64], lines: &[f64], weights: &[f64], frame: Option<f64>) -> f64 {
        if !self.free()[1] {
            return self.output.0;
        }
        let Some(first) = lines.first() else { return self.output.0 };
        let total: f64 = weights.iter().sum();
        let angles: Vec<f64> = match frame {
            Some(frame) => lines.iter().map(|line| wrapped(line + frame)).collect(),
            None => lines.iter().map(|line| wrapped(line - first)).collect(),
        };
        let mean = |list: &[f64]| match frame {
            Some(_) => 0.0,
            None => list.iter().zip(weights).map(|(x, weight)| x * weight).sum::<f64>() / total,
        };
        let (of_outputs, of_angles) = (mean(outputs), mean(&angles));
        let (mut both, mut sq) = (0.0, 0.0);
        for ((output, angle), weight) in outputs.iter().zip(&angles).zip(weights) {
            let turned = angle - of_angles;
            both += weight * turned * (output - of_outputs);
            sq += weight * turned * turned;
        }
        // A follower that turns the other way has no scale; the least range has the least error of those.
        let scale = if both > 0.0 { sq / both } else { self.output.0 };
        scale.max(self.output.0).min(self.output.1)
    }
}

/// The angle from which the angles of a link count, and their scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// In a motion the angle from the direction C -> D to the body's x axis; in a function that from the direction B -> D to
    /// that of an output of zero; degrees.
    pub frame_deg: f64,
    /// The scale k of a function's outputs; 1 where their range is as written.
    pub scale: f64,
}

impl Reference {
    /// Returns the reference of angles as they are written, counted from a frame.
    pub fn frame(frame_deg: f64) -> Reference {
        Reference { frame_deg, scale: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_best_scale_is_that_of_the_follower_and_stays_within_its_bounds() {
        let outputs = [0.0, 0.1, 0.35, 0.7, 1.1];
        let weights = [1.0, 2.0, 1.0, 0.5, 1.0];
        let ranges = Ranges { input: (1.0, 1.0), output: (0.2, 3.0) };
        for (scale, expected) in [(1.7, 1.7), (0.6, 0.6), (0.1, 0.2)] {
            // Across the direction of half a turn, where angles wrap.
            let lines: Vec<f64> = outputs.iter().map(|o| wrapped(PI - 0.2 + scale * o)).collect();
            let found = ranges.best_output(&outputs, &lines, &weights, None);
            assert!((found - expected).abs() < 1e-12, "{found} for {scale}");
            let found = ranges.best_output(&outputs, &lines, &weights, Some(0.2 - PI));
            assert!((found - expected).abs() < 1e-12, "{found} for {scale} from a frame");
        }
        let back: Vec<f64> = outputs.iter().map(|o| -o).collect();
        assert_eq!(ranges.best_output(&outputs, &back, &weights, None), 0.2);
        assert_eq!(Ranges::default().best_output(&outputs, &back, &weights, None), 1.0);
    }
}
