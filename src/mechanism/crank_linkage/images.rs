//! Images of a linkage that a crank drives: moved, turned, mirrored, scaled.

use super::CrankLinkage;
use crate::mechanism::{
    AssemblyMode, Complex, FourBar, InvertedSliderCrank, InvertedSliderCrankParameters, LinkageError,
    NaturalCoordinates, SliderCrank, SliderCrankParameters, xy,
};

impl CrankLinkage {
    /// Returns the image p -> shift + turn p of the linkage, of its mirror image in the x axis if it is to be mirrored.
    ///
    /// # Errors
    /// If a coordinate leaves the allowed range.
    pub fn carried(&self, mirrors: bool, turn: Complex, shift: Complex) -> Result<Self, LinkageError> {
        let place = |[x, y]: [f64; 2]| xy(shift + turn * Complex::new(x, if mirrors { -y } else { y }));
        let sign = if mirrors { -1.0 } else { 1.0 };
        Ok(match self {
            CrankLinkage::FourBar(linkage) => {
                let own = linkage.natural_coordinates();
                CrankLinkage::FourBar(FourBar::new(NaturalCoordinates {
                    crank_pivot: place(own.crank_pivot),
                    follower_pivot: place(own.follower_pivot),
                    assembly: self.carried_assembly(mirrors, own.assembly),
                    side: if mirrors { own.side.opposite() } else { own.side },
                    ..own
                })?)
            }
            CrankLinkage::SliderCrank(linkage) => {
                let own = linkage.parameters();
                CrankLinkage::SliderCrank(SliderCrank::new(SliderCrankParameters {
                    crank_pivot: place(own.crank_pivot),
                    line_point: place(own.line_point),
                    line_deg: turn.arg().to_degrees() + sign * own.line_deg,
                    coupler_y: sign * own.coupler_y,
                    ..own
                })?)
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                let own = linkage.parameters();
                CrankLinkage::InvertedSliderCrank(InvertedSliderCrank::new(InvertedSliderCrankParameters {
                    crank_pivot: place(own.crank_pivot),
                    block_pivot: place(own.block_pivot),
                    offset: sign * own.offset,
                    coupler_y: sign * own.coupler_y,
                    ..own
                })?)
            }
            CrankLinkage::MultiLoop(linkage) => {
                CrankLinkage::MultiLoop(linkage.carried(mirrors, turn, shift)?)
            }
        })
    }

    /// Returns the assembly that an assembly becomes in the image: the mirror image of a four-bar and of a six-bar has the
    /// other one, a slider's the same.
    pub fn carried_assembly(&self, mirrors: bool, assembly: AssemblyMode) -> AssemblyMode {
        if mirrors && (self.four_bar().is_some() || self.multi_loop().is_some()) {
            assembly.opposite()
        } else {
            assembly
        }
    }

    /// Returns the same linkage described the other way round: with the opposite direction of a slider-crank's line, or of the line
    /// of an inverted one's coupler, and the opposite t1. `None` if it has no slider.
    pub fn reversed(&self) -> Option<Self> {
        match self {
            CrankLinkage::SliderCrank(linkage) => {
                let own = linkage.parameters();
                let reversed = SliderCrankParameters {
                    line_deg: own.line_deg - 180.0_f64.copysign(own.line_deg),
                    assembly: own.assembly.opposite(),
                    ..own
                };
                SliderCrank::new(reversed).ok().map(CrankLinkage::SliderCrank)
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                let own = linkage.parameters();
                let reversed = InvertedSliderCrankParameters {
                    offset: -own.offset,
                    coupler_x: -own.coupler_x,
                    coupler_y: -own.coupler_y,
                    assembly: own.assembly.opposite(),
                    ..own
                };
                InvertedSliderCrank::new(reversed).ok().map(CrankLinkage::InvertedSliderCrank)
            }
            CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => None,
        }
    }

    /// Returns the linkage moved by the vector `by`.
    ///
    /// # Errors
    /// If a coordinate leaves the allowed range.
    pub fn shifted(&self, by: Complex) -> Result<Self, LinkageError> {
        Ok(match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.shifted(by)?),
            CrankLinkage::SliderCrank(linkage) => CrankLinkage::SliderCrank(linkage.shifted(by)?),
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(linkage.shifted(by)?)
            }
            CrankLinkage::MultiLoop(linkage) => {
                CrankLinkage::MultiLoop(linkage.carried(false, Complex::new(1.0, 0.0), by)?)
            }
        })
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// If a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        Ok(match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.scaled(factor)?),
            CrankLinkage::SliderCrank(linkage) => CrankLinkage::SliderCrank(linkage.scaled(factor)?),
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(linkage.scaled(factor)?)
            }
            CrankLinkage::MultiLoop(linkage) => CrankLinkage::MultiLoop(linkage.scaled(factor)?),
        })
    }
}
