//! `suite`: problems whose answer is known, from many seeds.

use super::arguments::Suite as Asked;
use super::output::Output;
use super::progress::Shown;
use super::{Ended, interrupt, refuse, refuse_at, refuse_io, terminal};
use crate::app::suite::choice::{LITERATURE, NoProblems, chosen, collection};
use crate::app::suite::{Options, Step, suite};
use crate::files::generator::FileKind;
use crate::files::problem_file::ProblemFile;
use crate::record::suite::Suite;
use crate::report::suite::{suite_markdown, suite_text};
use crate::task::spec::CertifySpec;
use ariadne::ReportKind;
use std::path::{Path, PathBuf};

/// The folder of the literature's problems in the repository.
const PROBLEMS: &str = "problems/literature";
/// The folder of the page and its JSON.
const RESULTS: &str = "results";

/// Runs the command.
pub fn run(asked: &Asked) -> Result<Ended, Ended> {
    let problems = problems(asked)?;
    // The place is looked at before anything runs: one that cannot be written to costs no search.
    let collection = asked.problems.as_deref().and_then(collection);
    let name = collection.clone().unwrap_or_else(|| LITERATURE.to_owned());
    let place = asked.write.then(|| Place::take(name, asked.force)).transpose()?;
    let certify = asked.certify.then(CertifySpec::default);
    let command = command(asked);
    let options = Options { seeds: asked.seeds, command, collection, certify, ..Options::default() };
    let cancel = interrupt::watch("showing the runs that are over");
    let shown = Shown::of_suite();
    let outcome = suite(&problems, &options, cancel, &|step: &Step<'_>| shown.suite(step));
    shown.finish();
    let suite = outcome.map_err(refuse)?;
    let json = serde_json::to_string_pretty(&suite)
        .map_err(|e| refuse(format!("the suite cannot be written as JSON: {e}")))?
        + "\n";
    terminal::answer(&if asked.json { json.clone() } else { suite_text(&suite, terminal::colour()) });
    if let Some(place) = place.filter(|_| suite.complete) {
        place.output.write(&place.files(&json, &suite_markdown(&suite)))?;
        if !asked.json {
            let name = &place.name;
            terminal::answer(&format!("\n  Written to {RESULTS}/{name}.md and {RESULTS}/{name}.json\n"));
        }
    }
    if !suite.complete {
        let more = if asked.write { "; nothing was written" } else { "" };
        terminal::tell(&format!("{}{more}", done(&suite, &options, &problems)));
        return Err(Ended::Interrupted);
    }
    Ok(if suite.is_accepted() { Ended::Good } else { Ended::Bad })
}

/// Says how far an interrupted suite came.
fn done(suite: &Suite, options: &Options, problems: &[ProblemFile]) -> String {
    let methods = suite.problems.iter().flat_map(|p| p.populations.iter().chain([&p.search]));
    let runs: usize = methods.map(|method| method.runs.len()).sum();
    format!("{runs} of {} runs are done", options.runs(problems))
}

/// Returns the command that makes the same suite again.
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
    let program = if here { "cargo run --release -- suite" } else { "linkwright suite" };
    let mut words = vec![program.to_owned()];
    words.extend(asked.filter.as_deref().map(quoted));
    let problems = asked.problems.as_ref().map(|folder| quoted(&folder.display().to_string()));
    words.extend(problems.map(|folder| format!("--problems {folder}")));
    words.push(format!("--seeds {}", asked.seeds));
    words.extend(asked.certify.then(|| "--certify".into()));
    words.extend(asked.write.then(|| "--write".into()));
    words.join(" ")
}

/// Returns the folder of the problems: the one that was named, or that of the literature if it is here; `None` if the
/// program's own are run.
fn folder(asked: &Asked) -> Option<&Path> {
    let here = Path::new(PROBLEMS);
    asked.problems.as_deref().or_else(|| here.is_dir().then_some(here))
}

/// Returns the problems that are asked for, by file name.
fn problems(asked: &Asked) -> Result<Vec<ProblemFile>, Ended> {
    let chosen = chosen(folder(asked), asked.filter.as_deref().unwrap_or_default());
    let known = chosen.map_err(|why| match why {
        NoProblems::Files(faults) => faults.into_iter().map(refuse_at).next_back().unwrap_or(Ended::Refused),
        why => refuse(why),
    })?;
    for warning in known.iter().flat_map(|problem| &problem.warnings) {
        terminal::diagnose(ReportKind::Warning, warning);
    }
    Ok(known)
}

/// The folder for the page and its JSON, which can be written to. It is removed again if it was made for them and they
/// were not written.
struct Place {
    folder: &'static Path,
    /// The name of both files without their endings.
    name: String,
    made: bool,
    output: Output,
}

impl Place {
    fn take(name: String, force: bool) -> Result<Self, Ended> {
        let folder = Path::new(RESULTS);
        let place = Place { folder, name, made: !folder.exists(), output: Output::new([], force) };
        std::fs::create_dir_all(folder).map_err(|e| refuse_io(folder, e))?;
        place.output.check(&place.files("", ""))?;
        tempfile::tempfile_in(folder)
            .map_err(|e| refuse(format!("{} cannot be written to: {e}", folder.display())))?;
        Ok(place)
    }

    fn files<'a>(&self, json: &'a str, page: &'a str) -> [(PathBuf, FileKind, &'a str); 2] {
        [
            (self.folder.join(format!("{}.json", self.name)), FileKind::SuiteJson, json),
            (self.folder.join(format!("{}.md", self.name)), FileKind::SuiteMarkdown, page),
        ]
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        if self.made {
            // A folder that holds something is not removed.
            let _ = std::fs::remove_dir(self.folder);
        }
    }
}
