//! Default tolerance of dimensions.

use crate::mechanism::{CrankLinkage, Unit};

/// The default standard deviation of a dimension, in millimetres.
const TOLERANCE_MM: f64 = 0.1;
/// The default standard deviation of a dimension without a unit, as a part of the longest link.
const TOLERANCE_SHARE: f64 = 1e-3;

/// Returns the default standard deviation of a dimension: 0.1 mm, or, if the unit is not known, a thousandth of the
/// longest link.
pub fn usual_tolerance(linkage: impl Into<CrankLinkage>, unit: Option<Unit>) -> f64 {
    let linkage = linkage.into();
    unit.map_or(TOLERANCE_SHARE * linkage.longest_link(), |unit| TOLERANCE_MM * Unit::Mm.factor_to(unit))
}
