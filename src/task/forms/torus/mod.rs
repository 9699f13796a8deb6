//! Free timing as a least-squares problem: the design vector and, for each point, a position of the linkage of its own.
//!
//! A position is a pair of unit vectors (e_j, u_j), crank and coupler, on the curve |Y_j| = c with Y_j = A + a e_j + b
//! u_j - B. It contains no assembly sign and is not singular at a toggle, so every type and both branches are treated
//! alike. With c_phi = <Y, i a e>, c_w = <Y, i b u>, n2 = c_phi^2 + c_w^2:
//!
//! ```text
//! P   = A + a e + Z u
//! t   = (i a e c_w - i u Z c_phi) / sqrt(n2)                      dP along the position's own curve
//! dP/dx_k = direct_k + (i a e c_phi + i u Z c_w)/n2 h_k           the least-norm return to the curve
//! h   = c dc - <Y, dA - dB + e da + u db>
//! ```
//!
//! In a motion a target has a third row: the error of the body's angle times the length W that a radian counts like,
//!
//! ```text
//! W (theta_j - arg u_j - beta),     d(arg u) = -c_phi/sqrt(n2) along the curve,  c_w/n2 h_k by the shape
//! ```
//!
//! with the frame beta, the angle from the coupler's direction to the body's x axis, as the last unknown of the design.
//! It is zero for a target without an angle.
//!
//! The tangents are eliminated point by point in [`crate::numbers::optimise::levenberg_marquardt`].

mod blocks;
mod order;

use super::design_space::{DESIGN, Design, DesignSpace, SHAPE, Shape};
use super::rows::{Motion, Place, Requirements, Row, assembly_of};
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::mobility::{linkage_type, ways_round, wrapped};
use crate::mechanism::{AssemblyMode, Complex, LinkageType, cross, dot, turned, xy};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::defect::ORDER_TOLERANCE;
use crate::task::{Body, Problem, Setting};
use blocks::Loop;
pub(in crate::task::forms) use blocks::{Blocks, Curve, RETURN_STEPS};
pub(in crate::task::forms) use order::{gaps_along, joined};
use std::f64::consts::TAU;

/// The positions of all points: (e_j, u_j).
pub type Positions = Vec<[Complex; 2]>;

/// The row of the body's angle among those of a target.
pub(in crate::task::forms) const ANGLE_ROW: usize = 2;

/// Least squares over the design vector and the points' positions, with R rows a target: 2 of a path, 3 of a motion.
#[derive(Clone, Debug)]
pub struct TorusFit<'a, const R: usize> {
    problem: &'a Problem,
    setting: Setting,
    space: DesignSpace,
    requirements: Requirements,
    /// The sense along the curves in which the points follow each other; 0: no order is kept.
    sense: f64,
    /// The assembly in which all points are held; `None`: any.
    assembly: Option<AssemblyMode>,
}

/// The fit of a path: two rows a target.
pub type PathFit<'a> = TorusFit<'a, 2>;
/// The fit of a motion: three rows a target.
pub type MotionFit<'a> = TorusFit<'a, 3>;

impl<'a, const R: usize> TorusFit<'a, R> {
    /// Creates the fit of a problem in a setting, without an order of the points; see [`TorusFit::in_order`].
    pub fn new(problem: &'a Problem, setting: Setting) -> Self {
        let space = problem.space(setting.side);
        let requirements = problem.requirements(&space);
        TorusFit { problem, setting, space, requirements, sense: 0.0, assembly: None }
    }

    /// Returns the same fit with the points held in their present order around the curve, if the problem requires an
    /// order.
    ///
    /// Along the curve of positions the tangent (c_w, -c_phi) never turns back; the points follow it or run against it,
    /// whichever is shorter in total.
    #[must_use]
    pub fn in_order(mut self, x: &Design, positions: &Positions) -> Self {
        if !self.problem.order_required() {
            return self;
        }
        let Some(shape) = self.space.shape(x) else { return self };
        self.sense = orientation(&shape, positions);
        self
    }

    /// Returns the same fit with the points held in the assembly in which they all are, if the problem requires one branch.
    ///
    /// With v = B - C the distance of B from the line C D, on the side on which it is, stays positive:
    ///
    /// ```text
    /// t1 <i u, -v> = t1 (v x u) = c sin mu >= 0
    /// ```
    #[must_use]
    pub fn on_its_branch(mut self, x: &Design, positions: &Positions) -> Self {
        if self.problem.branch_any() {
            return self;
        }
        let Some(shape) = self.space.shape(x) else { return self };
        let mut assemblies = positions.iter().map(|[e, u]| assembly_of(&shape, *e, *u));
        let first = assemblies.next();
        self.assembly = first.filter(|first| assemblies.all(|other| other == *first));
        self
    }

    /// Creates the fit of the positions alone: the design stays at `x`.
    pub fn at(problem: &'a Problem, setting: Setting, x: &Design) -> Self {
        let mut fit = TorusFit::new(problem, setting);
        fit.space.fix(x);
        fit
    }

    /// Returns the sense in which the points' own unknowns grow.
    fn forward(&self) -> f64 {
        if self.sense < 0.0 { -1.0 } else { 1.0 }
    }

    /// Returns the design space.
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// Returns the requirements.
    pub fn requirements(&self) -> &Requirements {
        &self.requirements
    }

    /// Returns the motion through the positions: an interval of crank angles if the input turns fully, or rocks on one
    /// branch. If no requirement depends on the motion, it is not computed.
    pub fn motion<'p>(&self, shape: &Shape, positions: &'p Positions) -> Motion<'p> {
        self.motion_between(shape, positions).0
    }

    /// As [`TorusFit::motion`], with the indices of the points at which the interval begins and ends; `None` for a full
    /// turn, which has no ends.
    fn motion_between<'p>(
        &self,
        shape: &Shape,
        positions: &'p Positions,
    ) -> (Motion<'p>, Option<[usize; 2]>) {
        let as_listed = (Motion::Positions(positions), None);
        if !self.requirements.depend_on_motion() {
            return as_listed;
        }
        let Some([e, u]) = positions.first() else { return as_listed };
        let assembly = assembly_of(shape, *e, *u);
        if !linkage_type(shape.links()).is_some_and(LinkageType::input_turns_fully) {
            return rocking(shape, positions, assembly).unwrap_or(as_listed);
        }
        let task = self.problem.task();
        let whole = (Motion::Stretch(e.arg(), e.arg() + TAU, assembly), None);
        if task.closed() || task.repeats_first() {
            return whole;
        }
        // Points that share a place make no step, and rounding must not turn that into a full turn.
        let steps = positions.windows(2).map(|w| (w[1][0] * w[0][0].conj()).arg());
        let [forward, backward] = ways_round(steps, ORDER_TOLERANCE);
        let last = positions.len() - 1;
        if forward.min(backward) >= TAU {
            whole
        } else if forward <= backward {
            (Motion::Stretch(e.arg(), e.arg() + forward, assembly), Some([0, last]))
        } else {
            (Motion::Stretch(e.arg() - backward, e.arg(), assembly), Some([last, 0]))
        }
    }

    /// Brings positions to the curves of a design; `false` if one cannot get there.
    pub fn settle(&self, x: &Design, positions: &mut Positions) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        let on = Loop::of(&shape);
        computed(RETURN_STEPS * positions.len());
        let mut blocks = Blocks::gather(positions);
        let settled = vectorised(
            #[inline(always)]
            || blocks.settle(&on),
        );
        blocks.scatter(positions);
        settled
    }
}

/// Returns the interval of crank angles of a rocking crank through positions on one branch, with the indices of the
/// points at its two ends; `None` if the positions lie on both branches.
fn rocking<'p>(
    shape: &Shape,
    positions: &[[Complex; 2]],
    assembly: AssemblyMode,
) -> Option<(Motion<'p>, Option<[usize; 2]>)> {
    let (first, rest) = positions.split_first()?;
    if rest.iter().any(|[e, u]| assembly_of(shape, *e, *u) != assembly) {
        return None;
    }
    let (begin, [low, high]) = (first[0].arg(), turned_range(positions));
    Some((Motion::Stretch(begin + low.0, begin + high.0, assembly), Some([low.1, high.1])))
}

/// Returns the least and the greatest angle by which the crank has turned from the first position, going through all of them,
/// each with the position there.
pub(in crate::task::forms) fn turned_range(positions: &[[Complex; 2]]) -> [(f64, usize); 2] {
    let (mut low, mut high, mut turned_by) = ((0.0, 0), (0.0, 0), 0.0);
    for (j, pair) in positions.windows(2).enumerate() {
        turned_by += (pair[1][0] * pair[0][0].conj()).arg();
        if turned_by < low.0 {
            low = (turned_by, j + 1);
        }
        if turned_by > high.0 {
            high = (turned_by, j + 1);
        }
    }
    [low, high]
}

/// Returns the curve's frame at a position: Y, c_phi, c_w.
fn frame(shape: &Shape, [e, u]: [Complex; 2]) -> (Complex, f64, f64) {
    let y = shape.crank_pivot + e * shape.crank + u * shape.coupler - shape.follower_pivot;
    (y, dot(y, turned(e)) * shape.crank, dot(y, turned(u)) * shape.coupler)
}

/// Returns h, the derivatives of (c^2 - |Y|^2)/2 by the shape at a position: what the return to its curve makes up for.
fn misses(shape: &Shape, y: Complex, [e, u]: [Complex; 2]) -> [f64; SHAPE] {
    [-y.re, -y.im, y.re, y.im, -dot(y, e), -dot(y, u), shape.follower, 0.0, 0.0]
}

/// Returns the position with the same crank angle in the other assembly: D is mirrored in the line B C,
///
/// ```text
/// w = B - C,   u' = (w/|w|)^2 conj(u)
/// ```
///
/// The position itself if C lies on B.
pub fn mirrored(shape: &Shape, [e, u]: [Complex; 2]) -> [Complex; 2] {
    let diagonal = shape.follower_pivot - shape.crank_pivot - e * shape.crank;
    let square = diagonal.norm_sqr();
    [e, if square > 0.0 { diagonal * diagonal / square * u.conj() } else { u }]
}

/// Returns the unit tangent (dphi, domega) of the curve at a position.
fn tangent_of(shape: &Shape, position: [Complex; 2]) -> Option<[f64; 2]> {
    let (_, by_e, by_u) = frame(shape, position);
    let length = (by_e * by_e + by_u * by_u).sqrt();
    (length > 0.0).then(|| [by_u / length, -by_e / length])
}

/// Returns +1 if the points run along the tangents of their curve, -1 if against; 0 if that is undecided.
///
/// The circuit is parametrised by the crank angle if the crank turns fully (the assembly is the same at all points),
/// and else by psi with phi = middle + half width sin psi; of both ways around the shorter is taken. The tangent's
/// crank part has one sign on each assembly, so that a single point determines the direction of the parameter along it.
fn orientation(shape: &Shape, positions: &Positions) -> f64 {
    let Some(first) = positions.first() else { return 0.0 };
    let assembly = assembly_of(shape, first[0], first[1]);
    let Ok(linkage) = shape.linkage(assembly) else { return 0.0 };
    let mobility = linkage.mobility();
    let arc = mobility.arc(mobility.branch(first[0].arg(), assembly).circuit);
    let parameter = |[e, u]: &[Complex; 2]| match arc {
        None => e.arg(),
        Some(arc) => arc.parameter(e.arg(), assembly_of(shape, *e, *u)),
    };
    let steps = positions.windows(2).map(|w| parameter(&w[1]) - parameter(&w[0]));
    let [forward, backward] = ways_round(steps, 0.0);
    let runs = if backward < forward { -1.0 } else { 1.0 };
    // dphi/dparameter has the sign of t1 if the crank rocks; the tangent's crank part is c_w.
    let (_, _, by_u) = frame(shape, *first);
    let crank_rises = if arc.is_some() { assembly.sign() } else { 1.0 };
    if by_u == 0.0 { 0.0 } else { runs * crank_rises * by_u.signum() }
}

/// The distance of B from the line C D that is aimed at where points are held in one assembly, in parts of the target's
/// size.
const BRANCH_MARGIN: f64 = 1e-9;

impl<const R: usize> TorusFit<'_, R> {
    /// Returns the row that holds a point in an assembly, with its derivatives.
    fn side_of_toggle(
        &self,
        value: f64,
        assembly: AssemblyMode,
        x: &Design,
        shape: &Shape,
        (j, position): (usize, [Complex; 2]),
    ) -> ConstraintRow<DESIGN> {
        let [e, u] = position;
        let sign = assembly.sign();
        let to_pivot = shape.follower_pivot - shape.crank_pivot - e * shape.crank;
        let mut by_shape = [0.0; SHAPE];
        by_shape[..5].copy_from_slice(&[-u.im, u.re, u.im, -u.re, -cross(e, u)].map(|d| sign * d));
        let by_turns = [-cross(turned(e), u) * shape.crank, dot(to_pivot, u)].map(|d| sign * d);
        let (y, by_e, by_u) = frame(shape, position);
        let n2 = by_e * by_e + by_u * by_u;
        let mut own = [None; MOST_OWN];
        if n2 > 0.0 {
            let by_return = (by_turns[0] * by_e + by_turns[1] * by_u) / n2;
            for (out, miss) in by_shape.iter_mut().zip(misses(shape, y, position)) {
                *out += by_return * miss;
            }
            let by_step = (by_turns[0] * by_u - by_turns[1] * by_e) / n2.sqrt();
            own[0] = Some((j, self.forward() * by_step));
        }
        ConstraintRow { value, gradient: self.space.chain_rule(x, shape).by_design(&by_shape, 0.0), own }
    }

    /// Returns the derivatives of a position's crank angle: by the shape, with the least-norm return to its curve, and
    /// by its own step. Zero if the curve has no tangent.
    fn crank_of(&self, shape: &Shape, position: [Complex; 2]) -> ([f64; SHAPE], f64) {
        let (y, by_e, by_u) = frame(shape, position);
        let n2 = by_e * by_e + by_u * by_u;
        if n2 == 0.0 {
            return ([0.0; SHAPE], 0.0);
        }
        (misses(shape, y, position).map(|h| h * by_e / n2), self.forward() * by_u / n2.sqrt())
    }

    /// Returns the row of a requirement with its derivatives by the design and by the points' own steps; `ends` are the
    /// points at which the motion begins and ends.
    fn constraint(
        &self,
        row: &Row,
        x: &Design,
        shape: &Shape,
        state: &Positions,
        ends: Option<[usize; 2]>,
    ) -> ConstraintRow<DESIGN> {
        let (mut by_shape, mut own) = (row.shape, [None; MOST_OWN]);
        for (turn, own) in row.turns.iter().zip(&mut own) {
            let point = match turn.place {
                Place::Anywhere => None,
                Place::First => ends.map(|[first, _]| first),
                Place::Last => ends.map(|[_, last]| last),
                Place::Position(j) => Some(j),
            };
            if let Some(j) = point {
                // The crank angle is the point's: it moves with the return to the curve and with the point's step.
                let (by_return, by_step) = self.crank_of(shape, state[j]);
                for (out, by) in by_shape.iter_mut().zip(by_return) {
                    *out += turn.by * by;
                }
                *own = Some((j, turn.by * by_step));
            }
        }
        ConstraintRow {
            value: row.value,
            gradient: self.space.chain_rule(x, shape).by_design(&by_shape, row.by_frame),
            own,
        }
    }
}

/// Returns W (theta - arg u - beta) of a target, the angle within half a turn; zero if it has no angle.
pub(super) fn angle_residual(body: &Body, j: usize, coupler: Complex, frame: f64) -> f64 {
    body.angles[j].map_or(0.0, |angle| body.angle_weight * wrapped(angle - coupler.arg() - frame))
}

impl<const R: usize> BlockLeastSquares<DESIGN, R> for TorusFit<'_, R> {
    type State = Positions;

    fn points(&self) -> usize {
        self.problem.task().len()
    }

    fn bounds(&self) -> &[(f64, f64); DESIGN] {
        self.space.bounds()
    }

    fn cost(&self, x: &Design, state: &Positions) -> Option<f64> {
        let shape = self.space.shape(x)?;
        let task = self.problem.task();
        computed(task.len());
        let mut cost = 0.0;
        for (([e, u], target), weight) in state.iter().zip(task.points()).zip(task.weights()) {
            let p = shape.crank_pivot + e * shape.crank + u * shape.offset;
            cost += weight * (target - p).norm_sqr();
        }
        if R == ANGLE_ROW + 1
            && let Some(body) = task.body()
        {
            let frame = self.space.offset(x);
            for (j, ([_, u], weight)) in state.iter().zip(task.weights()).enumerate() {
                cost += weight * angle_residual(body, j, *u, frame).powi(2);
            }
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &Design, state: &Positions, each: &mut dyn FnMut(&PointBlock<DESIGN, R>)) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        let (task, rule) = (self.problem.task(), self.space.chain_rule(x, &shape));
        computed(task.len());
        let body = task.body().filter(|_| R == ANGLE_ROW + 1);
        for (j, ((position, target), weight)) in
            state.iter().zip(task.points()).zip(task.weights()).enumerate()
        {
            let [e, u] = *position;
            let (y, by_e, by_u) = frame(&shape, *position);
            let n2 = by_e * by_e + by_u * by_u;
            if n2 == 0.0 {
                return false;
            }
            let (crank_turn, coupler_turn) = (turned(e) * shape.crank, turned(u) * shape.offset);
            let tangent = (crank_turn * by_u - coupler_turn * by_e) / n2.sqrt();
            let back = (crank_turn * by_e + coupler_turn * by_u) / n2;
            let one = Complex::new(1.0, 0.0);
            let i = Complex::new(0.0, 1.0);
            let columns: [Complex; SHAPE] = [
                one - back * y.re,
                i - back * y.im,
                back * y.re,
                back * y.im,
                e - back * dot(y, e),
                -back * dot(y, u),
                back * shape.follower,
                u,
                turned(u),
            ];
            let p = shape.crank_pivot + e * shape.crank + u * shape.offset;
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; DESIGN]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            block.residual[..2].copy_from_slice(&xy(target - p));
            block.tangent[..2].copy_from_slice(&xy(tangent * -self.forward()));
            let rows = [columns.map(|z| -z.re), columns.map(|z| -z.im)];
            for (out, row) in block.jacobian.iter_mut().zip(rows) {
                *out = rule.by_design(&row, 0.0);
            }
            if let Some(body) = body.filter(|body| body.angles[j].is_some()) {
                let weight = body.angle_weight;
                block.residual[ANGLE_ROW] = angle_residual(body, j, u, self.space.offset(x));
                block.jacobian[ANGLE_ROW] =
                    rule.by_design(&misses(&shape, y, *position).map(|h| -weight * h * by_u / n2), -weight);
                block.tangent[ANGLE_ROW] = self.forward() * weight * by_e / n2.sqrt();
            }
            each(&block);
        }
        true
    }

    fn residuals(&self, x: &Design, state: &Positions, out: &mut Vec<[f64; R]>) -> bool {
        let Some(shape) = self.space.shape(x) else { return false };
        let task = self.problem.task();
        let body = task.body().filter(|_| R == ANGLE_ROW + 1);
        out.clear();
        out.extend(state.iter().zip(task.points()).enumerate().map(|(j, ([e, u], target))| {
            let mut residual = [0.0; R];
            let p = shape.crank_pivot + e * shape.crank + u * shape.offset;
            residual[..2].copy_from_slice(&xy(target - p));
            if let Some(body) = body {
                residual[ANGLE_ROW] = angle_residual(body, j, *u, self.space.offset(x));
            }
            residual
        }));
        true
    }

    fn retract(
        &self,
        from: &Design,
        state: &Positions,
        tau: &[f64],
        to: &Design,
        out: &mut Positions,
    ) -> bool {
        let (Some(old), Some(new)) = (self.space.shape(from), self.space.shape(to)) else { return false };
        let (from, to) = (Loop::of(&old), Loop::of(&new));
        let forward = self.forward();
        computed(RETURN_STEPS * state.len());
        let mut blocks = Blocks::gather(state);
        let settled = vectorised(
            #[inline(always)]
            || {
                blocks.step(&from, forward, tau);
                blocks.settle(&to)
            },
        );
        blocks.scatter(out);
        // A point of a path that has stepped over a toggle, or to the other circuit, comes back at the same crank angle.
        if let Some(assembly) = self.assembly.filter(|_| R == 2) {
            for position in out.iter_mut().filter(|[e, u]| assembly_of(&new, *e, *u) != assembly) {
                *position = mirrored(&new, *position);
            }
        }
        settled
    }

    fn wide<T>(&self, work: impl FnOnce() -> T) -> T {
        vectorised(work)
    }

    fn gaps(&self, x: &Design, state: &Positions, gaps: &mut Vec<f64>) -> bool {
        if self.sense == 0.0 {
            return false;
        }
        let Some(shape) = self.space.shape(x) else { return false };
        let tangent = |position| tangent_of(&shape, position);
        gaps_along(state, tangent, self.sense, self.problem.task().repeats_first(), gaps)
    }

    fn join(&self, state: &mut Positions, leaders: &[usize]) {
        joined(state, leaders);
    }

    fn constraints(&self, x: &Design, state: &Positions, each: &mut EachConstraint<'_, DESIGN>) {
        let Some(shape) = self.space.shape(x) else { return };
        let (motion, ends) = self.motion_between(&shape, state);
        let frame = self.problem.frame_is_free().then(|| self.space.offset(x));
        self.requirements.rows(self.setting.aim, &shape, &motion, frame, &mut |row| {
            each(row.value, &|| self.constraint(row, x, &shape, state, ends));
        });
        if let Some(assembly) = self.assembly {
            let margin = BRANCH_MARGIN * self.problem.task().size();
            for (j, [e, u]) in state.iter().enumerate() {
                let to_pivot = shape.follower_pivot - shape.crank_pivot - e * shape.crank;
                let value = assembly.sign() * cross(to_pivot, *u) - margin;
                each(value, &|| self.side_of_toggle(value, assembly, x, &shape, (j, state[j])));
            }
        }
    }
}
