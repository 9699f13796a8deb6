//! Homotopy path tracking from target to target: the solutions of a target that has moved a little, from those of the
//! target before.
//!
//! A straight path between two real targets crosses the discriminant, where real solutions meet and part. So the
//! displacements go in two legs through a complex midpoint,
//!
//! ```text
//! delta_m = (delta + delta') / 2 + r c_j,      delta*_m = (delta* + delta*') / 2 + r c*_j
//! ```
//!
//! r the largest |delta' - delta|, c_j and c*_j fixed numbers of modulus about one in general position. Of two conjugate
//! classes one is tracked: the conjugate of its end is the end of the other, or of a path that is found to share it.

use super::certificate::certify;
use super::classes::{Class, first_of_class};
use super::settle::{Fate, Fates, Options, SAME, firsts, isolated, settle};
use super::solve::{Solved, judged, solve};
use super::target::{Closure, Displacements, STEPS, Solution, Target};
use super::tracker::{Parameters, Segment};
use linkwright_arithmetic::Complex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The result of solving a target from a neighbour's solutions.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// The solutions; those of the full solve if it fell back.
    pub solved: Solved,
    /// The number of classes of the previous target that arrived in different classes of this one.
    pub kept: usize,
    /// Whether classes were lost and the target was solved from the start set instead.
    pub fell_back: bool,
}

/// Tracks the classes of `previous` to `target`; solves the target from the start set if any class was lost.
pub fn resolve_from(previous: &Solved, target: &Target, options: &Options, cancel: &AtomicBool) -> Moved {
    let ratio = previous.target.scale / target.scale;
    // In units of the new target, both ways of measuring give the same equations.
    let from = previous.target.displacements.in_other_units(ratio.into(), ratio.into());
    let starts: Vec<Solution> = previous
        .classes
        .iter()
        .map(|class| class.solution.in_other_units(ratio.into(), ratio.into()))
        .collect();
    let to = target.displacements;
    let middle = midpoint(&from, &to);
    let legs = [Segment { from, to: middle }, Segment { from: middle, to }];
    let legs = Legs { legs, options: Options { parameters: short(&options.parameters), ..*options }, cancel };
    let mut kept = 0;
    for track in [by_halves, one_by_one] {
        let ends = track(&starts, &legs);
        let classes: Vec<Solution> = isolated(&ends.fates).map(|(_, class)| class.solution).collect();
        let first = firsts(&classes, to.kind.closure, |s| certify(target, s));
        kept = first.iter().enumerate().filter(|(at, first)| at == *first).count();
        let cancelled = cancel.load(Ordering::Relaxed);
        if kept == previous.classes.len() && kept == previous.census.tracked || cancelled {
            return Moved { solved: judged(target, &ends, cancelled), kept, fell_back: false };
        }
    }
    Moved { solved: solve(target, options, &quiet, cancel), kept, fell_back: true }
}

/// No report of the paths that have ended.
fn quiet(_: usize, _: usize) {}

/// The way from target to target.
struct Legs<'a> {
    legs: [Segment; 2],
    options: Options,
    cancel: &'a AtomicBool,
}

impl Legs<'_> {
    /// Tracks solutions over both legs; gives the fate of each.
    fn follow(&self, starts: &[Solution]) -> Fates {
        let [first, second] = &self.legs;
        let there = settle(starts, first, &self.options, &quiet, self.cancel);
        let (paths, arrived): (Vec<usize>, Vec<Solution>) =
            isolated(&there.fates).map(|(path, class)| (path, class.solution)).unzip();
        let ends = settle(&arrived, second, &self.options, &quiet, self.cancel);
        let mut fates = vec![Fate::Lost; starts.len()];
        for (path, fate) in paths.into_iter().zip(ends.fates) {
            fates[path] = fate;
        }
        Fates { fates, again: there.again + ends.again }
    }
}

/// Tracks one class of each conjugate pair: both targets are real, so the conjugate of an end is an end. Where it is an
/// end of another path, as that of two classes that have become real, the other class of the pair is tracked too, until
/// no two ends are one.
fn by_halves(starts: &[Solution], legs: &Legs<'_>) -> Fates {
    let partners = partners(starts, legs.legs[0].from.kind.closure);
    let mut is_tracked = vec![false; starts.len()];
    let mut ends = Fates { fates: vec![Fate::Lost; starts.len()], again: 0 };
    let mut open: Vec<usize> = (0..starts.len()).filter(|&path| partners[path] >= path).collect();
    while !open.is_empty() {
        let tracked = legs.follow(&open.iter().map(|&path| starts[path]).collect::<Vec<_>>());
        ends.again += tracked.again;
        for (&path, fate) in open.iter().zip(tracked.fates) {
            (ends.fates[path], is_tracked[path]) = (fate, true);
            let partner = partners[path];
            if !is_tracked[partner] {
                ends.fates[partner] = conjugate(fate);
            }
        }
        let (paths, found): (Vec<usize>, Vec<Solution>) =
            isolated(&ends.fates).map(|(path, class)| (path, class.solution)).unzip();
        let first = first_of_class(&found, legs.legs[1].to.kind.closure, SAME);
        let shared = (0..paths.len()).filter(|&at| first[at] != at);
        let pairs =
            shared.flat_map(|at| [paths[at], paths[first[at]]]).flat_map(|path| [path, partners[path]]);
        open = pairs.filter(|&path| !is_tracked[path]).collect();
        open.sort_unstable();
        open.dedup();
    }
    ends
}

/// Tracks every class by itself.
fn one_by_one(starts: &[Solution], legs: &Legs<'_>) -> Fates {
    legs.follow(starts)
}

fn conjugate(fate: Fate) -> Fate {
    match fate {
        Fate::Isolated(class) => Fate::Isolated(Class { solution: class.solution.conjugate(), ..class }),
        Fate::Singular | Fate::Lost => fate,
    }
}

/// Returns for each class the index of the class of its conjugate: its own if it is real, or if none is found.
fn partners(classes: &[Solution], closure: Closure) -> Vec<usize> {
    let n = classes.len();
    let with_conjugates: Vec<Solution> =
        classes.iter().copied().chain(classes.iter().map(Solution::conjugate)).collect();
    let first = first_of_class(&with_conjugates, closure, SAME);
    let partner = |at: usize| Some(first[n + at]).filter(|&other| other < n);
    (0..n).map(|at| partner(at).filter(|&other| partner(other) == Some(at)).unwrap_or(at)).collect()
}

/// Returns parameters with long steps, for short ways. A path that goes astray on one ends at the end of another
/// path, and is tracked again.
fn short(with: &Parameters) -> Parameters {
    Parameters {
        accept: 3.0 * with.accept,
        aim: 5.0 * with.aim,
        first_step: 10.0 * with.first_step,
        longest_step: 5.0 * with.longest_step,
        ..*with
    }
}

/// Returns the displacements half way, moved off the real ones by as much as the targets differ.
fn midpoint(from: &Displacements, to: &Displacements) -> Displacements {
    let differences = || (0..STEPS).map(|j| (to.delta[j] - from.delta[j]).norm());
    let radius = differences().fold(0.0, f64::max);
    // Angles that are no multiples of one another, different for the twins.
    let off = |j: usize, turn: f64| Complex::from_polar(radius, turn * (j as f64 + 1.0) * (j as f64 + 2.3));
    Displacements {
        delta: std::array::from_fn(|j| (from.delta[j] + to.delta[j]) * 0.5 + off(j, 0.754_877_7)),
        starred: std::array::from_fn(|j| (from.starred[j] + to.starred[j]) * 0.5 + off(j, 1.324_718_0)),
        kind: to.kind,
    }
}
