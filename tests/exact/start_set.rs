//! The embedded start sets: whole, complete, and what comes out when they are made anew.

use crate::common::thorough::is_thorough;
use crate::monodromy::{Limits, index, limits_of, orbit};
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::Solution;
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::equations::residuals;
use linkwright::internals::numbers::nine_point::start::{StartSet, StartSetError};
use linkwright::internals::numbers::nine_point::target::Kind;
use sha2::{Digest, Sha256};
use std::sync::atomic::AtomicBool;

/// Of the files `src/numbers/nine_point/start-set*.bin`, in the order of [`Kind::known`].
const SHA_256: [&str; 13] = [
    "3c894278aaa3946d1f30a5e16b106328fbd7d7dcda3d21945b5ae473a0fca418",
    "cb41ee791d245d9f381227eb184f454d4e4725dcda78a2c659cec8be54d3d944",
    "17b7d7aacc3b18812da99e21e66391e5e7027b632e2d41d05ce96334763b4304",
    "a3f3e10640e328f384c0b3b37ed2c274a364fc5d418e4ee4078aae42c1c32c0b",
    "7e9f5d7d78755d8fac395a65fdf550b12da349ff2db1e436809b674c9c934fc6",
    "f9a71673fc33860ecb08c9dfa555ed05796aa9f3d4b469e90a3ca948be1197b0",
    "36626eaf9cf28e4db399d2ca0a04e4b72925698ccef601b1a510c57430366954",
    "883680cd795a547e91a4a5e4f071d185520ea1ba3e391028953050a7f81304d5",
    "4c08de0f4a7f9e00f4481aec1b432fb1cc3676b26206f59f5c0848f966b35cfd",
    "ae514a5a2e7cf918a3ecb31b04b4514527eaf263b6bb31ea3562af4303cb92f5",
    "e35156c0e1def96ffcff9958f1c36f8d7cc996788d054f74d5b0079abd15eb7d",
    "adcfafe91dc9f2bd6c109df363a5cfa56bdc78c7908c771f5f7154550fa0fa2f",
    "f37d737c57b38b98b99ab970881dc689e219a0c8252aafdcbf4cd6c929062498",
];

/// Returns the number of classes among solutions.
fn classes(solutions: &[Solution], kind: Kind) -> usize {
    first_of_class(solutions, kind.closure, 1e-7)
        .into_iter()
        .enumerate()
        .filter(|(at, first)| at == first)
        .count()
}

#[test]
fn the_embedded_files_are_whole_and_small() {
    assert_eq!(Kind::known().count(), SHA_256.len());
    for (kind, wanted) in Kind::known().zip(SHA_256) {
        let digest: String =
            Sha256::digest(kind.embedded()).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(digest, wanted);
    }
    assert!(Kind::known().map(|kind| kind.embedded().len()).sum::<usize>() <= 400_000);
}

#[test]
fn each_embedded_set_has_as_many_different_classes_as_are_known_and_they_solve_its_equations() {
    for kind in Kind::known() {
        let (set, known) = (StartSet::parse(kind.embedded()).expect("it is whole"), kind.classes());
        assert_eq!(set.displacements.kind, kind);
        assert_eq!(set.solutions.len(), known);
        assert_eq!(classes(&set.solutions, kind), known);
        for solution in &set.solutions {
            assert!(residuals(solution, &set.displacements).iter().flatten().all(|f| f.norm() < 1e-8));
        }
    }
}

#[test]
fn broken_files_are_refused() {
    let whole = Kind::default().embedded();
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
    for kind in Kind::known().filter(|kind| is_thorough() || kind.classes() < 1000) {
        let known = kind.classes();
        let mut numbers = stream(1, index(kind));
        let (few, _) = limits_of(kind);
        let enough = if known > 1000 { known } else { usize::MAX };
        let limits = Limits { enough, idle: 8, ..Limits::default() };
        let found = orbit(&mut || unit(&mut numbers), (kind, few), &limits, &AtomicBool::new(false));
        let (loops, idle) = (found.loops, found.idle);
        assert!(loops < limits.loops, "{loops} loops, the last {idle} without a new class");
        let anew = StartSet { displacements: found.displacements, solutions: found.solutions };
        let embedded = StartSet::embedded(kind);
        assert_eq!(anew.displacements, embedded.displacements);
        assert_eq!(anew.solutions.len(), known);
        assert_eq!(classes(&anew.solutions, kind), known);
        assert_eq!(classes(&[anew.solutions, embedded.solutions.clone()].concat(), kind), known);
    }
}
