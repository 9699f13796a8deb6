//! What can be wrong with the parts of a chain, told by part, key and point.

use super::builder::MAX_STAGES;

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

/// What makes parts no chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainError {
    /// The part.
    pub place: ChainPlace,
    /// The point that the part makes; empty for the chain as a whole.
    pub joint: String,
    /// The key in that part, as in files.
    pub key: &'static str,
    /// Which of the key's values, counted from 0, where it has several.
    pub index: Option<usize>,
    /// What is wrong with it.
    pub fault: ChainFault,
}

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainFault {
    /// No stage and no pivot makes this point.
    #[error("there is no point \"{name}\"")]
    UnknownPoint {
        /// The point.
        name: String,
        /// Every point of the chain.
        known: Vec<String>,
    },
    /// The point is made further down, or here.
    #[error("\"{name}\" is not known yet: it is made {}", if *.itself { "here" } else { "further down" })]
    ForwardReference {
        /// The point.
        name: String,
        /// Whether this very stage makes it.
        itself: bool,
    },
    /// Two parts make a point of the same name.
    #[error("there are two points \"{name}\"")]
    DuplicateName {
        /// The point.
        name: String,
    },
    /// Not 1 to [`MAX_POINT_NAME`](super::MAX_POINT_NAME) letters, digits, `_` and `-`.
    #[error("\"{name}\" is no name of a point")]
    BadName {
        /// The text.
        name: String,
    },
    /// The crank's pivot moves, or is no point.
    #[error("\"{name}\" is not a fixed pivot")]
    NotAPivot {
        /// The point.
        name: String,
        /// Every pivot.
        known: Vec<String>,
    },
    /// A number that is NaN, infinite or beyond 1e12.
    #[error("{value} is not a finite number below 1e12 in magnitude")]
    NotFinite {
        /// The number.
        value: f64,
    },
    /// A link of zero or negative length.
    #[error("{value}: a link's length must be positive")]
    LengthNotPositive {
        /// The length.
        value: f64,
    },
    /// A negative distance.
    #[error("{value}: a distance cannot be negative")]
    DistanceNegative {
        /// The distance.
        value: f64,
    },
    /// A stage that names one point twice.
    #[error("\"{name}\" stands twice: a stage hangs on two different points")]
    SamePoint {
        /// The point.
        name: String,
    },
    /// Two points of no common link.
    #[error("\"{first}\" and \"{second}\" are not on one link: their distance changes")]
    NotOnOneLink {
        /// A point.
        first: String,
        /// Another.
        second: String,
    },
    /// Two points of a link at the same place.
    #[error("\"{first}\" and \"{second}\" coincide: they give no direction on their link")]
    Coincident {
        /// A point.
        first: String,
        /// Another.
        second: String,
    },
    /// The point of a guide lies on its pivot.
    #[error("the joint lies on the guide's pivot: a link needs a length")]
    NoLength,
    /// No triangle has these sides.
    #[error(
        "impossible triangle: \"{first}\" and \"{second}\" are {base} apart, the distances are {d} and {e}"
    )]
    NoTriangle {
        /// A point.
        first: String,
        /// Another.
        second: String,
        /// Their distance on the link.
        base: f64,
        /// From the first.
        d: f64,
        /// From the second.
        e: f64,
    },
    /// More than [`MAX_STAGES`].
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
