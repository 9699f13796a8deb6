//! `verify`: recompute a result.

use super::arguments::Verify;
use super::progress::{LINE_EVERY, Proving};
use super::result;
use super::result::Which;
use super::{Ended, interrupt, terminal};
use crate::app::results_folder::LEAVES;
use crate::files::diagnostic::escaped;
use crate::judge::certificate::{CheckError, Checked as CheckedLeaves, check};
use crate::judge::verify::{Checked, unchecked};
use crate::numbers::leaves::{LeavesError, MAX_BYTES};
use crate::record::Record;
use crate::report::text::COLUMNS;
use crate::report::text::wrapped;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the command: every record is looked at, whatever is wrong with those before it, and the gravest end is that of
/// all. Ctrl-C ends it.
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
                ended = ended.max(Ended::Refused);
                continue;
            }
            Err(refused) => {
                ended = ended.max(refused);
                continue;
            }
        };
        let mut verified = crate::judge::verify::verify(&record);
        if let (Ok(mismatches), true) = (&mut verified, options.certificate) {
            if record.certificate.is_none() {
                terminal::complain(&format!("{shown}: the record has no certificate; run certify first"));
                ended = ended.max(Ended::Refused);
                continue;
            }
            let mut proving = Proving::new(&record.problem.name, false);
            let cancel = interrupt::watch("ending the check");
            match crate::judge::verify::verify_certificate(&record, cancel, &mut |progress| {
                proving.update(progress)
            }) {
                Ok(Some(more)) => mismatches.extend(more),
                Ok(None) => return Ended::Interrupted,
                Err(e) => {
                    terminal::complain(&format!("{shown}: {e}"));
                    ended = ended.max(Ended::Refused);
                    continue;
                }
            }
        }
        let mut leaves = Ok(None);
        if let (Ok(_), true) = (&verified, options.leaves) {
            leaves = match check_leaves(path, &record) {
                Ok(checked) => Ok(Some(checked)),
                Err(Wrong::Told(Ended::Interrupted)) => return Ended::Interrupted,
                Err(Wrong::Told(told)) => {
                    ended = ended.max(told);
                    continue;
                }
                Err(Wrong::Not(why)) => Err(why),
            };
        }
        match verified {
            Ok(mismatches) if mismatches.is_empty() && leaves.is_ok() => {
                let n = record.candidates.len();
                let word = if n == 1 { "candidate" } else { "candidates" };
                terminal::answer(&format!(
                    "{shown}: true. The figures and verdicts of {n} {word} were recomputed and agree.\n"
                ));
                terminal::answer(&limits_of(&record, options));
                if options.certificate {
                    terminal::answer(
                        "  The certificate was worked out again: the same boxes, the same bound.\n",
                    );
                }
                if let Ok(Some(CheckedLeaves { leaves, boxes })) = leaves {
                    terminal::answer(&format!(
                        "  The leaves cover every linkage and each was shown in arithmetic of its own: {leaves} leaves, \
                         {boxes} boxes.\n"
                    ));
                }
            }
            Ok(mismatches) => {
                ended = ended.max(Ended::Bad);
                let untrue = !mismatches.is_empty() || leaves.as_ref().is_err_and(CheckError::is_refuted);
                terminal::answer(&format!("{shown}: {}.\n", if untrue { "NOT true" } else { "NOT shown" }));
                for mismatch in mismatches {
                    terminal::answer(&format!("  {}\n", escaped(&mismatch.to_string())));
                }
                if let Err(why) = leaves {
                    let file = escaped(&leaves_of(path).display().to_string());
                    terminal::answer(&format!("  {file}: {}\n", escaped(&why.to_string())));
                }
            }
            Err(e) => {
                terminal::complain(&format!("{shown}: the recorded problem is none: {e}"));
                ended = ended.max(Ended::Refused);
            }
        }
    }
    ended
}

/// The keys of a record that were not recomputed, in words.
fn limits_of(record: &Record, options: &Verify) -> String {
    let proved = options.certificate || options.leaves;
    let listed = |how: Checked| {
        let keys = unchecked(record, how).into_iter();
        // What the other answers speak of is told below.
        keys.filter(|key| !(proved && key.starts_with("certificate."))).collect::<Vec<_>>().join(", ")
    };
    let mut text = String::new();
    for (head, how) in [("Held to limits only: ", Checked::Bounded), ("Not checked: ", Checked::Not)] {
        let keys = listed(how);
        if !keys.is_empty() {
            text.push_str(&wrapped("  ", "    ", &format!("{head}{keys}."), COLUMNS));
        }
    }
    if record.certificate.is_some() && !proved {
        text.push_str(&wrapped(
            "  ",
            "    ",
            "Of the certificate its words, gap and verdict follow from its bounds; the bounds themselves are checked with \
             --certificate, or with --leaves.",
            COLUMNS,
        ));
    }
    text
}

/// Why leaves prove nothing.
enum Wrong {
    /// It has been told.
    Told(Ended),
    /// They do not prove the certificate.
    Not(CheckError),
}

/// The file of leaves beside a record.
fn leaves_of(path: &Path) -> PathBuf {
    if path.is_dir() { path.join(LEAVES) } else { path.with_file_name(LEAVES) }
}

/// Checks the leaves of a record's certificate, which lie beside it.
fn check_leaves(path: &Path, record: &Record) -> Result<CheckedLeaves, Wrong> {
    let refuse = |file: &Path, text: &str| {
        terminal::complain(&format!("{}: {text}", escaped(&file.display().to_string())));
        Wrong::Told(Ended::Refused)
    };
    let recorded = record
        .certificate
        .as_ref()
        .ok_or_else(|| refuse(path, "the record has no certificate; run certify with --leaves first"))?;
    let file = leaves_of(path);
    let mut bytes = Vec::new();
    let read = File::open(&file).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes));
    read.map_err(|e| match e.kind() {
        io::ErrorKind::NotFound => refuse(&file, "there are no leaves; run certify with --leaves first"),
        _ => refuse(&file, &e.to_string()),
    })?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(&file, &format!("leaves have at most {MAX_BYTES} bytes")));
    }
    let cancel = interrupt::watch("ending the check");
    let begun = Instant::now();
    let mut last = begun;
    let mut tell = |checked: &CheckedLeaves| {
        if last.elapsed() >= LINE_EVERY {
            last = Instant::now();
            let seconds = begun.elapsed().as_secs_f64();
            terminal::tell(&format!(
                "{}: {seconds:.0} s: {} leaves checked",
                escaped(&file.display().to_string()),
                checked.leaves
            ));
        }
    };
    check(record, recorded, &bytes, cancel, &mut tell).map_err(|e| match e {
        CheckError::NoCertificate(e) => refuse(path, &e.to_string()),
        CheckError::Leaves(e @ (LeavesError::Foreign | LeavesError::Version { .. })) => {
            refuse(&file, &e.to_string())
        }
        CheckError::Stopped => Wrong::Told(Ended::Interrupted),
        wrong => Wrong::Not(wrong),
    })
}
