//! The mechanisms of a real solution: the six ways to build one class, each with its motion through the points.
//!
//! A class of solutions is one coupler curve. Three Roberts cognates draw it, and in each of them either of the two
//! links on the ground can be driven: six mechanisms ([`Solution::cognate`], [`Solution::swapped`]).
//!
//! The driven link (x, a) has its pivot at A = P_0 + a and its pin at C_j = P_j + T_j x when the coupler point is at
//! P_j: the crank angles and the assembly at each point follow directly, without a search.
//!
//! The referee ([`crate::judge::referee`]) finds the defects that keep a mechanism from running through its points in
//! their order. They are defects of the mechanism, not of the curve: if the driven link has to turn back, that of
//! another mechanism may turn on. A class is on one circuit, in order or free of defects if one of its six is.

use crate::judge::referee::judge;
use crate::mechanism::{AssemblyMode, Complex, FourBar, cross};
use crate::numbers::nine_point::target::{STEPS, Solution, Target};
use crate::task::{Defect, Task};

/// The number of points.
pub const POINTS: usize = STEPS + 1;

/// The tolerance for passing a point: the coupler point has to come within this part of the mechanism's span, divided
/// by the sine of the transmission angle there: the loop's closure magnifies rounding by that much.
pub const PASSES: f64 = 1e-10;

/// The further tolerance relative to the coordinates: they are rounded, and the points' own are.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// The length, relative to the span, up to which a link counts as having none: its length is rounding.
pub const NO_LENGTH: f64 = 1e-9;

/// One of the six ways to build a class, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The linkage; its assembly t1 is that of the first point.
    pub linkage: FourBar,
    /// The crank angle at each point, radians in (-pi, pi].
    pub crank_angles: [f64; POINTS],
    /// The assembly at each point.
    pub assemblies: [AssemblyMode; POINTS],
    /// The largest distance of the coupler point from its point at these positions, in the file's units.
    pub miss: f64,
    /// The largest ratio of these distances to the tolerance for passing there.
    pub miss_over_limit: f64,
    /// The least sine of the transmission angle at the points: near 0 a point lies at a toggle, and rounding decides its
    /// assembly.
    pub least_sine: f64,
    /// Whether it passes every point, within [`PASSES`].
    pub passes: bool,
    /// The defects that the referee finds.
    pub defects: Vec<Defect>,
}

impl Mechanism {
    /// Returns whether it passes all points without being taken apart.
    pub fn on_one_circuit(&self) -> bool {
        self.passes && !self.defects.iter().any(|d| matches!(d, Defect::Circuit { .. }))
    }

    /// Returns whether it passes all points on one circuit, and round it in their order.
    pub fn in_order(&self) -> bool {
        self.on_one_circuit() && !self.defects.iter().any(|d| matches!(d, Defect::Order { .. }))
    }

    /// Returns whether it passes all points on one branch of one circuit, in order.
    pub fn is_free_of_defects(&self) -> bool {
        self.passes && self.defects.is_empty()
    }
}

/// A real solution: the unknowns that are left if the starred twins are the conjugates.
#[derive(Clone, Copy)]
struct Real {
    pins: [Complex; 2],
    grounds: [Complex; 2],
    rotations: [Complex; STEPS],
}

impl Real {
    /// Takes the mean of each unknown and the conjugate of its twin, and scales the rotations to modulus one.
    fn of(solution: &Solution) -> Real {
        let mean =
            |z: [Complex; 2], twin: [Complex; 2]| std::array::from_fn(|i| (z[i] + twin[i].conj()) * 0.5);
        Real {
            pins: mean(solution.pins, solution.pins_starred),
            grounds: mean(solution.grounds, solution.grounds_starred),
            rotations: solution.rotations.map(|t| t / t.norm()),
        }
    }

    /// Builds the mechanism whose crank is the `driven` one of the two links on the ground, with its positions; `None`
    /// if its lengths make no linkage.
    fn mechanism(&self, task: &Task, target: &Target, driven: usize) -> Option<Mechanism> {
        let (x, y) = (self.pins[driven], self.pins[1 - driven]);
        let (a, b) = (self.grounds[driven], self.grounds[1 - driven]);
        let scale = target.scale;
        let pivots = [target.points[0] + a * scale, target.points[0] + b * scale];
        let along = (y - x) / (y - x).norm();
        let links = [(x - a).norm() * scale, (y - x).norm() * scale, (y - b).norm() * scale];
        let positions: [(f64, AssemblyMode); POINTS] = std::array::from_fn(|j| {
            let (delta, t) = match j.checked_sub(1) {
                None => (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0)),
                Some(step) => (target.displacements.delta[step], self.rotations[step]),
            };
            let crank_pin = delta + x * t;
            let assembly = AssemblyMode::of(cross(b - crank_pin, (y - x) * t));
            ((crank_pin - a).arg(), assembly)
        });
        let (crank_angles, assemblies) = (positions.map(|p| p.0), positions.map(|p| p.1));
        let offset = -x * along.conj() * scale;
        let linkage = FourBar::with_coupler_offset(pivots, links, offset, assemblies[0]).ok()?;
        linkage.linkage_type()?;
        let span = linkage.longest_link().max(linkage.crank_side()).max(scale);
        if linkage.links().iter().any(|link| *link <= NO_LENGTH * span) {
            return None;
        }
        let far = pivots.iter().chain(&target.points).map(|z| z.norm()).fold(0.0, f64::max);
        let (mut miss, mut miss_over_limit, mut least_sine) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for j in 0..POINTS {
            let Some(joints) = linkage.position_with(crank_angles[j], assemblies[j]).joints() else {
                (miss, miss_over_limit, least_sine) = (f64::INFINITY, f64::INFINITY, 0.0);
                break;
            };
            let apart = (joints.coupler_point - target.points[j]).norm();
            let closure = linkage.angle_at_follower_pin(crank_angles[j]).sin();
            miss = miss.max(apart);
            least_sine = least_sine.min(closure);
            let limit = (PASSES * span + ROUNDED * far) / closure.max(f64::EPSILON.sqrt());
            miss_over_limit = miss_over_limit.max(apart / limit);
        }
        let defects = judge(task, &linkage, &crank_angles, &assemblies).defects;
        let passes = miss_over_limit <= 1.0;
        Some(Mechanism {
            linkage,
            crank_angles,
            assemblies,
            miss,
            miss_over_limit,
            least_sine,
            passes,
            defects,
        })
    }
}

/// Returns the six mechanisms of a real solution, cognate by cognate, the first link driven before the second; fewer
/// if one has a link of no length. `task` is the path of the nine points of `target`.
pub fn mechanisms(task: &Task, target: &Target, solution: &Solution) -> Vec<Mechanism> {
    let mut form = *solution;
    let mut list = Vec::with_capacity(6);
    for _ in 0..3 {
        let real = Real::of(&form);
        list.extend((0..2).filter_map(|driven| real.mechanism(task, target, driven)));
        form = form.cognate(&target.displacements);
    }
    list
}

/// Computes the solution that belongs to a linkage at its positions, the inverse of building a [`Mechanism`], with
/// its crank as the first link; `None` if the loop is open at a point.
pub fn solution_of(
    target: &Target,
    linkage: &FourBar,
    crank_angles: &[f64],
    assemblies: &[AssemblyMode],
) -> Option<Solution> {
    if crank_angles.len() != POINTS || assemblies.len() != POINTS {
        return None;
    }
    let joints = |j: usize| linkage.position_with(crank_angles[j], assemblies[j]).joints();
    let first = joints(0)?;
    let unit = 1.0 / target.scale;
    let relative = |z: Complex| (z - target.points[0]) * unit;
    // The pins are relative to the linkage's own coupler point: a miss by rounding is no part of the shape.
    let pins = [first.crank_pin, first.follower_pin].map(|pin| (pin - first.coupler_point) * unit);
    let grounds = [linkage.crank_pivot(), linkage.follower_pivot()].map(relative);
    let along = first.follower_pin - first.crank_pin;
    let mut rotations = [Complex::new(1.0, 0.0); STEPS];
    for (step, rotation) in rotations.iter_mut().enumerate() {
        let joints = joints(step + 1)?;
        let turned = (joints.follower_pin - joints.crank_pin) / along;
        *rotation = turned / turned.norm();
    }
    Some(Solution {
        pins,
        grounds,
        pins_starred: pins.map(|z| z.conj()),
        grounds_starred: grounds.map(|z| z.conj()),
        rotations,
    })
}
