//! Search for dyad chains (six-bars, eight-bars) that draw a path, with free or with prescribed timing.
//!
//! Every number that is tried is a chain whose crank turns fully, on one circuit and one branch; phases are in order by
//! construction; transmission angles, lengths and excursions between points are held by hinges inside the fit.
//!
//! | module | holds |
//! |---|---|
//! | `answers` | distinct ends of fits, the best first, and their figures |
//! | `atlas` | starts: the random chains whose curves resemble the target most |
//! | `checkpoint` | the state of a search between two islands |
//! | `constants` | the tuning constants |
//! | `curve` | curves of random chains, and how well they correlate with a target |
//! | `draw` | random chains |
//! | `fit` | Levenberg and Marquardt's method, with the phases eliminated |
//! | `held` | dimensions that a fit holds at given values |
//! | `limits` | the limits of a fit and the weights of their hinges |
//! | `normal_equations` | products of columns, and their solution |
//! | `order` | the projection of phases onto sequences in order |
//! | `reach` | how far the joints reach over the motion, for limits on footprint and extent |
//! | `refit` | fits of a known chain under other limits, or with dimensions at given values |
//! | `rematch` | the assignment of points to phases by dynamic programming |
//! | `request` | what is asked for, and the caller's side of a search that is running |
//! | `rows` | rows of all residuals |
//! | `search` | islands of starts and hops |
//! | `stages` | stages of fits, from a start to an end, and hops |
//! | `target` | the target in four variants, normalised |
//! | `timed` | starts with prescribed timing |
//! | `trial` | the value of a chain at one set of unknowns |

mod answers;
mod atlas;
mod checkpoint;
mod constants;
mod curve;
mod draw;
mod fit;
mod held;
mod limits;
mod normal_equations;
mod order;
mod reach;
mod refit;
mod rematch;
mod request;
mod rows;
mod search;
mod stages;
mod target;
mod timed;
mod trial;

pub use answers::{DyadChainAnswer, DyadChainOutcome};
pub use checkpoint::DyadChainState;
pub use held::Held;
pub use refit::refit;
pub use request::{DyadChainLimits, DyadChainProgress, DyadChainTiming, Request, Watch, run};
pub use search::search;
