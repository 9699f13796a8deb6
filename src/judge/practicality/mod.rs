//! Practicality of building a linkage: layers of its plates, clearances between its parts, and sensitivity of the path
//! to errors of its dimensions.
//!
//! Pure functions of a linkage and its motion, and of the target if there is one.
//!
//! | result | function or type |
//! |---|---|
//! | plates that share a plane, and the order in which plates stack | [`layers::layering`] |
//! | least distances between pivots and pins | [`clearance::pivot_distances`] |
//! | shift of the path for an error of each dimension | [`sensitivity::sensitivity`] |
//! | rims that are thinner than holes need | [`rims::needed_rims`] |
//! | lengths of pins and spacers | [`pins::pin_lengths`] |
//! | all of these, for a candidate or a linkage by itself | [`Practicality`] |
//!
//! Distances over a motion are proved least values ([`closest`]), not the least of samples.

pub mod clearance;
pub mod closest;
mod dimensions;
pub mod layers;
pub mod pins;
pub mod rims;
pub mod sensitivity;
pub mod sweep;

mod subject;
mod usual;

pub use clearance::{Build, Joint};
pub use closest::Closest;
pub use subject::{Practicality, sensitivity_of};
pub use sweep::Sweep;
pub use usual::usual_tolerance;
