//! Synthesizes linkages for drawn strokes: their errors with and without the limit on the longest link, the distance to
//! a longer search, and the times.
//!
//! ```text
//! cargo bench --bench strokes                              all 40 strokes
//! cargo bench --bench strokes -- closed/ellipse            strokes whose name contains the word
//!     --seed N            of the searches (1)
//!     --evaluations N     budget of a search (200000)
//!     --candidates N      number of answers asked for (1)
//!     --threads N         of a search (1)
//!     --ladder            search under more and more requirements in place of the table: is a looser problem ever worse?
//!     --reference FILE    compare with the references in this JSON file; those that it lacks are searched and added
//!     --reference-seeds N         searches for a reference, of seeds 1 to N (20)
//!     --reference-evaluations N   budget of each (200000)
//!     --reference-candidates N    number of answers asked for in it; more make it search longer (5)
//! ```
//!
//! Each stroke is a CSV file of 60 points and is read as the command line reads a bare CSV file; those in `closed/` with
//! `--set task.path.closed=true`. No link, |CP| and |DP| included, is longer than [`LONGEST`] sizes; the column *free*
//! is the error without this limit. The reference is the best of 20 searches under the same limits, each with its own seed, its own
//! budget and more answers asked for: one search with 20 times the budget would end where it believes its best, and be
//! no reference for that belief.
//!
//! Errors are the rms over the size, in percent, of the best accepted candidate. Columns *ms* and *advice ms* are the
//! times of the search and of what is computed beside it, *picks ms* the part of the picks. The searches without the limit and for the references give
//! no advice.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use ladder::{NEVER_WORSE, Rung, largest_factor, size};
use linkwright::internals::app::job::run::{Context, Finished, Job, run};
use linkwright::internals::files::problem_file::load_any;
use linkwright::internals::record::{Candidate, MET_TOLERANCE, Reason};
use linkwright::internals::task::spec::SolveSpec;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

#[path = "../tests/common/ladder.rs"]
mod ladder;

/// The greatest length of a link, in sizes.
const LONGEST: f64 = 3.0;
/// Number of searches for a reference, and of the answers asked for in each.
const SEEDS: u64 = 20;
const REFERENCE_CANDIDATES: usize = 5;
/// An error within this factor of the reference counts as near.
const NEAR: f64 = 1.02;
/// The same for a search that says it has found the best.
const BELIEVED: f64 = 1.01;

struct Arguments {
    filter: String,
    seed: u64,
    evaluations: u64,
    candidates: usize,
    threads: usize,
    ladder: bool,
    reference: Option<PathBuf>,
    reference_seeds: u64,
    reference_evaluations: u64,
    reference_candidates: usize,
}

impl Arguments {
    fn read() -> Arguments {
        let budget = SolveSpec::default().evaluations;
        let mut arguments = Arguments {
            filter: String::new(),
            seed: 1,
            evaluations: budget,
            candidates: 1,
            threads: 1,
            ladder: false,
            reference: None,
            reference_seeds: SEEDS,
            reference_evaluations: budget,
            reference_candidates: REFERENCE_CANDIDATES,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
            match word.as_str() {
                "--bench" => {}
                "--ladder" => arguments.ladder = true,
                "--seed" => arguments.seed = value().parse().expect("a whole number"),
                "--evaluations" => arguments.evaluations = value().parse().expect("a whole number"),
                "--candidates" => arguments.candidates = value().parse().expect("a whole number"),
                "--threads" => arguments.threads = value().parse().expect("a whole number"),
                "--reference" => arguments.reference = Some(value().into()),
                "--reference-seeds" => arguments.reference_seeds = value().parse().expect("a whole number"),
                "--reference-evaluations" => {
                    arguments.reference_evaluations = value().parse().expect("a whole number");
                }
                "--reference-candidates" => {
                    arguments.reference_candidates = value().parse().expect("a whole number");
                }
                other if other.starts_with('-') => panic!("{other} is no argument of this bench"),
                other => arguments.filter = other.into(),
            }
        }
        arguments
    }
}

/// A drawn stroke.
struct Stroke {
    /// Its folder and file without the ending: `closed/heart`.
    name: String,
    file: PathBuf,
    closed: bool,
}

/// Lists the strokes whose name contains a word, closed ones first, by name.
fn strokes(filter: &str) -> Vec<Stroke> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/strokes");
    let mut found = Vec::new();
    for kind in ["closed", "open"] {
        let entries = fs::read_dir(root.join(kind)).expect("the folder of strokes");
        let mut files: Vec<_> = entries.map(|entry| entry.expect("its files").path()).collect();
        files.sort();
        found.extend(files.into_iter().map(|file| {
            let stem = file.file_stem().expect("a name").to_string_lossy();
            Stroke { name: format!("{kind}/{stem}"), closed: kind == "closed", file }
        }));
    }
    found.retain(|stroke| stroke.name.contains(filter));
    found
}

/// The settings of one search.
#[derive(Clone, Copy)]
struct Search {
    rung: Rung,
    seed: u64,
    evaluations: u64,
    candidates: usize,
    limited: bool,
    advice: bool,
}

/// Returns the length of the longest of ground, a, b, c, d and e.
fn longest(candidate: &Candidate) -> f64 {
    let linkage = candidate.linkage.four_bar().expect("a four-bar");
    linkage.longest_link().max(linkage.crank_side()).max(linkage.follower_side())
}

/// The outcome of a search.
struct Outcome {
    finished: Finished,
    size: f64,
}

impl Outcome {
    fn of(stroke: &Stroke, search: Search) -> Outcome {
        let set = [
            ("task.path.closed", stroke.closed.to_string()),
            ("solve.seed", search.seed.to_string()),
            ("solve.evaluations", search.evaluations.to_string()),
            ("solve.candidates", search.candidates.to_string()),
            ("solve.advice", search.advice.to_string()),
        ];
        let set = set.map(|(key, value)| (key.to_owned(), value));
        let mut file = load_any(&stroke.file, &set).unwrap_or_else(|why| panic!("{}: {why}", stroke.name));
        let size = size(&file.spec);
        file.spec.require.longest_max = search.limited.then_some(LONGEST * size);
        search.rung.asks(&mut file.spec);
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let finished = run(&Job::from(file), &context).expect("it runs");
        let outcome = Outcome { finished, size };
        let within = outcome.longest_over_size().is_none_or(|l| l <= LONGEST * (1.0 + MET_TOLERANCE));
        assert!(within || !search.limited, "{}: the accepted candidate meets the limit", stroke.name);
        outcome
    }

    fn best(&self) -> Option<&Candidate> {
        self.finished.record.candidates.first().filter(|c| c.accepted)
    }

    fn rms_over_size(&self) -> Option<f64> {
        self.best().map(|c| c.error.rms_over_size)
    }

    fn longest_over_size(&self) -> Option<f64> {
        self.best().map(|c| longest(c) / self.size)
    }

    fn reason(&self) -> Reason {
        self.finished.record.termination.reason
    }
}

/// The best known answer for a stroke.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Reference {
    /// Absent if nothing was accepted.
    rms_over_size: Option<f64>,
    longest_over_size: Option<f64>,
    seed: u64,
    reason: Reason,
    /// Evaluations used.
    evaluations: u64,
    /// Evaluations allowed.
    budget: u64,
    /// Number of answers asked for.
    candidates: usize,
}

/// The references of a file, by the names of the strokes.
struct References<'a> {
    file: &'a Path,
    known: BTreeMap<String, Reference>,
}

impl References<'_> {
    fn read(file: &Path) -> References<'_> {
        let known = if file.exists() {
            let text = fs::read_to_string(file).expect("the file of references");
            serde_json::from_str(&text).expect("references of strokes")
        } else {
            BTreeMap::new()
        };
        References { file, known }
    }

    /// Returns the reference of a stroke; an unknown one is searched for and written to the file.
    fn of(&mut self, stroke: &Stroke, with: &Arguments) -> Reference {
        if let Some(known) = self.known.get(&stroke.name) {
            return *known;
        }
        let error = |r: &Reference| r.rms_over_size.unwrap_or(f64::INFINITY);
        let of_seeds = (1..=with.reference_seeds).map(|seed| {
            let (budget, candidates) = (with.reference_evaluations, with.reference_candidates);
            let rung = Rung::Nothing;
            let search = Search { rung, seed, evaluations: budget, candidates, limited: true, advice: false };
            let outcome = Outcome::of(stroke, search);
            Reference {
                rms_over_size: outcome.rms_over_size(),
                longest_over_size: outcome.longest_over_size(),
                seed,
                reason: outcome.reason(),
                evaluations: outcome.finished.record.evaluations.objective,
                budget,
                candidates,
            }
        });
        let best = of_seeds.min_by(|a, b| error(a).total_cmp(&error(b))).expect("there are seeds");
        self.known.insert(stroke.name.clone(), best);
        let text = serde_json::to_string_pretty(&self.known).expect("references are data");
        fs::write(self.file, text + "\n").expect("the references are written");
        best
    }
}

/// The results for a stroke.
struct Row {
    limited: Outcome,
    free: Outcome,
    reference: Option<Reference>,
}

impl Row {
    /// Returns the error over that of the reference; infinite if only the reference has an accepted candidate.
    fn ratio(&self) -> Option<f64> {
        let reference = self.reference?.rms_over_size;
        match (self.limited.rms_over_size(), reference) {
            (Some(error), Some(reference)) if error > 0.0 || reference > 0.0 => Some(error / reference),
            (Some(_), Some(_)) => Some(1.0),
            (Some(_), None) => Some(0.0),
            (None, Some(_)) => Some(f64::INFINITY),
            (None, None) => None,
        }
    }

    /// Returns whether the search ended because it believed its answer.
    fn believed(&self) -> bool {
        matches!(self.limited.reason(), Reason::Converged | Reason::TargetReached)
    }

    fn print(&self, name: &str) {
        let percent = |error: Option<f64>| error.map_or("-".into(), |e| format!("{:.4}", 100.0 * e));
        let Finished { record, search_s, beside_s, advice_s } = &self.limited.finished;
        let reason = serde_json::to_value(self.limited.reason()).expect("a reason is data");
        println!(
            "| {name} | {} | {} | {} | {} | {:.1} | {:.1} | {:.1} | {} | {} | {} |",
            percent(self.limited.rms_over_size()),
            self.limited.longest_over_size().map_or("-".into(), |l| format!("{l:.2}")),
            reason.as_str().expect("a reason is a word"),
            record.evaluations.objective,
            1e3 * search_s,
            1e3 * beside_s,
            1e3 * advice_s.picks,
            percent(self.free.rms_over_size()),
            self.free.longest_over_size().map_or("-".into(), |l| format!("{l:.2}")),
            self.ratio().map_or("-".into(), |r| format!("{r:.4}")),
        );
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2])
}

fn summary(rows: &[Row]) {
    let n = rows.len();
    let count = |test: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| test(row)).count();
    let short =
        |outcome: &Outcome| outcome.longest_over_size().is_some_and(|l| l <= LONGEST * (1.0 + MET_TOLERANCE));
    println!();
    println!("accepted: {} of {n}; without the limit {}", count(&|row| row.limited.best().is_some()), {
        count(&|row| row.free.best().is_some())
    });
    println!(
        "longest link at most {LONGEST} sizes: {} of {n}; without the limit {}",
        count(&|row| short(&row.limited)),
        count(&|row| short(&row.free))
    );
    println!("converged or target-reached: {} of {n}", count(&Row::believed));
    let compared = count(&|row| row.ratio().is_some());
    if compared > 0 {
        let within = |row: &Row, factor: f64| row.ratio().is_some_and(|r| r <= factor);
        let believed = count(&|row| row.believed() && row.ratio().is_some());
        let right = count(&|row| row.believed() && within(row, BELIEVED));
        println!("within {NEAR} of the reference: {} of {compared}", count(&|row| within(row, NEAR)));
        println!("converged or target-reached and within {BELIEVED} of the reference: {right} of {believed}");
    }
    let seconds: Vec<f64> = rows.iter().map(|row| row.limited.finished.search_s).collect();
    let beside: Vec<f64> = rows.iter().map(|row| row.limited.finished.beside_s).collect();
    let picks: Vec<f64> = rows.iter().map(|row| row.limited.finished.advice_s.picks).collect();
    let worst = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    println!(
        "search: median {:.1} ms, worst {:.1} ms, all {:.1} s",
        1e3 * median(&seconds),
        1e3 * worst(&seconds),
        seconds.iter().sum::<f64>()
    );
    for (name, times) in [("advice", &beside), ("picks", &picks)] {
        let part: Vec<f64> = times.iter().zip(&seconds).map(|(b, s)| b / s).collect();
        println!(
            "{name}: median {:.1} ms, worst {:.1} ms; of the search's time {:.2} in all, median {:.2}, worst {:.2}",
            1e3 * median(times),
            1e3 * worst(times),
            times.iter().sum::<f64>() / seconds.iter().sum::<f64>(),
            median(&part),
            worst(&part)
        );
    }
}

/// Searches each stroke under more and more requirements, and counts the strokes of which no looser problem has a worse
/// answer than a tighter one.
fn ladder(strokes: &[Stroke], search: Search) {
    println!("| stroke | nothing % | type % | 30 degrees % | footprint % | worst of a looser one |");
    println!("|---|---|---|---|---|---|");
    let mut kept = 0;
    for stroke in strokes {
        let errors = Rung::ALL.map(|rung| {
            let outcome = Outcome::of(stroke, Search { rung, ..search });
            outcome.rms_over_size().unwrap_or(f64::INFINITY)
        });
        let worst = largest_factor(&errors);
        kept += usize::from(worst <= NEVER_WORSE);
        let [nothing, types, transmission, footprint] =
            errors.map(|error| if error.is_finite() { format!("{:.4}", 100.0 * error) } else { "-".into() });
        println!("| {} | {nothing} | {types} | {transmission} | {footprint} | {worst:.4} |", stroke.name);
    }
    println!();
    println!("a looser problem never worse than {NEVER_WORSE} of a tighter one: {kept} of {}", strokes.len());
}

fn main() {
    let arguments = Arguments::read();
    let strokes = strokes(&arguments.filter);
    assert!(!strokes.is_empty(), "no stroke is called {}", arguments.filter);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build().expect("threads");
    let Arguments { seed, evaluations, candidates, .. } = arguments;
    let limited = Search { rung: Rung::Nothing, seed, evaluations, candidates, limited: true, advice: true };
    if arguments.ladder {
        pool.install(|| ladder(&strokes, limited));
        return;
    }
    let free = Search { limited: false, advice: false, ..limited };
    let mut references = arguments.reference.as_deref().map(References::read);
    println!(
        "| stroke | error % | longest / size | reason | evaluations | ms | advice ms | picks ms | free error % | free longest / size | / reference |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let rows: Vec<Row> = strokes
        .iter()
        .map(|stroke| {
            let row = pool.install(|| Row {
                limited: Outcome::of(stroke, limited),
                free: Outcome::of(stroke, free),
                reference: references.as_mut().map(|references| references.of(stroke, &arguments)),
            });
            row.print(&stroke.name);
            row
        })
        .collect();
    summary(&rows);
}
