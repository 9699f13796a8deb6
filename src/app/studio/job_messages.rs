//! The messages about jobs, as JSON; the schemas are made from these types.

use super::messages::{Ask, Shown, Target};
use crate::files::problem_file::ProblemFile;
use crate::mechanism::Unit;
use crate::record::{Candidate, Record};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A search to begin, whose result is saved. Exactly one of `ask` and `problem` is given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JobAsk {
    /// The target and the requirements as they stand in a tab. Its name is that of the job and of its folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ask: Option<Ask>,
    /// The text of a problem file. Its points stand in it: files are not read for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Keys of `[solve]` to set, with values as `--set` takes them: `{"solve.evaluations": "1000000"}`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, String>,
    /// Replace an earlier result of that name; without it such a name is refused.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub replace: bool,
}

/// The state of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JobState {
    /// It searches.
    Running,
    /// Its search has ended by itself.
    Done,
    /// Its search was stopped, or its time was over; the best so far is saved.
    Stopped,
    /// The studio ended before the job did.
    BrokenOff,
    /// Another program, such as `linkwright synth`, works in its folder.
    Elsewhere,
    /// It could not be run or saved.
    Failed,
    /// Its folder does not hold a whole result.
    Unreadable,
}

/// A job, or a result that was made before.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JobShown {
    /// Its name: that of its folder.
    pub name: String,
    /// Its state.
    pub state: JobState,
    /// The same in words.
    pub said: String,
    /// Whether it can go on: from its checkpoint if there is one, else from the beginning.
    pub resumable: bool,
    /// While it runs: how far it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub progress: Option<JobProgress>,
    /// The result in its folder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result: Option<JobResult>,
}

impl JobShown {
    /// Returns a job without progress and result.
    pub(super) fn new(name: &str, state: JobState, said: String, resumable: bool) -> Self {
        JobShown { name: name.to_owned(), state, said, resumable, progress: None, result: None }
    }
}

/// The progress of a search.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JobProgress {
    /// The phase of the search.
    pub phase: String,
    /// Evaluations so far.
    pub evaluations: u64,
    /// The budget; most searches end before it is used up.
    pub budget: u64,
    /// Evaluations a second.
    pub rate: f64,
    /// The best rms error so far, in the problem's unit of length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_rms: Option<f64>,
    /// Whether that one is acceptable.
    pub accepted: bool,
    /// Seconds since it began.
    pub elapsed_s: f64,
    /// Seconds that are left at most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_s: Option<f64>,
}

/// The figures of a result's record.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JobResult {
    /// The number of target points.
    pub points: usize,
    /// The label of lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// The seed of every draw.
    pub seed: u64,
    /// The method asked for.
    pub method: String,
    /// The number of candidates.
    pub candidates: usize,
    /// The number of accepted candidates.
    pub accepted: usize,
    /// The best candidate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best: Option<Best>,
    /// Evaluations of the objective.
    pub evaluations: u64,
    /// Whether the same problem and seed give the same record again.
    pub reproducible: bool,
    /// The version of linkwright that wrote it.
    pub version: String,
}

/// The figures of a result's best candidate.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Best {
    /// The root of the mean squared error.
    pub rms: f64,
    /// The largest error.
    pub max: f64,
    /// Its type.
    #[serde(rename = "type")]
    pub linkage_type: String,
    /// The worst transmission angle, degrees from 0 to 90.
    pub transmission_deg: f64,
    /// Whether every requirement is met.
    pub accepted: bool,
}

impl From<&Candidate> for Best {
    fn from(candidate: &Candidate) -> Best {
        Best {
            rms: candidate.error.rms,
            max: candidate.error.max,
            linkage_type: candidate.type_name().to_owned(),
            transmission_deg: candidate.transmission_deg.worst,
            accepted: candidate.accepted,
        }
    }
}

impl From<&Record> for JobResult {
    fn from(record: &Record) -> JobResult {
        JobResult {
            points: record.problem.resolved.task.points.len(),
            unit: record.problem.unit,
            seed: record.seed,
            method: record.method.asked.name().to_owned(),
            candidates: record.candidates.len(),
            accepted: record.candidates.iter().filter(|c| c.accepted).count(),
            best: record.candidates.first().map(Best::from),
            evaluations: record.evaluations.objective,
            reproducible: record.termination.reproducible,
            version: record.tool.version.clone(),
        }
    }
}

/// All jobs: those that run and all results of the folder, by name.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JobList {
    /// The folder, as it was named.
    pub folder: String,
    /// The jobs.
    pub jobs: Vec<JobShown>,
    /// The number of further jobs that are not listed.
    pub more: usize,
}

/// A saved result, opened.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Opened {
    /// The edit that asks the same in a tab, if a tab can hold it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ask: Option<Ask>,
    /// The reason why it cannot, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// The problem.
    #[serde(flatten)]
    pub target: Target,
    /// The candidates, better first.
    pub candidates: Vec<Shown>,
    /// The names of the result's files.
    pub files: Vec<String>,
}

impl Opened {
    /// Opens a record; `files` are the names of its result's files.
    pub(super) fn new(record: Record, files: Vec<String>) -> Opened {
        let candidates = record.candidates.iter().map(Shown::of).collect();
        let target = Target::from(&record.problem);
        let file = ProblemFile::of(record.problem);
        let (ask, why_not) = match Ask::of(&file) {
            Ok(ask) => (Some(ask), None),
            Err(why) => (None, Some(why.to_string())),
        };
        Opened { ask, why_not, target, candidates, files }
    }
}
