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
//! r the largest |delta' - delta|, c_j and c*_j fixed numbers of modulus about one in general position.

use super::certificate::certify;
use super::settle::{Fate, Fates, Options, firsts, isolated, settle};
use super::solve::{Solved, judged, solve};
use super::target::{Displacements, STEPS, Solution, Target};
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
    let from = previous.target.displacements.map(|d| d * ratio);
    let starts: Vec<Solution> = previous
        .classes
        .iter()
        .map(|class| class.solution.in_other_units(ratio.into(), ratio.into()))
        .collect();
    let to = target.displacements;
    let middle = midpoint(&from, &to);
    let quiet = |_: usize, _: usize| {};
    let legs = Options { parameters: short(&options.parameters), ..*options };
    let first = settle(&starts, &Segment { from, to: middle }, &legs, &quiet, cancel);
    let there: Vec<Solution> = isolated(&first.fates).map(|(_, class)| class.solution).collect();
    let second = settle(&there, &Segment { from: middle, to }, &legs, &quiet, cancel);
    let ends: Vec<Solution> = isolated(&second.fates).map(|(_, class)| class.solution).collect();
    let kept =
        firsts(&ends, |s| certify(target, s)).iter().enumerate().filter(|(at, first)| at == *first).count();
    let cancelled = cancel.load(Ordering::Relaxed);
    if kept == previous.classes.len() && kept == previous.census.tracked || cancelled {
        let lost = starts.len() - there.len();
        let fates = second.fates.into_iter().chain(std::iter::repeat_n(Fate::Lost, lost)).collect();
        let ends = Fates { fates, again: first.again + second.again };
        return Moved { solved: judged(target, &ends, cancelled), kept, fell_back: false };
    }
    Moved { solved: solve(target, options, &quiet, cancel), kept, fell_back: true }
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
    }
}
