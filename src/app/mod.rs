//! The doors: a job in, a record out; folders of results; the suite; the command line; the studio.
//!
//! | room | what it holds |
//! |---|---|
//! | [`checkpoint`] | checkpoints of unfinished searches on disk, from which `synth --resume` continues |
//! | [`cli`] | the command line: arguments, commands, exit codes |
//! | [`given`] | inputs of the export, comparison and report commands: a result of a run, one candidate of it, or a linkage without a run |
//! | [`measured`] | measuring the inputs of a comparison: every figure is computed again, and none is taken from a record unchecked |
//! | [`published`] | evaluation of published answers: the vectors of the literature, judged by our own referee |
//! | [`result_files`] | the files of a result's folder, as bytes: pure functions of the record, apart from its times |
//! | [`results_folder`] | A result's folder: locked while it is written to, replaced as a whole, and never mixed with files of other origin |
//! | [`run`] | one run: from a problem to its record |
//! | [`saved_run`] | running one job with its folder: lock, resume, run, checkpoints on the way, result files |
//! | [`studio`] | A local page that answers while a target is drawn |
//! | [`suite`] | the suite: benchmark problems whose answer is known, each run from many seeds, and compared with the population searches at equal evaluations and with published answers |

pub mod checkpoint;
#[cfg(feature = "cli")]
pub mod cli;
pub mod given;
pub mod measured;
pub mod published;
pub mod result_files;
pub mod results_folder;
pub mod run;
pub mod saved_run;
#[cfg(feature = "studio")]
pub mod studio;
pub mod suite;
