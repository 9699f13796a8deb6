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
use super::starts::{Searched, Starts, Way};
use crate::mechanism::four_bar::mobility::linkage_type;
use crate::mechanism::{AssemblyMode, Complex, LinkageType};
use crate::numbers::optimise::population::{Fitness, PopulationProblem};
use crate::task::forms::design_space::Shape;
use crate::task::forms::fitness::{PathFitness, Reading};
use crate::task::forms::genes::DesignFitness;
use crate::task::forms::linear_fit::{KnownPivots, Ratios};
use crate::task::forms::projection::{ProjectedFit, Projection, Solution, ratio_box};
use crate::task::forms::reduced::known_ground;
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::requirement::DEFAULT_LINK_RATIO;
use crate::task::{Problem, Timing};
use std::f64::consts::{PI, TAU};
use std::sync::{Mutex, PoisonError};

/// The span of an open target with free timing, radians of the crank.
const SPAN: (f64, f64) = (0.2, 6.0);
/// Base violation of a form whose loop does not close; its measured opening is added, so that no closed form ranks
/// behind an open one for a small violation.
const OPEN: f64 = 1.0;
/// The fitness of genes at which nothing can be computed.
const UNDEFINED: Fitness = Fitness { violation: f64::INFINITY, cost: f64::NAN };
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

    /// Returns the shape that the genes encode, or the fitness of genes that encode none.
    fn read(&self, x: &[f64]) -> Result<Read, Fitness> {
        let unknowns = self.unknowns(x);
        // The end of the box belongs to the last choice.
        let choice = self.choices[(unknowns[CHOICE] as usize).min(self.choices.len() - 1)];
        self.in_a_room(|room| {
            if self.forms.is_empty() {
                self.read_free(room, &unknowns, choice).ok_or(UNDEFINED)
            } else {
                self.read_timed(room, &unknowns, choice)
            }
        })
    }

    fn read_timed(
        &self,
        room: &mut Room<'_>,
        &[p, q, r, angle, ..]: &[f64; GENES],
        (direction, assembly): (usize, AssemblyMode),
    ) -> Result<Read, Fitness> {
        let fit = room.fits.get_mut(direction).ok_or(UNDEFINED)?;
        let form = self.forms.get(direction).ok_or(UNDEFINED)?;
        let at = [p, q, r, angle];
        fit.set_assembly(assembly);
        if let Some(Solution { shape, offset, .. }) = fit.solution(&at) {
            let (side, _) = self.starts.space_of(&shape);
            let reading = self.physical.read_timed(*side, &shape, offset, direction, assembly);
            return reading.map(|reading| self.within_bounds(reading, shape, offset)).ok_or(UNDEFINED);
        }
        let unit = Shape {
            crank_pivot: Complex::new(0.0, 0.0),
            follower_pivot: Complex::new(1.0, 0.0),
            crank: p.exp(),
            coupler: q.exp(),
            follower: r.exp(),
            offset: Complex::new(0.0, 0.0),
        };
        let open = OPEN + self.physical.open(&unit, form.crank_turn(&at), direction);
        Err(Fitness { violation: open, cost: f64::NAN })
    }

    fn read_free(
        &self,
        room: &mut Room<'_>,
        &[p, q, r, start, span, _]: &[f64; GENES],
        (direction, assembly): (usize, AssemblyMode),
    ) -> Option<Read> {
        let ratios = Ratios { crank: p.exp(), coupler: q.exp(), follower: r.exp() };
        let kind = linkage_type([1.0, ratios.crank, ratios.coupler, ratios.follower])?;
        let direction = self.problem.directions()[direction];
        let way = Way { kind, assembly, start, span: direction * if self.whole { TAU } else { span } };
        let rocking = || {
            let any = self.problem.branch_any();
            let first = if any { assembly == AssemblyMode::Plus } else { start.cos() >= 0.0 };
            let (one, other) = (start.sin(), (start + span).sin());
            let (low, high) = (one.min(other), one.max(other));
            Some((u8::from(!first), if direction > 0.0 { [low, high] } else { [high, low] }))
        };
        self.starts.place(&ratios, &self.starts.arc, &way, rocking, &mut room.positions)?;
        let shape = self.starts.fit(&ratios, &self.known, &room.positions)?;
        let reading = self.physical.read_free(self.starts.space_of(&shape).0, &shape);
        Some(self.within_bounds(reading, shape, 0.0))
    }

    /// Adds to an evaluation the violation of the design's bounds by its shape.
    fn within_bounds(&self, reading: Reading, shape: Shape, offset: f64) -> Read {
        let space = self.physical.genes().space(reading.setting.side);
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
        self.read(x).map_or_else(|fitness| fitness, |read| read.fitness)
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
        let Read { reading, shape, offset, .. } = self.read(x).ok()?;
        let space = self.physical.genes().space(reading.setting.side);
        let design = space.design(&shape, offset);
        if !self.forms.is_empty() {
            return Some(Start {
                design,
                setting: reading.setting,
                positions: Vec::new(),
                scales: AS_WRITTEN,
            });
        }
        // Clamped to the bounds, the shape may meet the points at other positions.
        let shape = space.shape(&design)?;
        let reading = self.physical.read_free(reading.setting.side, &shape);
        let sampled = DesignFitness::positions(&self.physical, &shape, offset, &reading)?;
        let positions = settle_positions(context, &design, reading.setting, sampled)?;
        Some(Start { design, setting: reading.setting, positions, scales: AS_WRITTEN })
    }
}
