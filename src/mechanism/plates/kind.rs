//! The plates that a kind of linkage has: its links, their holes and slots, the pins that join them, and how far they move.
//!
//! Every linkage of one loop is a ring of four links, each joined to the next. A new kind is a file beside this one that
//! implements [`Kind`], and an arm of [`Plated`].

use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch};
use crate::mechanism::{
    Complex, CrankLinkage, FourBar, InvertedSliderCrank, LoopJoints, SliderCrank, nearest_share,
};

/// A slot of a plate, as the line between the centres of its round ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot {
    /// The link that has it.
    pub link: Link,
    /// The centres S and T of its ends, in the plate's own frame.
    pub ends: [Complex; 2],
}

impl Slot {
    /// The letters of the two ends.
    pub const LETTERS: [&str; 2] = ["S", "T"];

    /// Returns the length between the centres of its ends.
    pub fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// Computes the distance of a point of the plate's own frame from the slot's centre line.
    pub fn distance(&self, to: Complex) -> f64 {
        let [from, end] = self.ends;
        (from + (end - from) * nearest_share(to, self.ends) - to).norm()
    }
}

/// The holes and the slot of a link, in its own frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Shape {
    /// Letters and centres of the holes.
    pub(super) holes: Vec<(char, Complex)>,
    /// The slot.
    pub(super) slot: Option<Slot>,
    /// Further points that the plate covers.
    pub(super) corners: Vec<Complex>,
}

impl Shape {
    pub(super) fn with_holes(holes: Vec<(char, Complex)>) -> Self {
        Shape { holes, ..Shape::default() }
    }
}

/// The plates of a kind of linkage.
pub(super) trait Kind {
    /// Returns the links around the loop, each joined to the next, the ground first and the coupler third.
    fn links(&self) -> [Link; 4];

    /// Returns the pins.
    fn pins(&self) -> &'static [Pin];

    /// Returns the joints whose distances matter, the coupler point among them; without guide pins.
    fn points(&self) -> &'static [Joint];

    /// Returns the pin that, beside the guide pins, always lies on the centre line of the slot.
    fn in_slot(&self) -> Option<Joint> {
        None
    }

    /// Returns the guide of the slider for a motion; `None` without a slider, or if the loop is open in the motion.
    fn guide(&self, sizes: Sizes, motion: &[Stretch]) -> Option<Guide>;

    /// Returns the holes and the slot of one of its links.
    fn shape(&self, link: Link, guide: Option<&Guide>) -> Shape;

    /// Returns the frame of one of its links at a position.
    fn placement(&self, link: Link, at: &LoopJoints) -> Placement;

    /// Computes how far joints move within a stretch from the position in its middle.
    fn reach(&self, stretch: &Stretch, at: &LoopJoints) -> Reach;
}

/// A linkage that has plates: one of a single loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Plated {
    FourBar(FourBar),
    SliderCrank(SliderCrank),
    InvertedSliderCrank(InvertedSliderCrank),
}

impl Plated {
    /// Returns a linkage as one that has plates; `None` of several loops.
    pub(super) fn of(linkage: &CrankLinkage) -> Option<Plated> {
        Some(match *linkage {
            CrankLinkage::FourBar(linkage) => Plated::FourBar(linkage),
            CrankLinkage::SliderCrank(linkage) => Plated::SliderCrank(linkage),
            CrankLinkage::InvertedSliderCrank(linkage) => Plated::InvertedSliderCrank(linkage),
            CrankLinkage::MultiLoop(_) => return None,
        })
    }

    /// Returns it as the plates of its kind.
    pub(super) fn kind(&self) -> &dyn Kind {
        match self {
            Plated::FourBar(linkage) => linkage,
            Plated::SliderCrank(linkage) => linkage,
            Plated::InvertedSliderCrank(linkage) => linkage,
        }
    }
}
