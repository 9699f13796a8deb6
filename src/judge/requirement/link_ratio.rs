//! The ratio of the longest to the shortest link against the greatest one.

use super::{Finding, Judged};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    Some(Finding::most(judged.candidate.link_ratio, judged.require().link_ratio_max))
}
