//! Figures by which linkages are compared in a front, computed from a judged candidate alone.

use crate::judge::practicality::sensitivity_of;
use crate::judge::referee::judge;
use crate::record::{Candidate, Figures};
use crate::task::Problem;

/// Returns the diagonal of the box of A, B, C, D and P over the motion that a candidate uses.
pub fn extent(problem: &Problem, candidate: &Candidate) -> f64 {
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let verdict = judge(problem.task(), candidate.linkage, &radians, &candidate.t1_at);
    let [x0, y0, x1, y1] = verdict.motion.footprint();
    (x1 - x0).hypot(y1 - y0)
}

/// Returns all figures of a candidate; `None` if the path has no direction at any point (every point is at a toggle).
pub fn figures(problem: &Problem, candidate: &Candidate) -> Option<Figures> {
    let felt = sensitivity_of(problem, candidate)?;
    Some(Figures {
        rms: candidate.error.rms,
        max: candidate.error.max,
        transmission_deg: candidate.transmission_deg.worst,
        extent: extent(problem, candidate),
        longest: candidate.linkage.longest(),
        link_ratio: candidate.link_ratio,
        sensitivity: felt.band,
        peak_torque: candidate.peak_torque,
    })
}
