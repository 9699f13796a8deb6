//! The longest rigid link, the sides of the coupler's triangle included, against the greatest one.

use super::{Finding, Judged};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let most = judged.require().longest_max?;
    let linkage = &judged.candidate.linkage;
    let sides = linkage.crank_side().max(linkage.follower_side());
    Some(Finding::most(linkage.longest_link().max(sides), most))
}
