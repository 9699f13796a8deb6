//! The torque of largest size over a stretch of crank angles, by the power balance alone: no joint force is computed.

use super::drive::Drive;
use super::figures::{Peak, SAMPLES};
use super::loaded::{LoadedLinkage, Scratch};
use super::peaks::largest;
use std::f64::consts::TAU;

/// The least number of samples of a stretch.
const LEAST: f64 = 24.0;

impl LoadedLinkage {
    /// Computes the torque of largest size (N m, with its sign) and its crank angle (degrees) over a stretch of crank angles in
    /// radians, or over a full turn, sampled as [`figures`](Self::figures) are and refined likewise. The linkage keeps its assembly.
    ///
    /// `None` if the linkage is open or at a toggle at a sample: there the torque has no bound.
    pub fn torque_peak_over(&self, stretch: Option<[f64; 2]>, drive: &Drive) -> Option<Peak> {
        let at = |angle: f64, scratch: &mut Scratch| self.torque(angle, drive.motion(angle), scratch);
        let mut scratch = self.scratch();
        let [from, to] = stretch.unwrap_or([0.0, TAU]);
        let steps = ((to - from).abs() / TAU * SAMPLES as f64).ceil().max(LEAST) as usize;
        let (step, count) = ((to - from) / steps as f64, if stretch.is_some() { steps + 1 } else { steps });
        let samples: Option<Vec<Option<f64>>> = (0..count)
            .map(|i| {
                let torque = at(from + step * i as f64, &mut scratch).ok()?;
                Some(Some(torque.abs()))
            })
            .collect();
        let (angle, _) = largest(&samples?, (from, step), stretch.is_none(), |angle| {
            at(angle, &mut scratch).ok().map(f64::abs)
        })?;
        let value = at(angle, &mut scratch).ok()?;
        Some(Peak { value, crank_deg: angle.to_degrees() })
    }
}
