//! The fit of a linkage with a slider to a function with free ranges.
//!
//! The crank stands at phi_0 + h psi_j, and the error of an output is W (k o_j - m - beta)/k; the scales h and k are unknowns
//! behind those of a [`SliderFit`]. To that fit every pair has its own crank angle: with its derivatives by that, p_j, those by
//! the offset and by h are p_j and psi_j p_j; and de_j/dk = (W o_j - e_j)/k.

use super::fit::{OwnAngles, SliderFit, add_turn, base_angle};
use super::shape::{SliderShape, UNKNOWNS, Unknowns};
use crate::mechanism::Complex;
use crate::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock,
};
use crate::task::AngleOffset;
use crate::task::forms::torus::Positions;
use crate::task::ranges::{Ranges, Scales};
use std::array::from_fn;

/// The number of unknowns with the scales of inputs and outputs.
pub const WITH_SCALES: usize = UNKNOWNS + 2;

/// A function with free ranges and the limits of a kind of linkage, R rows a pair of which the first counts.
#[derive(Clone, Debug)]
pub struct RangedFit<'a, const R: usize> {
    fit: SliderFit<'a, R>,
    /// The crank's turns psi_j as they are written, in its direction, radians.
    turns: Vec<f64>,
    offset: AngleOffset,
    bounds: [(f64, f64); WITH_SCALES],
}

/// Joins the unknowns of a linkage and the scales.
pub fn joined(x: &Unknowns, scales: Scales) -> [f64; WITH_SCALES] {
    from_fn(|i| if i < UNKNOWNS { x[i] } else { scales[i - UNKNOWNS] })
}

/// Parts unknowns into those of the linkage and the scales.
pub fn parted(x: &[f64; WITH_SCALES]) -> (Unknowns, Scales) {
    (from_fn(|i| x[i]), [x[UNKNOWNS], x[UNKNOWNS + 1]])
}

impl<'a, const R: usize> RangedFit<'a, R> {
    /// Creates the fit from that of the ranges as they are written.
    pub fn new(fit: SliderFit<'a, R>, turns: Vec<f64>, ranges: &Ranges) -> Self {
        let of_ranges = ranges.bounds();
        let bounds = from_fn(|i| if i < UNKNOWNS { fit.limits.bounds[i] } else { of_ranges[i - UNKNOWNS] });
        let offset = fit.offset();
        RangedFit { fit: SliderFit { own: OwnAngles::All, ..fit }, turns, offset, bounds }
    }

    /// Returns the cranks at a scale of the inputs; their couplers follow from the linkage.
    fn cranks(&self, x: &Unknowns, shape: &SliderShape, h: f64) -> Positions {
        let base = base_angle(x, shape, self.offset);
        self.turns.iter().map(|turn| [Complex::from_polar(1.0, base + h * turn); 2]).collect()
    }

    /// Returns the derivatives by all unknowns from those of a fit in which a pair has its own crank angle.
    fn widened(&self, mut row: Unknowns, own: &[(usize, f64)], shape: &SliderShape) -> [f64; WITH_SCALES] {
        let mut by_h = 0.0;
        for (j, by_turn) in own {
            add_turn(&mut row, *by_turn, shape, self.offset);
            by_h += by_turn * self.turns[*j];
        }
        joined(&row, [by_h, 0.0])
    }
}

impl<const R: usize> BlockLeastSquares<WITH_SCALES, R> for RangedFit<'_, R> {
    /// None: the positions follow from the unknowns.
    type State = Positions;

    fn points(&self) -> usize {
        self.turns.len()
    }

    fn bounds(&self) -> &[(f64, f64); WITH_SCALES] {
        &self.bounds
    }

    fn cost(&self, x: &[f64; WITH_SCALES], _: &Positions) -> Option<f64> {
        let (x, [h, k]) = parted(x);
        let shape = SliderShape::of(self.fit.kind, &x)?;
        let cranks = self.cranks(&x, &shape, h);
        self.fit.cost_of_outputs(self.fit.outputs?, (&x, &cranks), &shape, k)
    }

    fn linearise(
        &self,
        x: &[f64; WITH_SCALES],
        _: &Positions,
        each: &mut dyn FnMut(&PointBlock<WITH_SCALES, R>),
    ) -> bool {
        let (x, [h, k]) = parted(x);
        let (Some(shape), Some(outputs)) = (SliderShape::of(self.fit.kind, &x), self.fit.outputs) else {
            return false;
        };
        let cranks = self.cranks(&x, &shape, h);
        let mut j = 0;
        self.fit.linearise_outputs(outputs, (&x, &cranks), (&shape, k), &mut |block| {
            let mut wide = PointBlock {
                residual: block.residual,
                jacobian: [[0.0; WITH_SCALES]; R],
                tangent: [0.0; R],
                weight: block.weight,
            };
            wide.jacobian[0] = self.widened(block.jacobian[0], &[(j, block.tangent[0])], &shape);
            let wanted = outputs.weight * self.fit.sign * outputs.wanted[j];
            wide.jacobian[0][UNKNOWNS + 1] = (wanted - block.residual[0]) / k;
            each(&wide);
            j += 1;
        })
    }

    fn retract(
        &self,
        _: &[f64; WITH_SCALES],
        _: &Positions,
        _: &[f64],
        _: &[f64; WITH_SCALES],
        _: &mut Positions,
    ) -> bool {
        true
    }

    fn constraints(&self, x: &[f64; WITH_SCALES], _: &Positions, each: &mut EachConstraint<'_, WITH_SCALES>) {
        let (x, [h, _]) = parted(x);
        let Some(shape) = SliderShape::of(self.fit.kind, &x) else { return };
        let cranks = self.cranks(&x, &shape, h);
        self.fit.constraints(&x, &cranks, &mut |value, row| {
            each(value, &|| {
                let ConstraintRow { value, gradient, own } = row();
                let own: Vec<(usize, f64)> = own.into_iter().flatten().collect();
                ConstraintRow { value, gradient: self.widened(gradient, &own, &shape), own: [None; MOST_OWN] }
            });
        });
    }
}
