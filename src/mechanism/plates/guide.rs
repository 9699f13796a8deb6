//! The guide of a slider: a slot of the width of a pin, and a block with two pins that run in it.
//!
//! ```text
//!      S                  E     D     F            T       S, T   ends of the slot's centre line
//!     (===================o=====o=====o=============)      E, F   guide pins of the block, D between them
//!      |- end -|- ... the block's travel ... -|- end -|
//! ```
//!
//! Two pins keep the block from turning, and all parts are plates with round holes: nothing has to fit between edges.
//! The pins run in the slot as they run in a hole, since the slot is as wide as a hole.

use super::Stretch;
use crate::mechanism::slider::SliderLinkage;

/// The largest lever arm of the force on a block, in parts of the distance between its guide pins, beyond which it may
/// jam (the rule of two to one of makers of linear guides).
const LEVER: f64 = 2.0;
/// The room beyond the outermost place of a guide pin at either end of the slot, in parts of a hole.
const END: f64 = 0.5;

/// The sizes from which a guide follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// The diameter of the holes for pins.
    pub hole: f64,
    /// The material around a hole.
    pub margin: f64,
}

/// The guide of a slider, as lengths along the line on which it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// The least and the greatest place of D over the motion.
    pub travel: [f64; 2],
    /// The distance from D to either guide pin.
    pub half: f64,
    /// The room at either end of the slot.
    pub end: f64,
    /// The width of the slot.
    pub width: f64,
}

impl Guide {
    /// Returns the guide for a travel of D, with the force on the block at most `lever` from its line.
    pub(super) fn new(travel: [f64; 2], Sizes { hole, margin }: Sizes, lever: f64) -> Self {
        let half = (hole + margin).max(0.5 * lever / LEVER);
        Guide { travel, half, end: END * hole, width: hole }
    }

    /// Returns the places of the two ends of the slot's centre line.
    pub fn ends(&self) -> [f64; 2] {
        let [low, high] = self.travel;
        [low - self.half - self.end, high + self.half + self.end]
    }
}

/// Computes the least and the greatest place of the slider over stretches of the motion: at their ends, and where it
/// turns back. `None` if the loop is open in one of them, or there is none.
pub(super) fn travel<L: SliderLinkage>(linkage: &L, turns: &[f64], motion: &[Stretch]) -> Option<[f64; 2]> {
    let mut range: Option<[f64; 2]> = None;
    for stretch in motion {
        let turns = turns.iter().copied().filter(|angle| stretch.holds(*angle));
        for angle in [stretch.from, stretch.middle(), stretch.to].into_iter().chain(turns) {
            let place = linkage.position_with(angle, stretch.assembly).joints()?.place;
            range = Some(range.map_or([place; 2], |[low, high]| [low.min(place), high.max(place)]));
        }
    }
    range
}
