//! Inputs of the export, comparison and report commands: a result of a run, one linkage of it, or a linkage without a
//! run.

use crate::files::linkage_file::LinkageFile;
use crate::record::{Candidate, Pick, Record};

/// An input of the export, comparison and report commands.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A result of a run.
    Run(Box<Run>),
    /// A linkage without a run.
    Linkage(Box<LinkageFile>),
}

/// A result of a run, with the choice of its candidates.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The result's path as it was typed, without the candidate and without record.json: `results/k18`.
    pub named: String,
    /// The record. It contains the problem that was run, and so the target.
    pub record: Record,
    /// The choice of its candidates.
    pub which: Which,
}

/// A choice among the candidates of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// All candidates: none was named.
    All,
    /// The candidate of this rank, as in `:2`. It exists.
    Rank(usize),
    /// The member of the front of this number, as in `:front-2`. It exists.
    Member(usize),
    /// A linkage that a run offers beside its candidates, as in `:buildable` or `:smallest`. It exists.
    Pick(Pick),
}

/// The beginning of the name of a member of the front: `front-2`.
pub const MEMBER: &str = "front-";

impl Which {
    /// Returns the choice of a name as it is typed after a colon: `2`, `front-2`, `smallest`; `None` if it is none.
    pub fn named(name: &str) -> Option<Which> {
        let number = |text: &str| text.parse().ok().filter(|n: &usize| *n > 0);
        if let Some(rank) = number(name) {
            return Some(Which::Rank(rank));
        }
        let member = name.strip_prefix(MEMBER).and_then(number).map(Which::Member);
        member.or_else(|| Pick::named(name).map(Which::Pick))
    }
}

/// The error that a result has no candidate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} has no candidate: the run found none")]
pub struct NoCandidate(pub String);

/// A candidate that was chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen<'a> {
    /// Its label: `results/k18:2`.
    pub label: String,
    /// Its part in the names of its files: `2`, `front-2` or `buildable`.
    pub suffix: String,
    /// The candidate, as the record has it.
    pub candidate: &'a Candidate,
}

impl Run {
    /// Returns the chosen candidates, best first; an empty list if the result has no candidate.
    pub fn chosen(&self) -> Vec<Chosen<'_>> {
        let chosen = |suffix: String, candidate| Chosen {
            label: format!("{}:{suffix}", self.named),
            suffix,
            candidate,
        };
        let ranked = self.record.candidates.iter().enumerate().map(|(i, c)| ((i + 1).to_string(), c));
        match self.which {
            Which::All => ranked.map(|(suffix, c)| chosen(suffix, c)).collect(),
            Which::Rank(rank) => ranked.skip(rank - 1).take(1).map(|(suffix, c)| chosen(suffix, c)).collect(),
            Which::Member(number) => {
                let member = self.record.front.iter().flat_map(|front| &front.members).nth(number - 1);
                member.map(|m| chosen(format!("{MEMBER}{number}"), &m.candidate)).into_iter().collect()
            }
            Which::Pick(pick) => {
                self.record.pick(pick).map(|c| chosen(pick.name().to_owned(), c)).into_iter().collect()
            }
        }
    }

    /// Returns the candidate that was named, otherwise the first.
    ///
    /// # Errors
    /// [`NoCandidate`] if the result has none.
    pub fn one(&self) -> Result<Chosen<'_>, NoCandidate> {
        self.chosen().into_iter().next().ok_or_else(|| NoCandidate(self.named.clone()))
    }
}
