//! What several test files need: the shipped problems and a run.

#![allow(dead_code, reason = "every test file uses its own part of it")]

pub mod thorough;

use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::problem_file;
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::record::Record;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every file below `problems/` with this extension.
pub fn shipped(extension: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["literature", "examples", "exact", "linkages", "seeds"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(root().join("problems").join(folder)).expect("it is there"))
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

/// A problem of `problems/literature` with keys set.
pub fn literature(name: &str, set: &[(&str, &str)]) -> ProblemFile {
    load(&root().join(format!("problems/literature/{name}.toml")), set)
}

/// A problem file with keys set.
pub fn load(path: &Path, set: &[(&str, &str)]) -> ProblemFile {
    let overrides: Vec<_> = set.iter().map(|(k, v)| ((*k).to_string(), (*v).to_string())).collect();
    problem_file::load(path, &overrides).unwrap_or_else(|e| panic!("{e}"))
}

/// A problem from its text.
pub fn parse(text: &str) -> ProblemFile {
    problem_file::parse("test.toml", text, None, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// The job of a problem file.
pub fn job(file: ProblemFile) -> Job {
    Job::from(file)
}

/// Runs a problem on this many threads.
pub fn run_on(threads: usize, file: ProblemFile) -> Record {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    pool.install(|| run(&job(file), &context)).expect("it runs").record
}

/// A record's bytes as they stand on disk.
pub fn bytes(record: &Record) -> String {
    serde_json::to_string_pretty(record).expect("a record is JSON")
}
