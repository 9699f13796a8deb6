//! The limits of a linkage with a slider: bounds of its unknowns, and inequalities of its requirements.
//!
//! A crank that turns fully, with the transmission angle of at least mu over the turn, cos mu = k (k = 1: it only turns):
//!
//! ```text
//! slider-crank            k b - a -+ h0 >= 0                  h0 = Im(A conj s) - q
//! inverted slider-crank   k |(|AB| - a)| -+ h >= 0
//! ```
//!
//! Otherwise the same at each point: k b -+ (Im(C conj s) - q) >= 0, k |B - C| -+ h >= 0; and where one branch is required,
//! t1 <u, s> b >= 0 or t1 <B - C, u> >= 0 there.

use super::ends;
use super::regions::Regions;
use super::shape::{Closure, FRAME, OFFSET, SHAPE, SliderShape, UNKNOWNS};
use super::sides::Sides;
use super::swept::BoxLimits;
use crate::mechanism::{AssemblyMode, Complex, LinkageKind, cross, dot, turned};
use crate::numbers::optimise::levenberg_marquardt::MOST_OWN;
use crate::task::spec::{DEFAULT_REACH, DEFAULT_SHORTEST, DesignSpec, Limits, TransmissionOver};
use crate::task::{Problem, region::Region};
use std::f64::consts::PI;

/// The margin, in sizes of the target, inside a limit at which a fit aims.
pub(super) const MARGIN: f64 = 2e-9;

/// An inequality: its value, which is at least zero where it holds, and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// The value.
    pub value: f64,
    /// Its derivatives by the unknowns of the linkage, with the positions held.
    pub by_shape: [f64; SHAPE],
    /// Its derivative by the frame of the body.
    pub by_frame: f64,
    /// The points on whose positions it depends, with its derivatives by the angles of crank and coupler there.
    pub at: [Option<(usize, [f64; 2])>; MOST_OWN],
}

impl Bar {
    /// Returns an inequality that depends on the unknowns of the linkage alone.
    pub(super) fn still(value: f64, by_shape: [f64; SHAPE]) -> Bar {
        Bar { value, by_shape, by_frame: 0.0, at: [None; MOST_OWN] }
    }

    /// Returns an inequality that depends on the position of a point too.
    fn moving(value: f64, by_shape: [f64; SHAPE], at: (usize, [f64; 2])) -> Bar {
        let mut bar = Bar::still(value, by_shape);
        bar.at[0] = Some(at);
        bar
    }
}

/// The limits of a fit, in units of the target's size around its centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Limited {
    /// The bounds of the unknowns.
    pub bounds: [(f64, f64); UNKNOWNS],
    /// Whether the crank is to turn fully.
    pub turns: bool,
    /// Whether nothing but a crank that turns fully is acceptable.
    pub must_turn: bool,
    /// The cosine of the least transmission angle, if one is asked for.
    cosine: Option<f64>,
    /// Whether it is asked for over the motion used, whatever the crank does.
    over_used: bool,
    /// The bounds of the stroke and of the time ratio of a slider-crank.
    stroke: Option<[f64; 2]>,
    time_ratio: Option<[f64; 2]>,
    link_ratio: Option<f64>,
    longest: Option<f64>,
    /// Whether the motion is to stay on one branch.
    one_branch: bool,
    /// Middle and half widths of the box that the line passes, if one is given.
    line: Option<[Complex; 2]>,
    regions: Regions,
    /// The sides of the coupler and the ground.
    sides: Sides,
    /// The box of all joints over the motion.
    swept: BoxLimits,
}

fn clipped(limits: Option<Limits>, default: [f64; 2], shift: f64, size: f64) -> (f64, f64) {
    limits.map_or((default[0], default[1]), |Limits(low, high)| ((low - shift) / size, (high - shift) / size))
}

impl Limited {
    /// Returns the limits of a problem for a kind of linkage, seen from `centre` in units of `size`.
    pub fn of(problem: &Problem, kind: LinkageKind, centre: Complex, size: f64) -> Limited {
        let (design, require) = (&problem.spec().design, &problem.spec().require);
        let infinite = (f64::NEG_INFINITY, f64::INFINITY);
        let mut bounds = [infinite; UNKNOWNS];
        let around = [-DEFAULT_REACH, DEFAULT_REACH];
        let pivot = |pivot: Option<[Limits; 2]>, axis: usize| {
            let middle = [centre.re, centre.im][axis];
            let (mut low, mut high) = clipped(pivot.map(|p| p[axis]), around, middle, size);
            if let Some(corners) = require.pivots_in.as_ref().map(Region::corners) {
                low = low.max((corners[axis] - middle) / size);
                high = high.min((corners[axis + 2] - middle) / size);
            }
            (low, high.max(low))
        };
        let DesignSpec { crank_pivot, follower_pivot, a, b, coupler_x, coupler_y, d, .. } = design;
        let longest = require.longest_max.map(|most| most / size);
        let length = |limits: &Option<Limits>| {
            let (low, high) = clipped(*limits, [DEFAULT_SHORTEST, DEFAULT_REACH], 0.0, size);
            (low, longest.map_or(high, |longest| high.min(longest)).max(low))
        };
        (bounds[0], bounds[1]) = (pivot(*crank_pivot, 0), pivot(*crank_pivot, 1));
        bounds[2] = length(a);
        match kind {
            LinkageKind::FourBar | LinkageKind::SixBar | LinkageKind::EightBar => {}
            LinkageKind::SliderCrank => {
                bounds[3] = length(b);
                bounds[4] = (-DEFAULT_REACH, DEFAULT_REACH);
                bounds[5] = design
                    .line_deg
                    .map_or(infinite, |Limits(low, high)| (low.to_radians(), high.to_radians()));
            }
            LinkageKind::InvertedSliderCrank => {
                (bounds[3], bounds[4]) = (pivot(*follower_pivot, 0), pivot(*follower_pivot, 1));
                bounds[5] = (-DEFAULT_REACH, DEFAULT_REACH);
            }
        }
        let reach = d.map_or(DEFAULT_REACH, |d| d.1 / size);
        bounds[6] = clipped(*coupler_x, [-reach, reach], 0.0, size);
        bounds[7] = clipped(*coupler_y, [-reach, reach], 0.0, size);
        if !problem.offset_is_free() {
            bounds[OFFSET] = (0.0, 0.0);
        }
        if problem.task().body().is_none_or(|body| body.given_frame(0.0).is_some()) {
            bounds[FRAME] = (0.0, 0.0);
        }
        if problem.is_function() {
            // The coupler carries no point.
            (bounds[6], bounds[7]) = ((0.0, 0.0), (0.0, 0.0));
        }
        let must_turn = problem.has_to_turn();
        Limited {
            bounds,
            turns: must_turn,
            must_turn,
            cosine: require.transmission_deg_min.map(|deg| deg.to_radians().cos()),
            over_used: require.transmission_over == Some(TransmissionOver::Used),
            stroke: require
                .stroke
                .filter(|_| kind == LinkageKind::SliderCrank)
                .map(|limits| [limits.0 / size, limits.1 / size]),
            time_ratio: require.time_ratio.filter(|_| kind == LinkageKind::SliderCrank).map(|l| [l.0, l.1]),
            link_ratio: Some(require.link_ratio_max).filter(|ratio| ratio.is_finite()),
            longest,
            one_branch: !problem.branch_any(),
            regions: Regions::of(require, centre, size),
            sides: Sides::of(design, size),
            swept: BoxLimits {
                footprint: require.footprint_in.map(|[x0, y0, x1, y1]| {
                    let shifted = |value: f64, middle: f64| (value - middle) / size;
                    [
                        shifted(x0, centre.re),
                        shifted(y0, centre.im),
                        shifted(x1, centre.re),
                        shifted(y1, centre.im),
                    ]
                }),
                extent: require.extent_max.map(|most| most / size),
                whole: problem.task().closed() || problem.task().repeats_first(),
            },
            line: design.line_point.map(|[x, y]| {
                let low = (Complex::new(x.0, y.0) - centre) / size;
                let high = (Complex::new(x.1, y.1) - centre) / size;
                [0.5 * (low + high), 0.5 * (high - low)]
            }),
        }
    }

    /// Returns the direction of a line that is nearest to its bounds, among those by half turns, and whether it points the
    /// other way.
    pub fn line_angle(&self, angle: f64) -> (f64, bool) {
        let (low, high) = self.bounds[5];
        if !(low.is_finite() && high.is_finite()) {
            return (angle, false);
        }
        let halves = ((0.5 * (low + high) - angle) / PI).round();
        (angle + PI * halves, halves.rem_euclid(2.0) == 1.0)
    }

    /// Returns the same limits for a crank that is to turn fully, or that need not.
    #[must_use]
    pub fn turning(&self, turns: bool) -> Limited {
        Limited { turns: turns || self.must_turn, ..self.clone() }
    }

    /// Passes every inequality to `each`, always the same number and in the same order for `points` points; `frame` is that of
    /// a motion's body.
    pub fn each(
        &self,
        shape: &SliderShape,
        frame: f64,
        positions: &[[Complex; 2]],
        points: usize,
        each: &mut dyn FnMut(Bar),
    ) {
        let of_turn = self.cosine.filter(|_| self.turns && !self.over_used);
        if self.turns {
            full_turn(shape, of_turn.unwrap_or(1.0), each);
        }
        if self.stroke.is_some() || self.time_ratio.is_some() {
            ends::each(shape, self.stroke, self.time_ratio, each);
        }
        if let Some(cosine) = self.cosine.filter(|_| of_turn.is_none()) {
            for j in 0..points {
                match positions.get(j) {
                    Some(position) => transmission(shape, cosine, (j, *position), each),
                    None => (0..2).for_each(|_| each(Bar::still(0.0, [0.0; SHAPE]))),
                }
            }
        }
        if self.one_branch && !self.turns {
            let first = positions.first().map(|position| shape.assembly_of(*position));
            for j in 0..points {
                each(match (positions.get(j), first) {
                    (Some(position), Some(first)) => branch(shape, first, (j, *position)),
                    _ => Bar::still(0.0, [0.0; SHAPE]),
                });
            }
        }
        self.lengths(shape, each);
        self.sides.each(shape, each);
        self.regions.each(shape, frame, each);
        self.swept.each(shape, self.turns, positions, each);
        if let (Some([middle, half]), Closure::Line { height, direction: s, .. }) = (self.line, shape.closure)
        {
            // The box reaches so far across the line, with its derivative by the line's angle.
            let reach = half.re * s.im.abs() + half.im * s.re.abs();
            let by_reach = half.re * s.re * s.im.signum() - half.im * s.im * s.re.signum();
            let (away, by_away) = (cross(s, middle) - height, -dot(s, middle));
            for side in [1.0, -1.0] {
                let mut by_shape = [0.0; SHAPE];
                by_shape[4] = side;
                by_shape[5] = by_reach - side * by_away;
                each(Bar::still(reach - side * away, by_shape));
            }
        }
    }

    fn lengths(&self, shape: &SliderShape, each: &mut dyn FnMut(Bar)) {
        // The other link of the ratio, with its derivatives.
        let (other, by_other) = match shape.closure {
            Closure::Line { coupler, .. } => (coupler, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
            Closure::Block { pivot, .. } => {
                let ground = pivot - shape.crank_pivot;
                let g = ground.norm().max(f64::MIN_POSITIVE);
                let (x, y) = (ground.re / g, ground.im / g);
                (g, [-x, -y, 0.0, x, y, 0.0, 0.0, 0.0])
            }
        };
        if let Some(ratio) = self.link_ratio {
            let mut by = by_other.map(|by| ratio * by);
            by[2] -= 1.0;
            each(Bar::still(ratio * other - shape.crank - MARGIN, by));
            let mut by = by_other.map(|by| -by);
            by[2] += ratio;
            each(Bar::still(ratio * shape.crank - other - MARGIN, by));
        }
        if let Some(longest) = self.longest {
            let away = |from: f64| {
                let z = shape.offset - from;
                let length = z.norm().max(f64::MIN_POSITIVE);
                (longest - length - MARGIN, [z.re / length, z.im / length])
            };
            let (value, [x, y]) = away(0.0);
            each(Bar::still(value, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -x, -y]));
            match shape.closure {
                Closure::Line { coupler, .. } => {
                    let (value, [x, y]) = away(coupler);
                    each(Bar::still(value, [0.0, 0.0, 0.0, x, 0.0, 0.0, -x, -y]));
                }
                Closure::Block { .. } => each(Bar::still(longest - other - MARGIN, by_other.map(|by| -by))),
            }
        }
    }
}

/// Passes the two inequalities of a full turn with the cosine k of the least transmission angle.
fn full_turn(shape: &SliderShape, k: f64, each: &mut dyn FnMut(Bar)) {
    for side in [1.0, -1.0] {
        let (value, by_shape) = match shape.closure {
            Closure::Line { coupler, height, direction: s } => {
                let h0 = cross(s, shape.crank_pivot) - height;
                let by_angle = dot(shape.crank_pivot, s);
                let by = [side * s.im, -side * s.re, -1.0, k, side, side * by_angle, 0.0, 0.0];
                (k * coupler - shape.crank - side * h0, by)
            }
            Closure::Block { pivot, offset } => {
                let ground = pivot - shape.crank_pivot;
                let g = ground.norm().max(f64::MIN_POSITIVE);
                let far = if g >= shape.crank { k } else { -k };
                let (x, y) = (far * ground.re / g, far * ground.im / g);
                let by = [-x, -y, -far, x, y, -side, 0.0, 0.0];
                (far * (g - shape.crank) - side * offset, by)
            }
        };
        each(Bar::still(value - MARGIN, by_shape));
    }
}

/// Passes the two inequalities of the transmission angle at a point.
fn transmission(shape: &SliderShape, k: f64, (j, [e, _]): (usize, [Complex; 2]), each: &mut dyn FnMut(Bar)) {
    let c = shape.crank_pivot + e * shape.crank;
    for side in [1.0, -1.0] {
        let (value, by_shape, by_crank) = match shape.closure {
            Closure::Line { coupler, height, direction: s } => {
                let away = cross(s, c) - height;
                let by =
                    [side * s.im, -side * s.re, -side * cross(s, e), k, side, side * dot(c, s), 0.0, 0.0];
                (k * coupler - side * away, by, -side * shape.crank * dot(e, s))
            }
            Closure::Block { pivot, offset } => {
                let v = pivot - c;
                let length = v.norm().max(f64::MIN_POSITIVE);
                let v = v * (k / length);
                let by = [-v.re, -v.im, -dot(e, v), v.re, v.im, -side, 0.0, 0.0];
                (k * length - side * offset, by, -shape.crank * dot(turned(e), v))
            }
        };
        each(Bar::moving(value - MARGIN, by_shape, (j, [by_crank, 0.0])));
    }
}

/// Returns the inequality that holds a point on the branch of an assembly.
fn branch(shape: &SliderShape, assembly: AssemblyMode, (j, [e, u]): (usize, [Complex; 2])) -> Bar {
    let sign = assembly.sign();
    let (value, by_shape, by_angles) = match shape.closure {
        Closure::Line { coupler, direction: s, .. } => {
            let (along, across) = (dot(u, s), cross(s, u));
            let by = [0.0, 0.0, 0.0, along, 0.0, coupler * across, 0.0, 0.0];
            (coupler * along, by, [0.0, -coupler * across])
        }
        Closure::Block { pivot, .. } => {
            let v = pivot - shape.crank_pivot - e * shape.crank;
            let by = [-u.re, -u.im, -dot(e, u), u.re, u.im, 0.0, 0.0, 0.0];
            (dot(v, u), by, [-shape.crank * dot(turned(e), u), dot(v, turned(u))])
        }
    };
    let at = (j, by_angles.map(|by| sign * by));
    Bar::moving(sign * value - MARGIN, by_shape.map(|by| sign * by), at)
}
