//! Sweeps: plan, run, merge.

use crate::errors::{guarded, refused};
use crate::waiting::{Ended, Talk, run, run_whole};
use crate::{pools, values};
use linkwright::internals::app::sweep::shard::SHARDS;
use linkwright::internals::app::sweep::{self, How, PlanOptions, Ran, SweepError};
use pyo3::prelude::*;
use serde_json::json;
use std::collections::HashSet;
use std::ffi::OsString;
use std::path::PathBuf;

/// The outcome of work that may have been cancelled.
type Outcome<T> = Result<T, SweepError>;

/// Calls a part of a sweep with what it is told by its caller.
fn with<T>(talk: &Talk, part: impl FnOnce(&How<'_>) -> T) -> T {
    let observer =
        |done: u64, total: u64| talk.tell(|| json!({ "phase": "jobs", "done": done, "total": total }));
    part(&How { threads: None, cancel: &talk.cancel, observer: &observer })
}

/// Returns the value of work, or the interrupt that ended it.
fn whole<T>(ended: Ended<Outcome<T>>) -> PyResult<T> {
    match ended {
        Ended { interrupt: Some(interrupt), .. } => Err(interrupt),
        Ended { value, .. } => value.map_err(refused),
    }
}

/// Plans a sweep into a folder.
#[pyfunction]
pub fn sweep_plan(
    py: Python<'_>,
    sweep: PathBuf,
    out: PathBuf,
    shard_size: Option<u64>,
    records: bool,
    force: bool,
) -> PyResult<()> {
    guarded(|| {
        let options = PlanOptions { shard_size, records, replace: force };
        let ended = run(py, pools::threads(None)?, None, move |talk| {
            with(talk, |how| sweep::plan(&sweep, &out, options, how))
        })?;
        whole(ended).map(drop)
    })
}

/// Returns the plan in a folder, without the texts of its files.
#[pyfunction]
pub fn sweep_open(py: Python<'_>, folder: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    guarded(|| {
        let plan = sweep::open(&folder).map_err(refused)?;
        let mut keys = serde_json::to_value(&plan).map_err(refused)?;
        if let Some(keys) = keys.as_object_mut() {
            keys.remove("problem");
            keys.remove("beside");
        }
        values::to_python(py, &keys)
    })
}

/// Returns the numbers of the shards whose files are not in the folder.
#[pyfunction]
pub fn sweep_missing(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<u64>> {
    guarded(|| {
        let plan = sweep::open(&folder).map_err(refused)?;
        py.detach(|| {
            let shards = folder.join(SHARDS);
            // One look at the folder: asking for each file is slow where it is shared.
            let names: HashSet<OsString> = match std::fs::read_dir(&shards) {
                Ok(entries) => entries.filter_map(|entry| Some(entry.ok()?.file_name())).collect(),
                Err(_) => HashSet::new(),
            };
            let there = |shard: &u64| names.contains(&OsString::from(format!("{shard}.jsonl")));
            Ok((0..plan.shards).filter(|shard| !there(shard)).collect())
        })
    })
}

/// Runs a shard, or all that are missing: the rows, those accepted, those with a bug, the shards run and those there
/// before.
#[pyfunction]
#[pyo3(signature = (folder, shard, threads, progress))]
pub fn sweep_run(
    py: Python<'_>,
    folder: PathBuf,
    shard: Option<u64>,
    threads: Option<i64>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(u64, u64, u64, u64, u64)> {
    guarded(|| {
        let threads = pools::threads(threads)?;
        let ended = run(py, threads, progress, move |talk| {
            with(talk, |how| -> Outcome<_> {
                let how = How { threads: Some(threads), ..*how };
                match shard {
                    Some(shard) => {
                        let done = sweep::run_shard(&folder, shard, &how)?;
                        let before = u64::from(done.before);
                        Ok((done.rows, done.accepted, done.bugs, 1 - before, before))
                    }
                    None => {
                        let Ran { before, done, rows, accepted, bugs, .. } =
                            sweep::run_missing(&folder, &how)?;
                        Ok((rows, accepted, bugs, done.len() as u64, before))
                    }
                }
            })
        })?;
        whole(ended)
    })
}

/// Merges the shards: the number of rows and of those accepted.
#[pyfunction]
pub fn sweep_merge(py: Python<'_>, folder: PathBuf) -> PyResult<(u64, u64)> {
    guarded(|| {
        let merged = run_whole(py, move |_| sweep::merge(&folder))?.map_err(refused)?;
        Ok((merged.rows, merged.accepted))
    })
}
