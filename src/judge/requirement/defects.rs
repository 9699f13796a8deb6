//! Order, branch and circuit, as the referee found them.

use super::{Finding, Judged};
use crate::record::TO_AND_FRO;
use crate::task::Defect;
use crate::task::spec::{OnePolicy, OrderPolicy};

pub(super) fn order(judged: &Judged<'_>) -> Option<Finding> {
    if judged.require().order == OrderPolicy::Any {
        return None;
    }
    let defects = &judged.candidate.defects;
    let found = defects.iter().any(|defect| matches!(defect, Defect::Order { .. }));
    let has = match found {
        false => "required",
        true if defects.iter().any(Defect::is_to_and_fro) => TO_AND_FRO,
        true => "broken",
    };
    Some(Finding::word(has, "required", !found))
}

pub(super) fn branch(judged: &Judged<'_>) -> Option<Finding> {
    one(judged, judged.require().branch, |defect| matches!(defect, Defect::Branch { .. }))
}

pub(super) fn circuit(judged: &Judged<'_>) -> Option<Finding> {
    one(judged, judged.require().circuit, |defect| matches!(defect, Defect::Circuit { .. }))
}

fn one(judged: &Judged<'_>, policy: OnePolicy, is: fn(&Defect) -> bool) -> Option<Finding> {
    let found = judged.candidate.defects.iter().any(is);
    let has = if found { "several" } else { "one" };
    (policy == OnePolicy::One).then(|| Finding::word(has, "one", !found))
}
