//! The sense of the motion.

use super::{Finding, Judged};
use crate::task::spec::DirectionPolicy;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let wants = match judged.require().direction {
        DirectionPolicy::Any => return None,
        DirectionPolicy::Ccw => true,
        DirectionPolicy::Cw => false,
    };
    let word = |ccw: bool| if ccw { "ccw" } else { "cw" };
    let has = judged.verdict.direction > 0.0;
    Some(Finding::word(word(has), word(wants), has == wants))
}
