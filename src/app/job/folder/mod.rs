//! A result's folder: locked while it is written to, replaced as a whole, and never mixed with files of other origin.

use crate::record::{BeyondLimits, Pick, Record};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

mod content;
mod disk;
mod lock;
mod output_file;
mod replacement;
#[cfg(test)]
mod tests;
mod together;

pub use output_file::{OutputFile, Replace, Replacement, check_files, write_files};
pub use together::put_together;

use lock::Lock;
use replacement::Wait;

const LOCK: &str = ".lock";
/// The name of the file with the record.
pub const RECORD: &str = "record.json";
const TEMPORARY: &str = ".linkwright-";
/// The name of the file with the checkpoint of an unfinished search.
pub const CHECKPOINT: &str = "checkpoint.json";
/// The name of the file with the times of a run.
pub const TIMING: &str = "timing.json";
/// The name of the file with the leaves of a certificate.
pub const LEAVES: &str = "certificate.leaves";
/// The name of the file with the checkpoint of an unfinished certificate.
pub const CERTIFICATE_CHECKPOINT: &str = "certificate.checkpoint";
/// The name of the table of a front.
pub const FRONT_CSV: &str = "front.csv";
/// The name of the page of a front.
pub const FRONT_HTML: &str = "front.html";
/// The largest record that is read, in bytes.
pub const MAX_RECORD_BYTES: u64 = 256 << 20;

/// The reason why a result cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder or a file in it cannot be used.
    #[error("{path}: {source}; {}", remedy(source))]
    Io {
        /// The path of the folder or file.
        path: String,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The path of the results folder leads to a file.
    #[error("{0} is a file; give a folder for the results with --out")]
    NotAFolder(String),
    /// The folder contains something that linkwright did not write.
    #[error(
        "{path} holds {foreign}, which linkwright did not write; give another folder with --out or move it away"
    )]
    Foreign {
        /// The path of the folder.
        path: String,
        /// The name of the foreign entry.
        foreign: String,
    },
    /// A file at a path that a person named for writing exists, and this program did not write it.
    #[error(
        "{path} is there and is not {kind} that linkwright wrote; name another file, or replace it with --force"
    )]
    NotOurs {
        /// The path of the file.
        path: String,
        /// The kind of file that was to be written.
        kind: &'static str,
    },
    /// A file that a person named for writing is also read by the same command.
    #[error("{0} is an input of this command; name another file, or replace it with --force")]
    OwnInput(String),
    /// A file that is to be created exists already.
    #[error("{0} exists already; choose another name, or replace it with --force")]
    Exists(String),
    /// Two files were to be written to one path.
    #[error("{0} is named twice: each file needs a place of its own")]
    NamedTwice(String),
    /// The folder of a sweep contains something else.
    #[error(
        "{path} holds {foreign}, which is no part of a sweep; give another folder with --out or move it away"
    )]
    NotASweep {
        /// The path of the folder.
        path: String,
        /// The name of the foreign entry.
        foreign: String,
    },
    /// Another run uses the folder.
    #[error("{0} is in use by another run; wait for it to end or give another folder with --out")]
    Locked(String),
    /// The folder holds no record.
    #[error("{0}: there is no such record; name the folder of a result, such as results/my-path")]
    NoRecord(String),
    /// The file is not a valid record.
    #[error("{path}:{line}:{column}: this is not a linkwright record: {message}")]
    NotARecord {
        /// The path of the file.
        path: String,
        /// The line of the fault, counted from 1.
        line: usize,
        /// The column of the fault.
        column: usize,
        /// The fault.
        message: String,
    },
    /// The record has a value that no run writes.
    #[error("{path}: {beyond}; run the problem again to have a true record")]
    BeyondLimits {
        /// The path of the file.
        path: String,
        /// The value that is beyond its limit.
        beyond: BeyondLimits,
    },
    /// The file is larger than the limit.
    #[error("{path} has {bytes} bytes; a record has at most {MAX_RECORD_BYTES}")]
    TooLarge {
        /// The path of the file.
        path: String,
        /// The size of the file, in bytes.
        bytes: u64,
    },
}

/// Returns the remedy for an error of the system.
fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::NotFound => "check the spelling and the folder you are in",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "change its permissions or name another place"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "make room on the disk or name another place"
        }
        io::ErrorKind::FileTooLarge => {
            "make room on the disk, raise the limit of a file's size (ulimit -f), or name another place"
        }
        io::ErrorKind::AlreadyExists => "choose another name",
        io::ErrorKind::NotADirectory => "a part of this path is a file: name another place",
        io::ErrorKind::IsADirectory => "this is a folder: name a file",
        _ => "try again or name another place",
    }
}

/// Returns the error for a failure of the system (a full disk, a read-only folder) at a path.
fn about(path: &Path) -> impl FnOnce(io::Error) -> FolderError + '_ {
    move |source| FolderError::Io { path: path.display().to_string(), source }
}

/// A results folder that is locked for this run until it is dropped.
#[derive(Debug)]
pub struct ResultsFolder {
    path: PathBuf,
    lock: Lock,
    /// The folders that were created for it, the innermost first; removed again if nothing is written.
    created: Vec<PathBuf>,
    /// Whether the checkpoint is kept when the other files are replaced.
    half_done: bool,
}

/// Returns whether a file begins as a checkpoint does, which is enough to recognise a checkpoint of linkwright's.
fn begins_as_a_checkpoint(path: &Path) -> bool {
    let mut start = [0; 64];
    let read = disk::open(path).and_then(|mut file| file.read(&mut start)).unwrap_or(0);
    start[..read].starts_with(b"{\"format\":") && start[..read].windows(12).any(|w| w == b"\"linkwright\"")
}

/// Returns whether a text is a rank as a run writes it: 1, 2, .. without leading zeros.
fn is_rank(text: &str) -> bool {
    text.parse::<u32>().is_ok_and(|rank| rank > 0 && rank.to_string() == text)
}

/// Returns whether a run writes a file of this name.
fn is_ours(name: &str) -> bool {
    let numbered = |prefix: &str, suffix: &str| {
        name.strip_prefix(prefix)
            .and_then(|rest| rest.strip_suffix(suffix))
            .is_some_and(|n| Pick::named(n).is_some() || is_rank(n))
    };
    matches!(
        name,
        LOCK | RECORD | TIMING | "candidates.csv" | "contact-sheet.svg" | "exact.svg" | "report.html"
    ) || [FRONT_CSV, FRONT_HTML, CHECKPOINT, LEAVES, CERTIFICATE_CHECKPOINT].contains(&name)
        || is_temporary(name)
        || numbered("curve-", ".csv")
        || numbered("linkage-", ".toml")
        || numbered("candidate-", ".svg")
}

/// Returns whether a name is that of a half-written file ([`tempfile`] adds six letters or digits) or of a folder of a
/// replacement that was interrupted.
pub(crate) fn is_temporary(name: &str) -> bool {
    let random = |rest: &str| rest.len() == 6 && rest.bytes().all(|b| b.is_ascii_alphanumeric());
    replacement::is_staging(name) || name.strip_prefix(TEMPORARY).is_some_and(random)
}

/// Returns whether a run leaves a file of this name in a result's folder: neither a lock nor a temporary file.
pub fn is_result_file(name: &str) -> bool {
    is_ours(name) && !name.starts_with('.')
}

/// The age below which a lock counts as held: the run that has just created it may be about to lock it.
const FRESH: Duration = Duration::from_secs(2);

/// Returns whether a run works in a folder now. A lock file that was created a moment ago counts as held.
pub fn is_in_use(folder: &Path) -> bool {
    let Ok(found) = fs::symlink_metadata(folder.join(LOCK)) else { return false };
    let fresh = found.modified().ok().and_then(|made| made.elapsed().ok()).is_none_or(|age| age < FRESH);
    fresh || Lock::is_taken(folder)
}

/// Returns a description of the first foreign entry (one that linkwright did not write) of a folder with these names,
/// sorted.
fn foreign(path: &Path, names: &[String]) -> Option<String> {
    if let Some(foreign) = names.iter().find_map(|name| replacement::not_of_ours(path, name)) {
        return Some(foreign);
    }
    if let Some(foreign) = names.iter().find(|name| !is_ours(name)) {
        return Some(foreign.clone());
    }
    if let Some(foreign) = names.iter().find(|name| !content::is_of_a_run(&path.join(name), name)) {
        return Some(format!("{foreign} with other contents"));
    }
    let has_record = names.iter().any(|name| name == RECORD);
    let half_done = begins_as_a_checkpoint(&path.join(CHECKPOINT));
    let of_a_record =
        |name: &&String| !name.starts_with('.') && *name != RECORD && !(half_done && *name == CHECKPOINT);
    if let Some(orphan) = names.iter().find(of_a_record).filter(|_| !has_record) {
        return Some(format!("{orphan} without a record.json"));
    }
    let unread = has_record && read_record_of_a_folder(&path.join(RECORD)).is_err();
    unread.then(|| format!("a {RECORD} that is not a linkwright record"))
}

impl ResultsFolder {
    /// Takes a folder for a run: creates it if it is missing, and refuses it if it contains foreign files or another
    /// run uses it.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn take(path: &Path) -> Result<Self, FolderError> {
        let shown = || path.display().to_string();
        let created = match fs::metadata(path) {
            Ok(found) if found.is_dir() => Vec::new(),
            Ok(_) => return Err(FolderError::NotAFolder(shown())),
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                let missing = path.ancestors().take_while(|p| !p.as_os_str().is_empty() && !p.exists());
                let missing: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
                disk::create_folders(path).map_err(about(path))?;
                missing
            }
            Err(e) => return Err(about(path)(e)),
        };
        let names = replacement::names(path)?;
        if let Some(foreign) = foreign(path, &names) {
            // Half of another run's result, while it is moved to its place, looks foreign too.
            let in_use = Lock::is_taken(path);
            return Err(if in_use {
                FolderError::Locked(shown())
            } else {
                FolderError::Foreign { path: shown(), foreign }
            });
        }
        let lock = Lock::take(path)?;
        // An interrupted replacement may belong to an unfinished search: its checkpoint is kept here.
        if names.iter().any(|name| name.starts_with(TEMPORARY)) {
            replacement::finish(path, &[LOCK, CHECKPOINT])?;
        }
        Ok(ResultsFolder { path: path.to_path_buf(), lock, created, half_done: false })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether an unfinished search has left a checkpoint here.
    pub fn has_checkpoint(&self) -> bool {
        self.path.join(CHECKPOINT).is_file()
    }

    /// Keeps the checkpoint when the other files are replaced: the result is that of an unfinished search.
    pub fn keep_checkpoint(&mut self) {
        self.half_done = true;
    }

    /// Removes the checkpoint of a finished search, if there is one.
    ///
    /// # Errors
    /// [`FolderError::Io`] if it cannot be removed.
    pub fn remove_checkpoint(&self) -> Result<(), FolderError> {
        let path = self.path.join(CHECKPOINT);
        match fs::remove_file(&path) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(about(&path)(e)),
            _ => Ok(()),
        }
    }

    /// Replaces the contents of the folder by `files`, as a whole: even if it is interrupted, the folder holds the old
    /// result or the new one. If the folder was removed in the meantime, it is created again.
    ///
    /// # Errors
    /// [`FolderError::Io`] with the file that could not be written; the old result is kept. [`FolderError::Locked`] if
    /// the folder was removed in the meantime and another run uses it by now.
    pub fn replace(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        self.write(files)?;
        self.sync()?;
        self.put(Wait::Now)
    }

    /// Does the first half of [`ResultsFolder::replace`]: writes the files beside the old result, which is kept.
    /// [`put_together`] does the rest.
    ///
    /// # Errors
    /// As [`ResultsFolder::replace`].
    pub fn write(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        if !self.lock.is_current() {
            disk::create_folders(&self.path).map_err(about(&self.path))?;
            self.lock = Lock::take(&self.path)?;
        }
        replacement::write(&self.path, files, self.kept())
    }

    fn sync(&self) -> Result<(), FolderError> {
        replacement::sync(&self.path)
    }

    /// Waits until the names in the folder are on the disk.
    fn sync_names(&self) -> Result<(), FolderError> {
        disk::sync_folder(&self.path).map_err(about(&self.path))
    }

    fn put(&mut self, names: Wait) -> Result<(), FolderError> {
        replacement::put(&self.path, self.kept(), names)?;
        self.created.clear();
        Ok(())
    }

    /// Returns the names that are kept when the other files are replaced.
    fn kept(&self) -> &'static [&'static str] {
        if self.half_done { &[LOCK, CHECKPOINT] } else { &[LOCK] }
    }
}

/// Replaces the file `name` of an existing folder: writes it to a temporary file beside it first and renames that, so
/// that a reader sees the old file or the new one, never half of either.
///
/// # Errors
/// [`FolderError::Io`] with the file; the old file is kept.
pub fn replace_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
    let target = folder.join(name);
    output_file::over(&target, bytes).map_err(about(&target))
}

/// Saves the files of a result that cannot be written to its folder in a new folder among the system's temporary files.
///
/// # Errors
/// [`FolderError::Io`] if they cannot be written there either.
pub fn rescue(files: &[(String, Vec<u8>)]) -> Result<PathBuf, FolderError> {
    let place = std::env::temp_dir();
    let folder = tempfile::Builder::new().prefix("linkwright-rescued-").tempdir_in(&place);
    let folder = folder.map_err(about(&place))?;
    for (name, bytes) in files {
        replace_file(folder.path(), name, bytes)?;
    }
    Ok(folder.keep())
}

impl Drop for ResultsFolder {
    fn drop(&mut self) {
        self.lock.release();
        for folder in &self.created {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Reads a record from its file or from the folder that holds it.
///
/// # Errors
/// [`FolderError`] with the file and, if it is not a valid record, the line.
pub fn read_record(path: &Path) -> Result<Record, FolderError> {
    if !path.is_dir() {
        return read_record_file(path, read_at_most);
    }
    let records = replacement::records(path);
    let there = records.iter().find(|file| file.exists()).unwrap_or(&records[2]);
    match read_record_of_a_folder(there) {
        // The record was moved to its place just now.
        Err(FolderError::Io { .. } | FolderError::NoRecord { .. }) if there != &records[2] => {
            read_record_of_a_folder(&records[2])
        }
        read => read,
    }
}

fn read_record_of_a_folder(file: &Path) -> Result<Record, FolderError> {
    read_record_file(file, read_file_at_most)
}

fn read_record_file(
    file: &Path,
    read: fn(&Path, u64) -> io::Result<Option<Vec<u8>>>,
) -> Result<Record, FolderError> {
    let path = file.display().to_string();
    match read(file, MAX_RECORD_BYTES) {
        Ok(Some(text)) => parse_record(&path, &text),
        Ok(None) => {
            // A pipe states no length.
            let stated = fs::metadata(file).map_or(0, |found| found.len());
            Err(FolderError::TooLarge { path, bytes: stated.max(MAX_RECORD_BYTES + 1) })
        }
        Err(e) if e.kind() == io::ErrorKind::NotFound => Err(FolderError::NoRecord(path)),
        Err(e) => Err(about(file)(e)),
    }
}

/// Reads a file of at most `most` bytes; `None` if it has more. A file that states too many is not read; a pipe or a device
/// states no length, so bytes are counted while they are read.
///
/// # Errors
/// The error of the system.
pub fn read_at_most(file: &Path, most: u64) -> io::Result<Option<Vec<u8>>> {
    at_most(File::open(file)?, most)
}

/// As [`read_at_most`], of a file in a results folder: a pipe or a device, for which nothing is to be waited, is an error.
///
/// # Errors
/// The error of the system.
pub fn read_file_at_most(file: &Path, most: u64) -> io::Result<Option<Vec<u8>>> {
    at_most(disk::open(file)?, most)
}

fn at_most(file: File, most: u64) -> io::Result<Option<Vec<u8>>> {
    if file.metadata()?.len() > most {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    Ok(Some(bytes).filter(|bytes| bytes.len() as u64 <= most))
}

/// Returns the record of a text; `path` is shown in errors.
///
/// # Errors
/// [`FolderError`] with the line if it is not a valid record, or with the key that is beyond its limit.
pub fn parse_record(path: &str, text: &[u8]) -> Result<Record, FolderError> {
    let record: Record = serde_json::from_slice(text).map_err(|e| FolderError::NotARecord {
        path: path.to_owned(),
        line: e.line(),
        column: e.column(),
        message: e.to_string(),
    })?;
    match record.beyond_limits() {
        None => Ok(record),
        Some(beyond) => Err(FolderError::BeyondLimits { path: path.to_owned(), beyond }),
    }
}
