//! The checked problem, and the discrete choices of a search.
//!
//! A [`Problem`] is a checked [`ProblemSpec`]. The discrete choices of a search besides the design vector (the
//! assembly, the crank's direction, the type aimed at, the side of the coupler point) are a [`Setting`].

use super::spec::{
    ClosingPolicy, DirectionPolicy, Objective, OnePolicy, OrderPolicy, ProblemSpec, RequireSpec,
};
use crate::mechanism::{AssemblyMode, Complex, CouplerSide, LinkageType};
use crate::task::forms::design_space::DesignSpace;
use crate::task::forms::rows::Requirements;
use crate::task::region::Region;
use crate::task::{AngleOffset, Return, Task, TaskError, Timing};
use serde::{Deserialize, Serialize};

/// A checked problem.
#[derive(Clone, Debug)]
pub struct Problem {
    spec: ProblemSpec,
    task: Task,
    types: Vec<LinkageType>,
    grid: f64,
}

/// The discrete choices of a search besides the design vector.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The type aimed at; `None`: any.
    pub aim: Option<LinkageType>,
    /// The assembly sign t1 (prescribed timing).
    pub assembly: AssemblyMode,
    /// The direction of the crank. +1: the prescribed increments as written, -1: reversed. With free timing the sense
    /// in which starts run; in a function the sign of the outputs.
    pub direction: f64,
    /// The side t2 of the coupler point, used if d and e are coordinates of the design.
    pub side: CouplerSide,
}

/// Returns the task for the largest deviation. Its weights replace those of the file, which do not enter: with (least
/// tolerance / tol_j)^2 least squares come nearest to it.
fn measured_by_tolerances(task: Task) -> Result<Task, TaskError> {
    let weights = match task.tolerances() {
        None => vec![1.0; task.len()],
        Some(tolerances) => {
            if let Some((index, &value)) = tolerances.iter().enumerate().find(|(_, t)| **t <= 0.0) {
                let must = "positive where deviations are measured by it";
                return Err(TaskError::OutOfRange { what: "tolerance", index, value, must });
            }
            let least = tolerances.iter().copied().fold(f64::INFINITY, f64::min);
            tolerances.iter().map(|t| (least / t).powi(2).max(LEAST_WEIGHT)).collect()
        }
    };
    Ok(task.with_weights(weights))
}

/// Returns the ways in which the motion may come back to the first point, if it has to.
fn way_back(require: &RequireSpec) -> Return {
    match (require.closing, require.branch) {
        (ClosingPolicy::Any, _) => Return::Any,
        (ClosingPolicy::OneWay, OnePolicy::Any) => Return::AroundTheCircuit,
        (ClosingPolicy::OneWay, OnePolicy::One) => Return::TurningOn,
    }
}

/// Returns those of the given types (none: of all) whose crank turns fully. If no type does, they stay as they are:
/// nothing that they allow can be acceptable then, and the search reports that.
fn turning(types: &[LinkageType]) -> Vec<LinkageType> {
    let turns = |kind: &LinkageType| kind.input_turns_fully() || *kind == LinkageType::ChangePoint;
    let left: Vec<LinkageType> = types.iter().copied().filter(turns).collect();
    match (types, left.as_slice()) {
        ([], _) => vec![LinkageType::CrankRocker, LinkageType::DoubleCrank],
        (_, []) => types.to_vec(),
        _ => left,
    }
}

/// Least weight of a point, in parts of the largest, so that each weight stays above zero.
const LEAST_WEIGHT: f64 = 1e-12;

impl Problem {
    /// Creates a problem from its resolved data.
    ///
    /// # Errors
    /// As [`Task::new`]; and if the largest deviation is minimised and a tolerance is zero.
    pub fn new(spec: ProblemSpec) -> Result<Self, TaskError> {
        let mut task = spec.task.to_task()?;
        if task.body().is_some_and(|body| task.is_function() && !body.is_of_places()) {
            task = task.of_size(spec.design.function_ground());
        }
        if spec.solve.objective == Objective::MaxDeviation {
            task = measured_by_tolerances(task)?;
        }
        task = task.coming_back(way_back(&spec.require));
        let mut types = spec.require.types.clone();
        types.sort();
        types.dedup();
        let mut problem = Problem { spec, task, types, grid: 0.0 };
        if problem.has_to_turn() {
            problem.types = turning(&problem.types);
        }
        Ok(problem)
    }

    /// Creates a problem whose coordinates have been rounded to multiples of `grid`, a part of the target's size.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn on_grid(spec: ProblemSpec, grid: f64) -> Result<Self, TaskError> {
        Ok(Problem { grid, ..Problem::new(spec)? })
    }

    /// Creates a problem of other data whose coordinates are as exact as this one's.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn with(&self, spec: ProblemSpec) -> Result<Self, TaskError> {
        Problem::on_grid(spec, self.grid)
    }

    /// Returns the grid to which its coordinates have been rounded, a part of the target's size; 0 if they are as given.
    pub fn grid(&self) -> f64 {
        self.grid
    }

    /// Returns the data it was made from.
    pub fn spec(&self) -> &ProblemSpec {
        &self.spec
    }

    /// Returns the task.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// Returns whether only a crank that turns fully can be acceptable: the motion has to come back to its first point,
    /// in order, without reversing and without passing a toggle.
    pub fn has_to_turn_on(&self) -> bool {
        self.task.returns() && self.order_required() && self.task.comes_back() == Return::TurningOn
    }

    /// Returns whether only a crank that turns fully can be acceptable: it is asked for, or the motion has to turn on.
    pub fn has_to_turn(&self) -> bool {
        self.has_to_turn_on() || self.spec.require.asks_full_turn()
    }

    /// Returns the types that are searched for, sorted; empty: any. They are the required ones; if the crank has to
    /// turn fully, those of them whose crank does.
    pub fn types(&self) -> &[LinkageType] {
        &self.types
    }

    /// Returns whether searches hold their fits to one of the types from the start: true if types or a full turn are required. If only
    /// the crank has to turn fully, fits are free to pass a change point, and those that end beyond it are led back.
    pub fn aims_at_types(&self) -> bool {
        !self.spec.require.types.is_empty() || self.spec.require.asks_full_turn()
    }

    /// Returns whether the crank angle's offset is an unknown of the design vector.
    pub fn offset_is_free(&self) -> bool {
        matches!(self.task.timing(), Timing::Prescribed { offset: AngleOffset::Free, .. })
    }

    /// Returns whether the task is a function.
    pub fn is_function(&self) -> bool {
        self.task.is_function()
    }

    /// Returns whether the frame of a body, its angle from the coupler's direction, is an unknown of the design vector: in a
    /// motion with free timing.
    pub fn frame_is_free(&self) -> bool {
        self.task.body().is_some() && matches!(self.task.timing(), Timing::Free)
    }

    /// Returns the design space for a side of the coupler point.
    pub fn space(&self, side: CouplerSide) -> DesignSpace {
        DesignSpace::new(
            &self.spec.design,
            &self.task,
            self.offset_is_free() || self.frame_is_free(),
            (self.spec.require.pivots_in.as_ref().map(Region::corners), self.spec.require.pivot_on.as_ref()),
            side,
        )
    }

    /// Returns the requirements over a design space.
    pub fn requirements(&self, space: &DesignSpace) -> Requirements {
        let rows = Requirements::new(&self.spec.require, space.derived(), self.task.size());
        rows.under(self.spec.loads.as_ref())
    }

    /// Returns the directions in which prescribed increments may be run, +1 first; for free timing the allowed senses; of a
    /// function, whose inputs run as they are written, the signs of its outputs.
    pub fn directions(&self) -> &'static [f64] {
        if let Some(body) = self.task.body().filter(|_| self.is_function()) {
            return body.signs();
        }
        match (self.task.timing(), self.spec.require.direction) {
            (Timing::Prescribed { offset: AngleOffset::Fixed | AngleOffset::Ground, .. }, _) => &[1.0],
            (_, DirectionPolicy::Any) => &[1.0, -1.0],
            (Timing::Free, DirectionPolicy::Ccw) => &[1.0],
            (Timing::Free, DirectionPolicy::Cw) => &[-1.0],
            (Timing::Prescribed { crank_angles, .. }, policy) => {
                let rising = crank_angles.last() >= crank_angles.first();
                if rising == (policy == DirectionPolicy::Ccw) { &[1.0] } else { &[-1.0] }
            }
        }
    }

    /// Returns the sides of the coupler point to try: both only if d and e are the coordinates.
    pub fn sides(&self) -> &'static [CouplerSide] {
        if DesignSpace::has_side(&self.spec.design) {
            &[CouplerSide::Plus, CouplerSide::Minus]
        } else {
            &[CouplerSide::Plus]
        }
    }

    /// Returns whether the points must be passed in order.
    pub fn order_required(&self) -> bool {
        self.spec.require.order == OrderPolicy::Required
    }

    /// Returns whether the motion may pass a toggle.
    pub fn branch_any(&self) -> bool {
        self.spec.require.branch == OnePolicy::Any
    }

    /// Returns whether the points may lie on different circuits.
    pub fn circuit_any(&self) -> bool {
        self.spec.require.circuit == OnePolicy::Any
    }

    /// Returns the sign of the prescribed increments in a direction: those of a function run as they are written.
    pub fn run(&self, direction: f64) -> f64 {
        if self.is_function() { 1.0 } else { direction }
    }

    /// Returns e^{i psi_j} of the prescribed angles in a direction; empty for free timing.
    pub fn phases(&self, direction: f64) -> Vec<Complex> {
        let direction = self.run(direction);
        match self.task.timing() {
            Timing::Free => Vec::new(),
            Timing::Prescribed { crank_angles, .. } => {
                crank_angles.iter().map(|psi| Complex::from_polar(1.0, direction * psi)).collect()
            }
        }
    }
}
