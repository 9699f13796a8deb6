//! One run: from a problem to its record. It joins the other modules.

use crate::files::problem_file::ProblemFile;
use crate::judge::assess::measure_beside;
use crate::judge::certificate;
use crate::judge::rank::holds_an_exact;
use crate::mechanism::Unit;
use crate::numbers::optimise::population::PopulationError;
use crate::record::digest::NotWritten;
use crate::record::{BestOfKind, Candidate, Front, Picks, ProblemRecord, Reason, Record};
use crate::synthesis::conflicts::Explained;
use crate::synthesis::front::{self, AxesError, FrontRequest};
use crate::synthesis::keeper::Keeper;
use crate::synthesis::picks;
use crate::synthesis::{self, Budget, Observer, SearchOutcome, answers, conflicts, continuation, plan};
use crate::synthesis::{errors_without, offered_cognates, several_loops};
use crate::task::Problem;
use crate::task::TaskError;
use crate::task::forms::precision::{Refusal, precise};
use crate::task::spec::{Method, ProblemSpec};
use serde::Serialize;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A job to run: a problem with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The problem's name.
    pub name: String,
    /// The source of the problem, in words.
    pub source: Option<String>,
    /// The label of lengths.
    pub unit: Option<Unit>,
    /// The problem with every default filled in.
    pub spec: ProblemSpec,
    /// The front to be computed after the search, if any.
    pub front: Option<FrontRequest>,
}

impl Job {
    /// Creates a job from its name and a problem without a source and without a unit.
    pub fn new(name: impl Into<String>, spec: ProblemSpec) -> Self {
        Job { name: name.into(), source: None, unit: None, spec, front: None }
    }
}

impl From<ProblemFile> for Job {
    fn from(ProblemFile { name, source, unit, spec, .. }: ProblemFile) -> Self {
        Job { name, source, unit, spec, front: None }
    }
}

impl From<ProblemRecord> for Job {
    fn from(ProblemRecord { name, source, unit, resolved, .. }: ProblemRecord) -> Self {
        Job { name, source, unit, spec: resolved, front: None }
    }
}

impl TryFrom<Job> for ProblemRecord {
    type Error = NotWritten;

    fn try_from(Job { name, source, unit, spec, .. }: Job) -> Result<Self, NotWritten> {
        ProblemRecord::new(name, source, unit, spec)
    }
}

/// The inputs of a run from its caller.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The cancellation flag; setting it ends the run with its best answer so far.
    pub cancel: &'a AtomicBool,
    /// The callback that receives the progress of the search.
    pub observer: &'a Observer<'a>,
}

/// The reason why a job cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The task is invalid.
    #[error(transparent)]
    Task(#[from] TaskError),
    /// Exact linkages are asked for although there are none to list.
    #[error(transparent)]
    Precision(#[from] Refusal),
    /// A population search cannot be set up.
    #[error(transparent)]
    Population(#[from] PopulationError),
    /// The axes of the front do not go with the problem.
    #[error(transparent)]
    Axes(#[from] AxesError),
    /// The problem cannot be written as data.
    #[error(transparent)]
    NotWritten(#[from] NotWritten),
}

/// The seconds spent on each part of the advice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AdviceSeconds {
    /// The smallest and the best transmitting linkage.
    pub picks: f64,
    /// Costs of the limits on which candidates lie.
    pub costs: f64,
    /// Conflicts of requirements, and the relaxations that help.
    pub conflicts: f64,
    /// Warnings, a family, and a buildable candidate.
    pub buildable: f64,
    /// The front, if one is asked for.
    #[serde(skip_serializing_if = "is_nothing")]
    pub front: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_nothing(seconds: &f64) -> bool {
    *seconds < 1e-6
}

/// A record with the time that its search took.
#[derive(Clone, Debug)]
pub struct Finished {
    /// The record.
    pub record: Record,
    /// Seconds from the checked problem to ranked, refereed candidates.
    pub search_s: f64,
    /// Further seconds for everything computed beside them.
    pub beside_s: f64,
    /// The seconds of each part of `beside_s`.
    pub advice_s: AdviceSeconds,
}

/// Runs a job on the current rayon thread pool; a certificate that its problem asks for is left to [`prove`].
///
/// # Errors
/// [`RunError`] if the job cannot be searched; a search that finds nothing is a record with no accepted candidate, not
/// an error.
pub fn run(job: &Job, context: &Context<'_>) -> Result<Finished, RunError> {
    run_kept(job, context, None)
}

/// Computes the certificate that a record's problem asks for, within its time limit, and puts it into the record, or
/// the reason why there is none. Does nothing if no certificate is asked for or the search was cancelled.
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

/// As [`run`], with a keeper of the state of its search: the search resumes from there, and ends in the same record as
/// one from the beginning.
///
/// # Errors
/// As [`run`].
pub fn run_kept(job: &Job, context: &Context<'_>, keeper: Option<&Keeper<'_>>) -> Result<Finished, RunError> {
    if let Some(front) = &job.front {
        front.check_loads(&job.spec)?;
    }
    let start = Instant::now();
    let problem = Problem::new(job.spec.clone())?;
    if job.spec.solve.method == Method::Continuation {
        precise(&problem)?;
    }
    let budget = Budget::new(context.cancel, job.spec.solve.time_limit_s);
    let inputs =
        synthesis::Context { problem: &problem, budget: &budget, observer: context.observer, keeper };
    let mut outcome = plan::search(inputs)?;
    offered_cognates::offer(inputs, &mut outcome.candidates);
    let search_s = start.elapsed().as_secs_f64();
    let picked = picks::beside(inputs, &mut outcome);
    let mut advice_s = AdviceSeconds::default();
    let mut so_far = search_s;
    let mut lap = |part: &mut f64| {
        let now = start.elapsed().as_secs_f64();
        (*part, so_far) = (now - so_far, now);
    };
    lap(&mut advice_s.picks);
    let explained = explained(inputs, &mut outcome)?;
    // After it: the list of candidates is final, and ranks refer to it.
    continuation::finish(&problem, &mut outcome);
    let mut other_kind = offered_kind(inputs, &outcome);
    lap(&mut advice_s.conflicts);
    // After the conflicts: the search for relaxations may have met an acceptable design.
    errors_without::attach(inputs, &mut outcome);
    lap(&mut advice_s.costs);
    let mut beside = answers::beside(inputs, &mut outcome);
    lap(&mut advice_s.buildable);
    outcome.evaluations += picked.evaluations;
    for candidate in outcome.candidates.iter_mut().chain(&mut beside.buildable).chain(&mut other_kind) {
        measure_beside(&problem, candidate);
    }
    outcome.reason = reached(&problem, &outcome);
    let mut picks = picked.picks.map(|picks| settled(&outcome.candidates, picks));
    let front = job.front.as_ref().map(|request| fronted(inputs, request, &mut outcome, &picked.met));
    if let (Some(picks), Some(front), Some(closest)) = (&mut picks, &front, outcome.candidates.first()) {
        picks::take_better(&problem, closest, picks, front);
    }
    lap(&mut advice_s.front);
    let beside_s = start.elapsed().as_secs_f64() - search_s;
    let of_kinds = match problem.spec().design.compares_kinds() {
        true => BestOfKind::of_all(outcome.candidates.iter().chain(&outcome.others)),
        false => Vec::new(),
    };
    let asked = job.clone().try_into()?;
    let found = Record::new(asked, outcome.used, outcome.reason, outcome.evaluations, outcome.candidates);
    let record = Record {
        family: beside.family,
        buildable: beside.buildable,
        other_kind,
        of_kinds,
        picks,
        front,
        conflict: explained.conflict,
        relaxations: explained.relaxations,
        repeats: outcome.repeats,
        exact: outcome.exact,
        ..found
    };
    Ok(Finished { record, search_s, beside_s, advice_s })
}

/// Computes the front from all that was met; its cost and its end become those of the outcome.
fn fronted(
    context: synthesis::Context<'_>,
    request: &FrontRequest,
    outcome: &mut SearchOutcome,
    met: &[Candidate],
) -> Front {
    let known: Vec<Candidate> =
        outcome.candidates.iter().chain(&outcome.others).chain(met).cloned().collect();
    let found = front::search(context, request, &known, context.problem.spec().solve.evaluations);
    outcome.evaluations += found.evaluations;
    outcome.reason = found.reason.unwrap_or(outcome.reason);
    found.front
}

/// Makes each pick equal to the candidate with the same linkage and crank angles, which has been annotated since it was
/// picked.
fn settled(candidates: &[Candidate], mut picks: Picks) -> Picks {
    for pick in picks.smallest.iter_mut().chain(&mut picks.best_transmission) {
        let is_it = |c: &&Candidate| {
            (c.linkage, &c.crank_deg, &c.t1_at) == (pick.linkage, &pick.crank_deg, &pick.t1_at)
        };
        if let Some(same) = candidates.iter().find(is_it) {
            *pick = same.clone();
        }
    }
    picks
}

/// Returns the reason why a search ended, consistent with its list: a target is reached only if an accepted candidate of
/// the list is exact. A search far from the origin, or one whose best gave way to a cognate, may have found an exact one
/// that is not in the list: then it converged if its best came back, else it stalled.
fn reached(problem: &Problem, outcome: &SearchOutcome) -> Reason {
    if outcome.reason == Reason::TargetReached && !holds_an_exact(problem, &outcome.candidates) {
        let came_back = outcome.repeats.as_ref().is_some_and(|repeats| repeats.hits > 1);
        return if came_back { Reason::Converged } else { Reason::Stalled };
    }
    outcome.reason
}

/// Returns an acceptable six-bar or eight-bar where four-bars alone are searched for, none is acceptable, and advice is asked for.
///
/// As those of the explanation, its evaluations are not those of the search.
fn offered_kind(context: synthesis::Context<'_>, outcome: &SearchOutcome) -> Option<Candidate> {
    let solve = &context.problem.spec().solve;
    let is_called_for = solve.advice && solve.method == Method::Auto && outcome.exact.is_none();
    if !is_called_for || context.stopped() || outcome.candidates.iter().any(|c| c.accepted) {
        return None;
    }
    several_loops::beside_four_bars(context)
}

/// Returns the explanation why nothing is acceptable, if that is so and advice is asked for. If the budget leaves no
/// time for it, the record shows that by its reason: with more time it would hold more.
fn explained(
    context: synthesis::Context<'_>,
    outcome: &mut SearchOutcome,
) -> Result<Explained, PopulationError> {
    let solve = &context.problem.spec().solve;
    let listed = solve.method == Method::Continuation;
    if !solve.advice || listed || outcome.candidates.iter().any(|c| c.accepted) {
        return Ok(Explained::default());
    }
    if let Some(reason) = context.stop_reason() {
        outcome.reason = reason;
        return Ok(Explained::default());
    }
    conflicts::explain(context, outcome)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Evaluations;

    #[test]
    fn a_target_is_reached_only_if_a_listed_accepted_candidate_is_exact() {
        let text =
            "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1]]\n[solve]\ncandidates = 1\n";
        let file = crate::files::problem_file::parse("it.toml", text, None, &[]).expect("a problem");
        let problem = Problem::new(file.spec.clone()).expect("a problem");
        let job = Job::from(file);
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let record = run(&job, &context).expect("it runs").record;
        assert_eq!(record.termination.reason, Reason::TargetReached);
        let mut outcome = SearchOutcome {
            candidates: record.candidates,
            others: Vec::new(),
            used: Vec::new(),
            reason: Reason::TargetReached,
            evaluations: Evaluations::default(),
            exact: None,
            repeats: None,
        };
        assert_eq!(reached(&problem, &outcome), Reason::TargetReached);
        outcome.candidates[0].accepted = false;
        assert_eq!(reached(&problem, &outcome), Reason::Stalled);
        (outcome.candidates[0].accepted, outcome.candidates[0].error.sum_sq) = (true, 1e-9);
        assert_eq!(reached(&problem, &outcome), Reason::Stalled);
        outcome.repeats = Some(crate::record::Repeats::new(9, 2, 2));
        assert_eq!(reached(&problem, &outcome), Reason::Converged);
        outcome.candidates.clear();
        assert_eq!(reached(&problem, &outcome), Reason::Converged);
        outcome.reason = Reason::Cancelled;
        assert_eq!(reached(&problem, &outcome), Reason::Cancelled);
    }

    #[test]
    fn a_record_whose_explanation_found_no_time_says_that_it_cannot_be_repeated() {
        let points = "[[0, 0], [1, 1], [2, 1.5], [3, 1], [4, 0]]";
        for (advice, reason) in [(true, Reason::Cancelled), (false, Reason::Stalled)] {
            let text = format!(
                "format = 1\n[task.path]\npoints = {points}\ntolerance = 1e-9\n[solve]\nadvice = {advice}\n"
            );
            let file = crate::files::problem_file::parse("it.toml", &text, None, &[]).expect("a problem");
            let problem = Problem::new(file.spec).expect("a problem");
            let mut outcome = SearchOutcome {
                candidates: Vec::new(),
                others: Vec::new(),
                used: Vec::new(),
                reason: Reason::Stalled,
                evaluations: Evaluations::default(),
                exact: None,
                repeats: None,
            };
            let flag = AtomicBool::new(true);
            let budget = Budget { cancel: &flag, deadline: None };
            let context = synthesis::Context::new(&problem, &budget);
            let found = explained(context, &mut outcome).expect("no error");
            assert_eq!((found, outcome.reason), (Explained::default(), reason));
        }
    }
}
