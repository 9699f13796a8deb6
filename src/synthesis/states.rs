//! The states of the searches in a checkpoint: data alone, so that neither the keeper nor a search depends on another
//! search.
//!
//! A state holds everything on which the next batches of a search depend, besides the problem and the budget. The names
//! and the order of the fields are those of the checkpoint file.

use super::belief::Belief;
use super::dyad_chains::DyadChainState;
use super::front::FrontState;
use crate::mechanism::LinkageKind;
use crate::numbers::optimise::argmin_bridge::RestartsState;
use crate::numbers::optimise::exact_float::{self, Exact};
use crate::record::{Candidate, Evaluations};
use crate::task::forms::design_space::Design;
use crate::task::forms::start::Start;
use crate::task::{Problem, Setting};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The state of a search: the last saved boundary of each of its parts.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SearchState {
    /// State of least squares with free timing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) free: Option<FreeState>,
    /// State of prescribed timing in its reduced form (variable projection).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) timed: Option<TimedState>,
    /// State of the multistart rounds of prescribed timing in the physical parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) rounds: Option<RoundsState>,
    /// State of a motion search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) motion: Option<RepeatedState>,
    /// State of a search for linkages with a slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) sliders: Option<RepeatedState>,
    /// States of the searches for six-bars and eight-bars.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) dyad_chains: BTreeMap<LinkageKind, DyadChainState>,
    /// State of a population search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) population: Option<RestartsState>,
    /// State of a front.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) front: Option<FrontState>,
}

/// Counters over all batches.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Counts {
    /// Distinct answers known; `quiet`: batches in a row without a new one.
    pub(super) known: usize,
    pub(super) quiet: u64,
    pub(super) batch: u64,
    pub(super) draws: u64,
}

/// The state of least squares with free timing between two batches.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct FreeState {
    pub(super) counts: Counts,
    pub(super) evaluations: Evaluations,
    /// The least merit of each independent round.
    pub(super) best_merits: Vec<Exact>,
    /// The stages.
    pub(super) stages: Vec<StageState>,
    /// The ends, least merit first.
    pub(super) ends: Vec<End>,
    /// The level of the best error, if its errors are not noise and the target is dense or explored under stricter
    /// requirements.
    #[serde(default)]
    pub(super) reached: Option<Level>,
    /// Whether the stopping rule was met after the last batch, and stricter explorations are to confirm it.
    #[serde(default)]
    pub(super) confirming: bool,
}

/// A level of the error, and the evaluations after which it was reached.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Level {
    pub(super) cost: Exact,
    pub(super) evaluations: u64,
}

/// The results of the batches of a stage (on groups of points, or on all points) so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct StageState {
    /// The least merit on the explored points.
    #[serde(with = "exact_float")]
    pub(super) bar: f64,
    /// The best different ends on the explored points.
    pub(super) leading: Vec<(Exact, Start)>,
    /// The merits, on the explored points and on all points, of the ends that have been finished after their batch.
    pub(super) finished: Vec<(Exact, Exact)>,
    /// Rounds so far.
    pub(super) index: u64,
    /// Evaluations so far.
    #[serde(default)]
    pub(super) spent: u64,
    /// The least merit of each independent round on the explored points.
    #[serde(default)]
    pub(super) round_merits: Vec<Exact>,
}

impl StageState {
    /// The state of a stage before its first batch.
    pub(super) const BEGUN: StageState = StageState {
        bar: f64::INFINITY,
        leading: Vec::new(),
        finished: Vec::new(),
        index: 0,
        spent: 0,
        round_merits: Vec::new(),
    };
}

/// The end of a fit, judged or not yet.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct End {
    #[serde(with = "exact_float")]
    pub(super) merit: f64,
    pub(super) start: Start,
    /// Whether the referee has judged it.
    pub(super) judged: bool,
    /// The referee's result, `None` for an end that cannot be judged. It is computed again on resuming.
    #[serde(skip)]
    pub(super) verdict: Option<Candidate>,
}

/// An end that the referee has judged.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Judged {
    pub(super) setting: Setting,
    pub(super) design: Design,
    pub(super) accepted: bool,
}

/// The state of prescribed timing in its reduced form between two waves.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TimedState {
    pub(super) found: Vec<Candidate>,
    pub(super) evaluations: Evaluations,
    pub(super) polished: bool,
    pub(super) best: Option<Candidate>,
    pub(super) seen: Vec<Judged>,
    pub(super) belief: Belief,
    pub(super) known: usize,
    pub(super) quiet: u64,
    pub(super) wave: u64,
    pub(super) draws: u64,
    pub(super) binding: bool,
    pub(super) binding_waves: u64,
}

/// The state of a search by repeated hits ([`super::repeated`]) between two batches.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RepeatedState {
    pub(super) found: Vec<Candidate>,
    pub(super) evaluations: Evaluations,
    pub(super) best: Option<Candidate>,
    pub(super) belief: Belief,
    /// The evaluations after which the best answer was found.
    pub(super) reached: u64,
    /// Independent rounds so far.
    pub(super) independent: u64,
    pub(super) known: usize,
    pub(super) quiet: u64,
    pub(super) batch: u64,
    pub(super) draws: u64,
}

/// The state of the multistart rounds of prescribed timing in the physical parameters between two batches.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RoundsState {
    pub(super) found: Vec<Candidate>,
    pub(super) evaluations: Evaluations,
    pub(super) best: Option<Candidate>,
    pub(super) hits: usize,
    pub(super) known: usize,
    pub(super) quiet: u64,
    pub(super) batch: u64,
    pub(super) draws: u64,
}

/// Returns whether saved candidates fit the problem: they have as many points.
pub(super) fn of_as_many_points(problem: &Problem, found: &[Candidate], best: &Option<Candidate>) -> bool {
    let n = problem.task().len();
    found.iter().chain(best).all(|c| c.crank_deg.len() == n && c.t1_at.len() == n)
}
