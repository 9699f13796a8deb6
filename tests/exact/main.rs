//! Exact synthesis through nine points: all solutions, and what is proved of them.

mod certificate;
#[path = "../common/mod.rs"]
mod common;
mod equations;
mod known;
mod listing;
mod mechanisms;
#[path = "../../examples/nine-point-start-set/monodromy.rs"]
mod monodromy;
mod problems;
#[path = "../common/random.rs"]
mod random;
mod solutions;
mod start_set;
mod verdicts;
