//! Lengths of a linkage that a crank drives, by the names of a four-bar's, and their ratio.

use super::CrankLinkage;
use crate::mechanism::{Complex, SliderLinkage};

impl CrankLinkage {
    /// Returns a = |AC|, the length of the crank.
    pub fn crank(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank(),
            CrankLinkage::MultiLoop(linkage) => linkage.crank(),
        }
    }

    /// Returns P along and across the coupler from C, as lengths; of a six-bar along and across the line of its body
    /// ([`multi_loop`](crate::mechanism::multi_loop)).
    pub fn coupler_offset(&self) -> Complex {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.coupler_offset(),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_offset(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_offset(),
            CrankLinkage::MultiLoop(linkage) => linkage.coupler_point(),
        }
    }

    /// Returns the direction from which crank angles of `offset = "ground"` count: of the line A -> B, or of the slider's
    /// line; 0 for coincident pivots.
    pub fn ground_angle(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.ground_angle(),
            CrankLinkage::SliderCrank(linkage) => linkage.line_angle(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.ground_angle(),
            CrankLinkage::MultiLoop(linkage) => (linkage.follower_pivot() - linkage.crank_pivot()).arg(),
        }
    }

    /// Returns the ratio of the longest to the shortest link: of ground, a, b, c of a four-bar, a and b of a slider-crank,
    /// ground and a of an inverted one, all distances between joints of one body of a six-bar. Infinite for coincident
    /// pivots.
    pub fn link_ratio(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.link_ratio(),
            CrankLinkage::SliderCrank(linkage) => linkage.link_ratio(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.link_ratio(),
            CrankLinkage::MultiLoop(linkage) => linkage.link_ratio(),
        }
    }

    /// Returns the longest link, of those whose ratio [`CrankLinkage::link_ratio`] is.
    pub fn longest_link(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.longest_link(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank().max(linkage.coupler()),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank().max(linkage.ground()),
            CrankLinkage::MultiLoop(linkage) => linkage.longest_link(),
        }
    }

    /// Returns b = |CD|, the length of the coupler; that of an inverted slider-crank slides through its block.
    pub fn coupler(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.coupler()),
            CrankLinkage::SliderCrank(linkage) => Some(linkage.coupler()),
            CrankLinkage::InvertedSliderCrank(_) => None,
            CrankLinkage::MultiLoop(linkage) => Some(linkage.dyads()[0].lengths[0]),
        }
    }

    /// Returns |AB|, the distance of the fixed pivots; a slider-crank has one pivot.
    pub fn ground(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.ground()),
            CrankLinkage::SliderCrank(_) => None,
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage.ground()),
            CrankLinkage::MultiLoop(linkage) => {
                Some((linkage.follower_pivot() - linkage.crank_pivot()).norm())
            }
        }
    }

    /// Returns e = |DP|; `None` of an inverted slider-crank, whose D moves along the coupler, and of a
    /// six-bar, whose P lies on another link.
    pub fn second_side(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.follower_side()),
            CrankLinkage::SliderCrank(linkage) => Some((linkage.coupler_offset() - linkage.coupler()).norm()),
            CrankLinkage::InvertedSliderCrank(_) | CrankLinkage::MultiLoop(_) => None,
        }
    }

    /// Returns |CP|, the distance from the crank pin to the coupler point; of a six-bar that of P from the
    /// first joint of its body's line.
    pub fn crank_side(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank_side(),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_offset().norm(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_offset().norm(),
            CrankLinkage::MultiLoop(linkage) => linkage.coupler_point().norm(),
        }
    }

    /// Returns the largest distance between two joints of one body, P and pivots included; a rail does not count.
    pub fn longest(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => {
                linkage.longest_link().max(linkage.crank_side()).max(linkage.follower_side())
            }
            CrankLinkage::SliderCrank(linkage) => linkage.longest(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.longest(),
            CrankLinkage::MultiLoop(linkage) => linkage.longest(),
        }
    }
}
