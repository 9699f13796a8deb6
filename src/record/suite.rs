//! The figures of a suite: problems with a known answer, many seeds each.

pub use super::statistics::{MotionErrors, Run, Summary};
use super::{Certificate, Tool};
use crate::task::spec::Method;
use serde::Serialize;

/// The version of the suite's JSON format.
pub const FORMAT: u32 = 1;

/// A suite: problems, seeds and figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suite {
    /// The version of the format: [`FORMAT`].
    pub format: u32,
    /// The program that made it, with its version.
    pub tool: Tool,
    /// The command that makes it again.
    pub command: String,
    /// The name of the folder of the problems, where they are not those of the literature.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collection: Option<String>,
    /// The number of seeds that was asked for: seeds 1 to this.
    pub seeds: u64,
    /// The number of threads of every search: 1.
    pub threads: usize,
    /// Whether every run was finished; `false` after a cancellation.
    pub complete: bool,
    /// The problems in the given order; after a cancellation, those that were begun.
    pub problems: Vec<ProblemResult>,
    /// The problems that were not run.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
}

/// A problem that is not run, because nothing is known that its answers could be compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// The name of the problem.
    pub name: String,
    /// The reason.
    pub why: String,
}

/// The figure that the answers of a problem are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Known {
    /// Of a path: sums of squared distances.
    Path {
        /// The least sum of squares that is known.
        best_known_sum_sq: f64,
        /// The sum of squares that a run has to reach to count as a hit.
        goal_sum_sq: f64,
    },
    /// Of a motion: the objective, [`MotionErrors::objective`]. A run has to reach it to count as a hit.
    Motion {
        /// The least objective that is known.
        best_known_objective: f64,
        /// A length: an angle error of one radian counts like an error of the place of this length.
        angle_weight: f64,
    },
    /// Of a function: the sum of weighted squared errors of the output, in degrees squared or of a slider's place. A run has
    /// to reach it to count as a hit.
    Function {
        /// The least objective that is known.
        best_known_objective: f64,
        /// Whether the outputs are places of a slider.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        of_places: bool,
    },
}

impl Known {
    /// Returns the least figure that is known.
    pub fn best(&self) -> f64 {
        match *self {
            Known::Path { best_known_sum_sq, .. } => best_known_sum_sq,
            Known::Motion { best_known_objective, .. } | Known::Function { best_known_objective, .. } => {
                best_known_objective
            }
        }
    }

    /// Returns the figure that a run has to reach to count as a hit.
    pub fn goal(&self) -> f64 {
        match *self {
            Known::Path { goal_sum_sq, .. } => goal_sum_sq,
            Known::Motion { best_known_objective, .. } | Known::Function { best_known_objective, .. } => {
                best_known_objective
            }
        }
    }
}

/// The results for one problem of a suite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProblemResult {
    /// The name of the problem.
    pub name: String,
    /// The source of the problem.
    pub source: Option<String>,
    /// The number of target points; of a motion, of poses and places; of a function, of pairs.
    pub points: usize,
    /// The figure that its answers are compared with.
    #[serde(flatten)]
    pub known: Known,
    /// The results of the method that the file asks for, from every seed.
    pub search: MethodResult,
    /// The results of the population searches with the median number of evaluations of `search`.
    pub populations: Vec<MethodResult>,
    /// The reason why there are no population searches.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_populations: Option<String>,
    /// The smallest accepted answer of all runs, if it is smaller than the best known by more than one part in a
    /// million.
    pub smaller_than_best_known: Option<Smaller>,
    /// The published answers, evaluated again.
    pub published: Vec<PublishedResult>,
    /// The one of `published` with the least sum by our evaluation; if none can be evaluated, the one with the least
    /// printed sum.
    pub best_published: Option<PublishedResult>,
    /// The certificate of the best accepted answer of `search`, if certificates are asked for and there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// The reason why there is no certificate, if certificates are asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_certificate: Option<String>,
}

/// The results of one method on one problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodResult {
    /// The method.
    pub method: Method,
    /// The largest number of evaluations of the objective in each run.
    pub evaluations_at_most: u64,
    /// The summary of all runs.
    pub summary: Summary,
    /// The runs, in the order of their seeds.
    pub runs: Vec<Run>,
}

/// An accepted answer that is smaller than the best known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Smaller {
    /// The method that found it.
    pub method: Method,
    /// The seed of its run.
    pub seed: u64,
    /// Its sum of squares.
    pub sum_sq: f64,
    /// In a motion: its objective.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objective: Option<f64>,
}

impl Smaller {
    /// Returns the figure that answers are compared by: a motion's objective, a path's sum of squares.
    pub fn figure(&self) -> f64 {
        self.objective.unwrap_or(self.sum_sq)
    }
}

/// A published answer, evaluated again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PublishedResult {
    /// Author and year.
    pub source: String,
    /// The printed sum of squares, if it could be read in the source.
    pub printed_sum_sq: Option<f64>,
    /// The sum of squares of the published vector by our referee; `None` without a vector that can be assembled at
    /// every point.
    pub sum_sq: Option<f64>,
    /// The sum of squared distances of the points to the whole curve.
    pub to_curve_sum_sq: Option<f64>,
    /// Whether the answer meets the problem's own requirements.
    pub accepted: Option<bool>,
    /// The requirements that it does not meet.
    pub unmet: Vec<String>,
}

impl ProblemResult {
    /// Returns whether the problem is a motion: poses of a body.
    pub fn is_motion(&self) -> bool {
        matches!(self.known, Known::Motion { .. })
    }

    /// Returns whether the problem is a function whose outputs are places of a slider.
    pub fn is_of_places(&self) -> bool {
        matches!(self.known, Known::Function { of_places: true, .. })
    }

    /// Returns whether the problem is a function: angles of the follower, or places of a slider.
    pub fn is_function(&self) -> bool {
        matches!(self.known, Known::Function { .. })
    }
}

impl Suite {
    /// Returns whether every seed of every problem has an accepted answer, and no run is missing.
    pub fn is_accepted(&self) -> bool {
        self.complete && self.problems.iter().all(|p| p.search.summary.accepted == p.search.runs.len())
    }
}
