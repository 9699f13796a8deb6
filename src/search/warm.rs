//! A candidate as a start for a local search: from the record's terms back to the design vector.

use super::cognates::direction;
use super::starts::Start;
use crate::linkage::{Complex, CouplerSide};
use crate::problem::design_space::Shape;
use crate::problem::requirements::nearest_type;
use crate::problem::torus::TorusFit;
use crate::problem::{Problem, Setting};
use crate::record::Candidate;
use crate::task::Timing;

/// The start that lies where a candidate is, with its shortest link brought to `part` of itself. Where types
/// are asked for it aims at its own, or else at the nearest allowed. `None` where its loop is open at a point,
/// or where it cannot be brought back to its positions.
pub fn start_at(problem: &Problem, candidate: &Candidate, part: f64) -> Option<Start> {
    let linkage = &candidate.linkage;
    let side = if problem.sides().len() > 1 { linkage.side() } else { CouplerSide::Plus };
    let mut shape = Shape::from(linkage);
    if part != 1.0 {
        shorten(&mut shape, part);
    }
    let types = problem.types();
    let aim = if types.is_empty() { None } else { nearest_type(shape.links(), types) };
    let mut setting = Setting { aim, assembly: *candidate.t1_at.first()?, direction: 1.0, side };
    let space = problem.space(side);
    match problem.task().timing() {
        Timing::Prescribed { .. } => {
            let written = &problem.spec().task.path.timing.as_ref()?.crank_deg;
            setting.direction = direction(written, &candidate.crank_deg);
            let offset = candidate.crank_deg.first()? - setting.direction * written.first()?;
            let offset = if problem.offset_is_free() { offset.to_radians() } else { 0.0 };
            Some(Start { design: space.design(&shape, offset), setting, positions: Vec::new() })
        }
        Timing::Free => {
            let position = |(deg, t1): (&f64, &crate::linkage::AssemblyMode)| {
                let angle = deg.to_radians();
                let joints = linkage.position_with(angle, *t1).joints()?;
                let coupler = joints.follower_pin - joints.crank_pin;
                Some([Complex::from_polar(1.0, angle), coupler / coupler.norm()])
            };
            let positions: Option<Vec<_>> =
                candidate.crank_deg.iter().zip(&candidate.t1_at).map(position).collect();
            let (design, mut positions) = (space.design(&shape, 0.0), positions?);
            if part != 1.0 && !TorusFit::new(problem, setting).settle(&design, &mut positions) {
                return None;
            }
            Some(Start { design, setting, positions })
        }
    }
}

/// The shortest of ground, crank, coupler and follower to `part` of itself; the ground about its middle, the
/// coupler point to the same place beside the coupler.
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
