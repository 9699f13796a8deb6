//! RESULT on the command line: a folder, its record.json, either with `:2` for one candidate (or `:buildable`,
//! `:smallest`, `:best-transmission`, `:front-2`), or a linkage file. Every command that takes one reads it here.

use super::{Ended, refuse, refuse_at, refuse_path, terminal};
pub use crate::app::inputs::{Given, NoCandidate, Run, Which};
use crate::app::job::files;
use crate::app::job::folder::{RECORD, read_record};
use crate::files::linkage_file;
use crate::files::linkage_file::AnyLinkageFile;
use crate::judge::verify::{Mismatch, verify};
use crate::mechanism::Linkage;
use crate::record::{Pick, Record};
use std::path::{Path, PathBuf};

impl From<NoCandidate> for Ended {
    fn from(none: NoCandidate) -> Ended {
        terminal::complain(&none.to_string());
        Ended::Bad
    }
}

/// Reads a RESULT.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported.
pub fn read(argument: &Path) -> Result<Given, Ended> {
    if is_linkage_file(argument) {
        let file = linkage_file::load(argument).map_err(refuse_at)?;
        return Ok(Given::Linkage(Box::new(file)));
    }
    read_run(argument).map(|run| Given::Run(Box::new(run)))
}

/// As [`read`], for a command that needs the record of a run: a linkage file is refused.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported.
pub fn read_run_of(argument: &Path, command: &str) -> Result<Run, Ended> {
    match read(argument)? {
        Given::Run(run) => Ok(*run),
        Given::Linkage(_) => Err(refuse(format!(
            "{} is a linkage without a run; {command} needs a result: a folder such as results/my-path, or its record.json",
            argument.display()
        ))),
    }
}

/// As [`read`], for a command that is about one linkage alone, a chain or a four-bar: of a result it is the candidate
/// that is named, else the first.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported. [`Ended::Bad`] for a result without any candidate.
pub fn read_linkage(argument: &Path) -> Result<AnyLinkageFile, Ended> {
    if is_linkage_file(argument) {
        return linkage_file::load_any(argument).map_err(refuse_at);
    }
    let run = read_run(argument)?;
    let chosen = run.one()?;
    let problem = &run.record.problem;
    Ok(AnyLinkageFile {
        // The name that its linkage file has.
        name: files::linkage_name(&run.record, &chosen.suffix),
        unit: problem.unit,
        linkage: Linkage::FourBar(chosen.candidate.linkage),
    })
}

/// Recomputes a record, and returns the figures that are not so.
///
/// # Errors
/// [`Ended::Refused`] if its problem is invalid; the fault has been reported.
pub fn mismatches(path: &Path, record: &Record) -> Result<Vec<Mismatch>, Ended> {
    verify(record).map_err(|e| refuse_path(path, format!("the recorded problem is none: {e}")))
}

/// Returns the file that a RESULT is read from: the record in a folder, whatever candidate is named.
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

/// Whether an argument is the file of a linkage without a run.
fn is_linkage_file(argument: &Path) -> bool {
    argument.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) && !argument.is_dir()
}

fn read_run(argument: &Path) -> Result<Run, Ended> {
    let (folder, name) = split(argument);
    let which = match name {
        None => Which::All,
        Some(name) => Which::named(name).ok_or_else(|| refuse_path(argument, choices()))?,
    };
    let record = read_record(folder).map_err(refuse)?;
    if let Some(why) = missing(&record, which) {
        return Err(refuse_path(argument, why));
    }
    let folder = folder.display().to_string();
    let named = folder.trim_end_matches("/record.json").trim_end_matches('/').to_owned();
    Ok(Run { named, record, which })
}

/// Returns the names that can follow a colon, in words.
fn choices() -> String {
    let picks = Pick::ALL.map(Pick::name).join(", ");
    format!(
        "after the colon stands a candidate's rank, from 1, front-1, front-2, .. for a linkage of the front, or {picks}"
    )
}

/// Returns the reason why a record does not have what was chosen; `None` if it does.
fn missing(record: &Record, which: Which) -> Option<String> {
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
        Which::Pick(pick) if record.pick(pick).is_none() => Some(format!(
            "the result has no {} linkage (it is looked for where a candidate is accepted and solve.advice is on)",
            pick.words()
        )),
        Which::All | Which::Rank(_) | Which::Pick(_) => None,
    }
}
