//! The plates that a kind of linkage has: its links, their holes and slots, the pins that join them, and how far they move.
//!
//! A new kind is a file beside this one that implements [`Kind`], and an arm of [`plated`].

use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch};
use crate::mechanism::{Complex, CrankLinkage, LoopJoints, nearest_share};

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
    /// Joints and centres of the holes.
    pub(super) holes: Vec<(Joint, Complex)>,
    /// The slot.
    pub(super) slot: Option<Slot>,
    /// Further points that the plate covers.
    pub(super) corners: Vec<Complex>,
}

impl Shape {
    pub(super) fn with_holes(holes: Vec<(Joint, Complex)>) -> Self {
        Shape { holes, ..Shape::default() }
    }
}

/// The plates of a kind of linkage.
pub(super) trait Kind {
    /// Returns the links in their places: ground, crank, coupler, and the others.
    fn links(&self) -> Vec<Link>;

    /// Returns the pins.
    fn pins(&self) -> Vec<Pin>;

    /// Returns the joints whose distances matter, the coupler point among them; without guide pins.
    fn points(&self) -> Vec<Joint>;

    /// Returns the link that carries P.
    fn traced(&self) -> Link {
        Link::Coupler
    }

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

/// Returns a linkage as the plates of its kind.
pub(super) fn plated(linkage: &CrankLinkage) -> &dyn Kind {
    match linkage {
        CrankLinkage::FourBar(linkage) => linkage,
        CrankLinkage::SliderCrank(linkage) => linkage,
        CrankLinkage::InvertedSliderCrank(linkage) => linkage,
        CrankLinkage::MultiLoop(linkage) => linkage,
    }
}
