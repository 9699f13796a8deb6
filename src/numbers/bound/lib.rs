//! Certified global lower bounds of the sum of squares for prescribed timing, by branch and bound.
//!
//! ```text
//! minimise over A, K, Z and x = (p, phi_0, g, d):   sum_j |T_j - A - K e_j - Z u_j(x)|^2
//! ```
//!
//! A, K and Z are linear and solved inside (K a length if crank angles are from the x axis, A or both pivots known if
//! they are fixed: [`absolute`]); the linkages whose input turns fully lie in a compact box of four numbers
//! ([`chart`]); [`mod@bound`] bounds a box from below in arithmetic with enclosed rounding ([`ball`]); [`search`]
//! halves boxes until each is decided. docs/certificate.md has the proofs.

pub mod absolute;
mod affine;
pub mod ball;
pub mod bound;
pub mod chart;
mod expansion;
pub mod search;
pub mod target;

pub use ball::Ball;
pub use bound::{Bound, bound};
pub use chart::{Point, Ratios};
pub use search::{Leaf, Outcome, Question, Search};
pub use target::{Target, TargetError};
