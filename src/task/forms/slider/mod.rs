//! Linkages with a slider as least-squares problems: a path or a motion with prescribed or free timing.
//!
//! Every single loop that a crank drives is C = A + a e, P = C + Z u with one closure G(e, u) = 0 that gives u; the fit of a
//! four-bar carries over with another closure ([`shape`]).
//!
//! | module | holds |
//! |---|---|
//! | [`fit`] | the fit to the points of a path, or to the places and angles of a motion |
//! | [`limits`] | bounds of the unknowns, and inequalities of the requirements |
//! | `regions` | the regions of pivots and pins |
//! | [`shape`] | the closure with its derivatives by the position and by the unknowns |

pub mod fit;
pub mod limits;
mod regions;
pub mod shape;

#[cfg(test)]
mod tests;
