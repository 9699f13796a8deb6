//! The checkpoint of a search for a certificate, as a file: `certify --resume` continues from it.
//!
//! ```text
//! 0    8  "lwproof\0"
//! 8    4  1: the version of the format            numbers are little-endian
//! 12   1  length of the program's version, then that version
//!      32 SHA-256 of the figures of the search: points, increments, directions, cap, best sum, gap
//!      4  the number of parts
//! then, a part: 8 the share that is decided (double), 8 the number of nodes, the nodes as in `certificate.leaves`,
//!               and for each open box in their order: 4 its number, 8 its bound (double), 1 the axis to halve
//! at the end  32  SHA-256 of all before
//! ```
//!
//! Numbers are the order in which boxes were made, which decides between equal bounds; so a resumed search evaluates
//! the same boxes in the same order as an unbroken one.

use super::job::{Proof, Request};
use super::subject::NoCertificate;
use crate::numbers::bound::search::{MAX_BOXES, MAX_WAITING, OpenBox, Search};
use crate::numbers::leaves::{Nodes, OPEN, next};
use crate::record::Record;
use sha2::{Digest, Sha256};

/// The largest file that is read: four searches with as many open boxes and nodes as each may have.
pub const MAX_BYTES: u64 = 4 * (MAX_WAITING as u64 * OPEN_BYTES as u64 + MAX_BOXES as u64 / 2) + (1 << 20);
const MAGIC: &[u8; 8] = b"lwproof\0";
const VERSION: u32 = 1;
const PROGRAM: &str = env!("CARGO_PKG_VERSION");
const SUM: usize = 32;
/// Bytes of an open box.
const OPEN_BYTES: usize = 13;

/// The reason for which a search does not resume from a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResumeError {
    /// The file does not begin as a checkpoint does.
    #[error("this is no search for a certificate that was stopped; {REMEDY}")]
    Foreign,
    /// Another version wrote it.
    #[error(
        "this was written by version {by}, this is {us}: the search may have changed between them; {REMEDY}"
    )]
    OtherVersion {
        /// The version that wrote it.
        by: String,
        /// The version of this program.
        us: String,
    },
    /// Its checksum is wrong, or it does not hold a search.
    #[error("this was changed or cut off after it was written; {REMEDY}")]
    Changed,
    /// It is of another record or gap.
    #[error("this is of another result or another gap: give the --gap that it was begun with, or {REMEDY}")]
    Other,
    /// The record has no certificate.
    #[error(transparent)]
    NoCertificate(#[from] NoCertificate),
}

/// The advice for a file that cannot be resumed.
pub const REMEDY: &str = "run certify without --resume to begin anew";

impl Proof {
    /// Returns the checkpoint of the search, as the bytes of a file.
    pub fn checkpoint(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.push(PROGRAM.len() as u8);
        bytes.extend(PROGRAM.as_bytes());
        bytes.extend(self.subject.sha256());
        bytes.extend((self.searches.len() as u32).to_le_bytes());
        for (_, _, search) in &self.searches {
            let (nodes, open) = search.state();
            bytes.extend(search.decided().to_le_bytes());
            bytes.extend(nodes.len().to_le_bytes());
            bytes.extend(nodes.bytes());
            for OpenBox { number, sum_sq, axis } in open {
                bytes.extend(number.to_le_bytes());
                bytes.extend(sum_sq.to_le_bytes());
                bytes.push(axis);
            }
        }
        let sum: [u8; SUM] = Sha256::digest(&bytes).into();
        bytes.extend(sum);
        bytes
    }

    /// Restores the search for the same record and request that left these bytes.
    ///
    /// # Errors
    /// [`ResumeError`]: nothing is taken over.
    pub fn resume(record: &Record, request: &Request, bytes: &[u8]) -> Result<Self, ResumeError> {
        let mut proof = Proof::new(record, request)?;
        let mut rest = bytes.strip_prefix(MAGIC).ok_or(ResumeError::Foreign)?;
        let version = u32::from_le_bytes(take(&mut rest)?);
        let [length] = take::<1>(&mut rest)?;
        let program = rest.split_off(..length.into()).ok_or(ResumeError::Changed)?;
        if version != VERSION || program != PROGRAM.as_bytes() {
            let by = format!("{} (format {version})", String::from_utf8_lossy(program).escape_debug());
            return Err(ResumeError::OtherVersion { by, us: format!("{PROGRAM} (format {VERSION})") });
        }
        let body = bytes.len().checked_sub(SUM).ok_or(ResumeError::Changed)?;
        let (body, sum) = bytes.split_at(body);
        if <[u8; SUM]>::from(Sha256::digest(body)) != sum {
            return Err(ResumeError::Changed);
        }
        if take::<SUM>(&mut rest)? != proof.subject.sha256() {
            return Err(ResumeError::Other);
        }
        if u32::from_le_bytes(take(&mut rest)?) as usize != proof.searches.len() {
            return Err(ResumeError::Changed);
        }
        for (_, _, search) in &mut proof.searches {
            let decided = f64::from_le_bytes(take(&mut rest)?);
            let count = u64::from_le_bytes(take(&mut rest)?);
            let length = usize::try_from(count.div_ceil(2)).map_err(|_| ResumeError::Changed)?;
            let own = rest.split_off(..length).ok_or(ResumeError::Changed)?;
            let nodes = Nodes::from_bytes(own, count).ok_or(ResumeError::Changed)?;
            let waiting = nodes.codes().filter(|code| *code == OPEN).count();
            let length = waiting.checked_mul(OPEN_BYTES).ok_or(ResumeError::Changed)?;
            let mut own = rest.split_off(..length).ok_or(ResumeError::Changed)?;
            let mut open = Vec::with_capacity(waiting);
            while !own.is_empty() {
                let number = u32::from_le_bytes(take(&mut own)?);
                let sum_sq = f64::from_le_bytes(take(&mut own)?);
                let [axis] = take(&mut own)?;
                open.push(OpenBox { number, sum_sq, axis });
            }
            *search = Search::restored(search, &nodes, &open, decided).ok_or(ResumeError::Changed)?;
        }
        if rest.len() == SUM { Ok(proof) } else { Err(ResumeError::Changed) }
    }
}

fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], ResumeError> {
    next(rest).ok_or(ResumeError::Changed)
}
