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
    let (first, second) = bytes.split_at(bytes.len() / 2);
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
    fs::remove_dir_all(path)
}

/// The names in a folder on the disk when this returns, where the system can do that.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    step()?;
    if cfg!(all(unix, not(test))) { File::open(path)?.sync_all() } else { Ok(()) }
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
