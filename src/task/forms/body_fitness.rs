//! Fitness of a population search where angles of a link are wanted, of a body in a motion or of the follower in a function:
//! the design's free numbers in, violation and cost out.
//!
//! It is to poses and pairs what [`super::fitness`] is to points. *Prescribed timing*: the errors are those at the
//! prescribed angles, in either assembly and every allowed direction or sense; the frame of the link, from which its angles
//! count, is the best one and no gene. *Free timing* (motions): the frame is a gene, the circuit is sampled at evenly spaced
//! crank angles, and each target is matched to the position nearest to it in place and angle together: the sample with the
//! least
//!
//! ```text
//! |T_j - P|^2 + (W (theta_j - arg u - beta))^2
//! ```
//!
//! then the vertex of the parabola through it and its neighbours.

use super::design_space::Shape;
use super::fitness::{Course, Reading, nothing};
use super::genes::{DesignFitness, Genes, arcs, is_on_arc};
use super::rows::nearest_type;
use super::torus::Positions;
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::mobility::{linkage_type, wrapped};
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{AssemblyMode, Complex, CouplerSide, LinkageType, point};
use crate::numbers::optimise::population::{Fitness, PopulationProblem};
use crate::task::spec::Objective;
use crate::task::{Body, Problem, Setting, Timing};
use std::f64::consts::TAU;

/// Number of samples of a circuit for free timing.
const SAMPLES: usize = 128;

/// The fitness of a motion or of a function.
#[derive(Clone, Debug)]
pub struct BodyFitness<'a> {
    genes: Genes<'a>,
    body: &'a Body,
    /// The prescribed angles: for each direction, or sense of a function, its sign and e^{i direction psi_j}; none of free
    /// timing.
    clocks: Vec<(f64, Vec<Complex>)>,
    /// The directions of the sampled crank angles of free timing.
    wheel: Vec<Complex>,
    is_largest: bool,
}

/// A sampled position of a circuit: the coupler point, and the coupler's direction in radians.
type Sample = Option<(Complex, f64)>;

impl<'a> BodyFitness<'a> {
    /// Creates the fitness of a problem; `None` if it wants no angles of a link, or the ranges of a function are free.
    pub fn new(problem: &'a Problem) -> Option<Self> {
        let task = problem.task();
        let body = task.body().filter(|body| body.ranges().are_written())?;
        let clocks = match task.timing() {
            Timing::Free => Vec::new(),
            Timing::Prescribed { .. } => {
                problem.directions().iter().map(|sign| (*sign, problem.phases(*sign))).collect()
            }
        };
        Some(BodyFitness {
            genes: Genes::new(problem),
            body,
            clocks,
            wheel: (0..SAMPLES).map(|i| Complex::from_polar(1.0, TAU * i as f64 / SAMPLES as f64)).collect(),
            is_largest: problem.spec().solve.objective == Objective::MaxDeviation,
        })
    }

    /// Returns the problem.
    fn problem(&self) -> &'a Problem {
        self.genes.problem()
    }

    /// Returns a target's part of the cost, for an error of its place and of its angle: squares that are added up, or a deviation
    /// in parts of the tolerances.
    fn part(&self, j: usize, place: f64, angle: f64) -> f64 {
        let (task, radian) = (self.problem().task(), self.body.angle_weight);
        if !self.is_largest {
            return task.weights()[j] * (place * place + (radian * angle).powi(2));
        }
        match (task.tolerances(), &self.body.tolerances) {
            (None, None) => place.max(radian * angle.abs()),
            (Some(places), None) => place / places[j],
            (None, Some(angles)) => angle.abs() / angles[j],
            (Some(places), Some(angles)) => (place / places[j]).max(angle.abs() / angles[j]),
        }
    }

    /// Adds up the parts of the targets, or takes the largest.
    fn total(&self, parts: impl Iterator<Item = f64>) -> f64 {
        if self.is_largest { parts.fold(0.0, f64::max) } else { parts.sum() }
    }

    fn timed_readings(&self, side: CouplerSide, shape: &Shape, offset: f64, best: &mut Reading) {
        let task = self.problem().task();
        let offset = self.genes.angle_offset(offset, shape);
        let turn = Complex::from_polar(1.0, offset);
        let aim = nearest_type(shape.links(), self.problem().types());
        let ground = (shape.follower_pivot - shape.crank_pivot).arg();
        let n = task.len();
        let (mut apart, mut places) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
            let kernel = shape.kernel(assembly);
            for (direction, phases) in &self.clocks {
                apart.clear();
                places.clear();
                let sign = if self.problem().is_function() { *direction } else { 1.0 };
                let mut open = 0.0;
                for (j, phase) in phases.iter().enumerate() {
                    let crank = phase * turn;
                    let at = kernel.at(crank.re, crank.im);
                    open += (-at.gap).clamp(0.0, 1.0);
                    let joints = [shape.follower_pivot, point(at.crank_pin), point(at.follower_pin)];
                    let line = self.body.line(joints).arg();
                    apart.push(self.body.angles[j].map(|angle| sign * angle - line));
                    let place = task.points().get(j).map_or(0.0, |p| (p - point(at.coupler_point)).norm());
                    places.push(place);
                }
                let frame = self.body.given_frame(ground).unwrap_or_else(|| match self.is_largest {
                    true => self.body.frame_within(&apart, task.weights(), true),
                    false => self.body.best_frame(&apart, task.weights()),
                });
                let error = |j: usize| apart[j].map_or(0.0, |apart: f64| wrapped(apart - frame));
                let cost = self.total((0..n).map(|j| self.part(j, places[j], error(j))));
                let run = self.problem().run(*direction);
                let motion = self.genes.timed_motion(run, offset, assembly);
                let lack = self.genes.requirements.lack(aim, shape, &motion, Some(frame));
                let violation = if open.is_nan() { f64::INFINITY } else { open + lack };
                best.offer(Reading {
                    fitness: Fitness { violation, cost },
                    setting: Setting { aim, assembly, direction: *direction, side },
                    arc: 0.0,
                });
            }
        }
    }

    fn free_readings(&self, side: CouplerSide, shape: &Shape, frame: f64, best: &mut Reading) {
        let links = shape.links();
        let aim = nearest_type(links, self.problem().types());
        let own = linkage_type(links);
        for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
            let kernel = shape.kernel(assembly);
            let samples = self.samples(&kernel);
            for &arc in arcs(own) {
                let mut course = Course::default();
                let met: Option<Vec<(f64, f64)>> = (0..self.problem().task().len())
                    .map(|j| {
                        self.nearest(j, (&kernel, &samples), frame, &|i| is_on_arc(shape, arc, self.wheel[i]))
                    })
                    .collect();
                let Some(met) = met else {
                    let setting = Setting { aim, assembly, direction: 1.0, side };
                    let fitness = Fitness { violation: f64::INFINITY, cost: f64::NAN };
                    best.offer(Reading { fitness, setting, arc });
                    continue;
                };
                let repeated = usize::from(self.problem().task().repeats_first());
                met[..met.len() - repeated].iter().for_each(|(angle, _)| course.pass(*angle));
                let turns = own.is_some_and(LinkageType::input_turns_fully);
                let (direction, disorder, motion) =
                    course.judged(turns, self.problem().directions(), assembly);
                let disorder = if self.problem().order_required() { disorder } else { 0.0 };
                let lack = self.genes.requirements.lack(aim, shape, &motion, Some(frame));
                let cost = self.total(met.iter().map(|(_, part)| *part));
                best.offer(Reading {
                    fitness: Fitness { violation: lack + disorder, cost },
                    setting: Setting { aim, assembly, direction, side },
                    arc,
                });
            }
        }
    }

    fn samples(&self, kernel: &Kernel) -> Vec<Sample> {
        let at = |crank: &Complex| {
            let at = kernel.at(crank.re, crank.im);
            let coupler = point(at.follower_pin) - point(at.crank_pin);
            (at.gap >= 0.0).then(|| (point(at.coupler_point), coupler.arg()))
        };
        self.wheel.iter().map(at).collect()
    }

    /// Returns the errors of a target's place and angle at a position.
    fn errors(&self, j: usize, (place, coupler): (Complex, f64), frame: f64) -> (f64, f64) {
        let angle = self.body.angles[j].map_or(0.0, |angle| wrapped(angle - coupler - frame));
        ((self.problem().task().points()[j] - place).norm(), angle)
    }

    /// Returns the crank angle of the position nearest to a target and the target's part of the cost there; `None` if no sample can
    /// be reached.
    fn nearest(
        &self,
        j: usize,
        (kernel, samples): (&Kernel, &[Sample]),
        frame: f64,
        reachable: &dyn Fn(usize) -> bool,
    ) -> Option<(f64, f64)> {
        let sq = |sample: &Sample| {
            sample.map_or(f64::INFINITY, |at| {
                let (place, angle) = self.errors(j, at, frame);
                place * place + (self.body.angle_weight * angle).powi(2)
            })
        };
        let (best, here, at) = samples
            .iter()
            .enumerate()
            .filter(|(i, sample)| sample.is_some() && reachable(*i))
            .map(|(i, sample)| (i, sq(sample), *sample))
            .min_by(|one, other| one.1.total_cmp(&other.1))?;
        let part = |at: (Complex, f64)| {
            let (place, angle) = self.errors(j, at, frame);
            self.part(j, place, angle)
        };
        let own = (TAU * best as f64 / SAMPLES as f64, part(at?));
        let [before, after] = [SAMPLES - 1, 1].map(|step| sq(&samples[(best + step) % SAMPLES]));
        let curvature = before - 2.0 * here + after;
        if !(curvature.is_finite() && curvature > 0.0) {
            return Some(own);
        }
        let angle = own.0 + TAU / SAMPLES as f64 * (0.5 * (before - after) / curvature).clamp(-0.5, 0.5);
        let there = kernel.at(angle.cos(), angle.sin());
        let coupler = (point(there.follower_pin) - point(there.crank_pin)).arg();
        let refined = (there.gap >= 0.0).then(|| (angle, part((point(there.coupler_point), coupler))));
        Some(refined.filter(|(_, part)| *part <= own.1).unwrap_or(own))
    }
}

impl DesignFitness for BodyFitness<'_> {
    fn genes(&self) -> &Genes<'_> {
        &self.genes
    }

    fn positions_per_evaluation(&self) -> u64 {
        let n = self.problem().task().len();
        let each = if self.clocks.is_empty() { SAMPLES + n } else { n * self.clocks.len() };
        (2 * each * self.genes.spaces.len()) as u64
    }

    fn read(&self, genes: &[f64]) -> Reading {
        let compared = if self.clocks.is_empty() { self.problem().task().len() * SAMPLES / 8 } else { 0 };
        computed(self.positions_per_evaluation() as usize + compared);
        let mut best = nothing();
        for (side, space) in &self.genes.spaces {
            let x = space.from_free(genes);
            let Some(shape) = space.shape(&x) else { continue };
            if self.clocks.is_empty() {
                self.free_readings(*side, &shape, space.offset(&x), &mut best);
            } else {
                self.timed_readings(*side, &shape, space.offset(&x), &mut best);
            }
        }
        best
    }

    fn positions(&self, shape: &Shape, frame: f64, reading: &Reading) -> Option<Positions> {
        let kernel = shape.kernel(reading.setting.assembly);
        let samples = self.samples(&kernel);
        let reachable = |i: usize| is_on_arc(shape, reading.arc, self.wheel[i]);
        let position = |j: usize| {
            let (angle, _) = self.nearest(j, (&kernel, &samples), frame, &reachable)?;
            let at = kernel.at(angle.cos(), angle.sin());
            let coupler = (point(at.follower_pin) - point(at.crank_pin)) / shape.coupler;
            Some([Complex::from_polar(1.0, angle), coupler])
        };
        (0..self.problem().task().len()).map(position).collect()
    }
}

impl PopulationProblem for BodyFitness<'_> {
    fn bounds(&self) -> &[(f64, f64)] {
        self.genes.bounds()
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        self.read(x).fitness
    }

    fn cost_hint_ns(&self) -> f64 {
        // About 30 ns a position with its angle; free timing also compares every target with every sample.
        let positions = 30.0 * self.positions_per_evaluation() as f64 + 300.0;
        let compared = if self.clocks.is_empty() { 20 * SAMPLES * self.problem().task().len() } else { 0 };
        positions + compared as f64
    }
}
