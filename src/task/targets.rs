//! The synthesis task: a list of targets for the coupler point and, in poses, for the angle of the body, with or without
//! crank angles.
//!
//! A list of n targets is met by a linkage at positions (phi_j, t1_j). The structural error of the place of target j is
//! T_j - P(phi_j, t1_j). A target may also give the angle theta_j of a body that is fixed to the coupler: its structural
//! error is theta_j - (arg(D_j - C_j) + beta), within half a turn, where beta is the angle from the direction C -> D to the
//! body's x axis (its frame). A list without such angles is a *path*, one with them a *motion*. A *function* gives no
//! points but outputs at prescribed crank angles ([`super::body`]): of angles of the follower the structural error is s theta_j -
//! (arg(D_j - B) + beta), where s = +1 or -1 is the sense in which the follower turns and -beta its angle at an output of zero. With
//! *prescribed timing* the crank angles are given (up to a common offset, from the x axis, or from the ground line A ->
//! B); with *free timing* each is chosen to be nearest. This module uses `mechanism` and nothing else of the crate.

use super::body::{Body, Link, check_body};
use crate::mechanism::{Complex, MAX_MAGNITUDE};
use crate::task::ranges::Ranges;

/// The reference direction of prescribed crank angles.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum AngleOffset {
    /// Only the increments count: a common offset is free.
    #[default]
    Free,
    /// From the x axis.
    Fixed,
    /// From the line A -> B.
    Ground,
}

/// The timing of the target points: the crank angles at which the coupler point is to reach them.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing {
    /// Free timing: at the crank angle that is nearest.
    Free,
    /// Prescribed timing: at these crank angles.
    Prescribed {
        /// The crank angle at each point, in radians, counter-clockwise positive, not wrapped.
        crank_angles: Vec<f64>,
        /// Reference direction of the crank angles.
        offset: AngleOffset,
    },
}

/// The ways in which the motion may come back to the first point of a path that ends where it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Return {
    /// By turning on in the same direction: the crank turns fully.
    #[default]
    TurningOn,
    /// By going on around its circuit; a crank that rocks does so through both of its toggles.
    AroundTheCircuit,
    /// Also by going back through all points.
    Any,
}

/// The least extent of a target; smaller ones are refused: squares of their errors would be lost below the smallest
/// number.
pub const SMALLEST_SIZE: f64 = 1e-100;

/// A list of targets: a path to trace, or poses that a body is to pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    points: Vec<Complex>,
    weights: Vec<f64>,
    tolerances: Option<Vec<f64>>,
    closed: bool,
    comes_back: Return,
    timing: Timing,
    /// Whether the crank angle of each target is free although others are prescribed; empty: of none.
    untimed: Vec<bool>,
    body: Option<Body>,
    size: f64,
    error_size: f64,
    centre: Complex,
}

/// The error of numbers that do not make a task.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// The path has fewer than two points.
    #[error("a path needs at least 2 points, this one has {0}")]
    TooFewPoints(usize),
    /// A number that is NaN, infinite or too large.
    #[error("point {index}: {value} is not a finite number below {max:e} in magnitude", max = MAX_MAGNITUDE)]
    NotFinite {
        /// Index of the point, counted from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Two adjacent points are equal, and no different crank angles distinguish them. Carries the index of the first,
    /// counted from 0.
    #[error("points {0} and {next} are equal", next = .0 + 1)]
    AdjacentEqual(usize),
    /// No target of a motion has an angle.
    #[error("no target has an angle: without angles this is a path")]
    NoAngle,
    /// The length that an angle error of one radian counts like is not a positive number.
    #[error("angle_weight = {0}: it must be a length above 0")]
    AngleWeight(f64),
    /// A target is named as free that is not there, or beside which none has a crank angle.
    #[error("target {0} has no crank angle that could be free")]
    NotTimed(usize),
    /// Fewer than two targets have a crank angle.
    #[error("crank angles are prescribed at fewer than two targets")]
    TooFewTimed,
    /// All outputs of a function are equal.
    #[error("all outputs are equal: the output link would stand still")]
    ConstantOutput,
    /// All inputs of a function are equal.
    #[error("all inputs are equal: the crank would stand still")]
    ConstantInput,
    /// An output has a tolerance while the range of the outputs is free.
    #[error(
        "tolerances of the output do not go with a free output range: errors in degrees shrink with the range"
    )]
    ToleranceOfFreeRange,
    /// A function has no crank angles.
    #[error("a function needs a crank angle for each output")]
    NoInput,
    /// All points in one place, within [`SMALLEST_SIZE`].
    #[error("all points are equal, or lie within {size:e} of each other", size = SMALLEST_SIZE)]
    NoExtent,
    /// A list beside the points has another length.
    #[error("{points} points but {values} values of {what}")]
    LengthMismatch {
        /// Name of the list.
        what: &'static str,
        /// Number of points.
        points: usize,
        /// Number of values.
        values: usize,
    },
    /// A weight that is not positive or a tolerance that is negative.
    #[error("{what} of point {index} is {value}: it must be {must}")]
    OutOfRange {
        /// Name of the list.
        what: &'static str,
        /// Index of the point, counted from 0.
        index: usize,
        /// The value.
        value: f64,
        /// The allowed range, in words.
        must: &'static str,
    },
}

/// Returns the lower left and the upper right corner of the points' box.
pub(crate) fn corners(points: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    points.iter().fold(([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]), |(low, high), [x, y]| {
        ([low[0].min(*x), low[1].min(*y)], [high[0].max(*x), high[1].max(*y)])
    })
}

/// The optional lists of a path task.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaskOptions {
    /// One positive weight per point; they enter the objective only.
    pub weights: Option<Vec<f64>>,
    /// One tolerance per point: the largest error accepted there.
    pub tolerances: Option<Vec<f64>>,
    /// Whether the target is a closed curve: the last point is followed by the first.
    pub closed: bool,
    /// The targets with prescribed timing whose crank angle is free after all.
    pub untimed: Vec<usize>,
    /// The angles of a body, in a motion.
    pub body: Option<Body>,
}

impl Task {
    /// Creates a list of targets at `points` with the given timing.
    ///
    /// A last point equal to the first is kept.     /// Adjacent equal points are refused unless the timing is prescribed (the point dwells there) or the body lies there at
    /// different angles.
    /// crank angles are equal modulo a turn, or the body lies there at different angles.
    ///
    /// # Errors
    /// [`TaskError`], by its variants.
    pub fn new(points: Vec<[f64; 2]>, timing: Timing, options: TaskOptions) -> Result<Self, TaskError> {
        let follower = options.body.as_ref().filter(|body| matches!(body.link, Link::Output { .. }));
        let n = follower.map_or(points.len(), |body| body.angles.len());
        if n < 2 {
            return Err(TaskError::TooFewPoints(n));
        }
        let usable = |value: f64| value.abs() <= MAX_MAGNITUDE;
        for (index, p) in points.iter().enumerate() {
            if let Some(&value) = p.iter().find(|v| !usable(**v)) {
                return Err(TaskError::NotFinite { index, value });
            }
        }
        let same_length = |what, values: usize| {
            if values == n { Ok(()) } else { Err(TaskError::LengthMismatch { what, points: n, values }) }
        };
        if let Timing::Prescribed { crank_angles, .. } = &timing {
            same_length("crank_deg", crank_angles.len())?;
            if let Some(index) = crank_angles.iter().position(|v| !usable(*v)) {
                return Err(TaskError::NotFinite { index, value: crank_angles[index] });
            }
        }
        let mut untimed = vec![false; if options.untimed.is_empty() { 0 } else { n }];
        for &j in &options.untimed {
            match untimed.get_mut(j) {
                Some(is_free) if matches!(timing, Timing::Prescribed { .. }) => *is_free = true,
                _ => return Err(TaskError::NotTimed(j)),
            }
        }
        if !untimed.is_empty() && untimed.iter().filter(|is_free| !**is_free).count() < 2 {
            return Err(TaskError::TooFewTimed);
        }
        let positive: fn(f64) -> bool = |value| value > 0.0;
        let lists = [
            ("weight", &options.weights, positive, "positive"),
            ("tolerance", &options.tolerances, |value| value >= 0.0, "0 or more"),
        ];
        for (what, list, is_within, must) in lists {
            let Some(list) = list else { continue };
            same_length(what, list.len())?;
            if let Some(index) = list.iter().position(|v| !(is_within(*v) && usable(*v))) {
                return Err(TaskError::OutOfRange { what, index, value: list[index], must });
            }
        }
        if let Some(body) = &options.body {
            check_body(body, n)?;
        }
        if let Some(body) = follower {
            return Task::function(body.clone(), timing, options);
        }
        let (low, high) = corners(&points);
        let mut size = f64::hypot(high[0] - low[0], high[1] - low[1]);
        if size < SMALLEST_SIZE {
            // A body that only turns has the scale of its angles.
            size = options.body.as_ref().map(|body| body.angle_weight).ok_or(TaskError::NoExtent)?;
        }
        for i in 0..n - 1 {
            // At two crank angles the point is to dwell.
            let timed_equal = matches!(timing, Timing::Prescribed { .. });
            let turned = options.body.as_ref().is_some_and(|body| body.angles[i] != body.angles[i + 1]);
            if points[i] == points[i + 1] && !timed_equal && !turned {
                return Err(TaskError::AdjacentEqual(i));
            }
        }
        Ok(Task {
            points: points.into_iter().map(crate::mechanism::point).collect(),
            weights: options.weights.unwrap_or_else(|| vec![1.0; n]),
            tolerances: options.tolerances,
            closed: options.closed,
            comes_back: Return::default(),
            timing,
            untimed,
            body: options.body,
            size,
            error_size: size,
            centre: Complex::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])),
        })
    }

    /// Creates the task of a function, whose lists have been checked: no points, and a linkage of the size 1, or of the range
    /// of a slider's places.
    fn function(body: Body, timing: Timing, options: TaskOptions) -> Result<Self, TaskError> {
        let Timing::Prescribed { crank_angles, .. } = &timing else { return Err(TaskError::NoInput) };
        if crank_angles.iter().all(|angle| *angle == crank_angles[0]) {
            return Err(TaskError::ConstantInput);
        }
        let range = body.range();
        if range <= SMALLEST_SIZE {
            return Err(TaskError::ConstantOutput);
        }
        if body.ranges().free()[1] && body.tolerances.is_some() {
            return Err(TaskError::ToleranceOfFreeRange);
        }
        Ok(Task {
            points: Vec::new(),
            weights: options.weights.unwrap_or_else(|| vec![1.0; body.angles.len()]),
            tolerances: None,
            closed: false,
            comes_back: Return::default(),
            timing,
            untimed: Vec::new(),
            size: if body.is_of_places() { body.angle_weight * range } else { 1.0 },
            error_size: body.angle_weight * range,
            body: Some(body),
            centre: Complex::new(0.0, 0.0),
        })
    }

    /// Returns the same function for linkages of this size: the length of their ground link.
    pub(super) fn of_size(self, size: f64) -> Self {
        Task { size, ..self }
    }

    /// Returns the same task with other weights, one positive number per point.
    pub(super) fn with_weights(self, weights: Vec<f64>) -> Self {
        Task { weights, ..self }
    }

    /// Returns the same task with another rule for the way back to its first point.
    pub fn coming_back(self, comes_back: Return) -> Self {
        Task { comes_back, ..self }
    }

    /// Returns the target points; none of a function.
    pub fn points(&self) -> &[Complex] {
        &self.points
    }

    /// Returns the number of targets.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Returns whether there are no targets: never, since a task has at least two.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// Returns the positive weight of each point, 1 if none was given.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Returns the largest error accepted at each point.
    pub fn tolerances(&self) -> Option<&[f64]> {
        self.tolerances.as_deref()
    }

    /// Returns the largest of the tolerances of the error: of the places, or in a function of the outputs, degrees.
    pub fn largest_tolerance(&self) -> Option<f64> {
        let of_output = || {
            let output = self.body.as_ref().filter(|_| self.is_function())?;
            Some(output.tolerances.as_ref()?.iter().map(|t| output.angle_weight * t).collect())
        };
        let all: Vec<f64> = self.tolerances.clone().or_else(of_output)?;
        Some(all.into_iter().fold(0.0, f64::max))
    }

    /// Returns whether an error is limited at each target: of the place or of the body's angle.
    pub fn has_tolerances(&self) -> bool {
        self.tolerances.is_some() || self.body.as_ref().is_some_and(|body| body.tolerances.is_some())
    }

    /// Returns whether the target is a closed curve.
    pub fn closed(&self) -> bool {
        self.closed
    }

    /// Returns the rule for the motion's way back to the first point; it matters only if [`Task::returns`].
    pub fn comes_back(&self) -> Return {
        self.comes_back
    }

    /// Returns whether the motion has to come back to the first point: the target is closed, or its last point repeats
    /// the first and the timing is free. (Prescribed angles determine themselves how the repeated point is reached.)
    pub fn returns(&self) -> bool {
        self.closed || (self.timing == Timing::Free && self.repeats_first())
    }

    /// Returns whether the last target repeats the first.
    pub fn repeats_first(&self) -> bool {
        let Some(last) = self.points.len().checked_sub(1) else { return false };
        let as_first = |body: &Body| body.angles[0] == body.angles[last];
        last > 1 && self.points[0] == self.points[last] && self.body.as_ref().is_none_or(as_first)
    }

    /// Returns the angles of the body in a motion, those of the follower in a function.
    pub fn body(&self) -> Option<&Body> {
        self.body.as_ref()
    }

    /// Returns whether the task is a function: outputs at crank angles, and no points.
    pub fn is_function(&self) -> bool {
        self.body.as_ref().is_some_and(|body| matches!(body.link, Link::Output { .. }))
    }

    /// Returns the bounds of the scales of a function's inputs and outputs: 1 unless its ranges are free.
    pub fn ranges(&self) -> Ranges {
        self.body.as_ref().map_or_else(Ranges::default, Body::ranges)
    }

    /// Returns the timing.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Returns whether some crank angles are prescribed and others free.
    pub fn is_partly_timed(&self) -> bool {
        !self.untimed.is_empty()
    }

    /// Returns whether the crank angle of a target is free although others are prescribed.
    pub fn is_untimed(&self, j: usize) -> bool {
        self.untimed.get(j).copied().unwrap_or(false)
    }

    /// Returns the crank angles between which that of a target lies which has its own: those of the timed targets before and after
    /// it, on the way around the list. `angles` holds those of the timed targets, `turn` is a whole turn in their unit.
    pub fn between_timed(&self, angles: &[f64], turn: f64, j: usize) -> Option<[f64; 2]> {
        let n = angles.len() as isize;
        let turn = if angles.last() < angles.first() { -turn } else { turn };
        let neighbour = |step: isize| {
            (1..=n).find_map(|k| {
                let place = j as isize + step * k;
                let at = place.rem_euclid(n) as usize;
                (!self.is_untimed(at)).then(|| angles[at] + turn * place.div_euclid(n) as f64)
            })
        };
        Some([neighbour(-1)?, neighbour(1)?])
    }

    /// Returns the diagonal of the target's bounding box; of a body that only turns, the length that an angle error of one
    /// radian counts like; of a function, the length of the ground link. Positive.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Returns the error that is as large as the target: its size; of a function the range of its outputs, in degrees.
    pub fn error_size(&self) -> f64 {
        self.error_size
    }

    /// Returns the centre of the target's bounding box.
    pub fn centre(&self) -> Complex {
        self.centre
    }
}
