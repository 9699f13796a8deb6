//! `compare`: results and linkages side by side.

use super::arguments::Compare;
use super::result::{self, Given};
use super::{Ended, terminal};
use crate::assess::assess;
use crate::diagnostic::escaped;
use crate::linkage_file::LinkageFile;
use crate::problem::Problem;
use crate::problem_file;
use crate::problem_file::ProblemFile;
use crate::report::compare::{Entry, compare};
use crate::results_folder::write_file;
use crate::search::nearest::nearest_positions;
use ariadne::ReportKind;
use std::path::Path;

/// Runs the command.
pub fn run(options: &Compare) -> Ended {
    let target = match options.target.as_deref().map(load_target).transpose() {
        Ok(target) => target,
        Err(ended) => return ended,
    };
    let mut entries = Vec::new();
    for result in &options.results {
        match load(result, target.as_ref()) {
            Ok(loaded) => entries.extend(loaded),
            Err(ended) => return ended,
        }
    }
    if entries.is_empty() {
        terminal::complain("none of these results has a candidate to compare");
        return Ended::Bad;
    }
    let comparison = compare(&entries, options.sort);
    if let Some(path) = &options.csv
        && let Err(e) = write_file(path, comparison.csv().as_bytes())
    {
        terminal::complain(&e.to_string());
        return Ended::Refused;
    }
    terminal::answer(&comparison.table(terminal::colour()));
    Ended::Good
}

fn load_target(path: &Path) -> Result<(ProblemFile, Problem), Ended> {
    let file = problem_file::load(path, &[]).map_err(|diagnostic| {
        terminal::diagnose(ReportKind::Error, &diagnostic);
        Ended::Refused
    })?;
    let problem = Problem::new(file.spec.clone()).map_err(|e| refuse(&e.to_string()))?;
    Ok((file, problem))
}

fn refuse(text: &str) -> Ended {
    terminal::complain(text);
    Ended::Refused
}

/// The entries of one argument: a linkage file, or the candidates of a result (one with `:2`).
fn load(argument: &Path, target: Option<&(ProblemFile, Problem)>) -> Result<Vec<Entry>, Ended> {
    match result::read(argument)? {
        Given::Linkage(file) => {
            let shown = escaped(&argument.display().to_string());
            Ok(vec![bare(*file, &shown, target)?])
        }
        Given::Run(run) => {
            let record = &run.record;
            let entries = run.chosen().into_iter().map(|chosen| Entry {
                label: chosen.label,
                candidate: chosen.candidate.clone(),
                target: record.problem.resolved.task.path.points.clone(),
                unit: record.problem.unit,
            });
            Ok(entries.collect())
        }
    }
}

/// A linkage without a run: measured at the positions nearest to the target's points, or at its angles.
fn bare(file: LinkageFile, shown: &str, target: Option<&(ProblemFile, Problem)>) -> Result<Entry, Ended> {
    let Some((target_file, problem)) = target else {
        return Err(refuse(&format!(
            "{shown} is a linkage without a target: say which with --target PROBLEM.toml"
        )));
    };
    let candidate = nearest_positions(problem, &file.linkage)
        .and_then(|(crank_deg, assemblies)| assess(problem, &file.linkage, &crank_deg, &assemblies))
        .ok_or_else(|| refuse(&format!("{shown} cannot be assembled at every point of the target")))?;
    Ok(Entry {
        label: file.name,
        candidate,
        target: target_file.spec.task.path.points.clone(),
        unit: target_file.unit.or(file.unit),
    })
}
