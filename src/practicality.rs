//! What stands between a linkage and a workshop: which plates need layers of their own, what comes near what, and
//! how much a wrong dimension moves the path.
//!
//! Pure functions of a linkage and its motion, and of the target where there is one.
//!
//! | question | answer |
//! |---|---|
//! | which plates can share a plane, in which order do they stack? | [`layers::layering`] |
//! | how near do pivots and pins come to each other? | [`clearance::pivot_distances`] |
//! | how much does each dimension's error move the path? | [`sensitivity::sensitivity`] |
//! | all of it at once, for a candidate or a linkage by itself | [`Practicality`] |
//!
//! Distances over a motion are least values with a proof ([`closest`]), not the least of samples.

pub mod clearance;
pub mod closest;
pub mod layers;
pub mod sensitivity;
pub mod sweep;

mod subject;
mod usual;

pub use clearance::{Build, Pin};
pub use closest::Closest;
pub use subject::{Practicality, crank_of};
pub use sweep::Sweep;
pub use usual::{millimetre, usual_tolerance};
