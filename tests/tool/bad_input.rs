//! Every broken file under `tests/bad` is refused with exactly the words that stand beside it in `.expected`.
//!
//! To word a message anew, change it, run this test, read what it says and put that into
//! the `.expected` file.

use linkwright::internals::files::diagnostic::Diagnostic;
use linkwright::internals::files::{linkage_file, points_file, problem_file};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// What lies in tests/bad because bad files name it.
const GOOD: [&str; 2] = ["good-points.csv", "good-drawing.svg"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad")
}

/// What a person is told about a file: read as what its name says it is.
fn refusal(path: &Path) -> Option<Box<Diagnostic>> {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    if name.starts_with("linkage-") {
        linkage_file::load(path).err()
    } else if name.ends_with(".csv") || name.ends_with(".svg") {
        problem_file::from_points_file(path, &[]).err()
    } else {
        problem_file::load(path, &[]).err()
    }
}

#[test]
fn every_bad_file_is_refused_in_the_expected_words() {
    let (mut wrong, mut count) = (String::new(), 0);
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() || name.ends_with(".expected") || GOOD.contains(&name.as_str()) {
            continue;
        }
        count += 1;
        let Some(diagnostic) = refusal(&path) else {
            writeln!(wrong, "--- {name} was accepted").unwrap();
            continue;
        };
        // The folder of the checkout is no part of the words.
        let prefix = format!("{}{}", folder().display(), std::path::MAIN_SEPARATOR);
        let shown = diagnostic.to_string().replace(&prefix, "") + "\n";
        let expected = std::fs::read_to_string(folder().join(format!("{name}.expected"))).unwrap_or_default();
        if shown != expected.replace("\r\n", "\n") {
            writeln!(wrong, "--- {name}\n{shown}--- expected\n{expected}").unwrap();
        }
        let printable = |c: char| c == '\n' || !c.is_control();
        assert!(diagnostic.to_string().chars().all(printable), "{name} reaches the terminal raw");
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(count > 120, "only {count} bad files were found");
}

fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// The message and the remedy, without the place.
fn words(diagnostic: &Diagnostic) -> (&str, &str) {
    (&diagnostic.message, diagnostic.help.as_deref().unwrap_or_default())
}

#[test]
fn a_file_over_the_limit_is_refused_before_it_is_read() {
    let (_folder, path) = written("large.csv", b"x,y\n");
    std::fs::File::options().write(true).open(&path).unwrap().set_len(40 << 20).unwrap();
    let diagnostic = points_file::load(&path).unwrap_err();
    assert_eq!(diagnostic.message, "the file has 40 MB; at most 16 MB are read");
    assert!(diagnostic.text.is_empty());
    assert_eq!(problem_file::load(&path, &[]).unwrap_err().message, diagnostic.message);
    assert_eq!(linkage_file::load(&path).unwrap_err().message, diagnostic.message);
}

#[test]
fn a_folder_and_a_missing_file_are_named_as_such() {
    let folder = tempfile::tempdir().unwrap();
    for result in [problem_file::load(folder.path(), &[]), problem_file::from_points_file(folder.path(), &[])]
    {
        assert!(result.unwrap_err().message.contains("folder"));
    }
    let missing = folder.path().join("nowhere.toml");
    let diagnostic = problem_file::load(&missing, &[]).unwrap_err();
    assert_eq!(words(&diagnostic), ("there is no such file", "check the spelling and the folder you are in"));
    assert_eq!(diagnostic.file, missing.display().to_string());
}

#[test]
fn text_that_is_not_utf8_is_refused_with_its_line() {
    let (_folder, path) = written("latin1.csv", b"x,y\n0,0\n# gr\xf6\xdfe\n1,1\n");
    let diagnostic = points_file::load(&path).unwrap_err();
    assert_eq!(diagnostic.message, "line 3 holds the byte 0xf6, which is not UTF-8 text");
    let (_folder, path) = written("utf16.toml", &[0xff, 0xfe, b'f', 0, b'o', 0]);
    assert_eq!(
        problem_file::load(&path, &[]).unwrap_err().message,
        "the file is in UTF-16, which is not read"
    );
}

fn many_points(count: usize, separator: &str) -> String {
    (0..count).map(|i| format!("{i}{separator}{}", i % 7)).collect::<Vec<_>>().join("\n")
}

#[test]
fn more_than_100_000_points_are_refused_and_100_000_are_not() {
    let csv = |count| format!("x,y\n{}\n", many_points(count, ","));
    assert_eq!(points_file::parse("p.csv", &csv(100_000)).unwrap().points.len(), 100_000);
    let diagnostic = points_file::parse("p.csv", &csv(100_001)).unwrap_err();
    assert_eq!(diagnostic.message, "there are more than 100000 points");
    assert_eq!(diagnostic.line_column(), Some((100_002, 1)));

    let rows = many_points(100_001, ", ").replace('\n', "], [");
    let text = format!("format = 1\n[task.path]\npoints = [[{rows}]]\n");
    let diagnostic = problem_file::parse("p.toml", &text, None, &[]).unwrap_err();
    assert_eq!(diagnostic.message, "100001 points; at most 100000 are read");
    assert!(diagnostic.to_string().len() < 500, "a long line is not cut");
}

const GOOD_TEXT: &str = "format = 1\n[task.path]\npoints = [[0, 0], [2, 1]]\n";

fn with_override(key: &str, value: &str) -> Box<Diagnostic> {
    problem_file::parse("arm.toml", GOOD_TEXT, None, &[(key.into(), value.into())]).unwrap_err()
}

#[test]
fn an_override_gets_the_same_diagnostics_as_the_file() {
    let shown = |key, value| with_override(key, value).to_string();
    assert_eq!(
        shown("solve.seed", "x"),
        "arm.toml with --set solve.seed=x:6:8: expected a whole number, 0 or more, found the text \"x\"\n\
         6 | seed = \"x\"\n  |        ^^^"
    );
    assert!(shown("design.a", "[5, 1]").contains("write [1, 5]"));
    assert!(shown("solve.sed", "1").contains("did you mean `seed`?"));
    assert!(shown("solve.method", "continuation").contains("exactly 9 points, this path has 2"));
    assert!(shown("task.motion.poses", "[]").contains("two tasks"));
    assert!(shown("name", "../arm").contains("the name is a path"));
    assert!(shown("name", "\u{1b}[31m").contains("--set name=\\x1b[31m"));
}

#[test]
fn an_override_that_names_no_key_is_refused() {
    for (key, message) in [
        ("", "\"\" is not a key"),
        ("solve..seed", "\"solve..seed\" is not a key"),
        ("format.seed", "\"format\" in \"format.seed\" is a value, not a table"),
        ("task.path", "\"task.path\" is a table, not a value"),
    ] {
        assert_eq!(with_override(key, "1").message, message);
    }
}

#[test]
fn a_points_file_is_refused_where_there_is_no_folder() {
    let svg = "format = 1\n[task.path]\nsvg = \"drawing.svg\"\n";
    assert!(problem_file::parse("studio", svg, None, &[]).unwrap_err().message.contains("no folder"));
    let text = "format = 1\n[task.path]\nfile = \"points.csv\"\n";
    let diagnostic = problem_file::parse("studio", text, None, &[]).unwrap_err();
    assert!(diagnostic.message.contains("no folder"));
}

#[cfg(unix)]
#[test]
fn a_link_that_leaves_the_folder_is_refused_unless_it_is_typed() {
    let outside = tempfile::tempdir().unwrap();
    let secret = outside.path().join("secret.csv");
    std::fs::write(&secret, "x,y\n0,0\n3,4\n").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("points.csv");
    std::os::unix::fs::symlink(&secret, &link).unwrap();
    let problem = folder.path().join("arm.toml");
    std::fs::write(&problem, "format = 1\n[task.path]\nfile = \"points.csv\"\n").unwrap();
    let refused = problem_file::load(&problem, &[]).unwrap_err();
    assert_eq!(refused.message, "the points file lies outside the folder of the problem file: it is a link");
    // What a person types is meant.
    let typed = [("task.path.file".to_string(), secret.display().to_string())];
    assert_eq!(problem_file::load(&problem, &typed).unwrap().spec.task.points.len(), 2);
    assert_eq!(problem_file::from_points_file(&link, &[]).unwrap().spec.task.points.len(), 2);
    // A link that stays inside is a file like any other.
    std::fs::write(folder.path().join("here.csv"), "x,y\n0,0\n3,4\n").unwrap();
    std::fs::remove_file(&link).unwrap();
    std::os::unix::fs::symlink("here.csv", &link).unwrap();
    assert!(problem_file::load(&problem, &[]).is_ok());
}
