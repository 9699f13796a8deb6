//! What `synth` is given: files, and folders of problem files; and where the result of each goes.

use super::arguments::Synth;
use super::terminal;
use crate::app::run::Job;
use crate::files::diagnostic::escaped;
use crate::files::input_text;
use crate::files::problem_file;
use crate::files::problem_file::ProblemFile;
use ariadne::ReportKind;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs;
use std::path::{Path, PathBuf};

/// Where results go when nothing is said.
pub const RESULTS: &str = "results";
/// The most files of a folder.
const MOST_FILES: usize = 100_000;

/// One thing to run.
pub struct Input {
    /// The file as it was named, or the folder that names none.
    pub file: String,
    /// The job and its folder, or why there is none; the reason has been told.
    pub job: Result<(Job, PathBuf), String>,
}

/// Reads everything that is to be run, in the order in which it was named, the files of a folder by name. What is
/// wrong with a file is told at once.
pub fn load(options: &Synth) -> Vec<Input> {
    let mut files = Vec::new();
    for path in &options.files {
        if !path.is_dir() {
            files.push(Ok(path.clone()));
            continue;
        }
        match problem_files(path) {
            Ok(found) => files.extend(found.into_iter().map(Ok)),
            Err(why) => files.push(Err((path.clone(), why))),
        }
    }
    let mut overrides = options.set.clone();
    overrides.extend(options.method.iter().map(|method| ("solve.method".into(), method.clone())));
    overrides.extend(options.seed.iter().map(|seed| ("solve.seed".into(), seed.to_string())));
    overrides.extend(options.no_advice.then(|| ("solve.advice".into(), "false".into())));
    let several = files.len() > 1 || options.files.iter().any(|path| path.is_dir());
    let mut inputs: Vec<Input> = Vec::new();
    // Which file writes to which folder.
    let mut taken: BTreeMap<PathBuf, String> = BTreeMap::new();
    for file in files {
        let (path, why) = match file {
            Ok(path) => (path, None),
            Err((path, why)) => (path, Some(why)),
        };
        let file = path.display().to_string();
        if let Some(why) = why {
            terminal::complain(&why);
            inputs.push(Input { file, job: Err(why) });
            continue;
        }
        let job = match problem_file::load_any(&path, &overrides) {
            Ok(problem) => {
                for warning in &problem.warnings {
                    terminal::diagnose(ReportKind::Warning, warning);
                }
                let place = place(options, &problem, several);
                match taken.entry(place.clone()) {
                    Entry::Occupied(other) => {
                        let why = format!(
                            "{} and {file} would both write to {}; give them different names (key `name`)",
                            other.get(),
                            place.display()
                        );
                        terminal::complain(&why);
                        Err(why)
                    }
                    Entry::Vacant(free) => {
                        free.insert(file.clone());
                        Ok((problem.into(), place))
                    }
                }
            }
            Err(diagnostic) => {
                terminal::diagnose(ReportKind::Error, &diagnostic);
                Err(diagnostic.message.clone())
            }
        };
        inputs.push(Input { file, job });
    }
    inputs
}

/// Where the summary of a batch goes.
pub fn folder_of_all(options: &Synth) -> &Path {
    options.out.as_deref().unwrap_or(Path::new(RESULTS))
}

fn place(options: &Synth, problem: &ProblemFile, several: bool) -> PathBuf {
    match &options.out {
        Some(out) if !several => out.clone(),
        _ => folder_of_all(options).join(&problem.name),
    }
}

/// The problem files of a folder, by name: every `*.toml` in it, not below, but for those that say of themselves that
/// they are something else. These are named in a warning.
fn problem_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let shown = escaped(&folder.display().to_string());
    let entries = fs::read_dir(folder).map_err(|e| format!("{shown}: {e}"))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| format!("{shown}: {e}"))?.path();
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) && !path.is_dir() {
            files.push(path);
        }
        if files.len() > MOST_FILES {
            return Err(format!("{shown} holds more than {MOST_FILES} problem files; give some of them"));
        }
    }
    files.sort();
    let (problems, others): (Vec<_>, Vec<_>) = files.into_iter().partition(|path| !is_something_else(path));
    for other in others {
        terminal::tell(&format!(
            "warning: {} is no problem file (it has no [task]): skipped",
            escaped(&other.display().to_string())
        ));
    }
    if problems.is_empty() {
        return Err(format!("the folder {shown} holds no problem file (*.toml with a [task])"));
    }
    Ok(problems)
}

/// Whether a file can be read as TOML and has no task. What cannot be read is not passed over in silence.
fn is_something_else(path: &Path) -> bool {
    let Ok(text) = input_text::read(path) else { return false };
    text.trim_start_matches('\u{feff}').parse::<toml::Table>().is_ok_and(|table| !table.contains_key("task"))
}
