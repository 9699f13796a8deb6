//! RESULT on the command line: a folder, its record.json, either with `:2` (or `:buildable`) for one candidate,
//! or a linkage file. Every command that takes one reads it here.

use super::{Ended, terminal};
use crate::diagnostic::escaped;
use crate::linkage_file::{self, LinkageFile};
use crate::record::{Candidate, Record};
use crate::results_folder::{BUILDABLE, read_record};
use ariadne::ReportKind;
use std::path::Path;

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
    /// [`Ended::Bad`], told, where the result has none.
    pub fn one(&self) -> Result<Chosen<'_>, Ended> {
        self.chosen().into_iter().next().ok_or_else(|| {
            terminal::complain(&format!("{} has no candidate: the run found none", self.named));
            Ended::Bad
        })
    }
}

fn refuse(text: &str) -> Ended {
    terminal::complain(text);
    Ended::Refused
}

/// Reads what was given.
///
/// # Errors
/// [`Ended::Refused`]; what is wrong has been told.
pub fn read(argument: &Path) -> Result<Given, Ended> {
    let is_toml = argument.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    if is_toml && !argument.is_dir() {
        let file = linkage_file::load(argument).map_err(|diagnostic| {
            terminal::diagnose(ReportKind::Error, &diagnostic);
            Ended::Refused
        })?;
        return Ok(Given::Linkage(Box::new(file)));
    }
    read_run(argument).map(|run| Given::Run(Box::new(run)))
}

/// As [`read`], for a command that needs the record of a run: a linkage file is refused.
///
/// # Errors
/// [`Ended::Refused`]; what is wrong has been told.
pub fn read_run_of(argument: &Path, command: &str) -> Result<Run, Ended> {
    match read(argument)? {
        Given::Run(run) => Ok(*run),
        Given::Linkage(_) => Err(refuse(&format!(
            "{} is a linkage without a run; {command} needs a result: a folder such as results/my-path, or its record.json",
            argument.display()
        ))),
    }
}

fn read_run(argument: &Path) -> Result<Run, Ended> {
    let shown = escaped(&argument.display().to_string());
    let (folder, which) = match argument.to_str().and_then(|text| text.rsplit_once(':')) {
        Some((folder, name)) if !argument.exists() => match name.parse::<usize>() {
            Ok(rank) if rank >= 1 => (Path::new(folder), Which::Rank(rank)),
            _ if name == BUILDABLE => (Path::new(folder), Which::Buildable),
            _ => {
                return Err(refuse(&format!(
                    "{shown}: after the colon stands a candidate's rank, from 1, or the word {BUILDABLE}"
                )));
            }
        },
        _ => (argument, Which::All),
    };
    let record = read_record(folder).map_err(|e| refuse(&e.to_string()))?;
    let n = record.candidates.len();
    match which {
        Which::Rank(rank) if rank > n => {
            return Err(refuse(&format!("{shown}: there is no candidate {rank}, the result has {n}")));
        }
        Which::Buildable if record.buildable.is_none() => {
            return Err(refuse(&format!(
                "{shown}: the result has no buildable candidate besides its {n} (one is offered where the first has warnings)"
            )));
        }
        _ => {}
    }
    let folder = folder.display().to_string();
    let named = folder.trim_end_matches("/record.json").trim_end_matches('/').to_owned();
    Ok(Run { named, record, which })
}
