//! The joints of a linkage by their names, and the pins that hold plates together.

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
    /// The end of a link X-F of the second dyad of a six-bar or an eight-bar on another link.
    X2,
    /// The end of a link Y-F of the second dyad.
    Y2,
    /// The pin of the two links of the second dyad.
    F2,
    /// The end of a link X-F of the third dyad of an eight-bar.
    X3,
    /// The end of a link Y-F of the third dyad.
    Y3,
    /// The pin of the two links of the third dyad.
    F3,
}

impl Joint {
    /// The number of joints that have a name.
    pub const COUNT: usize = 13;
    /// The names, in the order of the joints.
    const NAMES: [&'static str; Joint::COUNT] =
        ["A", "B", "C", "D", "P", "E", "F", "X2", "Y2", "F2", "X3", "Y3", "F3"];
    /// The ends X and Y of the further dyads, and the joint F of their links.
    pub(super) const OF_DYADS: [[Joint; 3]; 2] =
        [[Joint::X2, Joint::Y2, Joint::F2], [Joint::X3, Joint::Y3, Joint::F3]];
    /// All five joints of a four-bar.
    pub const ALL: [Joint; 5] = [Joint::A, Joint::B, Joint::C, Joint::D, Joint::P];
    /// The four pins of a four-bar.
    pub const PINS: [Joint; 4] = [Joint::A, Joint::B, Joint::C, Joint::D];

    /// Returns the joint of a name.
    pub fn named(name: &str) -> Option<Joint> {
        let all =
            Joint::ALL.into_iter().chain([Joint::E, Joint::F]).chain(Joint::OF_DYADS.into_iter().flatten());
        all.into_iter().find(|joint| joint.name() == name)
    }

    /// Returns the joints of names that are written one after the other: `CX2`.
    pub fn all_named(letters: &str) -> Vec<Joint> {
        // Every name is a capital letter, or one with a digit behind it.
        let starts: Vec<usize> =
            letters.char_indices().filter(|(_, c)| c.is_alphabetic()).map(|(i, _)| i).collect();
        let ends = starts.iter().skip(1).copied().chain([letters.len()]);
        starts.iter().zip(ends).filter_map(|(start, end)| Joint::named(letters.get(*start..end)?)).collect()
    }

    /// Returns the name of the joint.
    pub fn name(self) -> &'static str {
        Joint::NAMES[self as usize]
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
