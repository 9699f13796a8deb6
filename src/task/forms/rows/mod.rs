//! Requirements on a linkage, as smooth constraint functions g(shape, motion) >= 0 in units of length.
//!
//! - type: with the shortest link s and the others p, q, l, "s is the shortest and the margin is positive"
//!   is the three linear conditions p + q - l - s >= 0, p + l - q - s >= 0, q + l - p - s >= 0;
//! - link ratio R: l_i - l_j / R >= 0 for all pairs;
//! - transmission angle: size (cos mu_min - cos mu) >= 0 and size (cos mu + cos mu_min) >= 0 at the extremes of
//!   the diagonal |CB|, cos mu = (b^2 + c^2 - s^2)/(2 b c);
//! - pivots on lines: the margin less the distance to either side of the line;
//! - pins: the distance of C and D from the boundary of their region, in the frame of the body;
//! - boxes: the distance to each side of the extreme joint, whose derivative is that of the joint at its
//!   extreme position (Danskin 1967);
//! - extent: the limit less the diagonal of the box of all joints, by its sides;
//! - longest link: L - l for each of ground, a, b, c, d and e;
//! - peak torque: size (1 - |T|/T_max) at the crank angle at which |T| is largest (Danskin 1967);
//! - derived bounds of the design space.
//!
//! Every g is aimed at with a small margin, so that a requirement that the search counts as met is met for the referee
//! too.

mod boxes;
mod derived;
pub(in crate::task::forms) mod diagonal;
mod extent_max;
mod footprint_in;
mod link_ratio;
mod linkage_type;
mod longest_max;
mod peak_torque;
mod pins_in;
mod pivot_on;
mod pivots_in;
mod swept;
mod transmission;

use super::design_space::{Derived, DerivedBound, SHAPE, Shape};
use crate::mechanism::{AssemblyMode, Complex, LinkageType, cross, length, unit_vector};
use crate::task::requirement::RequirementKind;
use crate::task::spec::{LoadsSpec, RequireSpec, TransmissionOver};

pub use linkage_type::nearest_type;

/// The margin aimed at inside the limits, in parts of the target's size.
const LENGTH_MARGIN: f64 = 1e-9;

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
    /// The sides in the order of their numbers.
    pub(in crate::task::forms) const ALL: [Side; 4] = [Side::XMin, Side::YMin, Side::XMax, Side::YMax];

    /// Returns the coordinate that the side limits (0: x, 1: y).
    pub(in crate::task::forms) fn axis(self) -> usize {
        self.index() % 2
    }

    /// Returns the sign of that coordinate's axis towards the inside of the box.
    pub(in crate::task::forms) fn sign(self) -> f64 {
        if self.index() < 2 { 1.0 } else { -1.0 }
    }

    /// Returns the component of a vector towards the inside of the box.
    pub(in crate::task::forms) fn inwards(self, z: Complex) -> f64 {
        self.sign() * if self.axis() == 0 { z.re } else { z.im }
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

/// The kind of a row: the limit that it keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowKind {
    /// A limit of a requirement.
    Limit {
        /// The requirement.
        of: RequirementKind,
        /// The side, if the limit is a box.
        side: Option<Side>,
        /// The change dg for one unit more of room.
        by_room: f64,
    },
    /// A derived bound's lower (`true`) or upper limit.
    Derived(Derived, bool),
}

impl RowKind {
    /// Returns the kind of a row that grows with the room.
    fn of(of: RequirementKind, side: Option<Side>) -> RowKind {
        RowKind::Limit { of, side, by_room: 1.0 }
    }
}

/// One requirement's value with its derivatives by the shape and by a turn of the crank.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The requirement that it belongs to.
    pub kind: RowKind,
    /// The value g, a length.
    pub value: f64,
    /// The derivatives dg/d(Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y).
    pub shape: [f64; SHAPE],
    /// The derivatives by a turn of the crank at the positions at which it is evaluated.
    pub turns: [Turn; MOST_TURNS],
    /// The derivative by the frame of the body, the angle from the coupler's direction to the body's x axis.
    pub by_frame: f64,
}

/// The most positions at which one requirement is evaluated: one for each side of a box.
pub const MOST_TURNS: usize = 4;

/// The derivative of a row by a turn of the crank at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The derivative dg/dphi.
    pub by: f64,
    /// The position.
    pub place: Place,
}

impl Turn {
    /// No dependence on the crank angle.
    const NONE: Turn = Turn { by: 0.0, place: Place::Anywhere };

    /// Returns the dependence on one position alone.
    fn at(place: Place, by: f64) -> [Turn; MOST_TURNS] {
        [Turn { by, place }, Turn::NONE, Turn::NONE, Turn::NONE]
    }
}

impl Row {
    /// Returns a row that does not depend on the motion.
    fn still(kind: RowKind, value: f64, shape: [f64; SHAPE]) -> Row {
        Row { kind, value, shape, turns: [Turn::NONE; MOST_TURNS], by_frame: 0.0 }
    }

    /// Returns the derivative dg/dphi by a turn of all crank angles together.
    pub fn by_turn(&self) -> f64 {
        self.turns.iter().fold(0.0, |sum, turn| sum + turn.by)
    }
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
    loads: Option<LoadsSpec>,
}

impl Requirements {
    /// Creates the requirements of a problem whose target has the given size.
    pub fn new(require: &RequireSpec, derived: &[DerivedBound], size: f64) -> Self {
        Requirements { size, require: require.clone(), derived: derived.to_vec(), loads: None }
    }

    /// Returns the requirements under the loads of a problem, which only that on the torque reads.
    #[must_use]
    pub fn under(mut self, loads: Option<&LoadsSpec>) -> Self {
        self.loads = loads.filter(|_| self.require.peak_torque_max.is_some()).cloned();
        self
    }

    /// Calls `each` for every requirement, always as many and in the same order for the same problem and the
    /// same `aim`, the type that is searched for (`None`: any). No allocation. Where the body of a motion lies is given by its
    /// `frame`, in radians; without it there are no rows of its pins.
    pub fn rows(
        &self,
        aim: Option<LinkageType>,
        shape: &Shape,
        motion: &Motion<'_>,
        frame: Option<f64>,
        each: &mut dyn FnMut(&Row),
    ) {
        let at = At::new(self, shape, motion);
        linkage_type::rows(&at, aim, each);
        link_ratio::rows(&at, each);
        derived::rows(&at, &self.derived, each);
        pivots_in::rows(&at, each);
        pivot_on::rows(&at, each);
        if let Some(frame) = frame {
            pins_in::rows(&at, frame, each);
        }
        transmission::rows(&at, each);
        footprint_in::rows(&at, each);
        extent_max::rows(&at, each);
        longest_max::rows(&at, each);
        peak_torque::rows(&at, each);
    }

    /// Returns whether a row depends on the motion, and not on the shape alone.
    pub fn depend_on_motion(&self) -> bool {
        let used = self.require.transmission_over != Some(TransmissionOver::Cycle);
        self.require.footprint_in.is_some()
            || self.loads.is_some()
            || self.require.extent_max.is_some()
            || (self.require.transmission_deg_min.is_some() && used)
    }

    /// Returns the total violation of the rows, in sizes of the target; 0 if all are met.
    pub fn lack(
        &self,
        aim: Option<LinkageType>,
        shape: &Shape,
        motion: &Motion<'_>,
        frame: Option<f64>,
    ) -> f64 {
        let mut lack = 0.0;
        self.rows(aim, shape, motion, frame, &mut |row| lack += (-row.value).max(0.0));
        lack / self.size
    }
}

/// A shape and its motion, with the derivatives of the links.
struct At<'a> {
    size: f64,
    require: &'a RequireSpec,
    loads: Option<&'a LoadsSpec>,
    shape: &'a Shape,
    motion: &'a Motion<'a>,
    /// The direction from A to B.
    ground: Complex,
    /// The lengths ground, a, b, c.
    links: [f64; 4],
    /// The derivative of the ground length by the shape.
    ground_row: [f64; SHAPE],
}

impl<'a> At<'a> {
    fn new(requirements: &'a Requirements, shape: &'a Shape, motion: &'a Motion<'a>) -> At<'a> {
        let g = unit_vector(shape.follower_pivot - shape.crank_pivot);
        At {
            size: requirements.size,
            require: &requirements.require,
            loads: requirements.loads.as_ref(),
            shape,
            motion,
            ground: g,
            links: shape.links(),
            ground_row: [-g.re, -g.im, g.re, g.im, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// Returns the margin aimed at inside a limit that is a length.
    fn margin(&self) -> f64 {
        LENGTH_MARGIN * self.size
    }

    /// Returns |CP| with its derivatives by the shape.
    fn crank_side(&self) -> (f64, [f64; SHAPE]) {
        let along = unit_vector(self.shape.offset);
        let mut row = [0.0; SHAPE];
        (row[7], row[8]) = (along.re, along.im);
        (length(self.shape.offset), row)
    }

    /// Returns |DP| with its derivatives by the shape.
    fn follower_side(&self) -> (f64, [f64; SHAPE]) {
        let from_d = self.shape.offset - self.shape.coupler;
        let along = unit_vector(from_d);
        let mut row = [0.0; SHAPE];
        (row[5], row[7], row[8]) = (-along.re, along.re, along.im);
        (length(from_d), row)
    }

    /// Returns the row constant + sum of factor times link.
    fn combined(&self, kind: RowKind, factors: [f64; 4], constant: f64) -> Row {
        let mut row = Row::still(kind, constant, [0.0; SHAPE]);
        for (factor, link) in factors.into_iter().zip(self.links) {
            row.value += factor * link;
        }
        let [ground, a, b, c] = factors;
        let by = self.ground_row;
        row.shape = [ground * by[0], ground * by[1], ground * by[2], ground * by[3], a, b, c, 0.0, 0.0];
        row
    }
}

/// Returns the assembly of a position given by directions: +1 if D lies left of C -> B, -1 if right of it.
pub fn assembly_of(shape: &Shape, crank: Complex, coupler: Complex) -> AssemblyMode {
    let c = shape.crank_pivot + crank * shape.crank;
    AssemblyMode::of(cross(shape.follower_pivot - c, coupler))
}
