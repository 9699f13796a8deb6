//! A remedy that a message names is one that the reader takes.

use crate::common::root;
use linkwright::internals::files::problem_file;
use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// `table.key = "word"` in the strings of a line of source: dotted keys of a problem file with a word as their value.
fn settings(line: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (at, _) in line.match_indices(" = \\\"") {
        let key: String =
            line[..at].chars().rev().take_while(|c| c.is_ascii_lowercase() || "._".contains(*c)).collect();
        let key: String = key.chars().rev().collect();
        let value: String =
            line[at + 5..].chars().take_while(|c| c.is_ascii_lowercase() || *c == '-').collect();
        let closed = line[at + 5 + value.len()..].starts_with("\\\"");
        if closed && !value.is_empty() && !key.is_empty() {
            found.push((key, value));
        }
    }
    found
}

/// Words that a message of our own names for a key; the tables that it may stand in.
const TABLES: [&str; 7] =
    ["", "solve.", "design.", "require.", "task.path.", "task.path.timing.", "task.function."];

/// Whether a reader takes a word for a key; in a problem that is made for it where the word asks for one.
fn is_taken(key: &str, value: &str) -> bool {
    let free = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1], [4, 0]]\n";
    let timed = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1], [4, 0]]\n\
        [task.path.timing]\ncrank_deg = [0, 20, 40, 60, 80]\n[solve]\nmethod = \"genetic\"\n";
    let nine = "format = 1\n[task.path]\npoints = [[0.25, 0], [0.52, 0.1], [0.8, 0.7], [1.2, 1], [1.4, 1.3], [1.1, 1.48], \
        [0.7, 1.4], [0.2, 1], [0.02, 0.4]]\n";
    let function = "format = 1\n[task.function]\ninput_deg = [0, 10, 20, 30]\noutput_deg = [0, 2, 5, 9]\n";
    TABLES.iter().any(|table| {
        let set = [(format!("{table}{key}"), value.to_owned())];
        [free, timed, nine, function]
            .iter()
            .any(|text| problem_file::parse("it.toml", text, None, &set).is_ok())
    })
}

/// Keys in messages that are no keys of a problem file: of loads, names of bodies and joints.
const OTHERS: [&str; 5] = ["view", "name", "svg_id", "body", "from"];

#[test]
fn every_remedy_that_sets_a_word_is_accepted_by_the_reader() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    files.sort();
    let mut count = 0;
    for file in files {
        let text = fs::read_to_string(&file).expect("it can be read");
        // Messages stand before the tests of a file.
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let line = line.replace("\\n", " ");
            for (key, value) in settings(&line) {
                if OTHERS.contains(&key.as_str()) {
                    continue;
                }
                count += 1;
                assert!(is_taken(&key, &value), "{}: {key} = \"{value}\" is refused", file.display());
            }
        }
    }
    assert!(count >= 8, "only {count} remedies were seen");
}

#[test]
fn a_remedy_that_is_refused_is_seen() {
    let line = "\"it needs require.circuit = \\\"same\\\"\"";
    assert_eq!(settings(line), [("require.circuit".to_owned(), "same".to_owned())]);
    assert!(!is_taken("require.circuit", "same"));
    assert!(is_taken("require.circuit", "one") && is_taken("circuit", "any"));
}
