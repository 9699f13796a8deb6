//! Inputs of `synth`: files and folders of problem files, each with the folder of its result.

use super::arguments::Synth;
use super::error::CommandError;
use super::terminal;
use crate::app::inputs::toml_files;
use crate::app::job::folder::FolderError;
use crate::app::job::run::Job;
use crate::files::input_text;
use crate::files::problem_file;
use crate::files::problem_file::ProblemFile;
use ariadne::ReportKind;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The usual folder of results.
pub const RESULTS: &str = "results";
/// The most files of a folder.
const MOST_FILES: usize = 100_000;

/// One thing to run.
pub struct Input {
    /// The file as it was named, or the folder that names none.
    pub file: String,
    /// The job and its folder; an error has been reported.
    pub job: Result<(Job, PathBuf), CommandError>,
}

/// Reads everything that is to be run, in the order in which it was named, the files of a folder by name. Faults of a
/// file are reported at once. Also returns whether the inputs are a batch.
pub fn load(options: &Synth) -> (Vec<Input>, bool) {
    let mut files = Vec::new();
    for path in &options.files {
        if !path.is_dir() {
            files.push((path.clone(), None));
            continue;
        }
        match problem_files(path) {
            Ok(found) => files.extend(found.into_iter().map(|file| (file, None))),
            Err(why) => files.push((path.clone(), Some(why))),
        }
    }
    let mut overrides = options.set.clone();
    overrides.extend(options.method.iter().map(|method| ("solve.method".into(), method.clone())));
    overrides.extend(options.search.seed.iter().map(|seed| ("solve.seed".into(), seed.to_string())));
    overrides.extend(options.no_advice.then(|| ("solve.advice".into(), "false".into())));
    let several = files.len() > 1 || options.files.iter().any(|path| path.is_dir());
    // The file that writes to each folder.
    let mut taken = BTreeMap::new();
    let input = |(path, why): (PathBuf, Option<CommandError>)| {
        let file = path.display().to_string();
        let problem = why.map_or_else(|| Ok(problem_file::load_any(&path, &overrides)?), Err);
        let job = problem.and_then(|problem| job(options, problem, several, &file, &mut taken));
        match &job {
            Err(CommandError::Problem(diagnostic)) => terminal::diagnose(ReportKind::Error, diagnostic),
            Err(why) => terminal::complain(&why.to_string()),
            Ok(_) => {}
        }
        Input { file, job }
    };
    (files.into_iter().map(input).collect(), several)
}

/// Returns the job of a problem and its folder, which no file before it has taken.
fn job(
    options: &Synth,
    problem: ProblemFile,
    several: bool,
    file: &str,
    taken: &mut BTreeMap<PathBuf, String>,
) -> Result<(Job, PathBuf), CommandError> {
    if let Some(front) = &options.front {
        front.check_loads(&problem.spec)?;
    }
    for warning in &problem.warnings {
        terminal::diagnose(ReportKind::Warning, warning);
    }
    let place = match &options.out {
        Some(out) if !several => out.clone(),
        _ => folder_of_all(options).join(&problem.name),
    };
    if let Some(one) = taken.get(&place) {
        let (one, other) = (one.clone(), file.to_owned());
        return Err(CommandError::SamePlace { one, other, place: place.display().to_string() });
    }
    taken.insert(place.clone(), file.to_owned());
    Ok((Job { front: options.front.clone(), ..problem.into() }, place))
}

/// Returns the folder for the summary of a batch.
pub fn folder_of_all(options: &Synth) -> &Path {
    options.out.as_deref().unwrap_or(Path::new(RESULTS))
}

/// Lists the problem files of a folder, by name: every `*.toml` in it, not below, but for those that say of themselves
/// that they are something else. These are named in a warning.
fn problem_files(folder: &Path) -> Result<Vec<PathBuf>, CommandError> {
    let shown = terminal::shown(folder);
    let unreadable = |source| FolderError::Io { path: folder.display().to_string(), source };
    let mut files = toml_files(folder).map_err(unreadable)?;
    files.retain(|path| !path.is_dir());
    if files.len() > MOST_FILES {
        return Err(CommandError::TooMany { folder: shown, most: MOST_FILES });
    }
    let (others, problems): (Vec<_>, Vec<_>) = files.into_iter().partition(|path| is_something_else(path));
    for other in others {
        terminal::tell(&format!(
            "warning: {} is no problem file (it has no [task]): skipped",
            terminal::shown(&other)
        ));
    }
    if problems.is_empty() {
        return Err(CommandError::NoProblems(shown));
    }
    Ok(problems)
}

/// Returns whether a file can be read as TOML and has no task. An unreadable file is not passed over in silence.
fn is_something_else(path: &Path) -> bool {
    let Ok(text) = input_text::read(path) else { return false };
    text.trim_start_matches('\u{feff}').parse::<toml::Table>().is_ok_and(|table| !table.contains_key("task"))
}
