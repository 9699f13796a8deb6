//! The longest rigid link, the sides of the coupler's triangle included, against the greatest one.

use super::{Finding, Judged};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let most = judged.require().longest_max?;
    Some(Finding::most(judged.candidate.linkage.longest(), most))
}
