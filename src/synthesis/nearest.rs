//! Positions at which a given linkage is nearest to a task's points: for linkages that were not placed by a search.

use crate::judge::unwrapped::unwrapped;
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::{AssemblyMode, CouplerCurve, FourBar, InputRange};
use crate::task::{AngleOffset, Problem, Timing};

/// Returns the crank angles (degrees) and assemblies at the points; `None` if there is no position for one.
///
/// Free timing: the nearest point of the circuit that the linkage's own t1 is on (of a rocking Grashof linkage the
/// better of its two circuits). Prescribed timing: the prescribed angles, with the offset and the direction that give
/// the least sum of squares if they are free, on the linkage's own t1.
pub fn nearest_positions(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    match problem.task().timing() {
        Timing::Free => free(problem, linkage),
        Timing::Prescribed { offset, .. } => prescribed(problem, linkage, *offset),
    }
}

fn free(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let mobility = linkage.mobility();
    let starts: Vec<f64> = match mobility.input {
        InputRange::None => return None,
        InputRange::Full => vec![linkage.ground_angle()],
        InputRange::One(arc) => vec![arc.middle],
        InputRange::Two(arcs) => arcs.iter().map(|arc| arc.middle).collect(),
    };
    let on_circuit = |start: f64| {
        let curve = CouplerCurve::through(linkage, start, linkage.assembly(), DEFAULT_SAMPLES);
        let mut sum = 0.0;
        let mut positions = Vec::new();
        for target in problem.task().points() {
            let nearest = curve.nearest(*target)?;
            sum += nearest.distance * nearest.distance;
            positions.push(curve.position_at(nearest.parameter));
        }
        Some((sum, positions))
    };
    let best = starts.into_iter().filter_map(on_circuit).min_by(|one, other| one.0.total_cmp(&other.0))?;
    let (angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) = best.1.into_iter().unzip();
    Some(unwrapped(problem, linkage, angles, assemblies))
}

fn prescribed(
    problem: &Problem,
    linkage: &FourBar,
    offset: AngleOffset,
) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let written = &problem.spec().task.timing.as_ref()?.crank_deg;
    let assemblies = vec![linkage.assembly(); written.len()];
    let angles = |direction: f64, base_deg: f64| -> Vec<f64> {
        written.iter().map(|deg| base_deg + direction * deg).collect()
    };
    let sum = |direction: f64, base_deg: f64| {
        let radians: Vec<f64> = angles(direction, base_deg).iter().map(|d| d.to_radians()).collect();
        problem.task().errors(linkage, &radians, &assemblies).map_or(f64::INFINITY, |e| e.objective)
    };
    let given = match offset {
        AngleOffset::Fixed => Some(0.0),
        AngleOffset::Ground => Some(linkage.ground_angle().to_degrees()),
        AngleOffset::Free => None,
    };
    if let Some(base) = given {
        return Some((angles(1.0, base), assemblies));
    }
    let step = 360.0 / DEFAULT_SAMPLES as f64;
    let samples = |&direction: &f64| (0..DEFAULT_SAMPLES).map(move |i| (direction, step * i as f64));
    let all = problem.directions().iter().flat_map(samples);
    let measured = all.map(|(direction, offset)| (sum(direction, offset), direction, offset));
    let (least, direction, offset) = measured.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let (mut low, mut high) = (offset - step, offset + step);
    for _ in 0..100 {
        let third = (high - low) / 3.0;
        if sum(direction, low + third) <= sum(direction, high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    let refined = 0.5 * (low + high);
    let offset = if sum(direction, refined) <= least { refined } else { offset };
    least.is_finite().then(|| (angles(direction, offset), assemblies))
}
