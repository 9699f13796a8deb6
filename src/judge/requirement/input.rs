//! The range of the input: a full turn of the crank.

use super::{Finding, Judged};
use crate::task::requirement::InputPolicy;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    if judged.require().input != InputPolicy::FullTurn {
        return None;
    }
    let turns = judged.candidate.linkage.mobility().input_turns_fully();
    Some(Finding::word(if turns { "full-turn" } else { "part of a turn" }, "full-turn", turns))
}
