//! Fitness of a population search in the physical parameters: the design's free numbers in, violation and cost out.
//!
//! *Prescribed timing*: the cost is the weighted sum of squared errors at the prescribed angles; both assemblies come
//! from one position solution, both directions are tried if allowed, and the better one counts; if the largest
//! deviation is minimised the cost is that, in parts of the tolerances. *Free timing*: the coupler curve is sampled at
//! evenly spaced crank angles and each point is matched, independently of the others, to its nearest angle (a parabola
//! through the three samples around the nearest one). The crank angles are not genes. Order, circuit and branch, if
//! required, enter the violation.
//!
//! A design that violates a requirement gets a violation instead of a penalised cost, and feasibility rules compare it
//! (see [`crate::numbers::optimise::population`]). Nothing here allocates, except for targets of thousands
//! of points.

use super::design_space::Shape;
use super::genes::{DesignFitness, Genes, arcs, is_on_arc};
use super::rows::{Motion, nearest_type};
use super::torus::Positions;
use crate::mechanism::effort::{POINTS_AT_ONCE, computed};
use crate::mechanism::four_bar::mobility::{linkage_type, wrapped};
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{AssemblyMode, Complex, CouplerSide, LinkageType};
use crate::numbers::arithmetic::complex_lanes::{Column, column};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::numbers::optimise::population::{Fitness, PopulationProblem};
use crate::task::spec::Objective;
use crate::task::{Problem, Setting, Timing};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Number of samples of the coupler curve for free timing: 2.8 degrees apart; the parabola leaves an error of third
/// order in that.
const CURVE_SAMPLES: usize = 128;

/// Columns padded to a multiple of eight, the padding with weight zero.
#[derive(Clone, Debug)]
struct Columns {
    point: Column,
    weight: Vec<f64>,
}

/// The fitness of a path task.
#[derive(Clone, Debug)]
pub struct PathFitness<'a> {
    genes: Genes<'a>,
    targets: Columns,
    /// The unit of the largest deviation, if that is minimised: the least tolerance, or 1.
    deviation: Option<f64>,
    /// The prescribed angles (*clocks*): for each direction its sign and the column of e^{i direction psi_j}.
    clocks: Vec<(f64, Column)>,
    /// The directions of the sampled crank angles of free timing (the *wheel*).
    wheel: Column,
}

/// An evaluation of a design (a *reading*): its fitness and the discrete setting that attains it.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// The fitness.
    pub fitness: Fitness,
    /// The setting.
    pub setting: Setting,
    /// Free timing: +1 or -1 if only the input arc on that side of the ground line is meant, else 0.
    pub arc: f64,
}

impl Reading {
    /// Takes a reading if it is better.
    pub(super) fn offer(&mut self, reading: Reading) {
        if reading.fitness.compare(&self.fitness).is_lt() {
            *self = reading;
        }
    }
}

/// Returns the reading of a design that cannot be evaluated.
pub(super) fn nothing() -> Reading {
    let setting =
        Setting { aim: None, assembly: AssemblyMode::Plus, direction: 1.0, side: CouplerSide::Plus };
    Reading { fitness: Fitness { violation: f64::INFINITY, cost: f64::NAN }, setting, arc: 0.0 }
}

impl<'a> PathFitness<'a> {
    /// Creates the fitness of a problem.
    pub fn new(problem: &'a Problem) -> Self {
        let task = problem.task();
        let mut targets = Columns { point: column(task.points()), weight: task.weights().to_vec() };
        targets.weight.resize(task.len().next_multiple_of(LANES), 0.0);
        let clocks = match task.timing() {
            Timing::Free => Vec::new(),
            Timing::Prescribed { .. } => {
                let clock = |&direction: &f64| (direction, column(&problem.phases(direction)));
                problem.directions().iter().map(clock).collect()
            }
        };
        let wheel: Vec<Complex> = (0..CURVE_SAMPLES)
            .map(|i| Complex::from_polar(1.0, TAU * i as f64 / CURVE_SAMPLES as f64))
            .collect();
        PathFitness {
            genes: Genes::new(problem),
            targets,
            deviation: (problem.spec().solve.objective == Objective::MaxDeviation)
                .then(|| task.tolerances().map_or(1.0, |t| t.iter().copied().fold(f64::INFINITY, f64::min))),
            clocks,
            wheel: column(&wheel),
        }
    }

    /// Returns the problem.
    fn problem(&self) -> &'a Problem {
        self.genes.problem()
    }

    /// Returns whether a sampled crank angle lies on an arc ([`arcs`]).
    fn is_on_arc(&self, shape: &Shape, arc: f64, sample: usize) -> bool {
        is_on_arc(shape, arc, Complex::new(self.wheel[0][sample], self.wheel[1][sample]))
    }

    /// Returns the reading of a shape with prescribed timing, in one direction (by its index among the allowed ones)
    /// and on one assembly; `offset` is that of the crank angle, if it is free. Bounds of the design do not enter.
    pub fn read_timed(
        &self,
        side: CouplerSide,
        shape: &Shape,
        offset: f64,
        direction: usize,
        assembly: AssemblyMode,
    ) -> Option<Reading> {
        let (direction, phases) = self.clocks.get(direction)?;
        let offset = self.genes.angle_offset(offset, shape);
        let turn = Complex::from_polar(1.0, offset);
        let sums = timed_sums(&shape.kernel(AssemblyMode::Plus), turn, phases, &self.targets, self.deviation);
        let aim = nearest_type(shape.links(), self.problem().types());
        let motion = self.genes.timed_motion(*direction, offset, assembly);
        let lack = self.genes.requirements.lack(aim, shape, &motion, None);
        let setting = Setting { aim, assembly, direction: *direction, side };
        Some(sums.reading(setting, lack))
    }

    /// Returns the opening of the loop, summed over the points, in one direction: 0 if it closes at all of them. `turn`
    /// is added to every prescribed angle.
    pub fn open(&self, shape: &Shape, turn: f64, direction: usize) -> f64 {
        let Some((_, phases)) = self.clocks.get(direction) else { return f64::INFINITY };
        let turn = Complex::from_polar(1.0, turn);
        timed_sums(&shape.kernel(AssemblyMode::Plus), turn, phases, &self.targets, None).open
    }

    /// Returns the best reading of a shape with free timing. Bounds of the design do not enter.
    pub fn read_free(&self, side: CouplerSide, shape: &Shape) -> Reading {
        let mut best = nothing();
        self.free_readings(side, shape, &mut |reading| best.offer(reading));
        best
    }

    /// Returns the violation of the requirements; computed once per shape if it does not depend on the motion.
    fn lack(
        &self,
        aim: Option<LinkageType>,
        shape: &Shape,
        motion: &Motion<'_>,
        shared: &mut Option<f64>,
    ) -> f64 {
        if self.genes.requirements.depend_on_motion() {
            return self.genes.requirements.lack(aim, shape, motion, None);
        }
        *shared.get_or_insert_with(|| self.genes.requirements.lack(aim, shape, motion, None))
    }

    fn timed_readings(&self, side: CouplerSide, offset: f64, shape: &Shape, offer: &mut dyn FnMut(Reading)) {
        let kernel = shape.kernel(AssemblyMode::Plus);
        let offset = self.genes.angle_offset(offset, shape);
        let turn = Complex::from_polar(1.0, offset);
        let aim = nearest_type(shape.links(), self.problem().types());
        let mut shared = None;
        for (direction, phases) in &self.clocks {
            let sums = timed_sums(&kernel, turn, phases, &self.targets, self.deviation);
            for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
                let motion = self.genes.timed_motion(*direction, offset, assembly);
                let lack = self.lack(aim, shape, &motion, &mut shared);
                offer(sums.reading(Setting { aim, assembly, direction: *direction, side }, lack));
            }
        }
    }

    fn free_readings(&self, side: CouplerSide, shape: &Shape, offer: &mut dyn FnMut(Reading)) {
        let kernel = shape.kernel(AssemblyMode::Plus);
        let links = shape.links();
        let aim = nearest_type(links, self.problem().types());
        let own = linkage_type(links);
        let curve = Sampled::of(&kernel, &self.wheel);
        let mut shared = None;
        for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
            for &arc in arcs(own) {
                let reachable = |i: usize| self.is_on_arc(shape, arc, i);
                let (mut cost, mut open) = (0.0, false);
                let mut course = Course::default();
                let points = self.problem().task().points();
                // In parallel if there are many, and read in the order of the points: the number of threads changes no
                // digit.
                let nearest = |target: &Complex| curve.nearest(assembly, *target, &reachable);
                let ready: Option<Vec<_>> = (points.len() >= MANY && nearest(&points[0]).is_some())
                    .then(|| points.par_iter().with_min_len(POINTS_AT_ONCE).map(nearest).collect());
                for (j, target) in points.iter().enumerate() {
                    match ready.as_ref().map_or_else(|| nearest(target), |ready| ready[j]) {
                        Some((angle, sq)) => {
                            let part = self.targets.weight[j] * sq;
                            cost = if self.deviation.is_some() { f64::max(cost, part) } else { cost + part };
                            if j + 1 < self.problem().task().len() || !self.problem().task().repeats_first() {
                                course.pass(angle);
                            }
                        }
                        None => {
                            open = true;
                            break;
                        }
                    }
                }
                let turns = own.is_some_and(LinkageType::input_turns_fully);
                let (direction, disorder, motion) =
                    course.judged(turns, self.problem().directions(), assembly);
                let disorder = if self.problem().order_required() { disorder } else { 0.0 };
                let lack = self.lack(aim, shape, &motion, &mut shared);
                if let Some(unit) = self.deviation {
                    cost = cost.sqrt() / unit;
                }
                let violation = if open { f64::INFINITY } else { lack + disorder };
                offer(Reading {
                    fitness: Fitness { violation, cost },
                    setting: Setting { aim, assembly, direction, side },
                    arc,
                });
            }
        }
    }
}

impl DesignFitness for PathFitness<'_> {
    fn genes(&self) -> &Genes<'_> {
        &self.genes
    }

    fn positions_per_evaluation(&self) -> u64 {
        let each = if self.clocks.is_empty() {
            CURVE_SAMPLES
        } else {
            self.problem().task().len() * self.clocks.len()
        };
        (2 * each * self.genes.spaces.len()) as u64
    }

    fn read(&self, genes: &[f64]) -> Reading {
        // With free timing every point is compared with every sample: for eight of them about as much work as a
        // position.
        let free = if self.clocks.is_empty() { self.problem().task().len() * CURVE_SAMPLES / 8 } else { 0 };
        computed(self.positions_per_evaluation() as usize + free);
        let mut best = nothing();
        let mut offer = |reading: Reading| best.offer(reading);
        for (side, space) in &self.genes.spaces {
            let x = space.from_free(genes);
            let Some(shape) = space.shape(&x) else { continue };
            if self.clocks.is_empty() {
                self.free_readings(*side, &shape, &mut offer);
            } else {
                self.timed_readings(*side, space.offset(&x), &shape, &mut offer);
            }
        }
        best
    }

    fn positions(&self, shape: &Shape, _: f64, reading: &Reading) -> Option<Positions> {
        let assembly = reading.setting.assembly;
        let linkage = shape.linkage(assembly).ok()?;
        let kernel = shape.kernel(AssemblyMode::Plus);
        let curve = Sampled::of(&kernel, &self.wheel);
        self.problem()
            .task()
            .points()
            .par_iter()
            .with_min_len(POINTS_AT_ONCE)
            .map(|target| {
                let (angle, _) =
                    curve.nearest(assembly, *target, &|i| self.is_on_arc(shape, reading.arc, i))?;
                let joints = linkage.position_with(angle, assembly).joints()?;
                let coupler = (joints.follower_pin - joints.crank_pin) / shape.coupler;
                Some([Complex::from_polar(1.0, angle), coupler])
            })
            .collect()
    }
}

/// Number of points from which they are compared with the curve by all threads.
const MANY: usize = 4096;

impl PopulationProblem for PathFitness<'_> {
    fn bounds(&self) -> &[(f64, f64)] {
        self.genes.bounds()
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        self.read(x).fitness
    }

    fn cost_hint_ns(&self) -> f64 {
        // About 3 ns per position and 150 ns per set of requirements; free timing also compares every point with every
        // sample.
        let positions = 3.0 * self.positions_per_evaluation() as f64 + 300.0;
        if self.clocks.is_empty() {
            positions + 2.0 * (CURVE_SAMPLES * self.problem().task().len()) as f64
        } else {
            positions
        }
    }
}

struct TimedSums {
    /// The cost of both assemblies: a sum, or the largest deviation.
    cost: [f64; 2],
    /// The opening of the loop, summed over the points; 0 if it closes at all of them.
    open: f64,
}

impl TimedSums {
    /// Returns the reading of a setting with a violation of the requirements.
    fn reading(&self, setting: Setting, lack: f64) -> Reading {
        let cost = self.cost[usize::from(setting.assembly == AssemblyMode::Minus)];
        Reading { fitness: Fitness { violation: self.open + lack, cost }, setting, arc: 0.0 }
    }
}

/// Number of points whose errors are computed before they are summed.
const BLOCK: usize = 64;

/// Returns the weighted sums of squared errors of both assemblies at the angles turned by `turn`; with the unit of a
/// deviation, the root of the largest weighted square in that unit.
///
/// Errors are stored block by block and summed afterwards, always in the same order: a running sum inside the
/// loop would keep the compiler from using vectors.
#[inline]
fn timed_sums(
    kernel: &Kernel,
    turn: Complex,
    phases: &Column,
    targets: &Columns,
    deviation: Option<f64>,
) -> TimedSums {
    let kernel = *kernel;
    let mut sums = [F64x8::splat(0.0); 3];
    let mut largest = [0.0_f64; 2];
    let mut block = [[0.0; BLOCK]; 3];
    for from in (0..targets.weight.len()).step_by(BLOCK) {
        let to = (from + BLOCK).min(targets.weight.len());
        let n = to - from;
        let [[cos, sin], [x, y]] = [phases, &targets.point].map(|[re, im]| [&re[from..to], &im[from..to]]);
        let weight = &targets.weight[from..to];
        let [plus, minus, open] = &mut block;
        vectorised(
            #[inline(always)]
            || {
                let splat = F64x8::splat;
                let (turn_cos, turn_sin) = (splat(turn.re), splat(turn.im));
                for at in (0..n).step_by(LANES) {
                    let (c, s) = (F64x8::load(cos, at), F64x8::load(sin, at));
                    let crank = (c * turn_cos - s * turn_sin, s * turn_cos + c * turn_sin);
                    let [p, m] = kernel.at_both(crank.0, crank.1);
                    let (x, y, w) = (F64x8::load(x, at), F64x8::load(y, at), F64x8::load(weight, at));
                    let (dx, dy) = (x - p.coupler_point[0], y - p.coupler_point[1]);
                    (w * (dx * dx + dy * dy)).store(plus, at);
                    let (dx, dy) = (x - m.coupler_point[0], y - m.coupler_point[1]);
                    (w * (dx * dx + dy * dy)).store(minus, at);
                    (-p.gap).positive_part().min(splat(1.0)).store(open, at);
                }
            },
        );
        for (sum, part) in sums.iter_mut().zip(&block) {
            for at in (0..n).step_by(LANES) {
                *sum = *sum + F64x8::load(part, at);
            }
        }
        if deviation.is_some() {
            for (largest, part) in largest.iter_mut().zip(&block) {
                *largest = part[..n].iter().copied().fold(*largest, f64::max);
            }
        }
    }
    if let Some(unit) = deviation {
        return TimedSums { cost: largest.map(|sq| sq.sqrt() / unit), open: sums[2].sum() };
    }
    TimedSums { cost: [sums[0].sum(), sums[1].sum()], open: sums[2].sum() }
}

/// The coupler points of both assemblies at evenly spaced crank angles.
struct Sampled {
    x: [[f64; CURVE_SAMPLES]; 2],
    y: [[f64; CURVE_SAMPLES]; 2],
    gap: [f64; CURVE_SAMPLES],
}

impl Sampled {
    fn of(kernel: &Kernel, [cos, sin]: &Column) -> Sampled {
        let mut out =
            Sampled { x: [[0.0; CURVE_SAMPLES]; 2], y: [[0.0; CURVE_SAMPLES]; 2], gap: [0.0; CURVE_SAMPLES] };
        vectorised(
            #[inline(always)]
            || {
                for at in (0..CURVE_SAMPLES).step_by(LANES) {
                    let both = kernel.at_both(F64x8::load(cos, at), F64x8::load(sin, at));
                    for (i, position) in both.into_iter().enumerate() {
                        position.coupler_point[0].store(&mut out.x[i], at);
                        position.coupler_point[1].store(&mut out.y[i], at);
                    }
                    both[0].gap.store(&mut out.gap, at);
                }
            },
        );
        out
    }

    /// Returns the crank angle of the nearest point and its squared distance.
    fn nearest(
        &self,
        assembly: AssemblyMode,
        target: Complex,
        reachable: &dyn Fn(usize) -> bool,
    ) -> Option<(f64, f64)> {
        let which = usize::from(assembly == AssemblyMode::Minus);
        let mut sq = [f64::INFINITY; CURVE_SAMPLES];
        let points = self.x[which].iter().zip(&self.y[which]).zip(&self.gap);
        for (sq, ((x, y), gap)) in sq.iter_mut().zip(points) {
            let (dx, dy) = (x - target.re, y - target.im);
            *sq = if *gap >= 0.0 { dx * dx + dy * dy } else { f64::INFINITY };
        }
        let best = (0..CURVE_SAMPLES)
            .filter(|&i| sq[i].is_finite() && reachable(i))
            .min_by(|&i, &j| sq[i].total_cmp(&sq[j]))?;
        let step = TAU / CURVE_SAMPLES as f64;
        let (before, after) =
            (sq[(best + CURVE_SAMPLES - 1) % CURVE_SAMPLES], sq[(best + 1) % CURVE_SAMPLES]);
        let curvature = before - 2.0 * sq[best] + after;
        let angle = step * best as f64;
        if curvature.is_finite() && curvature > 0.0 && before >= sq[best] && after >= sq[best] {
            let slope = before - after;
            let least = (sq[best] - slope * slope / (8.0 * curvature)).max(0.0);
            return Some((angle + step * 0.5 * slope / curvature, least));
        }
        Some((angle, sq[best]))
    }
}

/// The course of the crank angle through the points: its steps in either direction.
#[derive(Default)]
pub(super) struct Course {
    first: Option<f64>,
    last: Option<f64>,
    /// The sum of the steps taken counter-clockwise all the way, and clockwise all the way.
    forward: f64,
    backward: f64,
    /// With each step taken the short way: the sums of those counter-clockwise and clockwise, and the range reached
    /// from the first point.
    up: f64,
    down: f64,
    reach: (f64, f64),
}

impl Course {
    pub(super) fn pass(&mut self, angle: f64) {
        if let Some(last) = self.last {
            let step = (angle - last).rem_euclid(TAU);
            self.forward += step;
            self.backward += if step > 0.0 { TAU - step } else { 0.0 };
            let short = wrapped(angle - last);
            self.up += short.max(0.0);
            self.down += (-short).max(0.0);
            let at = self.up - self.down;
            self.reach = (self.reach.0.min(at), self.reach.1.max(at));
        }
        self.first.get_or_insert(angle);
        self.last = Some(angle);
    }

    /// Returns the direction among those allowed, the disorder of the points (in turns; 0: in order), and the motion. A
    /// crank that turns goes round less than once; one that rocks does not turn back.
    pub(super) fn judged(
        &self,
        turns: bool,
        allowed: &[f64],
        assembly: AssemblyMode,
    ) -> (f64, f64, Motion<'static>) {
        let start = self.first.unwrap_or(0.0);
        let best = |length: &dyn Fn(f64) -> f64| {
            let lengths = allowed.iter().map(|&d| (d, length(d)));
            lengths.min_by(|s, t| s.1.total_cmp(&t.1)).unwrap_or((1.0, length(1.0)))
        };
        if turns {
            let (direction, total) = best(&|d| if d > 0.0 { self.forward } else { self.backward });
            let end = start + direction * total.min(TAU);
            let motion = Motion::Stretch(start.min(end), start.max(end), assembly);
            return (direction, (total / TAU - 1.0).max(0.0), motion);
        }
        let (direction, against) = best(&|d| if d > 0.0 { self.down } else { self.up });
        let motion = Motion::Stretch(start + self.reach.0, start + self.reach.1, assembly);
        (direction, against / TAU, motion)
    }
}
