//! One run at a time has a results folder: an advisory lock on its `.lock`, which the system lets go when the process
//! ends, however it ends.
//!
//! The file is taken away by the one who holds it. Another may have opened it just before: it then locks a file that
//! nobody finds any more, while a third creates a new one. So a lock counts only if the file that was locked is the
//! one that stands there, and only that is taken away.

use super::{FolderError, LOCK};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// As often another run may let go of the folder while this one takes it.
const TRIES: usize = 100;

/// A lock that is held.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Takes the lock of a folder.
    ///
    /// # Errors
    /// [`FolderError::Locked`] where another run has it, [`FolderError::Io`] where there can be none.
    pub(super) fn take(folder: &Path) -> Result<Self, FolderError> {
        let path = folder.join(LOCK);
        for _ in 0..TRIES {
            let opened = File::options().create(true).truncate(false).write(true).open(&path);
            let file = opened.map_err(|e| FolderError::io(&path, e))?;
            match file.try_lock() {
                Ok(()) if stands_at(&file, &path) => return Ok(Lock { path, file }),
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => break,
                Err(TryLockError::Error(e)) => return Err(FolderError::io(&path, e)),
            }
        }
        Err(FolderError::Locked { path: folder.display().to_string() })
    }

    /// Whether another run has the folder now.
    pub(super) fn is_taken(folder: &Path) -> bool {
        let file = File::options().write(true).open(folder.join(LOCK));
        file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
    }

    /// Whether it still is the folder's: not where somebody took the folder away.
    pub(super) fn stands(&self) -> bool {
        stands_at(&self.file, &self.path)
    }

    /// Takes the file away, unless it is another's by now: a folder that was taken away may have been made anew. What
    /// cannot be taken away is harmless; the next run takes it over.
    pub(super) fn release(&self) {
        if self.stands() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Whether an open file is the one that a path leads to.
#[cfg(unix)]
fn stands_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |found: fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(ours), Ok(there)) => of(ours) == of(there),
        _ => false,
    }
}

/// A file that is open cannot be taken away there.
#[cfg(not(unix))]
fn stands_at(_: &File, path: &Path) -> bool {
    path.exists()
}
