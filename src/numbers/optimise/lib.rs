//! Numerical solvers: population searches, bounded least squares with one block per point, sequential convex
//! programming, non-negative least squares, random streams.
//!
//! This module imports nothing else of the crate. It owns the traits that problems implement:
//! [`population::PopulationProblem`], [`levenberg_marquardt::BlockLeastSquares`] and
//! [`compact_lm::CompactLeastSquares`].

pub mod argmin_bridge;
pub mod compact_lm;
pub mod conic;
pub mod convex;
mod damping;
pub mod differential_evolution;
pub mod exact_float;
pub mod genetic;
pub mod levenberg_marquardt;
pub mod nonnegative;
pub mod ordered;
pub mod population;
pub mod random_search;
pub mod saved;

#[cfg(test)]
mod population_tests;
#[cfg(test)]
mod test_functions;
