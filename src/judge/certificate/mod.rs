//! Certificates of a record: a certified lower bound of the sum of squares for prescribed timing, searched by
//! [`bound`](crate::numbers::bound) and checked by [`checker`](crate::numbers::checker), which shares with it the file format of the proofs alone.
//! docs/certificate.md has the proofs.

mod axis;
mod check;
pub mod checkpoint;
pub mod job;
pub mod subject;
mod words;

pub use check::{CheckError, Checked, check};
pub use checkpoint::ResumeError;
pub use job::{Progress, Proof, Request, certify, recheck};
pub use subject::{NoCertificate, Subject};
