//! `verify`: recompute a result.

use super::arguments::Verify;
use super::{Ended, terminal};
use crate::diagnostic::escaped;
use crate::results_folder::read_record;

/// Runs the command.
pub fn run(options: &Verify) -> Ended {
    let mut ended = Ended::Good;
    for path in &options.results {
        let shown = escaped(&path.display().to_string());
        let record = match read_record(path) {
            Ok(record) => record,
            Err(e) => {
                terminal::complain(&e.to_string());
                return Ended::Refused;
            }
        };
        match crate::verify::verify(&record) {
            Ok(mismatches) if mismatches.is_empty() => {
                let n = record.candidates.len();
                let word = if n == 1 { "candidate" } else { "candidates" };
                terminal::answer(&format!(
                    "{shown}: true. Every figure and verdict of {n} {word} was recomputed and agrees.\n"
                ));
            }
            Ok(mismatches) => {
                ended = Ended::Bad;
                terminal::answer(&format!("{shown}: NOT true.\n"));
                for mismatch in mismatches {
                    terminal::answer(&format!("  {}\n", escaped(&mismatch.to_string())));
                }
            }
            Err(e) => {
                terminal::complain(&format!("{shown}: the recorded problem is none: {e}"));
                return Ended::Refused;
            }
        }
    }
    ended
}
