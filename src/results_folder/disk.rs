//! What is done to the disk, a step each, so that tests can let every step fail in turn.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// A new folder.
pub(super) fn create_folder(path: &Path) -> io::Result<()> {
    step()?;
    fs::create_dir(path)
}

/// A folder with those above it, where they are missing.
pub(super) fn create_folders(path: &Path) -> io::Result<()> {
    step()?;
    fs::create_dir_all(path)
}

/// A new file with its bytes.
pub(super) fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    step()?;
    fill(&mut File::create_new(path)?, bytes)
}

/// Bytes into a file that is open.
pub(super) fn fill(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    // In halves where a step may fail; in one go otherwise.
    let (first, second) = bytes.split_at(if cfg!(test) { bytes.len() / 2 } else { 0 });
    file.write_all(first)?;
    // A full disk is found in the midst of a file.
    step()?;
    file.write_all(second)
}

/// A file's bytes on the disk when this returns. Many files are written first and synchronised then: that is
/// several times as fast as one after the other.
pub(super) fn sync_file(path: &Path) -> io::Result<()> {
    step()?;
    sync(&File::options().write(true).open(path)?)
}

/// The bytes of an open file on the disk when this returns.
pub(super) fn sync(file: &File) -> io::Result<()> {
    // No test takes the power away: they would only wait.
    if cfg!(test) { Ok(()) } else { file.sync_data() }
}

/// A file or a folder under another name.
pub(super) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    step()?;
    fs::rename(from, to)
}

/// A file taken away.
pub(super) fn remove_file(path: &Path) -> io::Result<()> {
    step()?;
    fs::remove_file(path)
}

/// A folder taken away with all that is in it; links in it are taken away, not followed.
pub(super) fn remove_folder(path: &Path) -> io::Result<()> {
    step()?;
    // Most are empty by then.
    fs::remove_dir(path).or_else(|_| fs::remove_dir_all(path))
}

/// The names in a folder on the disk when this returns, where the system can do that.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    step()?;
    if cfg!(all(unix, not(test))) { File::open(path)?.sync_all() } else { Ok(()) }
}

/// All that was written to the file systems of these folders is on the disk when this returns.
///
/// # Errors
/// Also where the system cannot do that.
pub(super) fn sync_file_systems<'p>(folders: impl Iterator<Item = &'p Path>) -> io::Result<()> {
    step()?;
    if cfg!(test) { Ok(()) } else { systems::sync(folders) }
}

#[cfg(target_os = "linux")]
mod systems {
    use std::collections::BTreeMap;
    use std::fs::{self, File};
    use std::io;
    use std::os::unix::fs::MetadataExt;
    use std::path::Path;

    pub(super) fn sync<'p>(folders: impl Iterator<Item = &'p Path>) -> io::Result<()> {
        let mut systems = BTreeMap::new();
        for folder in folders {
            // A folder that has vanished is found out when its result is put in place.
            let Ok(found) = fs::metadata(folder) else { continue };
            systems.entry(found.dev()).or_insert(folder);
        }
        systems.into_values().try_for_each(|folder| Ok(rustix::fs::syncfs(File::open(folder)?)?))
    }
}

#[cfg(not(target_os = "linux"))]
mod systems {
    use std::io;
    use std::path::Path;

    pub(super) fn sync<'p>(_: impl Iterator<Item = &'p Path>) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

#[cfg(not(test))]
fn step() -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
use faults::step;

/// Steps that fail, chosen by a test.
#[cfg(test)]
pub(super) mod faults {
    use std::cell::Cell;
    use std::io;
    use std::ops::Range;

    thread_local! {
        static COUNT: Cell<usize> = const { Cell::new(0) };
        static FAILING: Cell<(usize, usize)> = const { Cell::new((usize::MAX, usize::MAX)) };
    }

    /// Lets the steps of this thread with these numbers, from now and from 0, fail as on a full disk.
    pub(in super::super) fn fail(steps: Range<usize>) {
        COUNT.set(0);
        FAILING.set((steps.start, steps.end));
    }

    /// How many steps there were since then.
    pub(in super::super) fn steps() -> usize {
        COUNT.get()
    }

    pub(super) fn step() -> io::Result<()> {
        let now = COUNT.replace(COUNT.get() + 1);
        let (start, end) = FAILING.get();
        if (start..end).contains(&now) { Err(io::Error::from(io::ErrorKind::StorageFull)) } else { Ok(()) }
    }
}
