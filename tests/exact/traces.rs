//! The trace test of small start sets, and what it says of a set that lacks a solution.

use crate::trace::trace;
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::start::StartSet;
use linkwright::internals::numbers::nine_point::target::Kind;

/// Kinds that take a second or two, each with the number of points of its other section.
const SMALL: [(Kind, usize); 2] = [(Kind::new(4, 0), 126), (Kind::new(1, 2), 94)];

#[test]
fn sums_over_all_solutions_are_linear_and_without_any_one_they_are_not() {
    for (kind, others) in SMALL {
        let mut numbers = stream(3, 0);
        let found =
            trace(StartSet::embedded(kind), &mut || unit(&mut numbers), 120).expect("no path is lost");
        assert_eq!((found.at_t, found.known, found.others), (kind.classes(), kind.classes(), others));
        assert!(found.lost == 0 && found.loops.1 >= 2 && found.loops.0 < 120, "{:?}", found.loops);
        assert!(found.departure < 1e-11, "{kind:?}: {:e}", found.departure);
        assert!(found.without_one > 1e-7 && found.factor > 1e6, "{kind:?}: {:e}", found.factor);
    }
}

#[test]
fn a_set_that_lacks_solutions_is_found_out() {
    let (kind, _) = SMALL[1];
    let mut part = StartSet::embedded(kind).clone();
    part.solutions.truncate(2);
    let mut numbers = stream(3, 0);
    // Loops find the others.
    let found = trace(&part, &mut || unit(&mut numbers), 120).expect("no path is lost");
    assert_eq!((found.at_t, found.known), (kind.classes(), 2));
    assert!(found.departure < 1e-11, "{:e}", found.departure);
    // Without loops to find them, the sums depart.
    let mut numbers = stream(3, 0);
    let found = trace(&part, &mut || unit(&mut numbers), 3).expect("no path is lost");
    assert!(found.departure > 1e-3, "{:e}", found.departure);
}
