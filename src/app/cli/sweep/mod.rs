//! `sweep`: many problems that are one problem with different values of some keys.

pub mod arguments;

use super::inputs::RESULTS;
use super::progress::Shown;
use super::{Ended, interrupt, refuse, refuse_at, terminal};
use crate::app::sweep::{How, PlanOptions, SweepError, merge, plan, run_missing, run_shard};
use crate::files::diagnostic::escaped;
use crate::files::sweep_file;
use crate::report::text::grouped;
use arguments::{Sweep, SweepMerge, SweepPlan, SweepRun};
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(part: &Sweep) -> Result<Ended, Ended> {
    match part {
        Sweep::Plan(options) => planned(options),
        Sweep::Run(options) => ran(options),
        Sweep::Merge(options) => merged(options),
    }
}

/// Reports an error of a sweep.
fn refused(why: SweepError) -> Ended {
    match why {
        SweepError::File(diagnostic) => refuse_at(diagnostic),
        SweepError::Cancelled => Ended::Interrupted,
        why => refuse(why),
    }
}

fn planned(options: &SweepPlan) -> Result<Ended, Ended> {
    let folder = match &options.out {
        Some(folder) => folder.clone(),
        None => {
            let file = sweep_file::load(&options.sweep).map_err(refuse_at)?;
            PathBuf::from(RESULTS).join(file.name)
        }
    };
    let cancel = interrupt::watch("nothing is planned");
    let how = How { threads: options.threads.map(usize::from), cancel, observer: &|_, _| {} };
    let wanted =
        PlanOptions { shard_size: options.shard_size, records: options.records, replace: options.force };
    let plan = plan(&options.sweep, &folder, wanted, &how).map_err(refused)?;
    let shown = quoted(&folder);
    let keys: Vec<String> = plan
        .vary
        .iter()
        .map(|varied| format!("{} ({})", varied.key, grouped(varied.values.count())))
        .collect();
    terminal::answer(&format!(
        "{}: {} in {} of {}, over {}\n  Written to {shown}. Next: linkwright sweep run {shown}\n",
        plan.name,
        counted(plan.jobs, "job"),
        counted(plan.shards, "shard"),
        grouped(plan.shard_size),
        escaped(&keys.join(", ")),
    ));
    Ok(Ended::Good)
}

fn ran(options: &SweepRun) -> Result<Ended, Ended> {
    let shown = Shown::of_batch(options.quiet);
    let cancel = interrupt::watch("complete shards are kept");
    let how = How {
        threads: options.threads.map(usize::from),
        cancel,
        observer: &|_, total| shown.one_more(total),
    };
    let folder = quoted(&options.folder);
    if let Some(shard) = options.shard {
        let done = run_shard(&options.folder, shard, &how);
        shown.finish();
        let done = done.map_err(refused)?;
        let before = if done.before { " (it was there)" } else { "" };
        terminal::answer(&format!(
            "shard {shard}: {}, {} with something acceptable, sha256 {}{before}\n",
            counted(done.rows, "row"),
            grouped(done.accepted),
            done.sha256
        ));
        return Ok(if done.bugs > 0 { Ended::Bug } else { Ended::Good });
    }
    let ran = run_missing(&options.folder, &how);
    shown.finish();
    let ran = ran.map_err(refused)?;
    let before = match ran.before {
        0 => String::new(),
        before => format!(" ({} there before)", grouped(before)),
    };
    let shards = counted(ran.done.len() as u64, "shard");
    let rows = counted(ran.rows, "row");
    if ran.cancelled {
        terminal::tell(&format!("{shards} run{before}, {rows}; linkwright sweep run {folder} goes on"));
        return Err(Ended::Interrupted);
    }
    terminal::answer(&format!(
        "{shards} run{before}: {rows}, {} with something acceptable\n  Next: linkwright sweep merge {folder}\n",
        grouped(ran.accepted)
    ));
    Ok(if ran.bugs > 0 { Ended::Bug } else { Ended::Good })
}

fn merged(options: &SweepMerge) -> Result<Ended, Ended> {
    let merged = merge(&options.folder).map_err(refused)?;
    let refused = match merged.refused {
        0 => String::new(),
        refused => format!(", {} refused as their values contradict each other", grouped(refused)),
    };
    terminal::answer(&format!(
        "{}: {} with something acceptable{refused}\n  Written to {folder}: sweep.csv, sweep.jsonl, sweep.svg, sweep.html\n",
        counted(merged.rows, "row"),
        grouped(merged.accepted),
        folder = terminal::shown(&options.folder),
    ));
    Ok(match merged {
        merged if merged.bugs > 0 => Ended::Bug,
        merged if merged.accepted > 0 => Ended::Good,
        _ => Ended::Bad,
    })
}

/// Returns a number with its noun: `1,000 jobs`.
fn counted(count: u64, what: &str) -> String {
    format!("{} {what}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// Returns a path as it is typed in a shell.
fn quoted(path: &Path) -> String {
    let shown = terminal::shown(path);
    if shown.contains(' ') { format!("\"{shown}\"") } else { shown }
}
