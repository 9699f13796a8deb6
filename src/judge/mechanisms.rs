//! The mechanisms of a real solution: the ways to build one class, each with its motion through the points and poses.
//!
//! A class of solutions through points is one coupler curve. Three Roberts cognates draw it, and in each of them either of
//! the two links on the ground can be driven: six mechanisms ([`Solution::cognate`], [`Solution::swapped`]). A cognate
//! turns its coupler differently, and stands on other pivots: where there are poses, or both fixed pivots are given, the two
//! links make two mechanisms; where one is given and there are no poses, two cognates have it, which make four.
//!
//! The driven link (x, a) has its pivot at A = P_0 + a and its pin at C_j = P_j + T_j x when the coupler point is at
//! P_j: the crank angles and the assembly at each target follow directly, without a search.
//!
//! The referee ([`crate::judge::referee`]) finds the defects that keep a mechanism from running through its points in
//! their order. They are defects of the mechanism, not of the curve: if the driven link has to turn back, that of
//! another mechanism may turn on. A class is on one circuit, in order or free of defects if one of its six is.

use crate::judge::referee::judge;
use crate::mechanism::{AssemblyMode, Complex, FourBar, cross};
use crate::numbers::nine_point::target::{STEPS, Solution};
use crate::task::forms::precision::Precise;
use crate::task::{Defect, Task};

/// The tolerance for passing a point: the coupler point has to come within this part of the mechanism's span, divided
/// by the sine of the transmission angle there: the loop's closure magnifies rounding by that much.
pub const PASSES: f64 = 1e-10;

/// The further tolerance relative to the coordinates: they are rounded, and the points' own are.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// The length, relative to the span, up to which a link counts as having none: its length is rounding.
pub const NO_LENGTH: f64 = 1e-9;

/// One of the ways to build a class, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The linkage; its assembly t1 is that of the first point.
    pub linkage: FourBar,
    /// The crank angle at each target, in the task's order, radians in (-pi, pi].
    pub crank_angles: Vec<f64>,
    /// The assembly at each target.
    pub assemblies: Vec<AssemblyMode>,
    /// The largest distance of the coupler point from its point at these positions, or of the coupler's turn to a pose from
    /// the one wanted, times the extent of the targets; in the file's units.
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
    fn mechanism(&self, task: &Task, of: &Precise, driven: usize) -> Option<Mechanism> {
        let Precise { target, places } = of;
        let (x, y) = (self.pins[driven], self.pins[1 - driven]);
        let (a, b) = (self.grounds[driven], self.grounds[1 - driven]);
        let scale = target.scale;
        let pivots = [target.points[0] + a * scale, target.points[0] + b * scale];
        let along = (y - x) / (y - x).norm();
        let links = [(x - a).norm() * scale, (y - x).norm() * scale, (y - b).norm() * scale];
        let position = |place: &usize| {
            let (delta, t) = match place.checked_sub(1) {
                None => (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0)),
                Some(step) => (target.displacements.delta[step], self.rotations[step]),
            };
            let crank_pin = delta + x * t;
            let assembly = AssemblyMode::of(cross(b - crank_pin, (y - x) * t));
            ((crank_pin - a).arg(), assembly)
        };
        let (crank_angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) = places.iter().map(position).unzip();
        let offset = -x * along.conj() * scale;
        let linkage = FourBar::with_coupler_offset(pivots, links, offset, assemblies[0]).ok()?;
        linkage.linkage_type()?;
        let span = linkage.longest_link().max(linkage.crank_side()).max(scale);
        if linkage.links().iter().any(|link| *link <= NO_LENGTH * span) {
            return None;
        }
        let far = pivots.iter().chain(&target.points).map(|z| z.norm()).fold(0.0, f64::max);
        let points = target.displacements.kind.points();
        let first = places.iter().position(|place| *place == 0)?;
        let along = linkage.position_with(crank_angles[first], assemblies[first]).joints();
        let along = along.map(|joints| joints.follower_pin - joints.crank_pin)?;
        let (mut miss, mut miss_over_limit, mut least_sine) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for (j, place) in places.iter().enumerate() {
            let Some(joints) = linkage.position_with(crank_angles[j], assemblies[j]).joints() else {
                (miss, miss_over_limit, least_sine) = (f64::INFINITY, f64::INFINITY, 0.0);
                break;
            };
            let mut apart = (joints.coupler_point - target.points[*place]).norm();
            if *place > points {
                let turn = (joints.follower_pin - joints.crank_pin) / along;
                apart = apart.max((turn - self.rotations[place - 1]).norm() * scale);
            }
            let closure = linkage.angle_at_follower_pin(crank_angles[j]).sin();
            miss = miss.max(apart);
            least_sine = least_sine.min(closure);
            let limit = (PASSES * span + ROUNDED * far) / closure.max(f64::EPSILON.sqrt());
            miss_over_limit = miss_over_limit.max(apart / limit);
        }
        let defects = judge(task, linkage, &crank_angles, &assemblies).defects;
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

/// Returns the mechanisms of a real solution, cognate by cognate, the first link driven before the second; fewer if one has
/// a link of no length. `task` is that of the points and poses.
pub fn mechanisms(task: &Task, of: &Precise, solution: &Solution) -> Vec<Mechanism> {
    let mut list = Vec::with_capacity(6);
    for form in solution.cognates(&of.target.displacements) {
        let real = Real::of(&form);
        list.extend((0..2).filter_map(|driven| real.mechanism(task, of, driven)));
    }
    list
}

/// Computes the solution that belongs to a linkage at its positions, the inverse of building a [`Mechanism`], with
/// its crank as the first link, or its follower where that stands on the first given pivot; `None` if the loop is open at
/// a point.
pub fn solution_of(
    of: &Precise,
    linkage: &FourBar,
    crank_angles: &[f64],
    assemblies: &[AssemblyMode],
) -> Option<Solution> {
    let Precise { target, places } = of;
    if crank_angles.len() != places.len() || assemblies.len() != places.len() {
        return None;
    }
    let mut order = vec![0; places.len()];
    for (j, place) in places.iter().enumerate() {
        order[*place] = j;
    }
    let at = |place: usize| order[place];
    let joints =
        |place: usize| linkage.position_with(crank_angles[at(place)], assemblies[at(place)]).joints();
    let first = joints(0)?;
    let unit = 1.0 / target.scale;
    let relative = |z: Complex| (z - target.points[0]) * unit;
    // The pins are relative to the linkage's own coupler point: a miss by rounding is no part of the shape.
    let pins = [first.crank_pin, first.follower_pin].map(|pin| (pin - first.coupler_point) * unit);
    let grounds = [linkage.crank_pivot(), linkage.follower_pivot()].map(relative);
    let along = first.follower_pin - first.crank_pin;
    let mut rotations = [Complex::new(1.0, 0.0); STEPS];
    let kind = target.displacements.kind;
    for (entry, rotation) in rotations.iter_mut().enumerate() {
        // The entry of a pose's turn has the pose's rotation; those of given pivots have none.
        let step = match entry {
            place if place < kind.places() => place,
            turn if turn >= kind.lengths() && turn < kind.turn(kind.poses) => {
                turn - kind.lengths() + kind.points()
            }
            _ => continue,
        };
        let joints = joints(step + 1)?;
        let turned = (joints.follower_pin - joints.crank_pin) / along;
        *rotation = turned / turned.norm();
    }
    let solution = Solution {
        pins,
        grounds,
        pins_starred: pins.map(|z| z.conj()),
        grounds_starred: grounds.map(|z| z.conj()),
        rotations,
    };
    let other = kind.pivots > 0 && {
        let given = target.displacements.delta[kind.places()];
        (grounds[1] - given).norm() < (grounds[0] - given).norm()
    };
    Some(if other { solution.swapped() } else { solution })
}
