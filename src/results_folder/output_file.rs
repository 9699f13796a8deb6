//! A file that a person named, written as a whole or not at all.

use super::{FolderError, TEMPORARY, disk};
use crate::generator::{self, FileKind};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use tempfile::NamedTempFile;

/// A file that a person named, with what is to be in it.
#[derive(Clone, Copy, Debug)]
pub struct OutputFile<'a> {
    /// Its place, as it was named.
    pub path: &'a Path,
    /// Its kind.
    pub kind: FileKind,
    /// Its bytes.
    pub bytes: &'a [u8],
}

/// When a file that is there already may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replace<'a> {
    /// Where this program wrote it as a file of the same kind and it is none of these: the files that the command reads.
    Ours(&'a [&'a Path]),
    /// Never.
    Nothing,
    /// Whatever it is: `--force`.
    Anything,
}

/// Whether files may be written, before any of them is. A table is known by its header row, so that its bytes need to
/// hold that much.
///
/// # Errors
/// [`FolderError::NotOurs`], [`FolderError::OwnInput`], [`FolderError::Exists`], [`FolderError::NamedTwice`] or, where a
/// file that is there cannot be read, [`FolderError::Io`].
pub fn check_files(files: &[OutputFile<'_>], replace: Replace<'_>) -> Result<(), FolderError> {
    for (i, file) in files.iter().enumerate() {
        let there = may_replace(file, replace)?;
        // A stream takes whatever comes.
        if there != There::Stream && files[..i].iter().any(|other| is_same(other.path, file.path)) {
            return Err(FolderError::NamedTwice { path: file.path.display().to_string() });
        }
    }
    Ok(())
}

/// Writes files that a person named, after all of them were looked at: each in the place of the one that is there, so
/// that a reader sees the old one or the new one, never half of either. A link is followed; a device or a pipe is
/// written to as it is.
///
/// # Errors
/// Those of [`check_files`], with nothing written; [`FolderError::Io`] with the path that cannot be written, where what
/// was there before stays and new files are taken away again.
pub fn write_files(files: &[OutputFile<'_>], replace: Replace<'_>) -> Result<(), FolderError> {
    check_files(files, replace)?;
    let mut made = Vec::new();
    for file in files {
        // Looked at once more: another program may have written it in between.
        let written = may_replace(file, replace).and_then(|there| {
            write(file, there, replace).map_err(|e| FolderError::io(file.path, e)).map(|()| there)
        });
        match written {
            Ok(There::Nothing) => made.push(file.path),
            Ok(_) => {}
            Err(e) => {
                for path in made {
                    // One that was made a moment ago and stays is replaced by the next try.
                    let _ = fs::remove_file(path);
                }
                return Err(e);
            }
        }
    }
    Ok(())
}

/// The file that a new one would replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum There {
    /// None.
    Nothing,
    /// A file.
    File,
    /// A device or a pipe.
    Stream,
}

/// Looks at what is there. The one place that decides about every file that a person can name.
fn may_replace(file: &OutputFile<'_>, replace: Replace<'_>) -> Result<There, FolderError> {
    let shown = || file.path.display().to_string();
    let found = match fs::metadata(file.path) {
        Ok(found) if found.is_dir() => {
            return Err(FolderError::io(file.path, io::ErrorKind::IsADirectory.into()));
        }
        Ok(found) if !found.is_file() => return Ok(There::Stream),
        Ok(found) => found,
        // A link to nothing is found out when a new file is to take its name.
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(There::Nothing),
        Err(e) => return Err(FolderError::io(file.path, e)),
    };
    let inputs = match replace {
        Replace::Anything => return Ok(There::File),
        Replace::Nothing => return Err(FolderError::Exists { path: shown() }),
        Replace::Ours(inputs) => inputs,
    };
    if inputs.iter().any(|input| is_same(input, file.path)) {
        return Err(FolderError::OwnInput { path: shown() });
    }
    // An empty file holds nothing that could be lost.
    if found.len() == 0 {
        return Ok(There::File);
    }
    let mut existing = Vec::new();
    let read = File::open(file.path).and_then(|f| f.take(generator::MAX_BYTES).read_to_end(&mut existing));
    read.map_err(|e| FolderError::io(file.path, e))?;
    if file.kind.is_written_by_us(&existing, file.bytes) {
        return Ok(There::File);
    }
    Err(FolderError::NotOurs { path: shown(), kind: file.kind.described() })
}

/// Whether two paths lead to one file, which may not be there yet.
fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| {
        path.canonicalize().ok().or_else(|| {
            let folder =
                path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        })
    };
    match (real(one), real(other)) {
        (Some(one), Some(other)) => one == other,
        _ => one == other,
    }
}

fn write(file: &OutputFile<'_>, there: There, replace: Replace<'_>) -> io::Result<()> {
    match there {
        There::Stream => fs::write(file.path, file.bytes),
        There::Nothing if replace == Replace::Anything => over(file.path, file.bytes),
        // Whoever else makes this file meanwhile keeps it.
        There::Nothing => match temporary(file.path, file.bytes)?.persist_noclobber(file.path) {
            Ok(_) => Ok(()),
            Err(e) if e.error.kind() == io::ErrorKind::AlreadyExists => Err(e.error),
            // Some file systems can only rename.
            Err(e) if fs::symlink_metadata(file.path).is_err() => {
                e.file.persist(file.path).map_err(|e| e.error)?;
                Ok(())
            }
            Err(e) => Err(e.error),
        },
        There::File if fs::metadata(file.path)?.permissions().readonly() => {
            Err(io::Error::from(io::ErrorKind::PermissionDenied))
        }
        There::File => over(&file.path.canonicalize()?, file.bytes),
    }
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
