//! Fitness of a population search in reduced variables: ratios and at most two angles in, violation and cost out.
//!
//! | timing | genes |
//! |---|---|
//! | prescribed | ln p, ln q, ln r, and the angle if the form has one ([`crate::task::forms::projection`]) |
//! | free | ln p, ln q, ln r, the phase at the first point, and the span of the whole target if it is not a full turn |
//!
//! One more gene in [0, n) chooses among the n allowed pairs of a direction and an assembly, so that one evaluation is
//! one shape. Within the box a gene of a ratio is its logarithm from 1/20 to 20; if the problem allows more than that,
//! the rest is compressed into a margin of [`TAIL`] of that width on either side, so that it can be reached and is
//! seldom drawn.
//!
//! The remaining parameters are linear and solved for inside (variable projection). The resulting shape is evaluated as
//! [`PathFitness`] evaluates a design of nine parameters: cost at the prescribed angles or at the nearest points,
//! requirements as violations. If the shape lies outside the bounds of the design, the distance in sizes of the target
//! is a violation too. The linear part minimises the sum of squares also if the cost is the largest deviation.
//!
//! With free timing the points lie along the circuit as they lie along the target: by arc length ([`super::starts`]).
//! On a circuit that rocks, start and start + span are the phases psi of its two ends, sin psi of its half width from
//! its middle; of two circuits the sign of cos(start) chooses, or, if the motion may pass toggles, the assembly.

use super::Context;
use super::multistart::settle_positions;
use super::starts::{Searched, Starts, unit_linkage};
use crate::mechanism::four_bar::mobility::linkage_type;
use crate::mechanism::{AssemblyMode, Circuit, Complex, CouplerSide, LinkageType};
use crate::numbers::optimise::population::{Fitness, PopulationProblem};
use crate::task::Problem;
use crate::task::Timing;
use crate::task::forms::design_space::Shape;
use crate::task::forms::fitness::{PathFitness, Reading};
use crate::task::forms::linear_fit::{KnownPivots, Ratios};
use crate::task::forms::projection::{ProjectedFit, Projection, ratio_box};
use crate::task::forms::reduced::known_ground;
use crate::task::forms::start::Start;
use crate::task::requirement::DEFAULT_LINK_RATIO;
use std::f64::consts::{PI, TAU};
use std::sync::{Mutex, PoisonError};

/// The span of an open target with free timing, radians of the crank.
const SPAN: (f64, f64) = (0.2, 6.0);
/// Base violation of a form whose loop does not close; its measured opening is added, so that no closed form ranks
/// behind an open one for a small violation.
const OPEN: f64 = 1.0;
/// Number of genes: ln p, ln q, ln r, two angles and the choice of direction and assembly; `CHOICE` is the index of the
/// last.
const GENES: usize = 6;
const CHOICE: usize = 5;
/// Width of each margin for ratios beyond [`DEFAULT_LINK_RATIO`], in parts of the width between the margins.
pub const TAIL: f64 = 0.02;

/// The map from a gene to the logarithm of a ratio: the identity on the `core`, stretched to the limits beyond it.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    limits: (f64, f64),
    core: (f64, f64),
    margin: f64,
}

impl Stretch {
    fn new(limits: (f64, f64)) -> Self {
        let usual = DEFAULT_LINK_RATIO.ln();
        let core = (limits.0.max(-usual), limits.1.min(usual));
        // Limits that share at most a point with the usual range are searched evenly.
        let core = if core.0 < core.1 { core } else { limits };
        Stretch { limits, core, margin: TAIL * (core.1 - core.0) }
    }

    fn gene_box(&self) -> (f64, f64) {
        let low = if self.limits.0 < self.core.0 { self.core.0 - self.margin } else { self.core.0 };
        let high = if self.limits.1 > self.core.1 { self.core.1 + self.margin } else { self.core.1 };
        (low, high)
    }

    fn value(&self, gene: f64) -> f64 {
        if gene < self.core.0 {
            self.core.0 - (self.core.0 - gene) / self.margin * (self.core.0 - self.limits.0)
        } else if gene > self.core.1 {
            self.core.1 + (gene - self.core.1) / self.margin * (self.limits.1 - self.core.1)
        } else {
            gene
        }
    }
}

/// Returns the reduced forms of a problem, one per direction; empty with free timing.
pub fn forms(problem: &Problem) -> Vec<Projection> {
    problem.directions().iter().filter_map(|&direction| Projection::new(problem, direction)).collect()
}

/// The fitness of a path task in reduced variables.
pub struct ReducedFitness<'a> {
    problem: &'a Problem,
    physical: PathFitness<'a>,
    forms: &'a [Projection],
    starts: Starts<'a>,
    known: KnownPivots,
    /// The allowed pairs of direction (its index) and assembly.
    choices: Vec<(usize, AssemblyMode)>,
    ratios: [Stretch; 3],
    /// Indices of the free genes; `bounds` is their box.
    free: Vec<usize>,
    bounds: Vec<(f64, f64)>,
    /// The values of the fixed genes.
    fixed: [f64; GENES],
    /// Whether the target is closed with free timing: the motion then goes once around the circuit.
    whole: bool,
    /// Workspaces, one for each thread that evaluates: evaluations allocate nothing once they exist.
    rooms: Mutex<Vec<Room<'a>>>,
}

struct Room<'a> {
    fits: Vec<ProjectedFit<'a>>,
    positions: Vec<[Complex; 2]>,
}

/// A shape that the genes encode, and its evaluation.
#[derive(Clone, Copy)]
struct Read {
    fitness: Fitness,
    reading: Reading,
    shape: Shape,
    offset: f64,
}

impl<'a> ReducedFitness<'a> {
    /// Creates the fitness of a problem with its [`forms`].
    pub fn new(problem: &'a Problem, forms: &'a [Projection]) -> Self {
        let task = problem.task();
        let whole = forms.is_empty() && (task.closed() || task.repeats_first());
        let limits = match forms.first() {
            Some(form) => [0, 1, 2].map(|i: usize| form.bounds()[i]),
            None => ratio_box(problem, known_ground(problem)),
        };
        let ratios = limits.map(Stretch::new);
        let choices: Vec<(usize, AssemblyMode)> = (0..problem.directions().len())
            .flat_map(|i| [(i, AssemblyMode::Plus), (i, AssemblyMode::Minus)])
            .collect();
        let [p, q, r] = ratios.map(|ratio| ratio.gene_box());
        let turn = (-PI, PI);
        let (angle, span) = match forms.first() {
            Some(form) => (if form.has_angle() { turn } else { (0.0, 0.0) }, (0.0, 0.0)),
            None => {
                let turns = |kind: &LinkageType| kind.input_turns_fully();
                let rocks = problem.types().is_empty() || !problem.types().iter().all(turns);
                // A crank that rocks between its toggles needs two ends even for a closed target.
                let ends = rocks && !problem.branch_any();
                (turn, if whole && !ends { (TAU, TAU) } else { SPAN })
            }
        };
        let box_of = [p, q, r, angle, span, (0.0, choices.len() as f64)];
        let free: Vec<usize> = (0..GENES).filter(|&i| box_of[i].0 < box_of[i].1).collect();
        ReducedFitness {
            physical: PathFitness::new(problem),
            starts: Starts::new(problem),
            known: KnownPivots::of(problem),
            bounds: free.iter().map(|&i| box_of[i]).collect(),
            fixed: box_of.map(|(low, _)| low),
            rooms: Mutex::new(Vec::new()),
            problem,
            forms,
            choices,
            ratios,
            free,
            whole,
        }
    }

    /// Runs `work` with a workspace of this thread's own.
    fn in_a_room<T>(&self, work: impl FnOnce(&mut Room<'a>) -> T) -> T {
        let kept = self.rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut room = kept.unwrap_or_else(|| Room {
            fits: self.forms.iter().map(|form| ProjectedFit::new(form, AssemblyMode::Plus)).collect(),
            positions: Vec::with_capacity(self.problem.task().len()),
        });
        let done = work(&mut room);
        self.rooms.lock().unwrap_or_else(PoisonError::into_inner).push(room);
        done
    }

    /// Returns the unknowns that the genes encode, ratios as logarithms.
    fn unknowns(&self, x: &[f64]) -> [f64; GENES] {
        let mut unknowns = self.fixed;
        for (&i, &value) in self.free.iter().zip(x) {
            unknowns[i] = value;
        }
        for (value, ratio) in unknowns.iter_mut().zip(&self.ratios) {
            *value = ratio.value(*value);
        }
        unknowns
    }

    /// Returns the fitness, with the shape if there is one.
    fn read(&self, x: &[f64]) -> (Fitness, Option<Read>) {
        let unknowns = self.unknowns(x);
        // The end of the box belongs to the last choice.
        let choice = (unknowns[CHOICE] as usize).min(self.choices.len() - 1);
        let (direction, assembly) = self.choices[choice];
        self.in_a_room(|room| {
            if self.forms.is_empty() {
                self.read_free(room, &unknowns, direction, assembly)
            } else {
                self.read_timed(room, &unknowns, direction, assembly)
            }
        })
    }

    fn read_timed(
        &self,
        room: &mut Room<'_>,
        unknowns: &[f64; GENES],
        direction: usize,
        assembly: AssemblyMode,
    ) -> (Fitness, Option<Read>) {
        let unknown = Fitness { violation: f64::INFINITY, cost: f64::NAN };
        let (Some(fit), Some(form)) = (room.fits.get_mut(direction), self.forms.get(direction)) else {
            return (unknown, None);
        };
        let at = [unknowns[0], unknowns[1], unknowns[2], unknowns[3]];
        fit.set_assembly(assembly);
        if let Some(solution) = fit.solution(&at) {
            let side = self.side(&solution.shape);
            let Some(reading) =
                self.physical.read_timed(side, &solution.shape, solution.offset, direction, assembly)
            else {
                return (unknown, None);
            };
            let read = self.within_bounds(reading, solution.shape, solution.offset);
            return (read.fitness, Some(read));
        }
        let unit = Shape {
            crank_pivot: Complex::new(0.0, 0.0),
            follower_pivot: Complex::new(1.0, 0.0),
            crank: at[0].exp(),
            coupler: at[1].exp(),
            follower: at[2].exp(),
            offset: Complex::new(0.0, 0.0),
        };
        let open = OPEN + self.physical.open(&unit, form.crank_turn(&at), direction);
        (Fitness { violation: open, cost: f64::NAN }, None)
    }

    fn read_free(
        &self,
        room: &mut Room<'_>,
        unknowns: &[f64; GENES],
        direction: usize,
        assembly: AssemblyMode,
    ) -> (Fitness, Option<Read>) {
        let unknown = Fitness { violation: f64::INFINITY, cost: f64::NAN };
        let ratios =
            Ratios { crank: unknowns[0].exp(), coupler: unknowns[1].exp(), follower: unknowns[2].exp() };
        let positions = &mut room.positions;
        let direction = self.problem.directions()[direction];
        let Some(shape) = self
            .place(&ratios, direction, assembly, (unknowns[3], unknowns[4]), positions)
            .and_then(|()| self.starts.fit(&ratios, &self.known, positions))
        else {
            return (unknown, None);
        };
        let reading = self.physical.read_free(self.side(&shape), &shape);
        let read = self.within_bounds(reading, shape, 0.0);
        (read.fitness, Some(read))
    }

    /// Computes positions from the ground line along the circuit; `None` if the loop is open.
    fn place(
        &self,
        ratios: &Ratios,
        direction: f64,
        assembly: AssemblyMode,
        (start, span): (f64, f64),
        positions: &mut Vec<[Complex; 2]>,
    ) -> Option<()> {
        let kind = linkage_type([1.0, ratios.crank, ratios.coupler, ratios.follower])?;
        let around = if self.whole { TAU } else { span };
        positions.clear();
        let mut take = |at: Option<[Complex; 2]>| at.map(|at| positions.push(at));
        if kind.input_turns_fully() || kind == LinkageType::ChangePoint {
            return self.starts.turning(ratios, assembly, start, direction * around).try_for_each(&mut take);
        }
        let mobility = unit_linkage(ratios)?;
        let any = self.problem.branch_any();
        let first = if any { assembly == AssemblyMode::Plus } else { start.cos() >= 0.0 };
        let index = u8::from(!first) % mobility.circuits().max(1);
        let arc = mobility.arc(Circuit { index })?;
        if any {
            return self.starts.round_an_arc(ratios, &arc, start, direction * around).try_for_each(&mut take);
        }
        let (one, other) = (start.sin(), (start + span).sin());
        let (low, high) = (one.min(other), one.max(other));
        let ends = if direction > 0.0 { [low, high] } else { [high, low] };
        self.starts.along_an_arc(ratios, &arc, assembly, ends).try_for_each(&mut take)
    }

    fn side(&self, shape: &Shape) -> CouplerSide {
        match self.problem.sides() {
            [only] => *only,
            _ => CouplerSide::of(shape.offset.im),
        }
    }

    /// Adds to an evaluation the violation of the design's bounds by its shape.
    fn within_bounds(&self, reading: Reading, shape: Shape, offset: f64) -> Read {
        let space = self.physical.space(reading.setting.side);
        let outside = space.excess(&shape) / self.problem.task().size();
        let fitness = Fitness { violation: reading.fitness.violation + outside, ..reading.fitness };
        Read { fitness, reading, shape, offset }
    }
}

impl PopulationProblem for ReducedFitness<'_> {
    fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        self.read(x).0
    }

    fn cost_hint_ns(&self) -> f64 {
        // A linear fit, and the evaluation that follows it.
        let points = self.problem.task().len() as f64;
        match self.problem.task().timing() {
            Timing::Prescribed { .. } => 600.0 + 20.0 * points,
            Timing::Free => 600.0 + 20.0 * points + self.physical.cost_hint_ns(),
        }
    }
}

impl Searched for ReducedFitness<'_> {
    fn positions(&self) -> u64 {
        let points = self.problem.task().len() as u64;
        match self.problem.task().timing() {
            // Positions once in the form, and in both assemblies of its shape.
            Timing::Prescribed { .. } => 3 * points,
            Timing::Free => {
                points + self.physical.positions_per_evaluation() / self.problem.sides().len() as u64
            }
        }
    }

    fn start(&self, x: &[f64], context: Context<'_>) -> Option<Start> {
        let Read { reading, shape, offset, .. } = self.read(x).1?;
        let space = self.physical.space(reading.setting.side);
        let design = space.design(&shape, offset);
        if !self.forms.is_empty() {
            return Some(Start { design, setting: reading.setting, positions: Vec::new() });
        }
        // Clamped to the bounds, the shape may meet the points at other positions.
        let shape = space.shape(&design)?;
        let reading = self.physical.read_free(reading.setting.side, &shape);
        let sampled = self.physical.positions(&shape, &reading)?;
        let (positions, _) = settle_positions(context, &design, reading.setting, sampled)?;
        Some(Start { design, setting: reading.setting, positions })
    }
}
