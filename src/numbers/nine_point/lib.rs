//! Every four-bar linkage whose coupler point passes exactly through nine given points (Alt's problem), and every linkage
//! with a slider that does through eight.
//!
//! Points P_0 .. P_8 as complex numbers, delta_j = P_j - P_0. In the frame of P_0 the linkage has, at its first
//! point, the moving pins x and y and their ground pivots a and b; the coupler has turned by T_j = e^{i theta_j} when
//! P is at P_j. Each of the two links keeps its length:
//!
//! ```text
//! (x T_j + delta_j - a)(x* / T_j + delta*_j - a*) = (x - a)(x* - a*),      j = 1 .. 8,   the same for (y, b)
//! ```
//!
//! 16 equations in the 16 unknowns x, y, a, b, their starred twins and T_1 .. T_8. Over the complex numbers the twins
//! are unknowns of their own; in a real linkage they are the conjugates and |T_j| = 1. Generic points have 8652
//! solutions: 1442 classes of six, three Roberts cognates times two labels of the links.
//!
//! The same equations serve targets of p poses beyond the first and q given ground pivots, with 8 - 2 p - 2 q points
//! ([`target::Kind`]): the T_j of a pose and a given pivot are no unknowns, and have equations of their own in their place.
//!
//! With a slider in place of the second link eight points determine the linkage: the pin y of a slider-crank runs on a fixed
//! line, the pivot b of an inverted slider-crank on a line of the coupler ([`target::Closure`]). Seven equations of the second link
//! are others then, and of the two that the eighth place had one scales the normal of the line and one is idle. Generic
//! points have 558 slider-cranks, 279 pairs of cognates, and 2220 inverted ones, which have no cognates.
//!
//! [`refinement`] brings a solution to the last digit, [`certificate`] proves that it exists and is the only one
//! near, [`conjugation`] that it is real, [`distinct`] that two are of different classes. They are built on
//! double-double numbers and [`discs`].
//!
//! Source: C. W. Wampler, A. P. Morgan, A. J. Sommese, "Complete solution of the nine-point path synthesis problem for
//! four-bar linkages", ASME J. Mech. Des. 114 (1992) 153-159.
//!
//! | module | holds |
//! |---|---|
//! | [`careful`] | homotopy path tracking of one path in double-double, for a solution nearer to infinity than doubles can follow |
//! | [`certificate`] | the proof that a solution of the sixteen equations exists and is the only one near |
//! | [`classes`] | the six images of a solution, and the grouping of solutions into classes of images |
//! | [`conjugation`] | the proof that a certified solution is real, or draws a real curve, or does neither |
//! | [`correction`] | Newton's method at fixed displacements, eight solutions at once |
//! | [`discs`] | discs of complex numbers and upper bounds, both with outward rounding |
//! | [`distinct`] | the proof that certified solutions belong to different classes |
//! | [`double_discs`] | discs with double-double midpoints: enclosures that stay narrow where differences cancel |
//! | [`equations`] | the sixteen equations, their derivatives, and the 8x8 system that is left when the rotations are eliminated |
//! | [`live`] | homotopy path tracking from target to target: the solutions of a target that has moved a little, from those of the target before |
//! | [`polynomial`] | the sixteen equations as polynomials, over any numbers that can be added and multiplied |
//! | [`refinement`] | Newton's method with residuals in double-double: a solution to more digits than a double holds |
//! | [`settle`] | homotopy path tracking of all classes: all paths are tracked together, lost ones again in further rounds, and each end is classified |
//! | [`mod@solve`] | the solver for all classes of a target: tracks straight paths from the start set, tracks lost ones again, and classifies the ends |
//! | [`start`] | the start sets: one solution of each class at a fixed complex target in general position, of each kind of target |
//! | [`target`] | the problem, precision points, poses and given pivots, and its answer, a solution of the sixteen equations |
//! | [`tracker`] | homotopy path tracking of solutions while the displacements move along a straight line: predictor, corrector, step control |

mod careful;
pub mod certificate;
pub mod classes;
pub mod conjugation;
pub mod correction;
pub mod discs;
pub mod distinct;
mod double_discs;
pub mod equations;
pub mod live;
mod polynomial;
pub mod refinement;
mod settle;
pub mod solve;
pub mod start;
pub mod target;
pub mod tracker;

pub use certificate::{Certificate, Refused, certify, certify_all};
pub use classes::Class;
pub use conjugation::Reality;
pub use distinct::not_proved_distinct;
pub use live::{Moved, resolve_from};
pub use refinement::{Refined, refine};
pub use settle::Options;
pub use solve::{Census, Completeness, Solved, solve};
pub use target::{Closure, Displacements, Solution, Target, TargetError};
