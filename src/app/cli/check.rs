//! `check`: is a file what it should be?

use super::arguments::Check;
use super::{Ended, refuse_at, terminal};
use crate::files::diagnostic::{Diagnostic, escaped};
use crate::files::linkage_file;
use crate::files::{points_file, problem_file};
use crate::mechanism::Linkage;
use ariadne::ReportKind;
use std::path::Path;

/// Runs the command.
pub fn run(options: &Check) -> Result<Ended, Ended> {
    let mut ended = Ended::Good;
    for path in &options.files {
        match examine(path) {
            Ok((summary, warnings)) => {
                for warning in &warnings {
                    terminal::diagnose(ReportKind::Warning, warning);
                }
                terminal::answer(&format!("{}: {summary}\n", escaped(&path.display().to_string())));
            }
            Err(diagnostic) => ended = refuse_at(diagnostic),
        }
    }
    Ok(ended)
}

fn examine(path: &Path) -> Result<(String, Vec<Diagnostic>), Box<Diagnostic>> {
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
        let points = points_file::load(path)?;
        return Ok((format!("{} points", points.points.len()), points.warnings));
    }
    if problem_file::is_drawing(path) {
        let file = problem_file::from_points_file(path, &[])?;
        let drawn = &file.spec.task.path;
        let shape = if drawn.closed { "a closed" } else { "an open" };
        let unit = file.unit.map_or("user units", |unit| unit.label());
        let size = drawn.to_task().map_or(0.0, |task| task.size());
        let summary =
            format!("a drawing: {} points of {shape} curve, size {size:.6} {unit}", drawn.points.len());
        return Ok((summary, file.warnings));
    }
    if is_linkage_file(path) {
        let file = linkage_file::load_any(path)?;
        let what = match &file.linkage {
            Linkage::FourBar(linkage) => {
                let of = linkage.linkage_type().map_or("links that cannot be joined", |t| t.name());
                format!("linkage {}: {of}, {linkage}", file.name)
            }
            Linkage::Chain(chain) => {
                format!("chain {}: {} stages, points {}", file.name, chain.stages(), chain.names().join(", "))
            }
        };
        return Ok((what, Vec::new()));
    }
    let file = problem_file::load(path, &[])?;
    let path_spec = &file.spec.task.path;
    let timing = match &path_spec.timing {
        None => "free timing".to_string(),
        Some(_) => "prescribed timing".to_string(),
    };
    Ok((
        format!("problem {}: {} points, {timing}, runs as it is", file.name, path_spec.points.len()),
        file.warnings,
    ))
}

/// Whether a file has one of the tables that only a linkage file has; what cannot be read is left to the
/// problem reader's diagnostics.
fn is_linkage_file(path: &Path) -> bool {
    let small =
        std::fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() <= crate::files::input_text::MAX_BYTES);
    let text = if small { std::fs::read_to_string(path).unwrap_or_default() } else { String::new() };
    text.lines().any(|line| {
        let line = line.trim_start();
        ["[linkage]", "[vector_loop]", "[chain"].iter().any(|table| line.starts_with(table))
    })
}
