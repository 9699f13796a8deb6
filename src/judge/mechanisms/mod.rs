//! The mechanisms of a real solution: the ways to build one class, each with its motion through the points and poses.
//!
//! A class of solutions through points is one coupler curve. Three Roberts cognates draw it, and in each of them either of
//! the two links on the ground can be driven: six mechanisms ([`Solution::cognate`], [`Solution::swapped`]). A cognate
//! turns its coupler differently, and stands on other pivots: where there are poses, or both fixed pivots are given, the two
//! links make two mechanisms; where one is given and there are no poses, two cognates have it, which make four. A slider-crank
//! has one cognate and one link to drive, which makes two mechanisms; an inverted slider-crank is alone.
//!
//! The driven link (x, a) has its pivot at A = P_0 + a and its pin at C_j = P_j + T_j x when the coupler point is at
//! P_j: the crank angles and the assembly at each target follow directly, without a search. The second link is that of the
//! solution's closure ([`SecondLink`]):
//!
//! | module | holds |
//! |---|---|
//! | `second_link` | the second link of a closure, beside the crank: what it is in a linkage, and what in a real solution |
//! | `four_bar` | the follower of a four-bar |
//! | `slider_crank` | the slider of a slider-crank and its line |
//! | `inverted_slider_crank` | the block of an inverted slider-crank and the line of its coupler |
//!
//! The referee ([`crate::judge::referee`]) finds the defects that keep a mechanism from running through its points in
//! their order. They are defects of the mechanism, not of the curve: if the driven link has to turn back, that of
//! another mechanism may turn on. A class is on one circuit, in order or free of defects if one of its mechanisms is.

mod four_bar;
mod inverted_slider_crank;
mod second_link;
mod slider_crank;

pub use second_link::{Real, SecondLink};

use crate::judge::referee::judge;
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage};
use crate::numbers::nine_point::target::{STEPS, Solution};
use crate::task::forms::precision::Precise;
use crate::task::{Defect, Task};
use second_link::{First, span};

/// The tolerance for passing a point: the coupler point has to come within this part of the mechanism's span, divided
/// by the sine of the transmission angle there, and by the leverage of a slider ([`SecondLink::leverage`]): the loop's closure
/// magnifies rounding by that much.
pub const PASSES: f64 = 1e-10;

/// The further tolerance relative to the coordinates: they are rounded, and the points' own are.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// One of the ways to build a class, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The linkage; its assembly t1 is that of the first point.
    pub linkage: CrankLinkage,
    /// The crank angle at each target, in the task's order, radians in (-pi, pi].
    pub crank_angles: Vec<f64>,
    /// The assembly at each target.
    pub assemblies: Vec<AssemblyMode>,
    /// The largest distance of the coupler point from its point at these positions, or of the coupler's turn to a pose from
    /// the one wanted, times the extent of the targets; in the file's units.
    pub miss: f64,
    /// The largest ratio of these distances to the tolerance for passing there.
    pub miss_over_limit: f64,
    /// The least sine of the transmission angle at the points, times the leverage of a slider: near 0 a point lies at a toggle, and
    /// rounding decides its assembly.
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

impl Real {
    /// Builds the mechanism with its positions; `None` if its lengths make no linkage.
    fn mechanism(&self, task: &Task, of: &Precise) -> Option<Mechanism> {
        let Precise { target, places } = of;
        let (x, a, scale) = (self.pins[0], self.grounds[0], target.scale);
        let second = <dyn SecondLink>::of(target.displacements.kind.closure);
        let position = |place: &usize| {
            let (delta, t) = match place.checked_sub(1) {
                None => (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0)),
                Some(step) => (target.displacements.delta[step], self.rotations[step]),
            };
            let crank_pin = delta + x * t;
            ((crank_pin - a).arg(), second.assembly(self, crank_pin, t))
        };
        let (crank_angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) = places.iter().map(position).unzip();
        let linkage = second.linkage(self, target)?.with_assembly(assemblies[0]);
        let span = span(&linkage, scale);
        let of_points = target.points.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let far = linkage.pivots().map(|z| z.norm()).fold(of_points, f64::max);
        let points = target.displacements.kind.points();
        let first = places.iter().position(|place| *place == 0)?;
        let along = linkage.joints_with(crank_angles[first], assemblies[first])?.coupler;
        let (mut miss, mut miss_over_limit, mut least_sine) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for (j, place) in places.iter().enumerate() {
            let Some(at) = linkage.joints_with(crank_angles[j], assemblies[j]) else {
                (miss, miss_over_limit, least_sine) = (f64::INFINITY, f64::INFINITY, 0.0);
                break;
            };
            let mut apart = (at.joints.coupler_point - target.points[*place]).norm();
            if *place > points {
                let turn = at.coupler / along;
                apart = apart.max((turn - self.rotations[place - 1]).norm() * scale);
            }
            let closure = linkage.transmission_at(crank_angles[j]).sin() * second.leverage(&linkage, &at);
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
    let displacements = &of.target.displacements;
    let cranks = <dyn SecondLink>::of(displacements.kind.closure).cranks();
    let mut list = Vec::with_capacity(6);
    for form in solution.cognates(displacements) {
        let real = Real::of(&form);
        list.extend([real, real.swapped()].iter().take(cranks).filter_map(|real| real.mechanism(task, of)));
    }
    list
}

/// Computes the solution that belongs to a linkage at its positions, the inverse of building a [`Mechanism`], with
/// its crank as the first link, or its follower where that stands on the first given pivot; `None` if the loop is open at
/// a point, or the linkage is of another kind.
pub fn solution_of(
    of: &Precise,
    linkage: &CrankLinkage,
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
    let joints = |place: usize| linkage.joints_with(crank_angles[at(place)], assemblies[at(place)]);
    let kind = target.displacements.kind;
    let first = First::of(target, joints(0)?);
    let [y, b] = <dyn SecondLink>::of(kind.closure).solved(linkage, &first)?;
    let pins = [first.moving(first.at.joints.crank_pin), y];
    let grounds = [first.fixed(linkage.crank_pivot()), b];
    let along = first.at.coupler;
    let mut rotations = [Complex::new(1.0, 0.0); STEPS];
    for (entry, rotation) in rotations.iter_mut().enumerate() {
        // The entry of a pose's turn has the pose's rotation, that of n and n* their quotient; those of given pivots have none.
        let step = match entry {
            normal if kind.is_normal(normal) => {
                *rotation = target.displacements.delta[normal] / target.displacements.starred[normal];
                continue;
            }
            place if place < kind.places() => place,
            turn if turn >= kind.lengths() && turn < kind.turn(kind.poses) => {
                turn - kind.lengths() + kind.points()
            }
            _ => continue,
        };
        let turned = joints(step + 1)?.coupler / along;
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
