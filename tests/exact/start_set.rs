//! The embedded start set: whole, complete, and what comes out when it is made anew.

use crate::monodromy::{Limits, orbit};
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::Solution;
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::equations::residuals;
use linkwright::internals::numbers::nine_point::start::{CLASSES, EMBEDDED, StartSet, StartSetError};
use sha2::{Digest, Sha256};
use std::sync::atomic::AtomicBool;

/// Of `src/numbers/nine_point/start-set.bin`.
const SHA_256: &str = "3c894278aaa3946d1f30a5e16b106328fbd7d7dcda3d21945b5ae473a0fca418";

/// Returns the number of classes among solutions.
fn classes(solutions: &[Solution]) -> usize {
    first_of_class(solutions, 1e-7).into_iter().enumerate().filter(|(at, first)| at == first).count()
}

#[test]
fn the_embedded_file_is_whole_and_small() {
    let digest: String = Sha256::digest(EMBEDDED).iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(digest, SHA_256);
    assert!(EMBEDDED.len() <= 100_000);
}

#[test]
fn the_embedded_set_has_1442_different_classes_that_solve_its_equations() {
    let set = StartSet::parse(EMBEDDED).expect("it is whole");
    assert_eq!(set.solutions.len(), CLASSES);
    assert_eq!(classes(&set.solutions), CLASSES);
    for solution in &set.solutions {
        assert!(residuals(solution, &set.displacements).iter().flatten().all(|f| f.norm() < 1e-8));
    }
}

#[test]
fn broken_files_are_refused() {
    assert_eq!(StartSet::parse(b"LWN"), Err(StartSetError::Header));
    let mut other_version = EMBEDDED.to_vec();
    other_version[4] = 9;
    assert_eq!(StartSet::parse(&other_version), Err(StartSetError::Header));
    assert!(matches!(StartSet::parse(&EMBEDDED[..EMBEDDED.len() - 1]), Err(StartSetError::Length { .. })));
    let mut no_solution = EMBEDDED.to_vec();
    no_solution[272..272 + 64].fill(0);
    assert_eq!(StartSet::parse(&no_solution), Err(StartSetError::Entry(0)));
}

#[test]
fn made_anew_from_nothing_it_is_the_same_set() {
    // Until all are found; the generator's command goes on until loops find none.
    let mut numbers = stream(1, 0);
    let limits = Limits { enough: CLASSES, ..Limits::default() };
    let found = orbit(&mut || unit(&mut numbers), &limits, &AtomicBool::new(false));
    assert!(found.loops < limits.loops, "{} loops, the last {} without a new class", found.loops, found.idle);
    let anew = StartSet { displacements: found.displacements, solutions: found.solutions };
    let embedded = StartSet::embedded();
    assert_eq!(anew.displacements, embedded.displacements);
    assert_eq!(anew.solutions.len(), CLASSES);
    assert_eq!(classes(&anew.solutions), CLASSES);
    assert_eq!(classes(&[anew.solutions, embedded.solutions.clone()].concat()), CLASSES);
}
