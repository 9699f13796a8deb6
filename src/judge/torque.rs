//! The peak torque of a candidate under the loads of its problem.

use crate::mechanism::{AssemblyMode, CrankLinkage};
use crate::task::Problem;

/// Returns the largest size of the torque on the crank (N m) under the loads of a problem, over a full turn of a crank that turns
/// fully, else between the least and the greatest of the crank angles used (radians, unwrapped).
///
/// `None` without loads; if the motion uses another assembly than the linkage's, and so passes a toggle, at which the torque has no
/// bound; if the linkage is open at a sample; and if it lacks a body or a joint of the loads.
pub(super) fn peak_torque(
    problem: &Problem,
    linkage: &CrankLinkage,
    crank_angles: &[f64],
    assemblies: &[AssemblyMode],
) -> Option<f64> {
    let loads = problem.spec().loads.as_ref()?;
    let loaded = loads.on(linkage).ok()?;
    let stretch = if linkage.mobility().input_turns_fully() {
        None
    } else {
        if assemblies.iter().any(|assembly| *assembly != linkage.assembly()) {
            return None;
        }
        let ends = |(low, high): (f64, f64), angle: &f64| (low.min(*angle), high.max(*angle));
        let (low, high) = crank_angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        Some([low, high])
    };
    let peak = loaded.torque_peak_over(stretch, loaded.drive())?;
    Some(peak.value.abs()).filter(|peak| peak.is_finite())
}
