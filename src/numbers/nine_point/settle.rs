//! Homotopy path tracking of all classes: all paths are tracked together, lost ones again in further rounds, and each
//! end is classified.

use super::careful::{Followed, follow};
use super::certificate::{Certificate, Refused, certify_displacements};
use super::classes::{Class, first_of_class};
use super::conjugation::Reality;
use super::correction::{Corrected, correct};
use super::distinct::not_proved_distinct;
use super::refinement::refine;
use super::target::{Closure, Displacements, Solution};
use super::tracker::{Ending, Parameters, Segment, Tracked, track};
use linkwright_arithmetic::Complex;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// The options of [`solve`](super::solve::solve).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The parameters of the first round of tracking.
    pub parameters: Parameters,
    /// The number of further rounds, each with tighter tolerances and from another image of the start, for paths that
    /// were lost and for those that ended together.
    pub retries: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options { parameters: Parameters::default(), retries: 7 }
    }
}

/// The classified end of a path.
#[expect(clippy::large_enum_variant, reason = "nearly every path ends in an isolated solution")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fate {
    /// An isolated solution.
    Isolated(Class),
    /// An end at infinity, in a singular solution or in a family of them.
    Singular,
    /// A path lost on the way.
    Lost,
}

/// The fates of all paths after all rounds, with the number of paths that took more than one.
pub(super) struct Fates {
    pub(super) fates: Vec<Fate>,
    pub(super) again: usize,
}

/// The relative Newton step above which a solution is refined in double-double before it is compared.
const ROUGH: f64 = 1e-11;
/// The largest last Newton step of an isolated solution.
const CONVERGED: f64 = 1e-9;
/// The speed, relative to the solution and over the whole path, above which an end counts as singular.
const SINGULAR_SPEED: f64 = 1e9;
/// The last part of the way, in t: a path that stops in it has met a singularity of the end, not one of the way.
const NEAR_THE_END: f64 = 1e-3;
/// The tolerance within which two solutions are of one class.
pub(super) const SAME: f64 = 1e-8;

/// Classifies the end of a path; `fastest` is the speed above which it counts as singular.
fn fate(ending: Ending, class: Class, fastest: f64) -> Fate {
    match ending {
        Ending::Cancelled => Fate::Lost,
        Ending::Stalled { t } | Ending::OutOfSteps { t } if 1.0 - t >= NEAR_THE_END => Fate::Lost,
        Ending::Arrived if class.newton_step <= CONVERGED && class.speed <= fastest => Fate::Isolated(class),
        _ => Fate::Singular,
    }
}

/// Corrects and classifies the ends of tracked paths.
fn fates_of(ends: &[Tracked], along: &Segment) -> Vec<(Fate, Corrected)> {
    let arrived: Vec<Solution> = ends.iter().map(|end| end.solution).collect();
    let judged = |(end, corrected): (&Tracked, Corrected)| {
        let Corrected { mut solution, mut newton_step, speed, .. } = corrected;
        if end.ending == Ending::Arrived && (newton_step.is_nan() || newton_step > ROUGH) {
            match refine(&along.to, &end.solution) {
                Ok(refined) => (solution, newton_step) = (refined.solution, refined.last_step),
                Err(_) => return (Fate::Singular, corrected),
            }
        }
        let class = Class { solution, reality: Reality::Complex, newton_step, speed };
        (fate(end.ending, class, SINGULAR_SPEED), corrected)
    };
    ends.par_iter().zip(correct(&arrived, along, CORRECTIONS)).map(judged).collect()
}

/// Rounds in which the open paths, once they are few, are tracked in double-double: one from each cognate.
const CAREFUL_ROUNDS: std::ops::RangeInclusive<u32> = 2..=4;
/// The largest number of open paths that are tracked in double-double: one takes as long as a hundred in lanes.
const CAREFUL_FEW: usize = 32;
/// As [`SINGULAR_SPEED`], in double-double.
const CAREFUL_SINGULAR_SPEED: f64 = 1e13;

/// Tracks `starts` along the segment; lost and coinciding paths are tracked again, more carefully, from other images,
/// and from the third round on those that met an obstacle take a detour ([`track_around`]).
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
    // Paths whose solution was inaccurate though of moderate size: if two of them stay together, it is a double
    // solution.
    let mut rough = vec![false; starts.len()];
    let mut again = 0;
    for round in 0..=options.retries {
        let image = |&path: &usize| match round {
            0 => starts[path],
            _ => starts[path].images(&along.from)[round as usize % 3],
        };
        if CAREFUL_ROUNDS.contains(&round) && open.len() <= CAREFUL_FEW {
            let with = options.parameters.tightened(1);
            let end_of = |path: &usize| {
                let Followed { ending, end } = follow(&image(path), along, &with, cancel);
                fate(ending, end, CAREFUL_SINGULAR_SPEED)
            };
            let ends: Vec<Fate> = open.par_iter().map(end_of).collect();
            for (&path, fate) in open.iter().zip(ends) {
                fates[path] = fate;
                rough[path] = false;
            }
        } else {
            let (around, straight): (Vec<usize>, Vec<usize>) =
                open.iter().partition(|&&path| round >= 2 && obstructed[path]);
            let images: Vec<Solution> = straight.iter().map(image).collect();
            let with = options.parameters.tightened(round.min(3));
            let mut ends = track(&images, along, &with, cancel);
            let images: Vec<Solution> = around.iter().map(image).collect();
            ends.extend(track_around(&images, along, round, &options.parameters.tightened(1), cancel));
            let paths: Vec<usize> = straight.into_iter().chain(around).collect();
            for (path, (fate, corrected)) in paths.into_iter().zip(fates_of(&ends, along)) {
                fates[path] = fate;
                rough[path] = corrected.newton_step > CONVERGED && corrected.size <= MODERATE;
                obstructed[path] |= matches!(fate, Fate::Lost | Fate::Singular);
            }
        }
        open = unsettled(&fates, round, &along.to);
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

/// The size below which an isolated solution has not lost many digits.
const MODERATE: f64 = 1e3;

/// The number of singular ends that may well be obstacles close to the end; a target in special position has more of
/// them.
const FEW: usize = 8;
/// The largest number of singular ends that may be accidents of tracking; more are not tracked again.
const MANY: usize = 400;
/// The number of Newton steps on arrival.
const CORRECTIONS: usize = 2;

/// Tracks paths through t = 1/2 + i e instead of straight, with e small and different in each round: a detour around
/// a place close to the straight path where the solution is all but infinite. If a branch point lies between the two
/// routes, the path ends at the end of another one, and the two are found to coincide.
fn track_around(
    starts: &[Solution],
    along: &Segment,
    round: u32,
    with: &Parameters,
    cancel: &AtomicBool,
) -> Vec<Tracked> {
    let e = ASIDE * 4.0_f64.powi(round as i32 / 2 - 1) * if round.is_multiple_of(2) { 1.0 } else { -1.0 };
    let middle = along.at(Complex::new(0.5, e));
    let mut ends = track(starts, &Segment { from: along.from, to: middle }, with, cancel);
    let arrived: Vec<usize> = (0..ends.len()).filter(|&at| ends[at].ending == Ending::Arrived).collect();
    for end in &mut ends {
        // The first leg is half of the way, so its t counts half.
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

/// The distance of the first detour from the straight path, in t.
const ASIDE: f64 = 0.005;

/// Tracks all paths once more on a wide detour, which permutes the ends, if few classes are missing; classes that
/// only the detour finds take the place of paths that were lost, singular or second in their class.
pub(super) fn complete(
    ends: &mut Fates,
    starts: &[Solution],
    along: &Segment,
    options: &Options,
    cancel: &AtomicBool,
) {
    let solutions = |fates: &[Fate]| isolated(fates).map(|(_, class)| class.solution).collect::<Vec<_>>();
    let closure = along.to.kind.closure;
    let first = firsts(&solutions(&ends.fates), closure, |s| certify_displacements(&along.to, s));
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
    let detour = fates_of(&tracked, along).into_iter().map(|(fate, _)| fate);
    let known: Vec<Fate> =
        (0..starts.len()).filter(|&path| is_first[path]).map(|path| ends.fates[path]).collect();
    let all: Vec<Fate> =
        known.iter().copied().chain(detour).filter(|f| matches!(f, Fate::Isolated(_))).collect();
    let first = firsts(&solutions(&all), closure, |s| certify_displacements(&along.to, s));
    let new = (known.len()..all.len()).filter(|&at| first[at] == at);
    for (path, at) in spare.into_iter().zip(new) {
        ends.fates[path] = all[at];
    }
    ends.again = starts.len();
}

/// The number of a round whose detour is wide: t = 1/2 + 0.32 i.
const WIDE: u32 = 8;

/// Returns for each solution the index of the first one of its class, as [`first_of_class`]; solutions that are of
/// one class to rounding are of two if their certificates prove them distinct.
pub(super) fn firsts(
    solutions: &[Solution],
    closure: Closure,
    certify: impl Fn(&Solution) -> Result<Certificate, Refused>,
) -> Vec<usize> {
    let near = first_of_class(solutions, closure, SAME);
    let mut first = near.clone();
    let apart = |i: usize, j: usize| {
        let proofs = [i, j].map(|k| certify(&solutions[k]));
        matches!(proofs, [Ok(one), Ok(other)] if not_proved_distinct(&[one, other]).is_empty())
    };
    for i in (0..solutions.len()).filter(|&i| near[i] != i) {
        let met = (near[i]..i).find(|&j| near[j] == near[i] && first[j] == j && !apart(i, j));
        first[i] = met.unwrap_or(i);
    }
    first
}

/// Returns the paths that another round may help: lost ones, those that share a class, and those that seemed to end
/// in singular solutions, when they are few, or not too many after the first round.
fn unsettled(fates: &[Fate], round: u32, at: &Displacements) -> Vec<usize> {
    let mut open: Vec<usize> = (0..fates.len()).filter(|&path| fates[path] == Fate::Lost).collect();
    let singular: Vec<usize> = (0..fates.len()).filter(|&path| fates[path] == Fate::Singular).collect();
    if singular.len() <= if round == 0 { MANY } else { FEW } {
        open.extend(singular);
    }
    let (paths, solutions): (Vec<usize>, Vec<_>) =
        isolated(fates).map(|(path, class)| (path, class.solution)).unzip();
    let first = firsts(&solutions, at.kind.closure, |s| certify_displacements(at, s));
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

/// Iterates over the isolated solutions with the indices of their paths.
pub(super) fn isolated(fates: &[Fate]) -> impl Iterator<Item = (usize, &Class)> {
    fates.iter().enumerate().filter_map(|(path, fate)| match fate {
        Fate::Isolated(class) => Some((path, class)),
        Fate::Singular | Fate::Lost => None,
    })
}
