//! Exact synthesis through nine points: solutions and what is proved of them.

mod certificate;
mod known;
#[path = "../common/random.rs"]
mod random;
