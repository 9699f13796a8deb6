//! Sequential convex programming for points that share a few unknowns: least squares or minimax deviation under
//! inequalities.
//!
//! ```text
//! sum of squares     minimise  sum_j w_j |r_j|^2
//! max deviation      minimise  T   subject to  |r_jk| <= T tol_jk
//! within tolerances  minimise  sum_j w_j |r_j|^2   subject to  |r_jk| <= tol_jk
//! and always         lo <= x <= hi,   g_i(x, s) >= 0
//! ```
//!
//! where tolerances limit the parts r_jk of a residual of R rows: rows 0 and 1 together (the place of a point), then each
//! further row by itself (an angle).
//!
//! At each step the residuals and inequalities are replaced by their linear models r_j + J_j dx and g_i + <dg_i, dx>
//! inside a trust box, which leaves a quadratic or a second-order cone program ([`super::conic`]). If a point has an
//! unknown of its own (its tangent t_j is not zero), that unknown takes up the residual along t_j, and only the
//! components across count. If tolerances limit several parts of its residual, a step along t_j trades one against
//! another: then tau_j is a variable of the program, and the model is r_j + J_j dx + t_j tau_j. The curvature of the residuals and inequalities, weighted by their multipliers, is left
//! out by the linear models and learnt from step to step by the symmetric rank-one formula (Broyden 1967; its
//! positive part is used). Inequalities are elastic: a slack shared by all of them, with a price that grows until the
//! slack falls, so that a start outside first gets inside (Byrd, Gould, Nocedal and Waltz 2004, steering rules). A
//! step is accepted if the merit function with this price falls with the true residuals; a rejected one gets one
//! second-order correction (Fletcher 1982).

mod curvature;
mod model;
mod point;

use super::damping::{clamped, moved};
use super::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, PointBlock};
use curvature::Curvature;
use model::{Model, Step};
use point::{deviation, is_traded, parts};

/// The objective of a solve.
///
/// Tolerances: R - 1 for each point, positive, point by point. The first limits the length of rows 0 and 1 together,
/// each further one the magnitude of one further row; an infinite one limits nothing. With the parts r_jk of a residual
/// that they limit, the deviation of a point is max_k |r_jk| / tol_jk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal<'a> {
    /// The sum of squares, sum_j w_j |r_j|^2.
    SumOfSquares,
    /// The largest deviation of a point, max_jk |r_jk| / tol_jk; the weights do not enter.
    MaxDeviation {
        /// The tolerances tol_jk.
        tolerances: &'a [f64],
    },
    /// The sum of squares, sum_j w_j |r_j|^2, subject to |r_jk| <= tol_jk; from a start outside, the largest deviation
    /// is reduced first.
    SumOfSquaresWithin {
        /// The tolerances tol_jk.
        tolerances: &'a [f64],
    },
}

/// The stopping criteria and units of [`solve`].
#[derive(Clone, Copy, Debug)]
pub struct ConvexOptions<const N: usize> {
    /// The largest number of steps.
    pub max_steps: usize,
    /// The largest number of linearisations; at least one is made.
    pub max_evaluations: u64,
    /// The first half width of the trust box for each shared unknown; positive.
    pub trust: [f64; N],
    /// The length scale of the inequalities: a violation of this much weighs as much as the whole objective.
    pub length: f64,
    /// The relative reduction for convergence: the reduction predicted for a step is less than this part of the
    /// objective.
    pub relative_reduction: f64,
    /// The tolerance of the inequalities: one counts as met if g >= -`feasibility`.
    pub feasibility: f64,
    /// The objective at or below which a solve ends, once all constraints are met.
    pub good_enough: f64,
}

/// The reason for which a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConvexOutcome {
    /// Convergence: no step is predicted to reduce the objective further, and all constraints are met.
    Converged,
    /// No step is predicted to reduce the merit further, and some constraint is not met: the violation is at a local
    /// minimum.
    Infeasible,
    /// All constraints are met and the objective is good enough.
    GoodEnough,
    /// The trust box has become too small or the programs cannot be solved: the best point so far is returned.
    Stalled,
    /// The steps or evaluations are used up.
    StepLimit,
    /// The start could not be evaluated.
    NoStart,
    /// The caller's `stop` ended the solve.
    Stopped,
}

/// The Lagrange multipliers at the end: rates at which the objective changes with the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers<const N: usize> {
    /// The multiplier of each row, not negative: asking for g_i >= delta raises the objective by this times delta. In
    /// the unit of the objective over the unit of g_i.
    pub rows: Vec<f64>,
    /// The multiplier of each lower bound: raising it by delta raises the objective by this times delta.
    pub lower: [f64; N],
    /// The multiplier of each upper bound: reducing it by delta raises the objective by this times delta.
    pub upper: [f64; N],
    /// The multiplier of each tolerance, R - 1 for each point (empty for the plain sum of squares). Max deviation: the
    /// share that a part of a residual has in the maximum; they sum to 1. Within tolerances: reducing tol_jk by the part
    /// delta of itself raises the objective by this times delta.
    pub points: Vec<f64>,
}

/// The result of a solve.
#[derive(Clone, Debug)]
pub struct ConvexResult<const N: usize, S> {
    /// The shared unknowns.
    pub x: [f64; N],
    /// The points' own unknowns.
    pub state: S,
    /// The objective of the goal.
    pub objective: f64,
    /// The violation of the inequalities: the largest -g_i, or 0.
    pub violation: f64,
    /// The largest deviation, max_jk |r_jk| / tol_jk, if the goal has tolerances, else 0.
    pub deviation: f64,
    /// The number of linearisations.
    pub evaluations: u64,
    /// The number of steps tried; the number of convex programs is the same or more.
    pub steps: usize,
    /// The reason for which it ended.
    pub outcome: ConvexOutcome,
    /// The multipliers of the last program that was solved; `None` before the first.
    pub multipliers: Option<Multipliers<N>>,
}

/// The least ratio of actual to predicted reduction with which a step is accepted.
const KEEP: f64 = 1e-3;
/// The size of the trust box relative to the good step before it.
const ROOM: f64 = 4.0;
/// The smallest trust box, relative to the first one; a smaller one is below rounding.
const LEAST_TRUST: f64 = 1e-13;
/// The first price (penalty weight) of the slack; [`HIGHEST_PRICE`] is the largest.
const FIRST_PRICE: f64 = 10.0;
const HIGHEST_PRICE: f64 = 1e7;
/// The part of the lack to which a program has to reduce it; otherwise the price of the slack grows.
const STEER: f64 = 0.7;
/// The number of accepted steps in a row with hardly any reduction after which a solve counts as converged.
const QUIET_STEPS: usize = 3;
/// The part of the largest multiplier of a point above which a point counts as active.
const ACTIVE: f64 = 1e-6;
/// The number of programs in a row that cannot be solved after which a solve is given up.
const FAILED_PROGRAMS: usize = 6;

/// An iterate with its linearisation.
struct At<const N: usize, const R: usize, S> {
    x: [f64; N],
    state: S,
    blocks: Vec<PointBlock<N, R>>,
    /// The inequalities, with derivatives by traded own unknowns alone (see [`is_traded`]); the others follow.
    rows: Vec<ConstraintRow<N>>,
    objective: f64,
    deviation: f64,
    /// The violation of the inequalities: the largest -g_i, or 0.
    violation: f64,
    /// The lack, a dimensionless measure of infeasibility: the maximum over -g_i / length and, within
    /// tolerances, |r_jk| / tol_jk - 1.
    lack: f64,
}

impl<'a> Goal<'a> {
    /// Returns the tolerances, if the goal has them.
    fn tolerances(&self) -> Option<&'a [f64]> {
        match self {
            Goal::SumOfSquares => None,
            Goal::MaxDeviation { tolerances } | Goal::SumOfSquaresWithin { tolerances } => Some(tolerances),
        }
    }

    /// Returns the tolerances of a point with a residual of `rows` rows, if the goal has them.
    fn tolerances_of(&self, point: usize, rows: usize) -> Option<&'a [f64]> {
        self.tolerances().map(|list| &list[parts(rows) * point..parts(rows) * (point + 1)])
    }
}

fn look<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    goal: &Goal<'_>,
    length: f64,
    x: [f64; N],
    state: P::State,
) -> Option<At<N, R, P::State>> {
    let sum_sq = problem.cost(&x, &state)?;
    let (mut blocks, mut rows) = (Vec::with_capacity(problem.points()), Vec::new());
    if !problem.linearise(&x, &state, &mut |block| blocks.push(*block)) {
        return None;
    }
    let traded = |j: usize| blocks.get(j).is_some_and(|block| is_traded(block, goal.tolerances_of(j, R)));
    problem.constraints(&x, &state, &mut |_, row| rows.push(row().followed(&blocks, 0.0, traded)));
    let deviation = goal.tolerances().map_or(0.0, |tolerances| {
        let points = blocks.iter().zip(tolerances.chunks_exact(parts(R)));
        points.fold(0.0, |most: f64, (block, list)| most.max(deviation(&block.residual, list)))
    });
    let objective = if matches!(goal, Goal::MaxDeviation { .. }) { deviation } else { sum_sq };
    let violation = rows.iter().fold(0.0, |m: f64, row| m.max(-row.value));
    let mut lack = violation / length;
    if matches!(goal, Goal::SumOfSquaresWithin { .. }) {
        lack = lack.max(deviation - 1.0);
    }
    let usable = objective.is_finite() && deviation.is_finite() && lack.is_finite();
    usable.then_some(At { x, state, blocks, rows, objective, deviation, violation, lack })
}

/// Minimises the goal from a start by sequential convex programming. `stop` is called between steps.
///
/// The start is clamped to its bounds and x never leaves them. The best point so far is returned: of points that meet
/// all constraints the one of the least objective, else the one that lacks least for its price.
///
/// # Panics
/// When a goal has fewer than R - 1 tolerances for each point.
pub fn solve<const N: usize, const R: usize, P: BlockLeastSquares<N, R>>(
    problem: &P,
    goal: &Goal<'_>,
    start: [f64; N],
    state: P::State,
    options: &ConvexOptions<N>,
    stop: &dyn Fn() -> bool,
) -> ConvexResult<N, P::State> {
    const { assert!(R >= 2, "the first tolerance of a point limits two rows") };
    let wanted = parts(R) * problem.points();
    assert!(goal.tolerances().is_none_or(|t| t.len() >= wanted), "a tolerance for each part of a residual");
    let x = clamped(start, problem.bounds());
    let Some(at) = look(problem, goal, options.length, x, state.clone()) else {
        return ConvexResult {
            x,
            state,
            objective: f64::INFINITY,
            violation: f64::INFINITY,
            deviation: f64::INFINITY,
            evaluations: 1,
            steps: 0,
            outcome: ConvexOutcome::NoStart,
            multipliers: None,
        };
    };
    Solve {
        problem,
        goal,
        options,
        at,
        evaluations: 1,
        steps: 0,
        curvature: Curvature::none(),
        price: FIRST_PRICE,
        multipliers: None,
    }
    .run(stop)
}

struct Solve<'a, const N: usize, const R: usize, P: BlockLeastSquares<N, R>> {
    problem: &'a P,
    goal: &'a Goal<'a>,
    options: &'a ConvexOptions<N>,
    at: At<N, R, P::State>,
    evaluations: u64,
    steps: usize,
    curvature: Curvature<N>,
    price: f64,
    multipliers: Option<Multipliers<N>>,
}

impl<const N: usize, const R: usize, P: BlockLeastSquares<N, R>> Solve<'_, N, R, P> {
    fn run(mut self, stop: &dyn Fn() -> bool) -> ConvexResult<N, P::State> {
        let outcome = self.iterate(stop);
        ConvexResult {
            x: self.at.x,
            state: self.at.state,
            objective: self.at.objective,
            violation: self.at.violation,
            deviation: self.at.deviation,
            evaluations: self.evaluations,
            steps: self.steps,
            outcome,
            multipliers: self.multipliers,
        }
    }

    /// Returns the largest lack that counts as none.
    fn slight(&self) -> f64 {
        self.options.feasibility / self.options.length
    }

    fn met(&self) -> bool {
        self.at.lack <= self.slight()
    }

    fn ended(&self) -> ConvexOutcome {
        if self.met() { ConvexOutcome::Converged } else { ConvexOutcome::Infeasible }
    }

    /// Returns the outcome of a solve that ends before a step.
    fn ended_before(&self, trust: f64, stop: &dyn Fn() -> bool) -> Option<ConvexOutcome> {
        if stop() {
            Some(ConvexOutcome::Stopped)
        } else if self.met() && self.at.objective <= self.options.good_enough {
            Some(ConvexOutcome::GoodEnough)
        } else if self.evaluations >= self.options.max_evaluations {
            Some(ConvexOutcome::StepLimit)
        } else {
            (trust < LEAST_TRUST).then_some(ConvexOutcome::Stalled)
        }
    }

    fn iterate(&mut self, stop: &dyn Fn() -> bool) -> ConvexOutcome {
        let mut trust = 1.0;
        let (mut quiet, mut failed) = (0, 0);
        while self.steps < self.options.max_steps {
            if let Some(outcome) = self.ended_before(trust, stop) {
                return outcome;
            }
            self.steps += 1;
            // The objective is measured in parts of its present value.
            let unit = self.at.objective.max(self.options.good_enough).max(f64::MIN_POSITIVE);
            let mut model = Model::new(self.problem, self.goal, self.options, &self.at, trust, unit);
            let Some(step) = self.steered(&mut model) else {
                failed += 1;
                if failed >= FAILED_PROGRAMS {
                    return ConvexOutcome::Stalled;
                }
                self.curvature = Curvature::none();
                trust *= 0.25;
                continue;
            };
            failed = 0;
            let now = self.merit(self.at.objective, self.at.lack, unit);
            let promised = now - self.merit(step.objective, step.lack, unit);
            self.multipliers = Some(step.multipliers.clone());
            let hardly = self.options.relative_reduction * now.min(1.0);
            if promised <= hardly {
                return self.ended();
            }
            let (won, chosen) = self.evaluated(&mut model, &step, [now, promised, unit]);
            match chosen {
                Some(next) if won >= KEEP * promised => {
                    self.curvature.learn(self.options, &self.at, &next, &step);
                    self.at = next;
                    trust = trust_after(trust, won / promised, step.reach);
                    quiet = if won <= hardly { quiet + 1 } else { 0 };
                    if quiet >= QUIET_STEPS {
                        return self.ended();
                    }
                    if self.met() {
                        self.price = self.sufficient_price(&step.multipliers, unit);
                    }
                }
                _ => trust *= 0.25 * step.reach.clamp(0.1, 1.0),
            }
        }
        ConvexOutcome::StepLimit
    }

    /// Computes the merit of an objective, measured in `unit`, with a lack at the present price.
    fn merit(&self, objective: f64, lack: f64, unit: f64) -> f64 {
        objective / unit + self.price * lack.max(0.0)
    }

    /// Evaluates a step and, if it gains too little, its second-order correction; returns the better of both with its
    /// gain over the merit `now`.
    fn evaluated(
        &mut self,
        model: &mut Model<'_, N, R>,
        step: &Step<N, R>,
        [now, promised, unit]: [f64; 3],
    ) -> (f64, Option<At<N, R, P::State>>) {
        let won = |solve: &Self, trial: &Option<At<N, R, P::State>>| {
            trial
                .as_ref()
                .map_or(f64::NEG_INFINITY, |next| now - solve.merit(next.objective, next.lack, unit))
        };
        let trial = self.trial(step);
        let gain = won(self, &trial);
        if gain < KEEP * promised
            && let Some(refused) = &trial
            && self.evaluations < self.options.max_evaluations
        {
            self.curvature.learn(self.options, &self.at, refused, step);
            model.correct(&refused.blocks, &refused.rows, step);
            if let Some(second) = model.solve(&self.curvature, self.price, &self.active()) {
                let corrected = self.trial(&second);
                let of_corrected = won(self, &corrected);
                if of_corrected > gain {
                    return (of_corrected, corrected);
                }
            }
        }
        (gain, trial)
    }

    /// Returns the points that were active in the last program.
    fn active(&self) -> Vec<usize> {
        let shares: &[f64] = self.multipliers.as_ref().map_or(&[], |multipliers| &multipliers.points);
        let least = ACTIVE * shares.iter().copied().fold(0.0, f64::max);
        let points = shares.chunks_exact(parts(R)).enumerate();
        points.filter(|(_, shares)| shares.iter().any(|share| *share > least)).map(|(j, _)| j).collect()
    }

    /// Returns a price of twice the multipliers, which is enough to keep to the limits.
    fn sufficient_price(&self, multipliers: &Multipliers<N>, unit: f64) -> f64 {
        let rows: f64 = multipliers.rows.iter().sum::<f64>() * self.options.length / unit;
        let points = match self.goal {
            Goal::SumOfSquaresWithin { .. } => multipliers.points.iter().sum::<f64>() / unit,
            Goal::SumOfSquares | Goal::MaxDeviation { .. } => 0.0,
        };
        (2.0 * (rows + points)).clamp(FIRST_PRICE, HIGHEST_PRICE)
    }

    /// Solves the program for a step, raising the price of the slack until the lack falls.
    fn steered(&mut self, model: &mut Model<'_, N, R>) -> Option<Step<N, R>> {
        let mut step = model.solve(&self.curvature, self.price, &self.active())?;
        while step.lack > self.slight().max(STEER * self.at.lack) && self.price < HIGHEST_PRICE {
            let dearer = (10.0 * self.price).min(HIGHEST_PRICE);
            let Some(next) = model.solve(&self.curvature, dearer, &self.active()) else { break };
            self.price = dearer;
            // If a higher price does not reduce the lack, the trust box is the active limit.
            let bought = step.lack - next.lack;
            let done = bought <= 1e-3 * step.lack;
            step = next;
            if done {
                break;
            }
        }
        Some(step)
    }

    /// Evaluates the true residuals and inequalities after a step; `None` if they do not exist.
    fn trial(&mut self, step: &Step<N, R>) -> Option<At<N, R, P::State>> {
        self.evaluations += 1;
        let x = moved(&self.at.x, &step.dx, self.problem.bounds());
        let mut state = self.at.state.clone();
        if !self.problem.retract(&self.at.x, &self.at.state, &step.tau, &x, &mut state) {
            return None;
        }
        look(self.problem, self.goal, self.options.length, x, state)
    }
}

/// Returns the trust box after an accepted step with a ratio of actual to predicted reduction.
fn trust_after(trust: f64, ratio: f64, reach: f64) -> f64 {
    if ratio < 0.25 {
        0.5 * trust * reach.clamp(0.1, 1.0)
    } else if ratio > 0.5 {
        (ROOM * trust * reach).clamp(0.1 * trust, ROOM * trust)
    } else {
        trust
    }
}

#[cfg(test)]
mod pose_tests;
#[cfg(test)]
mod tests;
