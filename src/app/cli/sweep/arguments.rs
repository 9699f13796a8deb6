//! Options of `sweep`.

use crate::record::sweep::MAX_JOBS;
use clap::builder::RangedI64ValueParser;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// The parts of `sweep`.
#[derive(Debug, Subcommand)]
pub enum Sweep {
    /// Write the plan of a sweep: the problem, the values, the jobs in shards
    #[command(after_help = "Exit codes: 0 planned, 2 bad input, 130 interrupted.")]
    Plan(SweepPlan),
    /// Run the shards of a plan that are missing; run again after an interruption, it goes on
    #[command(
        after_help = "Exit codes: 0 the shards are complete, 2 bad input, 70 a bug in a job (its row says so), \
                            130 interrupted (complete shards stay)."
    )]
    Run(SweepRun),
    /// Merge the shards into sweep.csv and sweep.jsonl, a row for each job, with a plot and a page
    #[command(
        after_help = "Exit codes: 0 a job found something acceptable, 1 none did, 2 bad input or shards are \
                            missing, 70 a bug in a job."
    )]
    Merge(SweepMerge),
}

/// Options of `sweep plan`.
#[derive(Debug, Args)]
pub struct SweepPlan {
    /// A sweep file (TOML): a problem and the keys of it that vary
    pub sweep: PathBuf,
    /// The folder of the sweep [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Jobs of a shard [default: as many as take about 5 s, judged by running a few]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = RangedI64ValueParser::<u64>::new().range(1..=MAX_JOBS as i64))]
    pub shard_size: Option<u64>,
    /// Keep the whole record of every job in sweep.jsonl, not its row alone
    #[arg(long)]
    pub records: bool,
    /// Threads for the jobs that are run to size the shards [default: all cores]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Replace another plan in the folder, and remove its shards
    #[arg(long)]
    pub force: bool,
}

/// Options of `sweep run`.
#[derive(Debug, Args)]
pub struct SweepRun {
    /// The folder of a planned sweep
    pub folder: PathBuf,
    /// Run this shard alone, counted from 0 [default: all that are missing]
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = RangedI64ValueParser::<u64>::new().range(0..))]
    pub shard: Option<u64>,
    /// Threads [default: all cores]; they change the time, never a digit
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
}

/// Options of `sweep merge`.
#[derive(Debug, Args)]
pub struct SweepMerge {
    /// The folder of a sweep whose shards are complete
    pub folder: PathBuf,
}
