//! All classes of a target: from the start set along straight paths, lost ones again and again, the ends judged.

use super::classes::first_of_class;
use super::start::{CLASSES, StartSet};
use super::target::{Displacements, Solution, Target};
use super::tracker::{Ending, Parameters, Segment, correct, track};
use std::sync::atomic::{AtomicBool, Ordering};

/// What a caller may choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Of the first round of tracking.
    pub parameters: Parameters,
    /// Further rounds, each with tighter tolerances and from another image of the start, for paths that were lost and
    /// for those that ended together.
    pub retries: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options { parameters: Parameters::default(), retries: 4 }
    }
}

/// What is real about a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reality {
    /// A real linkage (and so are its cognates).
    Linkage,
    /// The conjugate is another image of the class: the coupler curve is real, the linkage is complex. No mechanism.
    CurveOnly,
    /// The conjugate is another class.
    Complex,
}

/// One class of six solutions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Class {
    /// One of the six.
    pub solution: Solution,
    /// What is real about it.
    pub reality: Reality,
    /// Relative size of the last Newton step: what rounding leaves unsure.
    pub newton_step: f64,
    /// Relative speed of the solution as the target comes in along the path: large near a singularity.
    pub speed: f64,
}

/// What became of the paths. `tracked = finite + singular + failed`, `finite = distinct + duplicates`,
/// `distinct = real + curve_only + complex`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Paths, one a class of the start set.
    pub tracked: usize,
    /// Ended in an isolated solution.
    pub finite: usize,
    /// Ended at infinity or in a singular solution, or in one of a family.
    pub singular: usize,
    /// Were lost on the way, and again in every further round.
    pub failed: usize,
    /// Classes.
    pub distinct: usize,
    /// Paths that ended in the class of an earlier one.
    pub duplicates: usize,
    /// Paths that were tracked more than once.
    pub again: usize,
    /// Classes with a real linkage.
    pub real: usize,
    /// Classes with a real curve and a complex linkage.
    pub curve_only: usize,
    /// The others.
    pub complex: usize,
}
