//! A result's folder: locked while it is written to, replaced as a whole, never mixed with foreign files.

use crate::record::Record;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const LOCK: &str = ".lock";
const RECORD: &str = "record.json";
const TEMPORARY: &str = ".linkwright-";
/// What stands in the place of a rank in the names of the buildable answer's files.
pub const BUILDABLE: &str = "buildable";
/// The largest record that is read.
pub const MAX_RECORD_BYTES: u64 = 256 << 20;

/// Why a result cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder or a file in it cannot be used.
    #[error("{path}: {source}")]
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
    /// A file over the limit.
    #[error("{path} has {bytes} bytes; a record has at most {MAX_RECORD_BYTES}")]
    TooLarge {
        /// Which file.
        path: String,
        /// Its size.
        bytes: u64,
    },
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
    lock: Option<File>,
    /// The folders that were made for it, the innermost first; taken away again when nothing is written.
    created: Vec<PathBuf>,
}

/// Whether a file of this name is one that a run writes.
fn is_ours(name: &str) -> bool {
    let numbered = |prefix: &str, suffix: &str| {
        name.strip_prefix(prefix)
            .and_then(|rest| rest.strip_suffix(suffix))
            .is_some_and(|n| n == BUILDABLE || (!n.is_empty() && n.bytes().all(|b| b.is_ascii_digit())))
    };
    matches!(
        name,
        LOCK | RECORD | "timing.json" | "candidates.csv" | "contact-sheet.svg" | "exact.svg" | "report.html"
    ) || name == "checkpoint.json"
        || name.starts_with(TEMPORARY)
        || numbered("curve-", ".csv")
        || numbered("linkage-", ".toml")
        || numbered("candidate-", ".svg")
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
                fs::create_dir_all(path).map_err(|e| FolderError::io(path, e))?;
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
        if let Some(foreign) = names.iter().find(|name| !is_ours(name)) {
            return Err(FolderError::Foreign { path: shown(), foreign: foreign.clone() });
        }
        let has_record = names.iter().any(|name| name == RECORD);
        let of_a_record = |name: &&String| !name.starts_with('.') && *name != RECORD;
        if let Some(orphan) = names.iter().find(of_a_record).filter(|_| !has_record) {
            return Err(FolderError::Foreign {
                path: shown(),
                foreign: format!("{orphan} without a record.json"),
            });
        }
        if has_record && read_record(&path.join(RECORD)).is_err() {
            let foreign = format!("a {RECORD} that is not a linkwright record");
            return Err(FolderError::Foreign { path: shown(), foreign });
        }
        let lock_path = path.join(LOCK);
        let lock = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&lock_path)
            .map_err(|e| FolderError::io(&lock_path, e))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(FolderError::Locked { path: shown() }),
            Err(TryLockError::Error(e)) => return Err(FolderError::io(&lock_path, e)),
        }
        Ok(ResultsFolder { path: path.to_path_buf(), lock: Some(lock), created })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Replaces what the folder holds by `files`, each written to a temporary file first and renamed; the
    /// record goes first, and what is left of an earlier result goes last.
    ///
    /// # Errors
    /// [`FolderError::Io`] with the file that could not be written; files already renamed stay.
    pub fn replace(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        let record_first = files.iter().filter(|(name, _)| name == RECORD);
        for (name, bytes) in record_first.chain(files.iter().filter(|(name, _)| name != RECORD)) {
            self.write(name, bytes)?;
        }
        self.created.clear();
        for entry in fs::read_dir(&self.path).map_err(|e| FolderError::io(&self.path, e))?.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if is_ours(&name) && name != LOCK && files.iter().all(|(kept, _)| *kept != name) {
                fs::remove_file(entry.path()).map_err(|e| FolderError::io(&entry.path(), e))?;
            }
        }
        Ok(())
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        replace_file(&self.path, name, bytes)
    }
}

/// Replaces the file `name` of a folder that is there: written to a temporary file beside it first and renamed,
/// so that a reader sees the old file or the new one, never half of either.
///
/// # Errors
/// [`FolderError::Io`] with the file; what was there before stays.
pub fn replace_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
    let target = folder.join(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Readable as any new file: what the user's mask leaves of it.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let written = builder.tempfile_in(folder).and_then(|mut file| {
        file.write_all(bytes)?;
        file.as_file().sync_data()?;
        file.persist(&target).map_err(|e| e.error)?;
        Ok(())
    });
    written.map_err(|e| FolderError::io(&target, e))
}

impl Drop for ResultsFolder {
    fn drop(&mut self) {
        // The lock ends with the file; what cannot be removed here is harmless and is taken over by the next run.
        let _ = fs::remove_file(self.path.join(LOCK));
        drop(self.lock.take());
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
    let file = if path.is_dir() { path.join(RECORD) } else { path.to_path_buf() };
    let bytes = match fs::metadata(&file) {
        Ok(metadata) => metadata.len(),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return Err(FolderError::NoRecord { path: file.display().to_string() });
        }
        Err(e) => return Err(FolderError::io(&file, e)),
    };
    if bytes > MAX_RECORD_BYTES {
        return Err(FolderError::TooLarge { path: file.display().to_string(), bytes });
    }
    let text = fs::read_to_string(&file).map_err(|e| FolderError::io(&file, e))?;
    serde_json::from_str(&text).map_err(|e| FolderError::NotARecord {
        path: file.display().to_string(),
        line: e.line(),
        column: e.column(),
        message: e.to_string(),
    })
}
