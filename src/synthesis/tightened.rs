//! Fits of a known linkage under tightened limits, judged by the problem itself: the epsilon constraints of
//! [`super::picks`] and [`super::front`].

use super::constants::tightened::{EVALUATIONS, FINISH, HOPELESS};
use super::fit_state::FitState;
use super::multistart::{Effort, polish_until};
use super::polish::{finish, reserve};
use super::{Context, plan, several_loops, sliders};
use crate::judge::assess::assess_again;
use crate::judge::warm::start_at;
use crate::mechanism::LinkageKind;
use crate::record::{Axis, Candidate, Figures};
use crate::task::Problem;
use crate::task::spec::{Method, Objective};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Limits on figures beside the requirements of a problem; `None`: no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tighter {
    /// The least worst transmission angle, in degrees.
    pub(super) transmission_deg: Option<f64>,
    /// The greatest extent.
    pub(super) extent: Option<f64>,
    /// The greatest length of the longest link.
    pub(super) longest: Option<f64>,
    /// The greatest link ratio.
    pub(super) link_ratio: Option<f64>,
    /// The greatest size of the torque on the crank, N m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) peak_torque: Option<f64>,
}

/// The axes that a fit can limit.
pub(super) const LIMITED: [Axis; 5] =
    [Axis::Transmission, Axis::Extent, Axis::Longest, Axis::LinkRatio, Axis::PeakTorque];

impl Tighter {
    /// Returns the place of an axis' limit; `None` for an axis that a fit cannot limit.
    pub(super) fn place(&mut self, axis: Axis) -> Option<&mut Option<f64>> {
        match axis {
            Axis::Transmission => Some(&mut self.transmission_deg),
            Axis::Extent => Some(&mut self.extent),
            Axis::Longest => Some(&mut self.longest),
            Axis::LinkRatio => Some(&mut self.link_ratio),
            Axis::PeakTorque => Some(&mut self.peak_torque),
            Axis::Rms | Axis::Max | Axis::Sensitivity => None,
        }
    }

    /// Returns the limits with one axis limited at a value.
    #[must_use]
    pub(super) fn with(mut self, axis: Axis, value: f64) -> Tighter {
        if let Some(place) = self.place(axis) {
            *place = Some(value);
        }
        self
    }

    /// Returns whether a linkage with these figures keeps the limits.
    pub(super) fn holds(&self, figures: &Figures) -> bool {
        let most = |value: f64, limit: Option<f64>| limit.is_none_or(|limit| value <= limit * (1.0 + 1e-9));
        self.transmission_deg.is_none_or(|least| figures.transmission_deg >= least - 1e-7)
            && most(figures.extent, self.extent)
            && most(figures.longest, self.longest)
            && most(figures.link_ratio, self.link_ratio)
            && most(figures.of(Axis::PeakTorque), self.peak_torque)
    }

    /// Returns the problem under these limits and its own, the tighter of both.
    pub(super) fn of(&self, problem: &Problem) -> Option<Problem> {
        let mut spec = problem.spec().clone();
        let require = &mut spec.require;
        let least = |own: Option<f64>, limit: Option<f64>| match (own, limit) {
            (Some(own), Some(limit)) => Some(own.min(limit)),
            (own, limit) => own.or(limit),
        };
        if let Some(limit) = self.transmission_deg {
            let limit = limit.clamp(0.0, 90.0);
            require.transmission_deg_min =
                Some(require.transmission_deg_min.map_or(limit, |own| own.max(limit)));
        }
        require.extent_max = least(require.extent_max, self.extent);
        require.longest_max = least(require.longest_max, self.longest);
        require.peak_torque_max = least(require.peak_torque_max, self.peak_torque);
        require.link_ratio_max =
            self.link_ratio.map_or(require.link_ratio_max, |l| require.link_ratio_max.min(l));
        Problem::new(spec).ok()
    }
}

/// Searches anew under limits with so many evaluations, for so many answers. Returns those, judged by the context's own
/// problem, and the evaluations used; `None` if the problem under the limits cannot be searched.
pub(super) fn searched_anew(
    context: Context<'_>,
    limits: &Tighter,
    evaluations: u64,
    answers: usize,
) -> Option<(Vec<Candidate>, u64)> {
    let problem = context.problem;
    let mut spec = limits.of(problem)?.spec().clone();
    spec.solve.evaluations = evaluations;
    spec.solve.method = Method::LeastSquares;
    // Tolerances and the largest deviation are left to the fits that follow.
    spec.task.tolerance = None;
    if let Some(body) = &mut spec.task.body {
        body.tolerance_deg = None;
    }
    spec.solve.objective = Objective::SumOfSquares;
    spec.solve.candidates = answers;
    let tight = Problem::new(spec).ok()?;
    let outcome = plan::approximate(context.of(&tight).silent()).ok()?;
    let judged = |c: &Candidate| assess_again(problem, c);
    let answers: Vec<Option<Candidate>> = outcome.candidates.par_iter().map(judged).collect();
    Some((answers.into_iter().flatten().collect(), outcome.evaluations.objective))
}

/// The end of a fit under tightened limits.
pub(super) struct Tightened {
    /// The candidate, judged by the problem itself; `None` if there is none.
    pub(super) candidate: Option<Candidate>,
    /// The evaluations used.
    pub(super) evaluations: u64,
}

/// Fits from a candidate under the limits of `tight`, and judges the end by the context's own problem. The fit ends as
/// soon as its weighted sum of squares is at most `enough`, or after at most `evaluations` evaluations. If tolerances are asked for, or the largest deviation is
/// the objective, the end is polished for them, the longer the greater the effort.
pub(super) fn fitted(
    context: Context<'_>,
    tight: &Problem,
    from: &Candidate,
    effort: Effort,
    (enough, evaluations): (f64, u64),
) -> Tightened {
    let mut out = Tightened { candidate: None, evaluations: 0 };
    if evaluations == 0 || context.stopped() {
        return out;
    }
    let within = context.of(tight).silent();
    if from.linkage.multi_loop().is_some() {
        let (end, evaluations) = several_loops::refitted(within, from, evaluations.min(EVALUATIONS));
        let candidate = end.and_then(|end| assess_again(context.problem, &end));
        return Tightened { candidate, evaluations };
    }
    if from.linkage.kind() == LinkageKind::FourBar {
        let Some(start) = start_at(tight, from) else { return out };
        let fit = polish_until(within, start, effort, evaluations.min(EVALUATIONS), enough);
        out.evaluations = fit.evaluations;
        out.take(context, within, fit.end, (effort, evaluations));
    } else {
        let fit = (effort, evaluations.min(EVALUATIONS), enough);
        let (end, used) = sliders::refit(within, from, fit);
        out.evaluations = used;
        let end = end.and_then(|end| sliders::Start::of(tight, &end));
        out.take(context, within, end, (effort, evaluations));
    }
    out
}

impl Tightened {
    /// Takes the end of a fit `within` the tightened limits, polished for tolerances or the largest deviation where they are
    /// asked for, judged by the context's problem.
    fn take<S: FitState>(
        &mut self,
        context: Context<'_>,
        within: Context<'_>,
        end: Option<S>,
        (effort, evaluations): (Effort, u64),
    ) {
        let (Some(end), tight) = (end, within.problem) else { return };
        self.candidate = end.judged(context.problem);
        let is_accepted = self.candidate.as_ref().is_some_and(|c| c.accepted);
        let deviations = reserve(tight, u64::MAX) > 0;
        let max = tight.spec().solve.objective == Objective::MaxDeviation;
        let most = HOPELESS * tight.task().largest_tolerance().unwrap_or(f64::INFINITY);
        let is_hopeless = self.candidate.as_ref().is_some_and(|c| c.error.max > most);
        if deviations && (max || !(is_accepted || is_hopeless)) && !context.stopped() {
            let left = evaluations.saturating_sub(self.evaluations);
            let polished = finish(within, &end, (effort.steps as u64 / 4).min(FINISH).min(left));
            self.evaluations += polished.evaluations;
            if let Some(better) = polished.end {
                self.candidate = better.judged(context.problem).or(self.candidate.take());
            }
        }
    }
}
