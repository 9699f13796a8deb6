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
//!
//! | module | holds |
//! |---|---|
//! | [`absolute`] | the lower bound of a box if crank angles are from the x axis: K = kappa is a real length |
//! | [`affine`] | affine enclosures of functions over a box: a linear function and a bound of the remainder (the rest) |
//! | [`ball`] | ball arithmetic: numbers with a bound of their error, on which every discarded box relies |
//! | [`mod@bound`] | the lower bound of a box: a number L such that no point of the box has a sum of squares below it |
//! | [`chart`] | the chart: coordinates of every four-bar whose input turns fully, in a compact box of four numbers |
//! | [`expansion`] | the expansion of the coupler's directions over a box: first derivatives at its centre, and a bound of the remainder |
//! | [`halving`] | boxes of the chart: their middle and half widths, and their halves |
//! | [`search`] | best-first branch and bound over the chart |
//! | [`target`] | the target, prepared for bounds: T', its length, and the directions that the linear unknowns take away |

pub mod absolute;
mod affine;
pub mod ball;
pub mod bound;
mod chart;
mod expansion;
mod halving;
pub mod search;
pub mod target;

pub use ball::Ball;
pub use bound::{Bound, bound};
pub use search::{Leaf, Outcome, Question, Search};
pub use target::{Target, TargetError};
