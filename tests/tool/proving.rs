//! `solve.certify`: a certificate after the search, or why there is none and what repeated hits say instead.

use crate::common::root;
use linkwright::internals::record::Record;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

fn record(folder: &Path) -> Record {
    let text = fs::read_to_string(folder.join("record.json")).expect("there is a record");
    serde_json::from_str(&text).expect("it is a record")
}

fn k18() -> String {
    root().join("problems/literature/k18.toml").display().to_string()
}

/// Six points, each at the crank angle that suits it.
const FREE: &str = "format = 1\n[task.path]\npoints = [[0, 0], [1, 0.2], [2, 0], [2.1, 1], [1, 1.3], [0, 1]]\n\
                    [solve]\ncertify = true\n";

#[test]
fn a_search_that_asks_for_a_certificate_ends_with_one_in_its_record_report_and_text() {
    let folder = TempDir::new().expect("a folder");
    let problem = k18();
    let set = ["--set", "solve.certify=true", "--set", "certify.time_limit_s=1", "--set", "certify.gap=0.5"];
    let mut arguments = vec!["synth", &problem, "--out", "r", "--quiet"];
    arguments.extend(set);
    let (code, stdout, stderr) = linkwright(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""), "{stdout}");
    assert!(stdout.contains("Covered: ") && stdout.contains("Not covered: "), "{stdout}");
    let result = folder.path().join("r");
    let found = record(&result);
    let certificate = found.certificate.clone().expect("a certificate");
    assert_eq!((certificate.wanted_gap, found.no_certificate.as_ref()), (0.5, None));
    let unbroken = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(unbroken.contains(&certificate.statement), "whole: {stdout}");
    assert!(certificate.boxes > 0 && certificate.lower_bound < found.candidates[0].error.sum_sq);
    let asked = found.problem.resolved.solve.certify.expect("it stands in the resolved problem");
    assert_eq!((asked.gap, asked.time_limit_s), (0.5, 1.0));
    let page = fs::read_to_string(result.join("report.html")).expect("a report");
    assert!(page.contains("Can it be better?") && page.contains(&certificate.statement));
    let (code, stdout, stderr) = linkwright(folder.path(), &["verify", "r", "--certificate"]);
    assert_eq!(code, 0, "{stdout}{stderr}");
    // The search is the same as without: the certificate decides no candidate and no digest.
    linkwright(folder.path(), &["synth", &problem, "--out", "plain", "--quiet"]);
    let plain = record(&folder.path().join("plain"));
    assert_eq!(plain.candidates, found.candidates);
    assert_eq!(plain.problem.digest, found.problem.digest);
    assert_eq!((&plain.certificate, &plain.repeats), (&None, &found.repeats));
}

#[test]
fn free_timing_has_no_certificate_and_says_how_often_the_best_came_back() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("free.toml"), FREE).expect("written");
    let (code, _, stderr) = linkwright(folder.path(), &["check", "free.toml"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("no certificate is available for free timing"), "{stderr}");
    let (code, stdout, _) = linkwright(folder.path(), &["synth", "free.toml", "--out", "r", "--quiet"]);
    assert!(code < 2, "{stdout}");
    assert!(stdout.contains("No certificate") && stdout.contains("for free timing"), "{stdout}");
    assert!(stdout.contains("independent starts") && stdout.contains("not a proof"), "{stdout}");
    let result = folder.path().join("r");
    let found = record(&result);
    assert!(found.certificate.is_none());
    let repeats = found.repeats.expect("hits were counted");
    assert!(repeats.hits > 0 && repeats.starts >= repeats.hits, "{repeats:?}");
    assert_eq!(repeats.as_likely, 0.5_f64.powi(i32::try_from(repeats.hits).expect("few")));
    assert_eq!(linkwright(folder.path(), &["verify", "r"]).0, 0);
    // There is nothing left to do.
    let (_, stdout, _) =
        linkwright(folder.path(), &["synth", "free.toml", "--out", "r", "--quiet", "--resume"]);
    assert!(stdout.contains("Done before"), "{stdout}");
    // Figures that do not follow from the counts are found out, and counts that cannot be.
    let path = result.join("record.json");
    let text = fs::read_to_string(&path).expect("a record");
    let starts = format!("\"starts\": {}", repeats.starts);
    assert!(text.contains(&starts));
    fs::write(&path, text.replace(&starts, "\"starts\": 100000")).expect("written");
    let (code, stdout, _) = linkwright(folder.path(), &["verify", "r"]);
    assert_eq!(code, 1);
    assert!(stdout.contains("repeats"), "{stdout}");
}

#[test]
fn a_table_that_is_not_read_and_a_certificate_that_cannot_be_are_warned_of() {
    let folder = TempDir::new().expect("a folder");
    let unread = FREE.replace("certify = true", "[certify]\ngap = 0.1");
    fs::write(folder.path().join("unread.toml"), unread).expect("written");
    let (code, _, stderr) = linkwright(folder.path(), &["check", "unread.toml"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("[certify] is read only where"), "{stderr}");
}
