//! The solver for all classes of a target: tracks straight paths from the start set, tracks lost ones again, and
//! classifies the ends.

use super::certificate::certify;
use super::classes::{Class, key};
use super::conjugation::Reality;
use super::settle::{Fate, Fates, Options, complete, firsts, isolated, settle};
use super::start::StartSet;
use super::target::{Closure, Solution, Target};
use super::tracker::Segment;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// The census of the paths: `tracked = finite + singular + failed`, `finite = distinct + duplicates`,
/// `distinct = real + curve_only + complex`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Paths tracked, one per class of the start set.
    pub tracked: usize,
    /// Paths that ended in an isolated solution.
    pub finite: usize,
    /// Paths that ended at infinity, in a singular or double solution, or in one of a family.
    pub singular: usize,
    /// Paths that were lost on the way, and again in every further round.
    pub failed: usize,
    /// Distinct classes.
    pub distinct: usize,
    /// Paths that ended in the class of an earlier one: astray, or, on a special target, in the same linkage with
    /// another rotation at a point that its curve passes twice.
    pub duplicates: usize,
    /// Paths that were tracked more than once.
    pub again: usize,
    /// Classes with a real linkage.
    pub real: usize,
    /// Classes with a real curve and a complex linkage.
    pub curve_only: usize,
    /// Classes with neither.
    pub complex: usize,
}

/// The completeness of the list of classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Completeness {
    /// All: as many distinct classes as a target in general position has.
    Complete,
    /// Paths ended at infinity or in singular solutions, and none was lost: the target is not in general position and
    /// has fewer isolated solutions. Paths that stay together in spite of all rounds are counted as duplicates here:
    /// they end in multiple solutions.
    NonGeneric {
        /// The number of distinct isolated classes that were found; no claim that there are no more.
        isolated: usize,
    },
    /// Paths were lost or ended together: so many classes may be missing.
    Incomplete {
        /// The number of failed and duplicate paths.
        missing: usize,
    },
    /// The solve was stopped before the end.
    Cancelled,
}

/// The result of solving a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// The target.
    pub target: Target,
    /// Real linkages first, then real curves, then the rest; within each by a number that the class determines.
    pub classes: Vec<Class>,
    /// The census of the paths.
    pub census: Census,
    /// Whether the solve was stopped before the end.
    pub cancelled: bool,
}

impl Solved {
    /// Returns the number of classes that a target in general position has.
    pub fn generic_classes(&self) -> usize {
        self.target.displacements.kind.classes()
    }

    /// Returns the completeness of the list.
    pub fn completeness(&self) -> Completeness {
        let census = &self.census;
        if self.cancelled {
            Completeness::Cancelled
        } else if census.distinct == self.generic_classes() {
            Completeness::Complete
        } else if census.failed == 0 && census.singular > 0 && census.singular >= census.duplicates {
            Completeness::NonGeneric { isolated: census.distinct }
        } else {
            Completeness::Incomplete {
                missing: self.generic_classes().saturating_sub(census.distinct + census.singular),
            }
        }
    }
}

/// Solves a target from the embedded start set, on the threads of the current rayon pool.
///
/// `progress` is called with the number of paths that have ended for good and the number of all paths, from several
/// threads. When `cancel` is set the answer holds what was found by then. Otherwise the answer depends on target and
/// options alone.
pub fn solve(
    target: &Target,
    options: &Options,
    progress: &(dyn Fn(usize, usize) + Sync),
    cancel: &AtomicBool,
) -> Solved {
    let start = StartSet::embedded(target.displacements.kind);
    let along = Segment { from: start.displacements, to: target.displacements };
    let mut ends = settle(&start.solutions, &along, options, progress, cancel);
    complete(&mut ends, &start.solutions, &along, options, cancel);
    let solved = judged(target, &ends, cancel.load(Ordering::Relaxed));
    if solved.cancelled || solved.census.distinct == solved.generic_classes() {
        return solved;
    }
    ends.fates.par_iter_mut().for_each(|end| *end = proved(target, *end));
    judged(target, &ends, false)
}

/// Classifies an end of a target that is not in general position: it counts as isolated if it or one of its cognates
/// is proved to be, as an end that looks isolated to rounding may be a multiple solution.
fn proved(target: &Target, end: Fate) -> Fate {
    let Fate::Isolated(class) = end else { return end };
    let proof = |solution: &Solution| certify(target, solution).ok().map(|proof| proof.refined);
    let cognates = || class.solution.cognates(&target.displacements)[1..].iter().find_map(proof);
    match proof(&class.solution).or_else(cognates) {
        Some(solution) => Fate::Isolated(Class { solution, ..class }),
        None => Fate::Singular,
    }
}

/// Computes the distinct classes, their reality, and the census.
pub(super) fn judged(target: &Target, ends: &Fates, cancelled: bool) -> Solved {
    let finite: Vec<Class> = isolated(&ends.fates).map(|(_, class)| *class).collect();
    let solutions: Vec<Solution> = finite.iter().map(|class| class.solution).collect();
    let closure = target.displacements.kind.closure;
    let first = firsts(&solutions, closure, |s| certify(target, s));
    let mut classes: Vec<(f64, Class)> = (0..finite.len())
        .filter(|&at| first[at] == at)
        .map(|at| {
            (
                key(&solutions[at], closure),
                Class { reality: reality(&finite[at].solution, closure), ..finite[at] },
            )
        })
        .collect();
    classes.sort_by(|(one, a), (other, b)| a.reality.cmp(&b.reality).then(one.total_cmp(other)));
    let classes: Vec<Class> = classes.into_iter().map(|(_, class)| class).collect();
    let count = |reality: Reality| classes.iter().filter(|class| class.reality == reality).count();
    let fated = |fate: Fate| ends.fates.iter().filter(|f| **f == fate).count();
    let census = Census {
        tracked: ends.fates.len(),
        finite: finite.len(),
        singular: fated(Fate::Singular),
        failed: fated(Fate::Lost),
        distinct: classes.len(),
        duplicates: finite.len() - classes.len(),
        again: ends.again,
        real: count(Reality::Real),
        curve_only: count(Reality::RealCurve),
        complex: count(Reality::Complex),
    };
    Solved { target: *target, classes, census, cancelled }
}

/// The distance from a real linkage up to which a solution is real: rounding after refinement is far below it, pairs
/// of nearly equal solutions are further apart.
const REAL: f64 = 1e-8;

/// Determines the reality of a solution of a real target, to rounding; [`super::conjugation`] proves it.
fn reality(of: &Solution, closure: Closure) -> Reality {
    if of.imaginary_part() <= REAL {
        Reality::Real
    } else if of.is_in_class_of(&of.conjugate(), closure, REAL) {
        Reality::RealCurve
    } else {
        Reality::Complex
    }
}
