//! Starts of local searches: shapes drawn by type, positions by timing, the rest by linear least squares.
//!
//! Grashof shapes are drawn in their slacks: with the shortest link s and s_i > 0,
//! p = s + (s2 + s3)/2, q = s + (s1 + s3)/2, l = s + (s1 + s2)/2 covers exactly the shapes whose shortest link
//! is s and whose margin is positive. Phases of free timing follow the arc length of the target.

use super::function_starts::FunctionStarts;
use super::{Context, ellipse};
use crate::mechanism::four_bar::mobility::{Mobility, grashof_margin, linkage_type};
use crate::mechanism::{
    AssemblyMode, Circuit, Complex, CouplerSide, FourBar, LinkageType, NaturalCoordinates,
};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::numbers::optimise::population::PopulationProblem;
use crate::task::forms::design_space::{DesignSpace, Shape};
use crate::task::forms::linear_fit::{KnownPivots, Ratios, assembly_sign, coupler_direction, fit};
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::forms::timed::{TimedMotionFit, TimedPathFit};
use crate::task::forms::torus::Positions;
use crate::task::{AngleOffset, Problem, Setting, Timing};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A fitness of a population search whose individuals become starts.
pub(super) trait Searched: PopulationProblem {
    /// Returns the number of positions of the linkage that one evaluation computes.
    fn positions(&self) -> u64;
    /// Returns the start that an individual encodes.
    fn start(&self, x: &[f64], context: Context<'_>) -> Option<Start>;
}

/// A generator of starts for a problem.
#[derive(Clone, Debug)]
pub struct Starts<'a> {
    pub(super) problem: &'a Problem,
    pub(super) types: Vec<LinkageType>,
    /// The arc length up to each point, in parts of the whole (closed: of the closed curve).
    pub(super) arc: Vec<f64>,
    /// The phases of the points on an ellipse, if the target is free, closed and nearly one ([`super::ellipse`]).
    ellipse: Option<Vec<f64>>,
    /// Those of a function.
    function: Option<FunctionStarts<'a>>,
    /// One design space per side of the coupler point.
    pub(super) spaces: Vec<(CouplerSide, DesignSpace)>,
}

impl<'a> Starts<'a> {
    /// Creates the generator of a problem.
    pub fn new(problem: &'a Problem) -> Self {
        let task = problem.task();
        let points = task.points();
        let mut along = vec![0.0];
        for w in points.windows(2) {
            along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
        }
        let mut whole = along[along.len() - 1];
        let function = FunctionStarts::new(problem);
        if task.closed() && !task.repeats_first() {
            whole += (points[0] - points[points.len() - 1]).norm();
        }
        Starts {
            problem,
            types: drawn_types(problem),
            arc: along.iter().map(|s| s / whole).collect(),
            ellipse: (task.closed() && matches!(task.timing(), Timing::Free))
                .then(|| ellipse::phases(points))
                .flatten(),
            function,
            spaces: problem.sides().iter().map(|&side| (side, problem.space(side))).collect(),
        }
    }

    /// Returns the side that a shape's coupler point lies on, or the only one allowed, and its design space.
    pub(super) fn space_of(&self, shape: &Shape) -> &(CouplerSide, DesignSpace) {
        let side = CouplerSide::of(shape.offset.im);
        self.spaces.iter().find(|(other, _)| *other == side).unwrap_or(&self.spaces[0])
    }

    /// Returns a start of free timing from ratios and positions measured from the ground line: the rest by linear least
    /// squares. `kind` is the type of the ratios, and the one aimed at if types are required.
    pub fn from_positions(
        &self,
        ratios: &Ratios,
        kind: LinkageType,
        direction: f64,
        positions: &[[Complex; 2]],
    ) -> Option<Start> {
        let shape = self.fit(ratios, &KnownPivots::of(self.problem), positions)?;
        let (side, space) = self.space_of(&shape);
        let aim = self.problem.aims_at_types().then_some(kind);
        let assembly = AssemblyMode::of(assembly_sign(ratios, positions[0]));
        let setting = Setting { aim, assembly, direction, side: *side };
        Some(start_from(space, setting, &shape, positions))
    }

    /// Returns the starts that the task itself suggests: of a function those of its linear equations.
    pub(super) fn suggested(&self) -> Vec<Start> {
        self.function.as_ref().map_or_else(Vec::new, FunctionStarts::of_grid)
    }

    /// Draws one start; `None` if it cannot be assembled at every point.
    pub fn draw(&self, stream: &mut Stream) -> Option<Start> {
        if let Some(function) = &self.function {
            return function.draw(stream);
        }
        let drawn = self.types[below(stream, self.types.len())];
        let assembly = if below(stream, 2) == 0 { AssemblyMode::Plus } else { AssemblyMode::Minus };
        let directions = self.problem.directions();
        let direction = directions[below(stream, directions.len())];
        let which = below(stream, self.spaces.len());
        let on_ellipse = self.ellipse.as_ref().filter(|_| drawn == LinkageType::CrankRocker);
        let on_ellipse = on_ellipse.filter(|_| below(stream, ELLIPSE_EVERY) == 0);
        let slacks = if on_ellipse.is_some() { SMALL_CRANK_RANGE } else { SLACK_RANGE };
        let ratios = draw_ratios(stream, drawn, slacks)?;
        let timed = !matches!(self.problem.task().timing(), Timing::Free);
        let aimed = if timed { !self.problem.types().is_empty() } else { self.problem.aims_at_types() };
        let aim = aimed.then_some(drawn);
        let theta = uniform(stream, -PI, PI);
        let phase = uniform(stream, -PI, PI);
        let (side, space) = &self.spaces[which];
        let setting = Setting { aim, assembly, direction, side: *side };
        let mut known = KnownPivots::of(self.problem);
        match self.problem.task().timing() {
            Timing::Prescribed { offset, .. } => {
                let phases = self.problem.phases(direction);
                let turn = match offset {
                    AngleOffset::Free => Complex::from_polar(1.0, phase),
                    AngleOffset::Ground => Complex::new(1.0, 0.0),
                    AngleOffset::Fixed => {
                        let angle = match (known.crank_pivot, known.follower_pivot, known.ground_angle) {
                            (Some(a), Some(b), _) => (b - a).arg(),
                            (_, _, Some(angle)) => angle,
                            _ => theta,
                        };
                        known.ground_angle = Some(angle);
                        Complex::from_polar(1.0, -angle)
                    }
                };
                let position = |e: Complex| Some([e, coupler_direction(&ratios, e, assembly.sign())?]);
                let positions: Option<Positions> = phases.iter().map(|e| position(e * turn)).collect();
                let shape = self.fit(&ratios, &known, &positions?)?;
                let ground = (shape.follower_pivot - shape.crank_pivot).arg();
                let offset = if self.problem.offset_is_free() { phase + ground } else { 0.0 };
                let design = space.design(&shape, offset);
                let positions = match self.problem.task().body() {
                    None => TimedPathFit::new(self.problem, setting)?.attached(&design)?,
                    Some(_) => TimedMotionFit::new(self.problem, setting)?.attached(&design)?,
                };
                Some(Start { design, setting, positions, scales: AS_WRITTEN })
            }
            Timing::Free => {
                let along = on_ellipse.unwrap_or(&self.arc);
                let positions = self.free_positions(stream, along, &ratios, (drawn, assembly), direction)?;
                let shape = self.fit(&ratios, &known, &positions)?;
                Some(start_from(space, setting, &shape, &positions))
            }
        }
    }

    /// Fits the shape by linear least squares through positions measured from the ground line.
    pub(super) fn fit(
        &self,
        ratios: &Ratios,
        known: &KnownPivots,
        positions: &[[Complex; 2]],
    ) -> Option<Shape> {
        let task = self.problem.task();
        if !task.is_partly_timed() {
            return fit(ratios, known, positions, task.points(), task.weights());
        }
        // Of those with their own crank angle nothing is known yet.
        let timed: Vec<usize> = (0..task.len()).filter(|j| !task.is_untimed(*j)).collect();
        let positions: Vec<[Complex; 2]> = timed.iter().map(|j| positions[*j]).collect();
        let points: Vec<Complex> = timed.iter().map(|j| task.points()[*j]).collect();
        let weights: Vec<f64> = timed.iter().map(|j| task.weights()[*j]).collect();
        fit(ratios, known, &positions, &points, &weights)
    }

    /// Draws positions (from the ground line) spread along the circuit as the points are `along` the target, in parts of
    /// the whole.
    fn free_positions(
        &self,
        stream: &mut Stream,
        along: &[f64],
        ratios: &Ratios,
        (kind, assembly): (LinkageType, AssemblyMode),
        direction: f64,
    ) -> Option<Positions> {
        let closed = self.problem.task().closed() || self.problem.task().repeats_first();
        let start = uniform(stream, -PI, PI);
        let partial = uniform(stream, 0.5, 5.8);
        let within = [uniform(stream, -FRAC_PI_2, FRAC_PI_2), uniform(stream, -FRAC_PI_2, FRAC_PI_2)];
        let circuit = below(stream, 2) as u8;
        let way = Way { kind, assembly, start, span: direction * if closed { TAU } else { partial } };
        let rocking = || {
            let ends = within.map(f64::sin);
            let is_against = (ends[1] - ends[0]) * direction < 0.0 && self.problem.directions().len() == 1;
            (self.problem.branch_any() || !is_against).then_some((circuit, ends))
        };
        let mut positions = Positions::with_capacity(along.len());
        self.place(ratios, along, &way, rocking, &mut positions)?;
        Some(positions)
    }

    /// Computes positions (from the ground line) along the circuit as the points are `along` the target, in parts of the
    /// whole; `None` if the loop is open. For a crank that rocks, `rocking` returns the number of the circuit (modulo their number) and the
    /// two ends of the motion on its arc, in parts of its half width; they count unless the motion may pass toggles.
    pub(super) fn place(
        &self,
        ratios: &Ratios,
        along: &[f64],
        &Way { kind, assembly, start, span }: &Way,
        rocking: impl FnOnce() -> Option<(u8, [f64; 2])>,
        positions: &mut Positions,
    ) -> Option<()> {
        positions.clear();
        let mut take = |angle: f64, t: f64| {
            let e = Complex::from_polar(1.0, angle);
            positions.push([e, coupler_direction(ratios, e, t)?]);
            Some(())
        };
        if kind.input_turns_fully() || kind == LinkageType::ChangePoint {
            return along.iter().try_for_each(|s| take(start + span * s, assembly.sign()));
        }
        let mobility = unit_linkage(ratios)?;
        let (circuit, ends) = rocking()?;
        let arc = mobility.arc(Circuit { index: circuit % mobility.circuits().max(1) })?;
        let on_arc = |x: f64| arc.middle + INSIDE * arc.half_width * x;
        if self.problem.branch_any() {
            return along.iter().try_for_each(|s| {
                let psi = start + span * s;
                take(on_arc(psi.sin()), if psi.cos() < 0.0 { -1.0 } else { 1.0 })
            });
        }
        let ends = ends.map(on_arc);
        along.iter().try_for_each(|s| take(ends[0] + (ends[1] - ends[0]) * s, assembly.sign()))
    }
}

/// Returns the start of free timing at a shape and at positions measured from its ground line.
fn start_from(space: &DesignSpace, setting: Setting, shape: &Shape, positions: &[[Complex; 2]]) -> Start {
    let ground = shape.follower_pivot - shape.crank_pivot;
    let turn = ground / ground.norm();
    let positions = positions.iter().map(|[e, u]| [e * turn, u * turn]).collect();
    Start { design: space.design(shape, 0.0), setting, positions, scales: AS_WRITTEN }
}

/// The motion of a crank along its circuit, from the first point of the target to the last.
pub(super) struct Way {
    pub(super) kind: LinkageType,
    pub(super) assembly: AssemblyMode,
    /// The crank angle at the first point, from the ground line, and the angle through which it turns; if it rocks and
    /// may pass toggles, the phases psi, with sin psi in parts of the arc's half width.
    pub(super) start: f64,
    pub(super) span: f64,
}

/// Factor that keeps positions a little off the toggles, where the assembly is undecided.
const INSIDE: f64 = 1.0 - 1e-9;

/// Returns the types from which starts are drawn.
fn drawn_types(problem: &Problem) -> Vec<LinkageType> {
    match problem.types() {
        // Any type: the types that a motor can turn get half of the draws.
        [] => vec![
            LinkageType::CrankRocker,
            LinkageType::CrankRocker,
            LinkageType::DoubleCrank,
            LinkageType::RockerCrank,
            LinkageType::DoubleRocker,
            LinkageType::TripleRocker,
        ],
        some => some.to_vec(),
    }
}

/// Returns the mobility of the linkage with ground 1 along the x axis.
pub(super) fn unit_linkage(ratios: &Ratios) -> Option<Mobility> {
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [1.0, 0.0],
        crank: ratios.crank,
        coupler: ratios.coupler,
        follower: ratios.follower,
        crank_side: 0.0,
        follower_side: ratios.coupler,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .ok()?;
    Some(linkage.mobility())
}

/// Range of ratios over which slacks and lengths are drawn, evenly in their logarithm.
pub(super) const SLACK_RANGE: (f64, f64) = (0.02, 30.0);

/// One draw in this many has a slack from `LONG_RANGE`, far beyond the usual.
const LONG_EVERY: usize = 4;
const LONG_RANGE: (f64, f64) = (30.0, 1000.0);

/// On a target that is nearly an ellipse one draw of a crank-rocker in this many has its points at their phases on the
/// ellipse, and slacks from `SMALL_CRANK_RANGE`.
const ELLIPSE_EVERY: usize = 2;
const SMALL_CRANK_RANGE: (f64, f64) = (2.0, 100.0);

/// Draws the ratios of a linkage of a type; `None` if a few draws found none.
pub(super) fn draw_ratios(
    stream: &mut Stream,
    drawn: LinkageType,
    slack_range: (f64, f64),
) -> Option<Ratios> {
    let log_uniform =
        |stream: &mut Stream, (low, high): (f64, f64)| uniform(stream, low.ln(), high.ln()).exp();
    let links = match drawn {
        LinkageType::TripleRocker => {
            // Most draws are not triple-rockers: try a few, always as many.
            let tries = [(); 16].map(|()| [(); 4].map(|()| log_uniform(stream, (0.2, 5.0))));
            let fits = |links: [f64; 4]| {
                linkage_type(links) == Some(LinkageType::TripleRocker) && grashof_margin(links) < 0.0
            };
            tries.into_iter().find(|links| fits(*links))?
        }
        _ => {
            let mut s = [(); 3].map(|()| log_uniform(stream, slack_range));
            let any = (below(stream, 3), below(stream, 4));
            if below(stream, LONG_EVERY) == 0 {
                // Two long links beside each other: towards a slider in place of a link.
                s[any.0] = log_uniform(stream, LONG_RANGE);
            }
            if drawn == LinkageType::ChangePoint {
                // One slack is used up: the margin is zero.
                s[any.0] = 0.0;
            }
            let others = [1.0 + 0.5 * (s[1] + s[2]), 1.0 + 0.5 * (s[0] + s[2]), 1.0 + 0.5 * (s[0] + s[1])];
            let place = match drawn {
                LinkageType::DoubleCrank => 0,
                LinkageType::CrankRocker => 1,
                LinkageType::DoubleRocker => 2,
                LinkageType::ChangePoint => any.1,
                _ => 3,
            };
            let mut links = [1.0; 4];
            for (slot, value) in (0..4).filter(|&i| i != place).zip(others) {
                links[slot] = value;
            }
            links
        }
    };
    let [g, a, b, c] = links;
    Some(Ratios { crank: a / g, coupler: b / g, follower: c / g })
}
