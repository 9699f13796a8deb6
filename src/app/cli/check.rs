//! `check`: reads files and reports their faults without running anything.

use super::arguments::Check;
use super::{Ended, refuse_at, terminal};
use crate::files::diagnostic::{Diagnostic, counted, escaped};
use crate::files::input_text;
use crate::files::linkage_file;
use crate::files::loads_file;
use crate::files::{points_file, problem_file, shop_file, sweep_file};
use crate::mechanism::Linkage;
use crate::mechanism::loads::Loads;
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
                terminal::answer(&format!("{}: {summary}\n", terminal::shown(path)));
            }
            Err(diagnostic) => ended = refuse_at(diagnostic),
        }
    }
    Ok(ended)
}

fn examine(path: &Path) -> Result<(String, Vec<Diagnostic>), Box<Diagnostic>> {
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
        if points_file::holds_pairs(path) {
            let pairs = points_file::load_pairs(path)?;
            return Ok((counted(pairs.points.len(), "pair"), pairs.warnings));
        }
        let points = points_file::load(path)?;
        return Ok((targets(points.points.len(), points.angle_deg.as_deref()), points.warnings));
    }
    if problem_file::is_drawing(path) {
        let file = problem_file::from_points_file(path, &[])?;
        let drawn = &file.spec.task;
        let shape = if drawn.closed { "a closed" } else { "an open" };
        let unit = file.unit.map_or("user units", |unit| unit.label());
        let (n, size) = (drawn.points.len(), drawn.to_task().map_or(0.0, |task| task.size()));
        return Ok((format!("a drawing: {n} points of {shape} curve, size {size:.6} {unit}"), file.warnings));
    }
    if is_linkage_file(path) {
        let (file, loads) = linkage_file::load_loaded(path)?;
        let name = file.name;
        let summary = match &file.linkage {
            Linkage::FourBar(linkage) => {
                let kind = linkage.linkage_type().map_or("links that cannot be joined", |t| t.name());
                format!("linkage {name}: {kind}, {linkage}")
            }
            Linkage::SliderCrank(linkage) => format!("slider-crank {name}: {linkage}"),
            Linkage::InvertedSliderCrank(linkage) => format!("inverted slider-crank {name}: {linkage}"),
            Linkage::MultiLoop(linkage) => format!("linkage {name}: {linkage}"),
            Linkage::Chain(chain) => {
                format!("chain {name}: {} stages, points {}", chain.stages(), chain.names().join(", "))
            }
        };
        let loads = loads.map_or_else(String::new, |loads| format!("; loads: {}", counted_loads(&loads)));
        let shop = linkage_file::load_shop(path)?;
        let shop = shop.map_or_else(String::new, |shop| {
            format!("; shop: {}", counted_sizes([shop.joints.len(), shop.bodies.len()]))
        });
        return Ok((summary + &loads + &shop, Vec::new()));
    }
    if has_table(path, &["[loads", "[[loads"]) && !has_table(path, &["[task"]) {
        let loads = counted_loads(&loads_file::load_alone(path)?);
        let summary = format!("loads: {loads}; `analyze LINKAGE --loads FILE` checks them against a linkage");
        return Ok((summary, Vec::new()));
    }
    if has_table(path, &["[shop"]) {
        let sizes = counted_sizes(shop_file::check_alone(path)?);
        let summary = format!("shop: {sizes}; `build RESULT --shop FILE` checks them against a linkage");
        return Ok((summary, Vec::new()));
    }
    if sweep_file::is_sweep(path) {
        let file = sweep_file::load(path)?;
        let keys: Vec<&str> = file.vary.iter().map(|varied| varied.key.as_str()).collect();
        let summary = format!(
            "sweep {}: {} of {} over {}",
            file.name,
            counted(usize::try_from(file.jobs).unwrap_or(usize::MAX), "job"),
            file.problem.display(),
            keys.join(", ")
        );
        return Ok((escaped(&summary), Vec::new()));
    }
    let file = problem_file::load(path, &[])?;
    let target = &file.spec.task;
    let timing = match &target.timing {
        None => "free",
        Some(timing) if timing.free.is_empty() => "prescribed",
        Some(_) => "partly prescribed",
    };
    let angles = target.body.as_ref().map(|body| &body.angle_deg[..]);
    let counted = match target.is_function() {
        true => counted(target.len(), "pair"),
        false => targets(target.points.len(), angles),
    };
    if target.is_function() {
        let summary = format!("problem {}: a function of {counted}, runs as it is", file.name);
        return Ok((summary, file.warnings));
    }
    Ok((format!("problem {}: {counted}, {timing} timing, runs as it is", file.name), file.warnings))
}

/// Returns the number of a path's points, or of a motion's poses and of the places among them.
fn targets(count: usize, angles: Option<&[Option<f64>]>) -> String {
    let Some(angles) = angles else { return format!("{count} points") };
    let poses = angles.iter().flatten().count();
    match count - poses {
        0 => counted(poses, "pose"),
        places => format!("{} and {}", counted(poses, "pose"), counted(places, "place")),
    }
}

/// Returns the numbers of loads of each sort.
fn counted_loads(loads: &Loads) -> String {
    let sorts = [
        (loads.bodies.len(), "body with mass"),
        (loads.forces.len(), "force"),
        (loads.couples.len(), "couple"),
        (loads.springs.len(), "spring"),
    ];
    let named = |(count, sort): &(usize, &str)| match (*count, *sort) {
        (count, "body with mass") if count > 1 => format!("{count} bodies with mass"),
        (count, sort) => counted(count, sort),
    };
    let some: Vec<String> = sorts.iter().filter(|(count, _)| *count > 0).map(named).collect();
    if some.is_empty() { "none".to_owned() } else { some.join(", ") }
}

/// Returns the numbers of joints and of bodies with sizes of their own.
fn counted_sizes([joints, bodies]: [usize; 2]) -> String {
    let bodies = if bodies == 1 { "1 body".to_owned() } else { format!("{bodies} bodies") };
    format!("sizes of {} and {bodies}", counted(joints, "joint"))
}

/// Returns whether a file has one of the tables that only a linkage file has. An unreadable file is left to the problem
/// reader's diagnostics.
fn is_linkage_file(path: &Path) -> bool {
    has_table(path, &["[linkage]", "[vector_loop]", "[slider_crank]", "[inverted_slider_crank]", "[chain"])
}

/// Returns whether a line of a file begins with one of these.
fn has_table(path: &Path, tables: &[&str]) -> bool {
    // A pipe can be read only once.
    let text = if path.is_file() { input_text::read(path).unwrap_or_default() } else { String::new() };
    text.lines().any(|line| {
        let line = line.trim_start();
        tables.iter().any(|table| line.starts_with(table))
    })
}
