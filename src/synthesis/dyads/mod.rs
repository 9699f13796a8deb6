//! Dyads through poses (Burmester's problem), exactly or nearly, and four-bars of two of them.
//!
//! Pose j is a position P_j and a direction Q_j = e^{i theta_j} of the body ([`Pose`](crate::mechanism::Pose)); a dyad is
//! one constraint on the body ([`Dyad`](crate::mechanism::Dyad)), and a four-bar is two. Two dyads have ten parameters
//! and each pose asks for two equations (one a dyad), so five poses are met exactly by finitely many linkages, fewer
//! poses by families of them, and more poses only nearly.
//!
//! | poses | dyads | function |
//! |---|---|---|
//! | 3 | one for each pin, one for each pivot; one slider along each line | [`through_three_from_pin`], [`through_three_from_pivot`], [`pin_on_line_across`] |
//! | 4 | a curve of them; one slider of each kind | [`through_four_curve`], [`four_curve_strands`], [`pin_on_line`], [`line_over_pivot`] |
//! | 5 | 0, 2 or 4 | [`through_five`] |
//! | more | near ones | [`nearest_in_kernel`], [`circle_minima`], [`circle_fit`], [`through_random_five`], [`pin_on_line`], [`line_over_pivot`], [`pin_on_line_across`] |
//!
//! | module | holds |
//! |---|---|
//! | `circle` | the best circle of a pin, by Kasa's fit and Newton's iteration |
//! | `conics` | the common points of two conics, by the resultant |
//! | `curve` | four poses: the circle-point and centre-point curves, by the compatibility linkage |
//! | `driving` | poses with given crank angles: the driving dyad |
//! | `kernel` | five poses and more: linear rows, their kernel, and two conics in it |
//! | `line` | four poses and a line of the pivot; the best pin of a pivot |
//! | `map` | the map of the body plane: the error of the best circle at each place of a pin |
//! | `pair` | two dyads as a four-bar |
//! | `quartic` | the roots of a quartic, by the iteration of Aberth and Ehrlich |
//! | `scale` | the frame of the computations: poses about their middle, of size one |
//! | `slider` | the best pin on a line, and the best line over a pivot |
//! | `three` | three poses: circumcentres |
//!
//! References: L. Burmester, Lehrbuch der Kinematik, 1888; G. N. Sandor and A. G. Erdman, Advanced Mechanism Design,
//! 1984, chapter 3 (compatibility linkage); I. Kasa, IEEE Trans. Instrum. Meas. 25 (1976) 8 (circle fit); Q. J. Ge,
//! A. Purwar, P. Zhao, S. Deshpande, Journal of Computing and Information Science in Engineering 17 (2017) 021007 (the kernel of linear rows).

mod circle;
mod conics;
mod curve;
mod driving;
mod kernel;
mod line;
mod map;
mod pair;
mod quartic;
mod scale;
mod slider;
mod three;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;

pub use circle::{CircleFit, circle_fit};
pub use curve::{Strand, four_curve_strands, through_four_curve};
pub use driving::{Driving, driving_dyad};
pub use kernel::{nearest_in_kernel, through_five, through_random_five};
pub use line::{best_from_pivot, through_four_on_line};
pub use map::{CircleMap, circle_minima};
pub use pair::{Pair, pair};
pub use slider::{line_over_pivot, pin_on_line, pin_on_line_across};
pub use three::{through_three_from_pin, through_three_from_pivot};
