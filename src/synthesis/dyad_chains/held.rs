//! Dimensions that a fit holds at given values: lengths, fixed pivots, the direction of the ground.

use super::constants::HELD_WEIGHT;
use super::limits::pivot_place;
use super::normal_equations::{MAX_COLUMNS, Matrix, add_square};
use super::rows::{pivot_row, size_row};
use super::target::Target;
use super::trial::Trial;
use crate::mechanism::dyad_chain::sizes::{Joint, Side, distance};
use crate::mechanism::dyad_chain::{Placement, Proportions, Rates};
use crate::numbers::arithmetic::Complex;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// A dimension at a given value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The distance of two joints of a body.
    Length(Side, f64),
    /// The place of a joint of the ground.
    Pivot(Joint, Complex),
    /// The direction from A to B, radians.
    Direction(f64),
}

/// Residual at which all is held, and at which it is nearly; what is added to the squares, for lengths that depend on each other (of
/// three joints in line); and the greatest step of an unknown.
const EXACT: f64 = 1e-13;
const NEAR: f64 = 1e-7;
const FLOOR: f64 = 1e-12;
const MOST: f64 = 0.5;

/// All that a fit holds, in units of the target.
#[derive(Clone, Debug, Default)]
pub(super) struct AllHeld {
    held: Vec<Held>,
}

impl AllHeld {
    /// Returns what is held of a chain that is fitted to a target, or to its mirror image.
    pub(super) fn of(held: &[Held], target: &Target, mirrored: bool) -> Self {
        let own = |one: &Held| match *one {
            Held::Length(side, length) => Held::Length(side, length / target.radius),
            Held::Pivot(joint, at) => {
                let at = (at - target.centre) / target.radius;
                Held::Pivot(joint, if mirrored { at.conj() } else { at })
            }
            Held::Direction(angle) => Held::Direction(if mirrored { -angle } else { angle }),
        };
        AllHeld { held: held.iter().map(own).collect() }
    }

    /// Returns whether nothing is held.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Returns the sum of the weighted squares, a point.
    #[inline(always)]
    pub(super) fn value(&self, of: &Proportions, at: &Placement) -> f64 {
        let sum: f64 = self
            .held
            .iter()
            .map(|one| match one {
                Held::Length(side, length) => residual(of, at, side, *length).powi(2),
                Held::Pivot(joint, wanted) => away(of, at, *joint, *wanted).norm_sqr(),
                Held::Direction(angle) => turned(at, *angle).powi(2),
            })
            .sum();
        sum * HELD_WEIGHT
    }

    /// Adds the squares of the rows of all that is held.
    pub(super) fn add(&self, fixed: &mut Matrix, now: &Trial, rates: &Rates, points: usize) {
        let columns = now.shape.count() + 7;
        for row in self.rows(now, rates) {
            add_square(fixed, &row, columns, HELD_WEIGHT * points as f64);
        }
    }

    /// Returns the rows of all that is held, by the unknowns; the residuals stand behind them.
    fn rows(&self, now: &Trial, rates: &Rates) -> Vec<[f64; MAX_COLUMNS]> {
        let count = now.shape.count();
        let mut rows = Vec::new();
        for one in &self.held {
            match one {
                Held::Length(side, length) => {
                    let residual = residual(&now.of, &now.at, side, *length);
                    rows.push(size_row(now, rates, side, residual));
                }
                Held::Pivot(joint, wanted) => {
                    let away = away(&now.of, &now.at, *joint, *wanted);
                    let place = pivot_place(&now.of, *joint);
                    for (axis, away) in [away.re, away.im].into_iter().enumerate() {
                        rows.push(pivot_row(now, *joint, place, (axis, away)));
                    }
                }
                Held::Direction(angle) => {
                    let per = now.at.ground / now.at.ground.norm_sqr();
                    let mut row = [0.0; MAX_COLUMNS];
                    (row[count + 2], row[count + 3]) = (-per.im, per.re);
                    row[count + 6] = turned(&now.at, *angle);
                    rows.push(row);
                }
            }
        }
        rows
    }

    /// Moves shape and placement of a trial to where all is held, each step as little as it takes (Newton's method with the least-norm
    /// solution); returns whether that came to an end within so many steps.
    pub(super) fn restore(&self, trial: &mut Trial, steps: usize) -> bool {
        let count = trial.shape.count();
        let unknowns = count + 6;
        let mut at_first = f64::INFINITY;
        for step in 0..=steps {
            trial.of = trial.shape.resolve(&mut trial.grid);
            let rows = self.rows(trial, &Rates::of(&trial.shape, &trial.of));
            let residual = rows.iter().map(|row| row[unknowns].abs()).fold(0.0, f64::max);
            if residual <= EXACT {
                return true;
            }
            if step == 0 {
                at_first = residual;
            }
            if step == steps || !residual.is_finite() {
                return residual <= NEAR.min(at_first);
            }
            let by = |i: usize, k: usize| rows[i][k];
            let slopes = DMatrix::from_fn(rows.len(), unknowns, by);
            let missing = DVector::from_fn(rows.len(), |i, _| -rows[i][unknowns]);
            let mut square = &slopes * slopes.transpose();
            for i in 0..rows.len() {
                square[(i, i)] += FLOOR;
            }
            let Some(factors) = square.cholesky() else { return false };
            let mut moved = slopes.transpose() * factors.solve(&missing);
            let largest = moved.amax();
            if largest > MOST {
                moved *= MOST / largest;
            }
            for (parameter, step) in trial.shape.parameters.iter_mut().zip(moved.iter()).take(count) {
                *parameter += step;
            }
            let step = |i: usize| Complex::new(moved[count + i], moved[count + i + 1]);
            let Placement { origin, ground, pointer } = trial.at;
            trial.at =
                Placement { origin: origin + step(0), ground: ground + step(2), pointer: pointer + step(4) };
        }
        false
    }
}

/// Returns ln of a distance over its value.
#[inline(always)]
fn residual(of: &Proportions, at: &Placement, side: &Side, length: f64) -> f64 {
    (distance(of, at, side).max(f64::MIN_POSITIVE) / length).ln()
}

/// Returns the vector from the place of a pivot to where the chain has it.
#[inline(always)]
fn away(of: &Proportions, at: &Placement, joint: Joint, wanted: Complex) -> Complex {
    at.origin + at.ground * pivot_place(of, joint) - wanted
}

/// Returns the angle from a direction to that of the ground, from -pi to pi.
#[inline(always)]
fn turned(at: &Placement, angle: f64) -> f64 {
    let turned = at.ground.arg() - angle;
    turned - TAU * (turned / TAU).round()
}
