//! The joints of a linkage of one loop by their letters, and the pins that hold plates together.

use super::Link;

/// A joint: a pin that joins two plates, or the coupler point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joint {
    /// The fixed pivot of the crank.
    A,
    /// The second fixed pivot: of the follower, or of the block.
    B,
    /// The pin of crank and coupler.
    C,
    /// The pin of the coupler with the follower, or with the block on a rail.
    D,
    /// The coupler point.
    P,
    /// The guide pin of a block that runs behind D in the slot.
    E,
    /// The guide pin of a block that runs ahead of D in the slot.
    F,
}

impl Joint {
    /// All five joints of a four-bar.
    pub const ALL: [Joint; 5] = [Joint::A, Joint::B, Joint::C, Joint::D, Joint::P];
    /// The four pins of a four-bar.
    pub const PINS: [Joint; 4] = [Joint::A, Joint::B, Joint::C, Joint::D];

    /// Returns the letter of the joint.
    pub fn letter(self) -> char {
        ['A', 'B', 'C', 'D', 'P', 'E', 'F'][self as usize]
    }

    /// Returns the letter of the joint as a text.
    pub fn name(self) -> &'static str {
        ["A", "B", "C", "D", "P", "E", "F"][self as usize]
    }
}

/// A pin with the two plates that it holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// The joint.
    pub joint: Joint,
    /// The two plates; a guide pin is fixed in the block and runs in the slot of the other one.
    pub joins: [Link; 2],
}

impl Pin {
    /// Returns the pin of a joint between two links.
    pub const fn new(joint: Joint, one: Link, other: Link) -> Self {
        Pin { joint, joins: [one, other] }
    }
}
