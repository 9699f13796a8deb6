//! Merging: the shards as one table, read as a stream.

use super::error::SweepError;
use super::plan::{MERGED, open};
use super::shard::{Reader, remove_abandoned};
use crate::app::job::folder::Replacement;
use crate::record::sweep::{Plan, Row, Status};
use crate::report::sweep::page::sweep_html;
use crate::report::sweep::plot::plot_svg;
use crate::report::sweep::summary::Summary;
use crate::report::sweep::table::{head, line_of};
use serde::de::IgnoredAny;
use std::fs;
use std::path::Path;

/// The most missing shards that are named.
const NAMED: usize = 5;

/// The outcome of a merge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    /// The number of rows: one for each job.
    pub rows: u64,
    /// How many have an accepted candidate.
    pub accepted: u64,
    /// How many have a job whose values contradict each other.
    pub refused: u64,
    /// How many met a bug of linkwright.
    pub bugs: u64,
}

/// Merges the shards of a folder into `sweep.csv` and `sweep.jsonl`, a row for each job by number, with a plot and a page
/// (`sweep.svg`, `sweep.html`). Half-written files that killed processes left a day ago or earlier are removed.
///
/// # Errors
/// [`SweepError::Missing`] if shards are missing; [`SweepError::OtherPlan`] and [`SweepError::Damaged`] name a shard that
/// cannot be used; [`SweepError::Folder`].
pub fn merge(folder: &Path) -> Result<Merged, SweepError> {
    let plan = open(folder)?;
    refuse_missing(folder, &plan)?;
    let [csv, jsonl, svg, html] = MERGED.map(|name| folder.join(name));
    let (mut csv, mut jsonl) = (Replacement::begin(&csv)?, Replacement::begin(&jsonl)?);
    csv.write(head(&plan).as_bytes())?;
    let mut summary = Summary::of(&plan);
    let mut line = String::new();
    for shard in 0..plan.shards {
        // Shards were all there a moment ago.
        let Some(mut reader) = Reader::open(folder, &plan, shard)? else {
            return Err(missing(folder, &plan, vec![shard], 1));
        };
        while reader.next(&mut line)? {
            let row: Row<IgnoredAny> = serde_json::from_str(&line).map_err(|_| reader.no_row())?;
            if row.job != summary.rows {
                return Err(reader.no_row());
            }
            summary.take(&plan, &row);
            csv.write(line_of(&plan, &row).as_bytes())?;
            jsonl.write(line.as_bytes())?;
        }
    }
    csv.finish()?;
    jsonl.finish()?;
    for (path, text) in [(svg, plot_svg(&plan, &summary)), (html, sweep_html(&plan, &summary))] {
        let mut file = Replacement::begin(&path)?;
        file.write(text.as_bytes())?;
        file.finish()?;
    }
    if let Ok(now) = fs::metadata(folder.join(MERGED[0])).and_then(|found| found.modified()) {
        remove_abandoned(folder, now);
    }
    Ok(Merged {
        rows: summary.rows,
        accepted: summary.count(Status::Accepted),
        refused: summary.count(Status::Refused),
        bugs: summary.count(Status::Bug),
    })
}

/// Refuses a folder in which shards are missing.
fn refuse_missing(folder: &Path, plan: &Plan) -> Result<(), SweepError> {
    let missing_here = || (0..plan.shards).filter(|shard| !super::shard::exists(folder, *shard));
    let first: Vec<u64> = missing_here().take(NAMED).collect();
    if first.is_empty() { Ok(()) } else { Err(missing(folder, plan, first, missing_here().count() as u64)) }
}

fn missing(folder: &Path, plan: &Plan, first: Vec<u64>, count: u64) -> SweepError {
    SweepError::Missing { folder: folder.display().to_string(), first, count, shards: plan.shards }
}
