//! The kinds of linkages of one loop, by their names in files.

use serde::{Deserialize, Serialize};

/// The kinds of linkages of one loop.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum LinkageKind {
    /// Four pins.
    FourBar,
    /// Three pins and a block on a fixed line.
    SliderCrank,
    /// Three pins and a block at a fixed pivot, through which the coupler slides.
    InvertedSliderCrank,
}

impl LinkageKind {
    /// Every kind.
    pub const ALL: [LinkageKind; 3] =
        [LinkageKind::FourBar, LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank];

    /// Returns the name in files: `slider-crank`.
    pub fn name(self) -> &'static str {
        match self {
            LinkageKind::FourBar => "four-bar",
            LinkageKind::SliderCrank => "slider-crank",
            LinkageKind::InvertedSliderCrank => "inverted-slider-crank",
        }
    }
}

impl std::fmt::Display for LinkageKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
