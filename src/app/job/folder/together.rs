//! Writing many results to the disk with one wait for it.
//!
//! Waiting until a file is on the disk takes milliseconds, as long as a small search; waiting for everything that was
//! written to a file system takes hardly longer. So the results of a batch are written as they come, and those that
//! came while the disk was busy are waited for together. Each is put in its place only when its files are on the disk:
//! after a power cut there is the old result or the new one, as there is if a result is replaced alone.

use super::replacement::Wait;
use super::{FolderError, ResultsFolder, disk};

/// Puts the results that were written ([`ResultsFolder::write`]) in the places of the old ones, each as
/// [`ResultsFolder::replace`] does. All are on the disk when this returns, if the system can do that.
///
/// # Errors
/// Those of [`ResultsFolder::replace`], for each folder.
pub fn put_together(folders: &mut [&mut ResultsFolder]) -> Vec<Result<(), FolderError>> {
    let all_on_disk = |folders: &[&mut ResultsFolder]| {
        folders.len() > 1 && disk::sync_file_systems(folders.iter().map(|folder| folder.path())).is_ok()
    };
    let files_there = all_on_disk(folders);
    let put = |folder: &mut &mut ResultsFolder| {
        if !files_there {
            folder.sync()?;
        }
        folder.put(Wait::Later)
    };
    let mut results: Vec<_> = folders.iter_mut().map(put).collect();
    if !all_on_disk(folders) {
        for (folder, result) in folders.iter().zip(&mut results).filter(|(_, result)| result.is_ok()) {
            *result = folder.sync_names();
        }
    }
    results
}
