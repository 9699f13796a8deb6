//! The torque of largest size on the crank against the greatest one. Without a peak, of a motion that passes a toggle, it is not
//! met: there the torque has no bound.

use super::{Finding, Judged};
use crate::record::Figure;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let most = judged.require().peak_torque_max?;
    Some(match judged.candidate.peak_torque {
        Some(peak) => Finding::most(peak, most),
        None => Finding { value: Figure::Word("none".into()), limit: Figure::Number(most), met: false },
    })
}
