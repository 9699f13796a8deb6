//! The fit of a linkage with a slider to the points of a path, or to the places and angles of a motion.
//!
//! *Free timing.* A position is a pair of unit vectors (e_j, u_j), crank and coupler, on the curve G(e, u) = 0 of the
//! closure; as with four-bars ([`crate::task::forms::torus`]), with G_phi, G_w its derivatives by both angles and
//! n2 = G_phi^2 + G_w^2:
//!
//! ```text
//! P   = A + a e + Z u
//! t   = (i a e G_w - i Z u G_phi) / sqrt(n2)                      dP along the position's own curve
//! dP/dx_k = direct_k - (i a e G_phi + i Z u G_w)/n2 G_k           the least-norm return to the curve
//! ```
//!
//! *Prescribed timing.* e_j is given up to an offset; u_j follows in closed form in one assembly:
//!
//! ```text
//! dP/dx_k = direct_k - i Z u G_k/G_w,     dP/dphi = i a e - i Z u G_phi/G_w
//! ```
//!
//! *Partly prescribed timing.* A target that has a crank angle of its own has it as its own unknown, with u_j in closed form too:
//! the tangent is dP/dphi above.
//!
//! In a motion a target has a third row, W (theta_j - arg u_j - beta): the error of the body's angle times the length W that a
//! radian counts like, with the frame beta as an unknown. It is zero for a target without an angle. With the turn of u:
//!
//! ```text
//! free         d(arg u) = -G_phi/sqrt(n2) along the curve,  -G_w/n2 G_k by the unknowns
//! prescribed   d(arg u) = -G_k/G_w by the unknowns,  -G_phi/G_w by the crank's angle
//! ```

use super::curve::{Steps, carry};
use super::limits::Limited;
use super::output::Outputs;
use super::shape::{Closure, FRAME, Miss, OFFSET, SHAPE, SliderShape, UNKNOWNS, Unknowns};
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::mobility::{ways_round, wrapped};
use crate::mechanism::{AssemblyMode, Complex, LinkageKind, turned, xy};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::AngleOffset;
use crate::task::forms::torus::{ANGLE_ROW, Positions, gaps_along, joined};

/// The crank angles of a fit.
#[derive(Clone, Debug)]
pub enum Angles {
    /// Each point has its own.
    Free,
    /// Given from the x axis, from the ground, or up to an offset, with the assembly of all positions.
    Prescribed(Vec<Complex>, AngleOffset, AssemblyMode),
}

/// The targets of prescribed timing that have a crank angle of their own instead of the prescribed one.
#[derive(Clone, Copy, Debug)]
pub enum OwnAngles<'a> {
    /// None of them.
    None,
    /// Those that are true.
    Of(&'a [bool]),
    /// All of them.
    All,
}

impl OwnAngles<'_> {
    pub(super) fn has(self, j: usize) -> bool {
        match self {
            OwnAngles::None => false,
            OwnAngles::Of(own) => own[j],
            OwnAngles::All => true,
        }
    }
}

/// The angles of a motion's body at its targets.
#[derive(Clone, Debug)]
pub struct BodyAngles {
    /// The angle at each target, in radians; `None`: only the place counts there.
    pub angles: Vec<Option<f64>>,
    /// W, the length that an error of one radian counts like.
    pub weight: f64,
}

impl BodyAngles {
    /// Returns the residual W (theta - arg u - beta) at a target, the angle within half a turn; zero if it has no angle.
    fn residual(&self, j: usize, u: Complex, frame: f64) -> f64 {
        self.angles[j].map_or(0.0, |angle| self.weight * wrapped(angle - u.arg() - frame))
    }
}

/// A path, a motion or a function and the limits of a kind of linkage, in units of the target's size around its centre; R rows
/// a target, 2 of a path, 3 of a motion and 1 of a function.
#[derive(Clone, Debug)]
pub struct SliderFit<'a, const R: usize> {
    /// The kind.
    pub kind: LinkageKind,
    /// The points; none of a function.
    pub points: &'a [Complex],
    /// Their weights.
    pub weights: &'a [f64],
    /// The angles of a motion's body.
    pub body: Option<&'a BodyAngles>,
    /// The outputs of a function.
    pub outputs: Option<&'a Outputs>,
    /// The sign in which a function's outputs count.
    pub sign: f64,
    /// The crank angles.
    pub angles: Angles,
    /// The targets that have their own crank angles among prescribed ones.
    pub own: OwnAngles<'a>,
    /// The limits.
    pub limits: &'a Limited,
    /// The sense along the curves in which the points follow each other; 0: no order is kept.
    pub sense: f64,
    /// Whether the last point must not pass the first one from behind.
    pub ends_meet: bool,
}

impl<const R: usize> SliderFit<'_, R> {
    /// Returns the positions at the prescribed crank angles, or at a target's own one in `state`; `None` if the loop is open at
    /// one.
    pub fn prescribed(&self, x: &Unknowns, shape: &SliderShape, state: &Positions) -> Option<Positions> {
        let Angles::Prescribed(phases, offset, assembly) = &self.angles else { return None };
        let turn = Complex::from_polar(1.0, base_angle(x, shape, *offset));
        let position = |(j, phase): (usize, &Complex)| {
            let e = if self.own.has(j) { state.get(j)?[0] } else { phase * turn };
            Some([e, shape.coupler_direction(e, assembly.sign())?])
        };
        phases.iter().enumerate().map(position).collect()
    }

    /// Returns the same fit with the points held in their present order around the curve.
    #[must_use]
    pub fn in_order(mut self, x: &Unknowns, positions: &Positions) -> Self {
        self.sense = SliderShape::of(self.kind, x).map_or(0.0, |shape| orientation(&shape, positions));
        self
    }

    /// Turns the cranks of the targets that have their own angles by `tau`; `false` if the loop is open there.
    fn turned(
        &self,
        sign: f64,
        (state, tau): (&Positions, &[f64]),
        to: &Unknowns,
        out: &mut Positions,
    ) -> bool {
        let Some(shape) = SliderShape::of(self.kind, to) else { return false };
        out.clone_from(state);
        for (j, ([e, u], tau)) in out.iter_mut().zip(tau).enumerate() {
            if !self.own.has(j) {
                continue;
            }
            *e *= Complex::from_polar(1.0, *tau);
            *e /= e.norm();
            let Some(direction) = shape.coupler_direction(*e, sign) else { return false };
            *u = direction;
        }
        true
    }

    fn forward(&self) -> f64 {
        if self.sense < 0.0 { -1.0 } else { 1.0 }
    }

    /// Returns the reference of prescribed crank angles.
    pub(super) fn offset(&self) -> AngleOffset {
        match &self.angles {
            Angles::Free => AngleOffset::Free,
            Angles::Prescribed(_, offset, _) => *offset,
        }
    }

    fn is_free(&self) -> bool {
        matches!(self.angles, Angles::Free)
    }

    /// Returns the row of a limit with its derivatives.
    fn row(
        &self,
        limit: &super::limits::Bar,
        shape: &SliderShape,
        state: &Positions,
    ) -> ConstraintRow<UNKNOWNS> {
        let mut gradient = [0.0; UNKNOWNS];
        gradient[..SHAPE].copy_from_slice(&limit.by_shape);
        gradient[FRAME] = limit.by_frame;
        let mut own = [None; MOST_OWN];
        for (own, at) in own.iter_mut().zip(limit.at) {
            let Some((j, [by_crank, by_coupler])) = at else { continue };
            let miss = shape.miss(state[j]);
            let n2 = miss.by_crank * miss.by_crank + miss.by_coupler * miss.by_coupler;
            match &self.angles {
                Angles::Free if n2 > 0.0 => {
                    let back = (by_crank * miss.by_crank + by_coupler * miss.by_coupler) / n2;
                    for (out, by) in gradient.iter_mut().zip(miss.by_shape) {
                        *out -= back * by;
                    }
                    let along = by_crank * miss.by_coupler - by_coupler * miss.by_crank;
                    *own = Some((j, self.forward() * along / n2.sqrt()));
                }
                Angles::Prescribed(_, offset, _) if miss.by_coupler != 0.0 => {
                    let back = by_coupler / miss.by_coupler;
                    for (out, by) in gradient.iter_mut().zip(miss.by_shape) {
                        *out -= back * by;
                    }
                    let by_turn = by_crank - back * miss.by_crank;
                    if self.own.has(j) {
                        *own = Some((j, by_turn));
                    } else {
                        add_turn(&mut gradient, by_turn, shape, *offset);
                    }
                }
                Angles::Free | Angles::Prescribed(..) => {}
            }
        }
        ConstraintRow { value: limit.value, gradient, own }
    }
}

/// Brings positions to the curves of a linkage; `false` if one does not get there.
pub fn settle(shape: &SliderShape, positions: &mut Positions) -> bool {
    carry(None, shape, positions)
}

/// Returns the angle that prescribed increments are added to.
pub fn base_angle(x: &Unknowns, shape: &SliderShape, offset: AngleOffset) -> f64 {
    match (offset, shape.closure) {
        (AngleOffset::Free, _) => x[OFFSET],
        (AngleOffset::Fixed, _) => 0.0,
        (AngleOffset::Ground, Closure::Line { direction, .. }) => direction.arg(),
        (AngleOffset::Ground, Closure::Block { pivot, .. }) => (pivot - shape.crank_pivot).arg(),
    }
}

/// Adds the derivatives of something that changes by `by` with the crank's angle.
pub(super) fn add_turn(gradient: &mut [f64; UNKNOWNS], by: f64, shape: &SliderShape, offset: AngleOffset) {
    match (offset, shape.closure) {
        (AngleOffset::Free, _) => gradient[OFFSET] += by,
        (AngleOffset::Fixed, _) => {}
        (AngleOffset::Ground, Closure::Line { .. }) => gradient[5] += by,
        (AngleOffset::Ground, Closure::Block { pivot, .. }) => {
            let ground = pivot - shape.crank_pivot;
            let [x, y] = xy(turned(ground) / ground.norm_sqr());
            for (i, part) in [(0, -x), (1, -y), (3, x), (4, y)] {
                gradient[i] += by * part;
            }
        }
    }
}

/// Returns +1 if the points run along the tangents of their curve, -1 if against; 0 if that is undecided. As with four-bars.
fn orientation(shape: &SliderShape, positions: &Positions) -> f64 {
    let Some(first) = positions.first() else { return 0.0 };
    let assembly = shape.assembly_of(*first);
    let Ok(linkage) = shape.linkage(assembly) else { return 0.0 };
    let mobility = linkage.mobility();
    // The linkage's own t1 is that of the first position.
    let sign = |p: &[Complex; 2]| {
        if shape.assembly_of(*p) == assembly { AssemblyMode::Plus } else { AssemblyMode::Minus }
    };
    let arc = mobility.arc(mobility.branch(first[0].arg(), AssemblyMode::Plus).circuit);
    let parameter = |p: &[Complex; 2]| arc.map_or(p[0].arg(), |arc| arc.parameter(p[0].arg(), sign(p)));
    let steps = positions.windows(2).map(|w| parameter(&w[1]) - parameter(&w[0]));
    let [forward, backward] = ways_round(steps, 0.0);
    let runs = if backward < forward { -1.0 } else { 1.0 };
    let by_coupler = shape.miss(*first).by_coupler;
    if by_coupler == 0.0 { 0.0 } else { runs * by_coupler.signum() }
}

/// Returns the unit tangent (dphi, domega) of the curve at a position.
fn tangent_of(miss: &Miss) -> Option<[f64; 2]> {
    let length = (miss.by_crank * miss.by_crank + miss.by_coupler * miss.by_coupler).sqrt();
    (length > 0.0).then(|| [miss.by_coupler / length, -miss.by_crank / length])
}

impl<const R: usize> BlockLeastSquares<UNKNOWNS, R> for SliderFit<'_, R> {
    /// The positions; of prescribed crank angles they follow from the unknowns, and only the cranks of targets that have their own
    /// angles are read.
    type State = Positions;

    fn points(&self) -> usize {
        self.weights.len()
    }

    fn bounds(&self) -> &[(f64, f64); UNKNOWNS] {
        &self.limits.bounds
    }

    fn cost(&self, x: &Unknowns, state: &Positions) -> Option<f64> {
        let shape = SliderShape::of(self.kind, x)?;
        computed(self.weights.len());
        if let Some(outputs) = self.outputs {
            return self.cost_of_outputs(outputs, (x, state), &shape, 1.0);
        }
        let given = if self.is_free() { None } else { Some(self.prescribed(x, &shape, state)?) };
        let state = given.as_ref().unwrap_or(state);
        let each = state.iter().zip(self.points).zip(self.weights);
        let mut cost: f64 =
            each.map(|((at, target), weight)| weight * (target - shape.coupler_point(*at)).norm_sqr()).sum();
        if let Some(body) = self.body {
            for (j, ([_, u], weight)) in state.iter().zip(self.weights).enumerate() {
                cost += weight * body.residual(j, *u, x[FRAME]).powi(2);
            }
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(
        &self,
        x: &Unknowns,
        state: &Positions,
        each: &mut dyn FnMut(&PointBlock<UNKNOWNS, R>),
    ) -> bool {
        let Some(shape) = SliderShape::of(self.kind, x) else { return false };
        computed(self.weights.len());
        if let Some(outputs) = self.outputs {
            return self.linearise_outputs(outputs, (x, state), (&shape, 1.0), each);
        }
        let given = match &self.angles {
            Angles::Free => None,
            Angles::Prescribed(..) => match self.prescribed(x, &shape, state) {
                Some(given) => Some(given),
                None => return false,
            },
        };
        let state = given.as_ref().unwrap_or(state);
        let zero = Complex::new(0.0, 0.0);
        for (j, ((position, target), weight)) in state.iter().zip(self.points).zip(self.weights).enumerate() {
            let [e, u] = *position;
            let miss = shape.miss(*position);
            let (crank_turn, coupler_turn) = (turned(e) * shape.crank, turned(u) * shape.offset);
            let direct = [Complex::new(1.0, 0.0), Complex::i(), e, zero, zero, zero, u, turned(u)];
            // What a change of the miss does to P and to the coupler's angle.
            let (back, turn_back, tangent, turn_along) = match &self.angles {
                Angles::Free => {
                    let n2 = miss.by_crank * miss.by_crank + miss.by_coupler * miss.by_coupler;
                    if n2 == 0.0 {
                        return false;
                    }
                    let back = (crank_turn * miss.by_crank + coupler_turn * miss.by_coupler) / n2;
                    let along = crank_turn * miss.by_coupler - coupler_turn * miss.by_crank;
                    let forward = self.forward() / n2.sqrt();
                    (back, miss.by_coupler / n2, along * -forward, miss.by_crank * forward)
                }
                Angles::Prescribed(..) => {
                    if miss.by_coupler == 0.0 {
                        return false;
                    }
                    let (back, turn_back) = (coupler_turn / miss.by_coupler, 1.0 / miss.by_coupler);
                    match self.own.has(j) {
                        true => {
                            (back, turn_back, back * miss.by_crank - crank_turn, turn_back * miss.by_crank)
                        }
                        false => (back, turn_back, zero, 0.0),
                    }
                }
            };
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; UNKNOWNS]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            let jacobian = &mut block.jacobian;
            for (k, (direct, by)) in direct.into_iter().zip(miss.by_shape).enumerate() {
                let column = back * by - direct;
                (jacobian[0][k], jacobian[1][k]) = (column.re, column.im);
            }
            let common = match &self.angles {
                Angles::Prescribed(_, offset, _) if !self.own.has(j) => Some(*offset),
                Angles::Prescribed(..) | Angles::Free => None,
            };
            if let Some(offset) = common {
                let by_turn = back * miss.by_crank - crank_turn;
                add_turn(&mut jacobian[0], by_turn.re, &shape, offset);
                add_turn(&mut jacobian[1], by_turn.im, &shape, offset);
            }
            block.residual[..2].copy_from_slice(&xy(target - shape.coupler_point(*position)));
            block.tangent[..2].copy_from_slice(&xy(tangent));
            if let Some(body) = self.body.filter(|body| body.angles[j].is_some()) {
                let length = body.weight;
                block.residual[ANGLE_ROW] = body.residual(j, u, x[FRAME]);
                block.tangent[ANGLE_ROW] = length * turn_along;
                let row = &mut block.jacobian[ANGLE_ROW];
                for (out, by) in row.iter_mut().zip(miss.by_shape) {
                    *out = length * turn_back * by;
                }
                row[FRAME] = -length;
                if let Some(offset) = common {
                    add_turn(row, length * turn_back * miss.by_crank, &shape, offset);
                }
            }
            each(&block);
        }
        true
    }

    fn retract(
        &self,
        from: &Unknowns,
        state: &Positions,
        tau: &[f64],
        to: &Unknowns,
        out: &mut Positions,
    ) -> bool {
        if let Angles::Prescribed(_, _, assembly) = &self.angles {
            return matches!(self.own, OwnAngles::None)
                || self.turned(assembly.sign(), (state, tau), to, out);
        }
        let shapes = (SliderShape::of(self.kind, from), SliderShape::of(self.kind, to));
        let (Some(from), Some(to)) = shapes else { return false };
        out.clone_from(state);
        carry(Some(&Steps { on: &from, forward: self.forward(), tau }), &to, out)
    }

    fn wide<T>(&self, work: impl FnOnce() -> T) -> T {
        vectorised(work)
    }

    fn gaps(&self, x: &Unknowns, state: &Positions, gaps: &mut Vec<f64>) -> bool {
        if self.sense == 0.0 || !self.is_free() {
            return false;
        }
        let Some(shape) = SliderShape::of(self.kind, x) else { return false };
        let tangent = |position| tangent_of(&shape.miss(position));
        gaps_along(state, tangent, self.sense, self.ends_meet, gaps)
    }

    fn join(&self, state: &mut Positions, leaders: &[usize]) {
        joined(state, leaders);
    }

    fn constraints(&self, x: &Unknowns, state: &Positions, each: &mut EachConstraint<'_, UNKNOWNS>) {
        let Some(shape) = SliderShape::of(self.kind, x) else { return };
        let given = if self.is_free() { None } else { self.prescribed(x, &shape, state) };
        let at = given.as_ref().unwrap_or(state);
        self.limits.each(&shape, x[FRAME], at, self.weights.len(), &mut |bar| {
            each(bar.value, &|| self.row(&bar, &shape, at));
        });
    }
}
