//! Errors in the parts of a chain, each with its part, key and point.

use super::builder::MAX_STAGES;
use crate::mechanism::MAX_MAGNITUDE;

/// The part of a chain that an error is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ChainPlace {
    /// A fixed pivot.
    Pivot(String),
    /// The crank.
    Crank,
    /// A stage, counted from 0.
    Stage(usize),
    /// The chain as a whole.
    Chain,
}

/// An error in the parts of a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainError {
    /// The part with the error.
    pub place: ChainPlace,
    /// The point that the part makes; empty for the chain as a whole.
    pub joint: String,
    /// The key in that part, as in files.
    pub key: &'static str,
    /// Index of the key's value, counted from 0, if the key has several.
    pub index: Option<usize>,
    /// The kind of fault.
    pub fault: ChainFault,
}

/// The kind of fault in a part or value of a chain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainFault {
    /// A point that no stage and no pivot makes.
    #[error("there is no point \"{name}\"")]
    UnknownPoint {
        /// Name of the point.
        name: String,
        /// Names of all points of the chain.
        known: Vec<String>,
    },
    /// A point that is made by a later stage, or by this one.
    #[error("\"{name}\" is not known yet: it is made {}", if *.itself { "here" } else { "further down" })]
    ForwardReference {
        /// Name of the point.
        name: String,
        /// Whether this very stage makes it.
        itself: bool,
    },
    /// A name of two points.
    #[error("there are two points \"{0}\"")]
    DuplicateName(String),
    /// A name that is not 1 to [`MAX_POINT_NAME`](super::MAX_POINT_NAME) letters, digits, `_` and `-`.
    #[error("\"{0}\" is no name of a point")]
    BadName(String),
    /// A crank pivot that moves, or is no point.
    #[error("\"{name}\" is not a fixed pivot")]
    NotAPivot {
        /// Name of the point.
        name: String,
        /// Names of all pivots.
        known: Vec<String>,
    },
    /// A number that is NaN, infinite or beyond [`MAX_MAGNITUDE`].
    #[error("{0} is not a finite number below {max:e} in magnitude", max = MAX_MAGNITUDE)]
    NotFinite(f64),
    /// A link of zero or negative length.
    #[error("{0}: a link's length must be positive")]
    LengthNotPositive(f64),
    /// A negative distance.
    #[error("{0}: a distance cannot be negative")]
    DistanceNegative(f64),
    /// A stage that names one point twice.
    #[error("\"{0}\" stands twice: a stage hangs on two different points")]
    SamePoint(String),
    /// Two points of no common link.
    #[error("\"{0}\" and \"{1}\" are not on one link: their distance changes")]
    NotOnOneLink(String, String),
    /// Two points of a link at the same place.
    #[error("\"{0}\" and \"{1}\" coincide: they give no direction on their link")]
    Coincident(String, String),
    /// A guide whose point lies on its pivot.
    #[error("the joint lies on the guide's pivot: a link needs a length")]
    NoLength,
    /// Sides of no triangle.
    #[error(
        "impossible triangle: \"{first}\" and \"{second}\" are {base} apart, the distances are {d} and {e}"
    )]
    NoTriangle {
        /// Name of the first point.
        first: String,
        /// Name of the second point.
        second: String,
        /// Their distance on the link.
        base: f64,
        /// Distance from the first point.
        d: f64,
        /// Distance from the second point.
        e: f64,
    },
    /// More stages than [`MAX_STAGES`].
    #[error("{0} stages; at most {MAX_STAGES} are read")]
    TooManyStages(usize),
}

impl std::fmt::Display for ChainError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.place {
            ChainPlace::Pivot(_) => write!(f, "pivot \"{}\": ", self.joint)?,
            ChainPlace::Crank => write!(f, "crank, {}: ", self.key)?,
            ChainPlace::Stage(i) => write!(f, "stage {}, \"{}\", {}: ", i + 1, self.joint, self.key)?,
            ChainPlace::Chain => write!(f, "{}: ", self.key)?,
        }
        self.fault.fmt(f)
    }
}

impl std::error::Error for ChainError {}
