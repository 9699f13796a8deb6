//! Snapping: lengths are brought to stock sizes, and the free parameters fitted again.
//!
//! Rounding every length to the nearest stock size at once ignores that the other lengths could compensate. Here the
//! lengths are fixed one after another, the one to which the path is most sensitive first; after each, all parameters
//! that are still free (pivots, ground angle, the lengths to come, the positions on the path) are fitted again by the
//! project's own least squares under all requirements, and the next length is taken near its fitted value. Several
//! partial choices are kept in parallel (beam search), and the best complete ones are improved by trying the
//! neighbouring stock sizes of one length and of two at a time until none helps (local search). Nothing is drawn at
//! random.
//!
//! The results are judged by the referee under the original problem: its limits and requirements still apply.

mod length;
mod record;
mod refit;
mod search;
mod stock;

pub use length::{JointName, Length};
pub use record::{own_curve, record};
pub use refit::{Fixed, refit};
pub use search::{Request, SnapError, Snapped, snap};
pub use stock::{Stock, StockError};
