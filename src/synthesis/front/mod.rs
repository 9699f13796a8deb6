//! The front of a problem: the trade-off between error, transmission angle, extent and other figures, by fits under
//! tightened limits.
//!
//! The first axis that is an error is minimised; the others are limited (epsilon constraints, Haimes, Lasdon and Wismer
//! 1971). An archive holds every linkage that none dominates. It begins with all that the search has met, with short
//! searches anew under tightened limits, and with fits of the distinct answers under a few combinations of limits, and
//! grows in generations of
//!
//! - *pushes*: the best linkage on an axis is fitted again under a tighter limit on that axis;
//! - *gap fillings*: where two neighbours differ most, linkages near them are fitted under limits between theirs, and
//!   under the tighter limit of both on every axis.
//!
//! It ends if no gap is left that is worth filling, if several generations add hardly any volume, or if the evaluations
//! are used up. The members are chosen from the archive by hypervolume ([`crate::judge::trade_off::members`]), fitted
//! to the last digit, and judged by the problem itself. A generation runs in parallel and is read in its order: the
//! number of threads changes nothing but the time.

mod archive;
mod targets;

use super::answers::complete;
use super::constants::front::{
    ANSWERS, EFFORT, FITS, LAST, LEAST_MEMBERS, MOST_ERROR, QUIET_GENERATIONS, QUIET_VOLUME, SEARCH, SEEDS,
    SPARE,
};
use super::multistart::Effort;
use super::tightened::{LIMITED, Tightened, Tighter, fitted, searched_anew};
use super::{Context, Progress};
use crate::judge::assess::assess_again;
use crate::judge::figures::figures;
use crate::judge::rank::chosen;
use crate::judge::trade_off::{Wishes, knees, members, undominated};
use crate::record::{Axis, Candidate, Evaluations, Figures, Front, LEAST_AXES, MOST_AXES, Member, Reason};
use crate::task::Problem;
use crate::task::spec::{Objective, ProblemSpec};
use archive::Archive;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use targets::Push;

pub use archive::Entry;

/// The front that is asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontRequest {
    /// The axes.
    pub axes: Vec<Axis>,
    /// The number of members.
    pub points: usize,
}

/// The reason why the axes of a front are refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AxesError {
    /// Too few axes, or too many, are named.
    #[error("--axes {0}: name {LEAST_AXES} to {MOST_AXES} axes, such as rms,transmission,extent")]
    Count(String),
    /// An axis is named twice.
    #[error("--axes {names}: {twice} is named twice; name each axis once")]
    Twice {
        /// The axes as they were named.
        names: String,
        /// The axis that is named twice.
        twice: &'static str,
    },
    /// No axis is an error.
    #[error("--axes {0}: add rms or max; without an error any small linkage is the best")]
    NoError(String),
    /// A torque is named for a problem without loads.
    #[error(
        "--axes {0}: peak_torque needs loads, and the problem has no table [loads]; add one, or leave the axis out"
    )]
    NoLoads(String),
}

impl FrontRequest {
    /// Checks that the problem has loads if a torque is an axis.
    ///
    /// # Errors
    /// [`AxesError::NoLoads`].
    pub fn check_loads(&self, spec: &ProblemSpec) -> Result<(), AxesError> {
        if self.axes.contains(&Axis::PeakTorque) && spec.loads.is_none() {
            let names: Vec<&str> = self.axes.iter().map(|axis| axis.name()).collect();
            return Err(AxesError::NoLoads(names.join(",")));
        }
        Ok(())
    }

    /// Checks the number of axes, that none is named twice, and that an error is among them.
    ///
    /// # Errors
    /// [`AxesError`].
    pub fn check(&self) -> Result<(), AxesError> {
        let axes = &self.axes;
        let names: Vec<&str> = axes.iter().map(|axis| axis.name()).collect();
        let names = names.join(",");
        if !(LEAST_AXES..=MOST_AXES).contains(&axes.len()) {
            return Err(AxesError::Count(names));
        }
        if let Some(twice) = (1..axes.len()).find(|&i| axes[..i].contains(&axes[i])) {
            return Err(AxesError::Twice { names, twice: axes[twice].name() });
        }
        if !axes.contains(&Axis::Rms) && !axes.contains(&Axis::Max) {
            return Err(AxesError::NoError(names));
        }
        Ok(())
    }
}

impl Default for FrontRequest {
    fn default() -> Self {
        FrontRequest { axes: vec![Axis::Rms, Axis::Transmission, Axis::Extent], points: 20 }
    }
}

/// The state of a front between two generations, in a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontState {
    request: FrontRequest,
    entries: Vec<Entry>,
    tried: Vec<Tighter>,
    pushes: Vec<Push>,
    generation: u64,
    quiet: u64,
    evaluations: u64,
}

/// A front with the reason why it ended before its own rule, if there is one.
#[derive(Clone, Debug)]
pub struct Found {
    /// The front.
    pub front: Front,
    /// The evaluations that it cost beside the search.
    pub evaluations: Evaluations,
    /// Why it was stopped.
    pub reason: Option<Reason>,
}

/// The search for a front.
struct Search<'a> {
    context: Context<'a>,
    request: &'a FrontRequest,
    /// The axes that fits limit.
    limited: Vec<Axis>,
    /// The problem whose objective is the largest deviation, if that is an axis.
    deviation: Option<Problem>,
    archive: Archive,
    tried: Vec<Tighter>,
    pushes: Vec<Push>,
    generation: u64,
    quiet: u64,
    evaluations: u64,
    allowance: u64,
}

/// Computes the front of a problem from the candidates that a search has found, best first, with at most `allowance`
/// evaluations.
pub fn search(context: Context<'_>, request: &FrontRequest, known: &[Candidate], allowance: u64) -> Found {
    let mut search = Search::new(context, request, allowance);
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().front.clone());
    match earlier.filter(|state| state.request == *request && state.is_of(context.problem)) {
        Some(state) => search.resume(state),
        None => search.begin(known),
    }
    search.grow();
    search.finished()
}

impl FrontState {
    /// Returns whether the state can be one of this problem's.
    fn is_of(&self, problem: &Problem) -> bool {
        let n = problem.task().len();
        self.entries.iter().all(|e| e.candidate.crank_deg.len() == n && e.candidate.t1_at.len() == n)
    }
}

impl<'a> Search<'a> {
    fn new(context: Context<'a>, request: &'a FrontRequest, allowance: u64) -> Self {
        let asked = |axis: &Axis| request.axes.contains(axis);
        let mut limited: Vec<Axis> = LIMITED.into_iter().filter(asked).collect();
        if asked(&Axis::Sensitivity) {
            // It cannot be limited: linkages of other transmission angles and lengths differ in it.
            let others = [Axis::Transmission, Axis::Longest].into_iter().filter(|axis| !asked(axis));
            limited.extend(others);
        }
        let deviation = asked(&Axis::Max).then(|| {
            let mut spec = context.problem.spec().clone();
            spec.solve.objective = Objective::MaxDeviation;
            Problem::new(spec).ok()
        });
        let pushes = limited.iter().map(|&axis| Push::new(axis)).collect();
        Search {
            context,
            request,
            limited,
            deviation: deviation.flatten(),
            archive: Archive::new(Wishes::of(context.problem, &request.axes)),
            tried: Vec::new(),
            pushes,
            generation: 0,
            quiet: 0,
            evaluations: 0,
            allowance,
        }
    }

    /// Goes on from a saved state.
    fn resume(&mut self, state: FrontState) {
        let problem = self.context.problem;
        let figures: Vec<Option<Figures>> =
            state.entries.par_iter().map(|entry| figures(problem, &entry.candidate)).collect();
        for (entry, figures) in state.entries.into_iter().zip(figures) {
            self.archive.extend(figures.map(|figures| (entry, figures)));
        }
        (self.tried, self.pushes) = (state.tried, state.pushes);
        (self.generation, self.quiet, self.evaluations) = (state.generation, state.quiet, state.evaluations);
    }

    /// Fills the archive with what is known, and with fits of the best distinct linkages under combinations of limits.
    fn begin(&mut self, known: &[Candidate]) {
        let problem = self.context.problem;
        let accepted: Vec<Candidate> = known.iter().filter(|c| c.accepted).cloned().collect();
        self.take(accepted.iter().map(|c| (c.clone(), Tighter::default())).collect());
        self.search_anew();
        let distinct = chosen(problem, &accepted, SEEDS);
        let seeds: Vec<&Candidate> = distinct.into_iter().map(|i| &accepted[i]).collect();
        let Some(first) = self.archive.members().first().map(|(_, figures)| *figures) else { return };
        let combinations = targets::anchors(&self.limited, &first);
        let fits: Vec<(Tighter, Candidate)> = combinations
            .iter()
            .flat_map(|limits| seeds.iter().map(|seed| (*limits, (*seed).clone())))
            .collect();
        self.fit(&fits, EFFORT);
    }

    /// Searches anew under tightened limits, and takes what was found into the archive.
    fn search_anew(&mut self) {
        let context = self.context;
        let searches = targets::searched(&self.limited, context.problem.task().size());
        // At most half of all evaluations.
        let each = SEARCH.min(self.allowance / (2 * searches.len().max(1) as u64)).max(1);
        let one = |limits: &Tighter| searched_anew(context, limits, each, ANSWERS);
        let found: Vec<_> = searches.par_iter().map(one).collect();
        for (limits, found) in searches.into_iter().zip(found) {
            let Some((answers, evaluations)) = found else { continue };
            self.evaluations += evaluations;
            self.take(answers.into_iter().map(|c| (c, limits)).collect());
        }
    }

    /// Runs generations until the rule of the module's head ends them. The state that a stop leaves is that before the
    /// generation that it cut short.
    fn grow(&mut self) {
        while !self.context.stopped() && self.evaluations < self.allowance && self.quiet < QUIET_GENERATIONS {
            let state = self.state();
            self.save(&state, false);
            let before = self.archive.volume();
            let axes = (self.request.axes.as_slice(), self.limited.as_slice());
            let targets = targets::next(self.archive.members(), axes, &mut self.pushes, &self.tried);
            if targets.is_empty() {
                break;
            }
            let fits: Vec<(Tighter, Candidate)> = targets
                .iter()
                .flat_map(|target| {
                    let starts = self.archive.near(&target.limits, &target.from);
                    starts.into_iter().map(|start| (target.limits, start)).collect::<Vec<_>>()
                })
                .collect();
            let reached = self.fit(&fits, EFFORT);
            if self.context.stopped() {
                self.save(&state, true);
                break;
            }
            for push in &mut self.pushes {
                push.after(&reached);
            }
            self.tried.extend(targets.iter().map(|target| target.limits));
            self.generation += 1;
            let volume = self.archive.volume();
            self.quiet = if volume > before + QUIET_VOLUME { 0 } else { self.quiet + 1 };
            (self.context.observer)(&Progress {
                accepted: true,
                ..Progress::of("front", self.evaluations, self.allowance)
            });
        }
    }

    fn state(&self) -> FrontState {
        FrontState {
            request: self.request.clone(),
            entries: self.archive.members().iter().map(|(entry, _)| entry.clone()).collect(),
            tried: self.tried.clone(),
            pushes: self.pushes.clone(),
            generation: self.generation,
            quiet: self.quiet,
            evaluations: self.evaluations,
        }
    }

    fn save(&self, front: &FrontState, stopped: bool) {
        if let Some(keeper) = self.context.keeper {
            keeper.keep(stopped, |state| state.front = Some(front.clone()));
        }
    }

    /// Fits in parallel and takes the results into the archive. Returns the figures of those that were accepted.
    fn fit(&mut self, fits: &[(Tighter, Candidate)], effort: Effort) -> Vec<Figures> {
        let (context, deviation) = (self.context, self.deviation.as_ref());
        let with_rms = self.request.axes.contains(&Axis::Rms);
        let one = |(limits, from): &(Tighter, Candidate)| -> Vec<(Tightened, Tighter)> {
            let Some(tight) = limits.of(context.problem) else { return Vec::new() };
            let fit = fitted(context, &tight, from, effort, (0.0, u64::MAX));
            let for_deviation = deviation.and_then(|problem| {
                let from = fit.candidate.as_ref().filter(|c| c.accepted)?;
                Some(fitted_for_deviation(context, problem, limits, from))
            });
            let least = if with_rms || for_deviation.is_none() { Some(fit) } else { None };
            least.into_iter().chain(for_deviation).map(|fit| (fit, *limits)).collect()
        };
        let done: Vec<Vec<(Tightened, Tighter)>> = fits.par_iter().map(one).collect();
        self.evaluations += done.iter().flatten().map(|(fit, _)| fit.evaluations).sum::<u64>();
        let ends = done.into_iter().flatten();
        self.take(ends.filter_map(|(fit, limits)| Some((fit.candidate?, limits))).collect())
    }

    /// Takes accepted candidates into the archive, and returns their figures.
    fn take(&mut self, candidates: Vec<(Candidate, Tighter)>) -> Vec<Figures> {
        let problem = self.context.problem;
        let most = MOST_ERROR * problem.task().error_size();
        let good: Vec<(Candidate, Tighter)> = candidates
            .into_iter()
            .filter(|(c, _)| c.accepted && c.error.rms <= most)
            .map(|(c, limits)| (Candidate { rank: 0, ..c }, limits))
            .collect();
        let found: Vec<Option<Figures>> = good.par_iter().map(|(c, _)| figures(problem, c)).collect();
        let mut taken = Vec::new();
        for ((candidate, limits), figures) in good.into_iter().zip(found) {
            let is_whole =
                |figures: &Figures| self.request.axes.iter().all(|axis| figures.of(*axis).is_finite());
            let Some(figures) = figures.filter(is_whole) else { continue };
            taken.push(figures);
            self.archive.extend([(Entry { candidate, limits }, figures)]);
        }
        taken
    }

    /// Chooses the members and fits them to the last digit.
    fn finished(mut self) -> Found {
        let axes = &self.request.axes;
        for _ in 0..FITS {
            let list: Vec<Figures> = self.archive.members().iter().map(|(_, figures)| *figures).collect();
            // A few more than are asked for: after their last fits some may be dominated.
            let wanted = self.request.points.max(LEAST_MEMBERS) + SPARE;
            let fits: Vec<(Tighter, Candidate)> = members(axes, &list, wanted)
                .into_iter()
                .map(|i| {
                    let entry = &self.archive.members()[i].0;
                    (entry.limits, entry.candidate.clone())
                })
                .collect();
            if self.context.stopped() {
                break;
            }
            self.fit(&fits, LAST);
        }
        let axes = &self.request.axes;
        let list: Vec<Figures> = self.archive.members().iter().map(|(_, figures)| *figures).collect();
        debug_assert_eq!(
            undominated(&Wishes::of(self.context.problem, axes), &list).len(),
            list.len(),
            "the archive holds undominated linkages"
        );
        let mut places = members(axes, &list, self.request.points);
        places.sort_by(|&i, &j| list[i].rms.total_cmp(&list[j].rms).then(i.cmp(&j)));
        let chosen: Vec<Figures> = places.iter().map(|&i| list[i]).collect();
        let knees = knees(axes, &chosen);
        let judging = self.context.budget.judging(self.context.points());
        let members = places.par_iter().zip(chosen).zip(knees).filter_map(|((&i, figures), knee)| {
            let mut candidate = judging.may_go_on().then(|| self.archive.members()[i].0.candidate.clone())?;
            complete(self.context.problem, &mut candidate);
            Some(Member { figures, knee, candidate })
        });
        let front = Front {
            axes: axes.clone(),
            points: self.request.points,
            evaluations: self.evaluations,
            members: members.collect(),
        };
        let evaluations = self.context.cost(self.evaluations);
        Found { front, evaluations, reason: self.context.stop_reason() }
    }
}

/// Fits a linkage for its largest deviation under the same limits.
fn fitted_for_deviation(
    context: Context<'_>,
    problem: &Problem,
    limits: &Tighter,
    from: &Candidate,
) -> Tightened {
    let nothing = Tightened { candidate: None, evaluations: 0 };
    let Some(tight) = limits.of(problem) else { return nothing };
    let fit = fitted(context.of(problem), &tight, from, Effort { steps: 0, ..EFFORT }, (0.0, u64::MAX));
    let judged = fit.candidate.and_then(|c| assess_again(context.problem, &c));
    Tightened { candidate: judged, evaluations: fit.evaluations }
}
