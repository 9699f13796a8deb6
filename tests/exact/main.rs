//! Exact synthesis through nine points: solutions and what is proved of them.

mod certificate;
mod known;
mod listing;
mod mechanisms;
#[path = "../common/random.rs"]
mod random;
mod verdicts;
