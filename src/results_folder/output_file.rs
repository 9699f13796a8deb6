//! A file that a person named, written as a whole or not at all.

use super::{FolderError, TEMPORARY, disk};
use std::fs;
use std::io;
use std::path::Path;
use tempfile::NamedTempFile;

/// Writes a file, in the place of the one that is there: a reader sees the old one or the new one, never half of
/// either. A link is followed; a device or a pipe is written to as it is.
///
/// # Errors
/// [`FolderError::Io`] with the path; what was there before stays.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let written = match fs::metadata(path) {
        Ok(found) if found.is_file() && found.permissions().readonly() => {
            Err(io::Error::from(io::ErrorKind::PermissionDenied))
        }
        Ok(found) if found.is_file() => path.canonicalize().and_then(|real| over(&real, bytes)),
        Ok(_) => fs::write(path, bytes),
        Err(_) => over(path, bytes),
    };
    written.map_err(|e| FolderError::io(path, e))
}

/// Writes a file that is not there yet.
///
/// # Errors
/// [`FolderError::Io`] with the path, [`io::ErrorKind::AlreadyExists`] where it is there.
pub fn create_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let created = temporary(path, bytes).and_then(|file| {
        file.persist_noclobber(path).map_err(|e| e.error)?;
        Ok(())
    });
    created.map_err(|e| FolderError::io(path, e))
}

/// Puts the bytes in the place of a path.
pub(super) fn over(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let file = temporary(path, bytes)?;
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}

/// A temporary file beside a path, with the bytes in it.
fn temporary(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Readable as any new file: what the user's mask leaves of it.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder)?;
    disk::fill(file.as_file_mut(), bytes)?;
    disk::sync(file.as_file())?;
    Ok(file)
}
