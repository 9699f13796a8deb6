//! RESULT on the command line: a folder, its record.json, either with `:2` for one candidate (or `:buildable`,
//! `:smallest`, `:best-transmission`, `:front-2`), or a linkage file. Every command that takes one reads it here, with
//! [`inputs`].

use super::{Ended, refuse, refuse_at, refuse_path, terminal};
use crate::app::inputs;
pub use crate::app::inputs::{Given, NoCandidate, NotRead, Run, Which, file_of};
use crate::files::linkage_file::AnyLinkageFile;
use crate::files::shop_file;
use crate::judge::verify::{Mismatch, verify};
use crate::mechanism::CrankLinkage;
use crate::mechanism::loads::Loads;
use crate::mechanism::plates::Shop;
use crate::record::Record;
use std::path::{Path, PathBuf};

impl From<NoCandidate> for Ended {
    fn from(none: NoCandidate) -> Ended {
        terminal::complain(&none.to_string());
        Ended::Bad
    }
}

impl From<NotRead> for Ended {
    fn from(why: NotRead) -> Ended {
        match why {
            NotRead::File(diagnostic) => refuse_at(diagnostic),
            NotRead::NoCandidate(none) => none.into(),
            why => refuse(why),
        }
    }
}

/// Reads a RESULT.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported.
pub fn read(argument: &Path) -> Result<Given, Ended> {
    Ok(inputs::read(argument)?)
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

/// As [`read`], for a command that is about one linkage alone, of any kind: of a result it is the candidate that is named,
/// else the first.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported. [`Ended::Bad`] for a result without any candidate.
pub fn read_linkage(argument: &Path) -> Result<AnyLinkageFile, Ended> {
    Ok(inputs::read_linkage(argument)?)
}

/// As [`read_linkage`], with the loads of a linkage file.
///
/// # Errors
/// As [`read_linkage`].
pub fn read_loaded_linkage(argument: &Path) -> Result<(AnyLinkageFile, Option<Loads>), Ended> {
    Ok(inputs::read_loaded_linkage(argument)?)
}

/// Reads the shop data of a linkage: of `own`, a file of shop data, else of its linkage file.
///
/// # Errors
/// [`Ended::Refused`]; the fault has been reported.
pub fn read_shop(
    argument: &Path,
    own: Option<&PathBuf>,
    linkage: &CrankLinkage,
) -> Result<Option<Shop>, Ended> {
    match own {
        Some(file) => Ok(Some(shop_file::load(file, linkage).map_err(refuse_at)?)),
        None => Ok(inputs::read_shop(argument)?),
    }
}

/// Says that loads and shop data of a linkage file are not carried over to what the command writes.
pub fn note_loads(argument: &Path) {
    if let Ok((_, Some(_))) = inputs::read_loaded_linkage(argument) {
        let file = terminal::shown(argument);
        terminal::tell(&format!("note: the loads of {file} are not carried over to the new linkage"));
    }
    if let Ok(Some(_)) = inputs::read_shop(argument) {
        let file = terminal::shown(argument);
        terminal::tell(&format!("note: the shop data of {file} are not carried over to the new linkage"));
    }
}

/// Recomputes a record, and returns the figures that are not so.
///
/// # Errors
/// [`Ended::Refused`] if its problem is invalid; the fault has been reported.
pub fn mismatches(path: &Path, record: &Record) -> Result<Vec<Mismatch>, Ended> {
    verify(record).map_err(|e| refuse_path(path, format!("the recorded problem is none: {e}")))
}
