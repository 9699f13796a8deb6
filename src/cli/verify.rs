//! `verify`: recompute a result.

use super::arguments::Verify;
use super::result::{self, Which};
use super::{Ended, terminal};
use crate::diagnostic::escaped;

/// Runs the command.
pub fn run(options: &Verify) -> Ended {
    let mut ended = Ended::Good;
    for path in &options.results {
        let shown = escaped(&path.display().to_string());
        let record = match result::read_run_of(path, "verify") {
            Ok(run) if run.which == Which::All => run.record,
            Ok(run) => {
                terminal::complain(&format!(
                    "{shown}: a record is verified as a whole; give {} alone",
                    run.named
                ));
                return Ended::Refused;
            }
            Err(ended) => return ended,
        };
        let mut verified = crate::verify::verify(&record);
        if let (Ok(mismatches), true) = (&mut verified, options.certificate) {
            if record.certificate.is_none() {
                terminal::complain(&format!("{shown}: the record has no certificate; run certify first"));
                return Ended::Refused;
            }
            match crate::verify::verify_certificate(&record) {
                Ok(more) => mismatches.extend(more),
                Err(e) => {
                    terminal::complain(&format!("{shown}: {e}"));
                    return Ended::Refused;
                }
            }
        }
        match verified {
            Ok(mismatches) if mismatches.is_empty() => {
                let n = record.candidates.len();
                let word = if n == 1 { "candidate" } else { "candidates" };
                terminal::answer(&format!(
                    "{shown}: true. Every figure and verdict of {n} {word} was recomputed and agrees.\n"
                ));
                if options.certificate {
                    terminal::answer(
                        "  The certificate was worked out again: the same boxes, the same bound.\n",
                    );
                }
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
