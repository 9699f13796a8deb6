//! Certificates and the files beside their record: the checkpoint from which a proof goes on, the leaves that show it.

use crate::app::job::folder::{CERTIFICATE_CHECKPOINT, FolderError, LEAVES, read_at_most};
use crate::judge::certificate::checkpoint::{MAX_BYTES as MOST_OF_CHECKPOINT, REMEDY};
use crate::judge::certificate::{CheckError, Checked, NoCertificate, Proof, Request, ResumeError, check};
use crate::numbers::leaves::{Leaves, LeavesError, MAX_BYTES as MOST_OF_LEAVES};
use crate::record::{Certificate, Record};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The reason why a file beside a record cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum Unusable {
    /// The record has no certificate that leaves could show.
    #[error("{0}: the record has no certificate; run certify with --leaves first")]
    NoCertificate(String),
    /// The result has no leaves.
    #[error("{0}: there are no leaves; run certify with --leaves first")]
    NoLeaves(String),
    /// The leaves are too large.
    #[error("{0}: leaves have at most {MOST_OF_LEAVES} bytes")]
    LargeLeaves(String),
    /// The leaves are of another kind or version.
    #[error("{path}: {why}")]
    Leaves {
        /// The path of the leaves.
        path: String,
        /// The fault.
        why: LeavesError,
    },
    /// Nothing can be proved about the record's problem.
    #[error("{path}: {why}")]
    Problem {
        /// The path of the result.
        path: String,
        /// The reason.
        why: NoCertificate,
    },
    /// The checkpoint is too large.
    #[error("{0}: it has at most {MOST_OF_CHECKPOINT} bytes; {REMEDY}")]
    LargeCheckpoint(String),
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] FolderError),
}

/// Returns the path of a file beside the record of a result, which is a folder or its `record.json`.
pub fn beside(result: &Path, name: &str) -> PathBuf {
    if result.is_dir() { result.join(name) } else { result.with_file_name(name) }
}

/// Returns the path of the leaves of a result.
pub fn leaves_of(result: &Path) -> PathBuf {
    beside(result, LEAVES)
}

/// Returns the path of the checkpoint of a result's proof.
pub fn checkpoint_of(result: &Path) -> PathBuf {
    beside(result, CERTIFICATE_CHECKPOINT)
}

fn read(path: &Path, most: u64, too_large: fn(String) -> Unusable) -> Result<Option<Vec<u8>>, Unusable> {
    let shown = || path.display().to_string();
    match read_at_most(path, most) {
        Ok(Some(bytes)) => Ok(Some(bytes)),
        Ok(None) => Err(too_large(shown())),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(FolderError::Io { path: shown(), source }.into()),
    }
}

/// Reads the checkpoint that a stopped proof left beside a record; `None` if there is none.
///
/// # Errors
/// [`Unusable`].
pub fn read_checkpoint(result: &Path) -> Result<Option<Vec<u8>>, Unusable> {
    read(&checkpoint_of(result), MOST_OF_CHECKPOINT, Unusable::LargeCheckpoint)
}

/// Reads the leaves beside a record.
///
/// # Errors
/// [`Unusable`].
pub fn read_leaves(result: &Path) -> Result<Vec<u8>, Unusable> {
    let path = leaves_of(result);
    let found = read(&path, MOST_OF_LEAVES, Unusable::LargeLeaves)?;
    found.ok_or_else(|| Unusable::NoLeaves(path.display().to_string()))
}

/// Returns the certificate of a record, which is needed before there can be leaves.
///
/// # Errors
/// [`Unusable::NoCertificate`].
pub fn certificate_of<'a>(result: &Path, record: &'a Record) -> Result<&'a Certificate, Unusable> {
    record.certificate.as_ref().ok_or_else(|| Unusable::NoCertificate(result.display().to_string()))
}

/// Checks that leaves prove the certificate of a record, with arithmetic of their own; the inner error is that they do
/// not, or that the check was stopped.
///
/// # Errors
/// [`Unusable`] if there is nothing to check.
pub fn check_leaves(
    result: &Path,
    record: &Record,
    leaves: &[u8],
    cancel: &AtomicBool,
    progress: &mut dyn FnMut(&Checked),
) -> Result<Result<Checked, CheckError>, Unusable> {
    let recorded = certificate_of(result, record)?;
    match check(record, recorded, leaves, cancel, progress) {
        Err(CheckError::NoCertificate(why)) => {
            Err(Unusable::Problem { path: result.display().to_string(), why })
        }
        Err(CheckError::Leaves(why @ (LeavesError::Foreign | LeavesError::Version { .. }))) => {
            Err(Unusable::Leaves { path: leaves_of(result).display().to_string(), why })
        }
        checked => Ok(checked),
    }
}

/// Begins the proof for a record, or goes on from the checkpoint of one that was stopped.
///
/// # Errors
/// [`ResumeError`]: the checkpoint is of another proof, or nothing can be proved.
pub fn begin(record: &Record, gap: f64, checkpoint: Option<&[u8]>) -> Result<Proof, ResumeError> {
    let request = Request { gap };
    match checkpoint {
        Some(bytes) => Proof::resume(record, &request, bytes),
        None => Ok(Proof::new(record, &request)?),
    }
}

/// Puts what a proof has reached into the record and returns its leaves; `None`: the certificate of the record proves more
/// and stays.
pub fn put(record: &mut Record, proof: &Proof) -> Option<Leaves> {
    let leaves = proof.leaves();
    let certificate = proof.certificate_of(&leaves);
    let proved = |certificate: &Certificate| (certificate.lower_bound, certificate.boxes);
    if record.certificate.as_ref().is_some_and(|former| proved(former) > proved(&certificate)) {
        return None;
    }
    record.certificate = Some(certificate);
    record.no_certificate = None;
    Some(leaves)
}
