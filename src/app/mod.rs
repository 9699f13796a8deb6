//! Entry points: a job in, a record out; folders of results; the suite; the command line; the studio.
//!
//! | module | holds |
//! |---|---|
//! | [`balancing`] | balances as they are asked for: a spring or counter-masses, with the text and the file of the result |
//! | [`building`] | sizes for building: shop data, sizes that go before them, and the usual ones |
//! | [`certificates`] | certificates and the files beside their record: checkpoints and leaves |
//! | [`cli`] | the command line: arguments, commands, exit codes |
//! | [`comparison`] | measuring the inputs of a comparison: every figure is computed again, and none is taken from a record unchecked |
//! | [`inputs`] | inputs of the export, comparison and report commands: a result of a run, one linkage of it, or a linkage without a run |
//! | [`job`] | jobs: one run from a problem to its record, the result's folder and files, checkpoints |
//! | [`snapping`] | the subject of a snap, the lengths in stock, and the dimensions that stay as they are |
//! | [`studio`] | a local page that answers while a target is drawn |
//! | [`suite`] | the suite: benchmark problems whose answer is known, each run from many seeds, and compared with the population searches at equal evaluations and with published answers |
//! | [`sweep`] | sweeps: a plan of many problems, its shards of jobs, and their merged rows |

pub mod balancing;
pub mod building;
pub mod certificates;
#[cfg(feature = "cli")]
pub mod cli;
pub mod comparison;
pub mod inputs;
pub mod job;
pub mod snapping;
#[cfg(feature = "studio")]
pub mod studio;
pub mod suite;
pub mod sweep;
