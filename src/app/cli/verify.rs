//! `verify`: recompute a result.

use super::arguments::Verify;
use super::progress::Shown;
use super::result;
use super::result::Which;
use super::{Ended, interrupt, refuse, refuse_path, terminal};
use crate::app::certificates;
use crate::files::diagnostic::escaped;
use crate::judge::certificate::{CheckError, Checked as CheckedLeaves};
use crate::judge::verify::{Checked, Mismatch, unchecked, verify_certificate};
use crate::record::Record;
use crate::report::text::{COLUMNS, plural, wrapped};
use std::path::Path;

/// Runs the command: every record is looked at, whatever is wrong with those before it, and the gravest end is that of
/// all. Ctrl-C ends it.
pub fn run(options: &Verify) -> Result<Ended, Ended> {
    let mut ended = Ended::Good;
    for path in &options.results {
        ended = ended.max(one(path, options).unwrap_or_else(|ended| ended));
        if ended == Ended::Interrupted {
            break;
        }
    }
    Ok(ended)
}

/// Recomputes one record and says how true it is.
fn one(path: &Path, options: &Verify) -> Result<Ended, Ended> {
    let shown = terminal::shown(path);
    let run = result::read_run_of(path, "verify")?;
    if run.which != Which::All {
        return Err(refuse_path(path, format!("a record is verified as a whole; give {} alone", run.named)));
    }
    let record = run.record;
    let mut mismatches = result::mismatches(path, &record)?;
    if options.certificate {
        mismatches.extend(certificate_of(path, &record)?);
    }
    let leaves = options.leaves.then(|| check_leaves(path, &record)).transpose()?;
    let wrong = match leaves.transpose() {
        Ok(checked) if mismatches.is_empty() => {
            say_true(&shown, &record, options, checked);
            return Ok(Ended::Good);
        }
        wrong => wrong.err(),
    };
    let untrue = !mismatches.is_empty() || wrong.as_ref().is_some_and(CheckError::is_refuted);
    terminal::answer(&format!("{shown}: {}.\n", if untrue { "NOT true" } else { "NOT shown" }));
    for mismatch in mismatches {
        terminal::answer(&format!("  {}\n", escaped(&mismatch.to_string())));
    }
    if let Some(why) = wrong {
        let leaves = terminal::shown(&certificates::leaves_of(path));
        terminal::answer(&format!("  {leaves}: {}\n", escaped(&why.to_string())));
    }
    Ok(Ended::Bad)
}

/// Works out the certificate of a record again.
fn certificate_of(path: &Path, record: &Record) -> Result<Vec<Mismatch>, Ended> {
    if record.certificate.is_none() {
        return Err(refuse_path(path, "the record has no certificate; run certify first"));
    }
    let proving = Shown::of_proof(&record.problem.name, false);
    let cancel = interrupt::watch("ending the check");
    let found = verify_certificate(record, cancel, &mut |progress| proving.proof(progress));
    found.map_err(|e| refuse_path(path, e))?.ok_or(Ended::Interrupted)
}

/// Says of a true record how much of it was recomputed.
fn say_true(shown: &str, record: &Record, options: &Verify, leaves: Option<CheckedLeaves>) {
    let subjects = subjects(record);
    terminal::answer(&format!(
        "{shown}: true. The figures and verdicts of {subjects} were recomputed and agree.\n"
    ));
    terminal::answer(&limits_of(record, options));
    if options.certificate {
        terminal::answer("  The certificate was worked out again: the same boxes, the same bound.\n");
    }
    if let Some(CheckedLeaves { leaves, boxes }) = leaves {
        terminal::answer(&format!(
            "  The leaves cover every linkage and each was shown in arithmetic of its own: {leaves} leaves, {boxes} \
             boxes.\n"
        ));
    }
}

/// The linkages of a record that were judged anew, counted: `5 candidates and 20 linkages of the front`.
fn subjects(record: &Record) -> String {
    let candidates = plural(record.candidates.len(), "candidate");
    match record.front.as_ref().map_or(0, |front| front.members.len()) {
        0 => candidates,
        n => format!("{candidates} and {} of the front", plural(n, "linkage")),
    }
}

/// The keys of a record that were not recomputed, in words.
fn limits_of(record: &Record, options: &Verify) -> String {
    let proved = options.certificate || options.leaves;
    let mut text = String::new();
    for (head, how) in [("Held to limits only: ", Checked::Bounded), ("Not checked: ", Checked::Not)] {
        let mut keys = unchecked(record, how);
        // The other answers speak of the certificate.
        keys.retain(|key| !(proved && key.starts_with("certificate.")));
        if !keys.is_empty() {
            text.push_str(&wrapped("  ", "    ", &format!("{head}{}.", keys.join(", ")), COLUMNS));
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

/// Checks the leaves of a record's certificate, which are beside it; the inner error is that they do not prove it.
fn check_leaves(path: &Path, record: &Record) -> Result<Result<CheckedLeaves, CheckError>, Ended> {
    certificates::certificate_of(path, record).map_err(refuse)?;
    let bytes = certificates::read_leaves(path).map_err(refuse)?;
    let cancel = interrupt::watch("ending the check");
    let (progress, named) = (Shown::of_proof("", false), terminal::shown(&certificates::leaves_of(path)));
    let told = &mut |checked: &CheckedLeaves| progress.leaves(&named, checked.leaves);
    match certificates::check_leaves(path, record, &bytes, cancel, told).map_err(refuse)? {
        Err(CheckError::Stopped) => Err(Ended::Interrupted),
        checked => Ok(checked),
    }
}
