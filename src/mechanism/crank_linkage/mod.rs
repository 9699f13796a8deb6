//! Linkages that a crank drives, of the kinds that synthesis finds, behind one type: four-bar, slider-crank, inverted
//! slider-crank, and six-bars and eight-bars.
//!
//! The first three have one loop: C = A + a e^{i phi}, a coupler through C that carries P, and one closure with two roots, told by
//! t1; see [`slider`](super::slider). A four-bar's numbers are those of [`FourBar`], to the last digit. Six-bars and eight-bars
//! ([`MultiLoop`]) have a sign for each dyad; t1 is that of the first, and the others are part of the linkage.

//!
//! | module | holds |
//! |---|---|
//! | `images` | a linkage moved, turned, mirrored, scaled |
//! | `keys` | how a linkage is written and read |
//! | `kind` | the kinds, by their names in files |
//! | `mobility` | how far the input turns, on which circuits and branches |
//! | `positions` | the joints at a crank angle, and the angle or the place of the output |
//! | `sizes` | lengths, by the names of a four-bar's, and their ratio |
//! | `transmission` | transmission angles, at a position and over a motion |

mod images;
mod keys;
mod kind;
mod mobility;
mod positions;
mod sizes;
mod transmission;

pub use keys::{LinkageKeys, NoLinkage};
pub use kind::{LinkageKind, article};
pub use mobility::LoopMobility;
pub use positions::LoopJoints;

use super::any::Mechanism;
use super::four_bar::coupler_curve::CrankDriven;
use super::{
    AssemblyMode, Complex, FourBar, InputArc, InvertedSliderCrank, MultiLoop, SliderCrank, SliderLinkage,
};

/// A linkage that a crank drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrankLinkage {
    /// A four-bar.
    FourBar(FourBar),
    /// A slider-crank.
    SliderCrank(SliderCrank),
    /// An inverted slider-crank.
    InvertedSliderCrank(InvertedSliderCrank),
    /// A six-bar or an eight-bar.
    MultiLoop(MultiLoop),
}

impl CrankLinkage {
    /// Returns the kind.
    pub fn kind(&self) -> LinkageKind {
        match self {
            CrankLinkage::FourBar(_) => LinkageKind::FourBar,
            CrankLinkage::SliderCrank(_) => LinkageKind::SliderCrank,
            CrankLinkage::InvertedSliderCrank(_) => LinkageKind::InvertedSliderCrank,
            CrankLinkage::MultiLoop(linkage) => linkage.linkage_kind(),
        }
    }

    /// Returns the four-bar, if it is one.
    pub fn four_bar(&self) -> Option<&FourBar> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the six-bar or eight-bar, if it is one.
    pub fn multi_loop(&self) -> Option<&MultiLoop> {
        match self {
            CrankLinkage::MultiLoop(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the slider-crank, if it is one.
    pub fn slider_crank(&self) -> Option<&SliderCrank> {
        match self {
            CrankLinkage::SliderCrank(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the inverted slider-crank, if it is one.
    pub fn inverted_slider_crank(&self) -> Option<&InvertedSliderCrank> {
        match self {
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the linkage as a mechanism of any kind.
    pub fn mechanism(&self) -> &dyn Mechanism {
        match self {
            CrankLinkage::FourBar(linkage) => linkage,
            CrankLinkage::SliderCrank(linkage) => linkage,
            CrankLinkage::InvertedSliderCrank(linkage) => linkage,
            CrankLinkage::MultiLoop(linkage) => linkage,
        }
    }

    /// Returns the same linkage with the given sign of the closure's root.
    #[must_use]
    pub fn with_assembly(self, assembly: AssemblyMode) -> Self {
        CrankDriven::with_assembly(self, assembly)
    }

    /// Returns t1, the sign of the closure's root.
    pub fn assembly(&self) -> AssemblyMode {
        CrankDriven::assembly(self)
    }

    /// Returns A, the fixed pivot of the crank.
    pub fn crank_pivot(&self) -> Complex {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank_pivot(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank_pivot(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank_pivot(),
            CrankLinkage::MultiLoop(linkage) => linkage.crank_pivot(),
        }
    }

    /// Returns the second fixed pivot B, of the follower or of the block; a slider-crank has none.
    pub fn second_pivot(&self) -> Option<Complex> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.follower_pivot()),
            CrankLinkage::SliderCrank(_) => None,
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage.block_pivot()),
            CrankLinkage::MultiLoop(linkage) => Some(linkage.follower_pivot()),
        }
    }

    /// Returns the fixed pivots.
    pub fn pivots(&self) -> impl Iterator<Item = Complex> + use<> {
        let of_one_loop = || std::iter::once(self.crank_pivot()).chain(self.second_pivot()).collect();
        self.multi_loop().map_or_else(of_one_loop, MultiLoop::pivots).into_iter()
    }

    /// Returns its numbers, by which equals are ordered: those of its keys, as many as there are.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.natural_coordinates().numbers().to_vec(),
            CrankLinkage::SliderCrank(linkage) => {
                let p = linkage.parameters();
                let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
                vec![ax, ay, qx, qy, p.line_deg, p.crank, p.coupler, p.coupler_x, p.coupler_y]
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                let p = linkage.parameters();
                let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
                vec![ax, ay, bx, by, p.crank, p.offset, p.coupler_x, p.coupler_y]
            }
            CrankLinkage::MultiLoop(linkage) => linkage.numbers(),
        }
    }
}

impl CrankDriven for CrankLinkage {
    fn with_assembly(self, assembly: AssemblyMode) -> Self {
        match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.with_assembly(assembly)),
            CrankLinkage::SliderCrank(linkage) => {
                CrankLinkage::SliderCrank(SliderLinkage::with_assembly(linkage, assembly))
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(SliderLinkage::with_assembly(linkage, assembly))
            }
            CrankLinkage::MultiLoop(linkage) => CrankLinkage::MultiLoop(linkage.with_assembly(assembly)),
        }
    }

    fn assembly(&self) -> AssemblyMode {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.assembly(),
            CrankLinkage::SliderCrank(linkage) => SliderLinkage::assembly(linkage),
            CrankLinkage::InvertedSliderCrank(linkage) => SliderLinkage::assembly(linkage),
            CrankLinkage::MultiLoop(linkage) => linkage.assembly(),
        }
    }

    fn coupler_point_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Complex> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::MultiLoop(linkage) => linkage.with_assembly(assembly).point_at(crank_angle),
        }
    }

    fn arc_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<InputArc> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::SliderCrank(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::MultiLoop(_) => None,
        }
    }
}

impl From<FourBar> for CrankLinkage {
    fn from(linkage: FourBar) -> Self {
        CrankLinkage::FourBar(linkage)
    }
}

impl From<&FourBar> for CrankLinkage {
    fn from(linkage: &FourBar) -> Self {
        CrankLinkage::FourBar(*linkage)
    }
}

impl From<SliderCrank> for CrankLinkage {
    fn from(linkage: SliderCrank) -> Self {
        CrankLinkage::SliderCrank(linkage)
    }
}

impl From<InvertedSliderCrank> for CrankLinkage {
    fn from(linkage: InvertedSliderCrank) -> Self {
        CrankLinkage::InvertedSliderCrank(linkage)
    }
}

impl From<MultiLoop> for CrankLinkage {
    fn from(linkage: MultiLoop) -> Self {
        CrankLinkage::MultiLoop(linkage)
    }
}

impl From<&CrankLinkage> for CrankLinkage {
    fn from(linkage: &CrankLinkage) -> Self {
        *linkage
    }
}

impl From<CrankLinkage> for super::Linkage {
    fn from(linkage: CrankLinkage) -> Self {
        match linkage {
            CrankLinkage::FourBar(linkage) => super::Linkage::FourBar(linkage),
            CrankLinkage::SliderCrank(linkage) => super::Linkage::SliderCrank(linkage),
            CrankLinkage::InvertedSliderCrank(linkage) => super::Linkage::InvertedSliderCrank(linkage),
            CrankLinkage::MultiLoop(linkage) => super::Linkage::MultiLoop(Box::new(linkage)),
        }
    }
}

impl std::fmt::Display for CrankLinkage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.fmt(f),
            CrankLinkage::SliderCrank(linkage) => linkage.fmt(f),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.fmt(f),
            CrankLinkage::MultiLoop(linkage) => linkage.fmt(f),
        }
    }
}
