//! An inverted slider-crank as a chain of a crank and a guide through a block at a fixed pivot, and back.

use super::InvertedSliderCrank;
use crate::mechanism::chain::{Chain, ChainBuilder, ChainError, Stage};
use crate::mechanism::slider::SliderLinkage;
use crate::mechanism::{point, xy};

impl InvertedSliderCrank {
    /// Returns the linkage as a chain with the points A, B, C and P, of which P is traced; D is no joint.
    ///
    /// # Errors
    /// [`ChainError`] if P lies on C: a guide of a chain needs a length.
    pub fn to_chain(&self) -> Result<Chain, Box<ChainError>> {
        let p = self.parameters;
        ChainBuilder::new()
            .pivot("A", p.crank_pivot)
            .pivot("B", p.block_pivot)
            .crank("A", "C", p.crank)
            .stage(Stage::Guide {
                joint: "P".into(),
                pivot: "C".into(),
                block: "B".into(),
                at: xy(self.coupler_offset()),
                offset: p.offset,
                side: p.assembly,
            })
            .trace("P")
            .build()
    }

    /// Returns the inverted slider-crank that a chain is: a crank and a guide about its joint, through a block at a fixed
    /// pivot, whose joint is traced. `None` for every other chain.
    pub fn from_chain(chain: &Chain) -> Option<InvertedSliderCrank> {
        let source = chain.source();
        let pivot = |of: &str| source.pivots.iter().find(|(name, _)| name == of).map(|(_, at)| point(*at));
        let [Stage::Guide { joint, pivot: turns_about, block, at, offset, side }] = &source.stages[..] else {
            return None;
        };
        if *turns_about != source.crank_joint || chain.names()[chain.trace().index()] != *joint {
            return None;
        }
        let pivots = [pivot(&source.crank_pivot)?, pivot(block)?];
        InvertedSliderCrank::from_parts(pivots, source.crank, *offset, point(*at), *side).ok()
    }
}
