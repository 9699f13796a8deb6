//! The joints over a motion with their extremes and derivatives, for the rows of the footprint and the extent.

use super::{Motion, Place, Side};
use crate::mechanism::four_bar::gradient::{Frame, by_crank_angle, shape_gradient};
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{AssemblyMode, Complex, point, turned, unit_vector};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::task::forms::design_space::{SHAPE, Shape};

/// The joints over a motion, without allocation.
#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack, so that nothing is allocated")]
pub(super) enum Swept<'a> {
    Samples(Samples),
    Points { shape: &'a Shape, positions: &'a [[Complex; 2]] },
}

/// Number of intervals between samples of a motion; parabolas through neighbours lead to the extremes.
const INTERVALS: usize = 96;
/// Number of samples, rounded up to whole lanes.
const SAMPLES: usize = (INTERVALS + 1).next_multiple_of(LANES);
/// The most steps towards an extreme from the parabola's, and the step in radians below which they end.
const STEPS: usize = 4;
const SMALL_STEP: f64 = 1e-7;

/// The joints at equidistant crank angles of an interval.
pub(super) struct Samples {
    kernel: Kernel,
    follower_pivot: Complex,
    /// The lengths b and c.
    links: [f64; 2],
    offset: Complex,
    crank: f64,
    from: f64,
    step: f64,
    /// The first and the last sample at which the loop closes.
    ends: [usize; 2],
    /// x and y of C, D and P; NaN if the loop does not close.
    joints: [[[f64; SAMPLES]; 2]; 3],
    /// The samples at which C, D and P have their least and greatest x and y.
    extremes: [[[usize; 2]; 2]; 3],
}

/// A position of the motion.
#[derive(Clone, Copy)]
pub(super) struct SweptPosition {
    pub(super) place: Place,
    frame: Frame,
    /// C, D, P.
    pub(super) joints: [Complex; 3],
}

impl<'a> Swept<'a> {
    /// Returns the joints over a motion; `None` if the shape is no linkage or closes nowhere.
    pub(super) fn of(shape: &'a Shape, motion: &Motion<'a>) -> Option<Swept<'a>> {
        match *motion {
            Motion::Positions(positions) => Some(Swept::Points { shape, positions }),
            Motion::Stretch(from, to, assembly) => {
                shape.linkage(assembly).ok()?;
                Samples::of(shape, (from, to), assembly).map(Swept::Samples)
            }
        }
    }

    /// Returns the position at which a joint (C, D, P) comes nearest to a side of a box around all positions; `None` if
    /// the loop closes nowhere.
    pub(super) fn extreme(&self, joint: usize, side: Side) -> Option<SweptPosition> {
        match self {
            Swept::Points { shape, positions } => extreme_point(shape, positions, joint, side),
            Swept::Samples(samples) => samples.extreme(joint, side),
        }
    }
}

/// Returns the position of a list at which a joint comes nearest to a side.
fn extreme_point(
    shape: &Shape,
    positions: &[[Complex; 2]],
    joint: usize,
    side: Side,
) -> Option<SweptPosition> {
    let value = |p: &SweptPosition| side.inwards(p.joints[joint]);
    let all = positions.iter().enumerate();
    all.map(|(j, p)| SweptPosition::of_directions(shape, p, Place::Position(j)))
        .min_by(|p, q| value(p).total_cmp(&value(q)))
}

/// Returns the samples with the least and the greatest value, the first of equal ones; NaN does not count.
#[inline(always)]
fn extremes(values: &[f64; SAMPLES]) -> [usize; 2] {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    let (mut low_at, mut high_at) = ([0.0; LANES], [0.0; LANES]);
    for (block, values) in values.chunks_exact(LANES).enumerate() {
        for lane in 0..LANES {
            let (value, place) = (values[lane], (block * LANES + lane) as f64);
            let (is_low, is_high) = (value < low[lane], value > high[lane]);
            low[lane] = if is_low { value } else { low[lane] };
            low_at[lane] = if is_low { place } else { low_at[lane] };
            high[lane] = if is_high { value } else { high[lane] };
            high_at[lane] = if is_high { place } else { high_at[lane] };
        }
    }
    let (mut least, mut greatest) = (0, 0);
    for lane in 1..LANES {
        let before =
            |value: f64, best: f64, at: f64, best_at: f64| value < best || (value == best && at < best_at);
        if before(low[lane], low[least], low_at[lane], low_at[least]) {
            least = lane;
        }
        if before(-high[lane], -high[greatest], high_at[lane], high_at[greatest]) {
            greatest = lane;
        }
    }
    [low_at[least] as usize, high_at[greatest] as usize]
}

impl Samples {
    /// Samples an interval of crank angles; `None` if the loop closes nowhere.
    fn of(shape: &Shape, (from, to): (f64, f64), assembly: AssemblyMode) -> Option<Samples> {
        let step = (to - from) / INTERVALS as f64;
        let mut samples = Samples {
            kernel: shape.kernel(assembly),
            follower_pivot: shape.follower_pivot,
            links: [shape.coupler, shape.follower],
            offset: shape.offset,
            crank: shape.crank,
            from,
            step,
            ends: [0, INTERVALS],
            joints: [[[f64::NAN; SAMPLES]; 2]; 3],
            extremes: [[[0; 2]; 2]; 3],
        };
        vectorised(
            #[inline(always)]
            || {
                samples.fill();
                for joint in 0..3 {
                    for axis in 0..2 {
                        samples.extremes[joint][axis] = extremes(&samples.joints[joint][axis]);
                    }
                }
            },
        );
        let closes = |i: &usize| !samples.joints[2][0][*i].is_nan();
        samples.ends = [(0..=INTERVALS).find(closes)?, (0..=INTERVALS).rfind(closes)?];
        Some(samples)
    }

    #[inline(always)]
    fn fill(&mut self) {
        // e^{i (from + k step)} by products: within a block of lanes, and from block to block.
        let one = Complex::from_polar(1.0, self.step);
        let mut power = Complex::from_polar(1.0, self.from);
        let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
        let mut block = Complex::new(1.0, 0.0);
        for lane in 0..LANES {
            (x[lane], y[lane]) = (power.re, power.im);
            power *= one;
            block *= one;
        }
        for first in (0..SAMPLES).step_by(LANES) {
            let mut at = self.kernel.at(F64x8(x), F64x8(y));
            for (lane, gap) in at.gap.0.iter_mut().enumerate() {
                // The samples beyond the last one only fill up the lanes.
                *gap = if first + lane <= INTERVALS { *gap } else { -1.0 };
            }
            let zero = F64x8::splat(0.0);
            for (joint, place) in [at.crank_pin, at.follower_pin, at.coupler_point].into_iter().enumerate() {
                for (axis, value) in place.into_iter().enumerate() {
                    let closed = at.gap.at_least(zero, value, F64x8::splat(f64::NAN));
                    closed.store(&mut self.joints[joint][axis], first);
                }
            }
            for lane in 0..LANES {
                (x[lane], y[lane]) =
                    (x[lane] * block.re - y[lane] * block.im, x[lane] * block.im + y[lane] * block.re);
            }
        }
    }

    /// Returns the value of a joint towards the inside of a side at a sample.
    fn value(&self, joint: usize, side: Side, sample: usize) -> f64 {
        side.sign() * self.joints[joint][side.axis()][sample]
    }

    /// Returns the sample at which a joint is nearest to a side.
    fn nearest(&self, joint: usize, side: Side) -> usize {
        let [least, greatest] = self.extremes[joint][side.axis()];
        if side.sign() > 0.0 { least } else { greatest }
    }

    /// Returns the crank angle of a sample.
    fn angle(&self, sample: usize) -> f64 {
        self.from + self.step * sample as f64
    }

    /// Returns the position at a sample.
    fn sample(&self, sample: usize) -> Option<SweptPosition> {
        let place = match sample {
            0 => Place::First,
            INTERVALS => Place::Last,
            _ => Place::Anywhere,
        };
        Some(SweptPosition { place, ..self.at(self.angle(sample))? })
    }

    /// Returns the position at a crank angle; `None` if the loop does not close.
    fn at(&self, angle: f64) -> Option<SweptPosition> {
        let (sin, cos) = angle.sin_cos();
        let at = self.kernel.at(cos, sin);
        if at.gap.is_nan() || at.gap < 0.0 {
            return None;
        }
        let [c, d, p] = [at.crank_pin, at.follower_pin, at.coupler_point].map(point);
        let frame = Frame {
            crank: Complex::new(cos, sin),
            coupler: (d - c) / self.links[0],
            follower: (d - self.follower_pivot) / self.links[1],
        };
        Some(SweptPosition { place: Place::Anywhere, frame, joints: [c, d, p] })
    }

    /// Returns the derivative of a joint's value towards the inside of a side by the crank angle; `None` at a toggle.
    fn slope(&self, position: &SweptPosition, joint: usize, side: Side) -> Option<f64> {
        let coupler = self.links[0];
        let offset = match joint {
            0 => return Some(side.inwards(turned(position.frame.crank) * self.crank)),
            1 => Complex::new(coupler, 0.0),
            _ => self.offset,
        };
        by_crank_angle(&position.frame, self.crank, coupler, offset).map(|by| side.inwards(by))
    }

    /// Returns the position at which a joint comes nearest to a side: from the extreme of the parabola through the nearest
    /// sample and its neighbours by steps of the secant method on the derivative.
    fn extreme(&self, joint: usize, side: Side) -> Option<SweptPosition> {
        let sample = self.nearest(joint, side);
        let [first, last] = self.ends;
        let step = self.step.abs();
        let (mut angle, mut curvature) = (self.angle(sample), 0.0);
        if first < sample && sample < last {
            let [l, m, r] = [sample - 1, sample, sample + 1].map(|i| self.value(joint, side, i));
            curvature = (l - 2.0 * m + r) / (step * step);
            if curvature > 0.0 {
                angle += (0.5 * (l - r) / (curvature * self.step)).clamp(-step, step);
            }
        }
        // At an end of the interval the extreme may be the end itself.
        let mut best = if curvature > 0.0 { None } else { self.sample(sample) };
        let [low, high] = [self.angle(sample.max(first + 1) - 1), self.angle((sample + 1).min(last))];
        let (low, high) = (low.min(high), low.max(high));
        let value = |p: &SweptPosition| side.inwards(p.joints[joint]);
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..STEPS {
            let Some(position) = self.at(angle) else { break };
            if best.as_ref().is_none_or(|best| value(&position) < value(best)) {
                best = Some(position);
            }
            let Some(slope) = self.slope(&position, joint, side) else { break };
            if let Some((other, by)) = before {
                let secant = (slope - by) / (angle - other);
                curvature = if secant > 0.0 { secant } else { curvature };
            }
            before = Some((angle, slope));
            // Without a curvature: half of the way to the neighbour down the slope.
            let towards = if slope > 0.0 { low } else { high };
            let next = if curvature > 0.0 { angle - slope / curvature } else { 0.5 * (angle + towards) };
            let next = next.clamp(low, high);
            if (next - angle).abs() <= SMALL_STEP {
                break;
            }
            angle = next;
        }
        best.or_else(|| self.sample(sample))
    }
}

impl SweptPosition {
    fn of_directions(shape: &Shape, [crank, coupler]: &[Complex; 2], place: Place) -> SweptPosition {
        let c = shape.crank_pivot + crank * shape.crank;
        let d = c + coupler * shape.coupler;
        SweptPosition {
            place,
            frame: Frame {
                crank: *crank,
                coupler: *coupler,
                follower: unit_vector(d - shape.follower_pivot),
            },
            joints: [c, d, c + coupler * shape.offset],
        }
    }

    /// Returns the derivative of a joint's coordinate inwards from a side, by the shape and by the crank angle.
    pub(super) fn derivative(&self, shape: &Shape, joint: usize, side: Side) -> ([f64; SHAPE], f64) {
        // C is the coupler point at offset 0, D the one at offset b (which grows with b).
        let offset = match joint {
            0 => Complex::new(0.0, 0.0),
            1 => Complex::new(shape.coupler, 0.0),
            _ => shape.offset,
        };
        let Some(gradient) = shape_gradient(&self.frame, shape.crank, shape.coupler, offset) else {
            return ([0.0; SHAPE], 0.0);
        };
        let mut row = gradient.shape.map(|z| side.inwards(z));
        match joint {
            0 => (row[7], row[8]) = (0.0, 0.0),
            1 => {
                row[5] += row[7];
                (row[7], row[8]) = (0.0, 0.0);
            }
            _ => {}
        }
        (row, side.inwards(gradient.crank_angle))
    }
}
