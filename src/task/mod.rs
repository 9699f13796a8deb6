//! Tasks: the targets, the requirements, and both as mathematics.
//!
//! | module | holds |
//! |---|---|
//! | `body` | the angles of a link that a task asks for: of a body in a motion, or the outputs of a function |
//! | [`builder`] | a builder of problems from points, with the defaults of a problem file |
//! | [`defect`] | defects of a motion through target points: order, branch, circuit |
//! | [`forms`] | the task as mathematics: design space, residuals with derivatives, requirements, fitness |
//! | `kind` | the kinds of tasks, with their words |
//! | `limits` | intervals in which the parameters of a design lie |
//! | [`loads`] | loads of a problem, the same for every candidate |
//! | [`pivot_on`] | lines and points on which the fixed pivots are to lie |
//! | [`problem`] | a checked `ProblemSpec`, and the discrete choices of a search besides the design vector (`Setting`) |
//! | [`ranges`] | free ranges of a function: the scales of its inputs and outputs |
//! | [`region`] | regions of the plane: a box along the axes, or a polygon |
//! | [`requirement`] | requirements on a linkage, one file each: key, parsing, limits with their outward side, unit and words |
//! | [`resampling`] | smoothing and resampling of digitised points into a target |
//! | [`similarity`] | similarities that map the axes to themselves and renumberings of a path's points, of a whole problem |
//! | [`spec`] | the problem as data: every key of a problem file with its default filled in |
//! | `task_spec` | the task as data: a list of targets, written as `path`, as `motion` or as `function` |
//! | `targets` | the synthesis task: a list of targets for the coupler point and, in poses, for the angle of the body, or for the outputs of a function, with or without crank angles |
//! | [`without_several_loops`] | reasons why six-bars and eight-bars are not searched for in a problem |
//! | `values` | the value types of TOML files, with errors in a designer's words |

mod body;
mod builder;
pub mod defect;
pub mod forms;
mod kind;
mod limits;
pub mod loads;
pub mod pivot_on;
pub mod problem;
pub mod ranges;
pub mod region;
pub mod requirement;
pub mod resampling;
pub mod similarity;
pub mod spec;
mod targets;
mod task_spec;
pub(crate) mod values;
pub mod without_several_loops;

pub use body::{Body, Link, Output, Sense, best_frame};
pub use builder::ProblemBuilder;
pub use defect::Defect;
pub use kind::TaskKind;
pub use problem::{Problem, Setting};
pub(crate) use targets::corners;
pub use targets::{AngleOffset, Return, SMALLEST_SIZE, Task, TaskError, TaskOptions, Timing};
