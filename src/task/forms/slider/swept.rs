//! The box of all joints over the motion used: the inequalities of the footprint and of the extent.
//!
//! The joints are A, C, D, P, and B of an inverted slider-crank, whose D is the foot of the perpendicular from B on the rod:
//!
//! ```text
//! C = A + a e,   D = C + b u (slider-crank),   D = B - i h u (inverted),   P = C + Z u
//! ```
//!
//! Over a turn, or over the crank angles between the first and the last position, the extremes of each joint are found from
//! equidistant samples by the secant method; the derivative of an extreme is that of the joint at its extreme position (Danskin
//! 1967). The extent has an inequality for each diagonal of the box ([`diagonals`]).

use super::limits::{Bar, MARGIN};
use super::shape::{Closure, SHAPE, SliderShape};
use crate::mechanism::four_bar::mobility::ways_round;
use crate::mechanism::{Complex, turned};
use crate::task::forms::rows::Side;
use crate::task::forms::rows::diagonal::{Diagonal, diagonals};
use crate::task::forms::torus::turned_range;
use std::f64::consts::TAU;

/// The number of intervals between samples of a motion.
const INTERVALS: usize = 96;
/// Steps of the secant method towards an extreme, the first one with the curvature of the samples.
const STEPS: usize = 4;
/// The joints C, D and P, which move.
const MOVING: usize = 3;
/// The most joints, pivots included.
const JOINTS: usize = MOVING + 2;

/// The limits of the box, in units of the target's size around its centre.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BoxLimits {
    pub(super) footprint: Option<[f64; 4]>,
    pub(super) extent: Option<f64>,
    /// Whether the motion used is a whole turn where the crank turns fully.
    pub(super) whole: bool,
}

/// The crank angles of the motion used, of one assembly.
struct Stretch {
    from: f64,
    to: f64,
    sign: f64,
    /// The positions at its ends; `None` of a whole turn.
    ends: Option<[usize; 2]>,
}

/// The least coordinate of a joint towards the inside of a side.
#[derive(Clone, Copy)]
struct Reach {
    value: f64,
    by_shape: [f64; SHAPE],
    /// The position on which it depends, with its derivatives by the angles of crank and coupler.
    at: Option<(usize, [f64; 2])>,
}

impl Reach {
    /// The reach of a linkage without any position: its violation is the target's size.
    const NOWHERE: Reach = Reach { value: -1.0, by_shape: [0.0; SHAPE], at: None };
}

impl BoxLimits {
    /// Passes the inequalities to `each`, always in the same number and order for a kind.
    pub(super) fn each(
        &self,
        shape: &SliderShape,
        turns: bool,
        positions: &[[Complex; 2]],
        each: &mut dyn FnMut(Bar),
    ) {
        if self.footprint.is_none() && self.extent.is_none() {
            return;
        }
        let (reaches, count) = reaches(shape, stretch(shape, turns, self.whole, positions), positions);
        if let Some(limits) = self.footprint {
            for (side, limit) in Side::ALL.into_iter().zip(limits) {
                for reach in &reaches[side.index()][..count] {
                    let value = reach.value - side.sign() * limit - MARGIN;
                    let mut bar = Bar::still(value, reach.by_shape);
                    bar.at[0] = reach.at;
                    each(bar);
                }
            }
        }
        let Some(most) = self.extent else { return };
        let least = reaches.map(|joints| joints.map(|reach| reach.value));
        diagonals(least.each_ref().map(|joints| &joints[..count]), &mut |diagonal| {
            each(bar(most, &reaches, diagonal));
        });
    }
}

/// Returns the inequality of a diagonal.
fn bar(most: f64, reaches: &[[Reach; JOINTS]; 4], diagonal: &Diagonal) -> Bar {
    let mut bar = Bar::still(most - diagonal.length - MARGIN, [0.0; SHAPE]);
    for (i, (joint, factor)) in diagonal.joints.into_iter().zip(diagonal.factors).enumerate() {
        let side = &reaches[i][joint];
        for (sum, by) in bar.by_shape.iter_mut().zip(side.by_shape) {
            *sum += factor * by;
        }
        bar.at[i] = side.at.map(|(j, by)| (j, by.map(|by| factor * by)));
    }
    bar
}

/// Returns the motion used; `None` for positions of both assemblies, or of none.
fn stretch(shape: &SliderShape, turns: bool, whole: bool, positions: &[[Complex; 2]]) -> Option<Stretch> {
    let first = positions.first()?;
    let assembly = shape.assembly_of(*first);
    if positions.iter().any(|position| shape.assembly_of(*position) != assembly) {
        return None;
    }
    let (sign, begin) = (assembly.sign(), first[0].arg());
    let turn = |w: &[[Complex; 2]]| (w[1][0] * w[0][0].conj()).arg();
    if turns {
        let last = positions.len() - 1;
        let [forward, backward] = ways_round(positions.windows(2).map(turn), 0.0);
        return Some(if whole || forward.min(backward) >= TAU {
            Stretch { from: begin, to: begin + TAU, sign, ends: None }
        } else if forward <= backward {
            Stretch { from: begin, to: begin + forward, sign, ends: Some([0, last]) }
        } else {
            Stretch { from: begin - backward, to: begin, sign, ends: Some([last, 0]) }
        });
    }
    let [low, high] = turned_range(positions);
    Some(Stretch { from: begin + low.0, to: begin + high.0, sign, ends: Some([low.1, high.1]) })
}

/// Returns the places of C, D and P.
fn places(shape: &SliderShape, [e, u]: [Complex; 2]) -> [Complex; MOVING] {
    let pin = shape.crank_pivot + e * shape.crank;
    let second = match shape.closure {
        Closure::Line { coupler, .. } => pin + u * coupler,
        Closure::Block { pivot, offset } => pivot - turned(u) * offset,
    };
    [pin, second, pin + u * shape.offset]
}

/// A moving joint, base + a e + z u, with its derivatives by the unknowns at held directions.
struct Joint {
    place: Complex,
    by_shape: [Complex; SHAPE],
    /// By the angles of crank and coupler.
    by_angles: [Complex; 2],
}

/// Returns C, D and P at a position.
fn joints(shape: &SliderShape, [e, u]: [Complex; 2]) -> [Joint; MOVING] {
    let (zero, one) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0));
    let [pin, second_pin, point] = places(shape, [e, u]);
    let with_crank = [one, Complex::i(), e, zero, zero, zero, zero, zero];
    let by_crank = turned(e) * shape.crank;
    let crank_pin = Joint { place: pin, by_shape: with_crank, by_angles: [by_crank, zero] };
    let second = match shape.closure {
        Closure::Line { coupler, .. } => {
            let mut by_shape = with_crank;
            by_shape[3] = u;
            Joint { place: second_pin, by_shape, by_angles: [by_crank, turned(u) * coupler] }
        }
        Closure::Block { offset, .. } => Joint {
            place: second_pin,
            by_shape: [zero, zero, zero, one, Complex::i(), -turned(u), zero, zero],
            by_angles: [zero, u * offset],
        },
    };
    let mut by_shape = with_crank;
    (by_shape[6], by_shape[7]) = (u, turned(u));
    let point = Joint { place: point, by_shape, by_angles: [by_crank, turned(u) * shape.offset] };
    [crank_pin, second, point]
}

/// Returns the least coordinate of every joint towards the inside of every side, and the number of joints.
fn reaches(
    shape: &SliderShape,
    stretch: Option<Stretch>,
    positions: &[[Complex; 2]],
) -> ([[Reach; JOINTS]; 4], usize) {
    let second = match shape.closure {
        Closure::Line { .. } => None,
        Closure::Block { pivot, .. } => Some((3, pivot)),
    };
    let count = MOVING + 1 + usize::from(second.is_some());
    let mut found = [[Reach::NOWHERE; JOINTS]; 4];
    if positions.is_empty() {
        return (found, count);
    }
    for side in Side::ALL {
        let pivots = [Some((0, shape.crank_pivot)), second];
        for (place, (first, pivot)) in (MOVING..).zip(pivots.into_iter().flatten()) {
            let mut by_shape = [0.0; SHAPE];
            by_shape[first + side.axis()] = side.sign();
            found[side.index()][place] = Reach { value: side.inwards(pivot), by_shape, at: None };
        }
    }
    let swept = stretch.and_then(|stretch| Samples::of(shape, stretch));
    for (joint, side) in (0..MOVING).flat_map(|joint| Side::ALL.map(|side| (joint, side))) {
        let reach = match &swept {
            Some(samples) => samples.reach(joint, side),
            None => nearest(shape, positions, joint, side),
        };
        found[side.index()][joint] = reach.unwrap_or(Reach::NOWHERE);
    }
    (found, count)
}

/// Returns the least coordinate of a joint over the positions alone.
fn nearest(shape: &SliderShape, positions: &[[Complex; 2]], joint: usize, side: Side) -> Option<Reach> {
    let value = |j: &usize| side.inwards(places(shape, positions[*j])[joint]);
    let least = (0..positions.len()).min_by(|i, k| value(i).total_cmp(&value(k)))?;
    Some(at_position(shape, (least, positions[least]), joint, side))
}

/// Returns the coordinate of a joint at a position of the fit.
fn at_position(shape: &SliderShape, (j, position): (usize, [Complex; 2]), joint: usize, side: Side) -> Reach {
    let Joint { place, by_shape, by_angles } = &joints(shape, position)[joint];
    Reach {
        value: side.inwards(*place),
        by_shape: by_shape.map(|by| side.inwards(by)),
        at: Some((j, by_angles.map(|by| side.inwards(by)))),
    }
}

/// The joints at equidistant crank angles.
struct Samples<'a> {
    shape: &'a SliderShape,
    stretch: Stretch,
    step: f64,
    places: Vec<[Complex; MOVING]>,
}

impl<'a> Samples<'a> {
    /// Returns the samples; `None` if the loop is open at one of them.
    fn of(shape: &'a SliderShape, stretch: Stretch) -> Option<Samples<'a>> {
        let step = (stretch.to - stretch.from) / INTERVALS as f64;
        let mut samples = Samples { shape, stretch, step, places: Vec::with_capacity(INTERVALS + 1) };
        let one = Complex::from_polar(1.0, step);
        let mut e = Complex::from_polar(1.0, samples.stretch.from);
        for _ in 0..=INTERVALS {
            let u = shape.coupler_direction(e, samples.stretch.sign)?;
            samples.places.push(places(shape, [e, u]));
            e *= one;
        }
        Some(samples)
    }

    fn position(&self, angle: f64) -> Option<[Complex; 2]> {
        let e = Complex::from_polar(1.0, angle);
        Some([e, self.shape.coupler_direction(e, self.stretch.sign)?])
    }

    /// Returns the least coordinate of a joint over the motion.
    fn reach(&self, joint: usize, side: Side) -> Option<Reach> {
        let value = |sample: usize| side.inwards(self.places[sample][joint]);
        let sample = (0..=INTERVALS).min_by(|i, k| value(*i).total_cmp(&value(*k)))?;
        let mut angle = self.stretch.from + self.step * sample as f64;
        let mut position = self.position(angle)?;
        let (mut low, mut high) = (angle - self.step, angle + self.step);
        let mut around = sample;
        if let Some([first, last]) = self.stretch.ends
            && (sample == 0 || sample == INTERVALS)
        {
            // The extreme is at the end itself, unless the coordinate falls from there inwards.
            let slope = self.slope(position, joint, side);
            if slope.is_none_or(|slope| if sample == 0 { slope >= 0.0 } else { slope <= 0.0 }) {
                let j = if sample == 0 { first } else { last };
                return Some(at_position(self.shape, (j, position), joint, side));
            }
            (around, low, high) = if sample == 0 { (1, angle, high) } else { (INTERVALS - 1, low, angle) };
        }
        // The samples of a whole turn go on beyond its ends.
        let beside = |by: isize| value((around as isize + by).rem_euclid(INTERVALS as isize) as usize);
        let next = if around + 1 > INTERVALS { beside(1) } else { value(around + 1) };
        let mut curvature = (beside(-1) - 2.0 * value(around) + next) / (self.step * self.step);
        let mut before: Option<[f64; 2]> = None;
        for _ in 0..STEPS {
            let slope = self.slope(position, joint, side)?;
            if let Some([angle_before, slope_before]) = before
                && angle != angle_before
            {
                curvature = (slope - slope_before) / (angle - angle_before);
            }
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            before = Some([angle, slope]);
            let next = (angle - slope / curvature).clamp(low, high);
            let Some(there) = self.position(next) else { break };
            (angle, position) = (next, there);
        }
        let miss = self.shape.miss(position);
        let Joint { place, by_shape, by_angles } = &joints(self.shape, position)[joint];
        let by_coupler = side.inwards(by_angles[1]) / miss.by_coupler;
        let followed = |k: usize| side.inwards(by_shape[k]) - by_coupler * miss.by_shape[k];
        Some(Reach { value: side.inwards(*place), by_shape: std::array::from_fn(followed), at: None })
    }

    /// Returns the derivative of a joint's coordinate by the crank's angle; `None` at a toggle.
    fn slope(&self, position: [Complex; 2], joint: usize, side: Side) -> Option<f64> {
        let miss = self.shape.miss(position);
        let [by_crank, by_coupler] = joints(self.shape, position)[joint].by_angles;
        let slope = side.inwards(by_crank) - side.inwards(by_coupler) * miss.by_crank / miss.by_coupler;
        slope.is_finite().then_some(slope)
    }
}
