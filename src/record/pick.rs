//! The linkages that a record offers beside its ranked candidates, each with the name that files and commands use.

use super::{Candidate, Record};

/// A linkage that a record offers beside its ranked candidates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pick {
    /// The best one without warnings.
    Buildable,
    /// The smallest one whose error is nearly that of the closest.
    Smallest,
    /// The best transmitting one whose error is nearly that of the closest.
    BestTransmission,
    /// An acceptable six-bar or eight-bar where no four-bar is acceptable.
    OtherKind,
}

impl Pick {
    /// Every pick.
    pub const ALL: [Pick; 4] = [Pick::Buildable, Pick::Smallest, Pick::BestTransmission, Pick::OtherKind];

    /// Returns the name in file names and on the command line: `best-transmission`.
    pub const fn name(self) -> &'static str {
        match self {
            Pick::Buildable => "buildable",
            Pick::Smallest => "smallest",
            Pick::BestTransmission => "best-transmission",
            Pick::OtherKind => "other-kind",
        }
    }

    /// Returns the name in words: `best transmitting`.
    pub const fn words(self) -> &'static str {
        match self {
            Pick::Buildable => "buildable",
            Pick::Smallest => "smallest",
            Pick::BestTransmission => "best transmitting",
            Pick::OtherKind => "other kind of",
        }
    }

    /// Returns the pick of a name.
    pub fn named(name: &str) -> Option<Pick> {
        Self::ALL.into_iter().find(|pick| pick.name() == name)
    }
}

impl Record {
    /// Returns the candidate of a pick. Its rank is that of the equal candidate, 0 if it is none of them.
    pub fn pick(&self, pick: Pick) -> Option<&Candidate> {
        let picks = self.picks.as_ref();
        match pick {
            Pick::Buildable => self.buildable.as_ref(),
            Pick::Smallest => picks?.smallest.as_ref(),
            Pick::BestTransmission => picks?.best_transmission.as_ref(),
            Pick::OtherKind => self.other_kind.as_ref(),
        }
    }
}
