//! Sequential convex programming for points that share a few unknowns: least squares, or the least largest
//! deviation, under inequalities.
//!
//! ```text
//! sum of squares     minimise  sum_j w_j |r_j|^2
//! max deviation      minimise  T   subject to  |r_j| <= T tol_j
//! within tolerances  minimise  sum_j w_j |r_j|^2   subject to  |r_j| <= tol_j
//! and always         lo <= x <= hi,   g_i(x, s) >= 0
//! ```
//!
//! At each step the residuals and inequalities are replaced by their linear models r_j + J_j dx and
//! g_i + <dg_i, dx> inside a trust box, which leaves a quadratic or a second-order cone program ([`super::conic`]).
//! Where a point has an unknown of its own (its tangent t_j is not zero) that unknown takes up the residual along
//! t_j, and only the component across counts. What the linear models leave out, the curvature of the residuals
//! and inequalities weighed by their multipliers, is learnt from step to step by the symmetric rank-one
//! formula (Broyden 1967; its positive part is used). Inequalities are elastic: a slack shared by all of them,
//! with a price that grows until the slack falls, so that a start outside first gets inside (Byrd, Gould,
//! Nocedal and Waltz 2004, steering rules). A step is kept when the same price function falls with the true
//! residuals; a refused one is corrected once to second order (Fletcher 1982).

mod model;

use super::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, PointBlock};
use model::{Curvature, Model, Step};

/// What is minimised. Tolerances: one a point, positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal<'a> {
    /// sum_j w_j |r_j|^2.
    SumOfSquares,
    /// max_j |r_j| / tol_j; the weights do not enter.
    MaxDeviation {
        /// tol_j.
        tolerances: &'a [f64],
    },
    /// sum_j w_j |r_j|^2 with |r_j| <= tol_j; a start outside first lessens max_j |r_j| / tol_j.
    SumOfSquaresWithin {
        /// tol_j.
        tolerances: &'a [f64],
    },
}

/// When to stop, and in which units.
#[derive(Clone, Copy, Debug)]
pub struct ConvexOptions<const N: usize> {
    /// Steps at most.
    pub max_steps: usize,
    /// Linearisations at most; at least one is made.
    pub max_evaluations: u64,
    /// The first half width of the trust box for each shared unknown; positive.
    pub trust: [f64; N],
    /// The length by which inequalities are judged: a lack of this much weighs as much as the whole objective.
    pub length: f64,
    /// Converged when a step promises less than this part of the objective.
    pub relative_reduction: f64,
    /// An inequality counts as met when g >= -this.
    pub feasibility: f64,
    /// Done when all is met and the objective is not above this.
    pub good_enough: f64,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConvexOutcome {
    /// No step promises more, and everything is met.
    Converged,
    /// No step promises more, and something is not met: nearby nothing lacks less.
    Infeasible,
    /// Everything is met and the objective is good enough.
    GoodEnough,
    /// Steps that are promised are not found: the best point so far is returned.
    Stalled,
    /// Out of steps or evaluations.
    StepLimit,
    /// The start could not be evaluated.
    NoStart,
    /// Stopped from outside.
    Stopped,
}

/// What the limits cost at the end: rates of the objective.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers<const N: usize> {
    /// One a row, not negative: asking for g_i >= delta raises the objective by this times delta. In the unit
    /// of the objective over the unit of g_i.
    pub rows: Vec<f64>,
    /// Raising the lower bound by delta raises the objective by this times delta.
    pub lower: [f64; N],
    /// Reducing the upper bound by delta raises the objective by this times delta.
    pub upper: [f64; N],
    /// One a point (empty for the plain sum of squares). Max deviation: the share that a point has in the
    /// maximum; they sum to 1. Within tolerances: reducing tol_j by the part delta of itself raises the objective
    /// by this times delta.
    pub points: Vec<f64>,
}

/// The end of a solve.
#[derive(Clone, Debug)]
pub struct ConvexResult<const N: usize, S> {
    /// The shared unknowns.
    pub x: [f64; N],
    /// The points' unknowns.
    pub state: S,
    /// The objective of the goal.
    pub objective: f64,
    /// The largest -g_i, or 0.
    pub violation: f64,
    /// max_j |r_j| / tol_j where the goal has tolerances, else 0.
    pub deviation: f64,
    /// Linearisations made.
    pub evaluations: u64,
    /// Steps tried, the same number of convex programs or more.
    pub steps: usize,
    /// How it ended.
    pub outcome: ConvexOutcome,
    /// Of the last program that was solved; `None` before the first.
    pub multipliers: Option<Multipliers<N>>,
}

/// A point's own step is at most this long (radians): beyond it the tangent says nothing.
const MAX_TAU: f64 = 0.6;
/// A step that wins at least this part of what it promised is kept.
const KEEP: f64 = 1e-3;
/// The trust box follows a good step with this room to grow.
const ROOM: f64 = 4.0;
/// A trust box below this part of the first one is below rounding.
const LEAST_TRUST: f64 = 1e-13;
/// The first price of a slack, and the highest.
const FIRST_PRICE: f64 = 10.0;
const HIGHEST_PRICE: f64 = 1e7;
/// A program should take away this part of the lack; else the slack gets dearer.
const STEER: f64 = 0.7;
/// Kept steps in a row that hardly reduce before a solve counts as converged.
const QUIET_STEPS: usize = 3;
/// Programs in a row that cannot be solved before a solve is given up.
const FAILED_PROGRAMS: usize = 6;

/// A point of the iteration with everything that is known there.
struct At<const N: usize, S> {
    x: [f64; N],
    state: S,
    blocks: Vec<PointBlock<N>>,
    rows: Vec<ConstraintRow<N>>,
    objective: f64,
    deviation: f64,
    /// The largest -g_i, or 0.
    violation: f64,
    /// What is lacking, without a unit: max over -g_i / length and, within tolerances, |r_j| / tol_j - 1.
    lack: f64,
}

/// |r|.
fn norm(r: [f64; 2]) -> f64 {
    r[0].hypot(r[1])
}

impl Goal<'_> {
    /// The tolerances, where the goal has them.
    fn tolerances(&self) -> Option<&[f64]> {
        match self {
            Goal::SumOfSquares => None,
            Goal::MaxDeviation { tolerances } | Goal::SumOfSquaresWithin { tolerances } => Some(tolerances),
        }
    }
}

fn look<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    goal: &Goal<'_>,
    length: f64,
    x: [f64; N],
    state: P::State,
) -> Option<At<N, P::State>> {
    let sum_sq = problem.cost(&x, &state)?;
    let (mut blocks, mut rows) = (Vec::with_capacity(problem.points()), Vec::new());
    if !problem.linearise(&x, &state, &mut |block| blocks.push(*block)) {
        return None;
    }
    problem.constraints(&x, &state, &mut |row| rows.push(row.followed(&blocks, 0.0)));
    let deviation = goal.tolerances().map_or(0.0, |tolerances| {
        blocks.iter().zip(tolerances).fold(0.0, |m: f64, (b, tol)| m.max(norm(b.residual) / tol))
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

/// Solves from a start. `stop` is asked between steps.
///
/// The start is brought into its bounds and x never leaves them. The best point so far is what is returned: of
/// points that meet everything the one of the least objective, else the one that lacks least for its price.
///
/// # Panics
/// When a goal has fewer tolerances than there are points.
pub fn solve<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    goal: &Goal<'_>,
    start: [f64; N],
    state: P::State,
    options: &ConvexOptions<N>,
    stop: &dyn Fn() -> bool,
) -> ConvexResult<N, P::State> {
    assert!(goal.tolerances().is_none_or(|t| t.len() >= problem.points()), "a tolerance a point");
    let mut x = start;
    for (value, &(low, high)) in x.iter_mut().zip(problem.bounds()) {
        *value = value.max(low).min(high);
    }
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

struct Solve<'a, const N: usize, P: BlockLeastSquares<N>> {
    problem: &'a P,
    goal: &'a Goal<'a>,
    options: &'a ConvexOptions<N>,
    at: At<N, P::State>,
    evaluations: u64,
    steps: usize,
    curvature: Curvature<N>,
    price: f64,
    multipliers: Option<Multipliers<N>>,
}

impl<const N: usize, P: BlockLeastSquares<N>> Solve<'_, N, P> {
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

    /// The lack that counts as none.
    fn slight(&self) -> f64 {
        self.options.feasibility / self.options.length
    }

    fn met(&self) -> bool {
        self.at.lack <= self.slight()
    }

    fn ended(&self) -> ConvexOutcome {
        if self.met() { ConvexOutcome::Converged } else { ConvexOutcome::Infeasible }
    }

    fn iterate(&mut self, stop: &dyn Fn() -> bool) -> ConvexOutcome {
        let mut trust = 1.0;
        let (mut quiet, mut failed) = (0, 0);
        while self.steps < self.options.max_steps {
            if stop() {
                return ConvexOutcome::Stopped;
            }
            if self.met() && self.at.objective <= self.options.good_enough {
                return ConvexOutcome::GoodEnough;
            }
            if self.evaluations >= self.options.max_evaluations {
                return ConvexOutcome::StepLimit;
            }
            if trust < LEAST_TRUST {
                return ConvexOutcome::Stalled;
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
            let merit = |objective: f64, lack: f64| objective / unit + self.price * lack.max(0.0);
            let now = merit(self.at.objective, self.at.lack);
            let promised = now - merit(step.objective, step.lack);
            let price = self.price;
            self.multipliers = Some(step.multipliers.clone());
            if promised <= self.options.relative_reduction * now.min(1.0) {
                return self.ended();
            }
            let trial = self.trial(&step);
            let mut won = self.won(trial.as_ref(), now, unit, price);
            let mut chosen = trial;
            if won < KEEP * promised
                && let Some(refused) = &chosen
                && self.evaluations < self.options.max_evaluations
            {
                self.curvature.learn(
                    self.options,
                    &self.at.x,
                    &self.at.blocks,
                    &self.at.rows,
                    refused,
                    &step,
                );
                model.correct(&refused.blocks, &refused.rows, &step);
                if let Some(second) = model.solve(&self.curvature, price) {
                    let corrected = self.trial(&second);
                    let gain = self.won(corrected.as_ref(), now, unit, price);
                    if gain > won {
                        (won, chosen) = (gain, corrected);
                    }
                }
            }
            let reach = step.reach;
            match chosen {
                Some(next) if won >= KEEP * promised => {
                    self.curvature.learn(
                        self.options,
                        &self.at.x,
                        &self.at.blocks,
                        &self.at.rows,
                        &next,
                        &step,
                    );
                    self.at = next;
                    let ratio = won / promised;
                    trust = if ratio < 0.25 {
                        0.5 * trust * reach.clamp(0.1, 1.0)
                    } else if ratio > 0.5 {
                        (ROOM * trust * reach).clamp(0.1 * trust, ROOM * trust)
                    } else {
                        trust
                    };
                    quiet = if won <= self.options.relative_reduction * now.min(1.0) { quiet + 1 } else { 0 };
                    if quiet >= QUIET_STEPS {
                        return self.ended();
                    }
                    if self.met() {
                        // Twice what the limits cost is enough to keep to them.
                        let length = self.options.length;
                        let rows: f64 = step.multipliers.rows.iter().sum::<f64>() * length / unit;
                        let points = match self.goal {
                            Goal::SumOfSquaresWithin { .. } => {
                                step.multipliers.points.iter().sum::<f64>() / unit
                            }
                            Goal::SumOfSquares | Goal::MaxDeviation { .. } => 0.0,
                        };
                        self.price = (2.0 * (rows + points)).clamp(FIRST_PRICE, HIGHEST_PRICE);
                    }
                }
                _ => trust *= 0.25 * reach.clamp(0.1, 1.0),
            }
        }
        ConvexOutcome::StepLimit
    }

    /// The program's step at a price at which the lack falls.
    fn steered(&mut self, model: &mut Model<'_, N>) -> Option<Step<N>> {
        let mut step = model.solve(&self.curvature, self.price)?;
        while step.lack > self.slight().max(STEER * self.at.lack) && self.price < HIGHEST_PRICE {
            let dearer = (10.0 * self.price).min(HIGHEST_PRICE);
            let Some(next) = model.solve(&self.curvature, dearer) else { break };
            self.price = dearer;
            // Where a price buys nothing more, the box is what binds.
            let bought = step.lack - next.lack;
            let done = bought <= 1e-3 * step.lack;
            step = next;
            if done {
                break;
            }
        }
        Some(step)
    }

    fn won(&self, trial: Option<&At<N, P::State>>, now: f64, unit: f64, price: f64) -> f64 {
        trial.map_or(f64::NEG_INFINITY, |next| now - (next.objective / unit + price * next.lack.max(0.0)))
    }

    /// The true residuals and inequalities after a step; `None` where they do not exist.
    fn trial(&mut self, step: &Step<N>) -> Option<At<N, P::State>> {
        self.evaluations += 1;
        let mut x = self.at.x;
        for (value, (by, &(low, high))) in x.iter_mut().zip(step.dx.iter().zip(self.problem.bounds())) {
            *value = (*value + by).max(low).min(high);
        }
        let mut state = self.at.state.clone();
        if !self.problem.retract(&self.at.x, &self.at.state, &step.tau, &x, &mut state) {
            return None;
        }
        look(self.problem, self.goal, self.options.length, x, state)
    }
}

#[cfg(test)]
mod tests;
