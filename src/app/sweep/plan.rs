//! Planning: from a sweep file to `plan.json`, and the size of a shard.
//!
//! Without a size that is asked for, shards of about 5 s are made: a few jobs, spread over the sweep, are run, and the
//! positions of a linkage that they computed are counted. A nominal time for each position makes seconds of the count.
//! No clock is read, so that the same sweep gives the same plan, on a slow machine or a busy one; there shards take
//! longer.

use super::error::SweepError;
use super::job::Jobs;
use super::run::{How, sample};
use super::shard::{SHARDS, io};
use crate::app::job::folder::{FolderError, Replacement, is_temporary};
use crate::files::diagnostic::Diagnostic;
use crate::files::sweep_file;
use crate::files::sweep_file::SweepFile;
use crate::record::Tool;
use crate::record::digest::NotWritten;
use crate::record::sweep::{FORMAT, Plan};
use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The name of the file with the plan.
pub const PLAN: &str = "plan.json";
/// The names of the files that merging writes.
pub const MERGED: [&str; 4] = ["sweep.csv", "sweep.jsonl", "sweep.svg", "sweep.html"];
/// The largest plan that is read, in bytes.
const MAX_PLAN_BYTES: u64 = 256 << 20;

/// The nominal time of a shard whose size is not asked for, seconds.
const SHARD_S: f64 = 5.0;
/// The nominal time of a search for each position of a linkage that it computes, with all that comes with it, seconds: ten
/// problems took 120 to 970 ns (2026, two cores of a cloud machine), their median 400 ns.
const POSITION_S: f64 = 400e-9;
/// The nominal time of a job beside its search, seconds.
const JOB_S: f64 = 5e-3;
/// The nominal time of exact synthesis, which computes no positions, seconds.
const CONTINUATION_S: f64 = 0.6;
/// The most jobs that are run for the size of a shard.
const SAMPLES: u64 = 8;
/// The most jobs whose values are tried before a sweep is refused because none can be run.
const TRIED: u64 = 100;
/// The largest size of a shard that is not asked for.
const LARGEST: u64 = 10_000;

/// Options of a plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanOptions {
    /// The number of jobs of a shard; by default as many as take about 5 s.
    pub shard_size: Option<u64>,
    /// Whether rows hold the whole record of their job.
    pub records: bool,
    /// Whether another plan in the folder is replaced, and its shards and merged files are removed.
    pub replace: bool,
}

/// Plans the sweep of a file in a folder and returns its plan. A plan that is there already and equal is kept, with its
/// shards.
///
/// # Errors
/// [`SweepError::File`] if the sweep or its problem is invalid or no job can be run; [`SweepError::Planned`] if the folder
/// has shards of another plan; [`SweepError::Folder`]; [`SweepError::Cancelled`].
pub fn plan(sweep: &Path, folder: &Path, options: PlanOptions, how: &How<'_>) -> Result<Plan, SweepError> {
    let file = sweep_file::load(sweep)?;
    // A place that is taken is reported before the work.
    check_folder(folder)?;
    let shown = sweep.display().to_string();
    let text = file.text.clone();
    let mut plan = unsized_plan(file, options.records);
    if let Some(why) = refusal_of_all(&plan) {
        let message = format!("no job of this sweep can be run: {why}");
        let help = "make the problem right, or vary other keys or values";
        return Err(Box::new(Diagnostic::new(shown, text, message).with_help(help)).into());
    }
    let size = match options.shard_size {
        Some(size) => size,
        None => size_of(&plan, how)?,
    };
    plan.shard_size = size.clamp(1, plan.jobs.max(1));
    plan.shards = plan.jobs.div_ceil(plan.shard_size);
    let plan = plan.sealed()?;
    put(&plan, folder, options.replace)?;
    Ok(plan)
}

/// Returns the plan of a sweep with shards of one job, without its digest.
fn unsized_plan(file: SweepFile, records: bool) -> Plan {
    Plan {
        format: FORMAT,
        tool: Tool::this(),
        digest: String::new(),
        name: file.name,
        jobs: file.jobs,
        shard_size: 1,
        shards: file.jobs,
        records,
        vary: file.vary,
        problem: file.template.problem,
        beside: file.template.beside,
    }
}

/// Returns at most `count` numbers of jobs, spread evenly over a sweep, the first and the last among them.
fn spread(jobs: u64, count: u64) -> Vec<u64> {
    let count = count.min(jobs);
    let last = jobs.saturating_sub(1);
    let mut numbers: Vec<u64> = (0..count)
        .map(
            |i| if count < 2 { 0 } else { (u128::from(last) * u128::from(i) / u128::from(count - 1)) as u64 },
        )
        .collect();
    numbers.dedup();
    numbers
}

/// Returns the reason why the first job is refused if all that are tried are.
fn refusal_of_all(plan: &Plan) -> Option<String> {
    let jobs = Jobs::of(plan);
    let mut first = None;
    for number in spread(plan.jobs, TRIED) {
        let why = jobs.refusal(number)?;
        first.get_or_insert(why);
    }
    first
}

/// Returns the number of jobs that take about [`SHARD_S`] one after the other: 1, 2 or 5 times a power of ten.
fn size_of(plan: &Plan, how: &How<'_>) -> Result<u64, SweepError> {
    let numbers = spread(plan.jobs, SAMPLES);
    let costs = sample(plan, &numbers, how)?;
    let seconds: f64 = costs.iter().map(|cost| JOB_S + cost_s(*cost)).sum();
    Ok(rounded_down(SHARD_S * numbers.len() as f64 / seconds))
}

/// Returns the nominal time of a search, seconds; `None` stands for a job that was not run.
fn cost_s(cost: Option<u64>) -> f64 {
    match cost {
        None => 0.0,
        Some(0) => CONTINUATION_S,
        Some(positions) => POSITION_S * positions as f64,
    }
}

/// Returns the largest of 1, 2, 5, 10, .. that is not above a number, at most [`LARGEST`].
fn rounded_down(number: f64) -> u64 {
    let mut size = 1;
    for next in [2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, LARGEST] {
        if next as f64 <= number {
            size = next;
        }
    }
    size
}

/// Refuses a folder that holds something else than a sweep.
fn check_folder(folder: &Path) -> Result<(), SweepError> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(()),
        Err(e) if e.kind() == ErrorKind::NotADirectory => {
            return Err(FolderError::NotAFolder(folder.display().to_string()).into());
        }
        Err(e) => return Err(io(folder, e)),
    };
    for entry in entries {
        let name = entry.map_err(|e| io(folder, e))?.file_name().to_string_lossy().into_owned();
        let ours = name == PLAN || name == SHARDS || MERGED.contains(&name.as_str()) || is_temporary(&name);
        if !ours {
            let path = folder.display().to_string();
            return Err(FolderError::NotASweep { path, foreign: name }.into());
        }
    }
    Ok(())
}

/// Returns whether a file of the folder of shards is a shard.
fn is_shard(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "jsonl")
}

/// Writes a plan into its folder.
fn put(plan: &Plan, folder: &Path, replace: bool) -> Result<(), SweepError> {
    let path = folder.join(PLAN);
    let shards = folder.join(SHARDS);
    let there = if path.exists() { read(&path).ok() } else { None };
    if there.is_some_and(|there| there.digest == plan.digest) {
        fs::create_dir_all(&shards).map_err(|e| io(&shards, e))?;
        return Ok(());
    }
    fs::create_dir_all(&shards).map_err(|e| io(&shards, e))?;
    let entries = fs::read_dir(&shards).map_err(|e| io(&shards, e))?;
    let files: Vec<PathBuf> =
        entries.map(|entry| Ok(entry?.path())).collect::<Result<_, _>>().map_err(|e| io(&shards, e))?;
    if !replace && files.iter().any(|file| is_shard(file)) {
        return Err(SweepError::Planned(folder.display().to_string()));
    }
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let old = files.iter().filter(|file| is_shard(file) || is_temporary(&name(file))).cloned();
    let merged = MERGED.iter().map(|name| folder.join(name)).filter(|path| path.exists());
    for stale in old.chain(merged) {
        fs::remove_file(&stale).map_err(|e| io(&stale, e))?;
    }
    let mut text = serde_json::to_string_pretty(plan).map_err(NotWritten::from)?;
    text.push('\n');
    let mut file = Replacement::begin(&path)?;
    file.write(text.as_bytes())?;
    Ok(file.finish()?)
}

/// Reads the plan of a folder.
///
/// # Errors
/// [`SweepError`] if there is none, if it was changed by hand or if another version of the program made it.
pub fn open(folder: &Path) -> Result<Plan, SweepError> {
    let path = folder.join(PLAN);
    if !path.exists() {
        return Err(SweepError::NoPlan(folder.display().to_string()));
    }
    read(&path)
}

fn read(path: &Path) -> Result<Plan, SweepError> {
    let shown = path.display().to_string();
    let not_a_plan = |message: String| SweepError::NotAPlan { path: shown.clone(), message };
    let file = fs::File::open(path).map_err(|e| io(path, e))?;
    let mut text = String::new();
    match file.take(MAX_PLAN_BYTES + 1).read_to_string(&mut text) {
        Ok(_) if text.len() as u64 > MAX_PLAN_BYTES => return Err(not_a_plan("it is too large".into())),
        Ok(_) => {}
        Err(e) if e.kind() == ErrorKind::InvalidData => return Err(not_a_plan("it is not text".into())),
        Err(e) => return Err(io(path, e)),
    }
    let plan: Plan = serde_json::from_str(&text).map_err(|e| not_a_plan(e.to_string()))?;
    if plan.format != FORMAT {
        return Err(not_a_plan(format!("it has format {}, and this program reads {FORMAT}", plan.format)));
    }
    if plan.tool != Tool::this() {
        return Err(SweepError::OtherVersion { path: shown, version: plan.tool.version });
    }
    if plan.clone().sealed()?.digest != plan.digest {
        return Err(SweepError::Changed(shown));
    }
    let consistent = Plan::product(&plan.vary) == Some(plan.jobs)
        && plan.shard_size > 0
        && plan.shards == plan.jobs.div_ceil(plan.shard_size)
        && plan.shards > 0;
    if consistent { Ok(plan) } else { Err(not_a_plan("its numbers of jobs and shards do not agree".into())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_round_numbers() {
        let sizes = [0.2, 1.0, 1.9, 2.0, 7.0, 49.0, 50.0, 1e9].map(rounded_down);
        assert_eq!(sizes, [1, 1, 1, 2, 5, 20, 50, LARGEST]);
    }

    #[test]
    fn samples_are_spread_from_the_first_job_to_the_last() {
        assert_eq!(spread(1, 8), [0]);
        assert_eq!(spread(3, 8), [0, 1, 2]);
        assert_eq!(spread(100, 4), [0, 33, 66, 99]);
        assert_eq!(spread(crate::record::sweep::MAX_JOBS, 2), [0, crate::record::sweep::MAX_JOBS - 1]);
    }
}
