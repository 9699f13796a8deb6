//! Search strategies: multistart rounds, populations and continuation; the choice of the answers (distinct ones,
//! cognates, families, warnings, buildable ones); what the requirements cost; and the relaxations that help if nothing
//! is acceptable.
//!
//! | module | holds |
//! |---|---|
//! | [`answers`] | the parts of a record beside its ranked candidates: warnings, the family of exact answers, and a buildable candidate |
//! | [`atlas`] | an atlas of coupler curves: a table of linkages from which those whose curves resemble a given target are taken as starts |
//! | [`belief`] | stopping rule of a multistart search: the best answer is accepted as the global optimum after repeated hits |
//! | [`buildable`] | the best buildable candidate, for a problem whose best candidate by error has warnings |
//! | [`coarse`] | coarsening of dense targets: a search explores the problem with fewer points and fits the answer to all points |
//! | [`conflicts`] | conflict analysis: which requirements cannot be met together, and the least relaxation after which an answer is acceptable |
//! | [`constants`] | the tuning constants of the searches, by search |
//! | [`context`] | the inputs that every search is given, as one value |
//! | [`continuation`] | the method `continuation`: all linkages through nine precision points, as candidates, alone or beside the approximate answers of `auto` |
//! | [`driver`] | the loop of every search in batches: states saved, a batch run, progress reported, the stopping rule asked |
//! | [`dyad_chains`] | search for dyad chains (six-bars, eight-bars) that draw a path, with free or prescribed timing |
//! | [`dyads`] | Burmester's problem: the dyads that guide a body through given poses, exactly or nearly, and the linkages of two of them |
//! | `ellipse` | the ellipse through the points of a closed target that is nearly one |
//! | [`errors_without`] | the error that is left without each requirement that is active at the best candidate |
//! | `family` | families of exact answers, along which the transmission angle is raised |
//! | [`fit_state`] | the unknowns of a linkage in the fits of its kind, and the end of such a fit: what polishes of all kinds have in common |
//! | [`frame`] | the canonical frame in which problems of free timing are searched, and the way back of their candidates |
//! | [`free`] | multistart search for free timing: starts by arc length or from the atlas, joint Levenberg-Marquardt fits on the torus, and a stopping rule by repeated hits of the best answer |
//! | [`front`] | the front of a problem: the trade-off between error, transmission angle, extent and other figures, by fits under tightened limits |
//! | `function_starts` | starts of function generation: linear solutions of Freudenstein's equation over a grid of offsets |
//! | [`keeper`] | checkpoints of long searches: the state of a search at a batch boundary, and the keeper that saves it |
//! | [`live`] | live fitting to a target that the user moves: known candidates follow it by warm starts, and the answers of a search join them |
//! | [`local`] | the local searches by least squares, chosen by the timing |
//! | [`motion`] | multistart search for the poses of a body with free timing: starts from dyads, joint fits, and a stopping rule by repeated hits |
//! | [`moves`] | starts made from known ends: near one, or along the difference of two |
//! | [`multistart`] | multistart: Levenberg-Marquardt fits from many starts, in rounds |
//! | [`nearest`] | positions at which a given linkage is nearest to a task's points: for linkages that were not placed by a search |
//! | [`offered_cognates`] | the offer of Roberts cognates beside the candidates of a search |
//! | [`picks`] | the smallest and the best transmitting linkage whose error is nearly that of the closest candidate |
//! | [`plan`] | the plan of a search: the phases of each method, in their order |
//! | [`polish`] | polish after a search by least squares: minimises the largest deviation, brings answers within tolerances, and gains the last digits of answers on which a limit is active |
//! | [`pose_curves`] | the circle-point and centre-point curves of four poses, with how well linkages of their dyads transmit |
//! | [`population`] | the population searches on the design vector or in reduced variables: genetic, differential evolution, and uniform sampling as the baseline for comparison |
//! | [`reassign`] | correspondence between target points and coupler curve: assigns the points to curve samples in their order, by dynamic programming |
//! | [`reduced_fitness`] | fitness of a population search in reduced variables: ratios and at most two angles in, violation and cost out |
//! | [`relaxed`] | search with one requirement left out, whose results are then fitted under all requirements |
//! | `repeated` | what the multistart searches by repeated hits share: the best answer so far, and when it is believed |
//! | [`repeats`] | repeated hits of the best answer, counted over independent rounds |
//! | [`required`] | ends whose points have strayed to circuits or branches that the referee will refuse, and starts that lead back |
//! | [`rounds`] | multistart search for prescribed timing in the physical parameters |
//! | [`several_loops`] | search for six-bars and eight-bars: the limits of a problem as those of [`dyad_chains`], and its answers as judged candidates |
//! | `sliders` | multistart search for linkages with a slider |
//! | [`snap`] | snapping: lengths are brought to stock sizes, and the free parameters fitted again |
//! | [`starts`] | starts of local searches: shapes drawn by type, positions by timing, the rest by linear least squares |
//! | [`states`] | the states of the searches in a checkpoint: data alone |
//! | [`tightened`] | fits of a known linkage under tightened limits, judged by the problem itself |
//! | [`variable_projection`] | multistart search for prescribed timing by variable projection (the reduced form) |

pub mod answers;
pub mod atlas;
pub mod belief;
pub mod buildable;
pub mod coarse;
pub mod conflicts;
mod constants;
pub mod context;
pub mod continuation;
mod driver;
pub mod dyad_chains;
pub mod dyads;
mod ellipse;
pub mod errors_without;
mod family;
pub mod fit_state;
pub(crate) mod fixture;
mod frame;
pub mod free;
pub mod front;
mod function_starts;
pub mod keeper;
pub mod live;
mod local;
mod motion;
mod moves;
pub mod multistart;
pub mod nearest;
pub mod offered_cognates;
pub mod picks;
pub mod plan;
pub mod polish;
pub mod population;
pub mod pose_curves;
mod reassign;
pub mod reduced_fitness;
mod relaxed;
mod repeated;
mod repeats;
mod required;
mod rounds;
pub mod several_loops;
mod sliders;
pub mod snap;
pub mod starts;
mod states;
mod stopping_tests;
mod tightened;
pub mod variable_projection;

pub use context::Context;
pub use driver::Found;

use crate::judge::assess::measure_curve;
use crate::judge::rank::divided;
use crate::mechanism::effort::is_stopped_by_a_test;
use crate::record::{Candidate, Evaluations, ExactRecord, Reason, Repeats};
use rayon::prelude::*;
use std::ops::AddAssign;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The limits that stop a search from outside.
#[derive(Clone, Copy, Debug)]
pub struct Budget<'a> {
    /// The cancellation flag; setting it ends the search with its best answer so far.
    pub cancel: &'a AtomicBool,
    /// The time limit, if one was asked for.
    pub deadline: Option<Instant>,
}

impl<'a> Budget<'a> {
    /// Creates a budget whose time limit counts from now.
    pub fn new(cancel: &'a AtomicBool, time_limit_s: Option<f64>) -> Self {
        let limit = time_limit_s.and_then(|s| Duration::try_from_secs_f64(s).ok());
        Budget { cancel, deadline: limit.and_then(|limit| Instant::now().checked_add(limit)) }
    }

    /// Returns whether the search should end now.
    pub fn stopped(&self) -> bool {
        self.stop_reason().is_some()
    }

    /// Returns the reason why the search should end now, if there is one.
    pub fn stop_reason(&self) -> Option<Reason> {
        if is_stopped_by_a_test() || self.cancel.load(Ordering::Relaxed) {
            return Some(Reason::Cancelled);
        }
        self.deadline.filter(|deadline| Instant::now() >= *deadline).map(|_| Reason::TimeLimit)
    }

    /// Returns whether there is time to judge candidates of so many target points in total: always until the search is
    /// stopped, and after that only if it takes a fraction of a second.
    pub fn leaves_time_for(&self, points: usize) -> bool {
        points <= JUDGED_AFTER_STOP || !self.stopped()
    }

    /// Counts how many candidates of `points` target points each may still be judged once the search is stopped.
    pub fn judging(&self, points: usize) -> Judging<'_> {
        Judging { budget: self, points, after_stop: AtomicUsize::new(0) }
    }
}

/// The number of target points, summed over the candidates, that are still judged after a stop. Judging takes about 200
/// positions of the linkage per target point, so that this many take a fraction of a second.
pub const JUDGED_AFTER_STOP: usize = 20_000;

/// A counter of the candidates that may still be judged: all of them until the search is stopped, and from then on as
/// many as have [`JUDGED_AFTER_STOP`] target points together, but always one, so that there is an answer.
#[derive(Debug)]
pub struct Judging<'a> {
    budget: &'a Budget<'a>,
    points: usize,
    after_stop: AtomicUsize,
}

impl Judging<'_> {
    /// Returns whether one more candidate may be judged, and counts it as judged.
    pub fn may_go_on(&self) -> bool {
        if !self.budget.stopped() {
            return true;
        }
        let before = self.after_stop.fetch_add(1, Ordering::Relaxed);
        before == 0 || (before + 1).saturating_mul(self.points) <= JUDGED_AFTER_STOP
    }
}

/// The progress of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// The current phase, in a few words.
    pub phase: &'static str,
    /// Evaluations so far.
    pub evaluations: u64,
    /// The budget of evaluations.
    pub budget: u64,
    /// The best sum of squares of an acceptable candidate so far, or else of any candidate; `None` if the search does
    /// not track it.
    pub best_sum_sq: Option<f64>,
    /// Whether the candidate with `best_sum_sq` is acceptable.
    pub accepted: bool,
    /// The repeated hits of the best acceptable candidate; `None` if the search does not count them.
    pub hits: Option<HitsSoFar>,
}

impl Progress {
    /// Creates the progress of a phase that tracks neither a best candidate nor its hits.
    pub(crate) fn of(phase: &'static str, evaluations: u64, budget: u64) -> Self {
        Progress { phase, evaluations, budget, best_sum_sq: None, accepted: false, hits: None }
    }
}

/// The number of independent rounds of starts that reached the best answer, and the number that the stopping rule
/// wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitsSoFar {
    /// Rounds that reached the best answer, the round that found it included.
    pub came: usize,
    /// Rounds that have to reach it before the search stops.
    pub wanted: usize,
}

/// A callback that receives the progress of a search.
pub type Observer<'a> = dyn Fn(&Progress) + Sync + 'a;

impl AddAssign for Evaluations {
    fn add_assign(&mut self, other: Self) {
        self.objective += other.objective;
        self.positions += other.positions;
    }
}

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct SearchOutcome {
    /// Distinct candidates, ranked.
    pub candidates: Vec<Candidate>,
    /// The other candidates found: repeats of the same answers, worse ones, and unacceptable ones.
    pub others: Vec<Candidate>,
    /// Names of the methods that ran, in order.
    pub used: Vec<String>,
    /// The reason why the search ended.
    pub reason: Reason,
    /// The evaluations used.
    pub evaluations: Evaluations,
    /// All linkages through nine precision points, if they were asked for.
    pub exact: Option<ExactRecord>,
    /// The repeated hits of the best answer, if they were counted.
    pub repeats: Option<Repeats>,
}

impl SearchOutcome {
    /// Chooses the candidates anew from `before`, the outcome's own and `after`; of equal ones the first is chosen. Their
    /// distances to their whole curves are computed anew, since those of unlisted ones are not exact. Once the budget
    /// has stopped, only so many stay in the list as can be measured in a fraction of a second ([`Budget::judging`]).
    pub(crate) fn choose_anew(
        &mut self,
        context: Context<'_>,
        before: Vec<Candidate>,
        after: Vec<Candidate>,
    ) {
        let problem = context.problem;
        let own = self.candidates.drain(..).chain(self.others.drain(..));
        let found = before.into_iter().chain(own).chain(after).collect();
        (self.candidates, self.others) = divided(problem, found, problem.spec().solve.candidates);
        self.measure_listed(context);
    }

    /// Returns the outcome with the distances of its candidates to their whole curves ([`SearchOutcome::measure_listed`]).
    fn measured(mut self, context: Context<'_>) -> Self {
        self.measure_listed(context);
        self
    }

    /// Computes the distances of the candidates to their whole curves: searches leave them out, since they take most of the
    /// time of a verdict. Once the budget has stopped, only so many stay in the list as [`SearchOutcome::choose_anew`] says.
    fn measure_listed(&mut self, context: Context<'_>) {
        let judging = context.budget.judging(context.points());
        let measured = |mut candidate| {
            judging.may_go_on().then(|| {
                measure_curve(context.problem, &mut candidate);
                candidate
            })
        };
        let listed = std::mem::take(&mut self.candidates);
        self.candidates = listed.into_par_iter().filter_map(measured).collect();
    }
}
