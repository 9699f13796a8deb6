//! Records and their check: what is untouched is true, what is changed is found out as far as docs/results.md says.

mod agreement;
#[path = "../common/mod.rs"]
mod common;
mod front;
mod leaves;
#[path = "../synthesis/properties/problems.rs"]
mod problems;
#[path = "../common/random.rs"]
mod random;
