//! Positions at which a given linkage is nearest to a task's points: for linkages that were not placed by a search.

use super::multistart::settle_positions;
use super::{Budget, Context};
use crate::judge::unwrapped::unwrapped;
use crate::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, CouplerCurve, CrankLinkage, InputRange, LoopJoints};
use crate::task::forms::design_space::Shape;
use crate::task::forms::rows::assembly_of;
use crate::task::forms::timed::ATTACHED;
use crate::task::forms::torus::Positions;
use crate::task::{AngleOffset, Body, Problem, Setting, Timing};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Returns the crank angles (degrees) and assemblies at the points; `None` if there is no position for one.
///
/// Free timing: the nearest point of the circuit that the linkage's own t1 is on (of a rocking Grashof linkage the
/// better of its two circuits). Prescribed timing: the prescribed angles, with the offset and the direction that give
/// the least sum of squares if they are free, on the linkage's own t1.
pub fn nearest_positions(
    problem: &Problem,
    linkage: impl Into<CrankLinkage>,
) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let linkage = &linkage.into();
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
fn partly_timed(problem: &Problem, linkage: &CrankLinkage) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
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
    let distance = |j: usize, deg: f64| {
        let at = linkage.joints_with(deg.to_radians(), linkage.assembly());
        at.map_or(f64::INFINITY, |at| (at.joints.coupler_point - task.points()[j]).norm())
    };
    let given: Vec<f64> = written.iter().map(|deg| base.to_degrees() + direction * deg).collect();
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
    let at_target = |j: usize| {
        if !task.is_untimed(j) {
            return Some(given[j]);
        }
        let [from, to] = task.between_timed(&given, 360.0, j)?;
        let step = (to - from) / ATTACHED as f64;
        let samples = (1..ATTACHED).map(|i| from + step * i as f64);
        let nearest = samples.min_by(|one, other| distance(j, *one).total_cmp(&distance(j, *other)))?;
        Some(refined(j, nearest))
    };
    let all: Option<Vec<f64>> = (0..task.len()).map(at_target).collect();
    Some((all?, vec![linkage.assembly(); task.len()]))
}

/// Returns a crank angle on each circuit that the linkage's own t1 can be on.
fn on_circuits(linkage: &CrankLinkage) -> Vec<f64> {
    match linkage.mobility().input {
        InputRange::None => Vec::new(),
        InputRange::Full => vec![linkage.ground_angle()],
        InputRange::One(arc) => vec![arc.middle],
        InputRange::Two(arcs) => arcs.iter().map(|arc| arc.middle).collect(),
    }
}

/// The coupler at a place of a circuit.
struct Sample {
    /// The parameter of the place on the circuit.
    parameter: f64,
    point: Complex,
    /// The coupler's direction, radians.
    direction: f64,
}

impl Sample {
    fn of(linkage: &CrankLinkage, curve: &CouplerCurve<CrankLinkage>, parameter: f64) -> Option<Sample> {
        let (angle, assembly) = curve.position_at(parameter);
        let LoopJoints { joints, coupler } = linkage.joints_with(angle, assembly)?;
        Some(Sample { parameter, point: joints.coupler_point, direction: coupler.arg() })
    }

    /// Returns the square of the distance from target j, the turn of a body with a frame included.
    fn off(&self, problem: &Problem, j: usize, frame: f64) -> f64 {
        let task = problem.task();
        let turned = |body: &Body| {
            let angle = body.angles[j].map_or(0.0, |angle| wrapped(angle - self.direction - frame));
            (body.angle_weight * angle).powi(2)
        };
        (task.points()[j] - self.point).norm_sqr() + task.body().map_or(0.0, turned)
    }
}

/// Places of the circuit at which a body is tried to lie at the first target.
const TRIED: usize = 48;

/// As [`free`] for a body that is fixed to the coupler in the way that gives the least errors: at several places of the
/// circuit the body is taken to lie as at the first target with an angle; the best of these is fitted.
fn of_body(problem: &Problem, linkage: &CrankLinkage) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let task = problem.task();
    let first = task.body()?.angles.iter().flatten().next()?;
    let mut best: Option<(f64, f64, f64, Vec<f64>)> = None;
    for start in on_circuits(linkage) {
        let curve = CouplerCurve::through(linkage, start, linkage.assembly(), DEFAULT_SAMPLES);
        let parameters = (0..DEFAULT_SAMPLES).map(|i| TAU * i as f64 / DEFAULT_SAMPLES as f64);
        let samples: Vec<Sample> = parameters.filter_map(|t| Sample::of(linkage, &curve, t)).collect();
        for tried in samples.iter().step_by(DEFAULT_SAMPLES / TRIED) {
            let frame = first - tried.direction;
            let (mut sum, mut places) = (0.0, Vec::with_capacity(task.len()));
            for j in 0..task.len() {
                let off = |sample: &&Sample| sample.off(problem, j, frame);
                let nearest = samples.iter().min_by(|one, other| off(one).total_cmp(&off(other)))?;
                sum += task.weights()[j] * off(&nearest);
                places.push(nearest.parameter);
            }
            if best.as_ref().is_none_or(|(least, ..)| sum < *least) {
                best = Some((sum, start, frame, places));
            }
        }
    }
    let (_, start, frame, parameters) = best?;
    let curve = CouplerCurve::through(linkage, start, linkage.assembly(), DEFAULT_SAMPLES);
    let Some(four_bar) = linkage.four_bar() else {
        return led_along(problem, linkage, &curve, frame, parameters);
    };
    let shape = Shape::from(four_bar);
    let position = |parameter: &f64| {
        let (angle, assembly) = curve.position_at(*parameter);
        let joints = four_bar.position_with(angle, assembly).joints()?;
        let coupler = (joints.follower_pin - joints.crank_pin) / shape.coupler;
        Some([Complex::from_polar(1.0, angle), coupler])
    };
    let positions: Option<Positions> = parameters.iter().map(position).collect();
    let side = four_bar.side();
    let setting = Setting { aim: None, assembly: four_bar.assembly(), direction: 1.0, side };
    let design = problem.space(side).coordinates(&shape, frame);
    let budget = Budget::new(&NEVER, None);
    let fitted = settle_positions(Context::new(problem, &budget), &design, setting, positions?)?;
    let angles = fitted.iter().map(|[e, _]| e.arg()).collect();
    let assemblies = fitted.iter().map(|[e, u]| assembly_of(&shape, *e, *u)).collect();
    Some(unwrapped(problem, linkage, angles, assemblies))
}

/// The most times that places and frame are fitted in turn, and the change of the frame (radians) below which they stay.
const IN_TURN: usize = 200;
const SETTLED: f64 = 1e-13;

/// Leads the places at the targets along the circuit to those that are nearest, and the frame of the body to the mean of its
/// angles there, in turn.
fn led_along(
    problem: &Problem,
    linkage: &CrankLinkage,
    curve: &CouplerCurve<CrankLinkage>,
    mut frame: f64,
    mut parameters: Vec<f64>,
) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let (task, body) = (problem.task(), problem.task().body()?);
    let step = TAU / DEFAULT_SAMPLES as f64;
    let off = |j: usize, frame: f64, t: f64| {
        Sample::of(linkage, curve, t).map_or(f64::INFINITY, |sample| sample.off(problem, j, frame))
    };
    for _ in 0..IN_TURN {
        for (j, t) in parameters.iter_mut().enumerate() {
            let led = least_between((*t - step, *t + step), THIRDS, |t| off(j, frame, t));
            if off(j, frame, led) < off(j, frame, *t) {
                *t = led;
            }
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for (j, t) in parameters.iter().enumerate() {
            let Some(angle) = body.angles[j] else { continue };
            let sample = Sample::of(linkage, curve, *t)?;
            sum += task.weights()[j] * wrapped(angle - sample.direction - frame);
            weights += task.weights()[j];
        }
        let turned = sum / weights;
        frame += turned;
        if turned.abs() < SETTLED {
            break;
        }
    }
    let (angles, assemblies) = parameters.iter().map(|t| curve.position_at(*t)).unzip();
    Some(unwrapped(problem, linkage, angles, assemblies))
}

/// A search that nothing cancels.
static NEVER: AtomicBool = AtomicBool::new(false);

fn free(problem: &Problem, linkage: &CrankLinkage) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
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

/// Scales of a function's inputs at which a linkage is tried where their range is free, and those that are refined.
const SCALES: usize = 40;
const SCALES_REFINED: usize = 3;
/// The places on either side of an offset at which it is looked for anew when the scale of the inputs changes, and their steps,
/// degrees.
const BESIDE: i32 = 20;
const BESIDE_STEP_DEG: f64 = 1.0;
/// Steps by thirds to the last digit.
const THIRDS: usize = 100;

fn prescribed(
    problem: &Problem,
    linkage: &CrankLinkage,
    offset: AngleOffset,
) -> Option<(Vec<f64>, Vec<AssemblyMode>)> {
    let written = &problem.spec().task.timing.as_ref()?.crank_deg;
    let given = match offset {
        AngleOffset::Fixed => Some(0.0),
        AngleOffset::Ground => Some(linkage.ground_angle().to_degrees()),
        AngleOffset::Free => None,
    };
    let of =
        Prescribed { problem, linkage, written, assemblies: vec![linkage.assembly(); written.len()], given };
    let found = match (problem.is_function(), given) {
        (true, _) if problem.task().ranges().free()[0] => of.scaled(),
        // The inputs of a function run as they are written, whichever way its outputs count.
        (true, _) | (false, Some(_)) => of.on_whole_turn(1.0),
        (false, None) => {
            let all = problem.directions().iter().map(|direction| of.sampled(*direction));
            of.refined(all.min_by(Placed::compare)?)
        }
    };
    (given.is_some() || found.sum.is_finite())
        .then(|| (of.crank_deg(found.run, found.base_deg), of.assemblies))
}

/// Crank angles run psi_j + base, psi_j as written, with the sum of the errors there; `run` is a direction, or the scale of a
/// function's inputs.
#[derive(Clone, Copy)]
struct Placed {
    sum: f64,
    run: f64,
    base_deg: f64,
}

impl Placed {
    fn compare(&self, other: &Placed) -> std::cmp::Ordering {
        self.sum.total_cmp(&other.sum)
    }
}

/// A linkage at prescribed crank angles.
struct Prescribed<'a> {
    problem: &'a Problem,
    linkage: &'a CrankLinkage,
    written: &'a [f64],
    assemblies: Vec<AssemblyMode>,
    /// The angle that is added to those written, degrees; `None`: any.
    given: Option<f64>,
}

impl Prescribed<'_> {
    fn crank_deg(&self, run: f64, base_deg: f64) -> Vec<f64> {
        self.written.iter().map(|deg| base_deg + run * deg).collect()
    }

    fn at(&self, run: f64, base_deg: f64) -> Placed {
        let radians: Vec<f64> = self.crank_deg(run, base_deg).iter().map(|d| d.to_radians()).collect();
        let errors = self.problem.task().errors(self.linkage, &radians, &self.assemblies, None);
        Placed { sum: errors.map_or(f64::INFINITY, |e| e.objective), run, base_deg }
    }

    /// Returns the best of evenly spaced bases, or the given one.
    fn sampled(&self, run: f64) -> Placed {
        let step = 360.0 / DEFAULT_SAMPLES as f64;
        let first = self.at(run, self.given.unwrap_or(0.0));
        let others = if self.given.is_none() { DEFAULT_SAMPLES } else { 1 };
        let better = |best: Placed, other: Placed| if other.compare(&best).is_lt() { other } else { best };
        (1..others).map(|i| self.at(run, step * i as f64)).fold(first, better)
    }

    /// Returns the best base within a sampling step of one, or the given one.
    fn refined(&self, from: Placed) -> Placed {
        self.refined_within(from, 360.0 / DEFAULT_SAMPLES as f64, THIRDS)
    }

    fn refined_within(&self, from: Placed, step_deg: f64, thirds: usize) -> Placed {
        if self.given.is_some() {
            return from;
        }
        let (run, base) = (from.run, from.base_deg);
        let refined =
            least_between((base - step_deg, base + step_deg), thirds, |base| self.at(run, base).sum);
        let refined = self.at(run, refined);
        if refined.sum <= from.sum { refined } else { from }
    }

    fn on_whole_turn(&self, run: f64) -> Placed {
        self.refined(self.sampled(run))
    }

    /// Returns the best base near another one, for a scale of the inputs.
    fn near(&self, run: f64, base_deg: f64) -> Placed {
        let places = if self.given.is_some() { 0..=0 } else { -BESIDE..=BESIDE };
        let all = places.map(|k| self.at(run, base_deg + f64::from(k) * BESIDE_STEP_DEG));
        let best = all.min_by(Placed::compare).unwrap_or_else(|| self.at(run, base_deg));
        self.refined_within(best, BESIDE_STEP_DEG, THIRDS / 2)
    }

    /// Returns the best scale of the inputs within the bounds of their range, with its base.
    fn scaled(&self) -> Placed {
        let (low, high) = self.problem.task().ranges().input;
        let step = (high / low).powf(1.0 / (SCALES - 1) as f64);
        let mut tried: Vec<Placed> = (0..SCALES).map(|i| self.sampled(low * step.powi(i as i32))).collect();
        tried.sort_by(Placed::compare);
        let refined = tried.iter().take(SCALES_REFINED).flat_map(|Placed { run, base_deg, .. }| {
            let between = ((run / step).max(low), (run * step).min(high));
            let thirds = if self.given.is_some() { THIRDS } else { THIRDS / 3 };
            let scale = least_between(between, thirds, |scale| self.near(scale, *base_deg).sum);
            [self.near(*run, *base_deg), self.near(scale, *base_deg)]
        });
        refined.min_by(Placed::compare).unwrap_or(tried[0])
    }
}

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
