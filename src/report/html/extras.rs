//! The linkages that the page shows beside the ranked candidates: the picks that are none of them, and a member of the
//! front if the page is asked to show it first.

use super::data::candidate_key;
use crate::record::{Candidate, Pick, Record};
use crate::report::text::capitalised;

/// The linkage that a report shows first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// The candidate of this index, counted from 0.
    Candidate(usize),
    /// The member of the front of this index, counted from 0.
    Member(usize),
    /// A pick.
    Pick(Pick),
}

/// A linkage beside the ranked candidates.
pub(super) struct Extra<'a> {
    /// The key of its mechanism: `b`, `s`, `t`, `k`, or `f3` for a member of the front.
    pub(super) key: String,
    /// The name of its choice and of its row: `buildable`.
    pub(super) short: String,
    /// The name within a sentence: `buildable answer`.
    pub(super) name: String,
    pub(super) candidate: &'a Candidate,
}

impl Extra<'_> {
    /// Returns the heading: `The buildable answer`.
    pub(super) fn title(&self) -> String {
        capitalised(&format!("the {}", self.name))
    }
}

/// Returns the key of a pick's mechanism if it is not among the candidates.
fn pick_key(pick: Pick) -> &'static str {
    match pick {
        Pick::Buildable => "b",
        Pick::Smallest => "s",
        Pick::BestTransmission => "t",
        Pick::OtherKind => "k",
    }
}

fn member_key(index: usize) -> String {
    format!("f{}", index + 1)
}

/// Returns the linkages that the page shows beside the candidates.
pub(super) fn extras(record: &Record, shown: Shown) -> Vec<Extra<'_>> {
    let own = Pick::ALL.into_iter().filter_map(|pick| {
        let candidate = record.pick(pick).filter(|c| c.rank == 0)?;
        let (key, words) = (pick_key(pick).to_owned(), pick.words());
        // Said by the kind that it has.
        let words = if pick == Pick::OtherKind { candidate.type_name() } else { words };
        Some(Extra { key, short: words.to_owned(), name: format!("{words} answer"), candidate })
    });
    let mut extras: Vec<Extra<'_>> = own.collect();
    if let Shown::Member(index) = shown
        && let Some(member) = record.front.as_ref().and_then(|front| front.members.get(index))
    {
        let n = index + 1;
        extras.push(Extra {
            key: member_key(index),
            short: format!("front {n}"),
            name: format!("linkage {n} of the front"),
            candidate: &member.candidate,
        });
    }
    extras
}

/// Returns the key of the mechanism that is shown first.
pub(super) fn first_key(record: &Record, shown: Shown) -> String {
    match shown {
        Shown::Candidate(index) => candidate_key(index),
        Shown::Member(index) => member_key(index),
        Shown::Pick(pick) => match record.pick(pick).map_or(0, |c| c.rank) {
            0 => pick_key(pick).to_owned(),
            rank => candidate_key(rank - 1),
        },
    }
}
