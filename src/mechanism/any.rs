//! A linkage of any kind.

use super::{Chain, FourBar};

/// The linkage in a linkage file, of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Linkage {
    /// A four-bar.
    FourBar(FourBar),
    /// A chain.
    Chain(Box<Chain>),
}
