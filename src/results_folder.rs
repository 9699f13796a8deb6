//! A result's folder: locked while it is written to, replaced as a whole, never mixed with foreign files.

use crate::record::{BeyondLimits, Record};
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

pub use output_file::{OutputFile, Replace, check_files, write_files};
pub use together::put_together;

use lock::Lock;
use replacement::Wait;

const LOCK: &str = ".lock";
/// The file of a record.
pub const RECORD: &str = "record.json";
const TEMPORARY: &str = ".linkwright-";
/// The file of a search half done.
pub const CHECKPOINT: &str = "checkpoint.json";
/// The file with the leaves of a certificate.
pub const LEAVES: &str = "certificate.leaves";
/// The file of a search for a certificate half done.
pub const CERTIFICATE_CHECKPOINT: &str = "certificate.checkpoint";
/// What stands in the place of a rank in the names of the buildable answer's files.
pub const BUILDABLE: &str = "buildable";
/// The largest record that is read.
pub const MAX_RECORD_BYTES: u64 = 256 << 20;

/// Why a result cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder or a file in it cannot be used.
    #[error("{path}: {source}; {}", remedy(source))]
    Io {
        /// Which path.
        path: String,
        /// What the system said.
        source: io::Error,
    },
    /// The place is taken by a file.
    #[error("{path} is a file; give a folder for the results with --out")]
    NotAFolder {
        /// Which path.
        path: String,
    },
    /// Something there is not ours.
    #[error(
        "{path} holds {foreign}, which linkwright did not write; give another folder with --out or move it away"
    )]
    Foreign {
        /// The folder.
        path: String,
        /// What was found.
        foreign: String,
    },
    /// A file that a person named for writing is there, and this program did not write it.
    #[error(
        "{path} is there and is not {kind} that linkwright wrote; name another file, or replace it with --force"
    )]
    NotOurs {
        /// Which file.
        path: String,
        /// The kind that was to be written.
        kind: &'static str,
    },
    /// A file that a person named for writing is read by the same command.
    #[error("{path} is an input of this command; name another file, or replace it with --force")]
    OwnInput {
        /// Which file.
        path: String,
    },
    /// A file that is to be made is there already.
    #[error("{path} exists already; choose another name, or replace it with --force")]
    Exists {
        /// Which file.
        path: String,
    },
    /// Two files were to be written to one place.
    #[error("{path} is named twice: each file needs a place of its own")]
    NamedTwice {
        /// Which file.
        path: String,
    },
    /// Another run has it.
    #[error("{path} is in use by another run; wait for it to end or give another folder with --out")]
    Locked {
        /// The folder.
        path: String,
    },
    /// No record there.
    #[error("{path}: there is no such record; name the folder of a result, such as results/my-path")]
    NoRecord {
        /// Which file was looked for.
        path: String,
    },
    /// A record that is none.
    #[error("{path}:{line}:{column}: this is not a linkwright record: {message}")]
    NotARecord {
        /// Which file.
        path: String,
        /// Where.
        line: usize,
        /// Where.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A record that no run has written.
    #[error("{path}: {beyond}; run the problem again to have a true record")]
    BeyondLimits {
        /// Which file.
        path: String,
        /// What is beyond its limit.
        beyond: BeyondLimits,
    },
    /// A file over the limit.
    #[error("{path} has {bytes} bytes; a record has at most {MAX_RECORD_BYTES}")]
    TooLarge {
        /// Which file.
        path: String,
        /// Its size.
        bytes: u64,
    },
}

/// What to do about a failure of the system.
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

impl FolderError {
    /// Whether the system failed (a full disk, a read-only folder) rather than the caller.
    fn io(path: &Path, source: io::Error) -> Self {
        FolderError::Io { path: path.display().to_string(), source }
    }
}

/// A folder that is ours until it is dropped.
#[derive(Debug)]
pub struct ResultsFolder {
    path: PathBuf,
    lock: Lock,
    /// The folders that were made for it, the innermost first; taken away again when nothing is written.
    created: Vec<PathBuf>,
    /// Whether the checkpoint stays when the rest is replaced.
    half_done: bool,
}

/// Whether a file begins as a checkpoint does: enough to tell it from one that linkwright did not write.
fn begins_as_a_checkpoint(path: &Path) -> bool {
    let mut start = [0; 64];
    let read = File::open(path).and_then(|mut file| file.read(&mut start)).unwrap_or(0);
    start[..read].starts_with(b"{\"format\":") && start[..read].windows(12).any(|w| w == b"\"linkwright\"")
}

/// Whether a text is a rank as a run writes it: 1, 2, .. without zeros in front.
fn is_rank(text: &str) -> bool {
    text.parse::<u32>().is_ok_and(|rank| rank > 0 && rank.to_string() == text)
}

/// Whether a file of this name is one that a run writes.
fn is_ours(name: &str) -> bool {
    let numbered = |prefix: &str, suffix: &str| {
        name.strip_prefix(prefix)
            .and_then(|rest| rest.strip_suffix(suffix))
            .is_some_and(|n| n == BUILDABLE || is_rank(n))
    };
    matches!(
        name,
        LOCK | RECORD | "timing.json" | "candidates.csv" | "contact-sheet.svg" | "exact.svg" | "report.html"
    ) || [CHECKPOINT, LEAVES, CERTIFICATE_CHECKPOINT].contains(&name)
        || is_temporary(name)
        || numbered("curve-", ".csv")
        || numbered("linkage-", ".toml")
        || numbered("candidate-", ".svg")
}

/// Whether a name is that of a file half written ([`tempfile`] adds six letters or digits) or of a folder of a
/// replacement that was broken off.
fn is_temporary(name: &str) -> bool {
    let random = |rest: &str| rest.len() == 6 && rest.bytes().all(|b| b.is_ascii_alphanumeric());
    replacement::is_staging(name) || name.strip_prefix(TEMPORARY).is_some_and(random)
}

/// Whether a file of this name is one that a run leaves in a result's folder: no lock, nothing temporary.
pub fn is_result_file(name: &str) -> bool {
    is_ours(name) && !name.starts_with('.')
}

/// How long a lock is left alone: whoever has just made it may be about to take it.
const FRESH: Duration = Duration::from_secs(2);

/// Whether a run works in a folder now. A lock that was made a moment ago counts as held.
pub fn is_in_use(folder: &Path) -> bool {
    let Ok(found) = fs::symlink_metadata(folder.join(LOCK)) else { return false };
    let fresh = found.modified().ok().and_then(|made| made.elapsed().ok()).is_none_or(|age| age < FRESH);
    fresh || Lock::is_taken(folder)
}

/// What a folder with these names, sorted, holds that linkwright did not write.
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
    let unread = has_record && read_record(&path.join(RECORD)).is_err();
    unread.then(|| format!("a {RECORD} that is not a linkwright record"))
}

impl ResultsFolder {
    /// Takes a folder for a run: creates it where it is missing, refuses foreign files and running neighbours.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn take(path: &Path) -> Result<Self, FolderError> {
        let shown = || path.display().to_string();
        let created = match fs::metadata(path) {
            Ok(found) if found.is_dir() => Vec::new(),
            Ok(_) => return Err(FolderError::NotAFolder { path: shown() }),
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                let missing = path.ancestors().take_while(|p| !p.as_os_str().is_empty() && !p.exists());
                let missing: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
                disk::create_folders(path).map_err(|e| FolderError::io(path, e))?;
                missing
            }
            Err(e) => return Err(FolderError::io(path, e)),
        };
        let mut names = Vec::new();
        for entry in fs::read_dir(path).map_err(|e| FolderError::io(path, e))? {
            let entry = entry.map_err(|e| FolderError::io(path, e))?;
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
        names.sort();
        if let Some(foreign) = foreign(path, &names) {
            // Half of a neighbour's result, while it is moved to its place, looks foreign too.
            let in_use = Lock::is_taken(path);
            return Err(if in_use {
                FolderError::Locked { path: shown() }
            } else {
                FolderError::Foreign { path: shown(), foreign }
            });
        }
        let lock = Lock::take(path)?;
        // A replacement that was broken off may be that of a search half done: its checkpoint is not thrown away here.
        if names.iter().any(|name| name.starts_with(TEMPORARY)) {
            replacement::finish(path, &[LOCK, CHECKPOINT]).map_err(|(path, e)| FolderError::io(&path, e))?;
        }
        Ok(ResultsFolder { path: path.to_path_buf(), lock, created, half_done: false })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a search half done has left a checkpoint here.
    pub fn has_checkpoint(&self) -> bool {
        self.path.join(CHECKPOINT).is_file()
    }

    /// From now on the checkpoint stays when the rest is replaced: the result is of a search half done.
    pub fn keep_checkpoint(&mut self) {
        self.half_done = true;
    }

    /// Removes the checkpoint of a search that is over, if there is one.
    ///
    /// # Errors
    /// [`FolderError::Io`] where it cannot be removed.
    pub fn remove_checkpoint(&self) -> Result<(), FolderError> {
        let path = self.path.join(CHECKPOINT);
        match fs::remove_file(&path) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(FolderError::io(&path, e)),
            _ => Ok(()),
        }
    }

    /// Replaces what the folder holds by `files`, as a whole: whatever breaks it off, the folder holds the old result
    /// or the new one. A folder that was taken away under way is made anew.
    ///
    /// # Errors
    /// [`FolderError::Io`] with the file that could not be written; the old result stays. [`FolderError::Locked`] where
    /// the folder was taken away under way and is another run's by now.
    pub fn replace(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        self.write(files)?;
        self.sync()?;
        self.put(Wait::Now)
    }

    /// The first half of [`ResultsFolder::replace`]: the files are written beside the old result, which stays.
    /// [`put_together`] does the rest.
    ///
    /// # Errors
    /// As [`ResultsFolder::replace`].
    pub fn write(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        if !self.lock.stands() {
            disk::create_folders(&self.path).map_err(|e| FolderError::io(&self.path, e))?;
            self.lock = Lock::take(&self.path)?;
        }
        replacement::write(&self.path, files, self.kept()).map_err(|(path, e)| FolderError::io(&path, e))
    }

    fn sync(&self) -> Result<(), FolderError> {
        replacement::sync(&self.path).map_err(|(path, e)| FolderError::io(&path, e))
    }

    /// The names in it are on the disk when this returns.
    fn sync_names(&self) -> Result<(), FolderError> {
        disk::sync_folder(&self.path).map_err(|e| FolderError::io(&self.path, e))
    }

    fn put(&mut self, names: Wait) -> Result<(), FolderError> {
        replacement::put(&self.path, self.kept(), names).map_err(|(path, e)| FolderError::io(&path, e))?;
        self.created.clear();
        Ok(())
    }

    /// What stays when the rest is replaced.
    fn kept(&self) -> &'static [&'static str] {
        if self.half_done { &[LOCK, CHECKPOINT] } else { &[LOCK] }
    }
}

/// Replaces the file `name` of a folder that is there: written to a temporary file beside it first and renamed,
/// so that a reader sees the old file or the new one, never half of either.
///
/// # Errors
/// [`FolderError::Io`] with the file; what was there before stays.
pub fn replace_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
    let target = folder.join(name);
    output_file::over(&target, bytes).map_err(|e| FolderError::io(&target, e))
}

/// Saves the files of a result that its folder does not take in a new folder of the system's for temporary files.
///
/// # Errors
/// [`FolderError::Io`] where that has no room either.
pub fn rescue(files: &[(String, Vec<u8>)]) -> Result<PathBuf, FolderError> {
    let place = std::env::temp_dir();
    let folder = tempfile::Builder::new().prefix("linkwright-rescued-").tempdir_in(&place);
    let folder = folder.map_err(|e| FolderError::io(&place, e))?;
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
/// [`FolderError`] with the file and, where it is no record, the line.
pub fn read_record(path: &Path) -> Result<Record, FolderError> {
    if !path.is_dir() {
        return read_record_file(path);
    }
    let records = replacement::records(path);
    let there = records.iter().find(|file| file.exists()).unwrap_or(&records[2]);
    match read_record_file(there) {
        // It was moved to its place just now.
        Err(FolderError::Io { .. } | FolderError::NoRecord { .. }) if there != &records[2] => {
            read_record_file(&records[2])
        }
        read => read,
    }
}

fn read_record_file(file: &Path) -> Result<Record, FolderError> {
    let bytes = match fs::metadata(file) {
        Ok(metadata) => metadata.len(),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return Err(FolderError::NoRecord { path: file.display().to_string() });
        }
        Err(e) => return Err(FolderError::io(file, e)),
    };
    if bytes > MAX_RECORD_BYTES {
        return Err(FolderError::TooLarge { path: file.display().to_string(), bytes });
    }
    // A pipe or a device tells no length: the limit holds while reading too.
    let mut text = Vec::new();
    File::open(file)
        .and_then(|f| f.take(MAX_RECORD_BYTES + 1).read_to_end(&mut text))
        .map_err(|e| FolderError::io(file, e))?;
    if text.len() as u64 > MAX_RECORD_BYTES {
        return Err(FolderError::TooLarge { path: file.display().to_string(), bytes: text.len() as u64 });
    }
    parse_record(&file.display().to_string(), &text)
}

/// The record of a text; `path` is shown in errors.
///
/// # Errors
/// [`FolderError`] with the line where it is no record, or the key that is beyond its limit.
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
