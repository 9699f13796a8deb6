//! Tasks: the targets, the requirements, and both as mathematics.
//!
//! | module | holds |
//! |---|---|
//! | [`builder`] | a builder of problems from points, with the defaults of a problem file |
//! | [`defect`] | defects of a motion through target points: order, branch, circuit |
//! | [`forms`] | the task as mathematics: design space, residuals with derivatives, requirements, fitness |
//! | `limits` | intervals in which the parameters of a design lie |
//! | [`path`] | the synthesis task: a path for the coupler point, with or without crank angles at its points |
//! | [`problem`] | a checked `ProblemSpec`, and the discrete choices of a search besides the design vector (`Setting`) |
//! | [`requirement`] | requirements on a linkage, one file each: key, parsing, limits with their outward side, unit and words |
//! | [`resampling`] | smoothing and resampling of digitised points into a target |
//! | [`similarity`] | similarities that map the axes to themselves and renumberings of a path's points, of a whole problem |
//! | [`spec`] | the problem as data: every key of a problem file with its default filled in |

mod builder;
pub mod defect;
pub mod forms;
mod limits;
mod path;
pub mod problem;
pub mod requirement;
pub mod resampling;
pub mod similarity;
pub mod spec;
pub(crate) mod values;

pub use builder::ProblemBuilder;
pub use defect::Defect;
pub(crate) use path::corners;
pub use path::{AngleOffset, PathOptions, PathTask, Return, SMALLEST_SIZE, TaskError, Timing};
pub use problem::{Problem, Setting};
