//! Starts of linkages with a slider: shapes drawn by kind, laid on the target by similarity or by linear least squares.
//!
//! *Free timing.* The curve of a drawn shape, as points evenly along it, is laid on the target by the similarity of least
//! squares, at every shift of a closed target and at a few stretches of an open one; the points' positions follow from
//! their arc length ([`crate::synthesis::atlas`]). Shapes are compared by what is left when A, K and Z are fitted at these
//! positions, as the place of P on the coupler is what a fit mends first; slider-cranks for an open target by the residual of the
//! similarity.
//!
//! *Prescribed timing.* At the drawn shape's positions A, K and Z of P = A + K e + Z u follow from linear least squares.

use crate::mechanism::{AssemblyMode, Circuit, Complex, InputArc, LinkageKind};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::atlas::{EVEN, Even, ON_ARC, OnArc, TRACED, Traced, arc_misfits, fraction};
use crate::synthesis::constants::motion::EXACT_WEIGHT;
use crate::task::forms::slider::fit::{BodyAngles, base_angle};
use crate::task::forms::slider::output::Outputs;
use crate::task::forms::slider::shape::{Closure, OFFSET, SliderShape, Unknowns};
use crate::task::forms::start::AS_WRITTEN;
use crate::task::forms::timed::ATTACHED;
use crate::task::forms::torus::Positions;
use crate::task::ranges::Scales;
use crate::task::{AngleOffset, Problem, Timing};
use std::f64::consts::{PI, TAU};

/// A start of a fit.
#[derive(Clone, Debug)]
pub(in crate::synthesis) struct Start {
    pub(super) kind: LinkageKind,
    pub(super) x: Unknowns,
    /// The positions of free timing.
    pub(super) positions: Positions,
    /// The assembly and the direction of prescribed timing.
    pub(super) assembly: AssemblyMode,
    pub(super) direction: f64,
    /// Whether the crank of the drawn shape turns fully.
    pub(super) turns: bool,
    /// The scales of a function's inputs and outputs.
    pub(super) scales: Scales,
}

/// The target in units of its size around its centre, as starts and fits see it.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) points: Vec<Complex>,
    pub(super) weights: Vec<f64>,
    pub(super) centre: Complex,
    pub(super) size: f64,
    /// The arc length up to each point, in parts of the whole.
    along: Vec<f64>,
    is_closed: bool,
    even: Option<Even>,
    on_arc: Option<OnArc>,
    /// Whether a target has a crank angle of its own among prescribed ones; empty if none has.
    pub(super) own: Vec<bool>,
    /// The angles of a motion's body.
    pub(super) body: Option<BodyAngles>,
    /// The outputs of a function.
    pub(super) outputs: Option<Outputs>,
}

impl Target {
    pub(super) fn of(problem: &Problem) -> Target {
        let task = problem.task();
        let (centre, size) = (task.centre(), task.size());
        let points: Vec<Complex> = task.points().iter().map(|p| (p - centre) / size).collect();
        let is_closed = task.closed() || task.repeats_first();
        let outputs = Outputs::of(problem);
        let body = task
            .body()
            .filter(|_| outputs.is_none())
            .map(|body| BodyAngles { angles: body.angles.clone(), weight: body.angle_weight / size });
        let mut along = vec![0.0];
        for w in points.windows(2) {
            along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
        }
        let mut whole = along[along.len() - 1];
        if let Some(outputs) = outputs {
            let weights = task.weights().to_vec();
            return Target {
                points,
                weights,
                centre,
                size,
                along: Vec::new(),
                is_closed: false,
                even: None,
                on_arc: None,
                own: Vec::new(),
                body: None,
                outputs: Some(outputs),
            };
        }
        if task.closed() && !task.repeats_first() {
            whole += (points[0] - points[points.len() - 1]).norm();
        }
        along.iter_mut().for_each(|s| *s /= whole);
        let distinct = if task.repeats_first() { points.len() - 1 } else { points.len() };
        // A motion starts from its poses.
        let is_path = body.is_none();
        let even = if is_path && is_closed { Traced::of(points[..distinct].to_vec()) } else { None };
        let on_arc = || {
            let at = |m: usize| {
                let s = m as f64 / (ON_ARC - 1) as f64;
                let next = along.partition_point(|length| *length < s).clamp(1, points.len() - 1);
                let (from, to) = (along[next - 1], along[next]);
                let part = if to > from { ((s - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
                points[next - 1] + (points[next] - points[next - 1]) * part
            };
            OnArc::of(&(0..ON_ARC).map(at).collect::<Vec<_>>())
        };
        Target {
            even: even.and_then(|traced| Even::of(&traced.even())),
            on_arc: if is_closed || !is_path { None } else { on_arc() },
            weights: task.weights().to_vec(),
            points,
            centre,
            size,
            along,
            is_closed,
            own: if task.is_partly_timed() {
                (0..task.len()).map(|j| task.is_untimed(j)).collect()
            } else {
                Vec::new()
            },
            body,
            outputs: None,
        }
    }

    /// Returns the target with larger weights where the tolerance is zero, so that the answers of a search by least squares are
    /// near to what the polish makes of them.
    pub(super) fn searched(problem: &Problem) -> Target {
        let mut target = Target::of(problem);
        let task = &problem.spec().task;
        let of_angles = task.body.as_ref().and_then(|body| body.tolerance_deg.as_ref());
        let tolerances = if target.outputs.is_some() { of_angles } else { task.tolerance.as_ref() };
        for (weight, tolerance) in target.weights.iter_mut().zip(tolerances.into_iter().flatten()) {
            if *tolerance == 0.0 {
                *weight *= EXACT_WEIGHT;
            }
        }
        target
    }

    /// Returns the unit of a squared error: the objective is this many times the cost of a fit.
    pub(super) fn unit_sq(&self) -> f64 {
        self.outputs.as_ref().map_or(self.size * self.size, |outputs| outputs.unit(self.size))
    }
}

pub(super) fn log_uniform(stream: &mut Stream, low: f64, high: f64) -> f64 {
    uniform(stream, low.ln(), high.ln()).exp()
}

fn sign(stream: &mut Stream) -> f64 {
    if below(stream, 2) == 0 { 1.0 } else { -1.0 }
}

/// Draws a shape with A in the origin: a slider-crank with b = 1 and its line along the x axis, or an inverted one with
/// a = 1 and B on the x axis.
fn shape(stream: &mut Stream, kind: LinkageKind, turns: bool) -> SliderShape {
    let angle = uniform(stream, -PI, PI);
    let reach = log_uniform(stream, 0.05, 3.0);
    let polar = |length: f64| Complex::from_polar(reach * length, angle);
    let zero = Complex::new(0.0, 0.0);
    if kind == LinkageKind::SliderCrank {
        let (crank, height) = if turns {
            let used = 1.0 - log_uniform(stream, 1e-3, 0.95);
            let part = log_uniform(stream, 0.02, 1.0);
            (used * part, used * (1.0 - part))
        } else {
            let crank = log_uniform(stream, 0.05, 5.0);
            (crank, uniform(stream, (1.0 - crank).max(0.0), 1.0 + crank))
        };
        let height = sign(stream) * height;
        let closure = Closure::Line { coupler: 1.0, height, direction: Complex::new(1.0, 0.0) };
        let offset = Complex::new(0.5, 0.0) + polar(crank.max(1.0));
        SliderShape { crank_pivot: zero, crank, offset, closure }
    } else {
        let ground = log_uniform(stream, 0.05, 20.0);
        let apart = (ground - 1.0).abs();
        let offset = if turns {
            uniform(stream, 0.0, 0.999) * apart
        } else {
            uniform(stream, apart, 0.999 * (1.0 + ground))
        };
        let closure = Closure::Block { pivot: Complex::new(ground, 0.0), offset: sign(stream) * offset };
        SliderShape { crank_pivot: zero, crank: 1.0, offset: polar(ground.max(1.0)), closure }
    }
}

/// A drawn shape on one of its circuits.
struct Drawn {
    shape: SliderShape,
    /// The sign of the root, if the crank turns fully.
    sign: f64,
    arc: Option<InputArc>,
}

impl Drawn {
    fn of(stream: &mut Stream, kind: LinkageKind, turns: bool) -> Option<Drawn> {
        let shape = shape(stream, kind, turns);
        let (sign, which) = (sign(stream), below(stream, 2) as u8);
        let mobility = shape.linkage(AssemblyMode::Plus).ok()?.mobility();
        Some(Drawn { shape, sign, arc: mobility.arc(Circuit { index: which }) })
    }

    /// Returns the position at a parameter in [0, 1) of the circuit.
    fn at(&self, parameter: f64) -> Option<[Complex; 2]> {
        let psi = TAU * parameter;
        let (angle, sign) = match self.arc {
            None => (psi, self.sign),
            // Slightly off the toggles, where the assembly is undecided.
            Some(arc) => (
                arc.middle + (1.0 - 1e-9) * arc.half_width * psi.sin(),
                if psi.cos() < 0.0 { -1.0 } else { 1.0 },
            ),
        };
        let e = Complex::from_polar(1.0, angle);
        Some([e, self.shape.coupler_direction(e, sign)?])
    }

    /// Samples the curve, half a step off the toggles.
    fn trace(&self) -> Option<Traced> {
        let at = |i: usize| self.at((i as f64 + 0.5) / TRACED as f64).map(|p| self.shape.coupler_point(p));
        Traced::of((0..TRACED).map(at).collect::<Option<_>>()?)
    }

    /// Returns the half of the circuit, between two toggles, on which a place of the curve lies.
    fn half(traced: &Traced, place: f64) -> bool {
        fraction(traced.parameter(place) + 0.25) < 0.5
    }
}

/// A stretch of a drawn curve laid on the target.
struct Laid {
    begin: f64,
    span: f64,
    direction: f64,
    misfit: f64,
}

/// Stretches of each drawn curve that are laid on an open target.
const STRETCHES: usize = 6;
/// Least and greatest length of a stretch, in parts of the curve's.
const SPANS: (f64, f64) = (0.08, 0.97);

/// Draws a start of free timing with its misfit, a residual relative to the target's spread; `None` for a shape that cannot be
/// laid on the target.
pub(super) fn free(
    problem: &Problem,
    target: &Target,
    (kind, turns): (LinkageKind, bool),
    stream: &mut Stream,
) -> Option<(f64, Start)> {
    let drawn = Drawn::of(stream, kind, turns)?;
    if target.is_closed && drawn.arc.is_some() && !problem.branch_any() {
        return None;
    }
    let traced = drawn.trace()?;
    let directions = problem.directions();
    let laid = match (&target.even, &target.on_arc) {
        (Some(wanted), _) => {
            let even = Even::of(&traced.even())?;
            let along = |&direction: &f64| {
                let misfits = even.misfits(wanted, direction > 0.0).into_iter().map(f64::from);
                misfits.enumerate().map(move |(shift, misfit)| {
                    let begin = shift as f64 / EVEN as f64;
                    Laid { begin, span: 1.0, direction, misfit }
                })
            };
            let all = directions.iter().flat_map(along);
            all.min_by(|one, other| one.misfit.total_cmp(&other.misfit))?
        }
        (None, Some(wanted)) => {
            let mut best: Option<Laid> = None;
            for _ in 0..STRETCHES {
                let (begin, span) = (uniform(stream, 0.0, 1.0), uniform(stream, SPANS.0, SPANS.1));
                let place = |m: usize| fraction(begin + span * m as f64 / (ON_ARC - 1) as f64);
                let first = Drawn::half(&traced, begin);
                let passes = || (1..ON_ARC).any(|m| Drawn::half(&traced, place(m)) != first);
                if drawn.arc.is_some() && !problem.branch_any() && passes() {
                    continue;
                }
                let points: Vec<Complex> =
                    (0..ON_ARC).map(|m| traced.point(traced.locate(place(m)))).collect();
                let Some(own) = OnArc::of(&points) else { continue };
                let [ahead, back] = arc_misfits(&own, wanted).map(f64::from);
                for &direction in directions {
                    let misfit = if direction > 0.0 { ahead } else { back };
                    let begin = if direction > 0.0 { begin } else { fraction(begin + span) };
                    if best.as_ref().is_none_or(|best| misfit < best.misfit) {
                        best = Some(Laid { begin, span, direction, misfit });
                    }
                }
            }
            best?
        }
        (None, None) => return None,
    };
    let place = |s: &f64| (laid.begin + laid.direction * laid.span * s).rem_euclid(1.0);
    let positions: Option<Positions> =
        target.along.iter().map(|s| drawn.at(traced.parameter(place(s)))).collect();
    let positions = positions?;
    let (scale, shift) = similarity(target, &drawn.shape, &positions)?;
    let turn = scale / scale.norm();
    // A coupler that swings little mimics every arc, with lengths out of all proportion.
    let tells = target.is_closed || kind != LinkageKind::SliderCrank;
    let misfit = if tells { linear(target, &positions)?.misfit } else { laid.misfit };
    let start = Start {
        kind,
        x: drawn.shape.carried(scale, shift).unknowns(0.0, 0.0),
        positions: positions.into_iter().map(|[e, u]| [e * turn, u * turn]).collect(),
        assembly: AssemblyMode::Plus,
        direction: laid.direction,
        turns: drawn.arc.is_none(),
        scales: AS_WRITTEN,
    };
    Some((misfit, start))
}

/// Returns the similarity p -> shift + scale p that brings the coupler points at positions to the target.
fn similarity(target: &Target, shape: &SliderShape, positions: &Positions) -> Option<(Complex, Complex)> {
    let points: Vec<Complex> = positions.iter().map(|p| shape.coupler_point(*p)).collect();
    let weight: f64 = target.weights.iter().sum();
    let mean = |of: &[Complex]| of.iter().zip(&target.weights).map(|(p, w)| p * w).sum::<Complex>() / weight;
    let (own, wanted) = (mean(&points), mean(&target.points));
    let (mut both, mut sq) = (Complex::new(0.0, 0.0), 0.0);
    for ((p, t), w) in points.iter().zip(&target.points).zip(&target.weights) {
        both += (p - own).conj() * (t - wanted) * w;
        sq += (p - own).norm_sqr() * w;
    }
    let scale = both / sq;
    (scale.norm() > 0.0 && scale.is_finite()).then(|| (scale, wanted - scale * own))
}

/// Draws a start of prescribed timing with the relative residual of its linear fit.
pub(super) fn prescribed(
    problem: &Problem,
    target: &Target,
    (kind, turns): (LinkageKind, bool),
    stream: &mut Stream,
) -> Option<(f64, Start)> {
    let Timing::Prescribed { offset, .. } = problem.task().timing() else { return None };
    let shape = shape(stream, kind, turns);
    let sign = sign(stream);
    let directions = problem.directions();
    let direction = directions[below(stream, directions.len())];
    let drawn = uniform(stream, -PI, PI);
    let angle = if *offset == AngleOffset::Ground { 0.0 } else { drawn };
    let turn = Complex::from_polar(1.0, angle);
    let position = |phase: &Complex| {
        let e = phase * turn;
        Some([e, shape.coupler_direction(e, sign)?])
    };
    let phases = problem.phases(direction);
    let positions: Positions = phases.iter().map(position).collect::<Option<_>>()?;
    let Linear { pivot, crank, coupler, misfit } = linear(target, &positions)?;
    let scale = crank / shape.crank;
    let turned = crank / crank.norm();
    let mut x = shape.carried(scale, pivot).unknowns(0.0, 0.0);
    let z = coupler / turned;
    (x[OFFSET - 2], x[OFFSET - 1]) = (z.re, z.im);
    if *offset == AngleOffset::Free {
        x[OFFSET] = angle + turned.arg();
    }
    let assembly = AssemblyMode::of(sign);
    let mut start =
        Start { kind, x, positions: Positions::new(), assembly, direction, turns, scales: AS_WRITTEN };
    if !target.own.is_empty() {
        start.positions = attached(problem, target, &start)?;
    }
    Some((misfit, start))
}

/// Returns the positions at targets of which some have their own crank angles: these are at the point of the curve that is
/// nearest between their neighbours. `None` if the loop is open at a target.
pub(super) fn attached(problem: &Problem, target: &Target, start: &Start) -> Option<Positions> {
    let Timing::Prescribed { crank_angles, offset } = problem.task().timing() else { return None };
    let shape = SliderShape::of(start.kind, &start.x)?;
    let base = base_angle(&start.x, &shape, *offset);
    let angles: Vec<f64> = crank_angles.iter().map(|angle| base + start.direction * angle).collect();
    let at = |angle: f64| {
        let e = Complex::from_polar(1.0, angle);
        Some([e, shape.coupler_direction(e, start.assembly.sign())?])
    };
    let position = |j: usize| {
        if !target.own[j] {
            return at(angles[j]);
        }
        let [from, to] = problem.task().between_timed(&angles, TAU, j)?;
        let samples = (1..ATTACHED).filter_map(|i| at(from + (to - from) * i as f64 / ATTACHED as f64));
        let off = |position: &[Complex; 2]| (shape.coupler_point(*position) - target.points[j]).norm_sqr();
        samples.min_by(|one, other| off(one).total_cmp(&off(other)))
    };
    (0..angles.len()).map(position).collect()
}

/// The linear part of a fit: P = A + K e + Z u, with its relative residual.
struct Linear {
    pivot: Complex,
    crank: Complex,
    coupler: Complex,
    misfit: f64,
}

fn linear(target: &Target, positions: &Positions) -> Option<Linear> {
    // Of targets that have their own crank angles nothing is known yet.
    let known = |j: usize| !target.own.get(j).copied().unwrap_or(false);
    let weights: Vec<f64> =
        target.weights.iter().enumerate().map(|(j, w)| if known(j) { *w } else { 0.0 }).collect();
    let weight: f64 = weights.iter().sum();
    let zero = Complex::new(0.0, 0.0);
    let (mut e_mean, mut u_mean, mut t_mean) = (zero, zero, zero);
    for (([e, u], t), w) in positions.iter().zip(&target.points).zip(&weights) {
        e_mean += e * (w / weight);
        u_mean += u * (w / weight);
        t_mean += t * (w / weight);
    }
    let (mut ee, mut uu, mut tt) = (0.0, 0.0, 0.0);
    let (mut eu, mut et, mut ut) = (zero, zero, zero);
    for (([e, u], t), w) in positions.iter().zip(&target.points).zip(&weights) {
        let (e, u, t) = (e - e_mean, u - u_mean, t - t_mean);
        ee += w * e.norm_sqr();
        uu += w * u.norm_sqr();
        tt += w * t.norm_sqr();
        eu += e.conj() * u * *w;
        et += e.conj() * t * *w;
        ut += u.conj() * t * *w;
    }
    let determinant = ee * uu - eu.norm_sqr();
    if determinant.is_nan() || determinant <= 1e-12 * ee * uu {
        return None;
    }
    let crank = (et * uu - eu * ut) / determinant;
    let coupler = (ut * ee - eu.conj() * et) / determinant;
    let explained = (crank.conj() * et).re + (coupler.conj() * ut).re;
    let is_usable = crank.norm() > 0.0 && crank.is_finite() && coupler.is_finite();
    is_usable.then(|| Linear {
        pivot: t_mean - crank * e_mean - coupler * u_mean,
        crank,
        coupler,
        misfit: ((tt - explained) / tt).max(0.0),
    })
}
