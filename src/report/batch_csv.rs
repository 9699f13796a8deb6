//! A batch as a table for spreadsheets and scripts: one row for each file. It contains no time, so that the same batch
//! gives the same bytes.

use super::csv::{Column, cells, names, written};
use super::table::BatchRow;
use super::text::{cell, exact};
use super::words;
use crate::record::{ErrorRecord, Record};

fn columns<'a>() -> [Column<BatchRow<'a>>; 12] {
    [
        ("problem", |row| cell(row.name)),
        ("status", |row| status(row).to_owned()),
        ("points", |row| ran(row, |r| r.problem.resolved.task.len().to_string())),
        ("candidates", |row| ran(row, |r| r.candidates.len().to_string())),
        ("accepted", |row| row.outcome.map_or(String::new(), |_| row.accepted().to_string())),
        ("sum_sq", |row| best(row, |e| e.sum_sq)),
        ("rms", |row| best(row, |e| e.rms)),
        ("max", |row| best(row, |e| e.max)),
        ("rms_over_size", |row| best(row, |e| e.rms_over_size)),
        ("reason", |row| ran(row, |r| words::reason_name(r.termination.reason).to_owned())),
        ("evaluations", |row| ran(row, |r| r.evaluations.objective.to_string())),
        ("message", |row| row.outcome.err().map_or(String::new(), cell)),
    ]
}

/// Returns one row for each file: `accepted`, `nothing-acceptable` or `refused`, the figures of the best candidate, the
/// reason why the search ended, and the reason why a file was refused.
pub fn batch_csv(files: &[BatchRow<'_>]) -> String {
    let columns = columns();
    written(names(&columns), files.iter().map(|file| cells(&columns, file)))
}

fn status(row: &BatchRow<'_>) -> &'static str {
    match row.outcome {
        Ok(_) if row.accepted() > 0 => "accepted",
        Ok(_) => "nothing-acceptable",
        Err(_) => "refused",
    }
}

/// Returns a cell of a file that was run; empty for a refused one.
fn ran(row: &BatchRow<'_>, of: fn(&Record) -> String) -> String {
    row.outcome.map_or(String::new(), of)
}

/// Returns a figure of the best candidate; empty without one.
fn best(row: &BatchRow<'_>, of: fn(&ErrorRecord) -> f64) -> String {
    row.best().map_or(String::new(), |error| exact(of(error)))
}
