//! `certify` and `verify --certificate` as a person meets them.

use crate::common::root;
use assert_cmd::Command;
use linkwright::internals::record::Record;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("linkwright")
        .expect("it is built")
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .args(arguments)
        .output()
        .expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

fn problem(name: &str) -> String {
    root().join(format!("problems/literature/{name}.toml")).display().to_string()
}

fn record(folder: &Path) -> Record {
    let text = fs::read_to_string(folder.join("record.json")).expect("there is a record");
    serde_json::from_str(&text).expect("it is a record")
}

#[test]
fn a_run_that_is_stopped_early_leaves_a_valid_bound_that_verify_works_out_again() {
    let folder = TempDir::new().expect("a folder");
    let result = folder.path().join("r");
    assert_eq!(linkwright(folder.path(), &["synth", &problem("k18"), "--out", "r", "--quiet"]).0, 0);
    let before = record(&result);
    let times = fs::read(result.join("timing.json")).expect("times");
    let (code, stdout, stderr) =
        linkwright(folder.path(), &["certify", "r", "--set", "certify.time_limit_s=1", "--quiet"]);
    assert_eq!(code, 1, "{stdout}{stderr}");
    assert!(stdout.contains("not closed") && stdout.contains("No four-bar linkage"), "{stdout}");
    let mut after = record(&result);
    let certificate = after.certificate.clone().expect("a certificate");
    assert!(!certificate.closed && certificate.boxes > 0 && certificate.parts.len() == 4);
    assert!(certificate.lower_bound >= 0.0 && certificate.lower_bound < before.candidates[0].error.sum_sq);
    assert!(
        (certificate.gap + certificate.lower_bound / before.candidates[0].error.sum_sq - 1.0).abs() < 1e-12
    );
    // Nothing else has changed.
    after.certificate = None;
    assert_eq!(before, after);
    assert_eq!(times, fs::read(result.join("timing.json")).expect("times"));
    let (code, stdout, stderr) = linkwright(folder.path(), &["verify", "r", "--certificate"]);
    assert_eq!(code, 0, "{stdout}{stderr}");
    assert!(stdout.contains("worked out again"), "{stdout}");
    // A later run that proves less takes nothing away.
    let (code, stdout, stderr) = linkwright(
        folder.path(),
        &["certify", "r", "--gap", "0.9", "--set", "certify.time_limit_s=1e-9", "--quiet"],
    );
    assert!(code == 1 && stderr.contains("proves more than this run"), "{stdout}{stderr}");
    assert_eq!(record(&result).certificate.as_ref(), Some(&certificate));
    // A bound that was raised by hand is found out.
    let path = result.join("record.json");
    after.certificate = Some(certificate);
    if let Some(certificate) = &mut after.certificate {
        certificate.lower_bound = 0.009;
        certificate.closed = true;
    }
    fs::write(&path, serde_json::to_string_pretty(&after).expect("JSON")).expect("it is written");
    let (code, stdout, _) = linkwright(folder.path(), &["verify", "r", "--certificate"]);
    assert_eq!(code, 1);
    assert!(stdout.contains("certificate.lower_bound") && stdout.contains("certificate.closed"), "{stdout}");
}

#[test]
fn a_stopped_run_goes_on_where_it_stood_and_refuses_what_is_not_its_own() {
    let folder = TempDir::new().expect("a folder");
    let result = folder.path().join("r");
    let synth = ["synth", &problem("k18"), "--out", "r", "--quiet"];
    assert_eq!(linkwright(folder.path(), &synth).0, 0);
    let second = |more: &[&str]| {
        let arguments = [&["certify", "r", "--set", "certify.time_limit_s=0.5"], more].concat();
        linkwright(folder.path(), &arguments)
    };
    let (code, _, stderr) = second(&["--resume"]);
    assert!(code == 1 && stderr.contains("begins anew"), "{stderr}");
    let checkpoint = result.join("certificate.checkpoint");
    let kept = fs::read(&checkpoint).expect("a checkpoint");
    let first = record(&result).certificate.expect("a certificate").boxes;
    let (code, stdout, stderr) = second(&["--resume", "--leaves", "--quiet"]);
    assert!(code == 1 && stdout.contains("--resume goes on"), "{stdout}{stderr}");
    let then = record(&result).certificate.expect("a certificate").boxes;
    assert!(then > first, "{then} after {first}");
    // The leaves of a run that went on prove what its record says.
    let (code, stdout, stderr) = linkwright(folder.path(), &["verify", "r", "--leaves"]);
    assert!(code == 0 && stdout.contains("arithmetic of its own"), "{stdout}{stderr}");
    let files = || {
        let names = fs::read_dir(&result).expect("it is there").map(|e| e.expect("it can be read").path());
        let mut files: Vec<_> =
            names.map(|path| (path.clone(), fs::read(path).expect("it is read"))).collect();
        files.sort();
        files
    };
    let before = files();
    let (code, _, stderr) = second(&["--resume", "--gap", "0.5"]);
    assert!(code == 2 && stderr.contains("another gap"), "{stderr}");
    assert_eq!(before, files());
    fs::write(&checkpoint, &kept[..kept.len() / 2]).expect("it is cut");
    let (code, _, stderr) = second(&["--resume"]);
    assert!(code == 2 && stderr.contains("certificate.checkpoint") && stderr.contains("cut off"), "{stderr}");
    // Leaves that were cut, and none at all.
    let leaves = result.join("certificate.leaves");
    let whole = fs::read(&leaves).expect("leaves");
    fs::write(&leaves, &whole[..whole.len() - 7]).expect("they are cut");
    let (code, stdout, _) = linkwright(folder.path(), &["verify", "r", "--leaves"]);
    assert!(code == 1 && stdout.contains("NOT true") && stdout.contains("cut off"), "{stdout}");
    fs::write(&leaves, "something else").expect("they are others");
    let (code, _, stderr) = linkwright(folder.path(), &["verify", "r", "--leaves"]);
    assert!(code == 2 && stderr.contains("certificate.leaves: these are no leaves"), "{stderr}");
    fs::remove_file(&leaves).expect("they are gone");
    let (code, _, stderr) = linkwright(folder.path(), &["verify", "r", "--leaves"]);
    assert!(code == 2 && stderr.contains("certify with --leaves"), "{stderr}");
}

#[test]
fn limits_that_the_proof_does_not_use_are_named() {
    let folder = TempDir::new().expect("a folder");
    linkwright(folder.path(), &["synth", &problem("a6"), "--out", "r", "--quiet"]);
    let (code, stdout, _) =
        linkwright(folder.path(), &["certify", "r", "--set", "certify.time_limit_s=0.1", "--quiet"]);
    let said = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        code == 1 && said.contains("limits that the proof does not use (design.ground, design.a)"),
        "{stdout}"
    );
}

#[test]
fn what_has_no_certificate_is_told_so_and_nothing_is_written() {
    let folder = TempDir::new().expect("a folder");
    let points = "x,y\n0,0\n1,0.2\n2,0\n2.1,1\n1,1.3\n0,1\n";
    fs::write(folder.path().join("free.csv"), points).expect("written");
    linkwright(folder.path(), &["synth", "free.csv", "--out", "free", "--quiet"]);
    let k18 = problem("k18");
    let apart = ["synth", &k18, "--set", "require.circuit=any", "--out", "apart", "--quiet"];
    linkwright(folder.path(), &apart);
    let (code, _, stderr) = linkwright(folder.path(), &["certify", "apart"]);
    assert!(code == 2 && stderr.contains("require.circuit"), "{stderr}");
    let before = fs::read(folder.path().join("free/record.json")).expect("a record");
    let (code, stdout, stderr) = linkwright(folder.path(), &["certify", "free"]);
    assert_eq!(code, 2);
    assert!(stdout.contains("independent starts") && stdout.contains("not a proof"), "{stdout}");
    assert!(stderr.contains("free timing"), "{stderr}");
    assert_eq!(before, fs::read(folder.path().join("free/record.json")).expect("a record"));
    let (code, _, stderr) = linkwright(folder.path(), &["verify", "free", "--certificate"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("no certificate"), "{stderr}");
    for (arguments, words) in [
        (["certify", "free", "--gap", "1.5"], "between 0 and 1"),
        (["certify", "free", "--gap", "-1"], "above 0"),
        (["certify", "free", "--set", "certify.time_limit_s=0"], "above 0"),
        (["certify", "free", "--set", "certify.threads=2"], "certify.time_limit_s"),
    ] {
        let (code, _, stderr) = linkwright(folder.path(), &arguments);
        assert_eq!(code, 2, "{arguments:?}");
        assert!(stderr.contains(words), "{arguments:?}: {stderr}");
    }
}

#[test]
fn fixed_pivots_and_angles_from_the_x_axis_are_proved_and_checked() {
    let folder = TempDir::new().expect("a folder");
    let run = |arguments: &[&str]| linkwright(folder.path(), arguments);
    // As it stands: A and the ground's direction are known. Then with both pivots known.
    let text = fs::read_to_string(problem("e5")).expect("a problem");
    let both = text
        .replace("A = [0, 0]\nground_angle_deg = 0\nground = [0, 50]\n", "A = [0, 0]\nB = [3.67, 0]\n")
        .replace("[expect]", "[unused]");
    let both = &both[..both.find("[unused]").expect("the table")];
    fs::write(folder.path().join("both.toml"), both).expect("written");
    for (file, name, known) in
        [(problem("e5"), "e5", "ground 0 to 50 long"), ("both.toml".to_owned(), "both", "ground 3.67 long")]
    {
        let (_, stdout, stderr) = run(&["synth", &file, "--out", name, "--quiet"]);
        assert!(folder.path().join(name).join("record.json").exists(), "{stdout}{stderr}");
        let (code, stdout, stderr) = run(&["certify", name, "--leaves", "--quiet"]);
        assert_eq!(code, 0, "{stdout}{stderr}");
        let after = record(&folder.path().join(name));
        let certificate = after.certificate.expect("a certificate");
        assert!(certificate.closed && certificate.gap <= 1e-4 && certificate.parts.len() == 1);
        assert!((7.41e-7..7.4161e-7).contains(&certificate.lower_bound), "{certificate:?}");
        let statement = certificate.statement;
        for words in ["No crank-rocker (crank pivot at (0, 0); ground line at 0 degrees", known] {
            assert!(statement.contains(words), "{statement}");
        }
        let (code, stdout, stderr) = run(&["verify", name, "--leaves", "--certificate"]);
        assert_eq!(code, 0, "{stdout}{stderr}");
        assert!(stdout.contains("worked out again") && stdout.contains("arithmetic of its own"), "{stdout}");
    }
}
