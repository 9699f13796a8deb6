//! Linkages with a slider as least-squares problems: a path or a motion with prescribed or free timing, or a function.
//!
//! Every single loop that a crank drives is C = A + a e, P = C + Z u with one closure G(e, u) = 0 that gives u; the fit of a
//! four-bar carries over with another closure ([`shape`]).
//!
//! | module | holds |
//! |---|---|
//! | `curve` | positions brought to their curves, in lanes |
//! | [`ends`] | the stroke and the time ratio of a slider-crank |
//! | [`fit`] | the fit to the points of a path, or to the places and angles of a motion |
//! | [`limits`] | bounds of the unknowns, and inequalities of the requirements |
//! | [`output`] | the errors of a function's output |
//! | [`ranged`] | the fit to a function with free ranges |
//! | `regions` | the regions of pivots and pins |
//! | [`shape`] | the closure with its derivatives by the position and by the unknowns |
//! | `sides` | limits of the coupler's sides and of the ground |
//! | `swept` | the box of all joints over the motion |

mod curve;
pub mod ends;
pub mod fit;
pub mod limits;
pub mod output;
pub mod ranged;
mod regions;
pub mod shape;
mod sides;
mod swept;

#[cfg(test)]
mod tests;
