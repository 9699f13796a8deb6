//! One run: a problem in, a record out. This is where the rooms meet.

use crate::assess::to_raw;
use crate::certificate;
use crate::problem::Problem;
use crate::problem::precision::{Refusal, precision_points};
use crate::problem::spec::{Method, ProblemSpec};
use crate::record::{FORMAT, MethodRecord, ProblemRecord, Reason, Record, Termination, Tool, Unit};
use crate::search::keeper::Keeper;
use crate::search::{Budget, Observer, answers, cognates, conflicts, continuation, costs, plan};
use crate::solve::population::PopulationError;
use crate::task::TaskError;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// What is to be run.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The problem's name.
    pub name: String,
    /// Where it comes from, in words.
    pub source: Option<String>,
    /// The label of lengths.
    pub unit: Option<Unit>,
    /// The problem with every default filled in.
    pub spec: ProblemSpec,
}

/// What a run needs of its caller.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Set it to end the run with its best so far.
    pub cancel: &'a AtomicBool,
    /// Told where the search stands.
    pub observer: &'a Observer<'a>,
}

/// Why a job cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The task is no task.
    #[error(transparent)]
    Task(#[from] TaskError),
    /// Exact linkages are asked for where there are none to list.
    #[error(transparent)]
    Precision(#[from] Refusal),
    /// A population search cannot be set up.
    #[error(transparent)]
    Population(#[from] PopulationError),
    /// The problem cannot be written as data.
    #[error("the problem cannot be written as JSON: {0}")]
    Json(String),
}

/// A record with the time that its search took.
#[derive(Clone, Debug)]
pub struct Finished {
    /// The record.
    pub record: Record,
    /// Seconds from the checked problem to ranked, refereed candidates.
    pub search_s: f64,
    /// Seconds more for what stands beside them: warnings, a family, and the search for something to build.
    pub beside_s: f64,
}

/// Runs a job on the current rayon thread pool; a certificate that its problem asks for is left to [`prove`].
///
/// # Errors
/// [`RunError`] when the job makes no search; a search that finds nothing is a record with no accepted
/// candidate, not an error.
pub fn run(job: &Job, context: &Context<'_>) -> Result<Finished, RunError> {
    run_kept(job, context, None)
}

/// Works out the certificate that a record's problem asks for, within its time limit, and puts it into the record; or
/// why there is none. Nothing is done where none is asked for or the search was cancelled.
pub fn prove(record: &mut Record, cancel: &AtomicBool, progress: &mut dyn FnMut(&certificate::Progress)) {
    let Some(asked) = record.problem.resolved.solve.certify else { return };
    if record.termination.reason == Reason::Cancelled {
        return;
    }
    let limit = Duration::try_from_secs_f64(asked.time_limit_s).ok();
    let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
    let request = certificate::Request { gap: asked.gap };
    match certificate::certify(record, &request, cancel, deadline, progress) {
        Ok(certificate) => record.certificate = Some(certificate),
        Err(why) => record.no_certificate = Some(why.to_string()),
    }
}

/// As [`run`], with a keeper of where its search stands: the search begins where the keeper says, and ends in the
/// same record as one from the beginning.
///
/// # Errors
/// As [`run`].
pub fn run_kept(job: &Job, context: &Context<'_>, keeper: Option<&Keeper<'_>>) -> Result<Finished, RunError> {
    let start = Instant::now();
    let problem = Problem::new(job.spec.clone())?;
    if job.spec.solve.method == Method::Continuation {
        precision_points(&problem)?;
    }
    let budget = Budget::new(context.cancel, job.spec.solve.time_limit_s);
    let mut outcome = plan::search_kept(&problem, &budget, context.observer, keeper)?;
    cognates::offer(&problem, &mut outcome.candidates);
    continuation::finish(&problem, &mut outcome);
    let search_s = start.elapsed().as_secs_f64();
    costs::attach(&problem, &mut outcome, &budget);
    let explained = conflicts::explain(&problem, &mut outcome, &budget, context.observer)?;
    let mut beside = answers::beside(&problem, &mut outcome, &budget, context.observer);
    for candidate in outcome.candidates.iter_mut().chain(&mut beside.buildable) {
        candidate.error.to_raw = to_raw(&problem, candidate);
    }
    let beside_s = start.elapsed().as_secs_f64() - search_s;
    let reproducible = !matches!(outcome.reason, Reason::TimeLimit | Reason::Cancelled);
    let record = Record {
        format: FORMAT,
        tool: Tool { name: env!("CARGO_PKG_NAME").into(), version: env!("CARGO_PKG_VERSION").into() },
        problem: ProblemRecord {
            name: job.name.clone(),
            source: job.source.clone(),
            unit: job.unit,
            digest: digest(&job.spec)?,
            resolved: job.spec.clone(),
        },
        seed: job.spec.solve.seed,
        method: MethodRecord { asked: job.spec.solve.method, used: outcome.used },
        termination: Termination { reason: outcome.reason, reproducible },
        evaluations: outcome.evaluations,
        family: beside.family,
        buildable: beside.buildable,
        candidates: outcome.candidates,
        conflict: explained.conflict,
        relaxations: explained.relaxations,
        certificate: None,
        no_certificate: None,
        repeats: outcome.repeats,
        exact: outcome.exact,
    };
    Ok(Finished { record, search_s, beside_s })
}

/// SHA-256 of what decides a search: task, design, require, objective, variables, method with its
/// parameters, seed.
///
/// # Errors
/// [`RunError::Json`] when the problem cannot be written as data.
pub fn digest(spec: &ProblemSpec) -> Result<String, RunError> {
    #[derive(Serialize)]
    struct Decides<'a> {
        task: &'a crate::problem::spec::TaskSpec,
        design: &'a crate::problem::spec::DesignSpec,
        require: &'a crate::problem::spec::RequireSpec,
        objective: crate::problem::spec::Objective,
        // Absent where it is the default: records from before there was a choice keep their digest.
        #[serde(skip_serializing_if = "Option::is_none")]
        variables: Option<crate::problem::spec::Variables>,
        method: crate::problem::spec::Method,
        genetic: &'a crate::solve::genetic::GeneticParameters,
        differential_evolution: &'a crate::solve::differential_evolution::DifferentialEvolutionParameters,
        seed: u64,
    }
    let solve = &spec.solve;
    let text = serde_json::to_vec(&Decides {
        task: &spec.task,
        design: &spec.design,
        require: &spec.require,
        objective: solve.objective,
        variables: Some(solve.variables).filter(|v| !v.is_nine()),
        method: solve.method,
        genetic: &solve.genetic,
        differential_evolution: &solve.differential_evolution,
        seed: solve.seed,
    })
    .map_err(|e| RunError::Json(e.to_string()))?;
    Ok(Sha256::digest(&text).iter().map(|byte| format!("{byte:02x}")).collect())
}
