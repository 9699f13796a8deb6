//! A problem that asks for less, or a longer search of the same problem, never has a larger error.

#![allow(clippy::print_stdout, reason = "the slow test prints where an answer is worse")]

use crate::common::thorough::cases;
use crate::invariance::{solved, target};
use crate::rungs::{NEVER_WORSE, Rung, largest_factor};
use linkwright::internals::record::Record;

/// The error of the best accepted candidate in sizes of the target; infinite if there is none.
fn least_error(record: &Record) -> f64 {
    let accepted = record.candidates.iter().filter(|c| c.accepted);
    accepted.map(|c| c.error.rms_over_size).fold(f64::INFINITY, f64::min)
}

/// The targets of the longer tests from the environment: `LADDER_TARGETS=0..200`.
fn targets() -> std::ops::Range<u64> {
    let Ok(asked) = std::env::var("LADDER_TARGETS") else { return 0..20 };
    let (from, to) = asked.split_once("..").expect("FROM..TO");
    from.parse().expect("a number")..to.parse().expect("a number")
}

#[test]
fn a_longer_search_is_never_worse() {
    for index in 0..cases(6, 12) {
        let errors =
            [600, 2400, 9600, 20_000].map(|evaluations| least_error(&solved(&target(index, evaluations).1)));
        assert!(
            errors.windows(2).all(|w| w[1].max(1e-9) <= NEVER_WORSE * w[0].max(1e-9)),
            "target {index}: {errors:?}"
        );
    }
}

#[test]
#[ignore = "3 searches of each target; in a release build"]
fn a_search_with_the_whole_budget_is_never_worse() {
    let worse = targets().filter(|&index| {
        let errors =
            [2_000, 20_000, 100_000].map(|evaluations| least_error(&solved(&target(index, evaluations).1)));
        let is_worse = errors.windows(2).any(|w| w[1].max(1e-9) > NEVER_WORSE * w[0].max(1e-9));
        if is_worse {
            println!("target {index}: {errors:?}");
        }
        is_worse
    });
    assert!(worse.count() as f64 <= 0.01 * targets().count() as f64);
}

#[test]
#[ignore = "4 searches of each target; in a release build"]
fn a_problem_that_asks_for_less_is_never_worse() {
    let mut worse = 0_u32;
    for index in targets() {
        let (kind, spec) = target(index, 200_000);
        let records = Rung::ALL.map(|rung| {
            let mut spec = spec.clone();
            rung.asks(&mut spec);
            solved(&spec)
        });
        let errors = records.each_ref().map(least_error);
        let factor = largest_factor(&errors);
        if factor > NEVER_WORSE {
            let n = spec.task.points.len();
            let ends = records.map(|r| (r.termination.reason, r.evaluations.objective));
            println!("{kind} {index} of {n} points: {factor:.4} in {errors:?}, {ends:?}");
            worse += 1;
        }
    }
    println!("{worse} worse of {:?}", targets());
    assert!(f64::from(worse) <= 0.15 * targets().count() as f64);
}
