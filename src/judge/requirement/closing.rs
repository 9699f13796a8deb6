//! The way back to the first point, if any is allowed.

use super::{Finding, Judged};
use crate::record::TO_AND_FRO;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let is_told = !judged.require().closing.is_one_way() && judged.problem.task().returns();
    let has = if judged.verdict.to_and_fro { TO_AND_FRO } else { "one-way" };
    is_told.then(|| Finding::word(has, "any", true))
}
