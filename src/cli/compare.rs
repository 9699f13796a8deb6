//! `compare`: results and linkages side by side.

use super::arguments::Compare;
use super::{Ended, terminal};
use crate::assess::assess;
use crate::diagnostic::escaped;
use crate::problem::Problem;
use crate::problem_file::ProblemFile;
use crate::report::compare::{Entry, compare};
use crate::results_folder::{read_record, write_file};
use crate::search::nearest::nearest_positions;
use crate::{linkage_file, problem_file};
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
fn load(argument: &str, target: Option<&(ProblemFile, Problem)>) -> Result<Vec<Entry>, Ended> {
    let path = Path::new(argument);
    if path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
        return Ok(vec![bare(path, target)?]);
    }
    let (folder, which) = match argument.rsplit_once(':') {
        Some((folder, rank)) if !path.exists() => match rank.parse::<usize>() {
            Ok(rank) if rank >= 1 => (folder, Some(rank)),
            _ => {
                return Err(refuse(&format!(
                    "{argument}: after the colon stands a candidate's rank, from 1"
                )));
            }
        },
        _ => (argument, None),
    };
    let record = read_record(Path::new(folder)).map_err(|e| refuse(&e.to_string()))?;
    let n = record.candidates.len();
    if let Some(rank) = which.filter(|rank| *rank > n) {
        return Err(refuse(&format!("{argument}: there is no candidate {rank}, the result has {n}")));
    }
    let ranks = which.map_or(1..=n, |rank| rank..=rank);
    let label =
        |rank: usize| format!("{}:{rank}", folder.trim_end_matches("/record.json").trim_end_matches('/'));
    Ok(ranks.filter_map(|rank| Entry::from_record(&label(rank), &record, rank - 1)).collect())
}

/// A linkage without a run: measured at the positions nearest to the target's points, or at its angles.
fn bare(path: &Path, target: Option<&(ProblemFile, Problem)>) -> Result<Entry, Ended> {
    let file = linkage_file::load(path).map_err(|diagnostic| {
        terminal::diagnose(ReportKind::Error, &diagnostic);
        Ended::Refused
    })?;
    let shown = escaped(&path.display().to_string());
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
