//! Jobs: from a problem to its record, and the record in its folder.
//!
//! | module | holds |
//! |---|---|
//! | [`run`](mod@run) | one run: from a problem to its record |
//! | [`checkpoint`] | checkpoints of unfinished searches on disk, from which `synth --resume` continues |
//! | [`files`] | the files of a result's folder, as bytes: pure functions of the record, apart from its times |
//! | [`folder`] | a result's folder: locked while it is written to, replaced as a whole, and never mixed with files of other origin |
//! | [`save`] | running one job with its folder: lock, resume, run, checkpoints on the way, result files |
//! | [`workers`] | threads of a batch: jobs side by side, each on one thread, if there are enough of them |

pub mod checkpoint;
pub mod files;
pub mod folder;
pub mod run;
pub mod save;
pub mod workers;
