//! A slider-crank as a chain of a crank, a slider on a fixed line and a point of the coupler, and back.

use super::SliderCrank;
use crate::mechanism::chain::{Attachment, Chain, ChainBuilder, ChainError, SliderLine, Stage};
use crate::mechanism::four_bar::coupler_ratio;
use crate::mechanism::slider::SliderLinkage;
use crate::mechanism::{Complex, point, xy};

impl SliderCrank {
    /// Returns the linkage as a chain with the points A, C, D and P, of which P is traced.
    ///
    /// # Errors
    /// [`ChainError`] if a coupler is so short beside the coordinates that C and D coincide within rounding.
    pub fn to_chain(&self) -> Result<Chain, Box<ChainError>> {
        let p = self.parameters;
        ChainBuilder::new()
            .pivot("A", p.crank_pivot)
            .crank("A", "C", p.crank)
            .slider("D", "C", p.coupler, p.line_point, self.line_angle(), p.assembly)
            .point("P", ["C", "D"], xy(self.coupler_offset()))
            .trace("P")
            .build()
    }

    /// Returns the slider-crank that a chain is: a crank, a slider from its joint on a fixed line, and, if that is the
    /// traced point, a point of the coupler. `None` for every other chain.
    pub fn from_chain(chain: &Chain) -> Option<SliderCrank> {
        let source = chain.source();
        let (_, pivot) = source.pivots.iter().find(|(name, _)| *name == source.crank_pivot)?;
        let (first, rest) = source.stages.split_first()?;
        let Stage::Slider { joint, from, length, line: SliderLine::Fixed { through, angle }, side } = first
        else {
            return None;
        };
        if *from != source.crank_joint {
            return None;
        }
        let traced = &chain.names()[chain.trace().index()];
        let offset = match rest {
            [] if traced == joint => Complex::new(*length, 0.0),
            [Stage::Point { name, on, at }] if traced == name => {
                let offset = match at {
                    Attachment::Offset(offset) => point(*offset),
                    Attachment::Distances(distances, side) => {
                        coupler_ratio(*length, *distances, *side).ok()? * *length
                    }
                };
                match on {
                    [c, d] if c == from && d == joint => offset,
                    // From D towards C: the same point, seen from the other end.
                    [d, c] if c == from && d == joint => Complex::new(*length, 0.0) - offset,
                    _ => return None,
                }
            }
            _ => return None,
        };
        let line = (point(*through), *angle);
        SliderCrank::from_parts(point(*pivot), [source.crank, *length], line, offset, *side).ok()
    }
}
