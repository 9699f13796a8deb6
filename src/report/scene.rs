//! The scene of a candidate's drawing: target points, the circuits used, and one position of the linkage.

use super::guide::Sliding;
use super::{body, function, loops};
use crate::mechanism::{
    AssemblyMode, Complex, CouplerCurve, CrankLinkage, Joints, LoopJoints, MAX_MAGNITUDE, dot, point,
};
use crate::record::{Candidate, Record};
use crate::task::spec::TaskSpec;
use std::f64::consts::{PI, TAU};

/// The number of samples of a circuit for a drawing: half a degree of the crank, far below a pixel.
pub(super) const SAMPLES: usize = 720;

/// A target point and the coupler point's place at it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) index: usize,
    pub(super) at: Complex,
    pub(super) reached: Option<Complex>,
    /// The angle of the body there, in a motion, radians.
    pub(super) angle: Option<f64>,
    /// The angle that the body has instead.
    pub(super) reached_angle: Option<f64>,
}

/// The linkage at one position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// The index of the target point of this position; `None` if the loop closes at no target point.
    pub(super) target: Option<usize>,
    /// A, B, C, D, P; B of a slider-crank, which has no second pivot, is D.
    pub(super) joints: [Complex; 5],
    /// The direction of the coupler from C.
    pub(super) coupler: Complex,
}

/// A candidate, ready to be drawn. Without a candidate, the target alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub(super) linkage: Option<CrankLinkage>,
    pub(super) targets: Vec<Target>,
    /// The joints along each circuit used, the first point's circuit first.
    pub(super) circuits: Vec<Vec<Joints>>,
    pub(super) pose: Option<Pose>,
}

impl Scene {
    pub(super) fn new(record: &Record, candidate: Option<&Candidate>) -> Self {
        match candidate {
            None => Scene { targets: targets(record, None, &|_| None), ..Scene::default() },
            Some(candidate) => {
                let scene = Scene::of(
                    record,
                    &candidate.linkage,
                    &positions(candidate),
                    candidate.frame_deg,
                    SAMPLES,
                );
                let pins = output_pins(record, candidate);
                if pins.is_empty() { scene } else { Scene { targets: pins, ..scene } }
            }
        }
    }

    /// Returns the scene of a linkage at crank angle (radians) and assembly at each point, with `samples` positions of
    /// each circuit. The body of a motion lies at `frame_deg` from the direction C -> D.
    pub(super) fn of(
        record: &Record,
        linkage: &CrankLinkage,
        positions: &[(f64, AssemblyMode)],
        frame_deg: Option<f64>,
        samples: usize,
    ) -> Self {
        let reach = |j: usize| {
            let (angle, assembly) = *positions.get(j)?;
            linkage.joints_with(angle, assembly)
        };
        let circuits = circuits_of(linkage, positions, samples);
        let pose = legible_pose(linkage, positions).or_else(|| {
            let at = circuits.first()?.first()?;
            let coupler = at.follower_pin - at.crank_pin;
            Some(Pose { target: None, joints: all_joints(linkage, at), coupler })
        });
        Scene { linkage: Some(*linkage), targets: targets(record, frame_deg, &reach), circuits, pose }
    }

    /// Returns whether the linkage has a second fixed pivot.
    pub(super) fn has_two_pivots(&self) -> bool {
        self.linkage.as_ref().is_none_or(|linkage| linkage.second_pivot().is_some())
    }

    /// Returns the box of the target points and the coupler points that they are compared with.
    pub(super) fn target_bounds(&self) -> Bounds {
        Bounds::of(self.targets.iter().flat_map(|target| std::iter::once(target.at).chain(target.reached)))
    }

    /// Returns the box of the target points and the coupler curve.
    pub(super) fn curve_bounds(&self) -> Bounds {
        let mut bounds = self.target_bounds();
        self.circuits.iter().flatten().for_each(|joints| bounds.hold(joints.coupler_point));
        bounds
    }

    /// Returns the box of everything, over the whole motion.
    pub(super) fn bounds(&self) -> Bounds {
        let mut bounds = self.curve_bounds();
        let pivots = self.linkage.iter().flat_map(CrankLinkage::pivots);
        let pins = self.circuits.iter().flatten().flat_map(|joints| [joints.crank_pin, joints.follower_pin]);
        pivots.chain(pins).for_each(|p| bounds.hold(p));
        let several = self.linkage.as_ref().and_then(CrankLinkage::multi_loop);
        several.iter().flat_map(|linkage| loops::paths(linkage)).flatten().for_each(|p| bounds.hold(p));
        if let Some(sliding) = self.pose.as_ref().and_then(|pose| Sliding::of(self, pose)) {
            sliding.ends().into_iter().for_each(|p| bounds.hold(p));
        }
        bounds
    }
}

/// Returns the target points that can be drawn, each with the coupler point's place at it, and in a motion with the body's
/// angles.
fn targets(
    record: &Record,
    frame_deg: Option<f64>,
    reached: &dyn Fn(usize) -> Option<LoopJoints>,
) -> Vec<Target> {
    let TaskSpec { points, body, .. } = &record.problem.resolved.task;
    let usable = points.iter().enumerate().filter(|(_, p)| p.iter().all(|x| x.abs() <= MAX_MAGNITUDE));
    let target = |(index, p): (usize, &[f64; 2])| {
        let at = reached(index);
        let wanted = body.as_ref().and_then(|body| *body.angle_deg.get(index)?);
        let generated =
            |at: LoopJoints| Some(body::generated(at.coupler, frame_deg.filter(|_| wanted.is_some())?));
        Target {
            index,
            at: point(*p),
            reached: at.map(|at| at.joints.coupler_point),
            angle: wanted.map(f64::to_radians),
            reached_angle: at.and_then(generated),
        }
    };
    usable.map(target).collect()
}

/// Returns the places of the follower's or the slider's pin at the outputs that are wanted of a function, each with its place at
/// the one generated; none for another task, or for a block, which has no pin that its output moves.
fn output_pins(record: &Record, candidate: &Candidate) -> Vec<Target> {
    let Some(at) = output_pin(candidate) else { return Vec::new() };
    let pairs = function::pairs(&record.problem.resolved.task, candidate);
    let target = |(index, pair): (usize, &function::GeneratedPair)| Target {
        index,
        at: at(pair.wanted),
        reached: pair.generated.map(&at),
        angle: None,
        reached_angle: None,
    };
    pairs.iter().enumerate().map(target).collect()
}

/// Returns the place of the output link's pin at an output.
fn output_pin(candidate: &Candidate) -> Option<Box<dyn Fn(f64) -> Complex + '_>> {
    let sign = candidate.sense?.signs()[0];
    let (pivot, ground_angle) = (candidate.linkage.crank_pivot(), candidate.linkage.ground_angle());
    match &candidate.linkage {
        CrankLinkage::FourBar(linkage) => {
            let offset = candidate.output_offset_deg?;
            Some(Box::new(move |output| {
                let angle = ground_angle + (offset + sign * output).to_radians();
                linkage.follower_pivot() + Complex::from_polar(linkage.follower(), angle)
            }))
        }
        CrankLinkage::SliderCrank(linkage) => {
            let (offset, along) = (candidate.output_offset?, linkage.line_direction());
            let foot = linkage.line_point() + along * dot(pivot - linkage.line_point(), along);
            Some(Box::new(move |output| foot + along * (sign * (offset + output))))
        }
        CrankLinkage::InvertedSliderCrank(_) | CrankLinkage::MultiLoop(_) => None,
    }
}

/// Returns the crank angle (radians) and assembly at each point that has both.
pub(super) fn positions_at(crank_deg: &[f64], t1_at: &[AssemblyMode]) -> Vec<(f64, AssemblyMode)> {
    crank_deg.iter().map(|angle| angle.to_radians()).zip(t1_at.iter().copied()).collect()
}

fn positions(candidate: &Candidate) -> Vec<(f64, AssemblyMode)> {
    positions_at(&candidate.crank_deg, &candidate.t1_at)
}

/// Returns a position on the circuit of the first point: crank angle (radians) and assembly.
pub(super) fn first_position(candidate: &Candidate) -> (f64, AssemblyMode) {
    first_of(&candidate.linkage, &positions(candidate))
}

fn first_of(linkage: &CrankLinkage, positions: &[(f64, AssemblyMode)]) -> (f64, AssemblyMode) {
    let first = positions.first().copied().filter(|(angle, _)| angle.is_finite());
    first.unwrap_or_else(|| middle_position(linkage))
}

/// Returns a position in the middle of the input's range; if the loop does not determine the follower there (C on B, as
/// in a rhombus at one crank angle), the nearest of several others at which the linkage can be assembled.
pub(crate) fn middle_position(linkage: impl Into<CrankLinkage>) -> (f64, AssemblyMode) {
    /// Offsets from the middle, as fractions of a half turn or of half the arc.
    const ASIDE: [f64; 9] = [0.0, 1.0 / 3.0, -1.0 / 3.0, 0.5, -0.5, 2.0 / 3.0, -2.0 / 3.0, 0.1, -0.1];
    let linkage = linkage.into();
    let arc = linkage.mobility().arc(crate::mechanism::Circuit { index: 0 });
    let (middle, half) = arc.map_or((0.0, PI), |arc| (arc.middle, arc.half_width));
    let assembly = linkage.assembly();
    let angles = ASIDE.map(|part| middle + part * half);
    let joined = angles.into_iter().find(|angle| linkage.joints_with(*angle, assembly).is_some());
    (joined.unwrap_or(middle), assembly)
}

/// Returns the joints along every circuit on which a point is reached, `samples` positions each.
pub(super) fn circuits(candidate: &Candidate, samples: usize) -> Vec<Vec<Joints>> {
    circuits_of(&candidate.linkage, &positions(candidate), samples)
}

fn circuits_of(
    linkage: &CrankLinkage,
    positions: &[(f64, AssemblyMode)],
    samples: usize,
) -> Vec<Vec<Joints>> {
    let all = std::iter::once(first_of(linkage, positions)).chain(positions.iter().copied());
    circuits_through(linkage, all, samples)
}

/// Returns the joints along every circuit that contains one of the positions (crank angle in radians, assembly).
pub(crate) fn circuits_through(
    linkage: impl Into<CrankLinkage>,
    positions: impl IntoIterator<Item = (f64, AssemblyMode)>,
    samples: usize,
) -> Vec<Vec<Joints>> {
    let circuits = positions_through(linkage, positions, samples);
    circuits.into_iter().map(|circuit| circuit.into_iter().map(|at| at.joints).collect()).collect()
}

/// Returns the positions along every circuit that contains one of the positions (crank angle in radians, assembly).
pub(super) fn positions_through(
    linkage: impl Into<CrankLinkage>,
    positions: impl IntoIterator<Item = (f64, AssemblyMode)>,
    samples: usize,
) -> Vec<Vec<LoopJoints>> {
    let linkage = linkage.into();
    let mobility = linkage.mobility();
    let mut seen = Vec::new();
    let mut circuits = Vec::new();
    for (angle, assembly) in positions {
        let circuit = mobility.branch(angle, assembly).circuit;
        let rocks = mobility.arc(circuit).is_some();
        // If the input turns fully the assemblies are separate circuits; if it rocks they are one circuit.
        let key = (circuit.index, (!rocks).then_some(assembly));
        if !angle.is_finite() || seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let curve = CouplerCurve::through(&linkage, angle, assembly, 8);
        let joints: Vec<LoopJoints> = (0..samples)
            .filter_map(|i| {
                let (angle, assembly) = curve.position_at(TAU * i as f64 / samples as f64);
                linkage.joints_with(angle, assembly)
            })
            .collect();
        if !joints.is_empty() {
            circuits.push(joints);
        }
    }
    circuits
}

/// Returns the position at the first target point, or, if that is hard to read (joints close together), the one at
/// which the closest two joints are farthest apart.
fn legible_pose(linkage: &CrankLinkage, positions: &[(f64, AssemblyMode)]) -> Option<Pose> {
    /// The fraction of the best spacing down to which the first point is kept.
    const GOOD_ENOUGH: f64 = 0.6;
    let poses: Vec<(Pose, f64)> = positions
        .iter()
        .enumerate()
        .filter_map(|(j, (angle, assembly))| {
            let at = linkage.joints_with(*angle, *assembly)?;
            let joints = all_joints(linkage, &at.joints);
            let [a, _, c, d, p] = joints;
            let apart = if linkage.four_bar().is_some() { closest(&joints) } else { closest(&[a, c, d, p]) };
            Some((Pose { target: Some(j), joints, coupler: at.coupler }, apart))
        })
        .collect();
    // The first of equal ones.
    let best = poses.iter().rev().max_by(|x, y| x.1.total_cmp(&y.1))?;
    let first = poses.first()?;
    Some(if first.0.target == Some(0) && first.1 >= GOOD_ENOUGH * best.1 { first.0 } else { best.0 })
}

/// Returns the distance of the closest two points.
pub(super) fn closest(all: &[Complex]) -> f64 {
    let pairs = (0..all.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.map(|(i, j)| (all[i] - all[j]).norm()).fold(f64::INFINITY, f64::min)
}

/// Returns A, B, C, D, P of a linkage at a position; for B of a slider-crank D.
pub(super) fn all_joints(linkage: impl Into<CrankLinkage>, joints: &Joints) -> [Complex; 5] {
    let Joints { crank_pin, follower_pin, coupler_point } = *joints;
    let linkage = linkage.into();
    let second = linkage.second_pivot().unwrap_or(follower_pin);
    [linkage.crank_pivot(), second, crank_pin, follower_pin, coupler_point]
}

/// A bounding box, which grows with the points put into it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Default for Bounds {
    fn default() -> Self {
        Bounds { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }
    }
}

impl Bounds {
    pub(super) fn hold(&mut self, p: Complex) {
        for (axis, x) in [p.re, p.im].into_iter().enumerate() {
            if x.is_finite() {
                self.low[axis] = self.low[axis].min(x);
                self.high[axis] = self.high[axis].max(x);
            }
        }
    }

    /// Returns the box of the points.
    pub(super) fn of(points: impl IntoIterator<Item = Complex>) -> Self {
        let mut bounds = Bounds::default();
        points.into_iter().for_each(|p| bounds.hold(p));
        bounds
    }

    /// Returns the lower left and the upper right corner; infinite ones for an empty box.
    pub(super) fn corners(&self) -> [Complex; 2] {
        [self.low, self.high].map(|[x, y]| Complex::new(x, y))
    }

    /// Returns the width, 0 for an empty box.
    pub(super) fn width(&self) -> f64 {
        (self.high[0] - self.low[0]).max(0.0)
    }

    /// Returns the height, 0 for an empty box.
    pub(super) fn height(&self) -> f64 {
        (self.high[1] - self.low[1]).max(0.0)
    }

    /// Returns the longer side.
    pub(super) fn extent(&self) -> f64 {
        self.width().max(self.height())
    }

    pub(super) fn diagonal(&self) -> f64 {
        self.width().hypot(self.height())
    }

    /// Returns the centre, the origin for an empty box.
    pub(super) fn centre(&self) -> Complex {
        if self.low[0] > self.high[0] || self.low[1] > self.high[1] {
            return Complex::new(0.0, 0.0);
        }
        Complex::new(0.5 * (self.low[0] + self.high[0]), 0.5 * (self.low[1] + self.high[1]))
    }

    /// Returns the box enlarged by `part` of the longer side on every side; one unit wide if it had no extent.
    pub(super) fn padded(&self, part: f64) -> Bounds {
        let pad = if self.extent() > 0.0 { part * self.extent() } else { 0.5 };
        let (c, w, h) = (self.centre(), 0.5 * self.width() + pad, 0.5 * self.height() + pad);
        Bounds { low: [c.re - w, c.im - h], high: [c.re + w, c.im + h] }
    }

    pub(super) fn holds(&self, p: Complex) -> bool {
        (self.low[0]..=self.high[0]).contains(&p.re) && (self.low[1]..=self.high[1]).contains(&p.im)
    }
}

/// Returns the largest of 1, 2, 5 times a power of ten that is at most `length`; 1 if `length` is not positive.
pub(super) fn round_length(length: f64) -> f64 {
    if !(length > 0.0 && length.is_finite()) {
        return 1.0;
    }
    let exponent = length.log10().floor() as i32;
    let candidates = (exponent - 1..=exponent + 1).flat_map(|e| [1, 2, 5].map(|m| (m, e)));
    // Through text, so that the length is the decimal number that is printed.
    let decimal = |(m, e): (i32, i32)| format!("{m}e{e}").parse::<f64>().unwrap_or(1.0);
    candidates.map(decimal).filter(|c| *c <= length && *c > 0.0).fold(f64::MIN_POSITIVE, f64::max)
}
