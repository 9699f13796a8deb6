//! Inputs of the export, comparison and report commands: a result of a run, one linkage of it, or a linkage without a
//! run.

use crate::app::job::files;
use crate::app::job::folder::{FolderError, RECORD, read_record};
use crate::files::diagnostic::Diagnostic;
use crate::files::linkage_file;
use crate::files::linkage_file::{AnyLinkageFile, LinkageFile};
use crate::mechanism::CrankLinkage;
use crate::mechanism::loads::Loads;
use crate::mechanism::plates::Shop;
use crate::record::{Candidate, Pick, Record};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// An input of the export, comparison and report commands, with linkages of one loop or of one kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Given<L = CrankLinkage> {
    /// A result of a run.
    Run(Box<Run>),
    /// A linkage without a run.
    Linkage(Box<LinkageFile<L>>),
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

/// The reason why an input cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NotRead {
    /// A linkage file is refused.
    #[error(transparent)]
    File(#[from] Box<Diagnostic>),
    /// The record cannot be read.
    #[error(transparent)]
    Record(#[from] FolderError),
    /// The result does not have the linkage that is named after the colon.
    #[error("{path}: {why}")]
    Choice {
        /// The input as it was typed.
        path: String,
        /// The reason.
        why: String,
    },
    /// The result has no candidate.
    #[error(transparent)]
    NoCandidate(#[from] NoCandidate),
}

/// Reads an input: a folder, its record.json, either with `:2` for one candidate (or `:buildable`, `:smallest`,
/// `:best-transmission`, `:front-2`), or a linkage file.
///
/// # Errors
/// [`NotRead`].
pub fn read(argument: &Path) -> Result<Given, NotRead> {
    if is_linkage_file(argument) {
        return Ok(Given::Linkage(Box::new(linkage_file::load_crank_linkage(argument)?)));
    }
    Ok(Given::Run(Box::new(read_run(argument)?)))
}

/// Reads one linkage of any kind: of a result it is the candidate that is named, else the first.
///
/// # Errors
/// [`NotRead`].
pub fn read_linkage(argument: &Path) -> Result<AnyLinkageFile, NotRead> {
    Ok(read_loaded_linkage(argument)?.0)
}

/// Reads one linkage as [`read_linkage`] does, and the loads of its file, or of its result's problem.
///
/// # Errors
/// [`NotRead`].
pub fn read_loaded_linkage(argument: &Path) -> Result<(AnyLinkageFile, Option<Loads>), NotRead> {
    if is_linkage_file(argument) {
        return Ok(linkage_file::load_loaded(argument)?);
    }
    let run = read_run(argument)?;
    let chosen = run.one()?;
    let problem = &run.record.problem;
    let file = AnyLinkageFile {
        // The name that its linkage file has.
        name: files::linkage_name(&run.record, &chosen.suffix),
        unit: problem.unit,
        linkage: chosen.candidate.linkage.into(),
    };
    Ok((file, problem.resolved.loads.as_ref().map(|loads| loads.applied.clone())))
}

/// Reads the shop data of an input's linkage file; a result has none.
///
/// # Errors
/// [`NotRead`].
pub fn read_shop(argument: &Path) -> Result<Option<Shop>, NotRead> {
    if is_linkage_file(argument) { Ok(linkage_file::load_shop(argument)?) } else { Ok(None) }
}

/// Returns the file that an input is read from: the record in a folder, whatever candidate is named.
pub fn file_of(argument: &Path) -> PathBuf {
    let (named, _) = split(argument);
    if named.is_dir() { named.join(RECORD) } else { named.to_path_buf() }
}

/// Splits off the name of a candidate, unless the whole is the path of something.
fn split(argument: &Path) -> (&Path, Option<&str>) {
    match argument.to_str().and_then(|text| text.rsplit_once(':')) {
        Some((folder, name)) if !argument.exists() => (Path::new(folder), Some(name)),
        _ => (argument, None),
    }
}

/// Returns whether an argument is the file of a linkage without a run.
fn is_linkage_file(argument: &Path) -> bool {
    argument.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) && !argument.is_dir()
}

fn read_run(argument: &Path) -> Result<Run, NotRead> {
    let refused = |why: String| NotRead::Choice { path: argument.display().to_string(), why };
    let (folder, name) = split(argument);
    let which = match name {
        None => Which::All,
        Some(name) => Which::named(name).ok_or_else(|| refused(choices()))?,
    };
    let record = read_record(folder)?;
    if let Some(why) = missing(&record, which) {
        return Err(refused(why));
    }
    let folder = folder.display().to_string();
    let named = folder.trim_end_matches("/record.json").trim_end_matches('/').to_owned();
    Ok(Run { named, record, which })
}

/// Returns the names that can follow a colon, in words.
pub fn choices() -> String {
    let picks = Pick::ALL.map(Pick::name).join(", ");
    format!(
        "after the colon stands a candidate's rank, from 1, front-1, front-2, .. for a linkage of the front, or {picks}"
    )
}

/// Returns the reason why a record does not have what was chosen; `None` if it does.
pub fn missing(record: &Record, which: Which) -> Option<String> {
    let n = record.candidates.len();
    match which {
        Which::Rank(rank) if rank > n => Some(format!("there is no candidate {rank}, the result has {n}")),
        Which::Member(number) => match &record.front {
            None => Some("the result has no front; linkwright front PROBLEM computes one".to_owned()),
            Some(front) if number > front.members.len() => {
                Some(format!("there is no linkage {number} in the front, it has {}", front.members.len()))
            }
            Some(_) => None,
        },
        Which::Pick(Pick::Buildable) if record.buildable.is_none() => Some(format!(
            "the result has no buildable candidate besides its {n} (one is offered where the first has warnings)"
        )),
        Which::Pick(Pick::OtherKind) if record.other_kind.is_none() => Some(
            "the result has no linkage of another kind (one is offered where no four-bar is acceptable and a six-bar is)"
                .to_owned(),
        ),
        Which::Pick(pick) if record.pick(pick).is_none() => Some(format!(
            "the result has no {} linkage (it is looked for where a candidate is accepted and solve.advice is on)",
            pick.words()
        )),
        Which::All | Which::Rank(_) | Which::Pick(_) => None,
    }
}

/// Lists the TOML files of a folder, not below it, by name.
///
/// # Errors
/// The error of the system.
pub fn toml_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut files = paths.collect::<io::Result<Vec<_>>>()?;
    files.retain(|path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")));
    files.sort();
    Ok(files)
}
