//! One job: the problem with its values, run, and its row.

use crate::app::job::run::{Context, Job, run};
use crate::files::problem_file;
use crate::files::sweep_file::typed;
use crate::judge::figures::extent;
use crate::record::sweep::{Best, Plan, Row, Status};
use crate::record::{Evaluations, Record};
use crate::task::Problem;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

/// The message of a row whose job met a bug.
const BUG: &str = "a bug of linkwright: please report it with this problem";

/// The jobs of a plan.
#[derive(Debug)]
pub struct Jobs<'a> {
    plan: &'a Plan,
    beside: Vec<(&'a str, &'a str)>,
}

/// A row with the evaluations that it cost, none of a job that was refused.
pub type Costed = (Row, Evaluations);

impl<'a> Jobs<'a> {
    /// Returns the jobs of a plan.
    pub fn of(plan: &'a Plan) -> Self {
        let beside = plan.beside.iter().map(|file| (file.name.as_str(), file.text.as_str()));
        Jobs { plan, beside: beside.collect() }
    }

    /// Runs a job on the current rayon thread pool; `None` if it was cancelled. A job whose values contradict each other
    /// has a row with the reason, and so has one that meets a bug: neither ends a sweep.
    pub fn run(&self, number: u64, cancel: &AtomicBool) -> Option<Costed> {
        let values = self.plan.values(number);
        let row = |status, message| Row {
            job: number,
            values: values.clone(),
            status,
            message,
            termination: None,
            candidates: 0,
            accepted: 0,
            evaluations: 0,
            best: None,
            record: None,
        };
        let refused = |why: String| (row(Status::Refused, Some(why)), Evaluations::default());
        let job = match self.job(number) {
            Ok(job) => job,
            Err(why) => return Some(refused(why)),
        };
        let context = Context { cancel, observer: &|_| {} };
        let ran = catch_unwind(AssertUnwindSafe(|| {
            let record = run(&job, &context).map_err(|why| why.to_string())?.record;
            let best = best_of(&record).map_err(|why| why.to_string())?;
            Ok::<_, String>((record, best))
        }));
        // What was cut short can look like a result that stalled.
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        Some(match ran {
            Err(_) => (row(Status::Bug, Some(BUG.into())), Evaluations::default()),
            Ok(Err(why)) => refused(why),
            Ok(Ok((record, best))) => {
                let accepted = record.candidates.iter().filter(|c| c.accepted).count();
                let status = if accepted > 0 { Status::Accepted } else { Status::NothingAcceptable };
                let evaluations = record.evaluations;
                let row = Row {
                    termination: Some(record.termination.reason),
                    candidates: record.candidates.len(),
                    accepted,
                    evaluations: evaluations.objective,
                    best,
                    record: self.plan.records.then(|| Box::new(record)),
                    ..row(status, None)
                };
                (row, evaluations)
            }
        })
    }

    /// Returns a job, or the reason why its problem is refused.
    fn job(&self, number: u64) -> Result<Job, String> {
        let values = self.plan.values(number);
        let overrides: Vec<(String, String)> =
            values.iter().map(|(key, value)| (key.clone(), typed(value))).collect();
        let problem = &self.plan.problem;
        let read = problem_file::parse_beside(&problem.name, &problem.text, &self.beside, &overrides);
        match read {
            Ok(file) => Ok(Job::from(file)),
            Err(diagnostic) => Err(match diagnostic.help {
                Some(help) => format!("{}; {help}", diagnostic.message),
                None => diagnostic.message,
            }),
        }
    }

    /// Returns the reason why a job would be refused before its search, if it would be.
    pub fn refusal(&self, number: u64) -> Option<String> {
        let job = match self.job(number) {
            Ok(job) => job,
            Err(why) => return Some(why),
        };
        Problem::new(job.spec).err().map(|why| why.to_string())
    }
}

/// Returns the figures of the first candidate.
fn best_of(record: &Record) -> Result<Option<Best>, crate::task::TaskError> {
    let Some(first) = record.candidates.first() else { return Ok(None) };
    let problem = Problem::new(record.problem.resolved.clone())?;
    Ok(Some(Best {
        accepted: first.accepted,
        error: first.error,
        linkage_type: first.linkage_type,
        transmission_worst_deg: first.transmission_deg.worst,
        link_ratio: first.link_ratio,
        extent: extent(&problem, first),
        longest: first.linkage.longest(),
        linkage: first.linkage,
    }))
}
