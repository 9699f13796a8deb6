//! The rows of a sweep as a table for spreadsheets and scripts, line by line: a sweep may have more rows than fit into the
//! memory.

use crate::files::sweep_file::typed;
use crate::record::sweep::{Best, Plan, Row};
use crate::report::csv::{Column, OF_SLIDERS, PARAMETERS, Parameter, names, parameters, written_row};
use crate::report::text::{cell, exact};
use crate::report::words;
use serde_json::Value;

/// The figures of the first candidate.
const FIGURES: [Column<Best>; 11] = [
    ("sum_sq", |b| exact(b.error.sum_sq)),
    ("rms", |b| exact(b.error.rms)),
    ("max", |b| exact(b.error.max)),
    ("max_at", |b| b.error.max_at.to_string()),
    ("rms_over_size", |b| exact(b.error.rms_over_size)),
    ("objective", |b| exact(b.error.objective)),
    ("type", |b| b.type_name().to_owned()),
    ("transmission_worst_deg", |b| exact(b.transmission_worst_deg)),
    ("link_ratio", |b| exact(b.link_ratio)),
    ("extent", |b| exact(b.extent)),
    ("longest", |b| exact(b.longest)),
];

/// Returns the header row: `job`, the varied keys, the outcome, the figures and parameters of the first candidate.
pub fn head(plan: &Plan) -> String {
    let mut cells = vec!["job".to_owned()];
    cells.extend(plan.vary.iter().map(|varied| cell(&varied.key)));
    let of_linkage = parameters_in(plan);
    let outcome = ["status", "termination", "candidates", "accepted", "evaluations"];
    let rest = outcome.into_iter().chain(names(&FIGURES)).chain(names(&of_linkage)).chain(["message"]);
    cells.extend(rest.map(str::to_owned));
    written_row(&cells)
}

/// Returns the parameters in a sweep's table: those of sliders too where its problem names such a mechanism.
fn parameters_in(plan: &Plan) -> Vec<Parameter> {
    let of_sliders = plan.problem.text.contains("slider-crank");
    PARAMETERS.into_iter().chain(OF_SLIDERS.into_iter().filter(|_| of_sliders)).collect()
}

/// Returns the line of a row; cells of what a job has not are empty.
pub fn line_of<R>(plan: &Plan, row: &Row<R>) -> String {
    let mut cells = vec![row.job.to_string()];
    cells.extend(plan.vary.iter().map(|varied| row.values.get(&varied.key).map_or(String::new(), value)));
    cells.push(row.status.name().into());
    cells.push(row.termination.map_or(String::new(), |reason| words::reason_name(reason).into()));
    let ran = row.termination.is_some();
    let counts = [row.candidates as u64, row.accepted as u64, row.evaluations];
    cells.extend(counts.map(|count| if ran { count.to_string() } else { String::new() }));
    let of_linkage = parameters_in(plan);
    match &row.best {
        Some(best) => {
            cells.extend(FIGURES.map(|(_, figure)| figure(best)));
            cells.extend(parameters(&of_linkage, &best.linkage));
        }
        None => cells.extend(vec![String::new(); FIGURES.len() + of_linkage.len()]),
    }
    cells.push(row.message.as_deref().map_or(String::new(), cell));
    written_row(&cells)
}

/// Returns the cell of a value: a text without quotes, a number with its shortest digits, a list as it is typed.
pub(super) fn value(value: &Value) -> String {
    match value {
        Value::String(text) => cell(text),
        Value::Number(number) => match (number.as_i64(), number.as_f64()) {
            (None, Some(float)) => exact(float),
            _ => number.to_string(),
        },
        other => cell(&typed(other)),
    }
}
