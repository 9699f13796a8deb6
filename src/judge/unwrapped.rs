//! Crank angles unwrapped along the motion through the points.

use crate::mechanism::four_bar::mobility::{ways_round, wrapped};
use crate::mechanism::{AssemblyMode, CrankLinkage};
use crate::task::Problem;
use crate::task::defect::ORDER_TOLERANCE;
use std::f64::consts::TAU;

/// Returns crank angles (given in radians) unwrapped along the motion, in degrees: along a full turn in the direction
/// that is shorter in total; a rocking crank stays on the arc that it can reach. A last point that repeats the first
/// has the first one's angle, a turn later.
pub fn unwrapped(
    problem: &Problem,
    linkage: impl Into<CrankLinkage>,
    angles: Vec<f64>,
    mut assemblies: Vec<AssemblyMode>,
) -> (Vec<f64>, Vec<AssemblyMode>) {
    let mobility = linkage.into().mobility();
    let arc = mobility.arc(mobility.branch(angles[0], assemblies[0]).circuit);
    let [forward, backward] = ways_round(angles.windows(2).map(|w| w[1] - w[0]), ORDER_TOLERANCE);
    let direction = if backward < forward { -1.0 } else { 1.0 };
    let mut along: Vec<f64> = match arc {
        // From the middle of the arc, brought to within half a turn of the x axis.
        Some(arc) => angles.iter().map(|angle| wrapped(arc.middle) + arc.offset(*angle)).collect(),
        None => {
            let mut along = vec![angles[0]];
            for w in angles.windows(2) {
                let step = (direction * (w[1] - w[0])).rem_euclid(TAU);
                let step = if step > TAU - ORDER_TOLERANCE { step - TAU } else { step };
                along.push(along[along.len() - 1] + direction * step);
            }
            if !problem.task().repeats_first() {
                stop_short_of_the_first(&mut along, direction);
            }
            along
        }
    };
    if problem.task().repeats_first() {
        let last = along.len() - 1;
        along[last] = along[0] + if arc.is_none() { direction * TAU } else { 0.0 };
        assemblies[last] = assemblies[0];
    }
    (along.iter().map(|a| a.to_degrees()).collect(), assemblies)
}

/// Moves points at the end that share the first point's place, a whole turn on, slightly before it, so that the motion
/// does not pass a full turn.
fn stop_short_of_the_first(along: &mut [f64], direction: f64) {
    const HAIR: f64 = 4.0 * ORDER_TOLERANCE;
    const TOUCHING: f64 = 1e-6;
    let (Some(&first), Some(&last)) = (along.first(), along.last()) else { return };
    let beyond = direction * (last - first) - TAU;
    if (-HAIR..TOUCHING).contains(&beyond) {
        let end = first + direction * (TAU - HAIR);
        for angle in along.iter_mut().rev().take_while(|angle| (**angle - last).abs() <= TOUCHING) {
            *angle = end;
        }
    }
}
