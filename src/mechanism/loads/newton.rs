//! Forces at the joints by Newton-Euler: six equations for the two bodies of each group, from the last group to the first, and
//! three for the crank.
//!
//! Every body's loads and the resistance of its mass, -m a at G and -I alpha, make one wrench (F, M) about its origin O
//! (d'Alembert), which the forces of its pairs balance. A pair acts on its first body with
//!
//! ```text
//! revolute    f = (x, y)                          at the joint r
//! prismatic   f = n i u, and a moment m           at the joint r, u the block's direction
//! ```
//!
//! and on its second with the opposite. For each of the two bodies of a group, with s = 1 where it is the first of a pair and -1
//! where it is the second,
//!
//! ```text
//! sum s f + F = 0            sum s ((r - O) x f + m) + M = 0
//! ```
//!
//! These are six equations in six unknowns. Their determinant vanishes where the group is at a toggle. The forces then load the
//! earlier bodies, so that the next group's wrenches are complete. The crank's own wrench gives the force at its pivot and the
//! torque.
//!
//! A joint of more than two bodies has one force for each further body, on the first.

use super::applied::Wrench;
use super::kinematics::Kinematics;
use crate::mechanism::structure::{CRANK, GROUND, Group, Pair, PairKind, Structure};
use crate::mechanism::{Complex, cross, turned};
use nalgebra::{Matrix6, Vector6};

/// Forces of a pair on its first body: x and y in N of a revolute one; across the line (to its left) in N, and the moment in N m of
/// a prismatic one.
pub type Reaction = [f64; 2];

/// Computes the forces of all pairs in the order of [`Structure::pairs`] and returns the torque of the crank. The wrenches must hold
/// all loads of each body; that of the ground becomes what the mechanism puts on it, without the motor's own moment. `None` if a
/// group is at a toggle.
pub(super) fn balance(
    structure: &Structure,
    places: &Kinematics,
    wrenches: &mut [Wrench],
    reactions: &mut [Reaction],
) -> Option<f64> {
    for (i, group) in structure.groups.iter().enumerate().rev() {
        let found = solve(group, places, wrenches)?;
        for (pair, reaction) in group.pairs.iter().zip(found) {
            for (body, sign) in pair.bodies.into_iter().zip([1.0, -1.0]) {
                if !group.bodies.contains(&body) {
                    let (force, moment) = action(pair, reaction, places);
                    let arm = places.joints[pair.joint].at - places.bodies[body].origin.at;
                    wrenches[body].add(force * sign, arm);
                    wrenches[body].moment += moment * sign;
                }
            }
        }
        reactions[1 + 3 * i..4 + 3 * i].copy_from_slice(&found);
    }
    let Wrench { force, moment } = wrenches[CRANK];
    // The crank's frame begins at its pivot, or its first joint is another one of a chain's.
    let arm = places.joints[structure.crank_pivot].at - places.bodies[CRANK].origin.at;
    let torque = -(moment - cross(arm, force));
    reactions[0] = [force.re, force.im];
    wrenches[GROUND].add(force, Complex::new(0.0, 0.0));
    (torque.is_finite() && reactions.iter().flatten().all(|x| x.is_finite())).then_some(torque)
}

/// Returns force and moment of a pair on its first body.
fn action(pair: &Pair, [x, y]: Reaction, places: &Kinematics) -> (Complex, f64) {
    match pair.kind {
        PairKind::Revolute => (Complex::new(x, y), 0.0),
        PairKind::Prismatic => (turned(places.bodies[pair.bodies[1]].direction) * x, y),
    }
}

/// Solves the six equations of a group; moments count in the group's own size, so that all rows are forces.
fn solve(group: &Group, places: &Kinematics, wrenches: &[Wrench]) -> Option<[Reaction; 3]> {
    let origin = group.bodies.map(|body| places.bodies[body].origin.at);
    let arms = group.pairs.map(|pair| places.joints[pair.joint].at);
    let size = arms.iter().map(|at| (at - origin[0]).norm()).fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.0 };
    let mut matrix = Matrix6::<f64>::zeros();
    let mut right = Vector6::<f64>::zeros();
    for (row, body) in group.bodies.into_iter().enumerate() {
        let Wrench { force, moment } = wrenches[body];
        for (i, value) in [force.re, force.im, moment / size].into_iter().enumerate() {
            right[3 * row + i] = -value;
        }
        for (k, pair) in group.pairs.iter().enumerate() {
            let sign = match pair.bodies.iter().position(|of| *of == body) {
                Some(0) => 1.0,
                Some(_) => -1.0,
                None => continue,
            };
            let arm = arms[k] - origin[row];
            for unit in 0..2 {
                let one = if unit == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
                let (force, moment) = action(pair, one, places);
                let column = 2 * k + unit;
                matrix[(3 * row, column)] = sign * force.re;
                matrix[(3 * row + 1, column)] = sign * force.im;
                // A unit of a moment in the unknowns is a unit of force times the size.
                matrix[(3 * row + 2, column)] = sign * (cross(arm, force) / size + moment);
            }
        }
    }
    let found = matrix.lu().solve(&right)?;
    let of = |k: usize| {
        let second = match group.pairs[k].kind {
            PairKind::Revolute => 1.0,
            PairKind::Prismatic => size,
        };
        [found[2 * k], found[2 * k + 1] * second]
    };
    Some([of(0), of(1), of(2)])
}
