//! Replacement of a result as a whole: even if it is interrupted, the folder holds the old result or the new one.
//!
//! ```text
//! .linkwright-new      the new files are written here; if that is interrupted, they are removed
//! .linkwright-whole    all new files are written: from this renaming on the new result counts
//! .linkwright-moving   the old files are removed, and the new ones are moved to their places
//! ```
//!
//! The next run that takes the folder completes the replacement in the last two cases.

use super::{FolderError, TEMPORARY, about, disk, is_ours};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const NEW: &str = ".linkwright-new";
const WHOLE: &str = ".linkwright-whole";
const MOVING: &str = ".linkwright-moving";

/// Writes `files` beside the contents of the folder, after completing an earlier interrupted replacement. The files
/// need not be on the disk yet when this returns.
///
/// # Errors
/// The file that could not be written; the old result is kept.
pub(super) fn write(folder: &Path, files: &[(String, Vec<u8>)], kept: &[&str]) -> Result<(), FolderError> {
    if [NEW, WHOLE, MOVING].iter().any(|name| is_folder(&folder.join(name))) {
        finish(folder, kept)?;
    }
    let new = folder.join(NEW);
    let written = || {
        disk::create_folder(&new).map_err(about(&new))?;
        for (name, bytes) in files {
            // The error names the file with its final path.
            disk::write_new(&new.join(name), bytes).map_err(about(&folder.join(name)))?;
        }
        Ok(())
    };
    written().inspect_err(|_| forget(folder))
}

/// The time at which the names in a folder have to be on the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wait {
    /// Before the staging folder of the new files is removed.
    Now,
    /// Later: the caller waits for them.
    Later,
}

/// Waits until the written files are on the disk.
///
/// # Errors
/// The file for which that failed; the old result is kept.
pub(super) fn sync(folder: &Path) -> Result<(), FolderError> {
    let new = folder.join(NEW);
    let synced = || {
        for name in names(&new)? {
            disk::sync_file(&new.join(&name)).map_err(about(&folder.join(&name)))?;
        }
        disk::sync_folder(&new).map_err(about(&new))
    };
    synced().inspect_err(|_| forget(folder))
}

/// Replaces the old result in the folder by the written files, except for the names in `kept`.
///
/// # Errors
/// The old result is kept; or a file could not be moved, and the next run that takes the folder completes the
/// replacement.
pub(super) fn put(folder: &Path, kept: &[&str], names: Wait) -> Result<(), FolderError> {
    let whole = folder.join(WHOLE);
    disk::rename(&folder.join(NEW), &whole).map_err(about(&whole)).inspect_err(|_| forget(folder))?;
    move_in(folder, kept, names)
}

/// Removes the written files of a replacement that is not complete.
fn forget(folder: &Path) {
    if not_of_ours(folder, NEW).is_none() {
        // A folder that cannot be removed here is removed by the next run.
        let _ = disk::remove_folder(&folder.join(NEW));
    }
}

/// Completes an interrupted replacement and removes temporary files.
///
/// # Errors
/// The path that could not be moved or removed.
pub(super) fn finish(folder: &Path, kept: &[&str]) -> Result<(), FolderError> {
    move_in(folder, kept, Wait::Now)?;
    take_away(folder, |name| !name.starts_with(TEMPORARY))
}

/// Completes a replacement whose files are all written.
fn move_in(folder: &Path, kept: &[&str], wait: Wait) -> Result<(), FolderError> {
    let (whole, moving) = (folder.join(WHOLE), folder.join(MOVING));
    for name in [WHOLE, MOVING] {
        if let Some(foreign) = not_of_ours(folder, name) {
            let why = format!("{foreign} is not of linkwright's");
            return Err(about(&folder.join(name))(io::Error::new(io::ErrorKind::AlreadyExists, why)));
        }
    }
    if is_folder(&whole) {
        let new = names(&whole)?;
        let stays =
            |name: &str| name.starts_with(TEMPORARY) || kept.contains(&name) || new.iter().any(|n| n == name);
        take_away(folder, stays)?;
        disk::rename(&whole, &moving).map_err(about(&moving))?;
    }
    if is_folder(&moving) {
        let mut staged: Vec<String> = names(&moving)?.into_iter().filter(|name| is_ours(name)).collect();
        // The record first: everything else is made from it.
        staged.sort_by_key(|name| name != super::RECORD);
        for name in staged {
            let target = folder.join(&name);
            disk::rename(&moving.join(&name), &target).map_err(about(&target))?;
        }
        if wait == Wait::Now {
            disk::sync_folder(folder).map_err(about(folder))?;
        }
        disk::remove_folder(&moving).map_err(about(&moving))?;
    }
    Ok(())
}

/// Returns the possible paths of a folder's record: of a new result that is complete but not yet in its place, and the
/// usual one.
pub(super) fn records(folder: &Path) -> [PathBuf; 3] {
    [
        folder.join(MOVING).join(super::RECORD),
        folder.join(WHOLE).join(super::RECORD),
        folder.join(super::RECORD),
    ]
}

/// Returns whether there is a folder at this path; a link to a folder does not count.
fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

/// Returns whether a name is that of a folder of a replacement.
pub(super) fn is_staging(name: &str) -> bool {
    [NEW, WHOLE, MOVING].contains(&name)
}

/// Returns the part of a folder's entry `name` that no run writes under this name, if there is one: a run writes files,
/// no folders and no links, and its staging folders contain only such files.
pub(super) fn not_of_ours(folder: &Path, name: &str) -> Option<String> {
    let path = folder.join(name);
    // An entry that has vanished since was another run's.
    let Ok(found) = fs::symlink_metadata(&path) else { return None };
    if is_staging(name) && found.is_dir() {
        let inside = names(&path).unwrap_or_default();
        let foreign = inside.iter().find(|inner| !is_ours(inner) || !is_file(&path.join(inner)));
        return foreign.map(|inner| format!("{name}/{inner}"));
    }
    // A link in the place of a staging folder is removed and not followed.
    if found.is_file() || (is_staging(name) && found.is_symlink()) {
        return None;
    }
    Some(if found.is_dir() { format!("a folder {name}") } else { format!("{name}, which is no file") })
}

/// Returns whether there is a file at this path; a link to a file does not count.
fn is_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_file())
}

/// Returns the names in a folder, sorted.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, FolderError> {
    let listed = fs::read_dir(folder).and_then(|entries| {
        entries.map(|entry| entry.map(|e| e.file_name().to_string_lossy().into_owned())).collect()
    });
    let mut listed: Vec<String> = listed.map_err(about(folder))?;
    listed.sort();
    Ok(listed)
}

/// Removes the files that runs write, except for those that `stays` keeps.
fn take_away(folder: &Path, stays: impl Fn(&str) -> bool) -> Result<(), FolderError> {
    for name in names(folder)?.iter().filter(|name| is_ours(name) && !stays(name)) {
        let path = folder.join(name);
        // It was put there after the folder was checked: it is kept, and if it is in the way of a new file, an error
        // says so.
        if not_of_ours(folder, name).is_some() {
            continue;
        }
        let removed = if is_folder(&path) { disk::remove_folder(&path) } else { disk::remove_file(&path) };
        removed.map_err(about(&path))?;
    }
    Ok(())
}
