//! Lengths brought to stock sizes, and what is still free fitted again.
//!
//! Rounding every length to the nearest stock size at once throws away what the other lengths could make good. Here
//! the lengths are fixed one after another, the one that the path feels most first; after each, everything that is
//! still free (pivots, ground angle, the lengths to come, the positions on the path) is fitted again by the
//! project's own least squares under all requirements, and the next length is taken near where the fit has put it.
//! Several partial choices are kept side by side (a beam), and the best complete ones are improved by trying the
//! neighbouring stock sizes of one length and of two at a time until none helps. Nothing is drawn at random.
//!
//! What comes of it is judged by the referee under the problem as it was: its limits and requirements stand.

mod record;
mod refit;
mod search;
mod stock;

pub use record::{own_curve, record};
pub use refit::{Fixed, Length, refit};
pub use search::{Request, SnapError, Snapped, snap};
pub use stock::{Stock, StockError};
