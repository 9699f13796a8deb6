//! Exact synthesis through nine points: solutions and what is proved of them.

mod certificate;
#[path = "../common/mod.rs"]
mod common;
mod known;
mod listing;
mod mechanisms;
mod problems;
#[path = "../common/random.rs"]
mod random;
mod verdicts;
