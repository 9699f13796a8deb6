//! Bounded Levenberg-Marquardt for points that share a few unknowns and may each have one of their own.
//!
//! minimise  sum_j w_j |r_j(x, s_j)|^2   subject to  lo <= x <= hi  and  g_i(x, s) >= 0
//!
//! where r_j is a planar residual, x in R^N is shared and s_j is a point's own position on a curve. In a step
//! (dx, tau_j) the linear model is r_j + J_j dx + t_j tau_j with the tangent t_j = dr_j/dtau_j. The tau_j are
//! eliminated: rows normal to t_j keep weight 1, rows along it weight nu/(|t_j|^2 + nu) with a damping nu, and
//!
//! ```text
//! tau_j = -<t_j, r_j + J_j dx> / (|t_j|^2 + nu)
//! ```
//!
//! so the cost of a step is linear in the number of points. Where progress is slow, as along a narrow curved
//! valley, a step is bent by its geodesic acceleration: half of the a that solves the same system for the
//! second derivative of the residuals along the step, taken from one more evaluation (Transtrum and Sethna
//! 2012, *Improvements to the Levenberg-Marquardt algorithm for nonlinear least-squares minimization*). Where the points must keep their order along a
//! common curve, neighbours that the step would let pass each other move as one (a pool): the tangents of a
//! pool are eliminated together, and which points are pooled is decided anew in every step by isotonic
//! regression (pool adjacent violators, Ayer et al. 1955), see [`super::ordered`]. Inequalities enter by an augmented Lagrangian
//! (Powell 1969, Hestenes 1969, Rockafellar 1974): a row sqrt(rho) max(0, m_i - g_i) each, with m_i moved to
//! max(0, m_i - g_i) after every inner solve. Bounds are kept by an active set and projection. Damping
//! follows Nielsen (1999), *Damping parameter in Marquardt's method*.

use super::ordered::Ordered;
use nalgebra::{SMatrix, SVector};

/// A point's residual with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct PointBlock<const N: usize> {
    /// r_j.
    pub residual: [f64; 2],
    /// dr_j/dx, two rows.
    pub jacobian: [[f64; N]; 2],
    /// dr_j/dtau_j; zero where the point has no freedom of its own.
    pub tangent: [f64; 2],
    /// w_j.
    pub weight: f64,
}

/// An inequality g >= 0 with its derivative by the shared unknowns.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintRow<const N: usize> {
    /// g, in the unit of the residuals.
    pub value: f64,
    /// dg/dx.
    pub gradient: [f64; N],
}

/// A least-squares problem with a block a point.
pub trait BlockLeastSquares<const N: usize> {
    /// The points' own unknowns.
    type State: Clone;

    /// How many points.
    fn points(&self) -> usize;

    /// [low, high] of each shared unknown; equal: fixed; infinite: unbounded.
    fn bounds(&self) -> &[(f64, f64); N];

    /// sum_j w_j |r_j|^2; `None` where it does not exist.
    fn cost(&self, x: &[f64; N], state: &Self::State) -> Option<f64>;

    /// The blocks of all points in their order; `false` where a derivative does not exist.
    fn linearise(&self, x: &[f64; N], state: &Self::State, each: &mut dyn FnMut(&PointBlock<N>)) -> bool;

    /// r_j of all points in their order; `false` where one does not exist.
    fn residuals(&self, x: &[f64; N], state: &Self::State, out: &mut Vec<[f64; 2]>) -> bool {
        out.clear();
        self.linearise(x, state, &mut |block| out.push(block.residual))
    }

    /// The points' unknowns after a step `tau` from `state` at `from`, brought back to their curves at `to`;
    /// `false` where that fails.
    fn retract(
        &self,
        from: &[f64; N],
        state: &Self::State,
        tau: &[f64],
        to: &[f64; N],
        out: &mut Self::State,
    ) -> bool;

    /// The way from each point to the next along their curve, in units of the own unknowns and positive in
    /// order; the last one leads back to the first. `false`: the points need not keep an order.
    fn gaps(&self, _x: &[f64; N], _state: &Self::State, _gaps: &mut Vec<f64>) -> bool {
        false
    }

    /// Puts every point where its leader is.
    fn join(&self, _state: &mut Self::State, _leaders: &[usize]) {}

    /// Runs a loop over numbers; a problem that knows of wider vector instructions runs it with them.
    fn wide<R>(&self, work: impl FnOnce() -> R) -> R {
        work()
    }

    /// The inequalities, always as many and in the same order.
    fn constraints(&self, x: &[f64; N], state: &Self::State, each: &mut dyn FnMut(&ConstraintRow<N>));
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct LmOptions {
    /// Steps tried in one inner solve.
    pub max_steps: usize,
    /// Rounds of the multipliers.
    pub max_rounds: usize,
    /// Computations of the cost in all rounds together; at least one.
    pub max_evaluations: u64,
    /// Converged when a step promises less than this part of the cost.
    pub relative_reduction: f64,
    /// Converged when the cost is below this: an exact answer.
    pub exact_cost: f64,
    /// A constraint counts as met when g >= -this.
    pub feasibility: f64,
    /// An inner solve is given up when its cost is not below this after half the steps.
    pub hopeless_cost: f64,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LmOutcome {
    /// No step promises more.
    Converged,
    /// The cost is below `exact_cost`.
    Exact,
    /// Out of steps or evaluations.
    StepLimit,
    /// The start could not be evaluated.
    NoStart,
    /// Given up or stopped from outside.
    Abandoned,
}

/// The end of a solve.
#[derive(Clone, Debug)]
pub struct LmResult<const N: usize, S> {
    /// The shared unknowns.
    pub x: [f64; N],
    /// The points' unknowns.
    pub state: S,
    /// sum_j w_j |r_j|^2.
    pub cost: f64,
    /// The largest -g_i, or 0.
    pub violation: f64,
    /// How often the cost was computed.
    pub evaluations: u64,
    /// How it ended.
    pub outcome: LmOutcome,
}

/// A point's own step is at most this long (radians): beyond it the tangent says nothing.
const MAX_TAU: f64 = 0.6;
/// First damping, in parts of the normal matrix' diagonal.
const FIRST_DAMPING: f64 = 1e-3;
/// The part of a step at which its bend is measured.
const AHEAD: f64 = 0.1;
/// A bend of more than this part of the step (in the normal matrix' diagonal) says that neither is to be trusted.
const MOST_BENT: f64 = 0.375;
/// A step that takes off less than this part of the merit is slow.
const SLOW: f64 = 0.2;
/// Times that points which have passed each other are pooled after a step.
const MOST_REPAIRS: usize = 4;
/// Points that lie further apart than this (radians) have not just passed each other.
const JUST_PASSED: f64 = 0.05;
/// Past this damping a step is below rounding.
const LAST_DAMPING: f64 = 1e14;

struct Penalty {
    rho: f64,
    shift: Vec<f64>,
}

impl Penalty {
    /// rho max(0, m - g)^2 summed, and the largest -g.
    fn of<const N: usize, P: BlockLeastSquares<N>>(
        &self,
        problem: &P,
        x: &[f64; N],
        state: &P::State,
    ) -> f64 {
        let (mut sum, mut i) = (0.0, 0);
        problem.constraints(x, state, &mut |row| {
            let lack = self.shift[i] - row.value;
            i += 1;
            if lack > 0.0 {
                sum += self.rho * lack * lack;
            }
        });
        sum
    }
}

/// The largest -g_i, or 0 where all constraints hold.
pub fn violation<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
) -> f64 {
    let mut worst: f64 = 0.0;
    problem.constraints(x, state, &mut |row| worst = worst.max(-row.value));
    worst
}

/// Solves from a start. `stop` is asked between steps.
///
/// The start is brought into its bounds. The best point so far is always what is returned.
pub fn solve<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    start: [f64; N],
    state: P::State,
    options: &LmOptions,
    stop: &dyn Fn() -> bool,
) -> LmResult<N, P::State> {
    let mut x = start;
    for (value, &(low, high)) in x.iter_mut().zip(problem.bounds()) {
        *value = value.max(low).min(high);
    }
    let mut shift = Vec::new();
    problem.constraints(&x, &state, &mut |_| shift.push(0.0));
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
        inner(problem, &mut result, &penalty, options, stop);
        result.violation = violation(problem, &result.x, &result.state);
        if unconstrained || matches!(result.outcome, LmOutcome::NoStart | LmOutcome::Abandoned) {
            return result;
        }
        let mut i = 0;
        let mut moved: f64 = 0.0;
        problem.constraints(&result.x, &result.state, &mut |row| {
            let next = (penalty.shift[i] - row.value).max(0.0);
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

/// The first weight of a squared constraint against a squared residual, a point.
const FIRST_RHO: f64 = 1.0;
/// Its growth where a round did not bring the constraints down to a quarter.
const RHO_GROWTH: f64 = 8.0;

struct Normal<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    gradient: SVector<f64, N>,
    /// mean |t_j|^2.
    tangent_sq: f64,
}

/// What an inner solve works with, kept from step to step.
struct Workspace<const N: usize> {
    blocks: Vec<PointBlock<N>>,
    /// The constraints that lack something: (shift - g, dg/dx).
    lacking: Vec<(f64, [f64; N])>,
    /// w_j (|t_j|^2 + nu).
    stiffness: Vec<f64>,
    /// The points' own steps.
    tau: Vec<f64>,
    gaps: Vec<f64>,
    order: Ordered,
}

impl<const N: usize> Workspace<N> {
    fn new(points: usize) -> Self {
        Workspace {
            blocks: Vec::with_capacity(points),
            lacking: Vec::new(),
            stiffness: vec![0.0; points],
            tau: vec![0.0; points],
            gaps: Vec::with_capacity(points),
            order: Ordered::new(points),
        }
    }

    /// Each point's own best step for its residual as it stands.
    fn own_steps(&mut self, nu: f64) {
        for (j, block) in self.blocks.iter().enumerate() {
            let t = block.tangent;
            let t_sq = t[0] * t[0] + t[1] * t[1];
            self.stiffness[j] = block.weight * (t_sq + nu);
            self.tau[j] = if t_sq == 0.0 {
                0.0
            } else {
                -(t[0] * block.residual[0] + t[1] * block.residual[1]) / (t_sq + nu)
            };
        }
    }

    /// Each point's own step after a shared step `dx`; pooled points end in one place.
    fn own_steps_after(&mut self, dx: &[f64; N], nu: f64, ordered: bool) {
        let along = |block: &PointBlock<N>| {
            let mut moved = block.residual;
            for (value, row) in moved.iter_mut().zip(&block.jacobian) {
                let mut sum = 0.0;
                for (by, d) in row.iter().zip(dx) {
                    sum += by * d;
                }
                *value += sum;
            }
            block.tangent[0] * moved[0] + block.tangent[1] * moved[1]
        };
        for (j, block) in self.blocks.iter().enumerate() {
            let t_sq = block.tangent[0].powi(2) + block.tangent[1].powi(2);
            self.tau[j] =
                if t_sq == 0.0 { 0.0 } else { (-along(block) / (t_sq + nu)).clamp(-MAX_TAU, MAX_TAU) };
        }
        if ordered {
            self.order.pool(&self.gaps, &mut self.tau, &self.stiffness);
        }
    }

    /// The right-hand side of the acceleration: J^T of the residuals' second derivative along a step, the
    /// points' own unknowns eliminated; `bend` receives that derivative. `ahead` holds the residuals at the part
    /// [`AHEAD`] of the step.
    fn bending(
        &self,
        ahead: &[[f64; 2]],
        dx: &[f64; N],
        nu: f64,
        bend: &mut Vec<[f64; 2]>,
    ) -> SVector<f64, N> {
        let mut gradient = SVector::<f64, N>::zeros();
        bend.clear();
        for ((block, tau), r) in self.blocks.iter().zip(&self.tau).zip(ahead) {
            let t = block.tangent;
            let mut second = [0.0; 2];
            for axis in 0..2 {
                let mut slope = t[axis] * tau;
                for (by, d) in block.jacobian[axis].iter().zip(dx) {
                    slope += by * d;
                }
                second[axis] = 2.0 / AHEAD * ((r[axis] - block.residual[axis]) / AHEAD - slope);
            }
            bend.push(second);
            // What the point's own unknown does not take up.
            let t_sq = t[0] * t[0] + t[1] * t[1];
            let taken = if t_sq > 0.0 { (t[0] * second[0] + t[1] * second[1]) / (t_sq + nu) } else { 0.0 };
            for axis in 0..2 {
                let left = block.weight * (second[axis] - t[axis] * taken);
                for (sum, by) in gradient.iter_mut().zip(&block.jacobian[axis]) {
                    *sum += left * by;
                }
            }
        }
        gradient
    }

    /// Adds the bend's half to the points' own steps.
    fn bend_own_steps(&mut self, half: &[f64; N], bend: &[[f64; 2]], nu: f64) {
        for ((block, tau), second) in self.blocks.iter().zip(&mut self.tau).zip(bend) {
            let t = block.tangent;
            let t_sq = t[0] * t[0] + t[1] * t[1];
            if t_sq == 0.0 {
                continue;
            }
            let mut along = 0.0;
            for axis in 0..2 {
                let mut moved = 0.5 * second[axis];
                for (by, d) in block.jacobian[axis].iter().zip(half) {
                    moved += by * d;
                }
                along += t[axis] * moved;
            }
            *tau = (*tau - along / (t_sq + nu)).clamp(-MAX_TAU, MAX_TAU);
        }
    }

    /// What the linear model takes off the cost and the penalty.
    fn promised(&self, dx: &[f64; N], rho: f64) -> f64 {
        let mut promised = 0.0;
        for (block, tau) in self.blocks.iter().zip(&self.tau) {
            for axis in 0..2 {
                let mut change = block.tangent[axis] * tau;
                for (by, d) in block.jacobian[axis].iter().zip(dx) {
                    change += by * d;
                }
                promised -= block.weight * change * (2.0 * block.residual[axis] + change);
            }
        }
        for (lack, gradient) in &self.lacking {
            let change: f64 = gradient.iter().zip(dx).map(|(by, d)| by * d).sum();
            promised += rho * change * (2.0 * lack - change);
        }
        promised
    }
}

#[inline(always)]
fn add_row<const N: usize>(
    matrix: &mut [[f64; N]; N],
    gradient: &mut [f64; N],
    weight: f64,
    row: &[f64; N],
    residual: f64,
) {
    for i in 0..N {
        let w = weight * row[i];
        gradient[i] += w * residual;
        for k in 0..N {
            matrix[i][k] += w * row[k];
        }
    }
}

fn assemble<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    at: &LmResult<N, P::State>,
    penalty: &Penalty,
    nu: f64,
    work: &mut Workspace<N>,
) -> Option<Normal<N>> {
    work.blocks.clear();
    let complete = problem.linearise(&at.x, &at.state, &mut |block| work.blocks.push(*block));
    if !complete {
        return None;
    }
    work.gaps.clear();
    let ordered = problem.gaps(&at.x, &at.state, &mut work.gaps);
    if ordered {
        work.own_steps(nu);
        work.order.pool(&work.gaps, &mut work.tau, &work.stiffness);
    }
    let mut matrix = [[0.0; N]; N];
    let mut gradient = [0.0; N];
    let mut tangent_sum = 0.0;
    problem.wide(
        #[inline(always)]
        || {
            for (index, block) in work.blocks.iter().enumerate() {
                let t = block.tangent;
                let t_sq = t[0] * t[0] + t[1] * t[1];
                tangent_sum += t_sq;
                if ordered && !work.order.is_alone(index) {
                    continue;
                }
                let (r, j) = (&block.residual, &block.jacobian);
                if t_sq == 0.0 {
                    add_row(&mut matrix, &mut gradient, block.weight, &j[0], r[0]);
                    add_row(&mut matrix, &mut gradient, block.weight, &j[1], r[1]);
                    continue;
                }
                let length = t_sq.sqrt();
                let (along, normal) = ([t[0] / length, t[1] / length], [-t[1] / length, t[0] / length]);
                let mut row = [0.0; N];
                for (axis, weight) in [(normal, 1.0), (along, nu / (t_sq + nu))] {
                    for i in 0..N {
                        row[i] = axis[0] * j[0][i] + axis[1] * j[1][i];
                    }
                    let residual = axis[0] * r[0] + axis[1] * r[1];
                    add_row(&mut matrix, &mut gradient, block.weight * weight, &row, residual);
                }
            }
        },
    );
    if ordered {
        for pool in work.order.pools() {
            // r_j + t_j m_j + J_j dx + t_j tau with the way m_j to the common place and one tau for all.
            let mut by_tau = [0.0; N];
            let (mut along, mut stiffness) = (0.0, 0.0);
            for &(index, way) in pool {
                let block = &work.blocks[index];
                let (t, j, w) = (block.tangent, &block.jacobian, block.weight);
                let r = [block.residual[0] + t[0] * way, block.residual[1] + t[1] * way];
                add_row(&mut matrix, &mut gradient, w, &j[0], r[0]);
                add_row(&mut matrix, &mut gradient, w, &j[1], r[1]);
                for i in 0..N {
                    by_tau[i] += w * (t[0] * j[0][i] + t[1] * j[1][i]);
                }
                along += w * (t[0] * r[0] + t[1] * r[1]);
                stiffness += work.stiffness[index];
            }
            if stiffness > 0.0 {
                add_row(&mut matrix, &mut gradient, -1.0 / stiffness, &by_tau, along);
            }
        }
    }
    let mut i = 0;
    work.lacking.clear();
    problem.constraints(&at.x, &at.state, &mut |row| {
        let lack = penalty.shift[i] - row.value;
        i += 1;
        if lack > 0.0 {
            work.lacking.push((lack, row.gradient));
            add_row(&mut matrix, &mut gradient, penalty.rho, &row.gradient.map(|g| -g), lack);
        }
    });
    let usable = matrix.iter().flatten().chain(gradient.iter()).all(|v| v.is_finite());
    usable.then(|| Normal {
        matrix: SMatrix::from_fn(|i, k| matrix[i][k]),
        gradient: SVector::from(gradient),
        tangent_sq: tangent_sum / work.blocks.len().max(1) as f64,
    })
}

fn inner<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    result: &mut LmResult<N, P::State>,
    penalty: &Penalty,
    options: &LmOptions,
    stop: &dyn Fn() -> bool,
) {
    let bounds = *problem.bounds();
    let mut merit = result.cost + penalty.of(problem, &result.x, &result.state);
    let mut work = Workspace::new(problem.points());
    let mut trial_state = result.state.clone();
    let (mut damping, mut growth) = (FIRST_DAMPING, 2.0);
    let mut normal: Option<Normal<N>> = None;
    // The damping of the points' own unknowns follows the shared one: nu = damping * mean |t_j|^2.
    let (mut nu, mut tangent_sq) = (0.0, 0.0);
    let (mut quiet, mut slow) = (0, false);
    for step in 0..options.max_steps {
        if result.cost <= options.exact_cost
            && penalty.shift.iter().all(|m| *m == 0.0)
            && violation(problem, &result.x, &result.state) <= options.feasibility
        {
            result.outcome = LmOutcome::Exact;
            return;
        }
        if result.evaluations >= options.max_evaluations {
            result.outcome = LmOutcome::StepLimit;
            return;
        }
        if stop() || (step == options.max_steps / 2 && result.cost > options.hopeless_cost) {
            result.outcome = LmOutcome::Abandoned;
            return;
        }
        if normal.is_none() {
            nu = damping * tangent_sq;
            match assemble(problem, result, penalty, nu, &mut work) {
                Some(assembled) => {
                    tangent_sq = assembled.tangent_sq;
                    normal = Some(assembled);
                }
                None => {
                    // A toggle or a flat position: no derivative, no step.
                    result.outcome = LmOutcome::Converged;
                    return;
                }
            }
        }
        let Some(system) = &normal else { return };
        let Some(dx) = bounded_step(system, &result.x, &bounds, damping) else {
            damping *= growth;
            growth *= 2.0;
            if damping > LAST_DAMPING {
                result.outcome = LmOutcome::Converged;
                return;
            }
            continue;
        };
        let mut trial = result.x;
        for i in 0..N {
            trial[i] = (result.x[i] + dx[i]).max(bounds[i].0).min(bounds[i].1);
        }
        let shared = dx.into();
        work.own_steps_after(&shared, nu, !work.gaps.is_empty());
        let promised = work.promised(&shared, penalty.rho);
        let evaluate = |work: &Workspace<N>, trial: &[f64; N], state: &mut P::State| {
            if !problem.retract(&result.x, &result.state, &work.tau, trial, state) {
                return None;
            }
            if !work.gaps.is_empty() {
                problem.join(state, work.order.leaders());
                if !put_in_order(problem, trial, state, &work.stiffness) {
                    return None;
                }
            }
            problem.cost(trial, state).map(|cost| (cost, cost + penalty.of(problem, trial, state)))
        };
        let mut trial_merit = None;
        let mut evaluations = 0;
        // Three evaluations at most: the bend, the bent step and the straight one.
        if slow && !work.order.any() && result.evaluations + 3 <= options.max_evaluations {
            evaluations += 1;
            if let Some(bent) = bend(problem, result, system, &dx, (damping, nu), &mut work, &mut trial_state)
            {
                evaluations += 1;
                trial_merit = evaluate(&work, &bent, &mut trial_state).filter(|(_, new)| *new < merit);
                if trial_merit.is_some() {
                    trial = bent;
                } else {
                    work.own_steps_after(&shared, nu, !work.gaps.is_empty());
                }
            }
        }
        if trial_merit.is_none() {
            evaluations += 1;
            trial_merit = evaluate(&work, &trial, &mut trial_state);
        }
        result.evaluations += evaluations;
        match trial_merit {
            Some((cost, new_merit)) if new_merit < merit => {
                let gain = (merit - new_merit) / promised.max(f64::MIN_POSITIVE);
                let reduction = merit - new_merit;
                result.x = trial;
                std::mem::swap(&mut result.state, &mut trial_state);
                result.cost = cost;
                slow = reduction < SLOW * merit;
                merit = new_merit;
                damping *= (1.0 - (2.0 * gain - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
                damping = damping.max(1e-15);
                growth = 2.0;
                normal = None;
                quiet = if reduction <= options.relative_reduction * merit { quiet + 1 } else { 0 };
                if quiet >= QUIET_STEPS {
                    result.outcome = LmOutcome::Converged;
                    return;
                }
            }
            _ => {
                if promised <= options.relative_reduction * 1e-3 * merit {
                    result.outcome = LmOutcome::Converged;
                    return;
                }
                damping *= growth;
                growth *= 2.0;
                if damping > LAST_DAMPING {
                    result.outcome = LmOutcome::Converged;
                    return;
                }
                // The elimination depends on nu: assemble again where points have unknowns of their own.
                if system.tangent_sq > 0.0 {
                    normal = None;
                }
            }
        }
    }
    result.outcome = LmOutcome::StepLimit;
}

/// Pools what a step has let pass each other after all, because the way back to the curves is not straight.
fn put_in_order<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    x: &[f64; N],
    state: &mut P::State,
    stiffness: &[f64],
) -> bool {
    let mut gaps = Vec::with_capacity(stiffness.len());
    for _ in 0..MOST_REPAIRS {
        gaps.clear();
        if !problem.gaps(x, state, &mut gaps) {
            return true;
        }
        // Only points that are near each other have just passed: over longer ways a gap is a rough measure.
        gaps.iter_mut().filter(|gap| **gap < -JUST_PASSED).for_each(|gap| *gap = 0.0);
        if gaps.iter().all(|gap| *gap >= 0.0) {
            return true;
        }
        let mut order = Ordered::new(gaps.len());
        let mut tau = vec![0.0; gaps.len()];
        order.pool(&gaps, &mut tau, stiffness);
        let before = state.clone();
        if !problem.retract(x, &before, &tau, x, state) {
            return false;
        }
        problem.join(state, order.leaders());
    }
    true
}

/// A step bent by half its geodesic acceleration, in its bounds, the points' own steps with it; `None` where the
/// bend cannot be measured or is too large.
fn bend<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    at: &LmResult<N, P::State>,
    system: &Normal<N>,
    dx: &SVector<f64, N>,
    (damping, nu): (f64, f64),
    work: &mut Workspace<N>,
    scratch: &mut P::State,
) -> Option<[f64; N]> {
    let shared: [f64; N] = (*dx).into();
    let ahead: [f64; N] = std::array::from_fn(|i| at.x[i] + AHEAD * shared[i]);
    let own: Vec<f64> = work.tau.iter().map(|tau| AHEAD * tau).collect();
    if !problem.retract(&at.x, &at.state, &own, &ahead, scratch) {
        return None;
    }
    let (mut residuals, mut second) = (Vec::with_capacity(own.len()), Vec::with_capacity(own.len()));
    if !problem.residuals(&ahead, scratch, &mut residuals) {
        return None;
    }
    let gradient = work.bending(&residuals, &shared, nu, &mut second);
    let after: [f64; N] = std::array::from_fn(|i| at.x[i] + shared[i]);
    let bent = Normal { matrix: system.matrix, gradient, tangent_sq: system.tangent_sq };
    let half = 0.5 * bounded_step(&bent, &after, problem.bounds(), damping)?;
    let length = |v: &SVector<f64, N>| (0..N).map(|i| system.matrix[(i, i)] * v[i] * v[i]).sum::<f64>();
    if length(&half).is_nan() || length(&half) > MOST_BENT * MOST_BENT * length(dx) {
        return None;
    }
    work.bend_own_steps(&half.into(), &second, nu);
    let bounds = problem.bounds();
    Some(std::array::from_fn(|i| (after[i] + half[i]).max(bounds[i].0).min(bounds[i].1)))
}

/// The damped step inside the bounds: what a step would push through a bound is put onto it and the rest is
/// solved again, so that the step is the model's minimum on the face that it ends on. `None` where the damped
/// matrix is not positive definite.
fn bounded_step<const N: usize>(
    system: &Normal<N>,
    x: &[f64; N],
    bounds: &[(f64, f64); N],
    damping: f64,
) -> Option<SVector<f64, N>> {
    let mut damped = system.matrix;
    let diagonal_max = (0..N).map(|i| damped[(i, i)]).fold(f64::MIN_POSITIVE, f64::max);
    let mut held = [false; N];
    let mut dx = SVector::<f64, N>::zeros();
    for i in 0..N {
        let (low, high) = bounds[i];
        held[i] = low == high
            || damped[(i, i)] == 0.0
            || (x[i] <= low && system.gradient[i] >= 0.0)
            || (x[i] >= high && system.gradient[i] <= 0.0);
        damped[(i, i)] += damping * damped[(i, i)].max(1e-10 * diagonal_max);
    }
    for _ in 0..=N {
        let mut matrix = damped;
        let mut right =
            -(system.gradient + damped * SVector::from_fn(|i, _| if held[i] { dx[i] } else { 0.0 }));
        for i in (0..N).filter(|&i| held[i]) {
            for k in 0..N {
                matrix[(i, k)] = 0.0;
                matrix[(k, i)] = 0.0;
            }
            matrix[(i, i)] = 1.0;
            right[i] = dx[i];
        }
        dx = matrix.cholesky()?.solve(&right);
        let mut crossed = false;
        for i in 0..N {
            if held[i] {
                continue;
            }
            let (low, high) = bounds[i];
            let to = x[i] + dx[i];
            if to < low || to > high {
                dx[i] = if to < low { low - x[i] } else { high - x[i] };
                held[i] = true;
                crossed = true;
            }
        }
        if !crossed {
            break;
        }
    }
    Some(dx)
}

/// Steps in a row that hardly reduce before a solve counts as converged.
const QUIET_STEPS: usize = 3;

/// Blocks and constraint rows of a problem at a point.
fn linearised<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
) -> Option<(Vec<PointBlock<N>>, Vec<ConstraintRow<N>>)> {
    let (mut blocks, mut rows) = (Vec::new(), Vec::new());
    if !problem.linearise(x, state, &mut |block| blocks.push(*block)) {
        return None;
    }
    problem.constraints(x, state, &mut |row| rows.push(*row));
    Some((blocks, rows))
}

/// How far the derivatives of a problem are from central differences: the largest |analytic - difference| /
/// (1 + |analytic|) over all residuals (by x and along the tangents) and constraints (by x).
///
/// `steps` gives the difference's step for each shared unknown, 0 leaves it out; `along` is the step of the
/// points' own unknowns. `None` where a neighbour cannot be evaluated. A right derivative leaves what the
/// differences themselves have: the square of the step times the third derivative, and rounding over the step.
pub fn derivative_error<const N: usize, P: BlockLeastSquares<N>>(
    problem: &P,
    x: &[f64; N],
    state: &P::State,
    steps: &[f64; N],
    along: f64,
) -> Option<f64> {
    let (blocks, rows) = linearised(problem, x, state)?;
    let mut worst: f64 = 0.0;
    let mut compare = |analytic: f64, difference: f64| {
        worst = worst.max((analytic - difference).abs() / (1.0 + analytic.abs()));
    };
    let still = vec![0.0; problem.points()];
    let at = |to: &[f64; N], tau: &[f64]| {
        let mut moved = state.clone();
        problem.retract(x, state, tau, to, &mut moved).then(|| linearised(problem, to, &moved)).flatten()
    };
    for i in (0..N).filter(|&i| steps[i] != 0.0) {
        let (mut up, mut down) = (*x, *x);
        up[i] += steps[i];
        down[i] -= steps[i];
        let (above, below) = (at(&up, &still)?, at(&down, &still)?);
        for (block, (u, d)) in blocks.iter().zip(above.0.iter().zip(&below.0)) {
            for axis in 0..2 {
                compare(block.jacobian[axis][i], (u.residual[axis] - d.residual[axis]) / (2.0 * steps[i]));
            }
        }
        for (row, (u, d)) in rows.iter().zip(above.1.iter().zip(&below.1)) {
            compare(row.gradient[i], (u.value - d.value) / (2.0 * steps[i]));
        }
    }
    let moves = blocks.iter().any(|block| block.tangent != [0.0, 0.0]);
    if moves {
        let (forward, backward) = (vec![along; problem.points()], vec![-along; problem.points()]);
        let (above, below) = (at(x, &forward)?, at(x, &backward)?);
        for (block, (u, d)) in blocks.iter().zip(above.0.iter().zip(&below.0)) {
            for axis in 0..2 {
                compare(block.tangent[axis], (u.residual[axis] - d.residual[axis]) / (2.0 * along));
            }
        }
    }
    Some(worst)
}
