//! `report`: a result as a page, from its record alone.

use super::arguments::Report;
use super::output::Output;
use super::result::{Run, Which, mismatches, read_run_of};
use super::{Ended, terminal};
use crate::app::job::folder::RECORD;
use crate::files::diagnostic::escaped;
use crate::files::generator::FileKind;
use crate::report::html::{Shown, report_showing};
use std::path::{Path, PathBuf};

/// So many of the figures that are not so are named.
const NAMED: usize = 5;

/// Runs the command.
pub fn run(options: &Report) -> Result<Ended, Ended> {
    let run = read_run_of(&options.result, "report")?;
    is_true(&run)?;
    let first = match run.which {
        Which::All => Shown::Candidate(0),
        Which::Rank(rank) => Shown::Candidate(rank - 1),
        Which::Member(number) => Shown::Member(number - 1),
        Which::Pick(pick) => Shown::Pick(pick),
    };
    let place = options.out.clone().unwrap_or_else(|| beside(Path::new(&run.named)));
    let page = report_showing(&run.record, first);
    Output::new([&options.result], options.force).write(&[(&place, FileKind::Html, page)])?;
    terminal::answer(&format!("{}\n", terminal::shown(&place)));
    Ok(Ended::Good)
}

/// Refuses a record with false figures: a report would show them.
fn is_true(run: &Run) -> Result<(), Ended> {
    let mismatches = mismatches(Path::new(&run.named), &run.record)?;
    if mismatches.is_empty() {
        return Ok(());
    }
    let why = "this record is not true, so a report would show figures that are not so:";
    terminal::complain(&format!("{}: {why}", run.named));
    let (named, more) = mismatches.split_at(mismatches.len().min(NAMED));
    for mismatch in named {
        terminal::tell(&format!("  {}", escaped(&mismatch.to_string())));
    }
    if !more.is_empty() {
        terminal::tell(&format!("  and {} more: linkwright verify names them all", more.len()));
    }
    terminal::tell("run the problem again to have a true record");
    Err(Ended::Bad)
}

/// Returns the usual place of the page: `report.html` in the result's folder; for a record under another name, that name
/// with the ending `.html`.
fn beside(named: &Path) -> PathBuf {
    match named.file_name() {
        Some(name) if name == RECORD && named.is_file() => named.with_file_name("report.html"),
        _ if named.is_file() => named.with_extension("html"),
        _ => named.join("report.html"),
    }
}
