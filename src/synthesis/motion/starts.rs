//! Starts of a motion search: pairs of dyads that guide the body nearly through its poses.
//!
//! The first round takes the dyads that the poses themselves suggest: those of the kernel of their linear rows, the
//! minima of the map of circle errors, and dyads through a few sets of five poses. Later rounds draw further sets of five,
//! and pins at random, each with its best circle. Every two dyads are a linkage, either of them the crank.

use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, CouplerSide, Dyad, Pose};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::constants::motion::{FAMILY_PINS, GRID, MINIMA, PINS, REACH, SETS_FIRST, SETS_LATER};
use crate::synthesis::dyads::{
    Pair, circle_fit, circle_minima, nearest_in_kernel, pair, through_four_curve, through_random_five,
    through_three_from_pin,
};
use crate::synthesis::family::freedom;
use crate::task::forms::design_space::Shape;
use crate::task::forms::rows::{assembly_of, nearest_type};
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::forms::torus::Positions;
use crate::task::{Problem, Setting};

/// The distance of pins and pivots, in sizes of the target, within which two dyads are one.
const SAME_PIN: f64 = 1e-6;
/// Places on the curve of the dyads through four poses.
const CURVE: usize = 400;

/// A generator of starts for the poses of a problem.
pub(in crate::synthesis) struct DyadStarts<'a> {
    pub(super) problem: &'a Problem,
    /// The poses of the targets that give an angle, with their weights.
    pub(super) poses: Vec<Pose>,
    pub(super) weights: Vec<f64>,
    /// Whether the exact answers form a family.
    pub(super) family: bool,
}

impl<'a> DyadStarts<'a> {
    pub(in crate::synthesis) fn new(problem: &'a Problem) -> Self {
        let task = problem.task();
        let angles = task.body().map_or(&[][..], |body| &body.angles);
        let given = task.points().iter().zip(angles).zip(task.weights());
        let (poses, weights) = given
            .filter_map(|((point, angle), weight)| Some((Pose::new(*point, (*angle)?), *weight)))
            .unzip();
        DyadStarts { problem, poses, weights, family: freedom(problem) > 0 }
    }

    /// Returns the poses of the targets that give an angle.
    pub(in crate::synthesis) fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Returns the linkage of a crank's dyad and a follower's one with its positions at all targets; `None` if they are no
    /// linkage.
    pub(in crate::synthesis) fn positions_of(
        &self,
        crank: &Dyad,
        follower: &Dyad,
    ) -> Option<(Shape, Positions)> {
        let pair = pair(crank, follower)?;
        Some((pair.shape, self.positions(&pair)?))
    }

    /// Returns the dyads of a round: those that the poses suggest in the first one, else drawn ones.
    pub(in crate::synthesis) fn dyads(&self, first: bool, stream: &mut Stream) -> Vec<Dyad> {
        let poses = self.poses.as_slice();
        let mut dyads = Vec::new();
        if first {
            dyads = nearest_in_kernel(poses);
            let mut minima = circle_minima(poses, Some(&self.weights), GRID, REACH);
            minima.truncate(MINIMA);
            dyads.extend(minima);
        }
        for _ in 0..if first { SETS_FIRST } else { SETS_LATER } {
            dyads.extend(through_random_five(poses, stream));
        }
        dyads.extend(self.on_the_curve(stream));
        let least = if self.family { FAMILY_PINS } else { PINS };
        while dyads.len() < least {
            match self.drawn(stream) {
                Some(dyad) => dyads.push(dyad),
                None => break,
            }
        }
        distinct(dyads, self.problem.task().size())
    }

    /// Returns whether dyads of known answers are crossed with others: all targets are poses, and more than can be met
    /// exactly.
    pub(super) fn are_crossed(&self) -> bool {
        !self.family
            && !self.are_on_lines()
            && self.poses.len() == self.problem.task().len()
            && self.poses.len() > 5
    }

    /// Draws dyads from the curve of those through four poses; none for another number of poses.
    fn on_the_curve(&self, stream: &mut Stream) -> Vec<Dyad> {
        let Ok(four) = <[Pose; 4]>::try_from(self.poses.as_slice()) else { return Vec::new() };
        let all = through_four_curve(&four, CURVE);
        let most = if all.is_empty() { 0 } else { FAMILY_PINS };
        (0..most).map(|_| all[below(stream, all.len())]).collect()
    }

    /// Draws a pin of the body, with the circle that it stays nearest to.
    pub(super) fn drawn(&self, stream: &mut Stream) -> Option<Dyad> {
        let reach = REACH * self.problem.task().size();
        let [x0, y0, x1, y1] = match &self.problem.spec().require.pins_in {
            None => [-reach, -reach, reach, reach],
            Some(region) => region.corners(),
        };
        for _ in 0..PINS {
            let pin = Complex::new(uniform(stream, x0, x1), uniform(stream, y0, y1));
            let dyad = match *self.poses.as_slice() {
                [] => None,
                [one] => {
                    let to = Complex::new(uniform(stream, -reach, reach), uniform(stream, -reach, reach));
                    Some(Dyad::RR { pin, pivot: one.at(pin) + to, length: to.norm() })
                }
                [one, other] => {
                    // Any point of the perpendicular bisector is a pivot.
                    let (from, to) = (one.at(pin), other.at(pin));
                    let along = Complex::new(0.5, uniform(stream, -REACH, REACH));
                    let pivot = from + (to - from) * along;
                    Some(Dyad::RR { pin, pivot, length: (from - pivot).norm() })
                }
                [one, second, third] => through_three_from_pin(&[one, second, third], pin),
                _ => circle_fit(&self.poses, pin, Some(&self.weights)).map(|fit| fit.dyad(pin)),
            };
            if dyad.is_some() {
                return dyad;
            }
        }
        None
    }

    /// Returns the starts at every two of the dyads.
    pub(super) fn pairs(&self, dyads: &[Dyad]) -> Vec<Start> {
        let mut starts = Vec::new();
        for (i, one) in dyads.iter().enumerate() {
            for other in &dyads[..i] {
                starts.extend(pair(one, other).and_then(|pair| self.start(&pair)));
            }
        }
        starts
    }

    /// Returns the start at a pair of dyads; the crank is the first one or, if that alone is on one branch, the second.
    pub(super) fn start(&self, pair: &Pair) -> Option<Start> {
        let positions = self.positions(pair)?;
        let setting = Setting {
            aim: None,
            assembly: AssemblyMode::Plus,
            direction: self.problem.directions()[0],
            side: CouplerSide::of(pair.shape.offset.im),
        };
        let as_it_is = made(self.problem, setting, &pair.shape, pair.frame_angle, positions)?;
        let other = swapped(self.problem, &as_it_is);
        let serves = |start: &Start| is_on_one_branch(self.problem, start);
        match other {
            Some(other) if serves(&other) && !serves(&as_it_is) => Some(other),
            _ => Some(as_it_is),
        }
    }

    /// Returns the positions of a pair at all targets: at the poses by the body's place there, else at the nearest point of
    /// the coupler's curve.
    fn positions(&self, pair: &Pair) -> Option<Positions> {
        let at_poses = pair.positions(&self.poses)?;
        let task = self.problem.task();
        if at_poses.len() == task.len() {
            return Some(at_poses);
        }
        let angles = &task.body()?.angles;
        let [e, u] = *at_poses.first()?;
        let assembly = assembly_of(&pair.shape, e, u);
        let linkage = pair.shape.linkage(assembly).ok()?;
        let curve = CouplerCurve::through(&linkage, e.arg(), assembly, DEFAULT_SAMPLES);
        let mut poses = at_poses.into_iter();
        let position = |(target, angle): (&Complex, &Option<f64>)| {
            if angle.is_some() {
                return poses.next();
            }
            let (crank_angle, assembly) = curve.position_at(curve.nearest(*target)?.parameter);
            let joints = linkage.position_with(crank_angle, assembly).joints()?;
            let coupler = joints.follower_pin - joints.crank_pin;
            Some([Complex::from_polar(1.0, crank_angle), coupler / pair.shape.coupler])
        };
        task.points().iter().zip(angles).map(position).collect()
    }
}

/// Returns the RR dyads without those that repeat an earlier one, for a target of this size.
pub(super) fn distinct(dyads: Vec<Dyad>, size: f64) -> Vec<Dyad> {
    let near = SAME_PIN * size;
    let mut distinct: Vec<Dyad> = Vec::with_capacity(dyads.len());
    for dyad in dyads {
        let Dyad::RR { pin, pivot, .. } = dyad else { continue };
        let is_same = |other: &Dyad| match other {
            Dyad::RR { pin: p, pivot: g, .. } => (p - pin).norm() < near && (g - pivot).norm() < near,
            Dyad::PR { .. } | Dyad::RP { .. } => false,
        };
        if !distinct.iter().any(is_same) {
            distinct.push(dyad);
        }
    }
    distinct
}

/// Returns the start of a shape with the frame of its body; it aims at the nearest type if types are required.
fn made(
    problem: &Problem,
    setting: Setting,
    shape: &Shape,
    frame: f64,
    positions: Positions,
) -> Option<Start> {
    let aim = if problem.aims_at_types() { nearest_type(shape.links(), problem.types()) } else { None };
    let [e, u] = *positions.first()?;
    let setting = Setting {
        aim,
        assembly: assembly_of(shape, e, u),
        side: CouplerSide::of(shape.offset.im),
        ..setting
    };
    Some(Start {
        design: problem.space(setting.side).design(shape, frame),
        setting,
        positions,
        scales: AS_WRITTEN,
    })
}

/// Returns the start with crank and follower exchanged: the same linkage, driven from its other side; `None` where the fixed
/// pivots have lines of their own.
///
/// ```text
/// e' = (A + a e + b u - B)/c,   u' = -u,   Z' = b - Z,   beta' = beta + pi
/// ```
pub(in crate::synthesis) fn swapped(problem: &Problem, start: &Start) -> Option<Start> {
    if problem.spec().require.pivot_on.is_some() {
        return None;
    }
    let space = problem.space(start.setting.side);
    let shape = space.shape(&start.design)?;
    let exchanged = Shape {
        crank_pivot: shape.follower_pivot,
        follower_pivot: shape.crank_pivot,
        crank: shape.follower,
        coupler: shape.coupler,
        follower: shape.crank,
        offset: shape.coupler - shape.offset,
    };
    let position = |[e, u]: &[Complex; 2]| {
        let follower = shape.crank_pivot + e * shape.crank + u * shape.coupler - shape.follower_pivot;
        let length = follower.norm();
        (length > 0.0).then(|| [follower / length, -u])
    };
    let positions: Option<Positions> = start.positions.iter().map(position).collect();
    let frame = space.offset(&start.design) + std::f64::consts::PI;
    made(problem, start.setting, &exchanged, frame, positions?)
}

/// Returns the least |sin mu| over the positions of a start, mu the angle between coupler and follower; negative if they are
/// not on one branch.
pub(super) fn least_sine(problem: &Problem, start: &Start) -> f64 {
    let Some(shape) = problem.space(start.setting.side).shape(&start.design) else { return -1.0 };
    let sine = |[e, u]: &[Complex; 2]| {
        let follower = shape.crank_pivot + e * shape.crank + u * shape.coupler - shape.follower_pivot;
        ((follower.conj() * u).im / follower.norm()).abs()
    };
    let least = start.positions.iter().map(sine).fold(f64::INFINITY, f64::min);
    if is_on_one_branch(problem, start) { least } else { least - 2.0 }
}

/// Returns whether all positions of a start have one assembly.
fn is_on_one_branch(problem: &Problem, start: &Start) -> bool {
    let Some(shape) = problem.space(start.setting.side).shape(&start.design) else { return false };
    let mut assemblies = start.positions.iter().map(|[e, u]| assembly_of(&shape, *e, *u));
    let first = assemblies.next();
    assemblies.all(|assembly| Some(assembly) == first)
}
