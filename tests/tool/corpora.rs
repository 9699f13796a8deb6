//! What the fuzzer found, and what it starts from, through the readers: no panic.

#[path = "../common/readers.rs"]
pub mod readers;

use crate::common::root;
use std::path::PathBuf;
use std::process::Command;

/// The files of folders, sorted.
fn files(folders: &[&str]) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(root().join(folder)).expect("it is there"))
        .map(|entry| entry.expect("it can be listed").path())
        .filter(|path| path.is_file())
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn read_all(folders: &[&str], reader: fn(&[u8])) {
    for file in files(folders) {
        let bytes = std::fs::read(&file).expect("it can be read");
        let read = std::panic::catch_unwind(|| reader(&bytes));
        assert!(read.is_ok(), "{}", file.display());
    }
}

#[test]
fn problem_files() {
    read_all(&["tests/corpora/problem", "tests/bad"], readers::problem);
}

#[test]
fn settings() {
    read_all(&["tests/corpora/setting"], readers::setting);
}

#[test]
fn linkage_files() {
    read_all(&["tests/corpora/linkage", "tests/bad", "problems/linkages"], readers::linkage);
}

#[test]
fn points_files() {
    read_all(&["tests/corpora/points", "tests/bad"], readers::points);
}

#[test]
fn drawings() {
    read_all(&["tests/corpora/drawing", "tests/bad"], readers::drawing);
}

#[test]
fn records() {
    read_all(&["tests/corpora/record"], readers::record);
}

#[test]
fn checkpoints() {
    read_all(&["tests/corpora/checkpoint"], readers::checkpoint);
    for file in files(&["tests/corpora/checkpoint"]) {
        let text = std::fs::read_to_string(&file).expect("it can be read");
        let document: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
        assert!(!readers::searches_of(&document["state"]).is_empty(), "{}", file.display());
    }
}

/// Remakes the checkpoints that the fuzzer starts from: `cargo test --test tool remake -- --ignored`.
#[test]
#[ignore = "writes into the project"]
fn remake_the_corpus_of_checkpoints() {
    use linkwright::internals::app::job::checkpoint::Writer;
    use linkwright::internals::app::job::run::{Context, run_kept};
    use linkwright::internals::synthesis::keeper::{Keeper, SearchState};
    use std::collections::BTreeSet;
    use std::sync::Mutex;
    use std::time::Duration;
    let folder = root().join("tests/corpora/checkpoint");
    std::fs::create_dir_all(&folder).expect("a folder");
    for (text, _) in readers::SEARCHES {
        let job = readers::search_job(text);
        let writer = Writer::new(&job).expect("it has a digest");
        let written = Mutex::new(Vec::new());
        let sink = |state: &SearchState| written.lock().expect("no panic").push(writer.bytes(state));
        let keeper = Keeper::new(SearchState::default(), Duration::ZERO, &sink);
        let context = Context { cancel: &false.into(), observer: &|_| {} };
        run_kept(&job, &context, Some(&keeper)).expect("it runs");
        let written: Vec<Vec<u8>> = written.into_inner().expect("no panic").into_iter().flatten().collect();
        for at in BTreeSet::from([written.len() / 2, written.len() - 1]) {
            let path = folder.join(format!("{}-{at}.json", job.name));
            std::fs::write(path, &written[at]).expect("there is room");
        }
    }
}

#[test]
fn the_command_refuses_them_or_takes_them_and_never_falls_over() {
    let folders = ["problem", "linkage", "points", "drawing"].map(|name| format!("tests/corpora/{name}"));
    let checked = files(&folders.each_ref().map(String::as_str));
    let ask = |command: &str, files: &[PathBuf]| {
        let mut asked = Command::new(env!("CARGO_BIN_EXE_linkwright"));
        let code = asked.arg(command).args(files).output().expect("it runs").status.code();
        assert!(matches!(code, Some(0..=2)), "{command}: {code:?}");
    };
    ask("check", &checked);
    for record in files(&["tests/corpora/record"]) {
        ask("verify", std::slice::from_ref(&record));
        ask("compare", &[record]);
    }
}
