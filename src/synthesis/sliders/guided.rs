//! Starts of linkages with a slider that guide a body: every pair of a crank's dyad and a slider's dyad that suit its poses.
//!
//! A body on a crank (RR) and a pin on a fixed line (PR) is the coupler of a slider-crank; on a crank and a line of its own
//! over a fixed pin (RP), that of an inverted one. In the body's frame, C the crank's pin, n the normal of the line:
//!
//! ```text
//! slider-crank    u = (D - C)/|D - C|,  b = |D - C|,  s = -i n,  q = h
//! inverted        u = -i n,  the offset of B is h - <n, C>
//! Z = -C conj(u),  beta = -arg u
//! ```

use super::starts::{Start, Target};
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, Dyad, LinkageKind, Pose, dot};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::constants::sliders::{ACROSS, FOURS};
use crate::synthesis::dyads::{Driving, driving_dyad, pin_on_line, pin_on_line_across};
use crate::synthesis::motion::DyadStarts;
use crate::task::forms::slider::fit::settle;
use crate::task::forms::slider::shape::{Closure, FRAME, SliderShape};
use crate::task::forms::start::AS_WRITTEN;
use crate::task::forms::torus::Positions;
use crate::task::{Problem, Timing};
use std::f64::consts::PI;

/// A generator of starts for the poses of a motion.
pub(super) struct Guided<'a> {
    problem: &'a Problem,
    cranks: DyadStarts<'a>,
    poses: Vec<Pose>,
}

/// A crank's dyad, with its direction where its turn is zero and the direction of its turns, of prescribed timing.
struct Crank {
    dyad: Dyad,
    angle: f64,
    direction: f64,
}

impl<'a> Guided<'a> {
    /// Creates the generator of a motion; `None` for a path.
    pub(super) fn of(problem: &'a Problem) -> Option<Guided<'a>> {
        let task = problem.task();
        let body = task.body().filter(|_| !task.is_function())?;
        let given = task.points().iter().zip(&body.angles);
        let poses = given.filter_map(|(point, angle)| Some(Pose::new(*point, (*angle)?))).collect();
        Some(Guided { problem, cranks: DyadStarts::new(problem), poses })
    }

    /// Returns the starts of a round at every pair of its cranks and its sliders; in the `first` round these are those that
    /// the poses themselves suggest, too.
    pub(super) fn starts(
        &self,
        target: &Target,
        kind: LinkageKind,
        first: bool,
        stream: &mut Stream,
    ) -> Vec<Start> {
        let cranks = self.cranks(first, stream);
        let sliders = self.sliders(kind, first, stream);
        let mut starts = Vec::with_capacity(cranks.len() * sliders.len());
        for crank in &cranks {
            for slider in &sliders {
                starts.extend(self.start(target, crank, slider));
            }
        }
        starts
    }

    fn cranks(&self, first: bool, stream: &mut Stream) -> Vec<Crank> {
        let task = self.problem.task();
        let Timing::Prescribed { crank_angles, .. } = task.timing() else {
            let direction = self.problem.directions()[0];
            let dyads = self.cranks.dyads(first, stream);
            return dyads.into_iter().map(|dyad| Crank { dyad, angle: 0.0, direction }).collect();
        };
        let angles = task.body().map_or(&[][..], |body| &body.angles);
        let driven = |&direction: &f64| {
            let given = (0..task.len()).filter(|j| angles[*j].is_some() && !task.is_untimed(*j));
            let (mut poses, mut turns, mut weights) = (Vec::new(), Vec::new(), Vec::new());
            for j in given {
                poses.extend(angles[j].map(|angle| Pose::new(task.points()[j], angle)));
                turns.push(direction * crank_angles[j]);
                weights.push(task.weights()[j]);
            }
            let Driving { dyad, angle } = driving_dyad(&poses, &turns, &weights)?;
            Some(Crank { dyad, angle, direction })
        };
        self.problem.directions().iter().filter_map(driven).collect()
    }

    /// Returns the sliders of a kind: the best of all, in the first round, those of sets of four poses, and those of drawn
    /// lines.
    fn sliders(&self, kind: LinkageKind, first: bool, stream: &mut Stream) -> Vec<Dyad> {
        let is_inverted = kind == LinkageKind::InvertedSliderCrank;
        let seen: Vec<Pose> =
            self.poses.iter().map(|pose| if is_inverted { pose.inverse() } else { *pose }).collect();
        let mut sliders = Vec::new();
        if first {
            sliders.extend(pin_on_line(&seen));
        }
        if seen.len() > 4 {
            sliders.extend((0..FOURS).filter_map(|_| pin_on_line(&four(&seen, stream))));
        }
        let reach = self.problem.task().size();
        sliders.extend((0..ACROSS).filter_map(|_| across(&seen, reach, stream)));
        if is_inverted { sliders.iter().map(Dyad::inverse).collect() } else { sliders }
    }

    /// Returns the start at a pair of dyads.
    fn start(&self, target: &Target, crank: &Crank, slider: &Dyad) -> Option<Start> {
        let (shape, frame) = shape(&crank.dyad, slider)?;
        let (size, centre) = (target.size, target.centre);
        let shape = shape.carried(Complex::new(1.0 / size, 0.0), -centre / size);
        let mut positions = self.positions(target, &shape, frame)?;
        let assembly = shape.assembly_of(*positions.first()?);
        let is_free = matches!(self.problem.task().timing(), Timing::Free);
        if is_free {
            if !settle(&shape, &mut positions) {
                return None;
            }
        } else if target.own.is_empty() {
            positions.clear();
        }
        let offset = if self.problem.offset_is_free() { crank.angle } else { 0.0 };
        let mut x = shape.unknowns(offset, 0.0);
        x[FRAME] = frame;
        let kind = match shape.closure {
            Closure::Line { .. } => LinkageKind::SliderCrank,
            Closure::Block { .. } => LinkageKind::InvertedSliderCrank,
        };
        let turns = shape.linkage(assembly).ok()?.mobility().input_turns_fully();
        let direction = crank.direction;
        Some(Start { kind, x, positions, assembly, direction, turns, scales: AS_WRITTEN })
    }

    /// Returns the positions at all targets, in units of the target: at the poses by the body's place there, else at the
    /// nearest point of the coupler's curve.
    fn positions(&self, target: &Target, shape: &SliderShape, frame: f64) -> Option<Positions> {
        let angles = &self.problem.task().body()?.angles;
        let at_pose = |point: &Complex, angle: f64| {
            let u = Complex::from_polar(1.0, angle - frame);
            let crank = point - shape.offset * u - shape.crank_pivot;
            (crank.norm() > 0.0).then(|| [crank / crank.norm(), u])
        };
        let first = target.points.iter().zip(angles).find_map(|(point, angle)| at_pose(point, (*angle)?))?;
        let mut curve = None;
        let mut on_curve = |point: &Complex| {
            if curve.is_none() {
                let linkage = shape.linkage(shape.assembly_of(first)).ok()?;
                let (angle, own) = (first[0].arg(), AssemblyMode::Plus);
                curve = Some((linkage, CouplerCurve::through(&linkage, angle, own, DEFAULT_SAMPLES)));
            }
            let (linkage, curve) = curve.as_ref()?;
            let (angle, sign) = curve.position_at(curve.nearest(*point)?.parameter);
            let coupler = linkage.joints_with(angle, sign)?.coupler;
            // The linkage's own direction may be the shape's turned by half a turn.
            let e = Complex::from_polar(1.0, angle);
            [coupler, -coupler]
                .into_iter()
                .map(|u| [e, u])
                .min_by(|one, other| shape.miss(*one).value.abs().total_cmp(&shape.miss(*other).value.abs()))
        };
        let position = |(point, angle): (&Complex, &Option<f64>)| match angle {
            Some(angle) => at_pose(point, *angle),
            None => on_curve(point),
        };
        target.points.iter().zip(angles).map(position).collect()
    }
}

/// Draws four of the poses.
fn four(poses: &[Pose], stream: &mut Stream) -> Vec<Pose> {
    let mut left: Vec<usize> = (0..poses.len()).collect();
    (0..4).map(|_| poses[left.swap_remove(below(stream, left.len()))]).collect()
}

/// Draws a PR dyad: the best one with a line of a drawn normal; of fewer than three poses a drawn pin with a line through
/// its places.
fn across(poses: &[Pose], reach: f64, stream: &mut Stream) -> Option<Dyad> {
    let normal = Complex::from_polar(1.0, uniform(stream, 0.0, PI));
    if poses.len() >= 3 {
        return pin_on_line_across(poses, normal);
    }
    let pin = Complex::new(uniform(stream, -reach, reach), uniform(stream, -reach, reach));
    let [first, last] = [poses.first()?.at(pin), poses.last()?.at(pin)];
    let along = last - first;
    let normal = if along.norm() > 0.0 { Complex::i() * along / along.norm() } else { normal };
    Some(Dyad::PR { pin, normal, distance: dot(normal, first) })
}

/// Returns the linkage of a crank and a slider with the frame of its body; `None` if two of its pins are one.
fn shape(crank: &Dyad, slider: &Dyad) -> Option<(SliderShape, f64)> {
    let Dyad::RR { pin: c, pivot, length } = *crank else { return None };
    let (u, closure) = match *slider {
        Dyad::PR { pin: d, normal, distance } => {
            let coupler = (d - c).norm();
            let direction = -Complex::i() * normal;
            ((d - c) / coupler, Closure::Line { coupler, height: distance, direction })
        }
        Dyad::RP { pivot, normal, distance } => {
            (-Complex::i() * normal, Closure::Block { pivot, offset: distance - dot(normal, c) })
        }
        Dyad::RR { .. } => return None,
    };
    let shape = SliderShape { crank_pivot: pivot, crank: length, offset: -c * u.conj(), closure };
    (u.is_finite() && length > 0.0).then(|| (shape, -u.arg()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::stream;

    #[test]
    fn a_pair_of_dyads_is_a_linkage_that_carries_its_pins() {
        let draws = &mut stream(7, 0);
        for case in 0..60 {
            let mut place = || Complex::new(uniform(draws, -2.0, 2.0), uniform(draws, -2.0, 2.0));
            let (c, d, a, b) = (place(), place(), place(), place());
            let pose = Pose::new(place(), place().arg());
            let normal = place() / place().norm();
            let normal = normal / normal.norm();
            let crank = Dyad::RR { pin: c, pivot: a, length: (pose.at(c) - a).norm() };
            let sliders = [
                Dyad::PR { pin: d, normal, distance: dot(normal, pose.at(d)) },
                Dyad::RP { pivot: b, normal, distance: dot(normal, pose.body_point(b)) },
            ];
            for slider in sliders {
                let (shape, frame) = shape(&crank, &slider).expect("a linkage");
                let u = pose.direction * Complex::from_polar(1.0, -frame);
                let e = (pose.at(c) - a) / shape.crank;
                assert!(shape.miss([e, u]).value.abs() < 1e-12, "case {case}: {slider:?}");
                assert!((shape.coupler_point([e, u]) - pose.position).norm() < 1e-12);
            }
        }
    }
}
