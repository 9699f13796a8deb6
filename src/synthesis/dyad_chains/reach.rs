//! How far the joints and P of a chain reach over the motion, for limits on its footprint and its extent.
//!
//! Of each joint and side of the box the phase of the extreme is found on the grid, refined by the parabola through three phases;
//! the coordinate's derivative there is that of the extreme, since the coordinate is stationary by the phase (or the phase is an
//! end of the motion, which is held).

use super::limits::{Bodies, Limits, beyond};
use super::normal_equations::MAX_COLUMNS;
use super::target::Points;
use super::trial::Trial;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::dyad_chain::proportions::{first_parameter, parameters_of};
use crate::mechanism::dyad_chain::sizes::Joint;
use crate::mechanism::dyad_chain::{Frames, Grid, MAX_SLOPES, Rates, Slopes};
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::sine::sin_cos;
use crate::numbers::arithmetic::{Complex, least_and_greatest};

/// Steps of the finer look between the phases of the grid beside an extreme.
const FINER: usize = 16;
/// Rounds of regula falsi, and the part of the speeds beside an extreme at which it ends.
const ROUNDS: usize = 24;
const EQUAL: f64 = 1e-11;

/// A joint or P at the phase at which it reaches farthest to one side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    body: usize,
    joint: Joint,
    phase: f64,
    /// The phase of the grid beside it.
    middle: f64,
    /// Whether it is an end of the motion.
    is_end: bool,
    /// 0: x, 1: y.
    axis: usize,
    /// 1: to the greatest coordinate, -1: to the least.
    sign: f64,
    /// The coordinate.
    pub(super) at: f64,
}

/// A limit that the motion breaks: by how much, and the reaches by which it does, each with its share.
#[derive(Clone, Debug)]
pub(super) struct Broken {
    pub(super) over: f64,
    parts: Vec<(Reach, f64)>,
}

/// Returns the place of a joint on its body.
fn place(now: &Trial, joint: Joint) -> Complex {
    match joint {
        Joint::Fixed(x) => Complex::new(x, 0.0),
        Joint::CrankPin => now.of.anchors[0][0],
        Joint::End { dyad, end } => now.of.anchors[dyad][end],
        Joint::Traced => now.at.pointer / now.at.ground,
    }
}

/// Returns a number of one lane.
fn number(z: ComplexLanes<f64>) -> Complex {
    Complex::new(z.re, z.im)
}

/// Returns the direction of the crank at a phase.
fn crank(phase: f64) -> ComplexLanes<f64> {
    let (sin, cos) = sin_cos(phase);
    ComplexLanes { re: cos, im: sin }
}

/// Returns where a joint is at a phase.
fn position(now: &Trial, body: usize, joint: Joint, phase: f64) -> Complex {
    let mut frames = Frames::<f64>::of(crank(phase));
    frames.assemble_all(&now.of);
    let (o, v) = (number(frames.origin[body]), number(frames.along[body]));
    now.at.origin + now.at.ground * (o + v * place(now, joint))
}

/// Returns the derivative of a joint's coordinate by the phase.
fn speed(now: &Trial, reach: &Reach, phase: f64) -> f64 {
    let e = crank(phase);
    let mut frames = Frames::<f64>::of(e);
    let mut slopes = Slopes::<f64, 1>::of(e);
    for dyad in 0..now.of.kind.dyads() {
        frames.assemble(&now.of, dyad);
        slopes.differentiate(&now.of, &Rates::NONE, dyad, &frames, 0);
    }
    let (o, v) = (number(slopes.origin[reach.body][0]), number(slopes.along[reach.body][0]));
    let moved = now.at.ground * (o + v * place(now, reach.joint));
    if reach.axis == 0 { moved.re } else { moved.im }
}

/// Returns a reach at the phase at which its coordinate is stationary, by regula falsi between the phases of the grid beside it
/// (with half weights for an end that stays, the Illinois rule); one at an end of the motion, or without a change of sign, as it
/// is.
fn settled(now: &Trial, reach: Reach) -> Reach {
    // The motion may be quick here: a finer look at where the extreme lies.
    let fine = 2.0 * Grid::phase(1) / FINER as f64;
    let at = |i: usize| reach.middle - Grid::phase(1) + fine * i as f64;
    let coordinate = |phase: f64| {
        let p = position(now, reach.body, reach.joint, phase);
        reach.sign * if reach.axis == 0 { p.re } else { p.im }
    };
    let best = (1..FINER).max_by(|i, j| coordinate(at(*i)).total_cmp(&coordinate(at(*j)))).unwrap_or(1);
    let [mut low, mut high] = [at(best) - fine, at(best) + fine];
    let [mut at_low, mut at_high] = [low, high].map(|phase| speed(now, &reach, phase));
    if reach.is_end || at_low * at_high >= 0.0 {
        return reach;
    }
    let scale = EQUAL * (at_low.abs() + at_high.abs());
    let (mut phase, mut side) = (at(best), 0);
    for _ in 0..ROUNDS {
        let here = speed(now, &reach, phase);
        if here.abs() <= scale {
            break;
        }
        if here * at_high > 0.0 {
            (high, at_high) = (phase, here);
            at_low *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (low, at_low) = (phase, here);
            at_high *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
        phase = (low * at_high - high * at_low) / (at_high - at_low);
    }
    let p = position(now, reach.body, reach.joint, phase);
    Reach { phase, at: if reach.axis == 0 { p.re } else { p.im }, ..reach }
}

/// Returns the reaches of all joints to a side: along an axis (0: x, 1: y) in the sense of `sign`.
fn reaches(now: &Trial, points: &Points, bodies: &Bodies, axis: usize, sign: f64) -> Vec<Reach> {
    let step = Grid::phase(1);
    let used = (!points.closed).then(|| least_and_greatest(now.phases[..points.count].iter().copied()));
    let of_joint = |&(body, joint): &(usize, Joint)| {
        let curve = now.grid.points(body, [now.at.origin, now.at.ground, now.at.ground * place(now, joint)]);
        let column = &curve[axis];
        let n = column.len();
        let on = |i: usize| {
            used.is_none_or(|[from, to]| {
                (Grid::phase(i) - from).rem_euclid(std::f64::consts::TAU) <= to - from
            })
        };
        let best =
            (0..n).filter(|i| on(*i)).max_by(|i, j| (sign * column[*i]).total_cmp(&(sign * column[*j])));
        let inner = best.map(|i| {
            let [before, here, after] = [(i + n - 1) % n, i, (i + 1) % n].map(|k| column[k]);
            let bend = before - 2.0 * here + after;
            let by = if bend == 0.0 { 0.0 } else { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) };
            (Grid::phase(i), Grid::phase(i) + by * step)
        });
        let ends = used.into_iter().flatten();
        let inner = inner.filter(|(_, phase)| {
            used.is_none_or(|[from, to]| (phase - from).rem_euclid(std::f64::consts::TAU) <= to - from)
        });
        let ends = ends.map(|phase| (phase, phase, true));
        let all = inner.map(|(middle, phase)| (middle, phase, false)).into_iter().chain(ends);
        let all = all.map(|(middle, phase, is_end)| {
            let p = position(now, body, joint, phase);
            Reach { body, joint, phase, middle, is_end, axis, sign, at: if axis == 0 { p.re } else { p.im } }
        });
        all.max_by(|one, other| (sign * one.at).total_cmp(&(sign * other.at)))
    };
    let pivots = bodies.pivots.iter().map(|joint| (GROUND, *joint));
    bodies.moving.iter().copied().chain(pivots).filter_map(|joint| of_joint(&joint)).collect()
}

/// Returns the limits on footprint and extent that the motion of a chain breaks.
pub(super) fn broken(now: &Trial, points: &Points, limits: &Limits, bodies: &Bodies) -> Vec<Broken> {
    let mut all = Vec::new();
    if limits.footprint.is_none() && limits.extent.is_infinite() {
        return all;
    }
    let sides = [(0, -1.0), (1, -1.0), (0, 1.0), (1, 1.0)].map(|(axis, sign)| {
        let reaches = reaches(now, points, bodies, axis, sign);
        (sign, reaches)
    });
    if let Some(corners) = limits.footprint {
        for (_, reaches) in &sides {
            for reach in reaches {
                let p = if reach.axis == 0 {
                    Complex::new(reach.at, corners[0].im)
                } else {
                    Complex::new(corners[0].re, reach.at)
                };
                let over = beyond(p, corners)[reach.axis];
                if over != 0.0 {
                    let reach = settled(now, *reach);
                    let sign = over.signum();
                    let limit = if sign > 0.0 { corners[1] } else { corners[0] };
                    let limit = if reach.axis == 0 { limit.re } else { limit.im };
                    all.push(Broken { over: sign * (reach.at - limit), parts: vec![(reach, sign)] });
                }
            }
        }
    }
    if limits.extent.is_finite() {
        let farthest = sides.map(|(sign, reaches)| {
            let farthest =
                reaches.into_iter().max_by(|one, other| (sign * one.at).total_cmp(&(sign * other.at)));
            farthest.map(|reach| settled(now, reach))
        });
        if let [Some(left), Some(low), Some(right), Some(high)] = farthest {
            let (width, height) = (right.at - left.at, high.at - low.at);
            let diagonal = width.hypot(height);
            if diagonal > limits.extent {
                let [x, y] = [width / diagonal, height / diagonal];
                let parts = vec![(left, -x), (right, x), (low, -y), (high, y)];
                all.push(Broken { over: diagonal - limits.extent, parts });
            }
        }
    }
    all
}

impl Broken {
    /// Returns the row of the excess: its derivatives by all unknowns, and itself.
    pub(super) fn row(&self, now: &Trial, rates: &Rates) -> [f64; MAX_COLUMNS] {
        let count = now.shape.count();
        let mut row = [0.0; MAX_COLUMNS];
        for (reach, share) in &self.parts {
            let own = reach.row(now, rates);
            row.iter_mut().zip(own).for_each(|(sum, x)| *sum += share * x);
        }
        row[count + 6] = self.over;
        row
    }
}

impl Reach {
    /// Returns the derivatives of the coordinate by all unknowns, the phase held.
    fn row(&self, now: &Trial, rates: &Rates) -> [f64; MAX_COLUMNS] {
        let count = now.shape.count();
        let e = crank(self.phase);
        let mut frames = Frames::<f64>::of(e);
        let mut slopes = Slopes::<f64, MAX_SLOPES>::of(e);
        for dyad in 0..now.of.kind.dyads() {
            frames.assemble(&now.of, dyad);
            slopes.differentiate(&now.of, rates, dyad, &frames, parameters_of(dyad + 1));
        }
        let (o, v) = (number(frames.origin[self.body]), number(frames.along[self.body]));
        let (s, z) = (now.at.ground, now.at.pointer);
        let is_traced = self.joint == Joint::Traced;
        let xi = place(now, self.joint);
        let part = |z: Complex| if self.axis == 0 { z.re } else { z.im };
        let turned = Complex::new(0.0, 1.0);
        let mut row = [0.0; MAX_COLUMNS];
        for (k, entry) in row.iter_mut().enumerate().take(count) {
            let (do_, dv) = (number(slopes.origin[self.body][k + 1]), number(slopes.along[self.body][k + 1]));
            // Only links move with the parameters.
            let moved = if self.body > CRANK { do_ + dv * xi } else { Complex::new(0.0, 0.0) };
            *entry = if is_traced { part(s * do_ + z * dv) } else { part(s * moved) };
        }
        match self.joint {
            Joint::CrankPin => row[0] += part(s * v * xi),
            Joint::End { dyad, end } => {
                let k = first_parameter(dyad) + 2 * end;
                row[k] += part(s * v);
                row[k + 1] += part(s * turned * v);
            }
            Joint::Fixed(_) | Joint::Traced => {}
        }
        let by_ground = if is_traced { o } else { o + v * xi };
        let columns = [Complex::new(1.0, 0.0), by_ground, if is_traced { v } else { Complex::new(0.0, 0.0) }];
        for (i, column) in columns.into_iter().enumerate() {
            row[count + 2 * i] = part(column);
            row[count + 2 * i + 1] = part(turned * column);
        }
        row
    }
}
