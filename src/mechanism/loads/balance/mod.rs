//! Balance of a loaded linkage: springs that hold it where it is put, and counter-masses for an even torque or a quiet frame.
//!
//! The torque T of the crank is linear in every load, so that both are linear least squares in non-negative unknowns (Lawson and
//! Hanson 1974, [`nonnegative_least_squares`](crate::numbers::optimise::nonnegative)); residuals are those of the balanced loads
//! themselves, computed anew by the mechanics at more crank angles than the fit had.
//!
//! | module | holds |
//! |---|---|
//! | [`error`] | why a balance is refused |
//! | [`masses`] | counter-masses on bodies that turn about fixed pivots |
//! | [`spring`] | rate and free length, or free angle, of a spring between given places |

pub mod error;
pub mod masses;
pub mod spring;

pub use error::BalanceError;
pub use masses::{CounterMass, MassAim, MassBalance, MassRequest, balance_by_masses};
pub use spring::{SpringBalance, SpringEnds, SpringRequest, balance_by_spring};

use super::drive::Drive;
use super::figures::Peak;
use super::loaded::LoadedLinkage;
use crate::mechanism::four_bar::motion::CrankMotion;
use serde::Serialize;

/// The number of steps of a range in a fit.
const STEPS: usize = 180;
/// The number of steps of a range when a balance is verified.
const VERIFIED: usize = 1800;

/// The torque over a range of crank angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TorqueOver {
    /// The torque of largest size, N m.
    #[serde(rename = "peak_N_m")]
    pub peak: Peak,
    /// The root mean square, N m.
    #[serde(rename = "rms_N_m")]
    pub rms: f64,
}

impl TorqueOver {
    /// Computes the torque of a crank at rest over a range of crank angles (radians).
    ///
    /// # Errors
    /// [`BalanceError::NotClosed`] at the first sample at which the linkage is open or at a toggle.
    fn of(loaded: &LoadedLinkage, range: [f64; 2]) -> Result<Self, BalanceError> {
        let torques = torques(loaded, range, VERIFIED)?;
        let rms = (torques.iter().map(|t| t * t).sum::<f64>() / torques.len() as f64).sqrt();
        let largest = || {
            let all = torques.iter().enumerate().max_by(|(_, s), (_, t)| s.abs().total_cmp(&t.abs()));
            let (i, value) = all.map_or((0, 0.0), |(i, value)| (i, *value));
            Peak { value, crank_deg: angle(range, VERIFIED, i).to_degrees() }
        };
        Ok(TorqueOver {
            peak: loaded.torque_peak_over(Some(range), &Drive::still()).unwrap_or_else(largest),
            rms,
        })
    }
}

/// Returns the crank angle of a step.
fn angle([from, to]: [f64; 2], steps: usize, i: usize) -> f64 {
    from + (to - from) * i as f64 / steps as f64
}

/// Computes the torque of a crank at rest at the steps of a range.
fn torques(loaded: &LoadedLinkage, range: [f64; 2], steps: usize) -> Result<Vec<f64>, BalanceError> {
    let mut scratch = loaded.scratch();
    let at = |i: usize| {
        let angle = angle(range, steps, i);
        let torque = loaded.torque(angle, CrankMotion::steady(0.0), &mut scratch);
        torque.map_err(|_| BalanceError::NotClosed { crank_deg: angle.to_degrees() })
    };
    (0..=steps).map(at).collect()
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(x, y)| x * y).sum()
}

/// Returns a part of a whole in percent; 0 of nothing.
fn percent(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { 100.0 * part / whole } else { 0.0 }
}
