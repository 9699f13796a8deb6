//! `synth`: problems in, results out.

use super::arguments::Synth;
use super::progress::Shown;
use super::{Ended, interrupt, terminal};
use crate::linkage_file;
use crate::problem_file::{self, ProblemFile};
use crate::record::{Reason, Record};
use crate::report::exact::exact_text;
use crate::report::plot::{Glyphs, terminal_plot};
use crate::report::table::{BatchOutcome, BatchRow, batch_summary, candidates_table};
use crate::report::{contact_sheet, csv, exact_sheet, svg};
use crate::results_folder::{BUILDABLE, ResultsFolder, rescue};
use crate::run::{Context, Finished, Job, run as run_job};
use ariadne::ReportKind;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Where results go when nothing is said.
const RESULTS: &str = "results";

/// Runs the command.
pub fn run(options: &Synth) -> Ended {
    let start = Instant::now();
    let Some(problems) = load(options) else { return Ended::Refused };
    let Some(places) = places(options, &problems) else { return Ended::Refused };
    let threads = options.threads.map_or(0, usize::from);
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(e) => {
            terminal::complain(&format!("no threads to search with: {e}"));
            return Ended::Refused;
        }
    };
    // Every folder is taken before anything runs: a place that cannot be written to costs no search.
    let mut folders = Vec::new();
    for place in &places {
        match ResultsFolder::take(place) {
            Ok(folder) => folders.push(folder),
            Err(e) => {
                terminal::complain(&e.to_string());
                return Ended::Refused;
            }
        }
    }
    let cancel = interrupt::watch("saving the best so far");
    let several = problems.len() > 1;
    let mut finished: Vec<Record> = Vec::new();
    let mut ended = Ended::Good;
    for (problem, mut folder) in problems.into_iter().zip(folders) {
        let begun = if several { Instant::now() } else { start };
        let shown = Shown::new(&problem.name, options.quiet);
        let job = Job { name: problem.name, source: problem.source, unit: problem.unit, spec: problem.spec };
        let observer = |progress: &_| shown.update(progress);
        let outcome = pool.install(|| run_job(&job, &Context { cancel, observer: &observer }));
        shown.finish();
        let Finished { record, search_s, beside_s } = match outcome {
            Ok(finished) => finished,
            Err(e) => {
                terminal::complain(&format!("{}: {e}", job.name));
                return Ended::Refused;
            }
        };
        let timing = Timing {
            search_s,
            beside_s,
            total_s: begun.elapsed().as_secs_f64(),
            threads: pool.current_num_threads(),
        };
        if let Err(e) = files(&record, &timing).and_then(|files| save(&mut folder, &files)) {
            terminal::complain(&e);
            return Ended::Refused;
        }
        if !options.json {
            let seconds = (search_s, beside_s);
            let brief = several || options.quiet;
            terminal::answer(&page(&record, folder.path(), seconds, brief, options.all));
        }
        let interrupted = record.termination.reason == Reason::Cancelled;
        if !record.candidates.iter().any(|c| c.accepted) && ended == Ended::Good {
            ended = Ended::Bad;
        }
        finished.push(record);
        if interrupted {
            ended = Ended::Interrupted;
            break;
        }
    }
    if options.json {
        let text = match finished.as_slice() {
            [record] if !several => serde_json::to_string_pretty(record),
            records => serde_json::to_string_pretty(records),
        };
        terminal::answer(&format!("{}\n", text.unwrap_or_default()));
    } else if several {
        let rows: Vec<BatchRow<'_>> = finished
            .iter()
            .map(|record| BatchRow { name: &record.problem.name, outcome: BatchOutcome::Ran(record) })
            .collect();
        terminal::answer(&batch_summary(&rows, terminal::colour()));
    }
    ended
}

/// Puts a result into its folder; one that the folder does not take is saved elsewhere, and that is told.
fn save(folder: &mut ResultsFolder, files: &[(String, Vec<u8>)]) -> Result<(), String> {
    folder.replace(files).map_err(|e| match rescue(files) {
        Ok(place) => format!("{e}; the result was saved in {}", place.display()),
        Err(also) => format!("{e}; nor can it be saved elsewhere: {also}"),
    })
}

/// Reads every file; `None` after the diagnostics of those that are no problems.
fn load(options: &Synth) -> Option<Vec<ProblemFile>> {
    let mut overrides = options.set.clone();
    overrides.extend(options.method.iter().map(|method| ("solve.method".into(), method.clone())));
    overrides.extend(options.seed.iter().map(|seed| ("solve.seed".into(), seed.to_string())));
    let mut problems = Vec::new();
    let mut refused = false;
    for path in &options.files {
        match problem_file::load_any(path, &overrides) {
            Ok(problem) => {
                for warning in &problem.warnings {
                    terminal::diagnose(ReportKind::Warning, warning);
                }
                problems.push(problem);
            }
            Err(diagnostic) => {
                terminal::diagnose(ReportKind::Error, &diagnostic);
                refused = true;
            }
        }
    }
    (!refused).then_some(problems)
}

/// Where each problem's results go; `None` where two would share a folder.
fn places(options: &Synth, problems: &[ProblemFile]) -> Option<Vec<PathBuf>> {
    let place = |problem: &ProblemFile| match &options.out {
        Some(out) if problems.len() == 1 => out.clone(),
        Some(out) => out.join(&problem.name),
        None => Path::new(RESULTS).join(&problem.name),
    };
    let places: Vec<PathBuf> = problems.iter().map(place).collect();
    for (i, one) in places.iter().enumerate() {
        if let Some(j) = places[..i].iter().position(|other| other == one) {
            let [first, second] = [j, i].map(|k| options.files[k].display().to_string());
            terminal::complain(&format!(
                "{first} and {second} would both write to {}; give them different names (key `name`)",
                one.display()
            ));
            return None;
        }
    }
    Some(places)
}

#[derive(serde::Serialize)]
struct Timing {
    search_s: f64,
    beside_s: f64,
    total_s: f64,
    threads: usize,
}

/// Everything that a result's folder holds.
fn files(record: &Record, timing: &Timing) -> Result<Vec<(String, Vec<u8>)>, String> {
    let json = |text: Result<String, serde_json::Error>| {
        text.map(|t| (t + "\n").into_bytes())
            .map_err(|e| format!("the record cannot be written as JSON: {e}"))
    };
    let mut files = vec![
        ("record.json".to_string(), json(serde_json::to_string_pretty(record))?),
        ("timing.json".to_string(), json(serde_json::to_string_pretty(timing))?),
        ("candidates.csv".to_string(), csv::candidates_csv(record).into_bytes()),
    ];
    for (i, candidate) in record.candidates.iter().enumerate() {
        let n = i + 1;
        let name = numbered(&record.problem.name, &n.to_string());
        let toml = linkage_file::to_toml(&name, record.problem.unit, &candidate.linkage);
        files.push((format!("linkage-{n}.toml"), toml.into_bytes()));
        files.push((format!("curve-{n}.csv"), csv::curve_csv(record, i).into_bytes()));
        files.push((format!("candidate-{n}.svg"), svg::candidate_svg(record, i).into_bytes()));
    }
    if let Some(candidate) = &record.buildable {
        let name = numbered(&record.problem.name, BUILDABLE);
        let toml = linkage_file::to_toml(&name, record.problem.unit, &candidate.linkage);
        files.push((format!("linkage-{BUILDABLE}.toml"), toml.into_bytes()));
        files.push((format!("curve-{BUILDABLE}.csv"), csv::candidate_curve_csv(candidate).into_bytes()));
    }
    if record.candidates.len() > 1 {
        let sheet = contact_sheet::contact_sheet_svg(record);
        files.push(("contact-sheet.svg".into(), sheet.into_bytes()));
    }
    if record.exact.as_ref().is_some_and(|exact| !exact.linkages.is_empty()) {
        files.push(("exact.svg".into(), exact_sheet::exact_svg(record).into_bytes()));
    }
    Ok(files)
}

/// The problem's name with a candidate's rank (or `buildable`), within the length of a name.
fn numbered(name: &str, n: &str) -> String {
    let suffix = format!("-{n}");
    let stem: String = name.chars().take(crate::name::MAX_NAME - suffix.len()).collect();
    format!("{}{suffix}", stem.trim_end())
}

/// What is printed for one problem.
fn page(record: &Record, folder: &Path, (search_s, beside_s): (f64, f64), brief: bool, all: bool) -> String {
    let mut text = candidates_table(record, terminal::colour());
    text.push_str(&exact_text(record, all, terminal::colour()));
    if !brief && terminal::stdout_is_terminal() && !record.candidates.is_empty() {
        text.push('\n');
        text.push_str(&terminal_plot(record, 0, 72, 22, Glyphs::Braille));
    }
    let shown = crate::diagnostic::escaped(&folder.display().to_string());
    let more = match &record.buildable {
        Some(_) => format!(", {beside_s:.3} s more for the buildable one"),
        None => String::new(),
    };
    text.push_str(&format!("\n  {search_s:.3} s of search{more}. Written to {shown}\n"));
    if !record.candidates.is_empty() && !brief {
        let quoted = if shown.contains(' ') { format!("\"{shown}\"") } else { shown };
        text.push_str(&format!("  Look at {quoted}/candidate-1.svg, then: linkwright verify {quoted}\n"));
    }
    text.push('\n');
    text
}
