//! The worst transmission angle against the least one.

use super::{Finding, Judged};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let least = judged.require().transmission_deg_min?;
    Some(Finding::least(judged.candidate.transmission_deg.worst, least))
}
