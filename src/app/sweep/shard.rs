//! The file of a shard, written whole or not at all, and checked when it is read.
//!
//! Its first line has the digest of the plan, the number of the shard and of its rows, and the SHA-256 digest of all the
//! lines after it: one row for each job, by number.

use super::SweepError;
use crate::app::job::folder::{FolderError, Replacement, is_temporary};
use crate::record::digest::hex;
use crate::record::sweep::{FORMAT, Plan};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The age from which nobody is writing a half-written file any more.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// The folder of the shards in the folder of a sweep.
pub const SHARDS: &str = "shards";

/// The first line of a shard.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: u32,
    plan: String,
    shard: u64,
    rows: u64,
    accepted: u64,
    bugs: u64,
    sha256: String,
}

/// A shard that is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardDone {
    /// The number of the shard, from 0.
    pub shard: u64,
    /// The number of its rows: one for each job.
    pub rows: u64,
    /// How many of them have an accepted candidate.
    pub accepted: u64,
    /// How many met a bug of linkwright.
    pub bugs: u64,
    /// SHA-256 of the rows.
    pub sha256: String,
    /// Whether its file was there before: nothing was run.
    pub before: bool,
}

/// Returns the path of a shard.
pub fn path_of(folder: &Path, shard: u64) -> PathBuf {
    folder.join(SHARDS).join(format!("{shard}.jsonl"))
}

/// Writes a shard: its rows as lines with their line feeds.
///
/// # Errors
/// [`SweepError::Folder`].
pub(super) fn write(
    folder: &Path,
    plan: &Plan,
    shard: u64,
    lines: &[String],
    [accepted, bugs]: [u64; 2],
) -> Result<ShardDone, SweepError> {
    let mut hash = Sha256::new();
    for line in lines {
        hash.update(line);
    }
    let rows = lines.len() as u64;
    let sha256 = hex(&hash.finalize());
    let head = Head {
        format: FORMAT,
        plan: plan.digest.clone(),
        shard,
        rows,
        accepted,
        bugs,
        sha256: sha256.clone(),
    };
    let path = path_of(folder, shard);
    let mut file = Replacement::begin(&path)?;
    let head = serde_json::to_string(&head).map_err(crate::record::digest::NotWritten::from)?;
    file.write(head.as_bytes())?;
    file.write(b"\n")?;
    for line in lines {
        file.write(line.as_bytes())?;
    }
    file.finish()?;
    Ok(ShardDone { shard, rows, accepted, bugs, sha256, before: false })
}

/// The file of a shard, open for its rows.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    file: BufReader<File>,
    head: Head,
    hash: Sha256,
    rows: u64,
}

impl Reader {
    /// Opens a shard of a plan and checks its first line; `None` if there is no such file.
    ///
    /// # Errors
    /// [`SweepError::OtherPlan`], [`SweepError::Damaged`], or [`SweepError::Folder`] if it cannot be read.
    pub fn open(folder: &Path, plan: &Plan, shard: u64) -> Result<Option<Reader>, SweepError> {
        let path = path_of(folder, shard);
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(io(&path, source)),
        };
        let mut file = BufReader::new(file);
        let mut line = String::new();
        let damaged = |how| SweepError::Damaged { path: path.display().to_string(), how };
        match file.read_line(&mut line) {
            Ok(_) => {}
            Err(e) if e.kind() == ErrorKind::InvalidData => return Err(damaged("it is not text")),
            Err(source) => return Err(io(&path, source)),
        }
        let head: Head =
            serde_json::from_str(&line).map_err(|_| damaged("its first line does not describe a shard"))?;
        if head.format != FORMAT || head.plan != plan.digest {
            return Err(SweepError::OtherPlan(path.display().to_string()));
        }
        let jobs = plan.jobs_of(shard);
        if head.shard != shard || head.rows != jobs.end - jobs.start {
            return Err(damaged("it is not the shard of its name"));
        }
        Ok(Some(Reader { path, file, head, hash: Sha256::new(), rows: 0 }))
    }

    /// Reads the next row with its line feed into `line`; false after the last.
    ///
    /// # Errors
    /// [`SweepError::Damaged`] if the rows are not those that were written, [`SweepError::Folder`].
    pub fn next(&mut self, line: &mut String) -> Result<bool, SweepError> {
        line.clear();
        match self.file.read_line(line) {
            Ok(0) => {}
            Ok(_) => {
                self.hash.update(&*line);
                self.rows += 1;
                return Ok(true);
            }
            Err(e) if e.kind() == ErrorKind::InvalidData => return Err(self.damaged("it is not text")),
            Err(source) => return Err(io(&self.path, source)),
        }
        if self.rows != self.head.rows {
            return Err(self.damaged("rows are missing"));
        }
        if hex(&self.hash.clone().finalize()) != self.head.sha256 {
            return Err(self.damaged("its rows are not those that were written"));
        }
        Ok(false)
    }

    fn damaged(&self, how: &'static str) -> SweepError {
        SweepError::Damaged { path: self.path.display().to_string(), how }
    }

    /// The error that a line is not the row of its job.
    pub(super) fn no_row(&self) -> SweepError {
        self.damaged("a row is not that of its job")
    }

    /// Returns the shard after all its rows were read and found right.
    pub fn done(self) -> ShardDone {
        let Head { shard, rows, accepted, bugs, sha256, .. } = self.head;
        ShardDone { shard, rows, accepted, bugs, sha256, before: true }
    }
}

/// Returns a shard that is complete, all of it read and checked; `None` if it is missing or damaged, and is to be run.
///
/// # Errors
/// [`SweepError::OtherPlan`], or [`SweepError::Folder`] if it cannot be read.
pub fn find(folder: &Path, plan: &Plan, shard: u64) -> Result<Option<ShardDone>, SweepError> {
    let read = || -> Result<Option<ShardDone>, SweepError> {
        let Some(mut reader) = Reader::open(folder, plan, shard)? else { return Ok(None) };
        let mut line = String::new();
        while reader.next(&mut line)? {}
        Ok(Some(reader.done()))
    };
    match read() {
        Err(SweepError::Damaged { .. }) => Ok(None),
        other => other,
    }
}

/// Removes the half-written files that processes which were killed have left in the folder of a sweep and among its shards.
///
/// `now` is the time by the clock of their file system, whatever that of this machine is: of a file that was just written
/// there. Other machines may be writing shards meanwhile, each within moments, so younger files stay.
pub(super) fn remove_abandoned(folder: &Path, now: SystemTime) {
    for place in [folder.to_path_buf(), folder.join(SHARDS)] {
        let Ok(entries) = fs::read_dir(place) else { continue };
        for entry in entries.flatten() {
            let Ok(found) = entry.metadata() else { continue };
            let age = found.modified().ok().and_then(|written| now.duration_since(written).ok());
            let ours = found.is_file() && is_temporary(&entry.file_name().to_string_lossy());
            if ours && age.is_some_and(|age| age >= ABANDONED) {
                // One that stays, because it is another user's, is in nobody's way.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Returns whether there is a file for a shard, whatever is in it.
pub(super) fn exists(folder: &Path, shard: u64) -> bool {
    fs::exists(path_of(folder, shard)).unwrap_or(false)
}

/// The error of the system at a path.
pub(super) fn io(path: &Path, source: std::io::Error) -> SweepError {
    FolderError::Io { path: path.display().to_string(), source }.into()
}
