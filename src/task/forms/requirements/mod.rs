//! Requirements on a linkage, as smooth constraint functions g(shape, motion) >= 0 in units of length.
//!
//! - type: with the shortest link s and the others p, q, l, "s is the shortest and the margin is positive"
//!   is the three linear conditions p + q - l - s >= 0, p + l - q - s >= 0, q + l - p - s >= 0;
//! - link ratio R: l_i - l_j / R >= 0 for all pairs;
//! - transmission angle: size (cos mu_min - cos mu) >= 0 and size (cos mu + cos mu_min) >= 0 at the extremes of
//!   the diagonal |CB|, cos mu = (b^2 + c^2 - s^2)/(2 b c);
//! - boxes: the distance to each side of the extreme joint, whose derivative is that of the joint at its
//!   extreme position (Danskin 1967);
//! - derived bounds of the design space.
//!
//! Every g is aimed at with a small margin, so that a requirement that the search counts as met is met for the referee
//! too.

mod swept;

use self::swept::Swept;
use super::design_space::{Derived, DerivedBound, SHAPE, Shape, unit};
use crate::mechanism::four_bar::mobility::{grashof_margin, linkage_type, wrapped};
use crate::mechanism::{AssemblyMode, Complex, LinkageType, cross, dot, length, turned};
use crate::task::spec::{RequireSpec, TransmissionOver};
use std::f64::consts::PI;

/// The margin aimed at inside the limits, in parts of the target's size.
const LENGTH_MARGIN: f64 = 1e-9;
/// The margin aimed at inside the Grashof boundary, in parts of the sum of the links: well beyond the
/// change-point tolerance.
const TYPE_MARGIN: f64 = 1e-7;
/// The margin aimed at inside angle limits, radians.
const ANGLE_MARGIN: f64 = 1e-9;

/// A side of a box [xmin, ymin, xmax, ymax].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The least x.
    XMin,
    /// The least y.
    YMin,
    /// The greatest x.
    XMax,
    /// The greatest y.
    YMax,
}

impl Side {
    /// Returns the side of a box at which a coordinate (0: x, 1: y) has its lower or its upper limit.
    fn of(axis: usize, lower: bool) -> Side {
        match (axis, lower) {
            (0, true) => Side::XMin,
            (0, false) => Side::XMax,
            (_, true) => Side::YMin,
            (_, false) => Side::YMax,
        }
    }

    /// Returns its index in [xmin, ymin, xmax, ymax].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns xmin, ymin, xmax or ymax.
    pub fn name(self) -> &'static str {
        ["xmin", "ymin", "xmax", "ymax"][self.index()]
    }
}

/// The kind of a row: its requirement and the side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowKind {
    /// The type aimed at: g is a Grashof margin.
    Type,
    /// The longest over the shortest link: g = l_i - l_j / R. Carries l_j, the longer one.
    LinkRatio(f64),
    /// A derived bound's lower (`true`) or upper limit.
    Derived(Derived, bool),
    /// A side of the pivots' box.
    Pivots(Side),
    /// The transmission angle.
    Transmission,
    /// A side of the footprint.
    Footprint(Side),
}

/// One requirement's value with its derivatives by the shape and by a turn of all crank angles.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The requirement that it belongs to.
    pub kind: RowKind,
    /// The value g, a length.
    pub value: f64,
    /// The derivatives dg/d(Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y).
    pub shape: [f64; SHAPE],
    /// The derivative dg/dphi by a turn of all crank angles together.
    pub crank: f64,
    /// The position at which it is evaluated.
    pub place: Place,
}

/// The position of a motion at which a requirement is evaluated: the one where it is tightest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// No particular position, or an extreme inside an interval, which does not move with the crank angle to first
    /// order.
    Anywhere,
    /// The crank angle at which an interval begins.
    First,
    /// The crank angle at which an interval ends.
    Last,
    /// The index of a position in a list, counted from 0.
    Position(usize),
}

/// The motion over which a requirement is evaluated.
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a> {
    /// The interval of crank angles from the first to the second, in radians, on one assembly.
    Stretch(f64, f64, AssemblyMode),
    /// Positions (crank, coupler direction) at the points; the motion between them is not known.
    Positions(&'a [[Complex; 2]]),
}

/// The requirements of a problem as constraint rows for the search.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// The target's size.
    size: f64,
    require: RequireSpec,
    derived: Vec<DerivedBound>,
}

impl Requirements {
    /// Creates the requirements of a problem whose target has the given size.
    pub fn new(require: &RequireSpec, derived: &[DerivedBound], size: f64) -> Self {
        Requirements { size, require: require.clone(), derived: derived.to_vec() }
    }

    /// Calls `each` for every requirement, always as many and in the same order for the same problem and the
    /// same `aim`, the type that is searched for (`None`: any). No allocation.
    pub fn rows(
        &self,
        aim: Option<LinkageType>,
        shape: &Shape,
        motion: &Motion<'_>,
        each: &mut dyn FnMut(&Row),
    ) {
        let ground = shape.follower_pivot - shape.crank_pivot;
        let g = unit(ground);
        // d(links)/d(shape): ground, a, b, c
        let link_rows: [[f64; SHAPE]; 4] = [
            [-g.re, -g.im, g.re, g.im, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        ];
        let links = shape.links();
        let combine = |kind: RowKind, factors: [f64; 4], constant: f64| {
            let mut row =
                Row { kind, value: constant, shape: [0.0; SHAPE], crank: 0.0, place: Place::Anywhere };
            for (link, factor) in factors.into_iter().enumerate() {
                row.value += factor * links[link];
                for (out, by) in row.shape.iter_mut().zip(&link_rows[link]) {
                    *out += factor * by;
                }
            }
            row
        };
        type_rows(aim, links, &combine, each);
        let ratio = self.require.link_ratio_max;
        for i in 0..4 {
            for j in 0..4 {
                if i != j {
                    let mut factors = [0.0; 4];
                    factors[i] = 1.0;
                    factors[j] = -1.0 / (ratio * (1.0 - LENGTH_MARGIN));
                    each(&combine(RowKind::LinkRatio(links[j]), factors, 0.0));
                }
            }
        }
        self.derived_rows(shape, links, &link_rows, each);
        if let Some(b) = self.require.pivots_in {
            for (at, p) in [(0, shape.crank_pivot), (2, shape.follower_pivot)] {
                self.box_rows(
                    b,
                    p,
                    RowKind::Pivots,
                    &|axis, sign| {
                        let mut row = [0.0; SHAPE];
                        row[at + axis] = sign;
                        (row, 0.0)
                    },
                    each,
                );
            }
        }
        if let Some(limit) = self.require.transmission_deg_min {
            self.transmission_rows(limit.to_radians() + ANGLE_MARGIN, shape, links, g, motion, each);
        }
        if let Some(b) = self.require.footprint_in {
            self.footprint_rows(b, shape, motion, each);
        }
    }

    /// Returns whether a row depends on the motion, and not on the shape alone.
    pub fn depend_on_motion(&self) -> bool {
        let used = self.require.transmission_over != Some(TransmissionOver::Cycle);
        self.require.footprint_in.is_some() || (self.require.transmission_deg_min.is_some() && used)
    }

    /// Returns the total violation of the rows, in sizes of the target; 0 if all are met.
    pub fn lack(&self, aim: Option<LinkageType>, shape: &Shape, motion: &Motion<'_>) -> f64 {
        let mut lack = 0.0;
        self.rows(aim, shape, motion, &mut |row| lack += (-row.value).max(0.0));
        lack / self.size
    }

    fn derived_rows(
        &self,
        shape: &Shape,
        links: [f64; 4],
        link_rows: &[[f64; SHAPE]; 4],
        each: &mut dyn FnMut(&Row),
    ) {
        let margin = LENGTH_MARGIN * self.size;
        for bound in &self.derived {
            let (low, high) = (bound.limits.0, bound.limits.1);
            let kind = |lower| RowKind::Derived(bound.quantity, lower);
            let mut row = [0.0; SHAPE];
            let value = match bound.quantity {
                Derived::Ground => {
                    row = link_rows[0];
                    links[0]
                }
                Derived::GroundAngle => {
                    let ground = shape.follower_pivot - shape.crank_pivot;
                    let across = turned(unit(ground));
                    let middle = 0.5 * (low + high);
                    let value = wrapped(ground.arg() - middle) * self.size;
                    let scale = self.size / links[0].max(f64::MIN_POSITIVE);
                    (row[0], row[1]) = (-across.re * scale, -across.im * scale);
                    (row[2], row[3]) = (across.re * scale, across.im * scale);
                    let half = 0.5 * (high - low) * self.size;
                    for sign in [1.0, -1.0] {
                        each(&Row {
                            kind: kind(sign < 0.0),
                            value: half - sign * value,
                            shape: row.map(|by| -sign * by),
                            crank: 0.0,
                            place: Place::Anywhere,
                        });
                    }
                    continue;
                }
                Derived::CrankSide => {
                    let along = unit(shape.offset);
                    (row[7], row[8]) = (along.re, along.im);
                    length(shape.offset)
                }
                Derived::FollowerSide => {
                    let from_d = shape.offset - shape.coupler;
                    let along = unit(from_d);
                    (row[5], row[7], row[8]) = (-along.re, along.re, along.im);
                    length(from_d)
                }
            };
            let margin = if low == high { 0.0 } else { margin };
            let (crank, place) = (0.0, Place::Anywhere);
            each(&Row { kind: kind(true), value: value - low - margin, shape: row, crank, place });
            each(&Row {
                kind: kind(false),
                value: high - value - margin,
                shape: row.map(|by| -by),
                crank,
                place,
            });
        }
    }

    fn box_rows(
        &self,
        b: [f64; 4],
        p: Complex,
        kind: fn(Side) -> RowKind,
        derivative: &dyn Fn(usize, f64) -> ([f64; SHAPE], f64),
        each: &mut dyn FnMut(&Row),
    ) {
        let margin = LENGTH_MARGIN * self.size;
        for (axis, at) in [(0, p.re), (1, p.im)] {
            for (limit, sign) in [(b[axis], 1.0), (b[axis + 2], -1.0)] {
                let (shape, crank) = derivative(axis, sign);
                let kind = kind(Side::of(axis, sign > 0.0));
                let place = Place::Anywhere;
                each(&Row { kind, value: sign * (at - limit) - margin, shape, crank, place });
            }
        }
    }

    /// Adds the rows of the transmission angle, at the diagonals at which it is extreme: s^2 with its derivatives.
    fn transmission_rows(
        &self,
        limit: f64,
        shape: &Shape,
        links: [f64; 4],
        g: Complex,
        motion: &Motion<'_>,
        each: &mut dyn FnMut(&Row),
    ) {
        let [ground, a, b, c] = links;
        let turns = linkage_type(links).is_some_and(LinkageType::input_turns_fully);
        let over = self.require.transmission_over.unwrap_or(if turns {
            TransmissionOver::Cycle
        } else {
            TransmissionOver::Used
        });
        // (s, ds by ground and a, or by the shape at a crank angle, that angle)
        let aligned = |sign: f64| {
            let s = ground + sign * a;
            let mut row = [0.0; SHAPE];
            let flip = s.signum();
            (row[0], row[1], row[2], row[3]) = (-g.re * flip, -g.im * flip, g.re * flip, g.im * flip);
            row[4] = sign * flip;
            (s.abs(), row, 0.0, Place::Anywhere)
        };
        let at = |crank: Complex, place: Place| {
            let v = shape.follower_pivot - shape.crank_pivot - crank * a;
            let along = unit(v);
            let mut row = [0.0; SHAPE];
            (row[0], row[1], row[2], row[3]) = (-along.re, -along.im, along.re, along.im);
            row[4] = -dot(along, crank);
            (length(v), row, -dot(along, turned(crank)) * a, place)
        };
        let extremes = match (over, motion) {
            (TransmissionOver::Cycle, _) => [aligned(-1.0), aligned(1.0)],
            (TransmissionOver::Used, Motion::Positions(positions)) => {
                let mut found = [at(positions[0][0], Place::Position(0)); 2];
                for (j, p) in positions.iter().enumerate() {
                    let s = at(p[0], Place::Position(j));
                    if s.0 < found[0].0 {
                        found[0] = s;
                    }
                    if s.0 > found[1].0 {
                        found[1] = s;
                    }
                }
                found
            }
            (TransmissionOver::Used, Motion::Stretch(from, to, _)) => {
                let (low, high) = (from.min(*to), from.max(*to));
                let (first, last) = (
                    at(Complex::from_polar(1.0, low), Place::First),
                    at(Complex::from_polar(1.0, high), Place::Last),
                );
                let (mut least, mut greatest) = if first.0 < last.0 { (first, last) } else { (last, first) };
                let holds = |angle: f64| (angle - low).rem_euclid(2.0 * PI) <= high - low;
                if holds(g.arg()) {
                    least = aligned(-1.0);
                }
                if holds(g.arg() + PI) {
                    greatest = aligned(1.0);
                }
                [least, greatest]
            }
        };
        for (sign, (s, by, by_crank, place)) in [1.0, -1.0].into_iter().zip(extremes) {
            // least s: cos mu <= cos limit; greatest s: cos mu >= -cos limit
            let cos = (b * b + c * c - s * s) / (2.0 * b * c);
            let mut row = Row {
                kind: RowKind::Transmission,
                value: self.size * (limit.cos() - sign * cos),
                shape: by.map(|d| self.size * sign * s / (b * c) * d),
                crank: self.size * sign * s / (b * c) * by_crank,
                place,
            };
            row.shape[5] -= self.size * sign * (1.0 / c - cos / b);
            row.shape[6] -= self.size * sign * (1.0 / b - cos / c);
            each(&row);
        }
    }

    fn footprint_rows(&self, b: [f64; 4], shape: &Shape, motion: &Motion<'_>, each: &mut dyn FnMut(&Row)) {
        for (at, p) in [(0, shape.crank_pivot), (2, shape.follower_pivot)] {
            self.box_rows(
                b,
                p,
                RowKind::Footprint,
                &|axis, sign| {
                    let mut row = [0.0; SHAPE];
                    row[at + axis] = sign;
                    (row, 0.0)
                },
                each,
            );
        }
        let margin = LENGTH_MARGIN * self.size;
        let positions = Swept::of(shape, motion);
        for joint in 0..3 {
            for (axis, limit, sign) in [(0, b[0], 1.0), (1, b[1], 1.0), (0, b[2], -1.0), (1, b[3], -1.0)] {
                let kind = RowKind::Footprint(Side::of(axis, sign > 0.0));
                let row = positions.as_ref().and_then(|swept| {
                    let extreme = swept.extreme(joint, axis, sign)?;
                    let (shape_row, crank) = extreme.derivative(shape, joint, axis, sign);
                    let at = if axis == 0 { extreme.joints[joint].re } else { extreme.joints[joint].im };
                    let value = sign * (at - limit) - margin;
                    Some(Row { kind, value, shape: shape_row, crank, place: extreme.place })
                });
                // A linkage without any position has no footprint: its violation is the target's size.
                let nowhere = Place::Anywhere;
                let lacking =
                    Row { kind, value: -self.size, shape: [0.0; SHAPE], crank: 0.0, place: nowhere };
                each(&row.unwrap_or(lacking));
            }
        }
    }
}

fn type_rows(
    aim: Option<LinkageType>,
    links: [f64; 4],
    combine: &dyn Fn(RowKind, [f64; 4], f64) -> Row,
    each: &mut dyn FnMut(&Row),
) {
    let margin = TYPE_MARGIN * links.iter().sum::<f64>();
    let shortest = match aim {
        Some(LinkageType::DoubleCrank) => 0,
        Some(LinkageType::CrankRocker) => 1,
        Some(LinkageType::DoubleRocker) => 2,
        Some(LinkageType::RockerCrank) => 3,
        Some(LinkageType::TripleRocker) => {
            // l + s - p - q >= 0 with the links as they are now, and l <= the others together.
            let mut order = [0, 1, 2, 3];
            order.sort_by(|&i, &j| links[i].total_cmp(&links[j]));
            let mut factors = [0.0; 4];
            for (place, sign) in [(0, 1.0), (1, -1.0), (2, -1.0), (3, 1.0)] {
                factors[order[place]] = sign;
            }
            each(&combine(RowKind::Type, factors, -margin));
            let mut closes = [1.0; 4];
            closes[order[3]] = -1.0;
            each(&combine(RowKind::Type, closes, -margin));
            return;
        }
        Some(LinkageType::ChangePoint) => {
            // The margin is zero: both inequalities, without slack.
            let mut order = [0, 1, 2, 3];
            order.sort_by(|&i, &j| links[i].total_cmp(&links[j]));
            let mut factors = [0.0; 4];
            for (place, sign) in [(0, -1.0), (1, 1.0), (2, 1.0), (3, -1.0)] {
                factors[order[place]] = sign;
            }
            each(&combine(RowKind::Type, factors, 0.0));
            each(&combine(RowKind::Type, factors.map(|f| -f), 0.0));
            return;
        }
        None => return,
    };
    for other in (0..4).filter(|&i| i != shortest) {
        let mut factors = [1.0; 4];
        factors[shortest] = -1.0;
        factors[other] = -1.0;
        each(&combine(RowKind::Type, factors, -margin));
    }
}

/// Returns the allowed type that a shape is nearest to: its own if that is allowed.
pub fn nearest_type(links: [f64; 4], allowed: &[LinkageType]) -> Option<LinkageType> {
    let own = linkage_type(links)?;
    if allowed.is_empty() || allowed.contains(&own) {
        return Some(own);
    }
    let shortest = |t: &LinkageType| match t {
        LinkageType::DoubleCrank => links[0],
        LinkageType::CrankRocker => links[1],
        LinkageType::DoubleRocker => links[2],
        LinkageType::RockerCrank => links[3],
        LinkageType::TripleRocker | LinkageType::ChangePoint => grashof_margin(links).abs(),
    };
    allowed.iter().copied().min_by(|s, t| shortest(s).total_cmp(&shortest(t)))
}

/// Returns the assembly of a position given by directions: +1 if D lies left of C -> B, -1 if right of it.
pub fn assembly_of(shape: &Shape, crank: Complex, coupler: Complex) -> AssemblyMode {
    let c = shape.crank_pivot + crank * shape.crank;
    AssemblyMode::of(cross(shape.follower_pivot - c, coupler))
}
