//! The house as lib.rs draws it: which room may use which.

use crate::common::root;
use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("it is there") {
        let path = entry.expect("it can be read").path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// The rooms of the crate that a file's code names.
fn used(path: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(path).expect("it is text");
    // Tests may use what they like: those at a file's end, and files that are compiled for tests alone.
    if text.contains("\n#![cfg(test)]\n") {
        return Vec::new();
    }
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(&text);
    let mut rooms = Vec::new();
    for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
        for part in line.split("crate::").skip(1) {
            // `use crate::{linkage, task::..}` names several at once.
            let names: Vec<&str> = match part.strip_prefix('{') {
                Some(list) => list.trim_end_matches(|c: char| "};".contains(c)).split(", ").collect(),
                None => vec![part],
            };
            for name in names {
                let room: String = name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                if !room.is_empty() {
                    rooms.push(room);
                }
            }
        }
    }
    rooms
}

#[test]
fn every_room_uses_only_what_the_picture_allows() {
    let allowed: &[(&str, &[&str])] = &[
        ("linkage", &["linkage"]),
        ("task", &["task", "linkage"]),
        ("solve", &["solve"]),
        ("exact", &["exact", "linkage", "task", "solve"]),
        ("problem", &["problem", "task", "linkage", "solve", "resampling"]),
        ("resampling.rs", &[]),
        ("svg_file.rs", &["diagnostic", "input_text", "linkage", "record"]),
        ("svg_file", &["diagnostic", "task", "toml_text"]),
        ("search", &["search", "problem", "task", "linkage", "solve", "exact", "assess", "record"]),
        (
            "report",
            &[
                "report",
                "generator",
                "linkage",
                "linkage_file",
                "task",
                "problem",
                "record",
                "analysis",
                "suite",
                "plates",
                "practicality",
                "snap",
            ],
        ),
        ("published.rs", &["assess", "linkage", "problem", "problem_file", "record", "search"]),
        ("suite.rs", &["problem", "problem_file", "published", "record", "run", "search"]),
        ("suite", &["diagnostic", "problem_file", "record"]),
        ("analysis.rs", &["linkage", "record"]),
        ("analysis", &["linkage", "record"]),
        ("export.rs", &["analysis", "generator", "linkage", "linkage_file", "report"]),
        (
            "export",
            &["generator", "linkage", "linkage_file", "name", "plates", "record", "report", "toml_text"],
        ),
        ("plates.rs", &["linkage"]),
        ("plates", &["linkage"]),
        ("record.rs", &["linkage", "task", "problem"]),
        ("record", &["linkage", "task", "problem"]),
        ("assess.rs", &["linkage", "task", "problem", "record"]),
        ("run.rs", &["assess", "certificate", "problem", "record", "search", "solve", "task"]),
        ("live.rs", &["assess", "problem", "record", "search"]),
        ("live", &["exact", "problem", "record", "search"]),
        ("checkpoint.rs", &["record", "run", "search"]),
        ("verify.rs", &["assess", "linkage", "problem", "record", "run", "search", "task"]),
        ("verify", &["assess", "certificate", "linkage", "problem", "record", "search"]),
        ("given.rs", &["linkage_file", "record", "results_folder"]),
        (
            "measured.rs",
            &[
                "assess",
                "diagnostic",
                "given",
                "linkage",
                "linkage_file",
                "problem",
                "problem_file",
                "record",
                "report",
                "run",
                "search",
                "task",
                "verify",
            ],
        ),
        ("result_files.rs", &["linkage_file", "name", "record", "report", "results_folder", "run"]),
        (
            "saved_run.rs",
            &[
                "certificate",
                "checkpoint",
                "record",
                "report",
                "result_files",
                "results_folder",
                "run",
                "search",
            ],
        ),
        ("results_folder.rs", &["record"]),
        ("results_folder", &["generator"]),
        ("generator.rs", &[]),
        ("practicality.rs", &[]),
        ("practicality", &["linkage", "plates", "problem", "record", "task"]),
        ("snap.rs", &["assess", "linkage", "practicality", "problem", "record", "run", "search", "task"]),
        ("snap", &["assess", "linkage", "practicality", "problem", "record", "run", "search", "task"]),
        ("certificate", &["linkage", "problem", "record", "task"]),
        (
            "studio",
            &[
                "assess",
                "diagnostic",
                "export",
                "given",
                "linkage",
                "linkage_file",
                "live",
                "measured",
                "name",
                "points_file",
                "problem",
                "problem_file",
                "record",
                "report",
                "results_folder",
                "run",
                "saved_run",
                "search",
                "studio",
                "svg_file",
                "verify",
            ],
        ),
        ("diagnostic.rs", &[]),
        ("name.rs", &[]),
    ];
    for (room, may) in allowed {
        let path = root().join("src").join(room);
        let files = if path.is_dir() { sources(&path) } else { vec![path] };
        for file in files {
            for name in used(&file) {
                assert!(may.contains(&name.as_str()), "{} uses crate::{name}", file.display());
            }
        }
    }
}

#[test]
fn the_command_line_stays_in_its_room() {
    for file in sources(&root().join("src")) {
        let inside = file.components().any(|c| c.as_os_str() == "cli");
        let text = std::fs::read_to_string(&file).expect("it is text");
        for name in ["clap", "indicatif", "ctrlc", "ariadne"] {
            let names_it = text.lines().any(|l| {
                let l = l.trim_start();
                !l.starts_with("//")
                    && (l.contains(&format!("{name}::")) || l.contains(&format!("use {name}")))
            });
            assert!(inside || !names_it, "{} names {name}", file.display());
        }
    }
}

#[test]
fn argmin_and_clarabel_are_named_in_one_file_each_and_unsafe_code_stands_in_one() {
    for file in sources(&root().join("src")) {
        let text = std::fs::read_to_string(&file).expect("it is text");
        let code = |line: &&str| !line.trim_start().starts_with("//");
        let has = |word: &str| text.lines().filter(code).any(|line| line.contains(word));
        let is = |name: &str| file.ends_with(name);
        assert!(
            !has("argmin::") || is("argmin_bridge.rs") || is("population_tests.rs"),
            "{}",
            file.display()
        );
        assert!(!has("clarabel::") || is("conic.rs"), "{}", file.display());
        assert!(!has("unsafe ") || is("dispatch.rs"), "{}", file.display());
    }
    let main = std::fs::read_to_string(root().join("src/main.rs")).expect("it is text");
    assert!(main.lines().count() < 40);
}
