//! The method `continuation`: all linkages through nine precision points, or through poses and points of which there are
//! finitely many, as candidates, alone or beside the approximate answers of `auto`.
//!
//! The targets are solved once ([`crate::numbers::nine_point`]); bounds and requirements do not enter the equations, they choose among
//! the answers. If `auto` gets fewer acceptable exact answers than it was asked for, it goes on to approximate. Exact
//! linkages that a requirement forbids are not used as starts for that: they led to no better answer than those that
//! are drawn, at a tenth to a third more evaluations.

use super::{Context, Progress, SearchOutcome};
use crate::judge::certified::{certified, nearly_exact, same, target};
use crate::judge::exact_linkages::{Class, Depth, classes};
use crate::judge::rank::{count_distinct, divided, holds_an_exact};
use crate::numbers::nine_point;
use crate::numbers::nine_point::certificate::{Certificate, certify, certify_all};
use crate::numbers::nine_point::distinct::not_proved_distinct;
use crate::numbers::nine_point::{Options, Reality, Solution, Solved, Target};
use crate::record::{
    Candidate, Census, Certified, Completeness, Evaluations, ExactRecord, Reason, generic_classes,
};
use crate::task::Problem;
use crate::task::forms::precision::{Counted, Precise, counted};
use crate::task::spec::Method;
use rayon::prelude::*;

/// The name of the method in the record.
const NAME: &str = "continuation";

/// The exact answers of a problem.
#[derive(Clone, Debug)]
pub struct Exact {
    /// The census and the list of linkages, for the record.
    pub record: ExactRecord,
    /// The real classes, best first.
    pub classes: Vec<Class>,
}

/// Lists the real classes, with their certificates if they have one and all figures are computed, and counts them in
/// the census.
pub fn listed(
    problem: &Problem,
    target: &Precise,
    (census, completeness): (Census, Completeness),
    real: &[Solution],
    depth: Depth,
) -> Exact {
    let classes = classes(problem, target, real, depth);
    let proofs: Vec<Option<Certified>> = match depth {
        Depth::Whole => classes.par_iter().map(|class| certified(problem, target, &class.best)).collect(),
        Depth::Glance => vec![None; classes.len()],
    };
    let count = |of: fn(&Class) -> bool| classes.iter().filter(|class| of(class)).count();
    let census = Census {
        degenerate: real.len() - classes.len(),
        one_circuit: count(|c| c.one_circuit),
        in_order: count(|c| c.in_order),
        free_of_defects: count(|c| c.free_of_defects),
        ..census
    };
    let linkages = classes.iter().zip(proofs).map(|(class, proof)| class.listed(proof)).collect();
    let Counted { kind, poses, pivots } = counted(problem);
    let generic = census.classes == generic_classes(kind, poses, pivots);
    Exact { record: ExactRecord { kind, poses, pivots, census, generic, completeness, linkages }, classes }
}

/// Lists all real linkages of a quick solve, for a target that moves: without certificates and without distances to
/// whole curves.
pub fn glanced(problem: &Problem, target: &Precise, solved: &Solved) -> Exact {
    let real = solved.classes.iter().filter(|class| class.reality == Reality::Real);
    let real: Vec<Solution> = real.map(|class| class.solution).collect();
    listed(problem, target, ended(solved), &real, Depth::Glance)
}

/// Returns the census of the paths and the completeness, in the record's terms; nothing is certified yet.
fn ended(solved: &Solved) -> (Census, Completeness) {
    let paths = &solved.census;
    let census = Census {
        tracked: paths.tracked,
        finite: paths.finite,
        classes: paths.distinct,
        duplicate: paths.duplicates,
        singular: paths.singular,
        failed: paths.failed,
        real: paths.real,
        real_curve: paths.curve_only,
        complex: paths.complex,
        not_certified: paths.distinct,
        ..Census::default()
    };
    let completeness = match solved.completeness() {
        nine_point::Completeness::Complete => Completeness::Complete,
        nine_point::Completeness::NonGeneric { .. } => Completeness::NonGeneric,
        nine_point::Completeness::Incomplete { .. } => Completeness::Incomplete,
        nine_point::Completeness::Cancelled => Completeness::Cancelled,
    };
    (census, completeness)
}

impl Exact {
    fn candidates(&self) -> Vec<Candidate> {
        self.classes.iter().map(|class| class.best.clone()).collect()
    }

    /// Returns whether no further search is needed: exact answers alone were asked for, or there are enough of them.
    pub fn suffices(&self, problem: &Problem) -> bool {
        let solve = &problem.spec().solve;
        let accepted: Vec<Candidate> = self.candidates().into_iter().filter(|c| c.accepted).collect();
        solve.method == Method::Continuation
            || count_distinct(problem, &accepted, solve.candidates) >= solve.candidates
    }

    /// Returns the exact answers as the outcome of a search.
    pub fn alone(self, context: Context<'_>) -> SearchOutcome {
        let problem = context.problem;
        let (candidates, others) = divided(problem, self.candidates(), problem.spec().solve.candidates);
        let reason =
            if holds_an_exact(problem, &candidates) { Reason::TargetReached } else { Reason::Converged };
        SearchOutcome {
            candidates,
            others,
            used: vec![NAME.into()],
            reason: context.stop_reason().unwrap_or(reason),
            evaluations: Evaluations::default(),
            exact: Some(self.record),
            repeats: None,
        }
    }

    /// Returns the exact answers together with the outcome of a search by approximation.
    pub fn beside(self, context: Context<'_>, mut outcome: SearchOutcome) -> SearchOutcome {
        let problem = context.problem;
        outcome.choose_anew(context, self.candidates(), Vec::new());
        let reached = holds_an_exact(problem, &outcome.candidates);
        if reached && matches!(outcome.reason, Reason::Converged | Reason::Stalled) {
            outcome.reason = Reason::TargetReached;
        }
        outcome.reason = context.stop_reason().unwrap_or(outcome.reason);
        outcome.used.insert(0, NAME.into());
        outcome.exact = Some(self.record);
        // The hits were counted for approximate answers.
        outcome.repeats = None;
        outcome
    }
}

/// Adds certificates to the final candidates and their ranks to the list: a cognate, or a design that was met while a
/// conflict was looked for, may have taken a candidate's place, and ranks are given anew. Does nothing if there are no exact answers.
pub fn finish(problem: &Problem, outcome: &mut SearchOutcome) {
    let Some(exact) = &mut outcome.exact else { return };
    let Some(target) = target(problem) else { return };
    let bar = nearly_exact(problem);
    exact.linkages.iter_mut().for_each(|class| class.rank = 0);
    for candidate in outcome.candidates.iter_mut().filter(|c| c.error.sum_sq <= bar) {
        candidate.certified = certified(problem, &target, candidate);
        for class in &mut exact.linkages {
            let forms = std::iter::once(&class.linkage).chain(class.others.iter().map(|form| &form.linkage));
            if forms.into_iter().any(|form| same(form, &candidate.linkage)) {
                class.rank = candidate.rank;
            }
        }
    }
}

/// Certifies a class by another of its cognates: a solution that is badly conditioned in one may be well conditioned in
/// the next.
fn of_a_cognate(target: &Target, solution: &Solution) -> Option<Certificate> {
    let images = solution.images(&target.displacements);
    images[1..3].iter().filter(|image| image.is_finite()).find_map(|image| certify(target, image).ok())
}

/// Computes the exact answers; `None` if the points have none or the method does not ask for them.
pub fn solve(context: Context<'_>) -> Option<Exact> {
    let problem = context.problem;
    if !matches!(problem.spec().solve.method, Method::Auto | Method::Continuation) {
        return None;
    }
    let precise = target(problem)?;
    let target = &precise.target;
    let progress = |ended: usize, of: usize| (context.observer)(&Progress::of(NAME, ended as u64, of as u64));
    let solved = nine_point::solve(target, &Options::default(), &progress, context.budget.cancel);
    let solutions: Vec<Solution> = solved.classes.iter().map(|class| class.solution).collect();
    let proofs: Vec<Option<Certificate>> = certify_all(target, &solutions)
        .into_par_iter()
        .zip(&solutions)
        .map(|(proof, solution)| proof.ok().or_else(|| of_a_cognate(target, solution)))
        .collect();
    let certificates: Vec<Certificate> = proofs.iter().flatten().copied().collect();
    // Real solutions, as refined by the certificate.
    let real: Vec<Solution> = solved
        .classes
        .iter()
        .zip(&proofs)
        .filter(|(class, _)| class.reality == Reality::Real)
        .map(|(class, proof)| proof.as_ref().map_or(class.solution, |proof| proof.refined))
        .collect();
    let (census, completeness) = ended(&solved);
    let census = Census {
        certified: certificates.len(),
        not_certified: census.classes - certificates.len(),
        reality_proved: solved
            .classes
            .iter()
            .zip(&proofs)
            .filter(|(class, proof)| proof.as_ref().is_some_and(|proof| class.reality == proof.reality))
            .count(),
        not_told_apart: not_proved_distinct(&certificates).len(),
        ..census
    };
    Some(listed(problem, &precise, (census, completeness), &real, Depth::Whole))
}
