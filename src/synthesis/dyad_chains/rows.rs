//! Rows of all residuals of a fit: points along and normal to the curve, hinges, excursions.

use super::limits::{Bodies, Limits, beyond, pivot_place};
use super::normal_equations::{MAX_COLUMNS, Matrix, add_square, gram};
use super::target::Points;
use super::trial::{Trial, direction};
use crate::mechanism::dyad_chain::kinds::CRANK;
use crate::mechanism::dyad_chain::proportions::{first_parameter, parameters_of};
use crate::mechanism::dyad_chain::sizes::{Joint, Side, distance, log_rate};
use crate::mechanism::dyad_chain::transmission::{cosine, cosine_rate};
use crate::mechanism::dyad_chain::{Frames, MAX_SLOPES, Rates, Slopes};
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::numbers::arithmetic::{Complex, dot};

/// The rows of the points, column by column, and the sum of the squares of all rows whose weight is fixed.
#[derive(Debug)]
pub(super) struct Rows {
    slopes: Box<Slopes<F64x8, MAX_SLOPES>>,
    rates: Rates,
    normal: Vec<f64>,
    /// Rows along the curve, not yet weighted.
    pub(super) tangent: Vec<f64>,
    /// |g|^2 of each point.
    pub(super) speed_sq: Vec<f64>,
    pub(super) fixed: Box<Matrix>,
    /// The sum of the squares of the rows of what is held.
    pub(super) held: Box<Matrix>,
}

impl Default for Rows {
    fn default() -> Self {
        Rows {
            slopes: Box::new(Slopes::of(ComplexLanes::ZERO)),
            rates: Rates::NONE,
            normal: Vec::new(),
            tangent: Vec::new(),
            speed_sq: Vec::new(),
            fixed: Box::new([[0.0; MAX_COLUMNS]; MAX_COLUMNS]),
            held: Box::new([[0.0; MAX_COLUMNS]; MAX_COLUMNS]),
        }
    }
}

impl Rows {
    /// Makes room for so many points.
    pub(super) fn resize(&mut self, padded: usize) {
        self.normal.resize(MAX_COLUMNS * padded, 0.0);
        self.tangent.resize(MAX_COLUMNS * padded, 0.0);
        self.speed_sq.resize(padded, 0.0);
    }

    /// Computes frames and slopes at eight directions of the crank.
    #[inline(always)]
    fn differentiate(&mut self, now: &Trial, frames: &mut Frames<F64x8>, e: ComplexLanes) {
        frames.along[CRANK] = e;
        self.slopes.turn(e);
        for dyad in 0..now.shape.kind.dyads() {
            frames.assemble(&now.of, dyad);
            self.slopes.differentiate(&now.of, &self.rates, dyad, frames, parameters_of(dyad + 1));
        }
    }

    /// Calls `put` with dP by each unknown, of eight phases.
    #[inline(always)]
    fn derivatives(&self, now: &Trial, frames: &Frames<F64x8>, mut put: impl FnMut(usize, ComplexLanes)) {
        let (count, body) = (now.shape.count(), now.shape.kind.traced());
        let [_, s, z] = now.at.numbers().map(ComplexLanes::splat);
        let turned = |z: ComplexLanes| ComplexLanes { re: -z.im, im: z.re };
        for k in 0..count {
            put(k, s * self.slopes.origin[body][k + 1] + z * self.slopes.along[body][k + 1]);
        }
        let one = ComplexLanes::splat(Complex::new(1.0, 0.0));
        for (i, column) in [one, frames.origin[body], frames.along[body]].into_iter().enumerate() {
            put(count + 2 * i, column);
            put(count + 2 * i + 1, turned(column));
        }
    }

    /// Computes all rows.
    #[inline(always)]
    pub(super) fn derive(
        &mut self,
        now: &Trial,
        points: &Points,
        limits: &Limits,
        bodies: &Bodies,
        frames: &mut Frames<F64x8>,
    ) {
        self.rates = Rates::of(&now.shape, &now.of);
        let padded = points.mask.len();
        let (count, body) = (now.shape.count(), now.shape.kind.traced());
        let [t, s, z] = now.at.numbers().map(ComplexLanes::splat);
        let tiny = F64x8::splat(f64::MIN_POSITIVE);
        for at in (0..padded).step_by(LANES) {
            self.differentiate(now, frames, direction(&now.phases, at));
            let (o, v) = (frames.origin[body], frames.along[body]);
            let g = s * self.slopes.origin[body][0] + z * self.slopes.along[body][0];
            let speed_sq = g.norm_sq();
            speed_sq.store(&mut self.speed_sq, at);
            // Padding has rows of zeros.
            let unit = g.scale((speed_sq + tiny).sqrt().recip() * F64x8::load(&points.mask, at));
            let (mut normal, mut tangent) =
                (std::mem::take(&mut self.normal), std::mem::take(&mut self.tangent));
            self.derivatives(
                now,
                frames,
                #[inline(always)]
                |column, j| split(j, unit, [&mut normal, &mut tangent], column * padded + at),
            );
            let residual = t + s * o + z * v - ComplexLanes::load(&points.columns, at);
            split(residual, unit, [&mut normal, &mut tangent], (count + 6) * padded + at);
            if points.follow_the_ground() {
                // The phases fall by as much as S turns.
                let speed = speed_sq.sqrt() * F64x8::load(&points.mask, at);
                let per = now.at.ground / now.at.ground.norm_sqr();
                for (column, rate) in [(count + 2, per.im), (count + 3, -per.re)] {
                    let place = column * padded + at;
                    (F64x8::load(&tangent, place) + speed * F64x8::splat(rate)).store(&mut tangent, place);
                }
            }
            (self.normal, self.tangent) = (normal, tangent);
        }
        self.speed_sq[points.count..].fill(0.0);
        gram(&self.normal, padded, count + 7, &mut self.fixed);
        self.add_limits(now, points, limits, bodies);
        self.add_reaches(now, points, limits);
        self.add_excursions(now, frames);
    }

    /// Adds the hinges of the limits.
    #[inline(always)]
    fn add_limits(&mut self, now: &Trial, points: &Points, limits: &Limits, bodies: &Bodies) {
        let count = now.shape.count();
        let n = points.count as f64;
        let fixed = &mut self.fixed;
        for dyad in 0..now.shape.kind.dyads() {
            for (end, sign) in [(0, 1.0), (1, -1.0)] {
                let over = sign * cosine(&now.of, dyad, end) - limits.cosine;
                if over > 0.0 {
                    let mut row = [0.0; MAX_COLUMNS];
                    for (k, entry) in row.iter_mut().enumerate().take(count) {
                        *entry = sign * cosine_rate(&now.of, &self.rates, (dyad, end), k);
                    }
                    row[count + 6] = over;
                    add_square(fixed, &row, count + 7, limits.cosine_weight * n);
                }
            }
        }
        let weight = limits.size_weight * n;
        for side in &bodies.sides {
            let over = distance(&now.of, &now.at, side).max(f64::MIN_POSITIVE).ln() - limits.longest;
            if over > 0.0 {
                add_square(fixed, &size_row(now, &self.rates, side, over), count + 7, weight);
            }
        }
        let (low, high, ratio) = bodies.ratio(&now.of, &now.at);
        if ratio > limits.ratio {
            let mut row = size_row(now, &self.rates, &bodies.sides[high], ratio - limits.ratio);
            let other = size_row(now, &self.rates, &bodies.sides[low], 0.0);
            row.iter_mut().zip(other).for_each(|(a, b)| *a -= b);
            add_square(fixed, &row, count + 7, weight);
        }
        for (i, joint) in bodies.pivots.iter().enumerate() {
            if let Some(corners) = limits.pivots_in[i.min(2)] {
                let place = pivot_place(&now.of, *joint);
                let over = beyond(now.at.origin + now.at.ground * place, corners);
                for (axis, over) in over.into_iter().enumerate().filter(|(_, over)| *over != 0.0) {
                    let row = pivot_row(now, *joint, place, (axis, over));
                    add_square(fixed, &row, count + 7, limits.pivot_weight * n);
                }
            }
        }
        if !bodies.held.is_empty() {
            *self.held = [[0.0; MAX_COLUMNS]; MAX_COLUMNS];
            bodies.held.add(&mut self.held, now, &self.rates, points.count);
        }
    }

    /// Adds the hinges of footprint and extent.
    #[inline(always)]
    fn add_reaches(&mut self, now: &Trial, points: &Points, limits: &Limits) {
        let (count, weight) = (now.shape.count(), limits.pivot_weight * points.count as f64);
        for broken in &now.broken {
            add_square(&mut self.fixed, &broken.row(now, &self.rates), count + 7, weight);
        }
    }

    /// Adds the distances of the curve from the target between its points.
    #[inline(always)]
    fn add_excursions(&mut self, now: &Trial, frames: &mut Frames<F64x8>) {
        let count = now.shape.count();
        for together in now.excursions.chunks(LANES) {
            let mut e = ComplexLanes::splat(Complex::new(1.0, 0.0));
            for (lane, excursion) in together.iter().enumerate() {
                e.set(lane, now.grid.crank(excursion.phase));
            }
            self.differentiate(now, frames, e);
            let mut rows = [[0.0; MAX_COLUMNS]; LANES];
            self.derivatives(now, frames, |column, j| {
                for (lane, (row, excursion)) in rows.iter_mut().zip(together).enumerate() {
                    row[column] = dot(excursion.away, j.get(lane));
                }
            });
            for (row, excursion) in rows.iter_mut().zip(together) {
                row[count + 6] = excursion.excess;
                add_square(&mut self.fixed, row, count + 7, 1.0);
            }
        }
    }
}

/// Stores the parts of eight vectors normal to unit vectors and along them.
#[inline(always)]
fn split(j: ComplexLanes, unit: ComplexLanes, [normal, tangent]: [&mut [f64]; 2], at: usize) {
    (j.re * unit.re + j.im * unit.im).store(tangent, at);
    (unit.re * j.im - unit.im * j.re).store(normal, at);
}

/// Returns the row of the logarithm of a length.
#[inline(always)]
pub(super) fn size_row(now: &Trial, rates: &Rates, side: &Side, residual: f64) -> [f64; MAX_COLUMNS] {
    let count = now.shape.count();
    let rate = log_rate(&now.of, rates, &now.at, side);
    let mut row = [0.0; MAX_COLUMNS];
    row[..count].copy_from_slice(&rate.shape[..count]);
    row[count + 2..count + 4].copy_from_slice(&rate.ground);
    row[count + 4..count + 6].copy_from_slice(&rate.pointer);
    row[count + 6] = residual;
    row
}

/// Returns the row of a coordinate (0: x, 1: y) of a fixed pivot at a place of the frame A = 0, B = 1.
#[inline(always)]
pub(super) fn pivot_row(
    now: &Trial,
    joint: Joint,
    place: Complex,
    (axis, residual): (usize, f64),
) -> [f64; MAX_COLUMNS] {
    let count = now.shape.count();
    let mut row = [0.0; MAX_COLUMNS];
    // The part of z and of i z.
    let parts = |z: Complex| if axis == 0 { [z.re, -z.im] } else { [z.im, z.re] };
    row[count..count + 2].copy_from_slice(&parts(Complex::new(1.0, 0.0)));
    row[count + 2..count + 4].copy_from_slice(&parts(place));
    if let Joint::End { dyad, end } = joint {
        let k = first_parameter(dyad) + 2 * end;
        row[k..k + 2].copy_from_slice(&parts(now.at.ground));
    }
    row[count + 6] = residual;
    row
}

#[cfg(test)]
mod tests {
    use super::super::reach::broken;
    use super::super::request::DyadChainTiming;
    use super::super::target::Target;
    use super::*;
    use crate::mechanism::AssemblyMode;
    use crate::mechanism::dyad_chain::{DyadChainKind, Placement, Shape};
    use crate::numbers::arithmetic::streams::{Stream, stream, uniform};
    use crate::task::AngleOffset;

    const LIMITS: Limits = Limits {
        cosine: 0.6,
        longest: -0.5,
        ratio: 0.4,
        pivots_in: [
            Some([Complex::new(-0.1, -0.1), Complex::new(0.1, 0.1)]),
            Some([Complex::new(-0.2, -0.1), Complex::new(0.1, 0.2)]),
            Some([Complex::new(-0.1, -0.3), Complex::new(0.3, 0.1)]),
        ],
        footprint: Some([Complex::new(-0.4, -0.3), Complex::new(0.5, 0.2)]),
        extent: 1.1,
        cosine_weight: 4.0,
        size_weight: 0.7,
        pivot_weight: 0.9,
    };

    /// The sum of squares at a shape and a placement, with the phases held.
    fn sum_sq(trial: &mut Trial, points: &Points, bodies: &Bodies, (shape, at): (Shape, Placement)) -> f64 {
        trial.shape = shape;
        trial.evaluate(points, &LIMITS, bodies, &mut Frames::of(ComplexLanes::ZERO), None);
        trial.at = at;
        trial.find_excursions(points);
        let n = points.count as f64;
        let over: f64 = trial.excursions.iter().map(|e| e.excess * e.excess).sum();
        let reached: f64 = broken(trial, points, &LIMITS, bodies).iter().map(|b| b.over * b.over).sum();
        let hinges = LIMITS.of_transmission(&trial.of)
            + LIMITS.of_sizes(&trial.of, &at, bodies)
            + LIMITS.pivot_weight * reached;
        trial.misfit_at(points, &at) + n * hinges + over
    }

    fn moved(shape: Shape, at: Placement, unknown: usize, step: f64) -> (Shape, Placement) {
        let (mut shape, mut at) = (shape, at);
        let count = shape.count();
        let vector =
            |i: usize| if i.is_multiple_of(2) { Complex::new(step, 0.0) } else { Complex::new(0.0, step) };
        match unknown.checked_sub(count) {
            None => shape.parameters[unknown] += step,
            Some(i @ 0..2) => at.origin += vector(i),
            Some(i @ 2..4) => at.ground += vector(i),
            Some(i) => at.pointer += vector(i),
        }
        (shape, at)
    }

    fn drawn(draws: &mut Stream, kind: DyadChainKind) -> (Shape, Placement) {
        let mut shape = Trial::default().shape;
        (shape.kind, shape.assembly[1]) = (kind, AssemblyMode::Minus);
        let count = shape.count();
        shape.parameters[..count].fill_with(|| uniform(draws, -0.8, 0.8));
        let mut place = || Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0));
        (shape, Placement { origin: place(), ground: place(), pointer: place() })
    }

    #[test]
    fn the_gradient_with_prescribed_phases_is_that_of_central_differences() {
        let draws = &mut stream(62, 0);
        let targets: Vec<Complex> = (0..12).map(|i| Complex::from_polar(1.0, 0.31 * f64::from(i))).collect();
        let angles: Vec<f64> = (0..12).map(|i| 0.4 * f64::from(i)).collect();
        let timing = DyadChainTiming { angles: &angles, offset: AngleOffset::Fixed, runs: &[1.0] };
        let target = Target::of((&targets, false), Some(timing), 48, 64).expect("a target");
        let points = &target.all[0];
        for kind in DyadChainKind::SIX_BARS {
            let (shape, at) = drawn(draws, kind);
            let mut bodies = Bodies::default();
            bodies.of(kind);
            let mut trial = Trial::default();
            trial.resize(points.mask.len());
            let value = |(shape, at): (Shape, Placement), trial: &mut Trial| {
                trial.shape = shape;
                points.timing.as_ref().expect("times").put(at.ground, &mut trial.phases[..points.count]);
                let frames = &mut Frames::of(ComplexLanes::ZERO);
                trial.evaluate(points, &LIMITS, &bodies, frames, Some(at));
                trial.misfit
            };
            let misfit = value((shape, at), &mut trial);
            let mut rows = Rows::default();
            rows.resize(points.mask.len());
            rows.derive(&trial, points, &LIMITS, &Bodies::default(), &mut Frames::of(ComplexLanes::ZERO));
            let (unknowns, padded) = (shape.count() + 6, points.mask.len());
            let product = |part: &[f64], k: usize| -> f64 {
                let column = |k: usize| &part[k * padded..(k + 1) * padded];
                column(k).iter().zip(column(unknowns)).map(|(a, b)| a * b).sum()
            };
            for k in 0..unknowns {
                let gradient = 2.0 * (product(&rows.normal, k) + product(&rows.tangent, k));
                let step = 1e-6;
                let mut at_step = |step| value(moved(shape, at, k, step), &mut trial) * points.count as f64;
                let difference = (at_step(step) - at_step(-step)) / (2.0 * step);
                let scale = misfit + difference.abs();
                assert!(
                    (gradient - difference).abs() < 1e-6 * scale,
                    "{kind:?} {k}: {gradient} {difference}"
                );
            }
        }
    }

    #[test]
    fn the_gradient_of_all_residuals_and_hinges_is_that_of_central_differences() {
        let draws = &mut stream(61, 0);
        let targets: Vec<Complex> = (0..20).map(|i| Complex::from_polar(1.0, 0.31 * f64::from(i))).collect();
        let target = Target::of((&targets, true), None, 48, 64).expect("a target");
        let points = &target.all[0];
        let kinds = DyadChainKind::SIX_BARS.into_iter().chain(DyadChainKind::eight_bars());
        for kind in kinds {
            let (shape, at) = drawn(draws, kind);
            let mut bodies = Bodies::default();
            bodies.of(kind);
            let mut trial = Trial::default();
            trial.resize(points.mask.len());
            for (i, phase) in trial.phases.iter_mut().enumerate() {
                *phase = 0.3 * i as f64;
            }
            let value = sum_sq(&mut trial, points, &bodies, (shape, at));
            trial.broken = broken(&trial, points, &LIMITS, &bodies);
            let mut rows = Rows::default();
            rows.resize(points.mask.len());
            rows.derive(&trial, points, &LIMITS, &bodies, &mut Frames::of(ComplexLanes::ZERO));
            let (unknowns, padded) = (shape.count() + 6, points.mask.len());
            let column = |k: usize| &rows.tangent[k * padded..(k + 1) * padded];
            for k in 0..unknowns {
                let along: f64 = column(k).iter().zip(column(unknowns)).map(|(a, b)| a * b).sum();
                let gradient = 2.0 * (rows.fixed[k][unknowns] + along);
                let step = 1e-6;
                let mut at_step = |step| sum_sq(&mut trial, points, &bodies, moved(shape, at, k, step));
                let difference = (at_step(step) - at_step(-step)) / (2.0 * step);
                let scale = value + difference.abs();
                assert!(
                    (gradient - difference).abs() < 1e-6 * scale,
                    "{kind:?} {k}: {gradient} {difference}"
                );
            }
        }
    }
}
