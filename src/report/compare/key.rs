//! The figures by which a comparison can be ranked.

use crate::report::text::clean;
use std::cmp::Ordering;
use std::str::FromStr;

/// A figure by which a comparison can be ranked.
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
    /// The diagonal of the box of all joints and P over the motion that the points use, least first.
    Extent,
    /// The objective of the candidate's problem, least first: the sum of squared errors with its weights, or the
    /// largest error, in parts of the tolerances if these are given.
    Objective,
    /// The root of the mean squared error of a body's angle, least first.
    AngleRms,
    /// The largest error of a body's angle, least first.
    AngleMax,
}

impl SortKey {
    /// Every key.
    pub const ALL: [SortKey; 11] = [
        SortKey::SumSq,
        SortKey::Rms,
        SortKey::Max,
        SortKey::ToCurve,
        SortKey::Transmission,
        SortKey::LinkRatio,
        SortKey::Size,
        SortKey::Extent,
        SortKey::Objective,
        SortKey::AngleRms,
        SortKey::AngleMax,
    ];

    /// Returns whether only motions have this figure.
    pub fn is_of_motions(self) -> bool {
        matches!(self, SortKey::AngleRms | SortKey::AngleMax)
    }

    /// Returns the name on the command line: `to_curve`.
    pub fn name(self) -> &'static str {
        const NAMES: [&str; SortKey::ALL.len()] = [
            "sum_sq",
            "rms",
            "max",
            "to_curve",
            "transmission",
            "link_ratio",
            "size",
            "extent",
            "objective",
            "angle_rms",
            "angle_max",
        ];
        NAMES[self as usize]
    }

    /// Compares two figures, the better one first.
    pub(super) fn order(self, x: f64, y: f64) -> Ordering {
        if self == SortKey::Transmission { y.total_cmp(&x) } else { x.total_cmp(&y) }
    }
}

/// The error that a word is not the name of a key.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no figure is called \"{}\": sort by {}", .0, SortKey::ALL.map(SortKey::name).join(", "))]
pub struct UnknownKey(pub String);

impl FromStr for SortKey {
    type Err = UnknownKey;
    fn from_str(name: &str) -> Result<Self, UnknownKey> {
        SortKey::ALL.into_iter().find(|key| key.name() == name).ok_or_else(|| UnknownKey(clean(name)))
    }
}
