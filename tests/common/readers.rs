//! Every reader of text that comes from outside, as the fuzzer and the test of its corpora call it: any bytes in, no
//! panic. What could be read is used as the commands use it, and has to be what a reader promises.

#![allow(dead_code, reason = "a fuzz target uses one of them")]

use linkwright::internals::app::job::checkpoint;
use linkwright::internals::app::job::checkpoint::Writer;
use linkwright::internals::app::job::run::{Context, Job};
use linkwright::internals::app::job::{folder, run};
use linkwright::internals::files::diagnostic::Diagnostic;
use linkwright::internals::files::linkage_file;
use linkwright::internals::files::linkage_file::AnyLinkageFile;
use linkwright::internals::files::points_file;
use linkwright::internals::files::problem_file;
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::files::svg_file;
use linkwright::internals::files::svg_file::SvgOptions;
use linkwright::internals::judge::verify;
use linkwright::internals::mechanism::Linkage;
use linkwright::internals::mechanism::analysis::driven::{MechanismRequest, analyze_mechanism};
use linkwright::internals::mechanism::analysis::{PositionMethod, Request, analyze, full_turn};
use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::record::Record;
use linkwright::internals::record::digest::digest;
use linkwright::internals::report::compare::{Entry, SortKey, compare};
use linkwright::internals::report::plot::{Glyphs, terminal_plot};
use linkwright::internals::report::{
    Colour, analysis_csv, analysis_sheets, analysis_text, cognates_sheet, mechanism_sheet, mechanism_text,
};
use linkwright::internals::report::{contact_sheet, csv, exact, exact_sheet, html, svg, table};
use linkwright::internals::synthesis::keeper::{Keeper, SearchState};
use linkwright::internals::task::Problem;
use linkwright::internals::task::spec::ProblemSpec;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// A problem that `--set` changes.
const SET_BASE: &str = "format = 1
name = \"base\"
[task.path]
points = [[0, 0], [1, 2], [2, 2.5], [3, 2], [4, 0]]
tolerance = 0.1
[design]
A = [[-5, 5], [-5, 5]]
a = [0.1, 9]
[require]
type = [\"crank-rocker\"]
[solve]
seed = 3
[solve.genetic]
population = 50
";
/// The columns and rows of a plot.
const PLOT: (usize, usize) = (60, 20);

/// A text, without the bytes that no file reader lets through.
fn text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

/// A refusal is text that a terminal can show.
fn shown(refusal: &Diagnostic) {
    let words = refusal.to_string();
    assert!(words.chars().all(|c| c == '\n' || !c.is_control()), "{words:?}");
    assert!(!refusal.message.is_empty());
    if let Some(span) = &refusal.span {
        assert!(span.start <= span.end && span.end <= refusal.text.len(), "{span:?}");
    }
}

/// What a problem file gives can be run and is the same after a record has held it.
fn usable(file: &ProblemFile) {
    file.warnings.iter().for_each(shown);
    Problem::new(file.spec.clone()).expect("what was read can be run");
    digest(&file.spec).expect("it is data");
    let kept = serde_json::to_vec(&file.spec).expect("it is data");
    let back: ProblemSpec = serde_json::from_slice(&kept).expect("what was written can be read");
    assert_eq!(back, file.spec);
}

/// Problem files.
pub fn problem(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    match problem_file::parse("a problem.toml", text, None, &[]) {
        Ok(file) => usable(&file),
        Err(refusal) => shown(&refusal),
    }
}

/// `--set KEY=VALUE`, one a line.
pub fn setting(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    let pair = |line: &str| line.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()));
    let set: Vec<_> = text.lines().filter_map(pair).collect();
    match problem_file::parse("base.toml", SET_BASE, None, &set) {
        Ok(file) => usable(&file),
        Err(refusal) => shown(&refusal),
    }
}

/// Linkage files of every kind.
pub fn linkage(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    let AnyLinkageFile { name, unit, linkage } = match linkage_file::parse_any("a linkage.toml", text) {
        Ok(file) => file,
        Err(refusal) => return shown(&refusal),
    };
    let crank_deg = full_turn(5);
    let input = CrankMotion { speed_rad_s: 2.0, acceleration_rad_s2: 1.0 }.into();
    match linkage {
        Linkage::FourBar(linkage) => {
            let again = linkage_file::parse("again.toml", &linkage_file::to_toml(&name, unit, &linkage));
            assert_eq!(again.expect("what was written can be read").linkage, linkage);
            let methods = ["algebraic", "complex", "fixed-point"];
            let methods: Vec<PositionMethod> = methods.iter().filter_map(|name| name.parse().ok()).collect();
            let request =
                Request { name, unit, linkage, crank_deg, input, methods, all_configurations: true };
            let analysis = analyze(&request);
            analysis_csv::analysis_csv(&analysis);
            analysis_sheets::analysis_svg(&analysis);
            analysis_text::analysis_head(&analysis, Colour::Never);
            analysis_text::analysis_table(&analysis, Colour::Never);
            let cognates: Vec<_> = linkage.cognates().into_iter().flatten().map(|c| c.linkage).collect();
            cognates_sheet::cognates_svg("name", unit, &linkage, &cognates);
        }
        linkage => {
            let again = match &linkage {
                Linkage::SliderCrank(l) => Some(linkage_file::slider_crank_to_toml(&name, unit, l)),
                Linkage::InvertedSliderCrank(l) => {
                    Some(linkage_file::inverted_slider_crank_to_toml(&name, unit, l))
                }
                Linkage::MultiLoop(l) => Some(linkage_file::multi_loop_to_toml(&name, unit, l)),
                Linkage::FourBar(_) | Linkage::Chain(_) => None,
            };
            if let Some(again) = again {
                let again =
                    linkage_file::parse_any("again.toml", &again).expect("what was written can be read");
                assert_eq!(again.linkage, linkage);
            }
            let request = MechanismRequest { name, unit, linkage, crank_deg, input };
            let analysis = analyze_mechanism(&request);
            mechanism_sheet::mechanism_svg(&analysis, &request.linkage);
            mechanism_text::mechanism_csv(&analysis);
            mechanism_text::mechanism_head(&analysis, Colour::Never);
            mechanism_text::mechanism_table(&analysis, Colour::Never);
        }
    }
}

/// Points CSV, and CSV of a function's pairs.
pub fn points(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    of_csv(points_file::parse("points.csv", text));
    of_csv(points_file::parse_pairs("pairs.csv", text));
}

fn of_csv(read: Result<points_file::PointsFile, Box<Diagnostic>>) {
    match read {
        Ok(file) => {
            file.warnings.iter().for_each(shown);
            let n = file.points.len();
            assert!(n > 0 && n <= points_file::MAX_POINTS && file.rows.len() == n);
            for column in [&file.crank_deg, &file.angle_deg].into_iter().flatten() {
                assert!(column.len() == n && column.iter().flatten().all(|v| v.is_finite()));
            }
            let columns = [&file.weight, &file.tolerance, &file.tolerance_deg];
            for column in columns.into_iter().flatten() {
                assert!(column.len() == n && column.iter().all(|v| v.is_finite()));
            }
            assert!(file.points.iter().flatten().all(|v| v.abs() <= 1e12));
            assert!(file.rows.iter().all(|row| file.text.get(row.clone()).is_some()));
        }
        Err(refusal) => shown(&refusal),
    }
}

/// SVG drawings.
pub fn drawing(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    match svg_file::parse("drawing.svg", text, &SvgOptions { samples: 12, ..SvgOptions::default() }) {
        Ok(target) => {
            target.warnings.iter().for_each(shown);
            assert_eq!(target.points.len(), 12);
            // A sample lies on the shape, which lies within 1e12, to rounding.
            assert!(target.points.iter().flatten().all(|v| v.abs() <= 1.001e12));
            assert!(target.length.is_finite() && target.length > 0.0);
        }
        Err(refusal) => shown(&refusal),
    }
}

/// Records, as `verify`, `compare` and the reports read them.
pub fn record(bytes: &[u8]) {
    let Ok(record) = folder::parse_record("record.json", bytes) else { return };
    if let Ok(mismatches) = verify::verify(&record) {
        mismatches.iter().for_each(|mismatch| assert!(!mismatch.to_string().is_empty()));
    }
    reports(&record);
}

/// Small searches of every kind: free timing, prescribed timing, in the physical parameters, populations, a function; each
/// with the parts of a state from which it goes on.
pub const SEARCHES: [(&str, &[&str]); 5] = [
    (
        "format = 1\nname = \"free\"\n[task.path]\npoints = [[0, 0], [2, 1], [3, 3], [4, 1], [5, 0], [6, -2], [4, -3], [2, -1]]\n\
         [solve]\ncandidates = 4\nevaluations = 20000\nmethod = \"least-squares\"\n",
        &["free"],
    ),
    (
        "format = 1\nname = \"timed\"\n[task.path]\npoints = [[0, 0], [10, 0], [10, 10], [0, 10], [5, 5]]\n\
         tolerance = 1e-6\n[task.path.timing]\ncrank_deg = [0, 60, 120, 180, 240]\n[require]\n\
         type = [\"crank-rocker\"]\ntransmission_deg_min = 40\n\
         [solve]\ncandidates = 2\nevaluations = 6000\nmethod = \"least-squares\"\n",
        &["timed", "rounds"],
    ),
    (
        "format = 1\nname = \"genetic\"\n[task.path]\npoints = [[0, 0], [2, 1], [4, 1], [5, 0]]\n\
         [solve]\nevaluations = 2000\nmethod = \"genetic\"\n[solve.genetic]\npopulation = 8\nelites = 1\n\
         stall_generations = 4\n",
        &["population"],
    ),
    (
        "format = 1\nname = \"differential\"\n[task.path]\npoints = [[0, 0], [2, 1], [4, 1], [5, 0]]\n\
         [solve]\nevaluations = 2000\nmethod = \"differential-evolution\"\n[solve.differential-evolution]\n\
         population = 8\nstall_generations = 4\n",
        &["population"],
    ),
    (
        "format = 1\nname = \"function\"\n[task.function]\ninput_deg = [0, 20, 40, 60, 80]\noutput_deg = [0, 3, 11, 24, 40]\n\
         [require]\ntransmission_deg_min = 30\n[solve]\ncandidates = 2\nevaluations = 6000\n",
        &["rounds"],
    ),
];

/// The job of one of [`SEARCHES`].
pub fn search_job(text: &str) -> Job {
    let file = problem_file::parse("search.toml", text, None, &[]).expect("it is a problem");
    Job { name: file.name, source: file.source, unit: file.unit, spec: file.spec, front: None }
}

/// Checkpoints: as they are, and signed anew after whatever was done to the state, as somebody could who means harm.
/// A search that goes on from there comes to an end. Those of which the state holds nothing would begin anew, whatever it
/// is: they are left out.
pub fn checkpoint(bytes: &[u8]) {
    if let Err(refusal) = checkpoint::parse("checkpoint.json", bytes) {
        assert!(!refusal.to_string().is_empty());
    }
    let Ok(mut document) = serde_json::from_slice::<serde_json::Value>(bytes) else { return };
    let Some(state) = document.get_mut("state").map(serde_json::Value::take) else { return };
    let searches = searches_of(&state);
    let Ok(state) = serde_json::from_value::<SearchState>(state) else { return };
    for text in searches {
        let job = search_job(text);
        let writer = Writer::new(&job).expect("it has a digest");
        let Some(signed) = writer.bytes(&state) else { return };
        let read = checkpoint::parse("checkpoint.json", &signed).expect("what was written can be read");
        assert_eq!(read.leads_to(&job), None);
        go_on(&job, read.into_state(), &writer);
    }
}

/// The searches of [`SEARCHES`] that go on from a state.
pub fn searches_of(state: &serde_json::Value) -> Vec<&'static str> {
    let holds = |part: &&str| state.get(*part).is_some_and(|part| !part.is_null());
    SEARCHES.into_iter().filter(|(_, parts)| parts.iter().any(holds)).map(|(text, _)| text).collect()
}

/// Goes on from a state to the second boundary.
fn go_on(job: &Job, state: SearchState, writer: &Writer) {
    let (cancel, seen) = (AtomicBool::new(false), AtomicBool::new(false));
    let sink = |state: &SearchState| {
        writer.bytes(state);
        cancel.store(seen.swap(true, Ordering::Relaxed), Ordering::Relaxed);
    };
    let keeper = Keeper::new(state, Duration::ZERO, &sink);
    let context = Context { cancel: &cancel, observer: &|_| {} };
    let finished = run::run_kept(job, &context, Some(&keeper)).expect("it is a search");
    // What a search gives is judged by the referee, whatever it went on from.
    for candidate in &finished.record.candidates {
        assert!(candidate.error.sum_sq.is_finite() && candidate.crank_deg.iter().all(|x| x.is_finite()));
    }
}

/// A candidate of a record as an entry of a comparison, with the figures of the record.
pub fn entry(label: &str, record: &Record, index: usize) -> Option<Entry> {
    let path = &record.problem.resolved.task;
    record.candidates.get(index).map(|candidate| Entry {
        label: label.to_owned(),
        candidate: candidate.clone(),
        target_name: record.problem.name.clone(),
        target: path.points.clone(),
        pairs: path.pairs(),
        kind: path.kind(),
        body: path.body.clone(),
        unit: record.problem.unit,
        measure: record.problem.resolved.measure(),
        of_run: true,
        extent: None,
        untrue: Vec::new(),
    })
}

fn reports(record: &Record) {
    table::candidates_table(record, Colour::Never);
    exact::exact_text(record, true, Colour::Never);
    exact_sheet::exact_svg(record);
    csv::candidates_csv(record);
    assert!(html::report_html(record, 0).ends_with("</html>\n"));
    contact_sheet::contact_sheet_svg(record);
    let mut entries = Vec::new();
    for i in 0..record.candidates.len().min(3) {
        csv::curve_csv(record, i);
        svg::candidate_svg(record, i);
        terminal_plot(record, i, PLOT.0, PLOT.1, Glyphs::Braille);
        entries.extend(entry("label", record, i));
    }
    let comparison = compare(&entries, &[SortKey::Rms], None);
    comparison.table(Colour::Never);
    comparison.csv();
    comparison.svg();
    comparison.json();
    comparison.html();
}
