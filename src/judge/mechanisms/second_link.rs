//! The second link of a closure, beside the crank: what it is in a linkage, and what in a real solution.
//!
//! The frame of a solution has its origin at P_0, the coupler point at the first place, and the scale of its target for a unit.

use super::{four_bar, inverted_slider_crank, slider_crank};
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, LoopJoints};
use crate::numbers::nine_point::target::{Closure, STEPS, Solution, Target};

/// The length, relative to the span, up to which a link counts as having none: its length is rounding.
pub const NO_LENGTH: f64 = 1e-9;

/// A real solution: the unknowns that are left if the starred twins are the conjugates. Its first link is the crank.
#[derive(Clone, Copy, Debug)]
pub struct Real {
    /// The moving pins x, y at the first place.
    pub pins: [Complex; 2],
    /// The ground pivots a of x and b of y.
    pub grounds: [Complex; 2],
    /// The rotations of the coupler from the first place.
    pub rotations: [Complex; STEPS],
}

impl Real {
    /// Takes the mean of each unknown and the conjugate of its twin, and scales the rotations to modulus one.
    pub fn of(solution: &Solution) -> Real {
        let mean =
            |z: [Complex; 2], twin: [Complex; 2]| std::array::from_fn(|i| (z[i] + twin[i].conj()) * 0.5);
        Real {
            pins: mean(solution.pins, solution.pins_starred),
            grounds: mean(solution.grounds, solution.grounds_starred),
            rotations: solution.rotations.map(|t| t / t.norm()),
        }
    }

    /// Takes the unknowns of a refined solution as they are, without their twins: the bounds of a proof are those of each.
    pub fn refined(solution: &Solution) -> Real {
        Real { pins: solution.pins, grounds: solution.grounds, rotations: solution.rotations }
    }

    /// Returns the same linkage with the other link driven.
    pub fn swapped(&self) -> Real {
        let swap = |[one, other]: [Complex; 2]| [other, one];
        Real { pins: swap(self.pins), grounds: swap(self.grounds), rotations: self.rotations }
    }

    /// Returns v, the normal of the line where there is a slider.
    pub fn normal(&self) -> Complex {
        self.pins[1] - self.grounds[1]
    }
}

/// A line of a linkage: the slider's of a slider-crank, at the first place the coupler's of an inverted one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point of it.
    pub through: Complex,
    /// Its direction, of any length.
    pub along: Complex,
}

/// The points and the line, at the first place, that determine a linkage and its motion through a given coupler point.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks {
    /// Fixed pivots and pins.
    pub points: Vec<Complex>,
    /// The line, where there is a slider.
    pub line: Option<Line>,
}

/// The second link of a closure: how linkages follow from real solutions, and solutions from linkages.
pub trait SecondLink: Sync {
    /// Returns the number of links on the ground that can be driven.
    fn cranks(&self) -> usize;

    /// Builds the linkage of a real solution, in the file's units, assembled as at the first place; `None` if its lengths make
    /// no linkage, or one of its links has none.
    fn linkage(&self, real: &Real, target: &Target) -> Option<CrankLinkage>;

    /// Returns t1 of that linkage where the crank pin is at `crank_pin` (from P_0, in units of the target's scale) and the coupler
    /// has turned by `turn` from the first place.
    fn assembly(&self, real: &Real, crank_pin: Complex, turn: Complex) -> AssemblyMode;

    /// Returns the arm by which the constraint turns the coupler about the crank pin, in parts of that of P, at most 1: rounding is
    /// magnified by its reciprocal. A four-bar's counts as 1: of its cognates one is well conditioned.
    fn leverage(&self, linkage: &CrankLinkage, at: &LoopJoints) -> f64;

    /// Returns y and b of a linkage at the first place; `None` if it is of another kind.
    fn solved(&self, linkage: &CrankLinkage, first: &First<'_>) -> Option<[Complex; 2]>;

    /// Returns the marks of a linkage at the first place.
    fn marks(&self, linkage: &CrankLinkage, at: &LoopJoints) -> Marks;

    /// Returns the same marks of a real solution, in its frame and units.
    fn marks_of(&self, real: &Real) -> Marks;
}

impl dyn SecondLink {
    /// Returns the second link of a closure.
    pub fn of(closure: Closure) -> &'static dyn SecondLink {
        match closure {
            Closure::FourBar => &four_bar::Follower,
            Closure::SliderCrank => &slider_crank::Slider,
            Closure::InvertedSliderCrank => &inverted_slider_crank::Block,
        }
    }
}

/// A linkage's position at the first place, and the frame of its target.
pub struct First<'a> {
    target: &'a Target,
    /// The position.
    pub at: LoopJoints,
}

impl<'a> First<'a> {
    /// Creates it from the position.
    pub fn of(target: &'a Target, at: LoopJoints) -> Self {
        First { target, at }
    }

    /// Returns a place of the moving linkage in the solution's frame: relative to its own coupler point, as a miss by rounding
    /// is no part of the shape.
    pub(super) fn moving(&self, place: Complex) -> Complex {
        (place - self.at.joints.coupler_point) * (1.0 / self.target.scale)
    }

    /// Returns a place on the ground in the solution's frame.
    pub(super) fn fixed(&self, place: Complex) -> Complex {
        (place - self.target.points[0]) * (1.0 / self.target.scale)
    }

    /// Returns v, a normal of a line of this direction, of the size that the equations ask for: n* v + n v* = 1.
    pub(super) fn normal(&self, along: Complex) -> Complex {
        let (normal, n) = (along * Complex::I, self.target.displacements.delta[STEPS - 1]);
        normal / (2.0 * (n.conj() * normal).re)
    }
}

/// Returns whether every one of these lengths is above rounding beside the span of a linkage; `scale` is that of its target.
pub(super) fn have_length(lengths: &[f64], linkage: &CrankLinkage, scale: f64) -> bool {
    let least = NO_LENGTH * span(linkage, scale);
    lengths.iter().all(|length| *length > least)
}

/// Returns the ratio of an arm about the crank pin to that of P, at most 1.
pub(super) fn beside_point(arm: Complex, at: &LoopJoints) -> f64 {
    let of_point = (at.joints.coupler_point - at.joints.crank_pin).norm();
    if of_point > 0.0 { (arm.norm() / of_point).min(1.0) } else { 1.0 }
}

/// Returns the length that misses are compared with.
pub(super) fn span(linkage: &CrankLinkage, scale: f64) -> f64 {
    linkage.longest_link().max(linkage.crank_side()).max(scale)
}
