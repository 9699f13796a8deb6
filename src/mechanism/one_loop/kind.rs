//! The kinds of linkages of one loop, by their names in files.

use serde::{Deserialize, Serialize};

/// The kinds of linkages of one loop.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum LoopKind {
    /// Four pins.
    FourBar,
    /// Three pins and a block on a fixed line.
    SliderCrank,
    /// Three pins and a block at a fixed pivot, through which the coupler slides.
    InvertedSliderCrank,
}

impl LoopKind {
    /// Every kind.
    pub const ALL: [LoopKind; 3] = [LoopKind::FourBar, LoopKind::SliderCrank, LoopKind::InvertedSliderCrank];

    /// Returns the name in files: `slider-crank`.
    pub fn name(self) -> &'static str {
        match self {
            LoopKind::FourBar => "four-bar",
            LoopKind::SliderCrank => "slider-crank",
            LoopKind::InvertedSliderCrank => "inverted-slider-crank",
        }
    }
}

impl std::fmt::Display for LoopKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
