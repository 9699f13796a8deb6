//! The errors of a function's output by a linkage with a slider: of a slider's place, or of the angle of the block.
//!
//! With the crank along e and the coupler along u in one assembly, the measure m of the output link is
//!
//! ```text
//! place of a slider-crank's slider     m = <a e + b u, s>
//! place of an inverted one's block     m = <B - A - a e, u>
//! angle of the block                   m = arg u, from the ground line arg u - arg(B - A)
//! ```
//!
//! and the error of a target W (k o_j - m - beta)/k, with the frame beta an unknown or 0, and the scale k of the outputs 1 or, where
//! their range is free, an unknown too. As u follows from the unknowns, dm/dx_k =
//! m_k - m_u G_k/G_w and dm/dphi = m_phi - m_u G_phi/G_w.

use super::fit::{SliderFit, add_turn};
use super::shape::{Closure, FRAME, Miss, SHAPE, SliderShape, UNKNOWNS, Unknowns};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, cross, dot, turned, xy};
use crate::numbers::optimise::levenberg_marquardt::PointBlock;
use crate::task::forms::torus::Positions;
use crate::task::{Output, Problem};

/// The outputs of a function, as a fit sees them.
#[derive(Clone, Debug)]
pub struct Outputs {
    /// The quantity that is wanted.
    pub kind: Output,
    /// Each in the sense of +1: an angle in radians, or a place in sizes of the target.
    pub wanted: Vec<f64>,
    /// W: degrees in a radian, or 1 of places.
    pub weight: f64,
    /// Whether angles count from the ground line.
    pub from_ground: bool,
}

/// The measure of the output link with its derivatives at held positions.
#[derive(Clone, Copy, Debug)]
struct Measure {
    value: f64,
    by_crank: f64,
    by_coupler: f64,
    by_shape: [f64; SHAPE],
}

impl Outputs {
    /// Returns the outputs of a function; `None` of another task.
    pub fn of(problem: &Problem) -> Option<Outputs> {
        let task = problem.task();
        let body = task.body().filter(|_| task.is_function())?;
        let given = || body.angles.iter().map(|angle| angle.unwrap_or(0.0));
        let (kind, wanted, weight) = match body.is_of_places() {
            true => {
                (Output::Place, given().map(|angle| angle * body.angle_weight / task.size()).collect(), 1.0)
            }
            false => (Output::Angle, given().collect(), body.angle_weight),
        };
        Some(Outputs { kind, wanted, weight, from_ground: body.given_frame(0.0).is_some() })
    }

    /// Returns the unit of a squared error: the objective is this many times the cost of a fit.
    pub fn unit(&self, size: f64) -> f64 {
        match self.kind {
            Output::Angle => 1.0,
            Output::Place => size * size,
        }
    }

    /// Returns a difference of two measures: of angles within half a turn.
    pub fn apart(&self, difference: f64) -> f64 {
        match self.kind {
            Output::Angle => wrapped(difference),
            Output::Place => difference,
        }
    }

    /// Computes the measure of a shape at a position.
    pub fn measured(&self, shape: &SliderShape, position: [Complex; 2]) -> f64 {
        self.measure(shape, position).value
    }

    fn measure(&self, shape: &SliderShape, [e, u]: [Complex; 2]) -> Measure {
        let a = shape.crank;
        match (self.kind, shape.closure) {
            (Output::Place, Closure::Line { coupler: b, direction: s, .. }) => {
                let reach = e * a + u * b;
                Measure {
                    value: dot(reach, s),
                    by_crank: a * dot(turned(e), s),
                    by_coupler: b * dot(turned(u), s),
                    by_shape: [0.0, 0.0, dot(e, s), dot(u, s), 0.0, cross(s, reach), 0.0, 0.0],
                }
            }
            (Output::Place, Closure::Block { pivot, .. }) => {
                let v = pivot - shape.crank_pivot - e * a;
                Measure {
                    value: dot(v, u),
                    by_crank: -a * dot(turned(e), u),
                    by_coupler: dot(v, turned(u)),
                    by_shape: [-u.re, -u.im, -dot(e, u), u.re, u.im, 0.0, 0.0, 0.0],
                }
            }
            (Output::Angle, closure) => {
                let (mut value, mut by_shape) = (u.arg(), [0.0; SHAPE]);
                if let (true, Closure::Block { pivot, .. }) = (self.from_ground, closure) {
                    let ground = pivot - shape.crank_pivot;
                    let [x, y] = xy(turned(ground) / ground.norm_sqr());
                    value -= ground.arg();
                    for (i, by) in [(0, x), (1, y), (3, -x), (4, -y)] {
                        by_shape[i] = by;
                    }
                }
                Measure { value, by_crank: 0.0, by_coupler: 1.0, by_shape }
            }
        }
    }

    /// Returns W (k o - m - beta)/k of a target.
    fn residual(&self, (j, sign): (usize, f64), measured: f64, (frame, k): (f64, f64)) -> f64 {
        self.weight * self.apart(sign * k * self.wanted[j] - measured - frame) / k
    }
}

impl<const R: usize> SliderFit<'_, R> {
    /// As `BlockLeastSquares::cost`, of a function.
    pub(super) fn cost_of_outputs(
        &self,
        outputs: &Outputs,
        (x, state): (&Unknowns, &Positions),
        shape: &SliderShape,
        k: f64,
    ) -> Option<f64> {
        let positions = self.prescribed(x, shape, state)?;
        let each = positions.iter().zip(self.weights).enumerate();
        let cost: f64 = each
            .map(|(j, (position, weight))| {
                let measured = outputs.measured(shape, *position);
                weight * outputs.residual((j, self.sign), measured, (x[FRAME], k)).powi(2)
            })
            .sum();
        cost.is_finite().then_some(cost)
    }

    /// As `BlockLeastSquares::linearise`, of a function.
    pub(super) fn linearise_outputs(
        &self,
        outputs: &Outputs,
        (x, state): (&Unknowns, &Positions),
        (shape, k): (&SliderShape, f64),
        each: &mut dyn FnMut(&PointBlock<UNKNOWNS, R>),
    ) -> bool {
        let Some(positions) = self.prescribed(x, shape, state) else { return false };
        let length = outputs.weight / k;
        for (j, (position, weight)) in positions.iter().zip(self.weights).enumerate() {
            let Miss { by_crank, by_coupler, by_shape, .. } = shape.miss(*position);
            if by_coupler == 0.0 {
                return false;
            }
            let measure = outputs.measure(shape, *position);
            let back = measure.by_coupler / by_coupler;
            let mut block = PointBlock {
                residual: [0.0; R],
                jacobian: [[0.0; UNKNOWNS]; R],
                tangent: [0.0; R],
                weight: *weight,
            };
            block.residual[0] = outputs.residual((j, self.sign), measure.value, (x[FRAME], k));
            let row = &mut block.jacobian[0];
            for (out, (direct, miss)) in row.iter_mut().zip(measure.by_shape.into_iter().zip(by_shape)) {
                *out = length * (back * miss - direct);
            }
            row[FRAME] = -length;
            let by_turn = length * (back * by_crank - measure.by_crank);
            if self.own.has(j) {
                block.tangent[0] = by_turn;
            } else {
                add_turn(row, by_turn, shape, self.offset());
            }
            each(&block);
        }
        true
    }
}
