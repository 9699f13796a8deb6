//! What a maker takes from the studio: the layers and clearances of a linkage as text, and one archive of everything
//! that it takes to build it.

use super::details::DetailsError;
use crate::files::linkage_file;
use crate::judge::practicality::{Build, Practicality, Sweep, usual_tolerance};
use crate::mechanism::Unit;
use crate::record::{Candidate, Record};
use crate::report::export::{Format, Settings, Subject, export};
use crate::report::grid::Colour;
use crate::report::practicality::practicality_text;
use crate::report::{html, svg};
use crate::task::Problem;
use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use zip::CompressionMethod;
use zip::result::ZipError;
use zip::write::{SimpleFileOptions, ZipWriter};

/// Sizes as they are typed: `hole_mm`, `motor_hole_mm`, `boss_hole_mm`, `margin_mm`, `kerf_mm`, `thickness_mm`, `gap_mm`, `sheet_mm`, `scale`.
pub(super) type Sizes = BTreeMap<String, String>;

/// The files of an archive: what is added to the name, the ending, what it is for, and the format.
const FILES: [(&str, &str, &str, Format); 6] = [
    (
        "plates",
        "dxf",
        "the plates to cut, in millimetres; the layer MARK holds names to engrave",
        Format::DxfPlates,
    ),
    (
        "plates",
        "svg",
        "the same plates for a laser that reads SVG, with names of the holes",
        Format::SvgPlates,
    ),
    ("plates", "stl", "the same plates to print", Format::Stl),
    ("model", "scad", "a model for OpenSCAD that moves", Format::Scad),
    ("skeleton", "dxf", "joints, links, curve and target, for CAD", Format::Dxf),
    ("cut-list", "txt", "each plate's holes and size, and the pins", Format::CutList),
];

/// Returns what `linkwright build` says of a candidate made with these sizes.
///
/// # Errors
/// [`DetailsError`] for a size that cannot be used, and for a linkage that cannot be assembled.
pub(super) fn layers(record: &Record, candidate: &Candidate, sizes: &Sizes) -> Result<String, DetailsError> {
    let settings = settings_for(Format::CutList, sizes)?;
    let unit = record.problem.unit.or(settings.unit);
    let problem = Problem::new(record.problem.resolved.clone()).map_err(super::asked::AskError::Task)?;
    let length = |mm: f64| mm * unit.map_or(1.0, |unit| Unit::Mm.factor_to(unit)) / settings.scale();
    let usual = || Build::usual_hole_of(&Sweep::of_candidate(&problem, candidate)?, unit);
    let hole = settings.hole_mm.map(length).or_else(usual).ok_or(DetailsError::NotAssembled)?;
    let build = Build::new(hole, settings.margin_mm.map_or(hole, length))
        .with_motor(settings.motor_hole_mm.map(length), settings.boss_hole_mm.map(length));
    let found = Practicality::of_candidate(&problem, candidate, build).ok_or(DetailsError::NotAssembled)?;
    Ok(practicality_text(&found, unit, usual_tolerance(candidate.linkage, unit), Colour::Never))
}

/// Returns an archive (zip) of everything that it takes to build a candidate, under names that begin with `name`; with
/// the problem file, if there is one.
///
/// # Errors
/// [`DetailsError`] for a size that cannot be used.
pub(super) fn archive(
    record: &Record,
    index: usize,
    (name, problem): (&str, Option<String>),
    sizes: &Sizes,
) -> Result<Vec<u8>, DetailsError> {
    let candidate = &record.candidates[index];
    let subject = Subject::of_candidate(record, candidate);
    let mut files: Vec<(String, &str, Vec<u8>)> = Vec::new();
    for (what, ending, purpose, format) in FILES {
        let settings = settings_for(format, sizes)?;
        let bytes = export(&subject, format, &settings).map_err(DetailsError::Export)?.bytes;
        files.push((format!("{name}-{what}.{ending}"), purpose, bytes));
    }
    let mut add = |what: &str, purpose, text: String| {
        files.push((format!("{name}-{what}"), purpose, text.into_bytes()));
    };
    add("layers.txt", "the order of the layers, distances over the motion, how exact to work", {
        layers(record, candidate, sizes)?
    });
    add("report.html", "the linkage in motion with every figure: open it in a browser", {
        html::report_html(record, index)
    });
    add("drawing.svg", "the linkage over its path", svg::candidate_svg(record, index));
    let (problem_name, unit) = (&record.problem.name, record.problem.unit);
    let linkage = linkage_file::to_toml_with(
        problem_name,
        unit,
        &candidate.linkage,
        linkage_file::Carried::of(candidate),
    );
    add("linkage.toml", "the linkage: linkwright analyze and export read it", linkage);
    if let Some(problem) = problem {
        add("problem.toml", "what was asked: linkwright synth and studio read it", problem);
    }
    let mut list = format!("{name}\n\nTo cut: {name}-plates.dxf; the kerf is in it already.\n\n");
    for (file, purpose, bytes) in &files {
        list.push_str(&format!("{file}: {purpose} ({} bytes)\n", bytes.len()));
    }
    let sizes: Vec<String> = sizes.iter().map(|(key, value)| format!("{} {value}", named(key))).collect();
    if !sizes.is_empty() {
        list.push_str(&format!("\nMade with {}.\n", sizes.join(", ")));
    }
    files.insert(0, (format!("{name}-contents.txt"), "", list.into_bytes()));
    zipped(&files).map_err(|why| DetailsError::NotPacked(why.to_string()))
}

/// Returns a size in words.
fn named(key: &str) -> &str {
    match key {
        "hole_mm" => "holes of (mm)",
        "motor_hole_mm" => "a hole for the motor's shaft of (mm)",
        "boss_hole_mm" => "a hole for the motor's boss of (mm)",
        "margin_mm" => "material around a hole (mm)",
        "kerf_mm" => "a kerf of (mm)",
        "thickness_mm" => "plates of (mm)",
        "gap_mm" => "gaps of (mm)",
        "sheet_mm" => "a sheet of (mm)",
        other => other,
    }
}

/// Returns the settings of a format among the sizes; those that mean nothing for it are left out.
fn settings_for(format: Format, sizes: &Sizes) -> Result<Settings, DetailsError> {
    let known = |key: &String| Format::ALL.iter().any(|other| other.settings().contains(&key.as_str()));
    let wanted = |(key, _): &(&String, &String)| format.settings().contains(&key.as_str()) || !known(key);
    let pairs: Vec<_> = sizes.iter().filter(wanted).map(|(k, v)| (k.clone(), v.clone())).collect();
    Settings::parse(format, &pairs).map_err(DetailsError::Export)
}

/// Returns an archive of files, each with its name. Nothing in it depends on the time at which it is made.
fn zipped(files: &[(String, &str, Vec<u8>)]) -> Result<Vec<u8>, ZipError> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, _, bytes) in files {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
