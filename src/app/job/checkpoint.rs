//! Checkpoints of unfinished searches on disk, from which `synth --resume` continues.
//!
//! ```json
//! {"format": 1, "tool": {"name": "linkwright", "version": "0.1.0"}, "digest": "..", "candidates": 5,
//!  "evaluations": 200000, "checksum": "..", "state": {}}
//! ```
//!
//! A checkpoint is an input like any other: its size is limited, and it is refused if it is not a checkpoint, is of
//! another problem or another version, or was changed. `checksum` is the SHA-256 of all the rest as it is written here.
//! The digest does not cover the number of candidates and the budget ([`digest`]): a search for another number of
//! candidates, or with a smaller budget, would not have reached this state and begins anew ([`Checkpoint::leads_to`]).

use crate::app::job::folder::read_file_at_most;
use crate::app::job::run::Job;
use crate::record::Tool;
use crate::record::digest::{NotWritten, digest};
use crate::synthesis::keeper::SearchState;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io;
use std::path::Path;

/// The largest checkpoint that is written or read.
pub const MAX_BYTES: u64 = 256 << 20;
/// The version of the format.
const FORMAT: u32 = 1;

/// The reason why a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be read.
    #[error("{path}: {source}")]
    Io {
        /// Path of the file.
        path: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The file is larger than [`MAX_BYTES`].
    #[error("{0} has more than {MAX_BYTES} bytes, the most that a checkpoint has; {REMEDY}")]
    TooLarge(String),
    /// The file is not a checkpoint.
    #[error("{path}: this is not a whole linkwright checkpoint: {message}; {REMEDY}")]
    NotACheckpoint {
        /// Path of the file.
        path: String,
        /// The fault, with line and column.
        message: String,
    },
    /// It was written in another format or by another version.
    #[error("{path} was written by {by}, this is {us}: the search may have changed between them; {REMEDY}")]
    OtherVersion {
        /// Path of the file.
        path: String,
        /// The tool, version and format that wrote it.
        by: String,
        /// The tool, version and format of this program.
        us: String,
    },
    /// Something in it was changed after it was written.
    #[error("{0} was changed after it was written (its checksum is wrong); {REMEDY}")]
    Changed(String),
    /// It belongs to another problem.
    #[error(
        "{path} is of another problem: the target, design, requirements, method or seed differ from those of \
         \"{name}\"; run it as it was, give another folder with --out, or run without --resume to begin anew"
    )]
    OtherProblem {
        /// Path of the file.
        path: String,
        /// The problem that is to be run.
        name: String,
    },
    /// The problem has no digest.
    #[error(transparent)]
    Digest(#[from] NotWritten),
}

const REMEDY: &str = "run without --resume to begin anew";

/// An unfinished search.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    header: Header,
    state: SearchState,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    format: u32,
    tool: Tool,
    digest: String,
    candidates: usize,
    evaluations: u64,
}

/// The content of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: u32,
    tool: Tool,
    digest: String,
    candidates: usize,
    evaluations: u64,
    checksum: String,
    state: SearchState,
}

/// The part that can be read of a file of any version.
#[derive(Deserialize)]
struct AnyVersion {
    format: u64,
    tool: Tool,
}

impl Header {
    fn of(job: &Job) -> Result<Self, NotWritten> {
        let solve = &job.spec.solve;
        Ok(Header {
            format: FORMAT,
            tool: Tool::this(),
            digest: digest(&job.spec)?,
            candidates: solve.candidates,
            evaluations: solve.evaluations,
        })
    }

    fn checksum(&self, state: &SearchState) -> Option<String> {
        let text = serde_json::to_vec(&(self, state)).ok()?;
        Some(Sha256::digest(&text).iter().map(|byte| format!("{byte:02x}")).collect())
    }
}

/// A writer of the states of one job's search as checkpoints.
#[derive(Clone, Debug)]
pub struct Writer {
    header: Header,
}

impl Writer {
    /// Creates a writer for the search of `job`.
    ///
    /// # Errors
    /// [`NotWritten`] if the problem cannot be written as data.
    pub fn new(job: &Job) -> Result<Self, NotWritten> {
        Ok(Writer { header: Header::of(job)? })
    }

    /// Returns the file's bytes; `None` if they could not be read back: a state that holds a number that JSON cannot
    /// express, or one over the limit.
    pub fn bytes(&self, state: &SearchState) -> Option<Vec<u8>> {
        let Header { format, tool, digest, candidates, evaluations } = self.header.clone();
        let checksum = self.header.checksum(state)?;
        let document =
            Document { format, tool, digest, candidates, evaluations, checksum, state: state.clone() };
        let bytes = serde_json::to_vec(&document).ok()?;
        let whole = bytes.len() as u64 <= MAX_BYTES && parse("", &bytes).is_ok();
        whole.then_some(bytes)
    }
}

impl Checkpoint {
    /// Reads the checkpoint of a job's earlier search; `None` if there is none.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn read(path: &Path, job: &Job) -> Result<Option<Self>, CheckpointError> {
        let shown = path.display().to_string();
        let bytes = match read_file_at_most(path, MAX_BYTES) {
            Ok(Some(bytes)) => bytes,
            Ok(None) => return Err(CheckpointError::TooLarge(shown)),
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(CheckpointError::Io { path: shown, source }),
        };
        let checkpoint = parse(&shown, &bytes)?;
        if checkpoint.header.digest != digest(&job.spec)? {
            return Err(CheckpointError::OtherProblem { path: shown, name: job.name.clone() });
        }
        Ok(Some(checkpoint))
    }

    /// Returns the reason why a search of this job would not have reached this state, in words that follow "begins
    /// anew: "; `None` if it would have.
    pub fn leads_to(&self, job: &Job) -> Option<String> {
        let (then, now) = (&self.header, &job.spec.solve);
        if then.candidates != now.candidates {
            let (then, now) = (then.candidates, now.candidates);
            return Some(format!("the checkpoint is of a search for solve.candidates = {then}, not {now}"));
        }
        if then.evaluations > now.evaluations {
            let (then, now) = (then.evaluations, now.evaluations);
            return Some(format!(
                "the checkpoint is of a search with solve.evaluations = {then}; a budget may be raised, and {now} is \
                 less"
            ));
        }
        None
    }

    /// Returns the state of the search.
    pub fn into_state(self) -> SearchState {
        self.state
    }
}

/// Parses a checkpoint of any problem from a text; `path` is shown in errors.
///
/// # Errors
/// [`CheckpointError`].
pub fn parse(path: &str, bytes: &[u8]) -> Result<Checkpoint, CheckpointError> {
    let path = || path.to_string();
    let none =
        |e: serde_json::Error| CheckpointError::NotACheckpoint { path: path(), message: e.to_string() };
    let AnyVersion { format, tool } = serde_json::from_slice(bytes).map_err(none)?;
    let us = Tool::this();
    if format != u64::from(FORMAT) || tool != us {
        let shown = |tool: &Tool, format: u64| format!("{} {} (format {format})", tool.name, tool.version);
        let (by, us) = (shown(&tool, format), shown(&us, FORMAT.into()));
        return Err(CheckpointError::OtherVersion { path: path(), by, us });
    }
    let document: Document = serde_json::from_slice(bytes).map_err(none)?;
    let Document { format, tool, digest, candidates, evaluations, checksum, state } = document;
    let header = Header { format, tool, digest, candidates, evaluations };
    if header.checksum(&state).as_ref() != Some(&checksum) {
        return Err(CheckpointError::Changed(path()));
    }
    Ok(Checkpoint { header, state })
}
