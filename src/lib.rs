//! linkwright finds the four-bar linkage whose coupler point draws the path you ask for.
//!
//! ```text
//!                    P                given: points T_1 .. T_n (and, if you like, the crank angle at each)
//!                   / \               found: A, B, a, b, c, d, e and the signs t1, t2 with
//!                d /   \ e
//!                 /  b  \                    sum_j |T_j - P(phi_j)|^2  least
//!                C-------D
//!             a /         \ c                and every requirement met: type, transmission angle, pivots,
//!              A-----------B                 footprint, order, circuit, branch
//! ```
//!
//! # The house
//!
//! Nouns know nothing; tasks know nouns; solvers are pure mathematics and know nothing of ours; problems put
//! tasks into the solvers' terms; search decides what to try; `run` introduces them; what a person sees knows
//! only the record.
//!
//! | room | what it holds | may use |
//! |---|---|---|
//! | [`linkage`] | what a four-bar is and where it is: position, gradient, mobility, transmission, curve | |
//! | [`task`] | what is wanted: paths, timing, errors, the referee | linkage |
//! | [`solve`] | numbers only: populations, Levenberg-Marquardt, random streams | |
//! | [`problem`] | the task as mathematics: design space, residuals, requirements, fitness | linkage, task, solve |
//! | [`assess`] | every figure and verdict of a candidate, recomputed | linkage, task, problem, record |
//! | [`search`] | what to try: starts, rounds, plan, distinct answers | all above |
//! | [`mod@run`] | a job in, a record out | all above |
//! | [`record`] | the truth on disk | linkage, task, problem |

pub mod assess;
pub mod linkage;
pub mod problem;
pub mod record;
pub mod run;
pub mod search;
pub mod solve;
pub mod task;
