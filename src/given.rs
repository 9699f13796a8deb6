//! What is exported, compared, reported: a result of a run, one candidate of it, or a linkage without a run.

use crate::linkage_file::LinkageFile;
use crate::record::{Candidate, Record};
use crate::results_folder::BUILDABLE;

/// What was given.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A result of a run.
    Run(Box<Run>),
    /// A linkage without a run.
    Linkage(Box<LinkageFile>),
}

/// A result of a run, with the candidate that was named.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// As it was typed, without the candidate and without record.json: `results/k18`.
    pub named: String,
    /// The record, with the problem that was run and so the target.
    pub record: Record,
    /// Which of its candidates are meant.
    pub which: Which,
}

/// Which candidates of a result are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// None was named.
    All,
    /// `:2`: the second. It is there.
    Rank(usize),
    /// `:buildable`: the one that a run offers where its first has warnings. It is there.
    Buildable,
}

/// A result without any candidate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} has no candidate: the run found none")]
pub struct NoCandidate(pub String);

/// A candidate that was meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen<'a> {
    /// What it is called: `results/k18:2`.
    pub label: String,
    /// What stands in the names of its files: `2` or `buildable`.
    pub suffix: String,
    /// The candidate, as the record has it.
    pub candidate: &'a Candidate,
}

impl Run {
    /// The candidates that are meant, best first; none where the result has none.
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
            Which::Buildable => {
                self.record.buildable.iter().map(|c| chosen(BUILDABLE.to_owned(), c)).collect()
            }
        }
    }

    /// The candidate that was named, else the first.
    ///
    /// # Errors
    /// [`NoCandidate`] where the result has none.
    pub fn one(&self) -> Result<Chosen<'_>, NoCandidate> {
        self.chosen().into_iter().next().ok_or_else(|| NoCandidate(self.named.clone()))
    }
}
