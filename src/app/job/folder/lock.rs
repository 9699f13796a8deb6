//! The lock of a results folder, for one run at a time: an advisory lock on its `.lock`, which the system releases when
//! the process ends, however it ends.
//!
//! The process that holds the lock removes the file. Another process may have opened it just before: it then locks a
//! file that has no name any more, while a third creates a new one. So a lock counts only if the locked file is the one
//! that the path leads to, and only that file is removed.

use super::{FolderError, LOCK, about};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The number of attempts to take the lock while other runs release it.
const TRIES: usize = 100;

/// A lock that this process holds.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Takes the lock of a folder.
    ///
    /// # Errors
    /// [`FolderError::Locked`] if another run has it, [`FolderError::Io`] if the lock file cannot be created or locked.
    pub(super) fn take(folder: &Path) -> Result<Self, FolderError> {
        let path = folder.join(LOCK);
        for _ in 0..TRIES {
            let opened = File::options().create(true).truncate(false).write(true).open(&path);
            let file = opened.map_err(about(&path))?;
            match file.try_lock() {
                Ok(()) if leads_to(&file, &path) => return Ok(Lock { path, file }),
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => break,
                Err(TryLockError::Error(e)) => return Err(about(&path)(e)),
            }
        }
        Err(FolderError::Locked(folder.display().to_string()))
    }

    /// Returns whether another run has the folder now.
    pub(super) fn is_taken(folder: &Path) -> bool {
        let file = File::options().write(true).open(folder.join(LOCK));
        file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
    }

    /// Returns whether the lock is still the folder's: false if the folder was removed.
    pub(super) fn is_current(&self) -> bool {
        leads_to(&self.file, &self.path)
    }

    /// Removes the lock file, unless it belongs to another run by now: a folder that was removed may have been created
    /// again. A file that cannot be removed is harmless; the next run takes it over.
    pub(super) fn release(&self) {
        if self.is_current() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Returns whether an open file is the one that a path leads to.
#[cfg(unix)]
fn leads_to(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |found: fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(ours), Ok(there)) => of(ours) == of(there),
        _ => false,
    }
}

/// Returns whether the path exists: on these systems, an open file cannot be removed.
#[cfg(not(unix))]
fn leads_to(_: &File, path: &Path) -> bool {
    path.exists()
}
