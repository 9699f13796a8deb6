//! The embedded start sets: whole, complete, and what comes out when they are made anew.

use crate::monodromy::{Limits, orbit};
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::Solution;
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::equations::residuals;
use linkwright::internals::numbers::nine_point::start::{CLASSES, EMBEDDED, StartSet, StartSetError};
use sha2::{Digest, Sha256};
use std::sync::atomic::AtomicBool;

/// Of the files `src/numbers/nine_point/start-set*.bin`.
const SHA_256: [&str; 5] = [
    "3c894278aaa3946d1f30a5e16b106328fbd7d7dcda3d21945b5ae473a0fca418",
    "cb41ee791d245d9f381227eb184f454d4e4725dcda78a2c659cec8be54d3d944",
    "17b7d7aacc3b18812da99e21e66391e5e7027b632e2d41d05ce96334763b4304",
    "a3f3e10640e328f384c0b3b37ed2c274a364fc5d418e4ee4078aae42c1c32c0b",
    "7e9f5d7d78755d8fac395a65fdf550b12da349ff2db1e436809b674c9c934fc6",
];

/// Returns the number of classes among solutions.
fn classes(solutions: &[Solution]) -> usize {
    first_of_class(solutions, 1e-7).into_iter().enumerate().filter(|(at, first)| at == first).count()
}

#[test]
fn the_embedded_files_are_whole_and_small() {
    for (file, wanted) in EMBEDDED.into_iter().zip(SHA_256) {
        let digest: String = Sha256::digest(file).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(digest, wanted);
    }
    assert!(EMBEDDED.into_iter().map(<[u8]>::len).sum::<usize>() <= 200_000);
}

#[test]
fn each_embedded_set_has_as_many_different_classes_as_are_known_and_they_solve_its_equations() {
    for (poses, (file, known)) in EMBEDDED.into_iter().zip(CLASSES).enumerate() {
        let set = StartSet::parse(file).expect("it is whole");
        assert_eq!(set.displacements.poses, poses);
        assert_eq!(set.solutions.len(), known);
        assert_eq!(classes(&set.solutions), known);
        for solution in &set.solutions {
            assert!(residuals(solution, &set.displacements).iter().flatten().all(|f| f.norm() < 1e-8));
        }
    }
}

#[test]
fn broken_files_are_refused() {
    let whole = EMBEDDED[0];
    assert_eq!(StartSet::parse(b"LWN"), Err(StartSetError::Header));
    for (place, value) in [(4, 9), (12, 5)] {
        let mut other = whole.to_vec();
        other[place] = value;
        assert_eq!(StartSet::parse(&other), Err(StartSetError::Header));
    }
    assert!(matches!(StartSet::parse(&whole[..whole.len() - 1]), Err(StartSetError::Length { .. })));
    let mut no_solution = whole.to_vec();
    no_solution[272..272 + 64].fill(0);
    assert_eq!(StartSet::parse(&no_solution), Err(StartSetError::Entry(0)));
}

#[test]
fn made_anew_from_nothing_they_are_the_same_sets() {
    // The large ones until all are found, the small ones until loops find none, as the generator's command does.
    for (poses, known) in CLASSES.into_iter().enumerate() {
        let mut numbers = stream(1, poses as u64);
        let enough = if poses < 2 { known } else { usize::MAX };
        let limits = Limits { enough, ..Limits::default() };
        let found = orbit(&mut || unit(&mut numbers), poses, &limits, &AtomicBool::new(false));
        let (loops, idle) = (found.loops, found.idle);
        assert!(loops < limits.loops, "{loops} loops, the last {idle} without a new class");
        let anew = StartSet { displacements: found.displacements, solutions: found.solutions };
        let embedded = StartSet::embedded(poses);
        assert_eq!(anew.displacements, embedded.displacements);
        assert_eq!(anew.solutions.len(), known);
        assert_eq!(classes(&anew.solutions), known);
        assert_eq!(classes(&[anew.solutions, embedded.solutions.clone()].concat()), known);
    }
}
