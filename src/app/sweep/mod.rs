//! Sweeps: a plan of many problems, its shards of jobs, and their merged rows.
//!
//! The folder of a sweep is all that its parts share, so that any engine can run the shards, on any machines, in any
//! order and more than once: the same program writes the same bytes.
//!
//! ```text
//! DIR/plan.json        the plan: problem, files beside it, varied keys, size of a shard
//! DIR/shards/0.jsonl   a line about the shard, then a row for each of its jobs; whole or absent
//! DIR/sweep.csv        the rows of all jobs, by number
//! DIR/sweep.jsonl      the same as lines of JSON
//! DIR/sweep.svg        the outcome over one or two keys, also in DIR/sweep.html with the best jobs
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`error`] | errors of sweeps |
//! | [`job`] | one job: the problem with its values, run, and its row |
//! | [`mod@merge`] | merging: the shards as one table, read as a stream |
//! | [`mod@plan`] | planning: from a sweep file to `plan.json`, and the size of a shard |
//! | [`run`] | running: the jobs of one shard or of all that are missing, on all cores |
//! | [`shard`] | the file of a shard, written whole or not at all, and checked when it is read |

pub mod error;
pub mod job;
pub mod merge;
pub mod plan;
pub mod run;
pub mod shard;

pub use error::SweepError;
pub use merge::{Merged, merge};
pub use plan::{PlanOptions, open, plan};
pub use run::{How, Ran, run_missing, run_shard};
pub use shard::ShardDone;
