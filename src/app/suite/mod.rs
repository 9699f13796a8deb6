//! The suite: benchmark problems whose answer is known, each run from many seeds, and compared with the population
//! searches at equal evaluations and with published answers.
//!
//! Answers of a path are compared by their sum of squared distances, those of a motion by their objective, which counts
//! the angles too, those of a function by theirs, in degrees squared. Population searches do not take poses or pairs: a motion
//! and a function have none beside them.
//!
//! Every run is [`run`] on the problem of its file, with two changes: the seed, and a single candidate. Runs go one
//! after the other on one thread, so that their times can be compared. All figures in a [`Suite`] are computed by the
//! referee; only the times differ from one machine to another.

pub mod choice;
pub mod literature;
pub mod published;

use crate::app::job::run::{Context, Finished, Job, RunError, prove, run};
use crate::files::problem_file::{ProblemFile, Published};
use crate::judge::rank::{exact_cost, exact_sum_sq, searched};
use crate::record::statistics::{Bar, Summary};
use crate::record::suite::{
    FORMAT, Known, LeftOut, MethodResult, MotionErrors, ProblemResult, PublishedResult, Run, Smaller, Suite,
};
use crate::record::{Candidate, Certificate, Reason, Record, Tool};
use crate::task::Problem;
use crate::task::spec::{CertifySpec, MAX_EVALUATIONS, Method, ProblemSpec};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicBool, Ordering};

/// The population searches on the design vector that are run for comparison with the problem's own method.
pub const POPULATIONS: [Method; 2] = [Method::Genetic, Method::DifferentialEvolution];

/// The options of a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The number of seeds for each problem: seeds 1 to this.
    pub seeds: u64,
    /// The number of seeds for each population search: seeds 1 to this, but at most `seeds`.
    pub population_seeds: u64,
    /// The command that makes the same suite again; stored with the figures.
    pub command: String,
    /// The name of the folder of the problems, where they are not those of the literature; stored with the figures.
    pub collection: Option<String>,
    /// The options for certifying the best answer of each problem, on all threads; `None` for no certificates.
    pub certify: Option<CertifySpec>,
}

impl Default for Options {
    fn default() -> Self {
        Options { seeds: 10, population_seeds: 5, command: String::new(), collection: None, certify: None }
    }
}

impl Options {
    fn population_seeds(&self) -> u64 {
        self.population_seeds.min(self.seeds)
    }

    /// Returns the number of runs for these problems.
    pub fn runs(&self, problems: &[ProblemFile]) -> u64 {
        let of = |problem: &ProblemFile| {
            let populations = populations_of(&problem.spec).map_or(0, |methods| methods.len() as u64);
            self.seeds + populations * self.population_seeds()
        };
        problems.iter().filter(|problem| known(problem).is_ok()).map(of).sum()
    }
}

/// The progress of a suite, with the current run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// The name of the problem.
    pub problem: &'a str,
    /// The method.
    pub method: Method,
    /// The seed.
    pub seed: u64,
    /// The number of finished runs.
    pub done: u64,
    /// The number of all runs.
    pub total: u64,
}

/// A callback that receives the progress of a suite: at the beginning of a run and repeatedly during it.
pub type StepObserver<'a> = dyn Fn(&Step<'_>) + Sync + 'a;

/// The reason why a suite cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SuiteError {
    /// A problem that cannot be searched.
    #[error("{problem}: {source}")]
    Run {
        /// The name of the problem.
        problem: String,
        /// The reason.
        source: RunError,
    },
    /// The thread for the searches cannot be created.
    #[error("no thread to search with: {0}")]
    Thread(String),
}

/// The number of poses from which on only finitely many four-bars meet them (Burmester 1888).
const FINITELY_MANY: usize = 5;

/// The reason why fewer poses have nothing to compare with.
const OF_A_FAMILY: &str = "no objective under [expect] (a whole family of linkages meets fewer than five poses exactly, so \
    that there is no least error to compare)";

/// Returns what a problem's answers are compared with, or the reason why nothing is known that they could be.
fn known(file: &ProblemFile) -> Result<Known, &'static str> {
    let expect = file.expect.as_ref();
    let Some(body) = &file.spec.task.body else {
        let best = expect.and_then(|expect| Some((expect.best_known_sum_sq?, expect.goal_sum_sq)));
        let (best_known_sum_sq, goal) = best.ok_or("no best_known_sum_sq under [expect]")?;
        return Ok(Known::Path { best_known_sum_sq, goal_sum_sq: goal.unwrap_or(best_known_sum_sq) });
    };
    match expect.and_then(|expect| expect.objective) {
        Some(best_known_objective) if file.spec.task.is_function() => {
            Ok(Known::Function { best_known_objective, of_places: file.spec.task.is_of_places() })
        }
        Some(best_known_objective) => {
            Ok(Known::Motion { best_known_objective, angle_weight: body.angle_weight })
        }
        None if file.spec.task.is_function() => Err("no objective under [expect]"),
        None if body.angle_deg.len() < FINITELY_MANY => Err(OF_A_FAMILY),
        None => Err("no objective under [expect]"),
    }
}

/// Runs a suite: each problem from seeds 1 to [`Options::seeds`] with the method of its file, then with each of
/// [`POPULATIONS`] that suits it with the median number of evaluations of the first method. Problems without an expected
/// `best_known_sum_sq` (of a path) or `objective` (of a motion) are left out, and named with the reason.
///
/// `cancel` ends the current run; that run does not count, and the results before it are returned.
///
/// # Errors
/// [`SuiteError`].
pub fn suite(
    problems: &[ProblemFile],
    options: &Options,
    cancel: &AtomicBool,
    observer: &StepObserver<'_>,
) -> Result<Suite, SuiteError> {
    let pool =
        ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| SuiteError::Thread(e.to_string()))?;
    let total = options.runs(problems);
    let mut runner = Runner { pool, cancel, observer, done: 0, total, cut_short: false };
    let (mut comparable, mut left_out) = (Vec::new(), Vec::new());
    for file in problems {
        match known(file) {
            Ok(known) => comparable.push((file, known)),
            Err(why) => left_out.push(LeftOut { name: file.name.clone(), why: why.to_owned() }),
        }
    }
    let mut results = Vec::with_capacity(comparable.len());
    for (file, known) in comparable {
        let result = runner
            .problem(file, known, options)
            .map_err(|source| SuiteError::Run { problem: file.name.clone(), source })?;
        if !result.search.runs.is_empty() {
            results.push(result);
        }
        if runner.cancelled() {
            break;
        }
    }
    Ok(Suite {
        format: FORMAT,
        tool: Tool::this(),
        command: options.command.clone(),
        collection: options.collection.clone(),
        seeds: options.seeds,
        threads: 1,
        complete: runner.done == runner.total && !runner.cut_short,
        problems: results,
        left_out,
    })
}

/// The state shared by the runs of a suite.
struct Runner<'a> {
    pool: ThreadPool,
    cancel: &'a AtomicBool,
    observer: &'a StepObserver<'a>,
    done: u64,
    total: u64,
    /// Whether a certificate was cancelled.
    cut_short: bool,
}

impl Runner<'_> {
    fn step<'s>(&self, problem: &'s str, method: Method, seed: u64) -> Step<'s> {
        Step { problem, method, seed, done: self.done, total: self.total }
    }

    fn cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    fn problem(
        &mut self,
        file: &ProblemFile,
        known: Known,
        options: &Options,
    ) -> Result<ProblemResult, RunError> {
        let problem = Problem::new(file.spec.clone())?;
        let (exact, populations) = match known {
            Known::Path { .. } => (exact_sum_sq(&problem), populations_of(&file.spec)),
            Known::Motion { .. } | Known::Function { .. } => {
                (exact_cost(&problem), populations_of(&file.spec))
            }
        };
        let bar = Bar { goal: known.goal(), best_known: known.best(), exact };
        let (search, best) = self.method(file, &problem, file.spec.clone(), options.seeds, &bar)?;
        let (certificate, no_certificate) = match (options.certify, best) {
            (Some(certify), Some(record)) => self.certificate(record, certify),
            (Some(_), None) => (None, Some("there is no accepted answer".into())),
            (None, _) => (None, None),
        };
        let no_populations = populations.err().map(str::to_owned);
        let mut found = Vec::with_capacity(POPULATIONS.len());
        for method in populations.into_iter().flatten() {
            let Some(evaluations) = search.summary.median_evaluations.filter(|_| !self.cancelled()) else {
                break;
            };
            let mut spec = file.spec.clone();
            spec.solve.method = method;
            spec.solve.evaluations = evaluations.clamp(1, MAX_EVALUATIONS);
            found.push(self.method(file, &problem, spec, options.population_seeds(), &bar)?.0);
        }
        let smaller_than_best_known = smallest(std::iter::once(&search).chain(&found), &bar);
        let published: Vec<PublishedResult> = file
            .expect
            .iter()
            .flat_map(|expect| &expect.published)
            .map(|entry| evaluated(&problem, entry))
            .collect();
        Ok(ProblemResult {
            name: file.name.clone(),
            source: file.source.clone(),
            points: problem.task().len(),
            known,
            search,
            populations: found,
            no_populations,
            smaller_than_best_known,
            best_published: best_published(&published).cloned(),
            published,
            certificate,
            no_certificate,
        })
    }

    /// Returns the certificate of a run's answer, or the reason why there is none; neither if it is cancelled.
    fn certificate(
        &mut self,
        mut record: Record,
        certify: CertifySpec,
    ) -> (Option<Certificate>, Option<String>) {
        record.problem.resolved.solve.certify = Some(certify);
        let name = record.problem.name.clone();
        let step = self.step(&name, record.problem.resolved.solve.method, record.seed);
        prove(&mut record, self.cancel, &mut |_| (self.observer)(&step));
        if self.cancelled() {
            self.cut_short = true;
            return (None, None);
        }
        (record.certificate, record.no_certificate)
    }

    /// Returns the runs of a method, and the record with the best accepted answer.
    fn method(
        &mut self,
        file: &ProblemFile,
        problem: &Problem,
        mut spec: ProblemSpec,
        seeds: u64,
        bar: &Bar,
    ) -> Result<(MethodResult, Option<Record>), RunError> {
        spec.solve.candidates = 1;
        let mut best: Option<(f64, Record)> = None;
        let (method, evaluations_at_most) = (spec.solve.method, spec.solve.evaluations);
        let mut job = Job { spec, ..Job::from(file.clone()) };
        let mut runs = Vec::new();
        for seed in 1..=seeds {
            if self.cancelled() {
                break;
            }
            job.spec.solve.seed = seed;
            let step = self.step(&file.name, method, seed);
            (self.observer)(&step);
            let context = Context { cancel: self.cancel, observer: &|_| (self.observer)(&step) };
            let Finished { record, search_s, .. } = self.pool.install(|| run(&job, &context))?;
            if record.termination.reason == Reason::Cancelled {
                break;
            }
            let first = record.candidates.first();
            let outcome = Run {
                seed,
                accepted: first.is_some_and(|c| c.accepted),
                sum_sq: first.map(|c| c.error.sum_sq),
                to_curve_sum_sq: first.map(|c| c.error.to_curve.sum_sq),
                two_sided: first.and_then(|c| c.error.two_sided),
                motion: first.and_then(|c| motion_errors(problem, c)),
                evaluations: record.evaluations.objective,
                search_s,
                reason: record.termination.reason,
            };
            self.done += 1;
            let figure = outcome.figure().filter(|_| outcome.accepted);
            if let Some(figure) = figure.filter(|f| best.as_ref().is_none_or(|(least, _)| f < least)) {
                best = Some((figure, record));
            }
            runs.push(outcome);
        }
        let result = MethodResult { method, evaluations_at_most, summary: Summary::of(&runs, bar), runs };
        Ok((result, best.map(|(_, record)| record)))
    }
}

/// Returns the population searches that suit a problem, or the reason why there are none.
fn populations_of(spec: &ProblemSpec) -> Result<[Method; 2], &'static str> {
    let task = &spec.task;
    if !spec.design.is_of_four_bars() {
        return Err("population searches are of four-bars");
    }
    if task.output.as_ref().is_some_and(|output| output.ranges.is_free()) {
        return Err("population searches do not take free ranges");
    }
    if task.body.is_some() && task.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
        return Err("population searches do not take free crank angles among prescribed ones");
    }
    Ok(POPULATIONS)
}

/// Returns the errors of an answer of a motion or of a function; `None` for one of a path.
fn motion_errors(problem: &Problem, candidate: &Candidate) -> Option<MotionErrors> {
    problem.task().body()?;
    // The sum of squares even where the largest deviation is minimised: what is known is one.
    let objective = searched(problem, candidate);
    let rms_deg = candidate.error.of_link().map(|angle| angle.rms_deg);
    Some(MotionErrors { objective, rms: candidate.error.rms, rms_deg })
}

/// Returns the smallest accepted answer of all runs, if it is smaller than the best known.
fn smallest<'a>(methods: impl Iterator<Item = &'a MethodResult>, bar: &Bar) -> Option<Smaller> {
    methods
        .filter_map(|of| {
            let best = of.summary.best.as_ref().filter(|best| bar.is_beaten_by(best.figure()))?;
            let objective = best.motion.map(|motion| motion.objective);
            Some(Smaller { method: of.method, seed: best.seed, sum_sq: best.sum_sq, objective })
        })
        .min_by(|one, other| one.figure().total_cmp(&other.figure()))
}

fn evaluated(problem: &Problem, entry: &Published) -> PublishedResult {
    let candidate = published::evaluate(problem, entry);
    let unmet = candidate.iter().flat_map(|c| &c.requirements).filter(|r| !r.met);
    PublishedResult {
        source: entry.source.clone(),
        printed_sum_sq: entry.printed_sum_sq,
        sum_sq: candidate.as_ref().map(|c| c.error.sum_sq),
        to_curve_sum_sq: candidate.as_ref().map(|c| c.error.to_curve.sum_sq),
        accepted: candidate.as_ref().map(|c| c.accepted),
        unmet: unmet.map(|r| r.name.clone()).collect(),
    }
}

fn best_published(published: &[PublishedResult]) -> Option<&PublishedResult> {
    let least = |of: fn(&PublishedResult) -> Option<f64>| {
        let known = published.iter().filter_map(|entry| Some((of(entry)?, entry)));
        known.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, entry)| entry)
    };
    least(|entry| entry.sum_sq).or_else(|| least(|entry| entry.printed_sum_sq))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::problem_file;

    fn parsed(text: &str) -> ProblemFile {
        problem_file::parse("one.toml", text, None, &[]).expect("a problem")
    }

    fn path(expect: &str) -> ProblemFile {
        parsed(&format!("format = 1\n[task.path]\npoints = [[0, 0], [2, 1], [4, 0]]\n{expect}"))
    }

    fn motion(poses: usize, expect: &str) -> ProblemFile {
        let poses = &[[0, 0, 0], [2, 1, 10], [4, 0, 15], [5, 2, 30], [7, 1, 50]][..poses];
        parsed(&format!("format = 1\n[task.motion]\nposes = {poses:?}\n{expect}"))
    }

    fn published(source: &str, printed_sum_sq: Option<f64>, sum_sq: Option<f64>) -> PublishedResult {
        PublishedResult {
            source: source.into(),
            printed_sum_sq,
            sum_sq,
            to_curve_sum_sq: None,
            accepted: None,
            unmet: Vec::new(),
        }
    }

    #[test]
    fn the_best_published_answer_is_the_best_by_our_own_evaluation() {
        let flattering = published("printed small, evaluates large", Some(1e-9), Some(0.5));
        let true_best = published("printed large", Some(0.3), Some(0.2));
        let only_printed = published("no vector", Some(1e-12), None);
        let all = [flattering, true_best, only_printed];
        assert_eq!(best_published(&all), Some(&all[1]));
        assert_eq!(
            best_published(&all[2..]),
            Some(&all[2]),
            "without a vector the printed figure is all there is"
        );
        assert_eq!(best_published(&[published("nothing", None, None)]), None);
    }

    #[test]
    fn the_number_of_runs_counts_no_more_population_seeds_than_seeds() {
        let options = |seeds| Options { seeds, ..Options::default() };
        let paths: Vec<ProblemFile> = (0..3).map(|_| path("[expect]\nbest_known_sum_sq = 0\n")).collect();
        assert_eq!(options(10).runs(&paths), 3 * (10 + 2 * 5));
        assert_eq!(options(2).runs(&paths[..1]), 2 + 2 * 2);
    }

    #[test]
    fn the_number_of_runs_counts_the_population_searches_that_suit_and_nothing_that_is_left_out() {
        let options = Options { seeds: 10, ..Options::default() };
        let free = parsed(
            "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\ninput_range_deg = 60\noutput_range_deg = \"free\"\n\
             [expect]\nobjective = 0\n",
        );
        let problems = [motion(5, "[expect]\nobjective = 0\n"), motion(5, ""), path(""), free];
        assert_eq!(options.runs(&problems), 10 + 2 * 5 + 10);
    }

    #[test]
    fn a_problem_with_nothing_to_compare_with_says_why() {
        assert_eq!(known(&path("")), Err("no best_known_sum_sq under [expect]"));
        assert_eq!(known(&motion(5, "[expect]\nrms_deg = 1\n")), Err("no objective under [expect]"));
        let family = known(&motion(4, "")).expect_err("nothing is known");
        assert!(family.contains("fewer than five poses exactly"), "{family}");
        let given = known(&motion(3, "[expect]\nobjective = 2\n")).expect("it is given");
        assert_eq!((given.best(), given.goal()), (2.0, 2.0));
        let path = known(&path("[expect]\nbest_known_sum_sq = 1\ngoal_sum_sq = 3\n")).expect("it is given");
        assert_eq!((path.best(), path.goal()), (1.0, 3.0));
    }
}
