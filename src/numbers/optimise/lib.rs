//! Numerical solvers: population searches, bound-constrained least squares with one block for each target point,
//! sequential convex programming, non-negative least squares.
//!
//! Of this repository it uses `linkwright-arithmetic` alone. It owns the traits that problems implement:
//! [`population::PopulationProblem`], [`levenberg_marquardt::BlockLeastSquares`] and
//! [`compact_lm::CompactLeastSquares`].
//!
//! | module | holds |
//! |---|---|
//! | [`argmin_bridge`] | runs a population algorithm under argmin's executor: the one file that names argmin |
//! | [`compact_lm`] | bounded Levenberg-Marquardt for a handful of unknowns: fixed-size arrays, no allocation |
//! | [`conic`] | second-order cone programs with a convex quadratic objective, in a few dozen variables; the only file that names the library that solves them |
//! | [`convex`] | sequential convex programming for points that share a few unknowns: least squares or minimax deviation under inequalities |
//! | [`damping`] | the damping of Levenberg-Marquardt steps, and steps that end inside bounds |
//! | [`differential_evolution`] | SHADE: differential evolution that adapts its parameters F and CR from the history of successful steps |
//! | [`exact_float`] | serialisation of floating-point numbers in JSON, exact to the last bit and including infinities and NaN |
//! | [`genetic`] | a real-coded genetic algorithm: tournament selection, simulated binary crossover, polynomial mutation, elitism |
//! | [`levenberg_marquardt`] | bounded Levenberg-Marquardt for points that share a few unknowns and may each have one of their own |
//! | [`nonnegative`] | non-negative least squares of a few columns: the least length of sum_i m_i g_i - q with every m_i >= 0 |
//! | [`ordered`] | isotonic regression on a closed chain: points on a curve that may meet but not pass each other |
//! | [`population`] | the parts of a population search: a problem, individuals, their order, and generations of them |
//! | [`random_search`] | uniform random sampling of the box: the baseline that every other search has to beat |
//! | [`saved`] | the states of all population searches as one type, for checkpoints |

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
#[cfg(test)]
mod test_poses;
