//! Positions of linkages with a slider on their curves, eight at a time, as those of four-bars.

use super::shape::{Closure, SliderShape};
use crate::mechanism::effort::computed;
use crate::mechanism::{Complex, cross};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, Lane};
use crate::task::forms::torus::{Blocks, Curve, Positions, RETURN_STEPS};

/// Tolerance for a position on its curve: its miss over the largest length.
const ON_CURVE: f64 = 1e-14;

/// The closure of a slider-crank, G = Im((A + a e + b u) conj s) - q.
struct Line {
    crank: f64,
    coupler: f64,
    direction: Complex,
    /// Im(A conj s) - q.
    constant: f64,
    near: f64,
}

/// The closure of an inverted slider-crank, G = Im((B - A - a e) conj u) - h.
struct Block {
    crank: f64,
    /// B - A.
    ground: Complex,
    offset: f64,
    near: f64,
}

impl Curve for Line {
    #[inline(always)]
    fn frame(&self, [ex, ey, ux, uy]: [F64x8; 4]) -> (F64x8, F64x8, F64x8) {
        let all = F64x8::splat;
        let (re, im) = (all(self.direction.re), all(self.direction.im));
        let (crank, coupler) = (all(self.crank), all(self.coupler));
        let (across_e, across_u) = (ey * re - ex * im, uy * re - ux * im);
        let (along_e, along_u) = (ex * re + ey * im, ux * re + uy * im);
        let value = all(self.constant) + crank * across_e + coupler * across_u;
        (value, crank * along_e, coupler * along_u)
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        self.near
    }
}

impl Curve for Block {
    #[inline(always)]
    fn frame(&self, [ex, ey, ux, uy]: [F64x8; 4]) -> (F64x8, F64x8, F64x8) {
        let all = F64x8::splat;
        let crank = all(self.crank);
        let (vx, vy) = (all(self.ground.re) - crank * ex, all(self.ground.im) - crank * ey);
        let value = vy * ux - vx * uy - all(self.offset);
        (value, -crank * (ex * ux + ey * uy), -(vx * ux + vy * uy))
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        self.near
    }
}

impl Line {
    fn of(shape: &SliderShape) -> Option<Line> {
        let Closure::Line { coupler, height, direction } = shape.closure else { return None };
        Some(Line {
            crank: shape.crank,
            coupler,
            direction,
            constant: cross(direction, shape.crank_pivot) - height,
            near: ON_CURVE * shape.largest(),
        })
    }
}

impl Block {
    fn of(shape: &SliderShape) -> Option<Block> {
        let Closure::Block { pivot, offset } = shape.closure else { return None };
        let ground = pivot - shape.crank_pivot;
        Some(Block { crank: shape.crank, ground, offset, near: ON_CURVE * shape.largest() })
    }
}

/// Steps along a curve: how far each position moves, and the shape that it moves on.
pub(super) struct Steps<'a> {
    pub(super) on: &'a SliderShape,
    /// The sense along the curves that counts as ahead.
    pub(super) forward: f64,
    pub(super) tau: &'a [f64],
}

/// Brings positions to the curves of a shape, after steps along those of another one of its kind if there are any; `false` if
/// one does not get there.
pub(super) fn carry(steps: Option<&Steps<'_>>, to: &SliderShape, positions: &mut Positions) -> bool {
    computed(RETURN_STEPS * positions.len());
    let mut blocks = Blocks::gather(positions);
    let settled = match (Line::of(to), Block::of(to)) {
        (Some(to), _) => settled(&mut blocks, steps, Line::of, &to),
        (None, Some(to)) => settled(&mut blocks, steps, Block::of, &to),
        (None, None) => false,
    };
    blocks.scatter(positions);
    settled
}

fn settled<C: Curve>(
    blocks: &mut Blocks,
    steps: Option<&Steps<'_>>,
    of: fn(&SliderShape) -> Option<C>,
    to: &C,
) -> bool {
    let along = steps.and_then(|steps| Some((of(steps.on)?, steps)));
    vectorised(
        #[inline(always)]
        || {
            if let Some((on, steps)) = &along {
                blocks.step(on, steps.forward, steps.tau);
            }
            blocks.settle(to)
        },
    )
}
