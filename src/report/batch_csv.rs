//! A batch as a table for spreadsheets and scripts: one row for each file. It contains no time, so that the same batch
//! gives the same bytes.

use super::csv::{Column, cells, names, written};
use super::table::{BatchOutcome, BatchRow};
use super::text::{cell, exact};
use super::words;
use crate::record::{ErrorRecord, Record};

fn columns<'a>() -> [Column<BatchRow<'a>>; 12] {
    [
        ("problem", |row| cell(row.name)),
        ("status", status),
        ("points", |row| ran(row, |r| r.problem.resolved.task.path.points.len().to_string())),
        ("candidates", |row| ran(row, |r| r.candidates.len().to_string())),
        ("accepted", |row| ran(row, |r| accepted(r).to_string())),
        ("sum_sq", |row| best(row, |e| e.sum_sq)),
        ("rms", |row| best(row, |e| e.rms)),
        ("max", |row| best(row, |e| e.max)),
        ("rms_over_size", |row| best(row, |e| e.rms_over_size)),
        ("reason", |row| ran(row, |r| words::reason_name(r.termination.reason).to_owned())),
        ("evaluations", |row| ran(row, |r| r.evaluations.objective.to_string())),
        ("message", |row| match row.outcome {
            BatchOutcome::Ran(_) => String::new(),
            BatchOutcome::Refused(why) => cell(why),
        }),
    ]
}

/// Returns one row for each file: `accepted`, `nothing-acceptable` or `refused`, the figures of the best candidate, the
/// reason why the search ended, and the reason why a file was refused.
pub fn batch_csv(files: &[BatchRow<'_>]) -> String {
    let columns = columns();
    written(names(&columns), files.iter().map(|file| cells(&columns, file)))
}

fn accepted(record: &Record) -> usize {
    record.candidates.iter().filter(|c| c.accepted).count()
}

fn status(row: &BatchRow<'_>) -> String {
    let status = match row.outcome {
        BatchOutcome::Ran(record) if accepted(record) > 0 => "accepted",
        BatchOutcome::Ran(_) => "nothing-acceptable",
        BatchOutcome::Refused(_) => "refused",
    };
    status.to_owned()
}

/// Returns a cell of a file that was run; empty for a refused one.
fn ran(row: &BatchRow<'_>, of: fn(&Record) -> String) -> String {
    match row.outcome {
        BatchOutcome::Ran(record) => of(record),
        BatchOutcome::Refused(_) => String::new(),
    }
}

/// Returns a figure of the best candidate; empty without one.
fn best(row: &BatchRow<'_>, of: fn(&ErrorRecord) -> f64) -> String {
    match row.outcome {
        BatchOutcome::Ran(record) => record.candidates.first().map_or(String::new(), |c| exact(of(&c.error))),
        BatchOutcome::Refused(_) => String::new(),
    }
}
