//! All classes of a target: from the start set along straight paths, lost ones again and again, the ends judged.

use super::classes::{class_distance, first_of_class, key};
use super::refinement::refine;
use super::start::{CLASSES, StartSet};
use super::target::{Displacements, Solution, Target};
use super::tracker::{Corrected, Ending, Parameters, Segment, Tracked, correct, track};
use crate::linkage::Complex;
use rayon::prelude::*;
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
        Options { parameters: Parameters::default(), retries: 7 }
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
    /// Ended at infinity, in a singular or double solution, or in one of a family.
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

/// What may be said of the list of classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Completeness {
    /// As many distinct classes as a target in general position has.
    Complete,
    /// Paths ended at infinity or in singular solutions, and none was lost: the target is not in general position and
    /// has fewer isolated solutions. Paths that stay together in spite of all rounds are counted as duplicates here:
    /// they end in multiple solutions.
    NonGeneric {
        /// Distinct isolated classes that were found; no claim that there are no more.
        isolated: usize,
    },
    /// Paths were lost or ended together: so many classes may be missing.
    Incomplete {
        /// Failed and duplicate paths.
        missing: usize,
    },
    /// Stopped before the end.
    Cancelled,
}

/// All that was found of a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// The target.
    pub target: Target,
    /// Real linkages first, then real curves, then the rest; within each by a number that the class determines.
    pub classes: Vec<Class>,
    /// What became of the paths.
    pub census: Census,
    /// Stopped before the end.
    pub cancelled: bool,
}

impl Solved {
    /// What may be said of the list.
    pub fn completeness(&self) -> Completeness {
        let census = &self.census;
        if self.cancelled {
            Completeness::Cancelled
        } else if census.distinct == CLASSES {
            Completeness::Complete
        } else if census.failed == 0 && census.singular > 0 && census.singular >= census.duplicates {
            Completeness::NonGeneric { isolated: census.distinct }
        } else {
            Completeness::Incomplete { missing: CLASSES.saturating_sub(census.distinct + census.singular) }
        }
    }
}

/// Solves a target from the embedded start set, on the threads of the current rayon pool.
///
/// `progress` hears how many paths have ended for good, of how many; it is called from several threads. When `cancel`
/// is set the answer holds what was found by then. Otherwise the answer depends on target and options alone.
pub fn solve(
    target: &Target,
    options: &Options,
    progress: &(dyn Fn(usize, usize) + Sync),
    cancel: &AtomicBool,
) -> Solved {
    let start = StartSet::embedded();
    let along = Segment { from: start.displacements, to: target.displacements };
    let mut ends = settle(&start.solutions, &along, options, progress, cancel);
    complete(&mut ends, &start.solutions, &along, options, cancel);
    judged(target, &ends, cancel.load(Ordering::Relaxed))
}

/// What a path came to.
#[expect(clippy::large_enum_variant, reason = "nearly every path ends in an isolated solution")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fate {
    /// An isolated solution.
    Isolated(Class),
    /// Infinity, a singular solution or a family of them.
    Singular,
    /// Lost on the way.
    Lost,
}

/// The fates of all paths after all rounds, with the number of paths that took more than one.
pub(super) struct Fates {
    pub(super) fates: Vec<Fate>,
    pub(super) again: usize,
}

/// Solutions whose Newton step is larger are refined in double-double before they are compared.
const ROUGH: f64 = 1e-11;
/// An isolated solution's last Newton step is at most this.
const CONVERGED: f64 = 1e-9;
/// Speeds, relative to the solution and over the whole path, above which an end counts as singular.
const SINGULAR_SPEED: f64 = 1e9;
/// Paths that stop in the last part of their way have met the end's singularity, not one of the way.
const NEAR_THE_END: f64 = 1e-3;
/// Classes nearer than this are one.
pub(super) const SAME: f64 = 1e-8;
/// Solutions nearer to a real linkage than this are real: rounding after refinement is far below it, pairs of nearly
/// equal solutions are further apart.
const REAL: f64 = 1e-8;

/// The fate of one end.
fn fate(end: &Tracked, corrected: &Corrected, along: &Segment) -> Fate {
    match end.ending {
        Ending::Cancelled => return Fate::Lost,
        Ending::Stalled { t } | Ending::OutOfSteps { t } => {
            return if 1.0 - t < NEAR_THE_END { Fate::Singular } else { Fate::Lost };
        }
        Ending::Arrived => {}
    }
    let (mut solution, mut newton_step) = (corrected.solution, corrected.newton_step);
    if newton_step.is_nan() || newton_step > ROUGH {
        match refine(&along.to, &end.solution) {
            Ok(refined) => (solution, newton_step) = (refined.solution, refined.last_step),
            Err(_) => return Fate::Singular,
        }
    }
    if newton_step.is_nan()
        || newton_step > CONVERGED
        || corrected.speed.is_nan()
        || corrected.speed > SINGULAR_SPEED
    {
        return Fate::Singular;
    }
    Fate::Isolated(Class { solution, reality: Reality::Complex, newton_step, speed: corrected.speed })
}

/// Tracks `starts` along the segment; lost and coinciding paths again, more carefully, from other images, and lost ones
/// in the end around what was in their way.
pub(super) fn settle(
    starts: &[Solution],
    along: &Segment,
    options: &Options,
    progress: &(dyn Fn(usize, usize) + Sync),
    cancel: &AtomicBool,
) -> Fates {
    let mut fates = vec![Fate::Lost; starts.len()];
    let mut open: Vec<usize> = (0..starts.len()).collect();
    let mut obstructed = vec![false; starts.len()];
    // Paths whose solution was rough though of moderate size: where two of them stay together it is a double one.
    let mut rough = vec![false; starts.len()];
    let mut again = 0;
    for round in 0..=options.retries {
        let image = |path: usize| match round {
            0 => starts[path],
            _ => starts[path].images(&along.from)[round as usize % 3],
        };
        let (around, straight): (Vec<usize>, Vec<usize>) =
            open.iter().partition(|&&path| round >= 2 && obstructed[path]);
        let images: Vec<Solution> = straight.iter().map(|&path| image(path)).collect();
        let with = options.parameters.tightened(round.min(3));
        let mut ends = track(&images, along, &with, cancel);
        let images: Vec<Solution> = around.iter().map(|&path| image(path)).collect();
        ends.extend(track_around(&images, along, round, &options.parameters.tightened(1), cancel));
        let paths: Vec<usize> = straight.into_iter().chain(around).collect();
        let arrived: Vec<Solution> = ends.iter().map(|end| end.solution).collect();
        let corrected = correct(&arrived, along, CORRECTIONS);
        let judged: Vec<Fate> =
            ends.par_iter().zip(&corrected).map(|(end, corrected)| fate(end, corrected, along)).collect();
        for ((&path, fate), corrected) in paths.iter().zip(judged).zip(&corrected) {
            fates[path] = fate;
            rough[path] = corrected.newton_step > CONVERGED && corrected.size <= MODERATE;
            obstructed[path] |= matches!(fate, Fate::Lost | Fate::Singular);
        }
        open = unsettled(&fates, round);
        progress(starts.len() - open.len(), starts.len());
        if round == 0 {
            again = open.len();
        }
        if open.is_empty() || cancel.load(Ordering::Relaxed) {
            break;
        }
    }
    if !cancel.load(Ordering::Relaxed) {
        for path in open {
            if rough[path] && fates[path] != Fate::Lost {
                fates[path] = Fate::Singular;
            }
        }
    }
    Fates { fates, again }
}

/// Below this size an isolated solution has not lost many digits.
const MODERATE: f64 = 1e3;

/// As many singular ends may well be obstacles close to the end; a target in special position has more of them.
const FEW: usize = 8;
/// Newton steps on arrival.
const CORRECTIONS: usize = 2;

/// Through t = 1/2 + i e instead of straight, e small and another one each round: around a place close to the straight
/// path where the solution is all but infinite. Should a branch point lie between the two routes, the path ends where
/// another one does, which shows.
fn track_around(
    starts: &[Solution],
    along: &Segment,
    round: u32,
    with: &Parameters,
    cancel: &AtomicBool,
) -> Vec<Tracked> {
    let e = ASIDE * 4.0_f64.powi(round as i32 / 2 - 1) * if round.is_multiple_of(2) { 1.0 } else { -1.0 };
    let t = Complex::new(0.5, e);
    let middle = Displacements {
        delta: std::array::from_fn(|j| along.from.delta[j] * (-t + 1.0) + along.to.delta[j] * t),
        starred: std::array::from_fn(|j| along.from.starred[j] * (-t + 1.0) + along.to.starred[j] * t),
    };
    let mut ends = track(starts, &Segment { from: along.from, to: middle }, with, cancel);
    let arrived: Vec<usize> = (0..ends.len()).filter(|&at| ends[at].ending == Ending::Arrived).collect();
    for end in &mut ends {
        // Where the first leg stopped counts as its half of the way.
        end.ending = match end.ending {
            Ending::Stalled { t } => Ending::Stalled { t: 0.5 * t },
            Ending::OutOfSteps { t } => Ending::OutOfSteps { t: 0.5 * t },
            other => other,
        };
    }
    let there: Vec<Solution> = arrived.iter().map(|&at| ends[at].solution).collect();
    let seconds = track(&there, &Segment { from: middle, to: along.to }, with, cancel);
    for (&at, second) in arrived.iter().zip(seconds) {
        ends[at] = Tracked { steps: ends[at].steps + second.steps, ..second };
    }
    ends
}

/// How far from the straight path the first way around leads, in t.
const ASIDE: f64 = 0.005;

/// Where few classes are missing: all paths once more on a wide detour, which permutes the ends; classes that only it
/// finds take the place of paths that were lost, singular or second in their class.
fn complete(ends: &mut Fates, starts: &[Solution], along: &Segment, options: &Options, cancel: &AtomicBool) {
    let foci = |fates: &[Fate]| isolated(fates).map(|(_, class)| class.solution.foci()).collect::<Vec<_>>();
    let first = first_of_class(&foci(&ends.fates), SAME);
    let paths: Vec<usize> = isolated(&ends.fates).map(|(path, _)| path).collect();
    let mut is_first = vec![false; starts.len()];
    for (at, &path) in paths.iter().enumerate() {
        is_first[path] = first[at] == at;
    }
    let spare: Vec<usize> = (0..starts.len()).filter(|&path| !is_first[path]).collect();
    if spare.is_empty() || spare.len() > FEW || cancel.load(Ordering::Relaxed) {
        return;
    }
    let tracked = track_around(starts, along, WIDE, &options.parameters, cancel);
    let arrived: Vec<Solution> = tracked.iter().map(|end| end.solution).collect();
    let corrected = correct(&arrived, along, CORRECTIONS);
    let detour: Vec<Fate> = tracked.par_iter().zip(&corrected).map(|(end, c)| fate(end, c, along)).collect();
    let known: Vec<Fate> =
        (0..starts.len()).filter(|&path| is_first[path]).map(|path| ends.fates[path]).collect();
    let all: Vec<Fate> =
        known.iter().chain(&detour).copied().filter(|f| matches!(f, Fate::Isolated(_))).collect();
    let first = first_of_class(&foci(&all), SAME);
    let new = (known.len()..all.len()).filter(|&at| first[at] == at);
    for (path, at) in spare.into_iter().zip(new) {
        ends.fates[path] = all[at];
    }
    ends.again = starts.len();
}

/// The round whose way around is a wide one: t = 1/2 + 0.32 i.
const WIDE: u32 = 8;

/// Paths that another round may help: lost ones, those that share a class, and those that seemed to end in singular
/// solutions, after the first round or when they are few.
fn unsettled(fates: &[Fate], round: u32) -> Vec<usize> {
    let mut open: Vec<usize> = (0..fates.len()).filter(|&path| fates[path] == Fate::Lost).collect();
    let singular: Vec<usize> = (0..fates.len()).filter(|&path| fates[path] == Fate::Singular).collect();
    if round == 0 || singular.len() <= FEW {
        open.extend(singular);
    }
    let (paths, foci): (Vec<usize>, Vec<_>) =
        isolated(fates).map(|(path, class)| (path, class.solution.foci())).unzip();
    let first = first_of_class(&foci, SAME);
    let mut shared = vec![false; paths.len()];
    for (at, &first) in first.iter().enumerate() {
        if first != at {
            (shared[first], shared[at]) = (true, true);
        }
    }
    open.extend(paths.iter().zip(&shared).filter(|(_, shared)| **shared).map(|(&path, _)| path));
    open.sort_unstable();
    open
}

/// The isolated solutions with the numbers of their paths.
pub(super) fn isolated(fates: &[Fate]) -> impl Iterator<Item = (usize, &Class)> {
    fates.iter().enumerate().filter_map(|(path, fate)| match fate {
        Fate::Isolated(class) => Some((path, class)),
        Fate::Singular | Fate::Lost => None,
    })
}

/// Distinct classes, what is real about them, and the census.
pub(super) fn judged(target: &Target, ends: &Fates, cancelled: bool) -> Solved {
    let finite: Vec<Class> = isolated(&ends.fates).map(|(_, class)| *class).collect();
    let foci: Vec<_> = finite.iter().map(|class| class.solution.foci()).collect();
    let first = first_of_class(&foci, SAME);
    let mut classes: Vec<(f64, Class)> = (0..finite.len())
        .filter(|&at| first[at] == at)
        .map(|at| (key(&foci[at]), Class { reality: reality(&finite[at].solution), ..finite[at] }))
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
        real: count(Reality::Linkage),
        curve_only: count(Reality::CurveOnly),
        complex: count(Reality::Complex),
    };
    Solved { target: *target, classes, census, cancelled }
}

/// What is real about a solution of a real target.
fn reality(of: &Solution) -> Reality {
    if of.imaginary_part() <= REAL {
        Reality::Linkage
    } else if class_distance(&of.foci(), &of.conjugate().foci()) <= REAL {
        Reality::CurveOnly
    } else {
        Reality::Complex
    }
}
