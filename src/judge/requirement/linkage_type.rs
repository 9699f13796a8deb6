//! The type, among those allowed.

use super::{Finding, Judged};
use crate::record::Figure;

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let (allowed, has) = (&judged.require().types, judged.candidate.linkage_type);
    (!allowed.is_empty()).then(|| Finding {
        value: Figure::Word(judged.candidate.type_name().into()),
        limit: Figure::Words(allowed.iter().map(|kind| kind.name().into()).collect()),
        // Other kinds have no type of a four-bar.
        met: has.is_none_or(|has| allowed.contains(&has)),
    })
}
