//! Errors of sweeps.

use crate::app::job::folder::FolderError;
use crate::files::diagnostic::Diagnostic;
use crate::record::digest::NotWritten;
use crate::report::text::grouped;

/// The reason why a part of a sweep cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The sweep file or its problem is invalid.
    #[error("{0}")]
    File(Box<Diagnostic>),
    /// A folder or a file cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The plan cannot be written as data.
    #[error(transparent)]
    NotWritten(#[from] NotWritten),
    /// No thread can be started.
    #[error("no threads to search with: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The work was cancelled.
    #[error("the sweep was interrupted")]
    Cancelled,
    /// The folder holds no plan.
    #[error("{0} holds no plan of a sweep; `linkwright sweep plan SWEEP.toml --out {0}` writes one")]
    NoPlan(String),
    /// The file is not a plan.
    #[error("{path}: this is not the plan of a sweep: {message}; plan the sweep again")]
    NotAPlan {
        /// The path of the file.
        path: String,
        /// The fault.
        message: String,
    },
    /// The plan was changed after it was written.
    #[error("{0} was changed by hand: its digest is not that of its contents; plan the sweep again")]
    Changed(String),
    /// The plan is of another version of the program, whose rows may differ.
    #[error("{path} was made by linkwright {version}, and this is linkwright {}; run it with that version, or plan the sweep again", env!("CARGO_PKG_VERSION"))]
    OtherVersion {
        /// The path of the plan.
        path: String,
        /// The version that made it.
        version: String,
    },
    /// The folder holds another plan, some of whose shards have been run.
    #[error(
        "{0} holds another plan, and shards of it; give another folder with --out, or --force to remove them"
    )]
    Planned(String),
    /// A shard of this number does not exist.
    #[error("there is no shard {shard}: this sweep has shards 0 to {}", shards - 1)]
    NoShard {
        /// The number asked for.
        shard: u64,
        /// The number of shards.
        shards: u64,
    },
    /// A shard belongs to another plan.
    #[error("{0} is a shard of another plan; remove it, or plan the sweep in another folder")]
    OtherPlan(String),
    /// A shard is damaged.
    #[error("{path} is damaged: {how}; `linkwright sweep run` makes it again")]
    Damaged {
        /// The path of the shard.
        path: String,
        /// The fault.
        how: &'static str,
    },
    /// Shards are missing.
    #[error("{} of {} shards are missing ({}); `linkwright sweep run {folder}` runs them", grouped(*count), grouped(*shards), listed(first, *count))]
    Missing {
        /// The folder of the sweep.
        folder: String,
        /// The first missing shards.
        first: Vec<u64>,
        /// The number of missing shards.
        count: u64,
        /// The number of shards.
        shards: u64,
    },
}

impl From<Box<Diagnostic>> for SweepError {
    fn from(diagnostic: Box<Diagnostic>) -> Self {
        SweepError::File(diagnostic)
    }
}

/// Returns the first missing shards in words.
fn listed(first: &[u64], count: u64) -> String {
    let more = if count > first.len() as u64 { ", .." } else { "" };
    first.iter().map(u64::to_string).collect::<Vec<_>>().join(", ") + more
}
