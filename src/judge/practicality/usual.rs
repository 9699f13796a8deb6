//! Default tolerance of dimensions, and the length of a millimetre in a unit.

use crate::mechanism::FourBar;
use crate::mechanism::Unit;

/// The default standard deviation of a dimension, in millimetres.
const TOLERANCE_MM: f64 = 0.1;
/// The default standard deviation of a dimension without a unit, as a part of the longest link.
const TOLERANCE_SHARE: f64 = 1e-3;

/// Returns the length of a millimetre in a unit.
pub fn millimetre(unit: Unit) -> f64 {
    match unit {
        Unit::Mm => 1.0,
        Unit::Cm => 0.1,
        Unit::M => 1e-3,
        Unit::In => 1.0 / 25.4,
    }
}

/// Returns the default standard deviation of a dimension: 0.1 mm, or, if the unit is not known, a thousandth of the
/// longest link.
pub fn usual_tolerance(linkage: &FourBar, unit: Option<Unit>) -> f64 {
    unit.map_or(TOLERANCE_SHARE * linkage.longest_link(), |unit| TOLERANCE_MM * millimetre(unit))
}
