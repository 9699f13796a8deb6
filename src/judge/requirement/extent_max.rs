//! The diagonal of the motion's box against the greatest one.

use super::{Finding, Judged};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let most = judged.require().extent_max?;
    let [x0, y0, x1, y1] = judged.verdict.motion.footprint();
    Some(Finding::most((x1 - x0).hypot(y1 - y0), most))
}
