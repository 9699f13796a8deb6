//! The sense of the motion.

use super::{Finding, Judged};
use crate::task::spec::DirectionPolicy;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let wants = match judged.require().direction {
        DirectionPolicy::Any => return None,
        DirectionPolicy::Ccw => "ccw",
        DirectionPolicy::Cw => "cw",
    };
    let direction = judged.verdict.direction;
    let has = if direction == 0.0 {
        "none"
    } else if direction > 0.0 {
        "ccw"
    } else {
        "cw"
    };
    Some(Finding::word(has, wants, has == wants))
}
