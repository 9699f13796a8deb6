//! Warm starts: a candidate as the start of another fit, of the same problem or of one whose limits have moved.

use crate::record::Candidate;
use crate::task::Timing;
use crate::task::forms::design_space::Shape;
use crate::task::forms::rows::nearest_type;
use crate::task::forms::start::Start;
use crate::task::forms::torus::{PathFit, Positions};
use crate::task::{Problem, Setting};

/// Returns the start at a candidate; `None` if the loop is open at a point or there are fewer positions than points.
///
/// The design is clamped to the problem's bounds. The type aimed at is the candidate's own if that is allowed, else the
/// nearest.
pub fn start_at(problem: &Problem, candidate: &Candidate) -> Option<Start> {
    start_beside(problem, candidate, 1.0)
}

/// As [`start_at`], with the candidate's shortest link multiplied by `part`.
pub fn start_beside(problem: &Problem, candidate: &Candidate, part: f64) -> Option<Start> {
    let n = problem.task().len();
    if candidate.crank_deg.len() != n || candidate.t1_at.len() != n {
        return None;
    }
    let linkage = candidate.linkage.four_bar()?;
    let as_it_is = Shape::from(linkage);
    let mut shape = as_it_is;
    if part != 1.0 {
        shorten(&mut shape, part);
    }
    let types = problem.types();
    let aim = if types.is_empty() { None } else { nearest_type(shape.links(), types) };
    let (direction, mut offset) = direction_and_offset(problem, candidate);
    if let Some(frame) = candidate.frame_deg.filter(|_| problem.frame_is_free()) {
        offset = frame.to_radians();
    }
    let scales = problem.task().ranges().nearest(candidate.scales(&problem.spec().task));
    let side = linkage.side();
    let setting = Setting { aim, assembly: candidate.t1_at[0], direction, side };
    let design = problem.space(side).design(&shape, offset);
    let positions = match problem.task().timing() {
        Timing::Prescribed { .. } if problem.task().is_partly_timed() => positions(candidate, &as_it_is)?,
        Timing::Prescribed { .. } => Vec::new(),
        Timing::Free => {
            // A design that was shortened or clamped to its bounds has other curves.
            let mut positions = positions(candidate, &as_it_is)?;
            PathFit::new(problem, setting).settle(&design, &mut positions).then_some(positions)?
        }
    };
    Some(Start { design, setting, positions, scales })
}

/// Returns the direction of the prescribed increments (in a function the sign of its outputs) and the angle that is added
/// to them, in radians.
pub fn direction_and_offset(problem: &Problem, candidate: &Candidate) -> (f64, f64) {
    let crank_deg = candidate.crank_deg.as_slice();
    let Some(timing) = &problem.spec().task.timing else { return (problem.directions()[0], 0.0) };
    if let Some(sense) = candidate.sense {
        let scale = candidate.scales(&problem.spec().task)[0];
        let offset = (crank_deg[0] - scale * timing.crank_deg[0]).to_radians();
        return (sense.signs()[0], if problem.offset_is_free() { offset } else { 0.0 });
    }
    let written = &timing.crank_deg;
    let is_timed = |(j, pair)| (!problem.task().is_untimed(j)).then_some(pair);
    let off = |direction: f64| {
        let steps = crank_deg.iter().zip(written).enumerate().filter_map(is_timed);
        steps
            .map(|(has, asks)| ((has - crank_deg[0]) - direction * (asks - written[0])).abs())
            .fold(0.0, f64::max)
    };
    let directions = problem.directions().iter().copied();
    let direction = directions.min_by(|one, other| off(*one).total_cmp(&off(*other))).unwrap_or(1.0);
    let offset = (crank_deg[0] - direction * written[0]).to_radians();
    (direction, if problem.offset_is_free() { offset } else { 0.0 })
}

fn positions(candidate: &Candidate, shape: &Shape) -> Option<Positions> {
    let at = candidate.crank_deg.iter().zip(&candidate.t1_at);
    at.map(|(deg, assembly)| {
        let joints = candidate.linkage.joints_with(deg.to_radians(), *assembly)?.joints;
        let (c, d) = (joints.crank_pin, joints.follower_pin);
        Some([(c - shape.crank_pivot) / shape.crank, (d - c) / shape.coupler])
    })
    .collect()
}

/// Multiplies the shortest of ground, crank, coupler and follower by `part`; the ground about its middle, the coupler
/// point to the same relative place beside the coupler.
fn shorten(shape: &mut Shape, part: f64) {
    let links = shape.links();
    let shortest = (0..4).min_by(|&i, &j| links[i].total_cmp(&links[j]));
    match shortest {
        Some(0) => {
            let by = (shape.follower_pivot - shape.crank_pivot) * (0.5 * (1.0 - part));
            shape.crank_pivot += by;
            shape.follower_pivot -= by;
        }
        Some(1) => shape.crank *= part,
        Some(2) => {
            shape.coupler *= part;
            shape.offset *= part;
        }
        _ => shape.follower *= part,
    }
}
