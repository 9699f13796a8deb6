//! `suite`: problems whose answer is known, from many seeds.

use super::arguments::Suite as Asked;
use super::error::CommandError;
use super::progress::Shown;
use super::{Ended, interrupt, refuse, refuse_at, terminal};
use crate::app::job::folder::{OutputFile, Replace, check_files, write_files};
use crate::app::suite::{Options, Step, literature, suite};
use crate::files::diagnostic::escaped;
use crate::files::generator::FileKind;
use crate::files::problem_file;
use crate::files::problem_file::ProblemFile;
use crate::record::suite::Suite;
use crate::report::suite::{suite_markdown, suite_text};
use crate::task::spec::CertifySpec;
use ariadne::ReportKind;
use std::path::{Path, PathBuf};

/// The folder of the literature's problems in the repository.
const PROBLEMS: &str = "problems/literature";
/// Where the page goes.
const RESULTS: &str = "results";
const PAGE: &str = "literature.md";
const DATA: &str = "literature.json";

/// Runs the command.
pub fn run(asked: &Asked) -> Result<Ended, Ended> {
    let problems = problems(asked)?;
    // The place is looked at before anything runs: one that cannot be written to costs no search.
    let place = asked.write.then(|| Place::take(Path::new(RESULTS), asked.force)).transpose();
    let place = place.map_err(refuse)?;
    let certify = asked.certify.then(CertifySpec::default);
    let options = Options { seeds: asked.seeds, command: command(asked), certify, ..Options::default() };
    let cancel = interrupt::watch("showing the runs that are over");
    let shown = Shown::of_suite();
    let outcome = suite(&problems, &options, cancel, &|step: &Step<'_>| shown.suite(step));
    shown.finish();
    let suite = outcome.map_err(refuse)?;
    let json = serde_json::to_string_pretty(&suite)
        .map_err(|e| refuse(format!("the suite cannot be written as JSON: {e}")))?
        + "\n";
    if asked.json {
        terminal::answer(&json);
    } else {
        terminal::answer(&suite_text(&suite, terminal::colour()));
    }
    if let Some(place) = place.filter(|_| suite.complete) {
        place.write(&suite, &json).map_err(refuse)?;
        if !asked.json {
            terminal::answer(&format!("\n  Written to {RESULTS}/{PAGE} and {RESULTS}/{DATA}\n"));
        }
    }
    if !suite.complete {
        let more = if asked.write { "; nothing was written" } else { "" };
        terminal::tell(&format!("{}{more}", done(&suite, &options, problems.len())));
        return Err(Ended::Interrupted);
    }
    Ok(if suite.is_accepted() { Ended::Good } else { Ended::Bad })
}

/// How far an interrupted suite came.
fn done(suite: &Suite, options: &Options, problems: usize) -> String {
    let runs: usize = suite
        .problems
        .iter()
        .flat_map(|p| std::iter::once(&p.search).chain(&p.populations))
        .map(|method| method.runs.len())
        .sum();
    format!("{runs} of {} runs are done", options.runs(problems))
}

/// The command that makes the same suite again.
fn command(asked: &Asked) -> String {
    let quoted = |text: &str| {
        let plain = |c: char| c.is_alphanumeric() || "/._-".contains(c);
        if !text.is_empty() && text.chars().all(plain) {
            text.to_owned()
        } else {
            format!("'{}'", text.replace('\'', r"'\''"))
        }
    };
    let here = asked.write || folder(asked).is_some();
    let mut command = String::from(if here { "cargo run --release -- suite" } else { "linkwright suite" });
    if let Some(filter) = &asked.filter {
        command.push_str(&format!(" {}", quoted(filter)));
    }
    if let Some(folder) = &asked.problems {
        command.push_str(&format!(" --problems {}", quoted(&folder.display().to_string())));
    }
    command.push_str(&format!(" --seeds {}", asked.seeds));
    if asked.certify {
        command.push_str(" --certify");
    }
    if asked.write {
        command.push_str(" --write");
    }
    command
}

/// Problems with the names of their files.
type Named = Vec<(String, ProblemFile)>;

/// The folder of the problems: the one that was named, or that of the literature where it is here; `None` where the
/// program's own are run.
fn folder(asked: &Asked) -> Option<&Path> {
    let here = Path::new(PROBLEMS);
    asked.problems.as_deref().or_else(|| here.is_dir().then_some(here))
}

/// The problems of a folder, by file name.
fn of_folder(folder: &Path) -> Result<Named, Ended> {
    let files = files(folder).map_err(|e| {
        let shown = escaped(&folder.display().to_string());
        let remedy =
            "name another with --problems, or leave it out for the problems that linkwright has in it";
        refuse(format!("the folder of problems {shown} cannot be read: {e}; {remedy}"))
    })?;
    let mut found = Vec::new();
    let mut refused = None;
    for path in files {
        match problem_file::load(&path, &[]) {
            Ok(problem) => {
                let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
                found.push((stem.unwrap_or_default(), problem));
            }
            Err(diagnostic) => refused = Some(refuse_at(diagnostic)),
        }
    }
    refused.map_or(Ok(found), Err)
}

/// The problems of the literature, which the program holds.
fn built_in() -> Result<Named, Ended> {
    let problems = literature::problems().map_err(refuse_at)?.into_iter();
    Ok(problems.map(|(name, problem)| (name.trim_end_matches(".toml").to_owned(), problem)).collect())
}

/// The problems that are asked for, by file name.
fn problems(asked: &Asked) -> Result<Vec<ProblemFile>, Ended> {
    let folder = folder(asked);
    let shown = match folder {
        Some(folder) => escaped(&folder.display().to_string()),
        None => "the literature".to_owned(),
    };
    let mut known = folder.map_or_else(built_in, of_folder)?;
    known.retain(|(_, problem)| problem.expect.as_ref().is_some_and(|e| e.best_known_sum_sq.is_some()));
    if known.is_empty() {
        return Err(refuse(format!("no problem in {shown} has an [expect] table with best_known_sum_sq")));
    }
    let names: Vec<String> = known.iter().map(|(_, problem)| problem.name.clone()).collect();
    let filter = asked.filter.as_deref().unwrap_or_default();
    known.retain(|(stem, problem)| problem.name.contains(filter) || stem.contains(filter));
    if known.is_empty() {
        let names = names.join(", ");
        return Err(refuse(format!("no problem in {shown} has {filter:?} in its name; there are {names}")));
    }
    for warning in known.iter().flat_map(|(_, problem)| &problem.warnings) {
        terminal::diagnose(ReportKind::Warning, warning);
    }
    Ok(known.into_iter().map(|(_, problem)| problem).collect())
}

/// The TOML files of a folder, sorted.
fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
            files.push(path);
        }
    }
    // By the name without its ending, so that a.toml stands before a-b.toml.
    files.sort_by(|one, other| one.file_stem().cmp(&other.file_stem()));
    Ok(files)
}

/// Where the page and its JSON go: a folder that can be written to, taken away again if it was made for them
/// and they were not written.
struct Place {
    folder: PathBuf,
    made: bool,
    replace: Replace<'static>,
}

impl Place {
    fn take(folder: &Path, force: bool) -> Result<Self, CommandError> {
        let made = !folder.exists();
        let path = || folder.display().to_string();
        std::fs::create_dir_all(folder).map_err(|source| CommandError::Io { path: path(), source })?;
        let replace = if force { Replace::Anything } else { Replace::Ours(&[]) };
        let place = Place { folder: folder.into(), made, replace };
        let [data, page] = [DATA, PAGE].map(|name| folder.join(name));
        check_files(&outputs((&data, ""), (&page, "")), replace)?;
        tempfile::tempfile_in(folder).map_err(|source| CommandError::NotWritable { path: path(), source })?;
        Ok(place)
    }

    fn write(&self, suite: &Suite, json: &str) -> Result<(), CommandError> {
        let page = suite_markdown(suite);
        let [data_at, page_at] = [DATA, PAGE].map(|name| self.folder.join(name));
        Ok(write_files(&outputs((&data_at, json), (&page_at, &page)), self.replace)?)
    }
}

/// The suite's two files.
fn outputs<'a>(data: (&'a Path, &'a str), page: (&'a Path, &'a str)) -> [OutputFile<'a>; 2] {
    let file = |(path, text): (&'a Path, &'a str), kind| OutputFile { path, kind, bytes: text.as_bytes() };
    [file(data, FileKind::SuiteJson), file(page, FileKind::SuiteMarkdown)]
}

impl Drop for Place {
    fn drop(&mut self) {
        if self.made {
            // A folder that holds something is not removed.
            let _ = std::fs::remove_dir(&self.folder);
        }
    }
}
