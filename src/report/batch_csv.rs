//! A batch as a table for spreadsheets and scripts: one row for each file. It contains no time, so that the same batch
//! gives the same bytes.

use super::csv::written;
use super::table::{BatchOutcome, BatchRow};
use super::text::{cell, exact};
use super::words;

/// The header row of [`batch_csv`].
pub const BATCH_COLUMNS: [&str; 12] = [
    "problem",
    "status",
    "points",
    "candidates",
    "accepted",
    "sum_sq",
    "rms",
    "max",
    "rms_over_size",
    "reason",
    "evaluations",
    "message",
];

/// Returns one row for each file: `accepted`, `nothing-acceptable` or `refused`, the figures of the best candidate, the
/// reason why the search ended, and the reason why a file was refused.
pub fn batch_csv(files: &[BatchRow<'_>]) -> String {
    written(&BATCH_COLUMNS, files.iter().map(row))
}

fn row(file: &BatchRow<'_>) -> Vec<String> {
    let mut row = vec![cell(file.name)];
    match file.outcome {
        BatchOutcome::Ran(record) => {
            let accepted = record.candidates.iter().filter(|c| c.accepted).count();
            row.push(if accepted > 0 { "accepted" } else { "nothing-acceptable" }.into());
            row.push(record.problem.resolved.task.path.points.len().to_string());
            row.push(record.candidates.len().to_string());
            row.push(accepted.to_string());
            let error = record.candidates.first().map(|c| &c.error);
            let figures = error.map(|e| [e.sum_sq, e.rms, e.max, e.rms_over_size].map(exact));
            row.extend(figures.unwrap_or_default());
            row.push(words::reason_name(record.termination.reason).into());
            row.push(record.evaluations.objective.to_string());
            row.push(String::new());
        }
        BatchOutcome::Refused(why) => {
            row.push("refused".into());
            row.extend(std::iter::repeat_n(String::new(), BATCH_COLUMNS.len() - 3));
            row.push(cell(why));
        }
    }
    row
}
