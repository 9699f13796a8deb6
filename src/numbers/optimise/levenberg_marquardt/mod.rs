//! Bounded Levenberg-Marquardt for points that share a few unknowns and may each have one of their own.
//!
//! minimise  sum_j w_j |r_j(x, s_j)|^2   subject to  lo <= x <= hi  and  g_i(x, s) >= 0
//!
//! where r_j is a residual of R rows (2 for a point of the plane, 3 for a pose with its angle), x in R^N is shared and
//! s_j is a point's own position on a curve. In a step
//! (dx, tau_j) the linear model is r_j + J_j dx + t_j tau_j with the tangent t_j = dr_j/dtau_j. The tau_j are
//! eliminated: rows normal to t_j keep weight 1, rows along it weight nu/(|t_j|^2 + nu) with a damping nu, and
//!
//! ```text
//! tau_j = -<t_j, r_j + J_j dx> / (|t_j|^2 + nu)
//! ```
//!
//! so the cost of a step is linear in the number of points. If progress is slow, as along a narrow curved valley, a
//! step is bent by half of its geodesic acceleration, the vector that solves the same system for the second
//! derivative of the residuals along the step, taken from one more evaluation (Transtrum and Sethna 2012,
//! *Improvements to the Levenberg-Marquardt algorithm for nonlinear least-squares minimization*). If the points must
//! keep their order along a common curve, neighbours that the step would let pass each other move as one (a pool):
//! the tangents of a pool are eliminated together, and the pools are determined anew in every step by isotonic
//! regression (pool adjacent violators, Ayer et al. 1955), see [`super::ordered`]. Inequalities enter by an augmented
//! Lagrangian (Powell 1969, Hestenes 1969, Rockafellar 1974): a row sqrt(rho) max(0, m_i - g_i) each, with m_i moved
//! to max(0, m_i - g_i) after every inner solve. Bounds are kept by an active set and projection. Damping is
//! Nielsen's ([`super::damping`]).

pub(crate) mod block;
mod derivatives;
mod finish;
mod system;

pub use block::{ConstraintRow, MOST_OWN, PointBlock};
pub use derivatives::derivative_error;
pub use finish::finish;

use super::damping::{Damping, clamped, moved};
use super::ordered::Ordered;
use nalgebra::SVector;
use system::{Normal, Workspace, assemble, bounded_step};

/// A function that takes the value g of an inequality, and a function that computes its row.
pub type EachConstraint<'a, const N: usize> = dyn FnMut(f64, &dyn Fn() -> ConstraintRow<N>) + 'a;

/// A least-squares problem with one block of R rows per point.
pub trait BlockLeastSquares<const N: usize, const R: usize = 2> {
    /// The values of the points' own unknowns.
    type State: Clone;

    /// Returns the number of points.
    fn points(&self) -> usize;

    /// Returns the bounds [low, high] of each shared unknown; equal bounds fix it, infinite ones leave it unbounded.
    fn bounds(&self) -> &[(f64, f64); N];

    /// Computes the cost sum_j w_j |r_j|^2; `None` if it does not exist.
    fn cost(&self, x: &[f64; N], state: &Self::State) -> Option<f64>;

    /// Passes the blocks of all points to `each`, in their order; `false` if a derivative does not exist.
    fn linearise(&self, x: &[f64; N], state: &Self::State, each: &mut dyn FnMut(&PointBlock<N, R>)) -> bool;

    /// Computes the residuals r_j of all points into `out`, in their order; `false` if one does not exist.
    fn residuals(&self, x: &[f64; N], state: &Self::State, out: &mut Vec<[f64; R]>) -> bool {
        out.clear();
        self.linearise(x, state, &mut |block| out.push(block.residual))
    }

    /// Computes the points' unknowns after a step `tau` from `state` at `from`, brought back to their curves at `to`
    /// (retraction); `false` if that fails.
    fn retract(
        &self,
        from: &[f64; N],
        state: &Self::State,
        tau: &[f64],
        to: &[f64; N],
        out: &mut Self::State,
    ) -> bool;

    /// Computes the gap from each point to the next along their curve, in units of their own unknowns and positive if
    /// they are in order; the last one leads back to the first. `false` if the points need not keep an order.
    fn gaps(&self, _x: &[f64; N], _state: &Self::State, _gaps: &mut Vec<f64>) -> bool {
        false
    }

    /// Moves every point to the position of its leader (see [`Ordered::leaders`]).
    fn join(&self, _state: &mut Self::State, _leaders: &[usize]) {}

    /// Runs a numerical loop, with wider vector instructions if the problem has them.
    fn wide<T>(&self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Passes the inequalities to `each`, always the same number and in the same order: the value, and the row with its
    /// derivatives, computed only where it is asked for.
    fn constraints(&self, x: &[f64; N], state: &Self::State, each: &mut EachConstraint<'_, N>);
}

/// The stopping criteria of [`solve`].
#[derive(Clone, Copy, Debug)]
pub struct LmOptions {
    /// The largest number of steps tried in one inner solve.
    pub max_steps: usize,
    /// The largest number of outer rounds, in which the multipliers of the augmented Lagrangian are updated.
    pub max_rounds: usize,
    /// The largest number of evaluations of the cost in all rounds together; at least one is made.
    pub max_evaluations: u64,
    /// The relative reduction for convergence: three accepted steps in a row each reduce the merit (cost and penalty)
    /// by less than this part, or the model predicts for a rejected step less than 1e-3 of it.
    pub relative_reduction: f64,
    /// The cost at which an answer counts as exact.
    pub exact_cost: f64,
    /// The tolerance of the constraints: one counts as met if g >= -`feasibility`.
    pub feasibility: f64,
    /// The cost that an inner solve has to reach after half the steps; otherwise it is given up.
    pub hopeless_cost: f64,
}

/// The reason for which a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LmOutcome {
    /// Convergence: steps hardly reduce the merit, or no step is predicted to.
    Converged,
    /// The cost is at most `exact_cost` and all constraints are met.
    Exact,
    /// The steps or evaluations are used up.
    StepLimit,
    /// A derivative does not exist at the best point (a toggle, a flat position): no step can be computed from there,
    /// and it need not be an optimum.
    NoDerivative,
    /// Every step with a predicted reduction was rejected until the damping reached its limit, because of rounding or
    /// a kink. The best point may be an optimum, but need not be.
    Stalled,
    /// The start could not be evaluated.
    NoStart,
    /// The solve was given up or stopped by the caller.
    Abandoned,
}

/// The result of a solve.
#[derive(Clone, Debug)]
pub struct LmResult<const N: usize, S> {
    /// The shared unknowns.
    pub x: [f64; N],
    /// The points' own unknowns.
    pub state: S,
    /// The cost sum_j w_j |r_j|^2.
    pub cost: f64,
    /// The violation of the constraints: the largest -g_i, or 0.
    pub violation: f64,
    /// The number of evaluations of the cost, those for the geodesic acceleration included.
    pub evaluations: u64,
    /// The reason for which it ended.
    pub outcome: LmOutcome,
}

/// The longest step of a point's own unknown, in radians: beyond it the tangent is no approximation.
pub(super) const MAX_TAU: f64 = 0.6;
/// The part of a step at which its geodesic acceleration is measured.
const AHEAD: f64 = 0.1;
/// The largest bend (half the acceleration) relative to the step, in the norm of the normal matrix' diagonal; a
/// larger one is not used.
const MOST_BENT: f64 = 0.375;
/// The relative reduction of the merit below which a step counts as slow.
const SLOW: f64 = 0.2;
/// The largest number of times that points which have passed each other are pooled after a step.
const MOST_REPAIRS: usize = 4;
/// The largest distance, in radians, between points that count as having just passed each other.
const JUST_PASSED: f64 = 0.05;
/// The largest damping; beyond it a step is below rounding.
const LAST_DAMPING: f64 = 1e14;

struct Penalty {
    rho: f64,
    shift: Vec<f64>,
}

impl Penalty {
    /// Computes the penalty: the sum of rho max(0, m - g)^2.
    fn of<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
        &self,
        problem: &P,
        x: &[f64; N],
        state: &P::State,
    ) -> f64 {
        let (mut sum, mut i) = (0.0, 0);
        problem.constraints(x, state, &mut |value, _| {
            let lack = self.shift[i] - value;
            i += 1;
            if lack > 0.0 {
                sum += self.rho * lack * lack;
            }
        });
        sum
    }
}

/// Computes the violation of the constraints: the largest -g_i, or 0 if all hold.
pub fn violation<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
) -> f64 {
    let mut worst: f64 = 0.0;
    problem.constraints(x, state, &mut |value, _| worst = worst.max(-value));
    worst
}

/// Minimises the cost from a start, by Levenberg-Marquardt and an augmented Lagrangian. `stop` is called between
/// steps, and within a step between its passes over the points.
///
/// The start is clamped to its bounds. The best point so far is always returned.
pub fn solve<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    start: [f64; N],
    state: P::State,
    options: &LmOptions,
    stop: &dyn Fn() -> bool,
) -> LmResult<N, P::State> {
    let x = clamped(start, problem.bounds());
    let mut shift = Vec::new();
    problem.constraints(&x, &state, &mut |_, _| shift.push(0.0));
    let unconstrained = shift.is_empty();
    let mut result = LmResult {
        x,
        state,
        cost: f64::INFINITY,
        violation: 0.0,
        evaluations: 1,
        outcome: LmOutcome::NoStart,
    };
    let Some(cost) = problem.cost(&result.x, &result.state) else { return result };
    result.cost = cost;
    result.violation = violation(problem, &result.x, &result.state);
    let mut penalty = Penalty { rho: FIRST_RHO * problem.points() as f64, shift };
    let mut last_violation = f64::INFINITY;
    for round in 0..options.max_rounds.max(1) {
        let outcome = Inner::new(problem, &mut result, &penalty, options, stop).run();
        result.outcome = outcome;
        result.violation = violation(problem, &result.x, &result.state);
        if unconstrained || matches!(result.outcome, LmOutcome::NoStart | LmOutcome::Abandoned) {
            return result;
        }
        let mut i = 0;
        let mut moved: f64 = 0.0;
        problem.constraints(&result.x, &result.state, &mut |value, _| {
            let next = (penalty.shift[i] - value).max(0.0);
            moved = moved.max((next - penalty.shift[i]).abs());
            penalty.shift[i] = next;
            i += 1;
        });
        if result.violation <= options.feasibility && moved <= options.feasibility && round > 0 {
            return result;
        }
        if result.violation <= options.feasibility && penalty.shift.iter().all(|m| *m == 0.0) {
            return result;
        }
        if result.violation > 0.25 * last_violation {
            let grown = RHO_GROWTH * penalty.rho;
            penalty.shift.iter_mut().for_each(|m| *m *= penalty.rho / grown);
            penalty.rho = grown;
        }
        last_violation = result.violation;
    }
    result
}

/// The first penalty weight of a squared constraint relative to a squared residual, per point.
const FIRST_RHO: f64 = 1.0;
/// The factor by which the penalty weight grows if a round did not reduce the violation to a quarter.
const RHO_GROWTH: f64 = 8.0;

/// An inner solve: the best point so far, the merit (cost and penalty) there, and the state of the step control.
struct Inner<'a, const N: usize, const R: usize, P: BlockLeastSquares<N, R>> {
    problem: &'a P,
    result: &'a mut LmResult<N, P::State>,
    penalty: &'a Penalty,
    options: &'a LmOptions,
    stop: &'a dyn Fn() -> bool,
    work: Workspace<N, R>,
    buffers: Buffers<R>,
    trial_state: P::State,
    merit: f64,
    damping: Damping,
    /// The damping of the points' own unknowns, which follows the shared one: nu = damping * mean |t_j|^2.
    nu: f64,
    tangent_sq: f64,
    /// The number of steps in a row with hardly any reduction.
    quiet: usize,
    /// Whether the last accepted step was slow.
    slow: bool,
}

/// The buffers for the end of a step, kept from step to step. They stand beside the [`Workspace`], which is read while
/// they are written.
#[derive(Default)]
struct Buffers<const R: usize> {
    /// The points' gaps at the end of a step.
    gaps: Vec<f64>,
    /// The points' own steps at the part [`AHEAD`] of a step, the residuals there, and their second derivatives along it.
    own: Vec<f64>,
    residuals: Vec<[f64; R]>,
    second: Vec<[f64; R]>,
}

/// The end of a step with its cost and merit; the points' own unknowns are in [`Inner::trial_state`].
struct Trial<const N: usize> {
    x: [f64; N],
    cost: f64,
    merit: f64,
}

impl<'a, const N: usize, const R: usize, P: BlockLeastSquares<N, R>> Inner<'a, N, R, P> {
    fn new(
        problem: &'a P,
        result: &'a mut LmResult<N, P::State>,
        penalty: &'a Penalty,
        options: &'a LmOptions,
        stop: &'a dyn Fn() -> bool,
    ) -> Self {
        Inner {
            merit: result.cost + penalty.of(problem, &result.x, &result.state),
            work: Workspace::new(problem.points()),
            buffers: Buffers::default(),
            trial_state: result.state.clone(),
            damping: Damping::up_to(LAST_DAMPING),
            nu: 0.0,
            tangent_sq: 0.0,
            quiet: 0,
            slow: false,
            problem,
            result,
            penalty,
            options,
            stop,
        }
    }

    fn run(mut self) -> LmOutcome {
        let mut normal: Option<Normal<N>> = None;
        for step in 0..self.options.max_steps {
            if let Some(outcome) = self.ended(step) {
                return outcome;
            }
            let Some(system) = normal.take().or_else(|| self.assembled()) else {
                return LmOutcome::NoDerivative;
            };
            let bounds = self.problem.bounds();
            let (x, damping) = (&self.result.x, self.damping.value);
            let Some(dx) = bounded_step(&system.matrix, &system.gradient, x, bounds, damping) else {
                if self.damping.raise() {
                    return LmOutcome::Stalled;
                }
                normal = Some(system);
                continue;
            };
            let shared = dx.into();
            self.work.own_steps_after(&shared, self.nu);
            let promised = self.work.promised(&shared, self.penalty.rho);
            let bent = self.bent_trial(&system, &dx);
            if (self.stop)() {
                return LmOutcome::Abandoned;
            }
            match bent.or_else(|| self.trial(moved(&self.result.x, &shared, bounds))) {
                Some(trial) => {
                    self.accept(trial, promised);
                    if self.quiet >= QUIET_STEPS {
                        return LmOutcome::Converged;
                    }
                }
                None if promised <= self.options.relative_reduction * 1e-3 * self.merit => {
                    return LmOutcome::Converged;
                }
                None if self.damping.raise() => return LmOutcome::Stalled,
                // The elimination depends on nu: it is assembled again where points have unknowns of their own.
                None => normal = Some(system).filter(|system| system.tangent_sq <= 0.0),
            }
        }
        LmOutcome::StepLimit
    }

    /// Returns the outcome of a solve that ends before a step.
    fn ended(&self, step: usize) -> Option<LmOutcome> {
        let (result, options) = (&*self.result, self.options);
        if result.cost <= options.exact_cost
            && self.penalty.shift.iter().all(|m| *m == 0.0)
            && violation(self.problem, &result.x, &result.state) <= options.feasibility
        {
            return Some(LmOutcome::Exact);
        }
        if result.evaluations >= options.max_evaluations {
            return Some(LmOutcome::StepLimit);
        }
        let hopeless = step == options.max_steps / 2 && result.cost > options.hopeless_cost;
        ((self.stop)() || hopeless).then_some(LmOutcome::Abandoned)
    }

    /// Assembles the normal equations at the best point with the present damping.
    fn assembled(&mut self) -> Option<Normal<N>> {
        self.nu = self.damping.value * self.tangent_sq;
        let system = assemble(self.problem, self.result, self.penalty, self.nu, &mut self.work)?;
        self.tangent_sq = system.tangent_sq;
        Some(system)
    }

    /// Evaluates the end of a step; `None` if it does not exist or its merit is no better.
    fn trial(&mut self, x: [f64; N]) -> Option<Trial<N>> {
        self.result.evaluations += 1;
        let (problem, work, state) = (self.problem, &self.work, &mut self.trial_state);
        if !problem.retract(&self.result.x, &self.result.state, &work.tau, &x, state) || (self.stop)() {
            return None;
        }
        if !work.gaps.is_empty() {
            problem.join(state, work.order.leaders());
            if !put_in_order(problem, &x, state, &work.stiffness, &mut self.buffers.gaps, self.stop) {
                return None;
            }
        }
        let cost = problem.cost(&x, state)?;
        let merit = cost + self.penalty.of(problem, &x, state);
        (merit < self.merit).then_some(Trial { x, cost, merit })
    }

    /// Evaluates the end of the step bent by its geodesic acceleration, if progress is slow; the points' own steps are
    /// those of the straight step again if there is no better one.
    fn bent_trial(&mut self, system: &Normal<N>, dx: &SVector<f64, N>) -> Option<Trial<N>> {
        // Three evaluations at most: the acceleration, the bent step and the straight one.
        let allowed = self.result.evaluations + 3 <= self.options.max_evaluations;
        if !self.slow || self.work.order.any() || !allowed {
            return None;
        }
        self.result.evaluations += 1;
        let bent = self.bend(system, dx)?;
        let trial = self.trial(bent);
        if trial.is_none() {
            self.work.own_steps_after(&(*dx).into(), self.nu);
        }
        trial
    }

    /// Computes the end of a step bent by half its geodesic acceleration, inside the bounds, and bends the points' own
    /// steps with it; `None` if the acceleration cannot be measured or is too large.
    fn bend(&mut self, system: &Normal<N>, dx: &SVector<f64, N>) -> Option<[f64; N]> {
        let (problem, at, nu) = (self.problem, &*self.result, self.nu);
        let shared: [f64; N] = (*dx).into();
        let ahead: [f64; N] = std::array::from_fn(|i| at.x[i] + AHEAD * shared[i]);
        let Buffers { own, residuals, second, .. } = &mut self.buffers;
        own.clear();
        own.extend(self.work.tau.iter().map(|tau| AHEAD * tau));
        if !problem.retract(&at.x, &at.state, own, &ahead, &mut self.trial_state) {
            return None;
        }
        if !problem.residuals(&ahead, &self.trial_state, residuals) {
            return None;
        }
        let gradient = self.work.bending(residuals, &shared, nu, second);
        let after: [f64; N] = std::array::from_fn(|i| at.x[i] + shared[i]);
        let (bounds, damping) = (problem.bounds(), self.damping.value);
        let half = 0.5 * bounded_step(&system.matrix, &gradient, &after, bounds, damping)?;
        let length = |v: &SVector<f64, N>| (0..N).map(|i| system.matrix[(i, i)] * v[i] * v[i]).sum::<f64>();
        if length(&half).is_nan() || length(&half) > MOST_BENT * MOST_BENT * length(dx) {
            return None;
        }
        let half = half.into();
        self.work.bend_own_steps(&half, second, nu);
        Some(moved(&after, &half, problem.bounds()))
    }

    /// Takes a trial as the best point and adapts the damping.
    fn accept(&mut self, trial: Trial<N>, promised: f64) {
        let reduction = self.merit - trial.merit;
        (self.result.x, self.result.cost) = (trial.x, trial.cost);
        std::mem::swap(&mut self.result.state, &mut self.trial_state);
        self.slow = reduction < SLOW * self.merit;
        self.merit = trial.merit;
        self.damping.accept(reduction / promised.max(f64::MIN_POSITIVE));
        let hardly = reduction <= self.options.relative_reduction * self.merit;
        self.quiet = if hardly { self.quiet + 1 } else { 0 };
    }
}

/// Pools points that have passed each other in a step after all, because the way back to the curves is not straight;
/// `false` if that fails or `stop` returns true. `gaps` is a buffer.
fn put_in_order<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    x: &[f64; N],
    state: &mut P::State,
    stiffness: &[f64],
    gaps: &mut Vec<f64>,
    stop: &dyn Fn() -> bool,
) -> bool {
    for _ in 0..MOST_REPAIRS {
        if stop() {
            return false;
        }
        gaps.clear();
        if !problem.gaps(x, state, gaps) {
            return true;
        }
        // Only points that are near each other have just passed: over longer ways a gap is a rough measure.
        gaps.iter_mut().filter(|gap| **gap < -JUST_PASSED).for_each(|gap| *gap = 0.0);
        if gaps.iter().all(|gap| *gap >= 0.0) {
            return true;
        }
        let mut order = Ordered::new(gaps.len());
        let mut tau = vec![0.0; gaps.len()];
        order.pool(gaps, &mut tau, stiffness);
        let before = state.clone();
        if !problem.retract(x, &before, &tau, x, state) {
            return false;
        }
        problem.join(state, order.leaders());
    }
    true
}

/// The number of steps in a row with hardly any reduction after which a solve counts as converged.
const QUIET_STEPS: usize = 3;

#[cfg(test)]
mod tests;
