//! Disk operations, one step each, so that tests can let every step fail in turn.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Opens a file of a results folder for reading; a pipe or a device, which might never end or never begin, is refused.
pub(super) fn open(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // A pipe that nobody writes to is opened at once, and refused below.
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    let refused =
        || io::Error::new(io::ErrorKind::InvalidInput, "it is no file but a pipe, a device or a folder");
    // Looked at before it is opened, as opening a device may do something.
    if !fs::metadata(path)?.is_file() {
        return Err(refused());
    }
    let file = options.read(true).open(path)?;
    if file.metadata()?.is_file() { Ok(file) } else { Err(refused()) }
}

/// Creates a folder.
pub(super) fn create_folder(path: &Path) -> io::Result<()> {
    step()?;
    fs::create_dir(path)
}

/// Creates a folder and the missing folders above it.
pub(super) fn create_folders(path: &Path) -> io::Result<()> {
    step()?;
    fs::create_dir_all(path)
}

/// Creates a file with these bytes.
pub(super) fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    step()?;
    fill(&mut File::create_new(path)?, bytes)
}

/// Writes bytes into an open file.
pub(super) fn fill(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    // In tests in two halves, with a step between them that may fail; otherwise in one go.
    let (first, second) = bytes.split_at(if cfg!(test) { bytes.len() / 2 } else { 0 });
    file.write_all(first)?;
    // A full disk is found in the middle of a file.
    step()?;
    file.write_all(second)
}

/// Waits until a file's bytes are on the disk. Writing many files first and synchronising them afterwards is several
/// times as fast as doing both for one after the other.
pub(super) fn sync_file(path: &Path) -> io::Result<()> {
    step()?;
    sync(&File::options().write(true).open(path)?)
}

/// Waits until the bytes of an open file are on the disk.
pub(super) fn sync(file: &File) -> io::Result<()> {
    // No test switches the power off, so waiting would be useless there.
    if cfg!(test) { Ok(()) } else { file.sync_data() }
}

/// Renames a file or a folder.
pub(super) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    step()?;
    fs::rename(from, to)
}

/// Removes a file.
pub(super) fn remove_file(path: &Path) -> io::Result<()> {
    step()?;
    fs::remove_file(path)
}

/// Removes a folder with all its contents; links in it are removed, not followed.
pub(super) fn remove_folder(path: &Path) -> io::Result<()> {
    step()?;
    // Most folders are empty by then.
    fs::remove_dir(path).or_else(|_| fs::remove_dir_all(path))
}

/// Waits until the names in a folder are on the disk, if the system can do that.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    step()?;
    if cfg!(all(unix, not(test))) { File::open(path)?.sync_all() } else { Ok(()) }
}

/// Waits until everything that was written to the file systems of these folders is on the disk.
///
/// # Errors
/// Also if the system cannot do that.
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
            // A folder that has vanished is noticed when its result is put in place.
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

/// Failing steps, chosen by a test.
#[cfg(test)]
pub(super) mod faults {
    use std::cell::Cell;
    use std::io;
    use std::ops::Range;

    thread_local! {
        static COUNT: Cell<usize> = const { Cell::new(0) };
        static FAILING: Cell<(usize, usize)> = const { Cell::new((usize::MAX, usize::MAX)) };
    }

    /// Lets the steps of this thread with these numbers, counted from 0 from now on, fail as on a full disk.
    pub(in crate::app::job::folder) fn fail(steps: Range<usize>) {
        COUNT.set(0);
        FAILING.set((steps.start, steps.end));
    }

    /// Returns the number of steps since [`fail`] was called.
    pub(in crate::app::job::folder) fn steps() -> usize {
        COUNT.get()
    }

    pub(super) fn step() -> io::Result<()> {
        let now = COUNT.replace(COUNT.get() + 1);
        let (start, end) = FAILING.get();
        if (start..end).contains(&now) { Err(io::Error::from(io::ErrorKind::StorageFull)) } else { Ok(()) }
    }
}
