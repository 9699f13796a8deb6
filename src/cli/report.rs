//! `report`: a result as a page, from its record alone.

use super::arguments::Report;
use super::result::{Run, Which, read_run_of};
use super::{Ended, terminal};
use crate::diagnostic::escaped;
use crate::report::html::{is_report, report_html};
use crate::results_folder::write_file;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// So many of the figures that are not so are named.
const NAMED: usize = 5;

/// Runs the command.
pub fn run(options: &Report) -> Ended {
    let run = match read_run_of(&options.result, "report") {
        Ok(run) => run,
        Err(ended) => return ended,
    };
    if let Err(ended) = is_true(&run) {
        return ended;
    }
    let first = match run.which {
        Which::All => 0,
        Which::Rank(rank) => rank - 1,
        // Where it is one of the candidates, that one; else it stands after them.
        Which::Buildable => run.record.buildable.as_ref().map_or(0, |c| match c.rank {
            0 => run.record.candidates.len(),
            rank => rank - 1,
        }),
    };
    let place = match &options.out {
        Some(place) => place.clone(),
        None => {
            let place = beside(Path::new(&run.named));
            if is_foreign(&place) {
                let shown = escaped(&place.display().to_string());
                terminal::complain(&format!(
                    "{shown} is there and is no report of linkwright; name another place with --out"
                ));
                return Ended::Refused;
            }
            place
        }
    };
    if let Err(e) = write_file(&place, report_html(&run.record, first).as_bytes()) {
        terminal::complain(&e.to_string());
        return Ended::Refused;
    }
    terminal::answer(&format!("{}\n", escaped(&place.display().to_string())));
    Ended::Good
}

/// A report shows figures as they were proved by the record: one that is not true gets none.
fn is_true(run: &Run) -> Result<(), Ended> {
    let shown = escaped(&run.named);
    let mismatches = crate::verify::verify(&run.record).map_err(|e| {
        terminal::complain(&format!("{shown}: the recorded problem is none: {e}"));
        Ended::Refused
    })?;
    if mismatches.is_empty() {
        return Ok(());
    }
    let mut text =
        format!("{shown}: this record is not true, so a report would show figures that are not so:");
    for mismatch in mismatches.iter().take(NAMED) {
        text.push_str(&format!("\n  {}", escaped(&mismatch.to_string())));
    }
    if mismatches.len() > NAMED {
        text.push_str(&format!(
            "\n  and {} more: linkwright verify names them all",
            mismatches.len() - NAMED
        ));
    }
    text.push_str("\nrun the problem again to have a true record");
    terminal::complain(&text);
    Err(Ended::Bad)
}

/// `report.html` in the result's folder; beside a record that was named by its file, `NAME.html`.
fn beside(named: &Path) -> PathBuf {
    if named.is_file() { named.with_extension("html") } else { named.join("report.html") }
}

/// Whether a file is there that no report of ours is.
fn is_foreign(place: &Path) -> bool {
    let Ok(file) = File::open(place) else { return place.exists() };
    let mut start = Vec::new();
    file.take(1024).read_to_end(&mut start).is_err() || !is_report(&start)
}
