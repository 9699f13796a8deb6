//! Costs of the active requirements: Lagrange multipliers at a candidate, as rates of the error per unit of a limit.
//!
//! At an optimum of f(x) = sum_j w_j |r_j|^2 under g_i(x) >= 0 (Karush 1939, Kuhn and Tucker 1951)
//!
//! ```text
//! grad f = sum_i m_i grad g_i,   m_i >= 0,   m_i = 0 where g_i > 0
//! df*/dL = -sum_i m_i dg_i/dL                                      for a limit L that g_i depends on
//! ```
//!
//! with grad f = 2 sum_j w_j J_j^T r_j, the points' own unknowns eliminated. Bounds of single unknowns are rows like
//! the others. The multipliers come from non-negative least squares on the active rows (the active set); if they do not
//! explain the gradient, or not uniquely, no rate is given. Errors are sqrt(f / sum_j w_j), so that d(rms) = df / (2 W
//! rms).

use super::loosen::design_limits;
use super::rank::exact_objective;
use super::warm::start_at;
use crate::numbers::optimise::levenberg_marquardt::BlockLeastSquares;
use crate::numbers::optimise::nonnegative::nonnegative_least_squares;
use crate::record::{Candidate, Cost, LimitUnit};
use crate::task::Problem;
use crate::task::forms::design_space::{DESIGN, Derived, DesignSpace, Shape};
use crate::task::forms::fits::{FitUser, Kept, on_fit, own_frame};
use crate::task::forms::rows::{Motion, RowKind, Side};
use crate::task::forms::start::Start;
use crate::task::forms::timed::TimedPathFit;
use crate::task::forms::torus::{PathFit, Positions};
use crate::task::requirement::RequirementKind;
use crate::task::spec::Objective;

/// Distance from a row's limit, in parts of the target's size, within which the row is active.
const ACTIVE: f64 = 1e-6;
/// Relative distance within which a bound is active: bounds are met to rounding.
const ON_BOUND: f64 = 1e-9;
/// A multiplier counts as known if the unexplained part of the gradient can move it by this part at most.
const UNEXPLAINED: f64 = 0.02;
/// A rate below this part of the error for a unit as large as the limit itself (or the target) is negligible.
const NEGLIGIBLE: f64 = 1e-6;
/// Change of a row with the crank angle, in target sizes per radian, above which it depends on the points' places on
/// the curve. Free timing leaves those angles to each point, and the rates are not given.
const MOVED_BY_POINTS: f64 = 1e-3;

/// An active row of the optimality conditions: its gradient by the scaled unknowns and the limit that it belongs to.
struct Active {
    gradient: Vec<f64>,
    moved_by_points: bool,
    /// The limit; `None` for a bound that the user has not set.
    label: Option<Label>,
}

#[derive(Clone, Debug, PartialEq)]
struct Label {
    name: String,
    side: Option<&'static str>,
    limit: f64,
    unit: LimitUnit,
    /// The change dg of the row for one unit more of room.
    by_room: f64,
    /// The scale of a change of the limit.
    scale: f64,
}

/// Returns the root of the weighted mean squared error: the rms if no point has a weight.
pub fn weighted_rms(problem: &Problem, objective: f64) -> f64 {
    (objective / problem.task().weights().iter().sum::<f64>()).sqrt()
}

/// Returns the costs of the limits that are active at a candidate, in a fixed order; without [`Cost::rms_without`].
///
/// Empty if no limit is active, or the candidate is not accepted, is exact, or is not an optimum that the limits
/// explain; and if no advice is asked for.
pub fn marginal(problem: &Problem, candidate: &Candidate) -> Vec<Cost> {
    if !candidate.accepted
        || !problem.spec().solve.advice
        || problem.spec().solve.objective != Objective::SumOfSquares
        || candidate.error.objective <= exact_objective(problem)
    {
        return Vec::new();
    }
    let Some(start) = start_at(problem, candidate) else { return Vec::new() };
    let space = problem.space(start.setting.side);
    let Some(shape) = space.shape(&start.design) else { return Vec::new() };
    let at = At { problem, candidate, start: &start, space: &space, shape: &shape };
    let (setting, positions) = (start.setting, &start.positions);
    let motion = if positions.is_empty() {
        let Some(fit) = TimedPathFit::new(problem, setting) else { return Vec::new() };
        fit.motion(&start.design, &shape, start.scales[0])
    } else {
        PathFit::new(problem, setting).motion(&shape, positions)
    };
    on_fit(problem, &start, Kept::Nothing, Pricing { at: &at, motion: &motion }).unwrap_or_default()
}

/// Computes the costs of the active limits at a candidate over a motion.
struct Pricing<'a> {
    at: &'a At<'a>,
    motion: &'a Motion<'a>,
}

impl FitUser for Pricing<'_> {
    type Output = Vec<Cost>;

    fn on<const N: usize, const R: usize, F>(self, fit: &F, x: [f64; N]) -> Vec<Cost>
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        self.at.costs(fit, &x, &self.at.start.positions, self.motion)
    }
}

/// A candidate with its place in the design space.
struct At<'a> {
    problem: &'a Problem,
    candidate: &'a Candidate,
    start: &'a Start,
    space: &'a DesignSpace,
    shape: &'a Shape,
}

impl At<'_> {
    /// Returns the costs at unknowns x of a fit, of which the first are the design; any others are at their best, and no limit
    /// depends on them.
    fn costs<const N: usize, const R: usize, F: BlockLeastSquares<N, R>>(
        &self,
        fit: &F,
        x: &[f64; N],
        state: &F::State,
        motion: &Motion<'_>,
    ) -> Vec<Cost> {
        let size = self.problem.task().size();
        let space = self.space;
        let free_timing = !self.start.positions.is_empty();
        let mut kinds = Vec::new();
        let own = self.problem.frame_is_free().then(|| space.offset(&self.start.design));
        let frame = own.or(own_frame(x));
        let requirements = self.problem.requirements(space);
        requirements.rows(self.start.setting.aim, self.shape, motion, frame, &mut |row| {
            kinds.push((row.kind, free_timing && row.by_turn().abs() > MOVED_BY_POINTS * size));
        });
        // Unknowns that can move, lengths in sizes of the target.
        let unknowns: Vec<(usize, f64)> = (0..DESIGN)
            .filter(|&i| space.bounds()[i].0 < space.bounds()[i].1 || space.is_held(i))
            .map(|i| (i, if space.coordinate(i).is_none_or(|(_, is_angle)| is_angle) { 1.0 } else { size }))
            .collect();
        let scaled = |row: &[f64; N]| unknowns.iter().map(|&(i, by)| by * row[i]).collect::<Vec<f64>>();
        let mut active = Vec::new();
        let mut place = 0;
        fit.constraints(x, state, &mut |value, row| {
            let (kind, moved_by_points) = kinds[place];
            place += 1;
            if value <= ACTIVE * size {
                let gradient = scaled(&row().gradient);
                active.push(Active { gradient, moved_by_points, label: self.label(kind) });
            }
        });
        self.bounds(&unknowns, &mut active);
        if active.is_empty() {
            return Vec::new();
        }
        let mut gradient = [0.0; N];
        let complete = fit.linearise(x, state, &mut |block| {
            let (t, r) = (&block.tangent, &block.residual);
            let t_sq: f64 = t.iter().map(|t| t * t).sum();
            let along = t.iter().zip(r).map(|(t, r)| t * r).sum::<f64>();
            let along = if t_sq > 0.0 { along / t_sq } else { 0.0 };
            for (axis, j) in block.jacobian.iter().enumerate() {
                let normal = r[axis] - along * t[axis];
                for (sum, by) in gradient.iter_mut().zip(j) {
                    *sum += 2.0 * block.weight * normal * by;
                }
            }
        });
        if !complete {
            return Vec::new();
        }
        self.priced(&active, &scaled(&gradient))
    }

    /// Adds the active bounds of the design. Those that come from the box of the pivots are rows already.
    fn bounds(&self, unknowns: &[(usize, f64)], active: &mut Vec<Active>) {
        for (place, &(i, by)) in unknowns.iter().enumerate() {
            let Some((name, is_angle)) = self.space.coordinate(i) else { continue };
            if self.space.is_held(i) {
                // The line of the pivot is a row already.
                continue;
            }
            let (low, high) = self.space.bounds()[i];
            let row = format!("design.{name}");
            let given = design_limits(&self.problem.spec().design, &row);
            let unit = if is_angle { 1f64.to_radians() } else { 1.0 };
            let sides = [(low, given.map(|g| g.0), 1.0, "min"), (high, given.map(|g| g.1), -1.0, "max")];
            for (bound, given, sign, side) in sides {
                if (self.start.design[i] - bound).abs() > ON_BOUND * by.max(bound.abs()) {
                    continue;
                }
                let set = given.filter(|limit| (limit * unit - bound).abs() <= 1e-12 * bound.abs());
                let is_pivot = matches!(name, "Ax" | "Ay" | "Bx" | "By");
                if is_pivot && set.is_none() && self.problem.spec().require.pivots_in.is_some() {
                    continue;
                }
                let mut gradient = vec![0.0; unknowns.len()];
                gradient[place] = sign * by;
                let label = set.map(|limit| self.design_label(&row, side, limit, unit));
                active.push(Active { gradient, moved_by_points: false, label });
            }
        }
    }

    fn design_label(&self, name: &str, side: &'static str, limit: f64, by_room: f64) -> Label {
        let is_angle = name == "design.ground_angle_deg" || name == "design.line_deg";
        Label {
            name: name.to_owned(),
            side: Some(side),
            limit,
            unit: if is_angle { LimitUnit::Degree } else { LimitUnit::Length },
            by_room,
            scale: if is_angle { 90.0 } else { self.problem.task().size() },
        }
    }

    fn label(&self, kind: RowKind) -> Option<Label> {
        let (spec, size) = (self.problem.spec(), self.problem.task().size());
        match kind {
            RowKind::Limit { of, side, by_room } => {
                // If no type is asked for, the crank has to turn fully to come back to the first point.
                let turns_fully = of == RequirementKind::Type && spec.require.types.is_empty();
                let name = if turns_fully { RequirementKind::Closing } else { of }.name();
                let limits = (of.definition().limits)(spec).unwrap_or_default();
                let limit = limits.get(side.map_or(0, Side::index)).map_or(0.0, |limit| limit.value);
                let unit = of.definition().unit;
                let scale = match unit {
                    LimitUnit::Length => size,
                    LimitUnit::Degree => 90.0,
                    LimitUnit::Ratio | LimitUnit::Torque => limit,
                };
                Some(Label { name: name.into(), side: side.map(Side::name), limit, unit, by_room, scale })
            }
            RowKind::Derived(quantity, lower) => {
                let (name, by_room) = match quantity {
                    Derived::Ground => ("design.ground", 1.0),
                    Derived::GroundAngle => ("design.ground_angle_deg", size * 1f64.to_radians()),
                    Derived::CrankSide => ("design.d", 1.0),
                    Derived::FollowerSide => ("design.e", 1.0),
                };
                let limits = design_limits(&spec.design, name).filter(|limits| !limits.is_fixed())?;
                let (side, limit) = if lower { ("min", limits.0) } else { ("max", limits.1) };
                Some(self.design_label(name, side, limit, by_room))
            }
        }
    }

    fn priced(&self, active: &[Active], gradient: &[f64]) -> Vec<Cost> {
        let lengths: Vec<f64> =
            active.iter().map(|a| a.gradient.iter().map(|g| g * g).sum::<f64>().sqrt()).collect();
        let unit = |i: usize| -> Vec<f64> {
            let length = if lengths[i] > 0.0 { lengths[i] } else { 1.0 };
            active[i].gradient.iter().map(|g| g / length).collect()
        };
        let columns: Vec<Vec<f64>> = (0..active.len()).map(unit).collect();
        let found = nonnegative_least_squares(&columns, gradient);
        let told = !active.iter().zip(&found.values).any(|(a, m)| a.moved_by_points && *m > 0.0);
        let size: f64 = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        let whole: f64 = self.problem.task().weights().iter().sum();
        let rms = weighted_rms(self.problem, self.candidate.error.objective);
        let mut labels: Vec<&Label> = Vec::new();
        for label in active.iter().filter_map(|a| a.label.as_ref()) {
            if !labels.iter().any(|l| l.name == label.name && l.side == label.side) {
                labels.push(label);
            }
        }
        let mut costs = Vec::new();
        for label in labels {
            let own =
                |a: &Active| a.label.as_ref().is_some_and(|l| l.name == label.name && l.side == label.side);
            let (mut rate, mut known) = (0.0, true);
            for ((a, m), length) in active.iter().zip(&found.values).zip(&lengths) {
                let Some(l) = a.label.as_ref().filter(|_| own(a) && *m > 0.0) else { continue };
                rate -= m / length * l.by_room / (2.0 * whole * rms);
                known &= found.residual * found.sensitivity <= UNEXPLAINED * m;
            }
            if -rate * label.scale <= NEGLIGIBLE * rms {
                continue;
            }
            // If the others explain the optimum without it, another limit restricts in the same way: moving this one
            // alone gains nothing.
            let others = active.iter().zip(&columns).filter(|(a, _)| !own(a));
            let others: Vec<Vec<f64>> = others.map(|(_, column)| column.clone()).collect();
            let without = || nonnegative_least_squares(&others, gradient).residual;
            let explained =
                !found.sensitivity.is_finite() || without() <= 10.0 * found.residual + 1e-9 * size;
            if explained || told && !known {
                continue;
            }
            costs.push(Cost {
                name: label.name.clone(),
                side: label.side.map(str::to_owned),
                limit: label.limit,
                rms_per_unit: told.then_some(rate),
                unit_of_limit: label.unit,
                rms_without: None,
            });
        }
        costs
    }
}
