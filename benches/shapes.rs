//! Shapes and letters by four-bars, six-bars and eight-bars that can be built, side by side.
//!
//! ```text
//! cargo bench --bench shapes                    every problem of problems/shapes
//! cargo bench --bench shapes -- letter-A        those whose file name contains the word
//!     --evaluations N     of each search (200000)
//!     --time-limit S      seconds of each search at most (10); a search that it ends cannot be repeated
//!     --threads N         (1)
//!     --write             writes results/shapes.md and results/shapes.svg
//! ```
//!
//! Every transmission angle is at least 30 degrees over the turn, no length exceeds three diagonals, no two differ by more than
//! 100 times, all points are met in order. *rms* is that of the points over the rms radius of the shape; *both ways* is the
//! mean distance of shape and curve from each other, both ways together, over the same radius; *worst* the largest of these
//! distances, likewise.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::problem_file::load;
use linkwright::internals::mechanism::{Complex, LinkageKind, bounding_box, centroid_and_radius, point};
use linkwright::internals::record::statistics::median;
use linkwright::internals::record::{Candidate, Record};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The kinds that are compared.
const KINDS: [LinkageKind; 3] = [LinkageKind::FourBar, LinkageKind::SixBar, LinkageKind::EightBar];
/// Letters that have to have an accepted six-bar, and the largest median of their two-sided mean distance.
const LETTERS: (usize, f64) = (24, 0.02);
/// The side of a picture, and samples of its curve.
const SIDE: f64 = 96.0;
const SAMPLES: usize = 240;

struct Options {
    filter: String,
    evaluations: u64,
    time_limit_s: f64,
    threads: usize,
    write: bool,
}

fn options() -> Options {
    let mut options =
        Options { filter: String::new(), evaluations: 200_000, time_limit_s: 10.0, threads: 1, write: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--bench" => {}
            "--evaluations" => options.evaluations = value().parse().expect("a whole number"),
            "--time-limit" => options.time_limit_s = value().parse().expect("seconds"),
            "--threads" => options.threads = value().parse().expect("a whole number"),
            "--write" => options.write = true,
            other if other.starts_with('-') => panic!("{other} is no argument of this bench"),
            other => options.filter = other.into(),
        }
    }
    options
}

/// The problem files, by name.
fn problems(filter: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/shapes");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("it is there")
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml") && name(path).contains(filter))
        .collect();
    files.sort();
    files
}

fn name(path: &Path) -> String {
    path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned())
}

/// The best answer of one kind.
struct Answer {
    best: Option<Candidate>,
    seconds: f64,
}

fn answer(file: &Path, kind: LinkageKind, options: &Options) -> (Record, Answer) {
    let set = [
        ("design.mechanism", kind.name().to_owned()),
        ("require.input", "full-turn".to_owned()),
        ("solve.evaluations", options.evaluations.to_string()),
        ("solve.time_limit_s", options.time_limit_s.to_string()),
        ("solve.candidates", "1".to_owned()),
        ("solve.advice", "false".to_owned()),
    ];
    let set = set.map(|(key, value)| (key.to_owned(), value));
    let problem = load(file, &set).unwrap_or_else(|why| panic!("{}: {why}", file.display()));
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let finished = run(&Job::from(problem), &context).expect("it runs");
    let best = finished.record.candidates.first().filter(|c| c.accepted).cloned();
    (finished.record, Answer { best, seconds: finished.search_s })
}

/// The figures of an answer as cells: rms, both ways, worst, seconds.
fn cells(answer: &Answer, radius: f64) -> String {
    match answer.best.as_ref().and_then(|best| Some((best, best.error.two_sided?))) {
        Some((best, both)) => format!(
            "{:.5} | {:.5} | {:.4} | {:.1}",
            best.error.rms / radius,
            both.mean_over_radius,
            both.worst / radius,
            answer.seconds
        ),
        None => format!("none | | | {:.1}", answer.seconds),
    }
}

/// Draws a shape and, over it, the curve of an answer, in a square.
fn picture(out: &mut String, [x, y]: [f64; 2], (points, closed): (&[Complex], bool), answer: &Answer) {
    let [low, high] = bounding_box(points.iter().copied());
    let scale = 0.8 * SIDE / (high - low).re.max((high - low).im);
    let middle = (low + high) * 0.5;
    let spot = |p: Complex| {
        let at = (p - middle) * scale;
        format!("{:.1} {:.1}", x + 0.5 * SIDE + at.re, y + 0.5 * SIDE - at.im)
    };
    let dots: Vec<String> = points.iter().map(|p| format!("M{}h0", spot(*p))).collect();
    let _ = write!(
        out,
        "<path d=\"{}\" stroke=\"#d55e00\" stroke-width=\"2.6\" stroke-linecap=\"round\"/>",
        dots.concat()
    );
    let Some(best) = &answer.best else { return };
    let (first, last) = (best.crank_deg[0], best.crank_deg[best.crank_deg.len() - 1]);
    let span = if closed { TAU } else { (last - first).to_radians() };
    let on = |i: usize| {
        let angle = first.to_radians() + span * i as f64 / SAMPLES as f64;
        best.linkage.joints_with(angle, best.t1_at[0]).map(|at| spot(at.joints.coupler_point))
    };
    let curve: Vec<String> = (0..=SAMPLES).filter_map(on).collect();
    let _ = write!(
        out,
        "<path d=\"M{}\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.4\"/>",
        curve.join("L")
    );
}

fn main() {
    let options = options();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().expect("threads");
    let head = "| shape | four-bar: rms | both ways | worst | s | six-bar: rms | both ways | worst | s \
                | eight-bar: rms | both ways | worst | s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|";
    println!("{head}");
    let (mut table, mut drawn) = (format!("{head}\n"), String::new());
    let (mut letters, mut both_ways, mut row) = (0, Vec::new(), 0.0);
    for file in problems(&options.filter) {
        let mut cells_of_kinds = Vec::new();
        for (column, kind) in KINDS.into_iter().enumerate() {
            let (record, found) = pool.install(|| answer(&file, kind, &options));
            let points: Vec<Complex> =
                record.problem.resolved.task.points.iter().copied().map(point).collect();
            cells_of_kinds.push(cells(&found, centroid_and_radius(&points).1));
            let place = [70.0 + SIDE * column as f64, 24.0 + SIDE * row];
            picture(&mut drawn, place, (&points, record.problem.resolved.task.closed), &found);
            if name(&file).starts_with("letter-") && kind == LinkageKind::SixBar {
                letters += 1;
                both_ways.extend(found.best.and_then(|best| Some(best.error.two_sided?.mean_over_radius)));
            }
        }
        let _ = write!(
            drawn,
            "<text x=\"4\" y=\"{:.1}\" font-family=\"sans-serif\" font-size=\"11\">{}</text>",
            24.0 + SIDE * (row + 0.5),
            name(&file)
        );
        row += 1.0;
        let line = format!("| {} | {} |", name(&file), cells_of_kinds.join(" | "));
        println!("{line}");
        table.push_str(&line);
        table.push('\n');
    }
    let mut said = String::new();
    if letters > 0 {
        let accepted = both_ways.len();
        let middle = median(&both_ways).unwrap_or(f64::INFINITY);
        said = format!(
            "Letters with an accepted six-bar: {accepted} of {letters}; median of both ways {middle:.4}."
        );
        println!("\n{said}");
        if letters == 26 {
            assert!(accepted >= LETTERS.0 && middle <= LETTERS.1, "{said}");
        }
    }
    if options.write {
        let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("results");
        let text = format!(
            "# Shapes and letters\n\nWritten by `cargo bench --bench shapes -- --write`: {} evaluations of each search, {} s at \
             most, {} thread(s). Errors are parts of the rms radius of the shape; see the bench for their meaning and for the \
             limits.\n\n{said}\n\n{table}\n![The shapes, and the curves of the three kinds](shapes.svg)\n",
            options.evaluations, options.time_limit_s, options.threads
        );
        std::fs::write(results.join("shapes.md"), text).expect("it can be written");
        let (width, height) = (70.0 + 3.0 * SIDE, 24.0 + SIDE * row);
        let heads: String = KINDS
            .iter()
            .enumerate()
            .map(|(i, kind)| {
                let x = 70.0 + SIDE * (i as f64 + 0.5);
                format!(
                    "<text x=\"{x}\" y=\"14\" text-anchor=\"middle\" font-family=\"sans-serif\" font-size=\"11\">{kind}</text>"
                )
            })
            .collect();
        let picture = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{heads}{drawn}</svg>\n"
        );
        std::fs::write(results.join("shapes.svg"), picture).expect("it can be written");
    }
}
