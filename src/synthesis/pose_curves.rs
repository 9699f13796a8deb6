//! The circle-point and centre-point curves of four poses, with how well linkages of their dyads transmit.
//!
//! A body that takes four poses has a curve of pins that stay on circles (circle points, in the body's frame), and the centres of
//! these circles are the fixed pivots that go with them (centre points). Every two of these dyads are a four-bar that meets the poses
//! exactly, but many of them change circuit or branch, or the order of the poses, on the way. So each place of the curve is
//! marked by the best linkage without a defect that has its dyad, with any other one of the samples: by that linkage's worst
//! transmission angle between the poses. A stretch without a mark leads to no linkage that could be built.
//!
//! Source: L. Burmester, Lehrbuch der Kinematik, 1888; the curves themselves are those of [`super::dyads::through_four_curve`].

use super::dyads::four_curve_strands;
use super::motion::DyadStarts;
use crate::judge::referee::judge;
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::{Complex, Dyad};
use crate::task::Problem;
use crate::task::forms::design_space::Shape;
use crate::task::forms::rows::assembly_of;
use crate::task::forms::torus::Positions;
use rayon::prelude::*;

/// The places of the curves that are paired with one another for a page: it takes some tenths of a second.
pub const PAIRED_ON_A_PAGE: usize = 96;
/// As [`PAIRED_ON_A_PAGE`], of a drawing that follows the hand.
pub const PAIRED_LIVE: usize = 40;

/// A place of the curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosePlace {
    /// The circle point: the pin in the body's frame.
    pub pin: Complex,
    /// The centre point: the fixed pivot.
    pub pivot: Complex,
    /// The worst transmission angle between the poses, in degrees, of the best linkage without a defect that has this dyad, or the
    /// one of its sample; `None` if there is no such linkage.
    pub transmission_deg: Option<f64>,
}

/// Returns the curves of a motion of four poses in stretches without a gap, marked by some `paired` places; one that closes has its
/// first place again at its end. `None` of another task, and where more than a curve of dyads meets the poses.
pub fn pose_curves(problem: &Problem, paired: usize) -> Option<Vec<Vec<PosePlace>>> {
    let task = problem.task();
    let body = task.body().filter(|_| problem.spec().task.is_motion())?;
    let all_have_angles = body.angles.iter().all(Option::is_some);
    let starts = DyadStarts::new(problem);
    let poses = starts.poses().first_chunk::<4>().filter(|_| all_have_angles && task.len() == 4)?;
    let strands = four_curve_strands(poses);
    let each = strands.iter().map(|strand| strand.dyads.len()).sum::<usize>().div_ceil(paired).max(1);
    let middle = |places: &[Dyad]| places[places.len() / 2];
    let dyads: Vec<Dyad> = strands.iter().flat_map(|strand| strand.dyads.chunks(each).map(middle)).collect();
    let with_earlier = |i: usize| -> Vec<Option<f64>> {
        dyads[..i].iter().map(|other| transmission(problem, &starts, [&dyads[i], other])).collect()
    };
    let of_pairs: Vec<Vec<Option<f64>>> = (0..dyads.len()).into_par_iter().map(with_earlier).collect();
    let mut marks = vec![None; dyads.len()];
    for (i, with_earlier) in of_pairs.iter().enumerate() {
        for (j, deg) in with_earlier.iter().enumerate() {
            for mark in [i, j] {
                marks[mark] = [marks[mark], *deg].into_iter().flatten().reduce(f64::max);
            }
        }
    }
    let mut marks = marks.into_iter();
    let mut stretches = Vec::with_capacity(strands.len());
    for strand in &strands {
        let mut places = Vec::with_capacity(strand.dyads.len() + 1);
        for chunk in strand.dyads.chunks(each) {
            let transmission_deg = marks.next().flatten();
            places.extend(chunk.iter().filter_map(|dyad| match *dyad {
                Dyad::RR { pin, pivot, .. } => Some(PosePlace { pin, pivot, transmission_deg }),
                Dyad::PR { .. } | Dyad::RP { .. } => None,
            }));
        }
        if let (true, Some(first)) = (strand.is_closed, places.first()) {
            places.push(*first);
        }
        stretches.push(places);
    }
    (!stretches.is_empty()).then_some(stretches)
}

/// Returns the worst transmission angle between the poses, in degrees, of the linkage of two dyads, the better of those driven by
/// either; `None` if both have a defect.
fn transmission(problem: &Problem, starts: &DyadStarts<'_>, [one, other]: [&Dyad; 2]) -> Option<f64> {
    let of = |crank: &Dyad, follower: &Dyad| {
        let (shape, positions) = starts.positions_of(crank, follower)?;
        free_of_defects(problem, &shape, &positions)
    };
    of(one, other).into_iter().chain(of(other, one)).reduce(f64::max)
}

/// Returns the worst transmission angle between the positions, in degrees; `None` if the motion has a defect.
fn free_of_defects(problem: &Problem, shape: &Shape, positions: &Positions) -> Option<f64> {
    let assemblies = positions.iter().map(|[e, u]| assembly_of(shape, *e, *u)).collect::<Vec<_>>();
    let linkage = shape.linkage(*assemblies.first()?).ok()?;
    let angles = positions.iter().map(|[e, _]| e.arg()).collect();
    let (crank_deg, assemblies) = unwrapped(problem, linkage, angles, assemblies);
    let crank_angles: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let verdict = judge(problem.task(), linkage, &crank_angles, &assemblies);
    verdict.defects.is_empty().then(|| verdict.motion.transmission().worst().to_degrees())
}
