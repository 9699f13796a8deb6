//! The units that label lengths.

use serde::{Deserialize, Serialize};

/// The unit that labels lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    In,
}

impl Unit {
    /// Every unit.
    pub const ALL: [Unit; 4] = [Unit::Mm, Unit::Cm, Unit::M, Unit::In];

    /// Returns the factor that converts a length in this unit to one in `to`: exactly 1 if they are the same.
    ///
    /// ```
    /// use linkwright::Unit;
    /// assert_eq!((Unit::In.factor_to(Unit::Mm), Unit::Cm.factor_to(Unit::Cm)), (25.4, 1.0));
    /// ```
    pub fn factor_to(self, to: Unit) -> f64 {
        let millimetres = |unit| match unit {
            Unit::Mm => 1.0,
            Unit::Cm => 10.0,
            Unit::M => 1000.0,
            Unit::In => 25.4,
        };
        millimetres(self) / millimetres(to)
    }

    /// The label: mm, cm, m or in.
    pub fn label(self) -> &'static str {
        match self {
            Unit::Mm => "mm",
            Unit::Cm => "cm",
            Unit::M => "m",
            Unit::In => "in",
        }
    }
}
