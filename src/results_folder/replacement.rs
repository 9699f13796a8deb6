//! A result replaced as a whole: whenever it is broken off, the folder holds the old result or the new one.
//!
//! ```text
//! .linkwright-new      the new files are written here; broken off, they are thrown away
//! .linkwright-whole    all are there: from this renaming on the new result is the result
//! .linkwright-moving   what is left of the old result is gone, the new files are moved to their places
//! ```
//!
//! Whoever takes the folder next brings the last two to their end.

use super::{TEMPORARY, disk, is_ours};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const NEW: &str = ".linkwright-new";
const WHOLE: &str = ".linkwright-whole";
const MOVING: &str = ".linkwright-moving";

/// An error and the path that it is about.
pub(super) type Failure = (PathBuf, io::Error);

fn about(path: &Path) -> impl FnOnce(io::Error) -> Failure + use<> {
    let path = path.to_path_buf();
    move |error| (path, error)
}

/// Writes `files` beside what the folder holds, after what was broken off before has been ended. They need not be on
/// the disk yet when this returns.
///
/// # Errors
/// The file that could not be written; the old result stays as it was.
pub(super) fn write(folder: &Path, files: &[(String, Vec<u8>)], kept: &[&str]) -> Result<(), Failure> {
    if [NEW, WHOLE, MOVING].iter().any(|name| is_folder(&folder.join(name))) {
        finish(folder, kept)?;
    }
    let new = folder.join(NEW);
    let written = || {
        disk::create_folder(&new).map_err(about(&new))?;
        for (name, bytes) in files {
            // The error names the file as it was to be.
            disk::write_new(&new.join(name), bytes).map_err(about(&folder.join(name)))?;
        }
        Ok(())
    };
    written().inspect_err(|_| forget(folder))
}

/// When the names in a folder are to be on the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wait {
    /// Before what they replace is thrown away.
    Now,
    /// The caller waits for them.
    Later,
}

/// What was written is on the disk when this returns.
///
/// # Errors
/// The file for which that failed; the old result stays as it was.
pub(super) fn sync(folder: &Path) -> Result<(), Failure> {
    let new = folder.join(NEW);
    let synced = || {
        for name in names(&new)? {
            disk::sync_file(&new.join(&name)).map_err(about(&folder.join(&name)))?;
        }
        disk::sync_folder(&new).map_err(about(&new))
    };
    synced().inspect_err(|_| forget(folder))
}

/// Puts what was written into the place of what the folder holds of ours, but for the names in `kept`.
///
/// # Errors
/// The old result stays as it was; or a file could not be moved, and the next to take the folder ends it.
pub(super) fn put(folder: &Path, kept: &[&str], names: Wait) -> Result<(), Failure> {
    let whole = folder.join(WHOLE);
    disk::rename(&folder.join(NEW), &whole).map_err(about(&whole)).inspect_err(|_| forget(folder))?;
    move_in(folder, kept, names)
}

/// Throws away what was written and is not whole.
fn forget(folder: &Path) {
    if not_of_ours(folder, NEW).is_none() {
        // What cannot be taken away here is taken away by the next run.
        let _ = disk::remove_folder(&folder.join(NEW));
    }
}

/// Brings a replacement that was broken off to its end and throws temporary files away.
///
/// # Errors
/// The path that could not be moved or taken away.
pub(super) fn finish(folder: &Path, kept: &[&str]) -> Result<(), Failure> {
    move_in(folder, kept, Wait::Now)?;
    take_away(folder, |name| !name.starts_with(TEMPORARY))
}

/// Brings a replacement that is whole to its end.
fn move_in(folder: &Path, kept: &[&str], wait: Wait) -> Result<(), Failure> {
    let (whole, moving) = (folder.join(WHOLE), folder.join(MOVING));
    for name in [WHOLE, MOVING] {
        if let Some(foreign) = not_of_ours(folder, name) {
            let why = format!("{foreign} is not of linkwright's");
            return Err((folder.join(name), io::Error::new(io::ErrorKind::AlreadyExists, why)));
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
        // The record first: it is what everything else is drawn from.
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

/// Where the record of a folder is: that of a new result which is whole but not yet in its place, or the visible one.
pub(super) fn records(folder: &Path) -> [PathBuf; 3] {
    [
        folder.join(MOVING).join(super::RECORD),
        folder.join(WHOLE).join(super::RECORD),
        folder.join(super::RECORD),
    ]
}

/// Whether there is a folder of this name; a link to one is none.
fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

/// Whether a name is that of a folder of a replacement.
pub(super) fn is_staging(name: &str) -> bool {
    [NEW, WHOLE, MOVING].contains(&name)
}

/// The part of a folder's entry `name` that no run writes under this name, if there is one: a run writes files, no
/// folders and no links, and its staging folders hold such files alone.
pub(super) fn not_of_ours(folder: &Path, name: &str) -> Option<String> {
    let path = folder.join(name);
    // An entry that has vanished since is a neighbour's.
    let Ok(found) = fs::symlink_metadata(&path) else { return None };
    if is_staging(name) && found.is_dir() {
        let inside = names(&path).unwrap_or_default();
        let foreign = inside.iter().find(|inner| !is_ours(inner) || !is_file(&path.join(inner)));
        return foreign.map(|inner| format!("{name}/{inner}"));
    }
    // A link in the place of a staging folder is taken away and not followed.
    if found.is_file() || (is_staging(name) && found.is_symlink()) {
        return None;
    }
    Some(if found.is_dir() { format!("a folder {name}") } else { format!("{name}, which is no file") })
}

/// Whether there is a file of this name; a link to one is none.
fn is_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_file())
}

/// The names in a folder, sorted.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, Failure> {
    let listed = fs::read_dir(folder).and_then(|entries| {
        entries.map(|entry| entry.map(|e| e.file_name().to_string_lossy().into_owned())).collect()
    });
    let mut listed: Vec<String> = listed.map_err(about(folder))?;
    listed.sort();
    Ok(listed)
}

/// Takes away what is ours and does not stay.
fn take_away(folder: &Path, stays: impl Fn(&str) -> bool) -> Result<(), Failure> {
    for name in names(folder)?.iter().filter(|name| is_ours(name) && !stays(name)) {
        let path = folder.join(name);
        // Put there after the folder was looked at: it stays, and where it is in the way of a new file that is told.
        if not_of_ours(folder, name).is_some() {
            continue;
        }
        let removed = if is_folder(&path) { disk::remove_folder(&path) } else { disk::remove_file(&path) };
        removed.map_err(about(&path))?;
    }
    Ok(())
}
