//! The task as mathematics: design space, residuals with derivatives, requirements, fitness.
//!
//! | module | holds |
//! |---|---|
//! | [`body_fitness`] | fitness of a population search where angles of a link are wanted: of a body in a motion, of the follower in a function |
//! | [`design_space`] | the design vector and its coordinates; only this file knows the meaning of each component |
//! | [`fitness`] | fitness of a population search in the physical parameters: the design's free numbers in, violation and cost out |
//! | [`fits`] | the least-squares fit that suits a start: of a path, of a motion or of a function, with prescribed or with free timing |
//! | [`genes`] | the free numbers of a design in which the population searches move, and what is the same of every fitness of them |
//! | [`linear_fit`] | the linear part of a path fit, for starts: given the shape ratios and the positions, the pivots, the size and the coupler point follow from linear least squares |
//! | [`precision`] | exact problems: paths of nine precision points with free timing |
//! | [`projection`] | variable projection for prescribed timing (the reduced form): the linear parameters are solved for inside |
//! | [`reduced`] | admissibility of a problem for the search in reduced variables |
//! | [`rows`] | requirements on a linkage, as smooth constraint functions g(shape, motion) >= 0 in units of length |
//! | [`slider`] | linkages with a slider as least-squares problems: a path or a motion with prescribed or free timing, or a function |
//! | [`start`] | the start of a local search: a design vector with its discrete choices and the points' positions |
//! | [`timed`] | prescribed timing as a least-squares problem in the design vector |
//! | [`torus`] | free timing as a least-squares problem: the design vector and, for each point, a position of the linkage of its own |

pub mod body_fitness;
pub mod design_space;
pub mod fitness;
pub mod fits;
pub mod genes;
pub mod linear_fit;
pub mod precision;
pub mod projection;
pub mod reduced;
pub mod rows;
pub mod slider;
pub mod start;
pub mod timed;
pub mod torus;
