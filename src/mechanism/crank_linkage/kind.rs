//! The kinds of linkages that synthesis finds, by their names in files.

use serde::{Deserialize, Serialize};

/// Returns the article before a name: `an` of `eight-bar`.
pub fn article(name: &str) -> &'static str {
    if name.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" }
}

/// The kinds of linkages that a crank drives.
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
    /// A crank and two dyads.
    SixBar,
    /// A crank and three dyads.
    EightBar,
}

impl LinkageKind {
    /// Every kind.
    pub const ALL: [LinkageKind; 5] = [
        LinkageKind::FourBar,
        LinkageKind::SliderCrank,
        LinkageKind::InvertedSliderCrank,
        LinkageKind::SixBar,
        LinkageKind::EightBar,
    ];

    /// Returns whether it has a slider.
    pub fn has_slider(self) -> bool {
        matches!(self, LinkageKind::SliderCrank | LinkageKind::InvertedSliderCrank)
    }

    /// Returns the number of dyads of a linkage of several loops, a six-bar or an eight-bar.
    pub fn dyads(self) -> Option<usize> {
        match self {
            LinkageKind::SixBar => Some(2),
            LinkageKind::EightBar => Some(3),
            _ => None,
        }
    }

    /// Returns the name with its article: `an eight-bar`.
    pub fn with_article(self) -> String {
        format!("{} {self}", article(self.name()))
    }

    /// Returns the name in files: `slider-crank`.
    pub fn name(self) -> &'static str {
        match self {
            LinkageKind::FourBar => "four-bar",
            LinkageKind::SliderCrank => "slider-crank",
            LinkageKind::InvertedSliderCrank => "inverted-slider-crank",
            LinkageKind::SixBar => "six-bar",
            LinkageKind::EightBar => "eight-bar",
        }
    }
}

impl std::fmt::Display for LinkageKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
