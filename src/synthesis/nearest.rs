//! Positions at which a given linkage is nearest to a task's points: for linkages that were not placed by a search.

use super::multistart::settle_positions;
use super::{Budget, Context};
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, FourBar, InputRange};
use crate::task::forms::design_space::Shape;
use crate::task::forms::rows::assembly_of;
use crate::task::forms::timed::TimedPathFit;
use crate::task::forms::torus::Positions;
use crate::task::{AngleOffset, Problem, Setting, Timing};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Returns the crank angles (degrees) and assemblies at the points; `None` if there is no position for one.
///
/// Free timing: the nearest point of the circuit that the linkage's own t1 is on (of a rocking Grashof linkage the
/// better of its two circuits). Prescribed timing: the prescribed angles, with the offset and the direction that give
/// the least sum of squares if they are free, on the linkage's own t1.
pub fn nearest_positions(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    match problem.task().timing() {
        Timing::Free if problem.task().body().is_some() => of_body(problem, linkage),
        Timing::Free => free(problem, linkage),
        Timing::Prescribed { .. } if problem.task().is_partly_timed() => partly_timed(problem, linkage),
        Timing::Prescribed { offset, .. } => prescribed(problem, linkage, *offset),
    }
}

/// The distance of the nearest of the samples between two timed targets from the nearest point, degrees: one in 48 of a turn
/// at most.
const BESIDE_SAMPLE_DEG: f64 = 7.5;

/// As [`prescribed`] of the timed targets, with the others where the coupler point is nearest between their neighbours.
fn partly_timed(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let task = problem.task();
    let mut spec = problem.spec().clone();
    let timed: Vec<usize> = (0..task.len()).filter(|j| !task.is_untimed(*j)).collect();
    let of = |list: &[f64]| timed.iter().map(|j| list[*j]).collect::<Vec<f64>>();
    spec.task.points = timed.iter().map(|j| spec.task.points[*j]).collect();
    spec.task.raw = None;
    for list in [&mut spec.task.weight, &mut spec.task.tolerance].into_iter().flatten() {
        *list = of(list);
    }
    if let Some(body) = &mut spec.task.body {
        body.angle_deg = timed.iter().map(|j| body.angle_deg[*j]).collect();
        body.tolerance_deg = body.tolerance_deg.as_ref().map(|list| of(list));
    }
    if let Some(timing) = &mut spec.task.timing {
        (timing.crank_deg, timing.free) = (of(&timing.crank_deg), Vec::new());
    }
    let whole = Problem::new(spec).ok()?;
    let Timing::Prescribed { offset, .. } = whole.task().timing() else { return None };
    let (crank_deg, _) = prescribed(&whole, linkage, *offset)?;
    let written = &problem.spec().task.timing.as_ref()?.crank_deg;
    let steps = (crank_deg[crank_deg.len() - 1] - crank_deg[0])
        * (written[*timed.last()?] - written[*timed.first()?]);
    let direction = if steps < 0.0 { -1.0 } else { 1.0 };
    let base = (crank_deg[0] - direction * written[timed[0]]).to_radians();
    let side = linkage.side();
    let setting = Setting { aim: None, assembly: linkage.assembly(), direction, side };
    let space = problem.space(side);
    let design = space.coordinates(&Shape::from(linkage), if problem.offset_is_free() { base } else { 0.0 });
    let positions = TimedPathFit::new(problem, setting)?.attached(&design)?;
    let distance = |j: usize, deg: f64| {
        let joints = linkage.position_with(deg.to_radians(), linkage.assembly()).joints();
        joints.map_or(f64::INFINITY, |joints| (joints.coupler_point - task.points()[j]).norm())
    };
    let refined = |j: usize, deg: f64| {
        let (mut low, mut high) = (deg - BESIDE_SAMPLE_DEG, deg + BESIDE_SAMPLE_DEG);
        for _ in 0..100 {
            let third = (high - low) / 3.0;
            match distance(j, low + third) <= distance(j, high - third) {
                true => high -= third,
                false => low += third,
            }
        }
        let middle = 0.5 * (low + high);
        if distance(j, middle) <= distance(j, deg) { middle } else { deg }
    };
    let all = positions.iter().zip(written).enumerate().map(|(j, ([e, _], deg))| {
        let guess = base.to_degrees() + direction * deg;
        if task.is_untimed(j) {
            refined(j, guess + wrapped(e.arg() - guess.to_radians()).to_degrees())
        } else {
            guess
        }
    });
    Some((all.collect(), vec![linkage.assembly(); task.len()]))
}

/// Returns a crank angle on each circuit that the linkage's own t1 can be on.
fn on_circuits(linkage: &FourBar) -> Vec<f64> {
    match linkage.mobility().input {
        InputRange::None => Vec::new(),
        InputRange::Full => vec![linkage.ground_angle()],
        InputRange::One(arc) => vec![arc.middle],
        InputRange::Two(arcs) => arcs.iter().map(|arc| arc.middle).collect(),
    }
}

/// A place on a circuit: the crank angle and the assembly.
type Place = (f64, AssemblyMode);
/// The coupler point and the coupler's direction (radians) at a place.
type Sample = (Complex, f64, Place);

/// Places of the circuit at which a body is tried to lie at the first target.
const TRIED: usize = 48;

/// As [`free`] for a body that is fixed to the coupler in the way that gives the least errors: at several places of the
/// circuit the body is taken to lie as at the first target with an angle; the best of these is fitted.
fn of_body(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let task = problem.task();
    let body = task.body()?;
    let first = body.angles.iter().flatten().next()?;
    let mut best: Option<(f64, f64, Vec<Place>)> = None;
    for start in on_circuits(linkage) {
        let curve = CouplerCurve::through(linkage, start, linkage.assembly(), DEFAULT_SAMPLES);
        let samples: Vec<Sample> = (0..DEFAULT_SAMPLES)
            .filter_map(|i| {
                let at = curve.position_at(TAU * i as f64 / DEFAULT_SAMPLES as f64);
                let joints = linkage.position_with(at.0, at.1).joints()?;
                Some((joints.coupler_point, (joints.follower_pin - joints.crank_pin).arg(), at))
            })
            .collect();
        for (_, coupler, _) in samples.iter().step_by(DEFAULT_SAMPLES / TRIED) {
            let frame = first - coupler;
            let (mut sum, mut places) = (0.0, Vec::with_capacity(task.len()));
            for (j, target) in task.points().iter().enumerate() {
                let off = |(point, coupler, _): &&Sample| {
                    let turned = body.angles[j].map_or(0.0, |angle| wrapped(angle - coupler - frame));
                    (target - point).norm_sqr() + (body.angle_weight * turned).powi(2)
                };
                let nearest = samples.iter().min_by(|one, other| off(one).total_cmp(&off(other)))?;
                sum += task.weights()[j] * off(&nearest);
                places.push(nearest.2);
            }
            if best.as_ref().is_none_or(|(least, ..)| sum < *least) {
                best = Some((sum, frame, places));
            }
        }
    }
    let (_, frame, places) = best?;
    let shape = Shape::from(linkage);
    let position = |(angle, assembly): &Place| {
        let joints = linkage.position_with(*angle, *assembly).joints()?;
        let coupler = (joints.follower_pin - joints.crank_pin) / shape.coupler;
        Some([Complex::from_polar(1.0, *angle), coupler])
    };
    let positions: Option<Positions> = places.iter().map(position).collect();
    let setting = Setting { aim: None, assembly: linkage.assembly(), direction: 1.0, side: linkage.side() };
    let design = problem.space(linkage.side()).coordinates(&shape, frame);
    let budget = Budget::new(&NEVER, None);
    let fitted = settle_positions(Context::new(problem, &budget), &design, setting, positions?)?;
    let angles = fitted.iter().map(|[e, _]| e.arg()).collect();
    let assemblies = fitted.iter().map(|[e, u]| assembly_of(&shape, *e, *u)).collect();
    Some(unwrapped(problem, linkage, angles, assemblies))
}

/// A search that nothing cancels.
static NEVER: AtomicBool = AtomicBool::new(false);

fn free(problem: &Problem, linkage: &FourBar) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
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
    let best = on_circuits(linkage)
        .into_iter()
        .filter_map(on_circuit)
        .min_by(|one, other| one.0.total_cmp(&other.0))?;
    let (angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) = best.1.into_iter().unzip();
    Some(unwrapped(problem, linkage, angles, assemblies))
}

/// Scales of a function's inputs at which a linkage is tried, where their range is free.
const SCALES: usize = 40;

/// Returns the scales of a function's inputs at which a linkage is tried: 1 alone where their range is as written.
fn scales_tried(problem: &Problem) -> Vec<f64> {
    let (low, high) = problem.task().ranges().input;
    let part = |i: usize| i as f64 / (SCALES - 1) as f64;
    if low == high { vec![low] } else { (0..SCALES).map(|i| low * (high / low).powf(part(i))).collect() }
}

fn prescribed(
    problem: &Problem,
    linkage: &FourBar,
    offset: AngleOffset,
) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let written = &problem.spec().task.timing.as_ref()?.crank_deg;
    let assemblies = vec![linkage.assembly(); written.len()];
    let scales = scales_tried(problem);
    // A direction is a sign with the scale of a function's inputs.
    let angles = |direction: f64, base_deg: f64| -> Vec<f64> {
        written.iter().map(|deg| base_deg + direction * deg).collect()
    };
    // The inputs of a function run as they are written, whichever way its outputs count.
    let directions = if problem.is_function() { scales.as_slice() } else { problem.directions() };
    let sum = |direction: f64, base_deg: f64| {
        let radians: Vec<f64> = angles(direction, base_deg).iter().map(|d| d.to_radians()).collect();
        problem.task().errors(linkage, &radians, &assemblies, None).map_or(f64::INFINITY, |e| e.objective)
    };
    let given = match offset {
        AngleOffset::Fixed => Some(0.0),
        AngleOffset::Ground => Some(linkage.ground_angle().to_degrees()),
        AngleOffset::Free => None,
    };
    if let Some(base) = given {
        let all = directions.iter().map(|direction| (sum(*direction, base), *direction));
        let (least, mut direction) = all.min_by(|one, other| one.0.total_cmp(&other.0))?;
        if let [one, other, ..] = scales.as_slice() {
            let (low, high) = problem.task().ranges().input;
            let between = ((direction * one / other).max(low), (direction * other / one).min(high));
            let refined = least_between(between, THIRDS, |scale| sum(scale, base));
            direction = if sum(refined, base) <= least { refined } else { direction };
        }
        return Some((angles(direction, base), assemblies));
    }
    let step = 360.0 / DEFAULT_SAMPLES as f64;
    let samples = |&direction: &f64| (0..DEFAULT_SAMPLES).map(move |i| (direction, step * i as f64));
    let all = directions.iter().flat_map(samples);
    let measured = all.map(|(direction, offset)| (sum(direction, offset), direction, offset));
    let (least, direction, offset) = measured.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let of_offset = |direction: f64, offset: f64| {
        let refined = least_between((offset - step, offset + step), THIRDS, |offset| sum(direction, offset));
        (sum(direction, refined), refined)
    };
    let (mut best, mut at) = (least, (direction, offset));
    let (found, refined) = of_offset(direction, offset);
    if found <= best {
        (best, at) = (found, (direction, refined));
    }
    if let [one, other, ..] = scales.as_slice() {
        // The scale of the inputs too, between those that were tried on either side of the best ones.
        let (low, high) = problem.task().ranges().input;
        let around = |scale: f64, offset: f64| {
            let places = (-BESIDE..=BESIDE).map(|k| offset + f64::from(k) * BESIDE_STEP_DEG);
            let nearest = places.map(|offset| (sum(scale, offset), offset));
            let (_, offset) = nearest.min_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or((0.0, offset));
            let beside = (offset - BESIDE_STEP_DEG, offset + BESIDE_STEP_DEG);
            let refined = least_between(beside, THIRDS / 2, |offset| sum(scale, offset));
            (sum(scale, refined), refined)
        };
        let mut tried: Vec<(f64, f64, f64)> = directions
            .iter()
            .filter_map(|direction| {
                let of_one = samples(direction).map(|(scale, offset)| (sum(scale, offset), scale, offset));
                of_one.min_by(|one, other| one.0.total_cmp(&other.0))
            })
            .collect();
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        for (_, scale, offset) in tried.into_iter().take(SCALES_REFINED) {
            let between = ((scale * one / other).max(low), (scale * other / one).min(high));
            let scale = least_between(between, THIRDS / 3, |scale| around(scale, offset).0);
            let (found, offset) = around(scale, offset);
            if found <= best {
                (best, at) = (found, (scale, offset));
            }
        }
    }
    best.is_finite().then(|| (angles(at.0, at.1), assemblies))
}

/// The places on either side of an offset at which it is looked for anew when the scale of the inputs changes, and their steps,
/// degrees.
const BESIDE: i32 = 20;
const BESIDE_STEP_DEG: f64 = 1.0;
/// Scales of the inputs from which the best one is refined.
const SCALES_REFINED: usize = 3;

/// Steps by thirds to the last digit.
const THIRDS: usize = 100;

/// Returns the place of the least value between two, by thirds.
fn least_between((mut low, mut high): (f64, f64), thirds: usize, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..thirds {
        let third = (high - low) / 3.0;
        if value(low + third) <= value(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}
