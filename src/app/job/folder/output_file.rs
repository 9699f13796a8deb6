//! Output files that a person named, each written as a whole or not at all.

use super::{FolderError, TEMPORARY, about, disk};
use crate::files::generator;
use crate::files::generator::FileKind;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// An output file that a person named, with its contents.
#[derive(Clone, Copy, Debug)]
pub struct OutputFile<'a> {
    /// The path, as it was named.
    pub path: &'a Path,
    /// The kind of file.
    pub kind: FileKind,
    /// The contents.
    pub bytes: &'a [u8],
}

/// The condition under which an existing file may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replace<'a> {
    /// Only if this program wrote it as a file of the same kind, and it is none of these files, which the command
    /// reads.
    Ours(&'a [&'a Path]),
    /// Never: existing files are kept.
    Nothing,
    /// Always: `--force`.
    Anything,
}

/// Checks whether files may be written, before any of them is. A table is recognised by its header row, so that the
/// bytes need to contain at least that.
///
/// # Errors
/// [`FolderError::NotOurs`], [`FolderError::OwnInput`], [`FolderError::Exists`], [`FolderError::NamedTwice`] or, if an
/// existing file cannot be read, [`FolderError::Io`].
pub fn check_files(files: &[OutputFile<'_>], replace: Replace<'_>) -> Result<(), FolderError> {
    for (i, file) in files.iter().enumerate() {
        let there = may_replace(file, replace)?;
        // A stream may be written to twice.
        if there != There::Stream && files[..i].iter().any(|other| is_same(other.path, file.path)) {
            return Err(FolderError::NamedTwice(file.path.display().to_string()));
        }
    }
    Ok(())
}

/// Writes files that a person named, after all of them have been checked: each replaces the existing file, so that a
/// reader sees the old one or the new one, never half of either. A link is followed; a device or a pipe is written to
/// directly.
///
/// # Errors
/// Those of [`check_files`], with nothing written; [`FolderError::Io`] with the path that cannot be written: the old
/// file is kept, and new files are removed again.
pub fn write_files(files: &[OutputFile<'_>], replace: Replace<'_>) -> Result<(), FolderError> {
    check_files(files, replace)?;
    let mut made = Vec::new();
    for file in files {
        // Checked once more: another program may have written it in between.
        let written = may_replace(file, replace)
            .and_then(|there| write(file, there, replace).map_err(about(file.path)).map(|()| there));
        match written {
            Ok(There::Nothing) => made.push(file.path),
            Ok(_) => {}
            Err(e) => {
                for path in made {
                    // A file that cannot be removed was made by this program, so that the next attempt may replace it.
                    let _ = fs::remove_file(path);
                }
                return Err(e);
            }
        }
    }
    Ok(())
}

/// The existing entry that a new file would replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum There {
    /// No entry.
    Nothing,
    /// A file.
    File,
    /// A device or a pipe.
    Stream,
}

/// Returns the existing entry, if it may be replaced. This function alone decides about every file that a person can
/// name.
fn may_replace(file: &OutputFile<'_>, replace: Replace<'_>) -> Result<There, FolderError> {
    let shown = || file.path.display().to_string();
    let found = match fs::metadata(file.path) {
        Ok(found) if found.is_dir() => {
            return Err(about(file.path)(io::ErrorKind::IsADirectory.into()));
        }
        Ok(found) if !found.is_file() => return Ok(There::Stream),
        Ok(found) => found,
        // A link to nothing is noticed when a new file is to take its name.
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(There::Nothing),
        Err(e) => return Err(about(file.path)(e)),
    };
    let inputs = match replace {
        Replace::Anything => return Ok(There::File),
        Replace::Nothing => return Err(FolderError::Exists(shown())),
        Replace::Ours(inputs) => inputs,
    };
    if inputs.iter().any(|input| is_same(input, file.path)) {
        return Err(FolderError::OwnInput(shown()));
    }
    // An empty file holds nothing that could be lost.
    if found.len() == 0 {
        return Ok(There::File);
    }
    let mut existing = Vec::new();
    let read = File::open(file.path).and_then(|f| f.take(generator::MAX_BYTES).read_to_end(&mut existing));
    read.map_err(about(file.path))?;
    if file.kind.is_written_by_us(&existing, file.bytes) {
        return Ok(There::File);
    }
    Err(FolderError::NotOurs { path: shown(), kind: file.kind.described() })
}

/// Returns the folder in which a path lies.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns whether two paths lead to one file, which need not exist yet.
fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| {
        let there = path.canonicalize().ok();
        there.or_else(|| Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?)))
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
        // A file that another program creates meanwhile is kept.
        There::Nothing => match temporary(file.path, file.bytes)?.persist_noclobber(file.path) {
            Ok(_) => Ok(()),
            Err(e) if e.error.kind() == io::ErrorKind::AlreadyExists => Err(e.error),
            // Some file systems can only rename.
            Err(e) if fs::symlink_metadata(file.path).is_err() => {
                e.file.persist(file.path).map(drop).map_err(|e| e.error)
            }
            Err(e) => Err(e.error),
        },
        There::File if fs::metadata(file.path)?.permissions().readonly() => {
            Err(io::Error::from(io::ErrorKind::PermissionDenied))
        }
        There::File => over(&file.path.canonicalize()?, file.bytes),
    }
}

/// A file that takes its place when it is complete: a reader sees the old one or the whole new one.
#[derive(Debug)]
pub struct Replacement<'p> {
    path: &'p Path,
    file: BufWriter<NamedTempFile>,
}

impl<'p> Replacement<'p> {
    /// Begins a file for a place in a folder of linkwright's.
    ///
    /// # Errors
    /// [`FolderError::Io`] if no file can be created beside it.
    pub fn begin(path: &'p Path) -> Result<Self, FolderError> {
        let file = temporary(path, &[]).map_err(about(path))?;
        Ok(Replacement { path, file: BufWriter::new(file) })
    }

    /// Appends bytes.
    ///
    /// # Errors
    /// [`FolderError::Io`].
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), FolderError> {
        self.file.write_all(bytes).map_err(about(self.path))
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// [`FolderError::Io`]; the old file is kept.
    pub fn finish(self) -> Result<(), FolderError> {
        let path = self.path;
        let done = || {
            let file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
            disk::sync(file.as_file())?;
            file.persist(path).map(drop).map_err(|e| e.error)
        };
        done().map_err(about(path))
    }
}

/// Replaces the file at a path by these bytes.
pub(super) fn over(path: &Path, bytes: &[u8]) -> io::Result<()> {
    temporary(path, bytes)?.persist(path).map(drop).map_err(|e| e.error)
}

/// Creates a temporary file beside a path, with these bytes.
fn temporary(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Readable like any new file: the permissions that the user's mask allows.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder_of(path))?;
    disk::fill(file.as_file_mut(), bytes)?;
    disk::sync(file.as_file())?;
    Ok(file)
}
