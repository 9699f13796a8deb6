//! The figures that a comparison ranks by.

use crate::report::text::clean;
use std::str::FromStr;

/// What a comparison ranks by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SortKey {
    /// The sum of squared errors, least first.
    #[default]
    SumSq,
    /// The root of the mean square, least first.
    Rms,
    /// The largest error, least first.
    Max,
    /// The rms distance to the whole coupler curve, least first.
    ToCurve,
    /// The worst transmission angle, greatest first.
    Transmission,
    /// Longest over shortest link, least first.
    LinkRatio,
    /// The diagonal of the box that the joints sweep over the circuit, least first.
    Size,
    /// What the candidate's problem minimises, least first: the sum of squared errors with its weights, or the largest
    /// error, where tolerances are given in parts of them.
    Objective,
}

impl SortKey {
    /// Every key.
    pub const ALL: [SortKey; 8] = [
        SortKey::SumSq,
        SortKey::Rms,
        SortKey::Max,
        SortKey::ToCurve,
        SortKey::Transmission,
        SortKey::LinkRatio,
        SortKey::Size,
        SortKey::Objective,
    ];

    /// Its name on the command line: `to_curve`.
    pub fn name(self) -> &'static str {
        match self {
            SortKey::SumSq => "sum_sq",
            SortKey::Rms => "rms",
            SortKey::Max => "max",
            SortKey::ToCurve => "to_curve",
            SortKey::Transmission => "transmission",
            SortKey::LinkRatio => "link_ratio",
            SortKey::Size => "size",
            SortKey::Objective => "objective",
        }
    }

    /// Whether more is better.
    pub fn greatest_first(self) -> bool {
        self == SortKey::Transmission
    }

    /// What a person reads: `worst transmission angle`.
    pub fn words(self) -> &'static str {
        match self {
            SortKey::SumSq => "sum of squared errors",
            SortKey::Rms => "rms error",
            SortKey::Max => "largest error",
            SortKey::ToCurve => "rms distance to the curve",
            SortKey::Transmission => "worst transmission angle",
            SortKey::LinkRatio => "link ratio",
            SortKey::Size => "size",
            SortKey::Objective => "what was minimised",
        }
    }
}

/// A key that doesn't exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no figure is called \"{}\": sort by {}", .0, SortKey::ALL.map(SortKey::name).join(", "))]
pub struct UnknownKey(pub String);

impl FromStr for SortKey {
    type Err = UnknownKey;
    fn from_str(name: &str) -> Result<Self, UnknownKey> {
        SortKey::ALL.into_iter().find(|key| key.name() == name).ok_or_else(|| UnknownKey(clean(name)))
    }
}
