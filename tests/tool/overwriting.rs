//! Files of a user stay: every door that writes a file where it is told, onto everything that linkwright did not write.

use crate::common::root;
use linkwright::internals::report::export::Format;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const PROBLEM: &str = "format = 1
name = \"small\"
[task.path]
points = [[0, 0], [1, 2], [2, 2.5], [3, 2], [4, 0]]
[solve]
candidates = 2
evaluations = 2000
";

fn linkwright(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments).stdin(Stdio::null());
    command.output().expect("it runs")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A folder with a problem, its result `r` and a linkage file.
fn place() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("small.toml"), PROBLEM).expect("there is room");
    let ran = linkwright(folder.path(), &["synth", "small.toml", "--out", "r", "--quiet", "--threads", "1"]);
    assert!(matches!(ran.status.code(), Some(0 | 1)), "{}", said(&ran));
    fs::copy(folder.path().join("r/linkage-1.toml"), folder.path().join("given.toml"))
        .expect("there is room");
    folder
}

/// Every command that writes a file where it is told: its arguments, to which the place is added, with the file's
/// ending.
fn doors() -> Vec<(Vec<&'static str>, &'static str)> {
    let mut doors = vec![
        (vec!["analyze", "given.toml", "--csv"], "csv"),
        (vec!["analyze", "given.toml", "--svg"], "svg"),
        (vec!["compare", "r", "--csv"], "csv"),
        (vec!["compare", "r", "--svg"], "svg"),
        (vec!["compare", "r", "--html"], "html"),
        (vec!["cognates", "given.toml", "--out", "cognates", "--svg"], "svg"),
        (vec!["report", "r", "--out"], "html"),
        (vec!["snap", "given.toml", "--grid", "0.5", "--snap", "a", "--out"], "toml"),
    ];
    for format in Format::ALL {
        doors.push((vec!["export", "r", "--format", format.name(), "--out"], "txt"));
    }
    doors
}

/// Files that linkwright did not write as such, or did not write at all.
fn victims(folder: &Path) -> Vec<Vec<u8>> {
    let of = |name: &str| fs::read(folder.join(name)).expect("it is there");
    vec![
        b"milk, eggs, butter\n".to_vec(),
        of("small.toml"),
        of("r/record.json"),
        of("r/timing.json"),
        b"x,y\n0,0\n1,1\n".to_vec(),
        b"<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0\"/></svg>\n".to_vec(),
        b"<!doctype html>\n<title>mine</title>\n".to_vec(),
        b"  999\nmine\n  0\nEOF\n".to_vec(),
        b"solid mine\nendsolid mine\n".to_vec(),
        b"// mine\ncube(3);\n".to_vec(),
        b"{\"tool\": {\"name\": \"another\"}, \"linkage\": {}}\n".to_vec(),
        b"\x89PNG\r\n\x1a\n of another program".to_vec(),
        b"GIF89a of another program".to_vec(),
        // A problem made of a linkage file, whose first line was left.
        format!("# A four-bar linkage, written by linkwright 0.1.0.\n{PROBLEM}").into_bytes(),
        b"\xff\xfe\x00not text".to_vec(),
    ]
}

#[test]
fn no_door_replaces_a_file_that_linkwright_did_not_write_as_that_kind() {
    let place = place();
    let folder = place.path();
    let victims = victims(folder);
    for (door, ending) in doors() {
        let name = format!("out.{ending}");
        let target = folder.join(&name);
        let run = |more: &[&str]| {
            // `cognates` writes its linkage files only where they are not there yet.
            let _ = fs::remove_dir_all(folder.join("cognates"));
            let mut arguments: Vec<&str> = door.clone();
            arguments.push(&name);
            arguments.extend(more);
            linkwright(folder, &arguments)
        };
        for victim in &victims {
            fs::write(&target, victim).expect("there is room");
            let output = run(&[]);
            assert_eq!(output.status.code(), Some(2), "{door:?} on {:?}", String::from_utf8_lossy(victim));
            assert!(said(&output).contains(&name) && said(&output).contains("--force"), "{}", said(&output));
            assert!(fs::read(&target).expect("it is there") == *victim, "{door:?}");
            assert!(!folder.join("cognates").exists(), "nothing else is written then");
        }
        // --force replaces even these; what was written may be written again, edited or not, and so may nothing.
        let output = run(&["--force"]);
        assert!(matches!(output.status.code(), Some(0 | 1)), "{door:?}: {}", said(&output));
        let ours = fs::read(&target).expect("it is there");
        let mut edited = ours.clone();
        edited.extend(b"\n");
        for there in [&ours, &edited, &Vec::new()] {
            fs::write(&target, there).expect("there is room");
            let output = run(&[]);
            assert!(matches!(output.status.code(), Some(0 | 1)), "{door:?}: {}", said(&output));
            assert!(fs::read(&target).expect("it is there") == ours, "{door:?}");
        }
        fs::remove_file(&target).expect("it is there");
    }
}

#[test]
fn every_export_format_bears_a_mark_that_only_its_own_kind_knows() {
    let place = place();
    let folder = place.path();
    let bytes: Vec<Vec<u8>> = Format::ALL
        .iter()
        .map(|format| {
            let name = format!("own.{}", format.name());
            let made = linkwright(folder, &["export", "r", "--format", format.name(), "--out", &name]);
            assert_eq!(made.status.code(), Some(0), "{}", said(&made));
            fs::read(folder.join(name)).expect("it is there")
        })
        .collect();
    for (one, existing) in Format::ALL.iter().zip(&bytes) {
        for (other, new) in Format::ALL.iter().zip(&bytes) {
            let known = other.kind().is_written_by_us(existing, new);
            let tables = [Format::Csv, Format::CutListCsv];
            let same = one.kind() == other.kind() && (!tables.contains(one) || one == other);
            assert_eq!(known, same, "{} as {}", one.name(), other.name());
        }
    }
}

#[test]
fn a_command_does_not_replace_its_own_input_by_whatever_name() {
    let place = place();
    let folder = place.path();
    let record = fs::read(folder.join("r/record.json")).expect("it is there");
    let given = fs::read(folder.join("given.toml")).expect("it is there");
    fs::create_dir(folder.join("below")).expect("a folder");
    let cases: [&[&str]; 8] = [
        &["export", "given.toml", "--format", "toml", "--out", "given.toml"],
        &["export", "given.toml", "--format", "toml", "--out", "below/../given.toml"],
        &["snap", "given.toml", "--grid", "0.5", "--snap", "a", "--out", "./given.toml"],
        &["analyze", "given.toml", "--csv", "given.toml"],
        &["cognates", "given.toml", "--svg", "given.toml"],
        &["report", "r", "--out", "r/record.json"],
        &["export", "r:1", "--format", "json", "--out", "r/record.json"],
        &["compare", "r", "--target", "small.toml", "--html", "small.toml"],
    ];
    for arguments in cases {
        let output = linkwright(folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(said(&output).contains("is an input of this command"), "{arguments:?}: {}", said(&output));
        assert!(fs::read(folder.join("r/record.json")).expect("it is there") == record);
        assert!(fs::read(folder.join("given.toml")).expect("it is there") == given);
        assert_eq!(fs::read_to_string(folder.join("small.toml")).expect("it is there"), PROBLEM);
    }
    // An edited linkage of ours that is not the input may be replaced: its mark is still there.
    fs::write(
        folder.join("mine.toml"),
        String::from_utf8_lossy(&given)
            .replace("\nt1 = 1\n", "\n# my remark\nt1 = 1\n")
            .replace("[linkage]", "# mine\n[linkage]"),
    )
    .expect("there is room");
    let output = linkwright(folder, &["export", "r", "--format", "toml", "--out", "mine.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let forced =
        ["export", "given.toml", "--format", "toml", "--set", "scale=2", "--out", "given.toml", "--force"];
    assert_eq!(linkwright(folder, &forced).status.code(), Some(0));
    assert!(fs::read(folder.join("given.toml")).expect("it is there") != given);
}

#[cfg(unix)]
#[test]
fn links_lead_to_the_same_refusals() {
    use std::os::unix::fs::symlink;
    let place = place();
    let folder = place.path();
    fs::write(folder.join("mine.svg"), "<svg/>").expect("there is room");
    symlink("mine.svg", folder.join("link.svg")).expect("a link");
    symlink("given.toml", folder.join("link.toml")).expect("a link");
    symlink("nowhere.svg", folder.join("dangling.svg")).expect("a link");
    for (arguments, words) in [
        (
            ["export", "r", "--format", "svg", "--out", "link.svg"],
            "is not an SVG drawing that linkwright wrote",
        ),
        (["export", "given.toml", "--format", "toml", "--out", "link.toml"], "is an input"),
        (["export", "link.toml", "--format", "toml", "--out", "given.toml"], "is an input"),
        (["export", "r", "--format", "svg", "--out", "dangling.svg"], "dangling.svg"),
    ] {
        let output = linkwright(folder, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(said(&output).contains(words), "{arguments:?}: {}", said(&output));
    }
    assert_eq!(fs::read_to_string(folder.join("mine.svg")).expect("it is there"), "<svg/>");
    assert!(fs::symlink_metadata(folder.join("dangling.svg")).expect("it is there").is_symlink());
}

#[test]
fn of_several_files_none_is_written_where_one_is_refused() {
    let place = place();
    let folder = place.path();
    fs::write(folder.join("mine.svg"), "<svg/>").expect("there is room");
    let cases: [(&[&str], &str); 3] = [
        (&["analyze", "given.toml", "--csv", "new.csv", "--svg", "mine.svg"], "mine.svg"),
        (&["compare", "r", "--csv", "new.csv", "--html", "mine.svg"], "mine.svg"),
        (&["compare", "r", "--csv", "new.csv", "--html", "./new.csv"], "is named twice"),
    ];
    for (arguments, words) in cases {
        let output = linkwright(folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(said(&output).contains(words), "{}", said(&output));
        assert!(!folder.join("new.csv").exists(), "{arguments:?}");
    }
}

#[test]
fn a_batch_and_a_suite_leave_files_of_a_user_where_their_summaries_go() {
    let place = place();
    let folder = place.path();
    fs::create_dir(folder.join("out")).expect("a folder");
    fs::write(folder.join("out/summary.csv"), "my,own\n1,2\n").expect("there is room");
    fs::write(folder.join("other.toml"), PROBLEM.replace("small", "other")).expect("there is room");
    let batch = ["synth", "small.toml", "other.toml", "--out", "out", "--quiet"];
    let output = linkwright(folder, &batch);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("summary.csv") && said(&output).contains("--out"), "{}", said(&output));
    assert!(!folder.join("out/small").exists(), "it is told before the searches");
    assert_eq!(fs::read_to_string(folder.join("out/summary.csv")).expect("it is there"), "my,own\n1,2\n");
    fs::remove_file(folder.join("out/summary.csv")).expect("it is there");
    for _ in 0..2 {
        assert!(matches!(linkwright(folder, &batch).status.code(), Some(0 | 1)));
    }
    fs::create_dir(folder.join("results")).expect("a folder");
    fs::write(folder.join("results/literature.json"), "{}").expect("there is room");
    let problems = root().join("problems/literature").display().to_string();
    let output = linkwright(folder, &["suite", "--problems", &problems, "--seeds", "1", "--write"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("literature.json"), "{}", said(&output));
    assert_eq!(fs::read_to_string(folder.join("results/literature.json")).expect("it is there"), "{}");
}

#[test]
fn a_folder_of_a_user_in_a_results_folder_stays() {
    let place = place();
    let folder = place.path();
    fs::create_dir(folder.join("r/candidate-9.svg")).expect("a folder");
    fs::write(folder.join("r/candidate-9.svg/thesis.txt"), "two years").expect("there is room");
    let output = linkwright(folder, &["synth", "small.toml", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("a folder candidate-9.svg"), "{}", said(&output));
    let kept = fs::read_to_string(folder.join("r/candidate-9.svg/thesis.txt"));
    assert_eq!(kept.expect("it is there"), "two years");
}

#[test]
fn new_replaces_nothing_unless_it_is_forced() {
    let place = place();
    let folder = place.path();
    let output = linkwright(folder, &["new", "small"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("exists already"), "{}", said(&output));
    assert_eq!(fs::read_to_string(folder.join("small.toml")).expect("it is there"), PROBLEM);
    assert_eq!(linkwright(folder, &["new", "small", "--force"]).status.code(), Some(0));
    assert_ne!(fs::read_to_string(folder.join("small.toml")).expect("it is there"), PROBLEM);
}
