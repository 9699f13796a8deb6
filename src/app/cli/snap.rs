//! `snap`: lengths brought to stock sizes.

use super::arguments::Snap as Options;
use super::inputs::RESULTS;
use super::output::Output;
use super::result;
use super::{Ended, build, interrupt, refuse, refuse_at, terminal};
use crate::app::job::files::{Timing, files};
use crate::app::job::folder::ResultsFolder;
use crate::app::snapping::{NoSubject, Subject, fixed, pitches, to_snap};
use crate::files::generator::FileKind;
use crate::files::linkage_file;
use crate::files::name;
use crate::judge::practicality::{Build, Practicality, Sweep};
use crate::record::{Reason, Record};
use crate::report::practicality::practicality_text;
use crate::report::snap::snap_text;
use crate::synthesis::snap::{Request, SnapError, Stock, record, snap};
use crate::synthesis::{Budget, Context};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The ending of the name of a snapped linkage.
const SUFFIX: &str = "-snapped";

/// Runs the command.
pub fn run(options: &Options) -> Result<Ended, Ended> {
    let begun = Instant::now();
    let stock = stock(options)?;
    let subject = Subject::of(result::read(&options.result)?).map_err(|why| match why {
        NoSubject::NoCandidate(none) => Ended::from(none),
        why => refuse(why),
    })?;
    result::note_loads(&options.result);
    // Before the work, not after it.
    if let Some(path) = linkage_place(options) {
        output(options).check(&[(path, FileKind::Linkage, "")])?;
    }
    let request = Request {
        stock,
        lengths: to_snap(&subject.candidate.linkage, options.snap.as_deref()).map_err(refuse)?,
        fixed: fixed(&subject.candidate.linkage, &options.keep, &options.set).map_err(refuse)?,
        wanted: subject.problem.spec().solve.candidates,
    };
    let cancel = interrupt::watch("saving the best so far");
    let budget = Budget::new(cancel, None);
    let context = Context::new(&subject.problem, &budget);
    let snapped = snap(context, &subject.candidate, &request).map_err(|e| {
        let (ended, more) = match e {
            SnapError::NoneFits => (Ended::Bad, ""),
            SnapError::Interrupted => (Ended::Interrupted, ": nothing was written"),
            SnapError::NothingToSnap | SnapError::NoStock { .. } => (Ended::Refused, ""),
        };
        terminal::complain(&format!("{e}{more}"));
        ended
    })?;
    let Some(best) = snapped.candidates.first() else { return Err(Ended::Bad) };
    let name = name::with_suffix(&name::legal(&subject.name, "linkage"), SUFFIX);
    let search_s = begun.elapsed().as_secs_f64();
    let record =
        record(&subject.problem, &name, subject.source, subject.unit, &request, &snapped).map_err(refuse)?;
    let written = write(options, &record, begun, search_s)?;
    terminal::answer(&format!("{}\n", subject.label));
    terminal::answer(&snap_text(&subject.candidate, &request, &snapped, subject.unit, terminal::colour()));
    let of_practice = || {
        let hole = Build::usual_hole_of(&Sweep::of_candidate(&subject.problem, best)?, subject.unit)?;
        let found = Practicality::of_candidate(&subject.problem, best, Build::new(hole, hole))?;
        Some((found, build::usual_tolerance(best.linkage, subject.unit)))
    };
    if let Some((found, tolerance)) = of_practice() {
        terminal::answer("\n");
        terminal::answer(&practicality_text(&found, subject.unit, tolerance, terminal::colour()));
    }
    terminal::answer(&format!("\n  Wrote {}\n", terminal::shown(&written)));
    Ok(match snapped.reason {
        Reason::Cancelled => Ended::Interrupted,
        _ if best.accepted => Ended::Good,
        _ => Ended::Bad,
    })
}

fn stock(options: &Options) -> Result<Stock, Ended> {
    match (options.grid, &options.lengths, &options.pitches) {
        (Some(step), ..) => Stock::grid(step).map_err(refuse),
        (_, Some(lengths), _) => Stock::list(lengths).map_err(refuse),
        (.., Some(path)) => pitches(path).map_err(refuse_at),
        _ => Err(refuse("give --grid, --lengths or --pitches")),
    }
}

/// Returns the file for the best linkage alone, if one was named.
fn linkage_place(options: &Options) -> Option<&Path> {
    options.out.as_deref().filter(|p| p.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")))
}

fn output(options: &Options) -> Output {
    Output::new([&options.result].into_iter().chain(&options.pitches), options.force)
}

/// Writes the record with all its files, or the best linkage alone; returns the place.
fn write(options: &Options, record: &Record, begun: Instant, search_s: f64) -> Result<PathBuf, Ended> {
    if let Some(path) = linkage_place(options) {
        let Some(best) = record.candidates.first() else { return Err(Ended::Bad) };
        let (name, unit) = (&record.problem.name, record.problem.unit);
        let text = linkage_file::to_toml_with(name, unit, &best.linkage, linkage_file::Carried::of(best));
        output(options).write(&[(path, FileKind::Linkage, text)])?;
        return Ok(path.to_path_buf());
    }
    let place = options.out.clone().unwrap_or_else(|| Path::new(RESULTS).join(&record.problem.name));
    let mut folder = ResultsFolder::take(&place).map_err(refuse)?;
    let total_s = begun.elapsed().as_secs_f64();
    let (beside_s, threads) = (total_s - search_s, rayon::current_num_threads());
    let timing = Timing { search_s, beside_s, advice_s: None, total_s, threads };
    let files = files(record, &timing).map_err(refuse)?;
    folder.replace(&files).map_err(refuse)?;
    Ok(place)
}
