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

/// Replaces what the folder holds of ours, but for the names in `kept`, by `files`.
///
/// # Errors
/// The file that could not be written, and the old result stays as it was; or one that could not be moved once all
/// were written, and the next to take the folder ends it.
pub(super) fn replace(folder: &Path, files: &[(String, Vec<u8>)], kept: &[&str]) -> Result<(), Failure> {
    finish(folder, kept)?;
    let new = folder.join(NEW);
    write_all(folder, &new, files).inspect_err(|_| {
        // What cannot be taken away here is taken away by the next run.
        let _ = disk::remove_folder(&new);
    })?;
    finish(folder, kept)
}

fn write_all(folder: &Path, new: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Failure> {
    disk::create_folder(new).map_err(about(new))?;
    for (name, bytes) in files {
        // The error names the file as it was to be.
        disk::write_new(&new.join(name), bytes).map_err(about(&folder.join(name)))?;
    }
    for (name, _) in files {
        disk::sync_file(&new.join(name)).map_err(about(&folder.join(name)))?;
    }
    disk::sync_folder(new).map_err(about(new))?;
    let whole = folder.join(WHOLE);
    disk::rename(new, &whole).map_err(about(&whole))
}

/// Brings a replacement that was broken off to its end and throws temporary files away.
///
/// # Errors
/// The path that could not be moved or taken away.
pub(super) fn finish(folder: &Path, kept: &[&str]) -> Result<(), Failure> {
    let (whole, moving) = (folder.join(WHOLE), folder.join(MOVING));
    if is_folder(&whole) {
        let new = names(&whole)?;
        let stays = |name: &str| new.iter().any(|n| n == name) || kept.contains(&name) || name == WHOLE;
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
        disk::sync_folder(folder).map_err(about(folder))?;
        disk::remove_folder(&moving).map_err(about(&moving))?;
    }
    take_away(folder, |name| !name.starts_with(TEMPORARY))
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
        let removed = if is_folder(&path) { disk::remove_folder(&path) } else { disk::remove_file(&path) };
        removed.map_err(about(&path))?;
    }
    Ok(())
}
