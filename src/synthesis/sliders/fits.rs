//! Fits of a round: its starts drawn and compared, led to their ends by Levenberg-Marquardt, and these judged.

use super::starts::{Start, Target, free, log_uniform, prescribed};
use crate::judge::assess::assess_on_curve;
use crate::judge::unwrapped::unwrapped;
use crate::judge::warm::direction_and_offset;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, LinkageKind};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::numbers::optimise::levenberg_marquardt::{BlockLeastSquares, LmOptions, LmOutcome, finish, solve};
use crate::record::{Candidate, CurveErrorRecord, ErrorRecord};
use crate::synthesis::Context;
use crate::synthesis::constants::Effort;
use crate::synthesis::constants::sliders::{HOP, HOPS, NEARLY, PROMISING, TURNING};
use crate::synthesis::polish::reserve;
use crate::task::forms::slider::fit::{Angles, OwnAngles, SliderFit, settle};
use crate::task::forms::slider::limits::Limited;
use crate::task::forms::slider::ranged::{RangedFit, joined, parted};
use crate::task::forms::slider::shape::{Closure, FRAME, OFFSET, SHAPE, SliderShape};
use crate::task::forms::torus::Positions;
use crate::task::ranges::Reference;
use crate::task::{AngleOffset, Output, Problem, Timing};
use std::f64::consts::PI;

/// Fits a candidate with a slider to the context's problem from where it stands, with at most so many evaluations and until
/// the weighted sum of squares is at most `enough`. Returns the end, judged, and the evaluations used.
pub(in crate::synthesis) fn refit(
    context: Context<'_>,
    from: &Candidate,
    (effort, evaluations, enough): (Effort, u64, f64),
) -> (Option<Candidate>, u64) {
    let problem = context.problem;
    let target = Target::of(problem);
    let Some(start) = start_at(problem, &target, from) else { return (None, 0) };
    let limits = Limited::of(problem, start.kind, target.centre, target.size);
    let mut fits = Fits::new(context, &target, enough, evaluations);
    let end = fits.run(&limits, start, effort);
    (end.and_then(|(_, end)| fits.judged(&end)), fits.used)
}

/// Judges a candidate with a slider where it stands, at the crank angles that the context's problem prescribes.
pub(in crate::synthesis) fn unfitted(context: Context<'_>, candidate: &Candidate) -> Option<Candidate> {
    let target = Target::of(context.problem);
    let start = start_at(context.problem, &target, candidate)?;
    Fits::new(context, &target, 0.0, 0).judged(&start)
}

/// Returns the start at which a candidate stands; `None` of a four-bar, or if its loop is open at a point.
pub(super) fn start_at(problem: &Problem, target: &Target, candidate: &Candidate) -> Option<Start> {
    let linkage = &candidate.linkage;
    let back = 1.0 / target.size;
    let shape = SliderShape::from_linkage(linkage)?.carried(Complex::new(back, 0.0), -target.centre * back);
    let position = |(deg, t1): (&f64, &AssemblyMode)| {
        let angle = deg.to_radians();
        let at = linkage.joints_with(angle, *t1)?;
        Some([Complex::from_polar(1.0, angle), at.coupler])
    };
    let (direction, offset) = direction_and_offset(problem, candidate);
    let is_free = matches!(problem.task().timing(), Timing::Free);
    let at = candidate.crank_deg.iter().zip(&candidate.t1_at);
    Some(Start {
        kind: linkage.kind(),
        x: shape.unknowns(offset, frame_of(problem, target, candidate)),
        positions: if is_free || !target.own.is_empty() {
            at.map(position).collect::<Option<_>>()?
        } else {
            Vec::new()
        },
        assembly: linkage.assembly(),
        direction,
        turns: linkage.mobility().input_turns_fully(),
        scales: candidate.scales(&problem.spec().task),
    })
}

/// Returns the frame of a candidate in the units of a fit: of a motion's body, or of a function's outputs; 0 if it is given.
fn frame_of(problem: &Problem, target: &Target, candidate: &Candidate) -> f64 {
    let Some(outputs) = &target.outputs else { return candidate.frame_deg.unwrap_or(0.0).to_radians() };
    if problem.task().body().is_none_or(|body| body.given_frame(0.0).is_some()) {
        return 0.0;
    }
    let frame = candidate.own_frame_deg().unwrap_or(0.0);
    match outputs.kind {
        Output::Angle => frame.to_radians(),
        Output::Place => frame / target.size,
    }
}

/// Returns a start of a slider-crank with its line seen in the sense that is nearest to its bounds.
pub(super) fn aligned(limits: &Limited, is_of_places: bool, mut start: Start) -> Start {
    if start.kind == LinkageKind::SliderCrank {
        let (angle, is_turned) = limits.line_angle(start.x[5]);
        start.x[5] = angle;
        if is_turned {
            start.x[4] = -start.x[4];
            start.assembly = start.assembly.opposite();
            // The slider's places count the other way.
            if is_of_places {
                (start.direction, start.x[FRAME]) = (-start.direction, -start.x[FRAME]);
            }
        }
    }
    start
}

/// Returns the fit of a start, its points in the order that they have.
pub(super) fn fit_of<'f, const R: usize>(
    problem: &Problem,
    target: &'f Target,
    limits: &'f Limited,
    start: &Start,
) -> SliderFit<'f, R> {
    let angles = match problem.task().timing() {
        Timing::Free => Angles::Free,
        Timing::Prescribed { offset, .. } => {
            Angles::Prescribed(problem.phases(start.direction), *offset, start.assembly)
        }
    };
    let fit = SliderFit {
        kind: start.kind,
        points: &target.points,
        weights: &target.weights,
        body: target.body.as_ref(),
        outputs: target.outputs.as_ref(),
        sign: start.direction,
        angles,
        own: if target.own.is_empty() { OwnAngles::None } else { OwnAngles::Of(&target.own) },
        limits,
        sense: 0.0,
        ends_meet: problem.task().repeats_first(),
    };
    let is_free = matches!(fit.angles, Angles::Free);
    if is_free && problem.order_required() { fit.in_order(&start.x, &start.positions) } else { fit }
}

/// Returns the fit of a start to a function with free ranges; `None` if the problem is no such function.
pub(super) fn ranged_fit_of<'f, const R: usize>(
    problem: &Problem,
    target: &'f Target,
    limits: &'f Limited,
    start: &Start,
) -> Option<RangedFit<'f, R>> {
    let ranges = problem.task().ranges();
    let Timing::Prescribed { crank_angles, .. } = problem.task().timing() else { return None };
    if ranges.are_written() {
        return None;
    }
    let run = problem.run(start.direction);
    let turns = crank_angles.iter().map(|turn| run * turn).collect();
    Some(RangedFit::new(fit_of(problem, target, limits, start), turns, &ranges))
}

/// A round's fits within an allowance of evaluations.
pub(super) struct Fits<'a> {
    context: Context<'a>,
    target: &'a Target,
    /// The cost, in units of the target's size, below which nothing is left to gain.
    exact: f64,
    allowance: u64,
    /// The evaluations used so far.
    pub(super) used: u64,
}

impl<'a> Fits<'a> {
    /// Creates the fits with an allowance of evaluations, of which a weighted sum of squares of at most `exact` ends one.
    pub(super) fn new(context: Context<'a>, target: &'a Target, exact: f64, allowance: u64) -> Self {
        Fits { context, target, exact: exact / target.unit_sq(), allowance, used: 0 }
    }

    fn is_at_its_end(&self) -> bool {
        self.context.stopped() || self.used >= self.allowance
    }

    /// Fits from a start, and returns the end with its merit; `None` if it is given up.
    pub(super) fn run(&mut self, limits: &Limited, start: Start, effort: Effort) -> Option<(f64, Start)> {
        match (&self.target.body, &self.target.outputs) {
            (_, Some(_)) => self.run_on::<1>(limits, start, effort),
            (None, None) => self.run_on::<2>(limits, start, effort),
            (Some(_), None) => self.run_on::<3>(limits, start, effort),
        }
    }

    /// As [`Fits::run`] with R rows a target.
    fn run_on<const R: usize>(
        &mut self,
        limits: &Limited,
        start: Start,
        effort: Effort,
    ) -> Option<(f64, Start)> {
        if self.is_at_its_end() {
            return None;
        }
        let is_of_places = self.is_of_places();
        let (limits, start) = (limits.turning(start.turns), aligned(limits, is_of_places, start));
        let weight: f64 = self.target.weights.iter().sum();
        let radian = self.target.outputs.as_ref().map_or(1.0, |outputs| outputs.weight);
        let options = LmOptions {
            max_steps: effort.steps,
            max_rounds: effort.rounds,
            max_evaluations: self.allowance - self.used,
            relative_reduction: effort.relative_reduction,
            exact_cost: 1e-6 * self.exact,
            feasibility: 1e-9,
            hopeless_cost: 0.04 * weight * radian * radian,
        };
        let nearly = NEARLY * weight * radian * radian;
        let problem = self.context.problem;
        if let Some(fit) = ranged_fit_of::<R>(problem, self.target, &limits, &start) {
            let from = (joined(&start.x, start.scales), start.positions.clone());
            let (merit, unknowns, positions) = self.solved(&fit, from, &options, nearly)?;
            let (x, scales) = parted(&unknowns);
            return Some((merit, Start { x, positions, scales, ..start }));
        }
        let fit = fit_of::<R>(problem, self.target, &limits, &start);
        let from = (start.x, start.positions.clone());
        let (merit, x, positions) = self.solved(&fit, from, &options, nearly)?;
        Some((merit, Start { x, positions, ..start }))
    }

    /// Solves a fit from its unknowns and positions, and leads it on to its last digits if its cost is at most `nearly`; returns
    /// the end with its merit, `None` if it is given up.
    fn solved<const N: usize, const R: usize, F>(
        &mut self,
        fit: &F,
        (x, positions): ([f64; N], Positions),
        options: &LmOptions,
        nearly: f64,
    ) -> Option<(f64, [f64; N], Positions)>
    where
        F: BlockLeastSquares<N, R, State = Positions>,
    {
        let context = self.context;
        let stop = || context.stopped();
        let mut end = solve(fit, x, positions, options, &stop);
        if end.cost <= nearly && end.outcome != LmOutcome::Exact {
            finish(fit, &mut end, options, &stop);
        }
        self.used += end.evaluations;
        let weight: f64 = self.target.weights.iter().sum();
        let usable = !matches!(end.outcome, LmOutcome::NoStart | LmOutcome::Abandoned);
        usable.then_some((end.cost + weight * end.violation * end.violation, end.x, end.state))
    }

    fn is_of_places(&self) -> bool {
        self.target.outputs.as_ref().is_some_and(|outputs| outputs.kind == Output::Place)
    }

    /// Draws `count` starts of a path, with the misfits of those that can be laid on it.
    pub(super) fn drawn(
        &mut self,
        (kind, limits): (LinkageKind, &Limited),
        count: usize,
        draws: &mut Stream,
    ) -> Vec<(f64, Start)> {
        let (problem, target) = (self.context.problem, self.target);
        let is_free = matches!(problem.task().timing(), Timing::Free);
        let mut drawn: Vec<(f64, Start)> = Vec::new();
        for _ in 0..count {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let turns = limits.must_turn || uniform(draws, 0.0, 1.0) < TURNING;
            drawn.extend(if is_free {
                free(problem, target, (kind, turns), draws)
            } else {
                prescribed(problem, target, (kind, turns), draws)
            });
        }
        drawn
    }

    /// Returns whether a merit is nearly that of an exact answer.
    pub(super) fn is_nearly_exact(&self, merit: f64) -> bool {
        let weight: f64 = self.target.weights.iter().sum();
        let radian = self.target.outputs.as_ref().map_or(1.0, |outputs| outputs.weight);
        merit <= PROMISING * weight * radian * radian
    }

    /// Draws starts of a path near known answers, with their costs: some unknowns of one are changed, and its positions
    /// brought to the changed curve.
    pub(super) fn hopped(
        &mut self,
        limits: &Limited,
        known: &[Start],
        draws: &mut Stream,
    ) -> Vec<(f64, Start)> {
        let mut hopped = Vec::with_capacity(HOPS);
        let is_free = matches!(self.context.problem.task().timing(), Timing::Free);
        for _ in 0..HOPS {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let mut start = known[below(draws, known.len())].clone();
            let by = log_uniform(draws, HOP.0, HOP.1);
            let part = if below(draws, 2) == 0 { 1.0 } else { 1.0 / 3.0 };
            for unknown in start.x.iter_mut().take(SHAPE) {
                let change = uniform(draws, -by, by) * unknown.abs().max(HOP.0);
                if uniform(draws, 0.0, 1.0) < part {
                    *unknown += change;
                }
            }
            let Some(shape) = SliderShape::of(start.kind, &start.x) else { continue };
            if is_free && !settle(&shape, &mut start.positions) {
                continue;
            }
            let start = aligned(limits, false, start);
            let cost = fit_of::<2>(self.context.problem, self.target, limits, &start)
                .cost(&start.x, &start.positions);
            hopped.extend(cost.map(|cost| (cost, start)));
        }
        hopped
    }

    /// Returns the starts of a function with their costs.
    pub(super) fn glanced_outputs(&mut self, limits: &Limited, starts: Vec<Start>) -> Vec<(f64, Start)> {
        let is_of_places = self.is_of_places();
        let mut glanced = Vec::with_capacity(starts.len());
        for start in starts {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let start = aligned(limits, is_of_places, start);
            let (problem, target) = (self.context.problem, self.target);
            let cost = match ranged_fit_of::<1>(problem, target, limits, &start) {
                Some(fit) => fit.cost(&joined(&start.x, start.scales), &start.positions),
                None => fit_of::<1>(problem, target, limits, &start).cost(&start.x, &start.positions),
            };
            glanced.extend(cost.map(|cost| (cost, start)));
        }
        glanced
    }

    /// Returns the starts of a motion with their costs, those on one branch first if one is required.
    pub(super) fn glanced(&mut self, limits: &Limited, starts: Vec<Start>) -> Vec<(f64, Start)> {
        let one_branch = !self.context.problem.branch_any();
        let weight: f64 = self.target.weights.iter().sum();
        let mut glanced = Vec::with_capacity(starts.len());
        for start in starts {
            if self.is_at_its_end() {
                break;
            }
            self.used += 1;
            let start = aligned(limits, false, start);
            let Some(cost) = fit_of::<3>(self.context.problem, self.target, limits, &start)
                .cost(&start.x, &start.positions)
            else {
                continue;
            };
            let Some(shape) = SliderShape::of(start.kind, &start.x) else { continue };
            let mut signs = start.positions.iter().map(|position| shape.assembly_of(*position));
            let first = signs.next();
            let strays = one_branch && !signs.all(|sign| Some(sign) == first);
            glanced.push((if strays { cost + weight } else { cost }, start));
        }
        glanced
    }

    /// Returns the judged candidate of an end.
    pub(super) fn judged(&self, end: &Start) -> Option<Candidate> {
        judged(self.context.problem, self.target, end)
    }
}

/// Returns the judged candidate of an end; the distances to its whole curve are measured later, if it is listed.
pub(super) fn judged(problem: &Problem, target: &Target, end: &Start) -> Option<Candidate> {
    const UNKNOWN: CurveErrorRecord = CurveErrorRecord { sum_sq: 0.0, rms: 0.0, max: 0.0 };
    let Target { size, centre, .. } = *target;
    let mut unit = SliderShape::of(end.kind, &end.x)?;
    if let (Some(_), Closure::Line { coupler, .. }) = (&target.outputs, unit.closure) {
        // P of a function is drawn at the slider's pin.
        unit.offset = Complex::new(coupler, 0.0);
    }
    let shape = unit.carried(Complex::new(size, 0.0), centre);
    let sign = |position: &[Complex; 2]| unit.assembly_of(*position);
    let is_free = matches!(problem.task().timing(), Timing::Free);
    let first = end.positions.first().filter(|_| is_free).map_or(end.assembly, sign);
    // Where crank angles or places count along the line, its sense stays, and so does t1.
    let counts_along =
        matches!(problem.task().timing(), Timing::Prescribed { offset: AngleOffset::Ground, .. });
    let keeps = matches!(shape.closure, Closure::Line { .. }) && (counts_along || problem.is_function());
    let linkage = match keeps {
        true => shape.linkage(AssemblyMode::Plus).ok()?.with_assembly(first),
        false => shape.linkage(first).ok()?,
    };
    let own = if keeps { first } else { AssemblyMode::Plus };
    let (crank_deg, assemblies) = match problem.task().timing() {
        Timing::Free => {
            // Seen from the first position, whose sign is +1.
            let own = |position| AssemblyMode::of(sign(position).sign() * first.sign());
            let angles = end.positions.iter().map(|[e, _]| e.arg()).collect();
            unwrapped(problem, linkage, angles, end.positions.iter().map(own).collect())
        }
        Timing::Prescribed { offset, .. } => {
            let base = match offset {
                AngleOffset::Free => wrapped(end.x[OFFSET]).to_degrees(),
                AngleOffset::Fixed => 0.0,
                AngleOffset::Ground => linkage.ground_angle().to_degrees(),
            };
            let written = &problem.spec().task.timing.as_ref()?.crank_deg;
            let run = end.scales[0] * problem.run(end.direction);
            let at_target = |(j, deg): (usize, &f64)| {
                let guess = base + run * deg;
                match end.positions.get(j).filter(|_| target.own.get(j) == Some(&true)) {
                    Some([e, _]) => guess + wrapped(e.arg() - guess.to_radians()).to_degrees(),
                    None => guess,
                }
            };
            let crank_deg: Vec<f64> = written.iter().enumerate().map(at_target).collect();
            let t1 = vec![own; crank_deg.len()];
            (crank_deg, t1)
        }
    };
    let frame = end.x[FRAME];
    let turned = || wrapped(frame + turn_of_coupler(&unit, first)).to_degrees();
    let is_frame_free = problem.task().body().is_some_and(|body| body.given_frame(0.0).is_none());
    let own = match &target.outputs {
        None => target.body.as_ref().map(|_| turned()),
        // Unless deviations count one by one, the frame of a function is the one of the least errors.
        Some(outputs) => (is_frame_free && reserve(problem, 1000) > 0).then(|| match outputs.kind {
            Output::Angle => turned(),
            Output::Place => frame * size,
        }),
    };
    let own = own.map(|frame_deg| Reference { frame_deg, scale: end.scales[1] });
    let mut candidate = assess_on_curve(problem, linkage, (&crank_deg, &assemblies), own, Some(UNKNOWN))?;
    let ErrorRecord { sum_sq, rms, max, .. } = candidate.error;
    candidate.error.to_curve = CurveErrorRecord { sum_sq, rms, max };
    Some(candidate)
}

/// Returns the angle from the coupler's direction of a shape to that of its linkage with the assembly of one of its positions.
fn turn_of_coupler(shape: &SliderShape, assembly: AssemblyMode) -> f64 {
    match shape.closure {
        Closure::Block { .. } if assembly == AssemblyMode::Minus => PI,
        Closure::Block { .. } | Closure::Line { .. } => 0.0,
    }
}
