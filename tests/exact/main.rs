//! Exact synthesis through nine points, through poses and points, and through eight points of linkages with a slider: all solutions,
//! and what is proved of them.

mod certificate;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/nine-point-start-set/conic.rs"]
mod conic;
mod equations;
mod known;
mod listing;
mod mechanisms;
mod mixed;
#[path = "../../examples/nine-point-start-set/monodromy.rs"]
mod monodromy;
#[path = "../common/poses.rs"]
mod poses;
mod problems;
#[path = "../common/random.rs"]
mod random;
mod slider_problems;
mod sliders;
mod solutions;
mod start_set;
#[path = "../../examples/nine-point-start-set/trace.rs"]
mod trace;
mod traces;
mod verdicts;
